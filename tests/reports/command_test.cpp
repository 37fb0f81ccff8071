// Definitions of outputs in the READMEs and in the command.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/reports/command.hpp"

namespace elastocheck {
namespace {

// Definitions of outputs have one source: README, inspect and result.json agree.
TEST(Command, ReadmeHasTheDefinitionsOfInspect) {
    const std::string readme = text_of(scenes + "/../../reports/README.md") +
                               text_of(scenes + "/../../compare/outputs/catalogue/README.md");
    int rows = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scenes)) {
        if (entry.path().extension() != ".yaml") continue;
        const auto part = nlohmann::json::parse(
            run_elastocheck("inspect --json " + entry.path().string()).out)["scenes"][0];
        for (const auto& row : part["results"][0]["tables"]["outputs"]["rows"]) {
            ++rows;
            std::string means = row[2];
            if (means.starts_with("such as: ")) means = means.substr(9);
            // Only names of the scene and axes differ.
            means = std::regex_replace(means, std::regex("^position of '[^']+'"),
                                       "position of the probe");
            means = std::regex_replace(means, std::regex("joint '[^']+' on ('[^']+'|ground)"),
                                       "the joint on its first body");
            means = std::regex_replace(means, std::regex("moves '[^']+'"), "moves the joint");
            means = std::regex_replace(means, std::regex("(spring|damper) '[^']+'"), "$1");
            means = std::regex_replace(means, std::regex("ground axis [xyz](, positive [a-z ]+)?"),
                                       "ground axis");
            EXPECT_TRUE(contains(readme, means))
                << "neither README says: " << means << "\nof " << row;
        }
    }
    EXPECT_GT(rows, 50);
}

}  // namespace
}  // namespace elastocheck
