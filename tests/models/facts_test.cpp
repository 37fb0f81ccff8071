// Facts about the scenes of tests/models/fixtures and models/scenes, in fixtures/*.facts.
#include "tests/models/facts.hpp"

#include "tests/models/fixtures.hpp"

namespace elastocheck {
namespace {

std::vector<ReadClaim> all_claims() {
    std::vector<ReadClaim> all;
    for (const auto& entry : std::filesystem::directory_iterator(ELASTOCHECK_FIXTURES))
        if (entry.path().extension() == ".facts")
            for (auto& claim : claims_in(entry.path())) all.push_back(std::move(claim));
    return all;
}

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
INSTANTIATE_TEST_SUITE_P(Scenes, ReaderFacts, testing::ValuesIn(all_claims()),
                         [](const auto& one) { return one.param.file + "_" + one.param.name; });

}  // namespace
}  // namespace elastocheck
