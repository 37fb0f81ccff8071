// Forward sensitivity of a state to small disturbances: three legs, each by its own tangent.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>

#include "compare/comparison/legs.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/trim.hpp"
#include "recursive/linear_response.hpp"
#include "reference/energy/linear_response.hpp"
#include "reference/equilibrium/linear_response.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/slopes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using support::at_wheel, support::poses_only, support::SideModel, support::side_named;
using Disturbances = std::vector<Disturbance>;

struct Answering {
    std::string name;
    std::function<Response(const SideModel&, const Equilibrium&, const Disturbances&)>
        linear_response;
};
Answering recursion(const char* method) {
    return {method,
            [method](const SideModel& side, const Equilibrium& state, const Disturbances& what) {
                return recursive::linear_response(side.model, side.branch, poses_only(state), what,
                                                  recursive::find_method(method).value());
            }};
}
const Answering by_equilibrium{
    "equilibrium",
    [](const SideModel&side, const Equilibrium&state, const Disturbances&what) {
        return reference::equilibrium::linear_response(side.model, side.branch, poses_only(state),
                                                       what);
    }},
    by_energy{"energy", [](const SideModel&side, const Equilibrium&state, const Disturbances&what) {
                  return reference::energy::linear_response(side.model, side.branch,
                                                            poses_only(state), what);
              }};
std::vector<Answering> three_legs() { return {by_equilibrium, by_energy, recursion("series")}; }

Equilibrium state_at(const SideModel& side, double a) {
    const auto path = reference::equilibrium::solve(side.model, side.branch, std::vector{a});
    EXPECT_EQ(path.outcome, Outcome::converged) << path.detail;
    return path.points.back();
}

// Forces and moments on every body, off its origin, and every offset that can be moved. The idle
// spin of the paper's strut is excluded.
struct Asked {
    Disturbances forces, moments, offsets;
};
Asked everything(const Model& model) {
    Asked all;
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        if (model.bodies[b].name == "strut") continue;
        const Point at{static_cast<BodyId>(b), {0.1, -0.05, 0.2}};
        for (int k = 0; k < 3; ++k) {
            all.forces.push_back(UnitWrench{at, Vector3d::Unit(k)});
            all.moments.push_back(UnitWrench{at, Vector3d::Zero(), Vector3d::Unit(k)});
        }
    }
    for (std::size_t j = 0; j < model.joints.size(); ++j)
        if (model.joints[j].driven >= 0) all.offsets.push_back(Motion{static_cast<int>(j)});
    return all;
}

// Relative to the largest entry, at least 1e-6 m per unit (1 kN/mm); rotations times half a metre.
// Infinite for a failed response.
double distance(const Response& a, const Response& b) {
    if (a.outcome != Outcome::converged || b.outcome != Outcome::converged) return INFINITY;
    if (a.increments.size() != b.increments.size()) return INFINITY;
    double size = 1e-6, difference = 0;
    for (std::size_t k = 0; k < a.increments.size(); ++k)
        for (std::size_t i = 0; i < a.increments[k].size(); ++i) {
            const Increment &x = a.increments[k][i], &y = b.increments[k][i];
            size = std::max({size, y.dr.norm(), y.dpi.norm() / 2});
            const double worst = std::max((x.dr - y.dr).norm(), (x.dpi - y.dpi).norm() / 2);
            if (!(worst <= difference)) difference = worst;
        }
    return difference / size;
}

TEST(Response, LegsAgreeAtTheStartAndEndOfEveryScene) {
    int answered = 0;
    double worst = 0;
    for (const auto& name : support::scene_names()) {
        const Model model = compile(trim(support::scene(name)).scene);
        for (const auto& branch : model.branches)
            for (const auto& [side_name, on_side, side, analysis] : sides_of(model, branch, 1))
                for (const double a : {0.0, side.to}) {
                    const SideModel here{on_side, side};
                    const Equilibrium state = state_at(here, a);
                    const auto& [forces, moments, offsets] = everything(on_side);
                    for (const auto* requested : {&forces, &moments, &offsets}) {
                        const Response truth =
                            by_equilibrium.linear_response(here, state, *requested);
                        for (const auto& other :
                             {by_energy, recursion("series"), recursion("tangent")}) {
                            const Response response =
                                other.linear_response(here, state, *requested);
                            if (is_not_applicable(response.outcome)) continue;
                            const double far = distance(response, truth);
                            EXPECT_LE(far, 1e-10)
                                << name << ", " << side_name << ", at " << a << ": " << other.name
                                << " " << response.detail << truth.detail;
                            worst = std::max(worst, far);
                            ++answered;
                        }
                    }
                }
    }
    EXPECT_GT(answered, 2000);
    RecordProperty("worst", fmt::format("{:.1e}", worst));
}

