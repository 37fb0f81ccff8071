// Sensitivity of states to the numbers of a model: three legs, each by its own derivation, along
// random changes of every number at once.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "compare/comparison/legs.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"
#include "models/branch.hpp"
#include "models/kinds.hpp"
#include "models/rates/fields.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "recursive/linear_response.hpp"
#include "recursive/sensitivity.hpp"
#include "reference/energy/linear_response.hpp"
#include "reference/energy/sensitivity.hpp"
#include "reference/equilibrium/linear_response.hpp"
#include "reference/equilibrium/sensitivity.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/slopes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;
using support::OneWay;

struct Answering {
    std::string name;
    Leg leg;
    std::function<StateRate(const OneWay&, const Equilibrium&, const Model& rate)> sensitivity;
};
std::vector<Answering> three_legs() {
    return {{"equilibrium", Leg::equilibrium,
             [](const OneWay& way, const Equilibrium& state, const Model& rate) {
                 return reference::equilibrium::sensitivity(way.model, way.branch, state,
                                                            {&rate, 1})
                     .front();
             }},
            {"energy", Leg::energy,
             [](const OneWay& way, const Equilibrium& state, const Model& rate) {
                 return reference::energy::sensitivity(way.model, way.branch, state, {&rate, 1})
                     .front();
             }},
            {"recursion", Leg::series,
             [](const OneWay& way, const Equilibrium& state, const Model& rate) {
                 return recursive::sensitivity(way.model, way.branch, state, {&rate, 1}).front();
             }}};
}

// ---- Changes of a model.

// A rate of every number: about 0.1 m of every point, a turn of every direction and marker by some
// tenths of a radian, every rate, preload, load and driver by its own size.
struct Randomly {
    std::mt19937 engine;
    double number() { return std::uniform_real_distribution<>(-1, 1)(engine); }
    Vector3d vector() { return {number(), number(), number()}; }

    void turn(Vector3d& u, const Vector3d& omega) { u = omega.cross(u); }
    void change(ScalarLaw& law) {
        std::visit(overloaded{[&](LinearRate& u) { u.k *= number(); },
                              // scaled and shifted, so that it stays continuous
                              [&](elastocheck::Curve& u) {
                                  const double factor = number(), shift = 1e-3 * number();
                                  for (double& x : u.knots) x = shift;
                                  for (auto& piece : u.pieces)
                                      for (double& c : piece) c *= factor;
                              }},
                   law);
    }
    template <class Kind>
    void change_members(Kind& kind) {
        each_member(
            kind, overloaded{[&](Point& p) { p.s_local = 0.1 * vector(); },
                             [&](Direction& u) { turn(u.u_local, 0.3 * vector()); },
                             [&](Marker& m) {
                                 m.s_local = 0.1 * vector();
                                 const Vector3d w = 0.15 * vector();
                                 m.A_local = Quaterniond(0, w.x(), w.y(), w.z()) * m.A_local;
                             },
                             [&](Length<double> l) { l.value = 0.01 * number(); },
                             [&](PlaneAngle<double> a) { a.value = 0.1 * number(); },
                             [&](ForceAndMoment<Vector6> w) {
                                 for (double& x : w.value) x = 10 * number();
                             },
                             [&](Deformation<Vector6> e) {
                                 for (double& x : e.value) x = 1e-3 * number();
                             },
                             [&](LoadVector<Vector3d> f) { f.value = f.value.norm() * vector(); },
                             [&](ScalarLaw& law) { change(law); },
                             [&](SpatialLaw& law) {
                                 std::visit(overloaded{[&](LinearStiffness& u) { u.K *= number(); },
                                                       [&](PerAxis& u) {
                                                           for (auto& axis : u.axis) change(axis);
                                                       }},
                                            law);
                             }});
    }
    void change_constraint(ConstraintKind& kind) {
        if (auto* angle = std::get_if<DirectionAtAngle>(&kind)) {
            turn(angle->i.u_local, 0.3 * vector());
            const Vector3d omega = 0.3 * vector();  // the two axes stay perpendicular
            turn(angle->j.u_local, omega), turn(angle->y_j.u_local, omega);
            angle->angle = 0.1 * number();
        } else {
            change_members(kind);
        }
    }
    Model rate_of(Model model) {
        for (auto& joint : model.joints) joint.at.s_local = 0.1 * vector();
        for (auto& constraint : model.constraints) change_constraint(constraint.kind);
        for (auto& elastic : model.elastics) change_members(elastic.kind);
        for (auto& load : model.static_loads) change_members(load.kind);
        for (auto& branch : model.branches)
            for (auto& driver : branch.drivers) {
                driver.start *= number(), driver.rate *= number();
                each_member(driver.what, overloaded{[&](Load& load) { change_members(load.kind); },
                                                    [&](ForceAndMoment<Vector6> w) {
                                                        for (double& x : w.value) x *= number();
                                                    }});
            }
        return model;
    }
};

