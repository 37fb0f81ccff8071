// UTF-8 decoding and trimming of text.
#pragma once

#include <string_view>

namespace elastocheck::reader {

// One UTF-8 character, or an invalid byte.
struct Character {
    std::string_view bytes;
    char32_t code = 0;  // of an invalid byte its value
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

// Without the blanks at both ends.
std::string_view trimmed(std::string_view text);

}  // namespace elastocheck::reader
