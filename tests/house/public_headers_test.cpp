// The installed headers: at most fifteen, which include only each other, the standard
// library and Eigen.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "tests/support/command.hpp"

namespace {

namespace fs = std::filesystem;
using elastocheck::support::text_of;

const fs::path public_headers = fs::path(ELASTOCHECK_ROOT) / "include";

TEST(PublicHeaders, PublicHeadersAreFewAndIncludeNoInternalOnes) {
    std::set<std::string> headers;
    for (const auto& entry : fs::recursive_directory_iterator(public_headers))
        if (entry.is_regular_file()) headers.insert(fs::relative(entry.path(), public_headers));
    EXPECT_FALSE(headers.empty());
    EXPECT_LE(headers.size(), 16u);

    static const std::regex include(R"(^\s*#\s*include\s*(["<])([^">]+)[">])");
    static const std::regex standard("[a-z_]+");
    for (const std::string& header : headers) {
        std::istringstream lines(text_of(public_headers / header));
        std::smatch match;
        for (std::string line; std::getline(lines, line);)
            if (std::regex_search(line, match, include)) {
                const std::string target = match[2];
                EXPECT_TRUE(match[1] == "\"" ? headers.contains(target)
                                             : std::regex_match(target, standard) ||
                                                   target.starts_with("Eigen/"))
                    << header << " includes " << target;
            }
    }
}

}  // namespace
