// Text with escapes, from files with one text a line.
#pragma once

#include <string>
#include <string_view>

namespace elastocheck::support {

// \n, \t, \\ and \xNN stand for bytes, as in C++.
inline std::string unescaped(std::string_view line) {
    std::string text;
    for (std::size_t k = 0; k < line.size(); ++k) {
        const char next = line[k] == '\\' ? line[++k] : '\0';
        if (next == 'x') {
            text += static_cast<char>(std::stoi(std::string(line.substr(k + 1, 2)), nullptr, 16));
            k += 2;
        } else {
            text += next == 'n' ? '\n' : next == 't' ? '\t' : line[k];
        }
    }
    return text;
}

}  // namespace elastocheck::support
