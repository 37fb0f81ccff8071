// Tyres act on the branches that move or hold their road (what they are: fixtures/tyres.facts).
#include <gtest/gtest.h>

#include <algorithm>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/branch.hpp"
#include "models/laws.hpp"
#include "tests/models/fixtures.hpp"

namespace elastocheck {
namespace {

const Curve& law_of(const Bushing& b) {
    return std::get<Curve>(std::get<PerAxis>(b.law).axis.at(2));
}

TEST(Tyre, IsActiveOnlyOnBranchesThatMoveItsRoad) {
    const Model model = compile(parse_scene(fixture("tyres"), "scene.yaml"));
    for (const Branch& branch : model.branches) {
        const Model here = on_branch(model, branch);
        for (const Elastic& elastic : here.elastics)
            if (elastic.name.starts_with("tyre")) {
                const bool is_away = elastocheck::is_zero(std::get<Bushing>(elastic.kind).law);
                EXPECT_EQ(is_away, branch.name == "load") << branch.name;
            }
    }
}

TEST(Tyre, IsActiveOnABranchThatHoldsItsRoad) {
    const Scene scene = parse_scene(
        replaced(fixture("tyre"), "branches: {bump: {drive: tyres.tyre.road, to: 0.05, steps: 5}}",
                 "loads: {push: {on: hub, at: hub, force: [0, 0, 1]}}\n"
                 "branches: {up: {load: push, to: 50, steps: 5, hold: {tyres.tyre.road: 0}}}"),
        "scene.yaml");
    for (const Detail detail : {Detail::required, Detail::everything}) {
        const Model model = compile(scene, detail);
        const Model here = on_branch(model, model.branches.at(0));
        const auto tyre = std::ranges::find(here.elastics, "tyre", &Elastic::name);
        ASSERT_NE(tyre, here.elastics.end());
        EXPECT_EQ(law_of(std::get<Bushing>(tyre->kind)).pieces.at(0)[1], 200e3);
    }
}

}  // namespace
}  // namespace elastocheck
