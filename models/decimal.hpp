// Reads a decimal number from text in any locale: std::from_chars, also where the standard library
// has it for integers only (libc++ 19, the library of the page's WebAssembly).
#pragma once

#include <charconv>
#include <version>
#ifndef __cpp_lib_to_chars
#include <cerrno>
#include <cstdlib>
#include <string>
#endif

namespace elastocheck {

// As std::from_chars(first, last, value) for a double in decimal notation.
inline std::from_chars_result read_decimal(const char* first, const char* last, double& value) {
#ifdef __cpp_lib_to_chars
    return std::from_chars(first, last, value);
#else
    // strtod of the C locale rounds correctly; unlike from_chars it takes blanks, a plus sign and
    // hexadecimal digits.
    const std::string text(first, last);
    const std::size_t digits = text.starts_with('-') ? 1 : 0;
    if (text.size() == digits || text[digits] == '+' || text[digits] == '-' || text[digits] <= ' ')
        return {first, std::errc::invalid_argument};
    const std::string plain = text.substr(0, text.find_first_of("xX"));
    char* stop = nullptr;
    errno = 0;
    const double read = std::strtod(plain.c_str(), &stop);
    if (stop == plain.c_str()) return {first, std::errc::invalid_argument};
    const char* const end = first + (stop - plain.c_str());
    if (errno == ERANGE) return {end, std::errc::result_out_of_range};
    value = read;
    return {end, std::errc{}};
#endif
}

}  // namespace elastocheck
