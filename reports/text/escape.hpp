// Escaping of text for each output language. Every external text (names in a scene, a result.json
// or a baseline, file names) passes exactly one of these functions on output: that of the target
// language. All except for_shell return valid UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace elastocheck::reports {

// Reason why a text is not accepted as a name: bytes that are not UTF-8, control characters (C0,
// DEL, C1, the line and paragraph separators), or characters that change the writing direction,
// which can disguise a text. "byte 0x85 is not UTF-8"; empty if the text is accepted.
std::string flaw(std::string_view text);

// One line of a terminal: characters named by flaw() are shown as \n, \x1b, \x{202e}.
std::string for_terminal(std::string_view text);

// HTML, as text or in a quoted attribute.
std::string for_html(std::string_view text);

// JSON as the content of a script element in HTML: it cannot end the element.
std::string for_script(std::string_view json);

// Markdown, also in a table cell or as a paragraph: without markup, links, formulas, line breaks.
std::string for_markdown(std::string_view text);

// A field of a CSV file (RFC 4180), quoted where necessary; on one line. A text that a spreadsheet
// would evaluate (=, +, -, @ at the beginning of a cell, also after a comma or semicolon) gets an apostrophe
// before it; numbers are unchanged.
std::string for_csv(std::string_view text);

// XML 1.0 (SVG, JUnit), as text or in a double-quoted attribute.
std::string for_xml(std::string_view text);

// A message of a GitHub workflow command, or one of its properties (file=..., title=...).
std::string for_github(std::string_view text);
std::string for_github_property(std::string_view text);

// One word of a POSIX shell, quoted where necessary.
std::string for_shell(std::string_view text);

}  // namespace elastocheck::reports
