// Mistakes in a valid text, and the messages with which they are refused: one file for each text.
//
//   # a heading
//   - text        occurs once in the valid text; a case may change it in several places
//   + text        its replacement
//   ! text        instead: the whole text
//   = message     after "FILE:", or "accepted"; this line ends the case
//   ~ part        or: a part of the message
//
// The texts are `unescaped`.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/escapes.hpp"

namespace elastocheck::support {

// `text` with the only occurrence of `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from << " is not in the text";
    EXPECT_EQ(text.find(from, at + 1), std::string::npos) << from << " is there twice";
    if (at != std::string::npos) text.replace(at, from.size(), to);
    return text;
}

struct Mistake {
    int line = 0;  // of its message in the file of mistakes
    std::string text, message;
    bool is_part = false;  // of the message
};

inline std::vector<Mistake> mistakes_in(const std::filesystem::path& file,
                                        const std::string& valid) {
    std::vector<Mistake> mistakes;
    std::ifstream lines(file);
    Mistake mistake;
    mistake.text = valid;
    std::string line, right;
    for (int n = 1; std::getline(lines, line); ++n) {
        const char mark = line.empty() ? '#' : line.front();
        const std::string rest = line.size() < 2 ? "" : unescaped(std::string_view(line).substr(2));
        if (mark == '-') right = rest;
        if (mark == '+') mistake.text = replaced(mistake.text, right, rest);
        if (mark == '!') mistake.text = rest;
        if (mark != '=' && mark != '~') continue;
        mistakes.push_back({n, mistake.text, rest, mark == '~'});
        mistake.text = valid;
    }
    EXPECT_FALSE(mistakes.empty()) << file;
    return mistakes;
}

// `refusal` returns the message, or "accepted". The valid text must be accepted.
inline void expect_refusals(const std::filesystem::path& file, const std::string& valid,
                            const std::string& name,
                            const std::function<std::string(const std::string&)>& refusal) {
    EXPECT_EQ(refusal(valid), "accepted") << file;
    for (const Mistake& mistake : mistakes_in(file, valid)) {
        std::string said = refusal(mistake.text);
        if (said.starts_with(name + ":")) said.erase(0, name.size() + 1);
        if (mistake.is_part)
            EXPECT_NE(said.find(mistake.message), said.npos)
                << file << ":" << mistake.line << ": " << said;
        else
            EXPECT_EQ(said, mistake.message) << file << ":" << mistake.line;
    }
}

}  // namespace elastocheck::support
