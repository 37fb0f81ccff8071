// Formatting of numbers for readers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace elastocheck::reports {

// `digits` significant digits, and all before the decimal point; a true minus sign; powers of ten:
// "2.91", "−0.0018", "2.6 × 10⁻¹³". A dash for a value that is not finite.
std::string number(double value, int digits = 3);
std::string signed_number(double value, int digits = 3);  // with a plus

// The number at the start of a text, with a decimal point in any locale. NaN without one.
double parsed_number(std::string_view text);
// The finite number that a word is, likewise, also with a plus.
std::optional<double> finite_number(std::string_view word);

// Up to four significant digits, as few as needed: "−80", "21.33".
std::string short_number(double value);

// With its sign; 0 for values below 1e-9 of a mm, deg, N or N·m, which are rounding.
std::string deviation_number(double value);

// "2.9 %" of 0.029; two significant digits, "< 0.001 %" for less.
std::string percent(double share);

std::string whole_number(long value);  // "12 345", with narrow spaces

// Two significant digits and the unit, kept on one line: "0.0018 deg".
std::string quantity(double value, std::string_view unit);
std::string setting(double value, std::string_view unit);  // as entered by the user: "0.01 mm"

}  // namespace elastocheck::reports