// model + h rate, with directions and quaternions of unit length.
Model changed(const Model& model, const Model& rate, double h) {
    auto numbers = rates::archive_of(model).values;
    const auto by = rates::archive_of(rate).values;
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] += h * by[k];
    Model result = rates::with_numbers(model, numbers);
    const auto normalise = overloaded{[](Direction& u) { u.u_local.normalize(); },
                                      [](Marker& m) { m.A_local.normalize(); }};
    for (auto& constraint : result.constraints) {
        each_member(constraint.kind, normalise);
        if (auto* angle = std::get_if<DirectionAtAngle>(&constraint.kind)) {
            const Vector3d x = angle->j.u_local, y = angle->y_j.u_local;
            const double skew = x.dot(y) / 2;
            angle->j.u_local = (x - skew * y).normalized();
            angle->y_j.u_local = (y - skew * x).normalized();
        }
    }
    for (auto& elastic : result.elastics) each_member(elastic.kind, normalise);
    return result;
}

// ---- States and their rates as vectors.

Equilibrium state_at(const OneWay& way, double a, Leg leg) {
    Branch branch = way.branch;
    branch.steps = 1;
    branch.to = a == 0 ? way.branch.to : a;
    const auto path = walk({"", way.model, branch}, {.leg = leg});
    EXPECT_EQ(path.outcome, Outcome::converged) << name(leg) << ": " << path.detail;
    return a == 0 ? path.points.front() : path.points.back();
}
VectorXd of_poses(const StateRate& rate) { return support::stacked(rate.increments); }
VectorXd stacked(const std::vector<Wrench>& wrenches) {
    VectorXd all(6 * std::ssize(wrenches));
    for (std::size_t k = 0; k < wrenches.size(); ++k)
        all.segment<6>(6 * static_cast<Eigen::Index>(k)) << wrenches[k].force, wrenches[k].moment;
    return all;
}
VectorXd motion(const Equilibrium& from, const Equilibrium& to) {
    std::vector<Increment> all;
    for (std::size_t b = 0; b < from.poses.size(); ++b) {
        Quaterniond turn = to.poses[b].p * from.poses[b].p.conjugate();
        if (turn.w() < 0) turn.coeffs() *= -1;
        const Eigen::AngleAxisd by(turn);
        all.push_back({to.poses[b].r - from.poses[b].r, by.angle() * by.axis()});
    }
    return support::stacked(all);
}

// Of the largest entry of b, at least `floor`; infinite where they are not alike.
double apart(const VectorXd& a, const VectorXd& b, double floor) {
    if (a.size() != b.size() || !a.allFinite()) return INFINITY;
    if (b.size() == 0) return 0;
    return (a - b).cwiseAbs().maxCoeff() / std::max(floor, b.cwiseAbs().maxCoeff());
}
constexpr double least_motion = 1e-9, least_force = 1e-4;

// f(scene, side, a) for both ends of every side of the scenes.
template <class F>
void everywhere(F f, const std::vector<std::string>& scenes = support::scene_names()) {
    for (const auto& name : scenes) {
        const Model model = compile(trim(support::scene(name)).scene);
        for (const auto& branch : model.branches)
            for (const auto& side : sides_of(model, branch, 1))
                for (const double a : {0.0, side.branch.to})
                    f(name + ", " + side.name, OneWay{side.model, side.branch}, a);
    }
}

