// Facts about the scenes of tests/models/fixtures and models/scenes, in fixtures/*.facts.
#include "tests/models/facts.hpp"
#include "tests/support/folder.hpp"

namespace elastocheck {
namespace {

class ReaderFacts : public testing::TestWithParam<ReadClaim> {};

TEST_P(ReaderFacts, Hold) {
    const std::string& stem = GetParam().file;
    const auto own = std::filesystem::path(ELASTOCHECK_FIXTURES) / (stem + ".yaml");
    const auto file =
        exists(own) ? own : std::filesystem::path(ELASTOCHECK_SCENES) / own.filename();
    expect_facts(GetParam(), support::text_of(file), [&](const std::string& text, const auto& set) {
        return parse_scene(text, stem + ".yaml", set);
    });
}
INSTANTIATE_TEST_SUITE_P(Scenes, ReaderFacts,
                         testing::ValuesIn(claims_beside(ELASTOCHECK_FIXTURES)), name_of);

}  // namespace
}  // namespace elastocheck
