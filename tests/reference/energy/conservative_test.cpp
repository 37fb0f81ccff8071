// Systems without energy: the energy leg reports not_conservative and names the load or bushing.
#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Vector3d;

constexpr const char* scenes[] = {"single_bushing", "mcpherson"};

void expect_named(const Model& model, const Branch& branch, const std::string& name,
                  bool conservative) {
    const double values[] = {0, branch.to};
    const auto path = solve(model, branch, values);
    const Equilibrium as_drawn{.load = 0,
                               .poses =
                                   [&] {
                                       std::vector<Pose> poses;
                                       for (const auto& body : model.bodies)
                                           poses.push_back(body.design);
                                       return poses;
                                   }(),
                               .reactions = {}};
    const Residuals judged = residuals(model, branch, as_drawn);
    EXPECT_TRUE(std::isfinite(judged.length) && std::isfinite(judged.direction)) << name;
    EXPECT_EQ(std::isfinite(judged.force), conservative) << name;
    EXPECT_EQ(std::isfinite(judged.moment), conservative) << name;
    if (conservative) {
        EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    } else {
        EXPECT_EQ(path.outcome, Outcome::not_conservative) << path.detail;
        EXPECT_TRUE(path.points.empty());
        EXPECT_NE(path.detail.find("'" + name + "'"), std::string::npos) << path.detail;
        EXPECT_NE(path.detail.find("'" + branch.name + "'"), std::string::npos) << path.detail;
    }
}

TEST(MissingPotential, FollowerLoadThatActsIsNamedAsTheCause) {
    for (const char* scene : scenes) {
        const Model good = compile(scene_named(scene));
        const Branch branch = good.branches[0];
        const LoadKind followers[] = {FollowerForce{{0}, Vector3d::UnitX()},
                                      FollowerMoment{0, Vector3d::UnitX()}};
        for (const auto& kind : followers) {
            Model model = good;
            model.static_loads.push_back({"chaser", kind});
            expect_named(model, branch, "chaser", false);
            for (const auto& [start, rate] : {std::pair{0.0, 1.0}, {1.0, 0.0}, {0.0, 0.0}}) {
                Branch driven = branch;
                driven.drivers.push_back({Load{"chaser", kind}, start, rate});
                expect_named(good, driven, "chaser", start == 0 && rate == 0);
            }
        }
        Model still = good;
        still.static_loads.push_back({"on ground", FollowerForce{{ground}, Vector3d::UnitX()}});
        still.static_loads.push_back({"nothing", FollowerMoment{0, Vector3d::Zero()}});
        expect_named(still, branch, "", true);
    }
}

TEST(MissingPotential, BushingFormulationWithoutEnergyIsNamedAsTheCause) {
    for (const char* scene : scenes) {
        const Model good = compile(scene_named(scene));
        for (const bool conjugate : {true, false}) {
            Model model = good;
            std::string name;
            for (auto& elastic : model.elastics) {
                auto* bushing = std::get_if<Bushing>(&elastic.kind);
                if (!bushing) continue;
                name = elastic.name;
                bushing->formulation.conjugate = conjugate;
                bushing->formulation.offset_moment = !conjugate;
                break;
            }
            expect_named(model, good.branches[0], name, false);
        }
    }
}

TEST(MissingPotential, BushingWithoutForceIsNeverTheCause) {
    Model model = compile(scene_named("single_bushing"));
    Bushing nothing{Marker{0}, Marker{ground}, PerAxis{}};
    nothing.formulation.conjugate = false;
    model.elastics.push_back({"nothing", nothing});
    Branch branch = model.branches[0];
    expect_named(model, branch, "nothing", true);
    branch.drivers.push_back(
        {Preload{static_cast<int>(model.elastics.size()) - 1, Vector6::Unit(2)}, 0, 1e-3});
    expect_named(model, branch, "nothing", false);
}

}  // namespace
}  // namespace elastocheck::reference::energy