TEST(Response, PublishedMatrixIsExactWithoutLoadAndLacksGeometricStiffnessUnderLoad) {
    for (const char* name : {"bushing_pair", "pinned_bar", "chrono_mcpherson", "two_spring_arch"}) {
        const Scene scene = support::scene(name);
        const SideModel side = side_named(scene, scene.branches[0].name, scene.branches[0].to);
        const auto forces = everything(side.model).forces;
        for (const double a : {0.0, side.branch.to}) {
            const Equilibrium state = state_at(side, a);
            const double far = distance(recursion("published").linear_response(side, state, forces),
                                        by_equilibrium.linear_response(side, state, forces));
            if (a == 0)
                EXPECT_LE(far, 1e-12) << name;
            else
                EXPECT_GT(far, 1e-3) << name;
        }
    }
}

// ---- Reciprocity: 6 × 6 compliance of the contact patch under wrenches there.

MatrixXd compliance(const SideModel& side, const Equilibrium& state, const Answering& leg) {
    const Wheel& wheel = side.model.wheels[0];
    const Point centre{wheel.body, wheel.centre_local};
    Disturbances wrenches;
    for (int k = 0; k < 3; ++k)
        wrenches.push_back(UnitWrench{centre, Vector3d::Unit(k), Vector3d::Zero()});
    for (int k = 0; k < 3; ++k)
        wrenches.push_back(UnitWrench{centre, Vector3d::Zero(), Vector3d::Unit(k)});
    const Response response = leg.linear_response(side, state, wrenches);
    EXPECT_EQ(response.outcome, Outcome::converged) << response.detail;
    const auto body = static_cast<std::size_t>(wheel.body);
    const Vector3d lever = state.poses[body].p * wheel.centre_local;
    MatrixXd C(6, 6);
    for (std::size_t k = 0; k < 6; ++k) {
        const Increment& by = response.increments[k][body];
        C.col(static_cast<Eigen::Index>(k)) << by.dr + by.dpi.cross(lever), by.dpi;
    }
    return C;
}
// Moments over half a metre, so that all is m/N.
MatrixXd in_one_unit(const MatrixXd& C) {
    Eigen::VectorXd L = Eigen::VectorXd::Constant(6, 1);
    L.tail(3).setConstant(0.5);
    return L.asDiagonal() * C * L.asDiagonal();
}
double largest(const MatrixXd& C) { return C.cwiseAbs().maxCoeff(); }

TEST(Response, ComplianceIsSymmetricUnderDeadForces) {
    for (const char* name :
         {"mcpherson_strut", "double_wishbone", "front_axle", "semi_trailing_arm"}) {
        const Scene scene = support::scene(name);
        for (const char* branch : {"lateral", "traction"}) {  // a brake has no potential
            const SideModel side = side_named(scene, branch, 1);
            const Equilibrium state = state_at(side, side.branch.to);
            for (const auto& leg : three_legs()) {
                const MatrixXd C = in_one_unit(compliance(side, state, leg));
                EXPECT_LE(largest(C - C.transpose()), 1e-10 * largest(C))
                    << name << ", " << branch << ", " << leg.name;
            }
        }
    }
}