TEST(Sensitivity, TheLegsAgreeOnEverySceneAlongRandomChangesOfAllNumbers) {
    double worst = 0, worst_force = 0;
    int answered = 0;
    everywhere([&](const std::string& where, const OneWay& way, double a) {
        const Equilibrium state = support::bare(state_at(way, a, Leg::equilibrium));
        const Model rate = Randomly{std::mt19937(7)}.rate_of(way.model);
        const auto determined = recursive::diagnose(way.model).determined;
        const auto legs = three_legs();
        const StateRate truth = legs.front().sensitivity(way, state, rate);
        const auto wrenches = [&](StateRate by) {
            for (std::size_t k = 0; k < by.reactions.size(); ++k)
                if (!determined[k]) by.reactions[k] = {};
            return stacked(by.reactions);
        };
        for (std::size_t l = 1; l < legs.size(); ++l) {
            const StateRate other = legs[l].sensitivity(way, state, rate);
            if (is_not_applicable(other.outcome)) continue;
            EXPECT_EQ(other.outcome, truth.outcome)
                << where << ": " << legs[l].name << ": " << other.detail << truth.detail;
            if (truth.outcome != Outcome::converged || other.outcome != truth.outcome) continue;
            const double poses = apart(of_poses(other), of_poses(truth), least_motion),
                         forces = apart(wrenches(other), wrenches(truth), least_force);
            EXPECT_LE(poses, 1e-10) << where << ", at " << a << ": " << legs[l].name;
            EXPECT_LE(forces, 1e-9) << where << ", at " << a << ": " << legs[l].name;
            worst = std::max(worst, poses), worst_force = std::max(worst_force, forces);
            ++answered;
        }
    });
    EXPECT_GT(answered, 250);
    RecordProperty("worst", fmt::format("{:.1e} poses, {:.1e} forces", worst, worst_force));
}

// Re-solves with all numbers changed by ±h, ±h/2: the remainder of the first-order expansion falls
// with h², and extrapolated differences are the derivative.
TEST(Sensitivity, IsTheDerivativeOfEveryLegsOwnSolutions) {
    const double h = 1e-3;
    int compared = 0;
    double worst = 0;
    for (const auto& scene :
         {"double_wishbone", "four_bar", "single_bushing", "bushing_by_small_angles",
          "two_spring_arch", "follower", "tyre_on_road", "semi_trailing_arm"}) {
        const Model model = compile(trim(support::scene(scene)).scene);
        const BranchSide side = sides_of(model, model.branches.front(), 1).front();
        const OneWay way{side.model, side.branch};
        const double a = side.branch.to / 2;
        const Model rate = Randomly{std::mt19937(11)}.rate_of(way.model);
        for (const auto& leg : three_legs()) {
            if (leg.leg == Leg::energy && !support::has_potential(support::scene(scene))) continue;
            const auto solved = [&](double by) {
                OneWay here{changed(way.model, rate, by), {}};
                here.branch = here.model.branches.front();
                return state_at(here, a, leg.leg);
            };
            const Equilibrium state = solved(0);
            const StateRate found = leg.sensitivity(way, state, rate);
            ASSERT_EQ(found.outcome, Outcome::converged) << scene << ": " << found.detail;
            const Equilibrium up = solved(h), down = solved(-h), near_up = solved(h / 2),
                              near_down = solved(-h / 2);
            const auto of = [&](const Equilibrium& at) { return motion(state, at); };
            const auto forces = [&](const Equilibrium& at) { return stacked(at.reactions); };
            const auto extrapolated = [&](const auto& value) {
                return VectorXd(
                    (8 * (value(near_up) - value(near_down)) - (value(up) - value(down))) /
                    (6 * h));
            };
            const std::string where = fmt::format("{}, {}", scene, leg.name);
            const double poses = apart(extrapolated(of), of_poses(found), least_motion),
                         reactions = apart(extrapolated(forces), stacked(found.reactions), 1);
            EXPECT_LE(poses, 1e-7) << where;
            EXPECT_LE(reactions, 1e-6) << where;
            worst = std::max(worst, poses);
            // Taylor test
            const double whole = (of(up) - h * of_poses(found)).norm(),
                         half = (of(near_up) - h / 2 * of_poses(found)).norm();
            if (whole > 1e-9) {
                EXPECT_NEAR(std::log2(whole / half), 2, 0.1) << where;
            }
            ++compared;
        }
    }
    EXPECT_GE(compared, 20);
    RecordProperty("worst", fmt::format("{:.1e}", worst));
}

