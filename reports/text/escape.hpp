// Text that crosses into another language. Whatever comes from outside (names in a scene, a result.json or a
// baseline, file names) passes exactly one of these functions on its way out: the one of the language it goes
// into. All but for_shell yield valid UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace elastocheck::reports {

// What makes a text unfit to be a name: bytes that are not UTF-8, control characters (C0, DEL, C1, the line
// and paragraph separators), or characters that turn the direction of writing (they make a text look like
// another). "byte 0x85 is not UTF-8"; empty where nothing is wrong.
std::string flaw(std::string_view text);

// One line of a terminal: what flaw() names is shown as \n, \x1b, \x{202e}.
std::string for_terminal(std::string_view text);

// HTML, as text or in a quoted attribute.
std::string for_html(std::string_view text);

// Markdown, also in a cell of a table or as a paragraph: nothing in it is markup, a link, a formula or a list, nothing
// ends the line.
std::string for_markdown(std::string_view text);

// A gnuplot script: between single quotes, or in a comment. An apostrophe becomes a typographic one:
// gnuplot 5.4 takes a doubled one for the end of the text where it begins the text or follows another.
std::string for_gnuplot(std::string_view text);

// A field of a CSV file (RFC 4180), quoted where it has to be; on one line. What a spreadsheet would compute (=, +, -, @
// at the beginning of a cell, of one after a semicolon too) gets an apostrophe before it; numbers stay.
std::string for_csv(std::string_view text);

// The characters that XML 1.0 has; what writes the document escapes its markup.
std::string for_xml(std::string_view text);

// A message of a GitHub workflow command, or one of its properties (file=..., title=...).
std::string for_github(std::string_view text);
std::string for_github_property(std::string_view text);

// One word of a POSIX shell, quoted where it has to be.
std::string for_shell(std::string_view text);

}  // namespace elastocheck::reports