// The work of a dead moment m depends on the path: its body's balance ∂(...)/∂π has an
// antisymmetric part -½ m̃, so that K - Kᵀ = -m̃ there and, C being the inverse,
//
//   C - Cᵀ = C (Kᵀ - K) Cᵀ = C_π m̃ C_πᵀ,   C_π the responses to moments on that body
TEST(Response, AsymmetryOfComplianceIsTheTermOfTheDeadMoment) {
    const SideModel side = side_named(support::scene("double_wishbone"), "aligning", 1);
    const Equilibrium state = state_at(side, side.branch.to);
    const Vector3d m(0, 0, side.branch.to);
    Matrix3d skew;
    skew << 0, -m.z(), m.y(), m.z(), 0, -m.x(), -m.y(), m.x(), 0;
    for (const auto& leg : three_legs()) {
        const MatrixXd C = compliance(side, state, leg), C_pi = C.rightCols<3>();
        const MatrixXd lacks = in_one_unit(C - C.transpose());
        EXPECT_GT(largest(lacks), 1e-5 * largest(in_one_unit(C))) << leg.name;
        EXPECT_LE(largest(lacks - in_one_unit(C_pi * skew * C_pi.transpose())),
                  1e-8 * largest(lacks))
            << leg.name;
    }
}

// ---- Invariance.

// Wrenches at the wheel, and the responses of all bodies.
Response at_the_wheel(const SideModel& side, const Equilibrium& state, const Answering& leg,
                      const Quaterniond& R) {
    Disturbances wrenches;
    for (int k = 0; k < 3; ++k) {
        wrenches.push_back(at_wheel(side.model, R * Vector3d::Unit(k)));
        wrenches.push_back(at_wheel(side.model, Vector3d::Zero(), R * Vector3d::Unit(k)));
    }
    return leg.linear_response(side, state, wrenches);
}

TEST(Response, GroundFrameOrderOfBodiesAndUnitsDoNotChangeTheResponse) {
    const Quaterniond R(Eigen::AngleAxisd(1.1, Vector3d(1, -2, 0.5).normalized()));
    const Vector3d t(3, -1, 2);
    for (const char* name : {"chrono_mcpherson_preload", "chrono_mcpherson"}) {
        const Scene scene = support::scene(name);
        const SideModel side = side_named(scene, "jounce", 1);
        const Equilibrium state = state_at(side, side.branch.to);
        for (const auto& leg : three_legs()) {
            const Response as_told = at_the_wheel(side, state, leg, Quaterniond::Identity());

            Equilibrium turned = state;
            for (Pose& pose : turned.poses) pose = {R * pose.r + t, R * pose.p};
            Response back =
                at_the_wheel(side_named(support::moved(scene, R, t), "jounce", 1), turned, leg, R);
            for (auto& increments : back.increments)
                for (Increment& body : increments)
                    body = {R.conjugate() * body.dr, R.conjugate() * body.dpi};
            EXPECT_LE(distance(back, as_told), 1e-10)
                << name << ", " << leg.name << ": another ground frame";

            Equilibrium other_way_round = state;
            std::ranges::reverse(other_way_round.poses);
            back = at_the_wheel(side_named(support::reversed(scene), "jounce", 1), other_way_round,
                                leg, Quaterniond::Identity());
            for (auto& increments : back.increments) std::ranges::reverse(increments);
            EXPECT_LE(distance(back, as_told), 1e-10) << name << ", " << leg.name << ": reversed";
        }
    }
    const Scene scene = support::scene("semi_trailing_arm"),
                in_mm = support::in_millimetres_and_kilonewtons("semi_trailing_arm");
    const SideModel side = side_named(scene, "travel", 1), other = side_named(in_mm, "travel", 1);
    const Equilibrium state = state_at(side, side.branch.to);
    const auto forces = everything(side.model).forces;
    for (const auto& leg : three_legs())
        EXPECT_LE(distance(leg.linear_response(other, state, forces),
                           leg.linear_response(side, state, forces)),
                  1e-10)
            << leg.name;
}

TEST(Response, SeriesAndEquilibriumLegAgreeWhereNoEnergyExists) {
    for (const auto& [name, branch] :
         {std::pair("follower", "up"), std::pair("bushing_by_small_angles", "pull")}) {
        const SideModel side = side_named(support::scene(name), branch, 1);
        const Equilibrium state = state_at(side, side.branch.to);
        const auto forces = everything(side.model).forces;
        EXPECT_EQ(by_energy.linear_response(side, state, forces).outcome,
                  Outcome::not_conservative);
        EXPECT_LE(distance(recursion("series").linear_response(side, state, forces),
                           by_equilibrium.linear_response(side, state, forces)),
                  1e-12)
            << name;
    }
}

}  // namespace
}  // namespace elastocheck::compare