// ---- Derivatives of the linear response.

// A force and a moment on every body, and the offset of every joint that has one.
std::vector<Disturbance> disturbances(const Model& model) {
    std::vector<Disturbance> all;
    for (int b = 0; b < std::ssize(model.bodies); ++b) {
        const Point at{b, {0.02, -0.03, 0.05}};
        all.push_back(UnitWrench{at, {0.3, -0.5, 0.8}, Vector3d::Zero()});
        all.push_back(UnitWrench{at, Vector3d::Zero(), {0.6, 0.2, -0.7}});
    }
    for (std::size_t k = 0; k < model.joints.size(); ++k)
        if (model.joints[k].driven >= 0) all.push_back(Motion{static_cast<int>(k)});
    return all;
}
struct Responding {
    std::string name;
    std::function<ResponseRates(const OneWay&, const Equilibrium&, std::span<const Disturbance>,
                                const Model& rate)>
        rates;
};
std::vector<Responding> responding_legs() {
    return {
        {"equilibrium",
         [](const OneWay& way, const Equilibrium& state, std::span<const Disturbance> by,
            const Model& rate) {
             return reference::equilibrium::response_rates(way.model, way.branch, state, by,
                                                           {&rate, 1});
         }},
        {"energy",
         [](const OneWay& way, const Equilibrium& state, std::span<const Disturbance> by,
            const Model& rate) {
             return reference::energy::response_rates(way.model, way.branch, state, by, {&rate, 1});
         }},
        {"recursion", [](const OneWay& way, const Equilibrium& state,
                         std::span<const Disturbance> by, const Model& rate) {
             recursive::ResponseAnalysis analysis{recursive::analyse(way.model)};
             return recursive::response_rates(way.model, way.branch, state, by, {&rate, 1},
                                              analysis);
         }}};
}

// Returns the number of compared responses. The energy leg differences its Hessians.
int agree_on_the_rates_of_responses(const std::vector<std::string>& scenes, double& worst) {
    constexpr double exact = 1e-8, differenced = 1e-6;
    int answered = 0;
    everywhere(
        [&](const std::string& where, const OneWay& way, double a) {
            // the part of a motion that is idle depends on the leg
            if (!recursive::diagnose(way.model).idle.empty()) return;
            const Equilibrium state = support::bare(state_at(way, a, Leg::equilibrium));
            const Model rate = Randomly{std::mt19937(7)}.rate_of(way.model);
            const auto by = disturbances(way.model);
            const auto legs = responding_legs();
            const ResponseRates truth = legs.front().rates(way, state, by, rate);
            if (truth.at.outcome != Outcome::converged) return;
            for (std::size_t l = 1; l < legs.size(); ++l) {
                const ResponseRates other = legs[l].rates(way, state, by, rate);
                if (is_not_applicable(other.at.outcome)) continue;
                ASSERT_EQ(other.at.outcome, Outcome::converged) << where << ": " << other.at.detail;
                EXPECT_EQ(other.by.front().outcome, truth.by.front().outcome)
                    << where << ": " << legs[l].name << ": " << other.by.front().detail
                    << truth.by.front().detail;
                if (truth.by.front().outcome != Outcome::converged ||
                    other.by.front().outcome != Outcome::converged)
                    continue;
                // of the response, at least a thousandth of the largest of its kind
                double largest[2] = {0, 0};
                const auto size_of = [&](std::size_t t) {
                    return support::stacked(truth.at.increments[t]).cwiseAbs().maxCoeff();
                };
                for (std::size_t t = 0; t < by.size(); ++t)
                    largest[by[t].index()] = std::max(largest[by[t].index()], size_of(t));
                for (std::size_t t = 0; t < by.size(); ++t) {
                    const double size =
                        std::max({1e-12, size_of(t), 1e-3 * largest[by[t].index()]});
                    const double off =
                        apart(support::stacked(other.by.front().increments[t]),
                              support::stacked(truth.by.front().increments[t]), size);
                    EXPECT_LE(off, legs[l].name == "energy" ? differenced : exact)
                        << where << ", at " << a << ": " << legs[l].name << ", " << t;
                    worst = std::max(worst, off);
                    ++answered;
                }
            }
        },
        scenes);
    return answered;
}

