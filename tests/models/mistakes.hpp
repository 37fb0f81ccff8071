// Fixture: one change to a valid text and the exact error message.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "elastocheck/read_scene.hpp"
#include "tests/models/bench_scene.hpp"

namespace elastocheck {

struct OneMistake {
    std::string right;    // occurs once in the text
    std::string wrong;    // its replacement
    std::string message;  // after "scene.yaml:LINE: "
};

inline std::string complaint_of(const std::string& text) {
    try {
        parse_scene(text, "scene.yaml");
    } catch (const SceneError& error) {
        const std::string what = error.what();
        return what.substr(what.find(": ") + 2);
    }
    return "none";
}

inline void expect_complaints(const std::string& text, const std::vector<OneMistake>& mistakes) {
    EXPECT_EQ(complaint_of(text), "none");
    for (const auto& [right, wrong, message] : mistakes)
        EXPECT_EQ(complaint_of(replaced(text, right, wrong)), message) << right << " -> " << wrong;
}

}  // namespace elastocheck
