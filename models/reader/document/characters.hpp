// Characters and lines of text: UTF-8, letters, trimming.
#pragma once

#include <string>
#include <string_view>

namespace elastocheck::reader {

// One UTF-8 character, or an invalid byte.
struct Character {
    std::string_view bytes;
    char32_t code = 0;  // code point; of an invalid byte its value
    bool valid = false;

    bool control() const;        // C0, DEL, C1, line and paragraph separator
    bool turns_writing() const;  // changes the direction of writing
    bool plain() const { return valid && !control() && !turns_writing(); }
};

// The first character of a text that is not empty (RFC 3629: no overlong forms, no surrogates,
// nothing above U+10FFFF).
Character first_character(std::string_view text);

bool is_utf8(std::string_view text);

// Space, tab, carriage return, vertical tab, form feed, and NUL, with which some programs pad.
inline constexpr std::string_view blanks{" \t\r\v\f\0", 6};
inline bool is_blank(char c) { return blanks.find(c) != blanks.npos; }

std::string_view trimmed(std::string_view text);

// ---- ASCII, in any locale.
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
inline bool is_word(char c) { return is_letter(c) || is_digit(c) || c == '_'; }
inline bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }
std::string capitals(std::string_view text);
std::string small_letters(std::string_view text);

// Lines that end in LF, CR LF or CR alone.
class Lines {
  public:
    explicit Lines(std::string_view text);
    bool next();                            // false at the end
    int number() const { return number_; }  // of the line, from 1
    std::string_view line() const { return line_; }

  private:
    std::string_view rest_, line_;
    char end_;
    int number_ = 0;
};

}  // namespace elastocheck::reader
