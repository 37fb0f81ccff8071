#include "reports/text/numbers.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

namespace elastocheck::reports {
namespace {

constexpr const char* dash = "–";
constexpr const char* minus = "−";
constexpr const char* narrow_space = "\u202f";  // no line break
constexpr const char* solid_space = "\u00a0";   // no line break

std::string raised(int exponent) {
    constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text;
    for (const char c : std::to_string(exponent)) text.append(c == '-' ? "⁻" : digits[c - '0']);
    return text;
}

// A positive number: digits without exponent where short, else mantissa and power of ten.
std::string magnitude(double value, int digits) {
    const std::string scientific = fmt::format("{:.{}e}", value, digits - 1);
    const auto e = scientific.find('e');
    const int exponent = std::stoi(scientific.substr(e + 1));
    if (exponent >= -4 && exponent < 6)
        return fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent));
    return fmt::format("{}{}×{}10{}", scientific.substr(0, e), solid_space, solid_space,
                       raised(exponent));
}

}  // namespace

std::string number(double value, int digits) {
    if (!std::isfinite(value)) return dash;
    if (value == 0) return "0";
    return fmt::format("{}{}", value < 0 ? minus : "", magnitude(std::abs(value), digits));
}

std::string signed_number(double value, int digits) {
    return fmt::format("{}{}", std::isfinite(value) && value > 0 ? "+" : "", number(value, digits));
}

double parsed_number(std::string_view text) {
    double value = std::numeric_limits<double>::quiet_NaN();
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

std::optional<double> finite_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);  // from_chars rejects a plus
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool whole = error == std::errc{} && end == word.data() + word.size();
    return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string short_number(double value) {
    int digits = 1;
    while (digits < 4 && parsed_number(fmt::format("{:.{}e}", value, digits - 1)) !=
                             parsed_number(fmt::format("{:.3e}", value)))
        ++digits;
    return std::isfinite(value) ? number(value, digits) : dash;
}

std::string deviation_number(double value) {
    return std::abs(value) < 1e-9 ? "0" : signed_number(value);
}

std::string percent(double share) {
    if (!std::isfinite(share)) return dash;
    const double size = 100 * std::abs(share);
    if (size == 0) return fmt::format("0{}%", solid_space);
    if (size < 0.001) return fmt::format("< 0.001{}%", solid_space);
    if (size > 1000) return fmt::format("{}1000{}%", share < 0 ? "< −" : "> ", solid_space);
    return fmt::format("{}{}{}%", share < 0 ? minus : "",
                       size < 100 ? number(size, 2) : fmt::format("{:.0f}", size), solid_space);
}

std::string whole_number(long value) {
    const std::string digits = std::to_string(std::abs(value));
    std::string text = value < 0 ? minus : "";
    for (std::size_t k = 0; k < digits.size(); ++k) {
        if (k > 0 && (digits.size() - k) % 3 == 0) text.append(narrow_space);
        text.push_back(digits[k]);
    }
    return text;
}

std::string quantity(double value, std::string_view unit) {
    return fmt::format("{}{}{}", number(value, 2), solid_space, unit);
}

std::string setting(double value, std::string_view unit) {
    return value >= 1e-4 ? fmt::format("{:g}{}{}", value, solid_space, unit)
                         : quantity(value, unit);
}

}  // namespace elastocheck::reports
