// Messages of the scene reader: mistakes in the scenes of tests/models/fixtures.
#include <gtest/gtest.h>

#include "tests/models/fixtures.hpp"

namespace elastocheck {
namespace {

std::string refusal(const std::string& text, const std::string& name) {
    try {
        parse_scene(text, name);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Mistakes, MistakeInASceneIsRejectedWithItsPlaceAndTheAllowedValues) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(ELASTOCHECK_FIXTURES)) {
        if (entry.path().extension() != ".mistakes") continue;
        ++files;
        const std::string stem = entry.path().stem(), name = stem + ".yaml";
        support::expect_refusals(entry.path(), fixture(stem), name,
                                 [&](const std::string& text) { return refusal(text, name); });
    }
    EXPECT_GT(files, 10);
}

TEST(Mistakes, TooDeeplyNestedOrTooLargeSceneIsRefused) {
    std::string nested;
    for (int n = 0; n < 100'000; ++n) nested += "- ";
    EXPECT_EQ(refusal(nested, "a.yaml"), "a.yaml:1: nested more than 16 levels deep");
    EXPECT_EQ(refusal(std::string((1 << 20) + 1, '#'), "a.yaml"),
              "a.yaml: larger than 1 MiB, the limit for a scene");
}

}  // namespace
}  // namespace elastocheck