TEST(Sensitivity, TheLegsAgreeOnTheDerivativeOfTheResponse) {
    double worst = 0;
    const int answered = agree_on_the_rates_of_responses(
        {"double_wishbone", "semi_trailing_arm", "four_bar", "follower", "single_bushing",
         "bushing_by_small_angles", "tyre_on_road"},
        worst);
    EXPECT_GT(answered, 200);
    RecordProperty("worst", fmt::format("{:.1e} of {}", worst, answered));
}
TEST(NightlySensitivity, TheLegsAgreeOnTheDerivativeOfTheResponseOnEveryScene) {
    double worst = 0;
    const int answered = agree_on_the_rates_of_responses(support::scene_names(), worst);
    EXPECT_GT(answered, 500);
    RecordProperty("worst", fmt::format("{:.1e} of {}", worst, answered));
}

// The response solved again with all numbers changed by ±h, ±h/2, each at its own equilibrium.
TEST(Sensitivity, TheDerivativeOfTheResponseIsThatOfResponsesSolvedAgain) {
    const double h = 5e-4;
    double worst = 0;
    for (const auto& scene : {"double_wishbone", "four_bar", "single_bushing",
                              "bushing_by_small_angles", "semi_trailing_arm"}) {
        const Model model = compile(trim(support::scene(scene)).scene);
        const BranchSide side = sides_of(model, model.branches.front(), 1).front();
        const OneWay way{side.model, side.branch};
        const double a = side.branch.to / 2;
        const Model rate = Randomly{std::mt19937(11)}.rate_of(way.model);
        const auto by = disturbances(way.model);
        const Equilibrium state = state_at(way, a, Leg::equilibrium);
        const ResponseRates found =
            reference::equilibrium::response_rates(way.model, way.branch, state, by, {&rate, 1});
        ASSERT_EQ(found.by.front().outcome, Outcome::converged) << found.by.front().detail;
        // each response over its size, those of rigid parts left out
        const auto in_sizes = [&](const std::vector<std::vector<Increment>>& increments) {
            VectorXd all;
            for (std::size_t t = 0; t < by.size(); ++t) {
                const double size = support::stacked(found.at.increments[t]).norm();
                if (size < 1e-9) continue;
                const VectorXd one = support::stacked(increments[t]) / size;
                all.conservativeResize(all.size() + one.size());
                all.tail(one.size()) = one;
            }
            return all;
        };
        const auto solved = [&](double s) {
            OneWay here{changed(way.model, rate, s), {}};
            here.branch = here.model.branches.front();
            return in_sizes(reference::equilibrium::linear_response(
                                here.model, here.branch, state_at(here, a, Leg::equilibrium), by)
                                .increments);
        };
        const VectorXd difference =
                           (8 * (solved(h / 2) - solved(-h / 2)) - (solved(h) - solved(-h))) /
                           (6 * h),
                       exact = in_sizes(found.by.front().increments);
        const double off = apart(exact, difference, 1e-6);
        EXPECT_LE(off, 1e-7) << scene;
        worst = std::max(worst, off);
    }
    RecordProperty("worst", fmt::format("{:.1e}", worst));
}

}  // namespace
}  // namespace elastocheck::compare
