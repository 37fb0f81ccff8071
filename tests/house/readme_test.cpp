// What the README shows is there: the program that is built, the references that a workflow checks out.
#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "tests/support/command.hpp"

namespace {

using elastocheck::support::Said;
using elastocheck::support::says;
using elastocheck::support::text_of;

const std::string root = ELASTOCHECK_ROOT;

// What stands between fences of a language.
std::vector<std::string> blocks(const std::string& page, const std::string& language) {
    const std::string open = "```" + language + "\n";
    std::vector<std::string> all;
    for (auto at = page.find(open); at != page.npos; at = page.find(open, at + 1)) {
        const auto begin = at + open.size();
        all.push_back(page.substr(begin, page.find("```\n", begin) - begin));
    }
    return all;
}

TEST(Readme, ItsProgramsAreThoseThatAreBuiltAndRun) {
    const auto programs = blocks(text_of(root + "/README.md"), "cpp");
    ASSERT_EQ(programs.size(), 2u);
    EXPECT_EQ(programs[0], text_of(root + "/tests/package/candidate/main.cpp"));
    EXPECT_EQ(programs[1], text_of(root + "/tests/package/example/main.cpp"));
}

TEST(Readme, WhatItsWorkflowChecksOutIsThere) {
    const std::string git = "git -c safe.directory='*' -C '" + root + "' ";
    if (says(git + "rev-parse --show-prefix").out != "\n") GTEST_SKIP() << "not a checkout of its own";
    if (says(git + "rev-parse --is-shallow-repository").out != "false\n")
        GTEST_SKIP() << "a checkout without history";
    const std::string page = text_of(root + "/README.md");
    static const std::regex reference("\\bref: ([^ ,}\n]+)");
    int references = 0;
    for (std::sregex_iterator at(page.begin(), page.end(), reference), end; at != end; ++at, ++references) {
        const std::string name = (*at)[1];
        bool there = false;
        for (const std::string place : {"", "origin/"})
            there = there || says(git + "rev-parse --verify -q '" + place + name + "^{commit}'").code == 0;
        EXPECT_TRUE(there) << "ref: " << name;
    }
    EXPECT_GT(references, 0);
}

}  // namespace
