#include "reports/numbers.hpp"

#include <fmt/format.h>

#include <cmath>

namespace elastocheck::reports {
namespace {

constexpr const char* dash = "–";
constexpr const char* minus = "−";
constexpr const char* thin_space = " ";

std::string raised(int exponent) {
    constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text;
    for (const char c : std::to_string(exponent)) text.append(c == '-' ? "⁻" : digits[c - '0']);
    return text;
}

// Of a positive number: digits without exponent where that is short, else a mantissa and a power of ten.
std::string magnitude(double value, int digits) {
    const std::string scientific = fmt::format("{:.{}e}", value, digits - 1);
    const auto e = scientific.find('e');
    const int exponent = std::stoi(scientific.substr(e + 1));
    if (exponent >= -4 && exponent < 6)
        return fmt::format("{:.{}f}", value, std::max(0, digits - 1 - exponent));
    return fmt::format("{} × 10{}", scientific.substr(0, e), raised(exponent));
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

std::string deviation_number(double value) { return std::abs(value) < 1e-9 ? "0" : signed_number(value); }

std::string percent(double share) {
    if (!std::isfinite(share)) return dash;
    const double size = 100 * std::abs(share);
    if (size == 0) return "0 %";
    if (size < 0.001) return "< 0.001 %";
    return fmt::format("{}{} %", share < 0 ? minus : "",
                       size < 100 ? number(size, 2) : fmt::format("{:.0f}", size));
}

std::string whole_number(long value) {
    const std::string digits = std::to_string(std::abs(value));
    std::string text = value < 0 ? minus : "";
    for (std::size_t k = 0; k < digits.size(); ++k) {
        if (k > 0 && (digits.size() - k) % 3 == 0) text.append(thin_space);
        text.push_back(digits[k]);
    }
    return text;
}

}  // namespace elastocheck::reports
