// Scalable scene families (tests/benchmark/families.hpp): every leg and method
// against closed forms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "compare/comparison/compare.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/benchmark/families.hpp"
#include "tests/support/planar_chain.hpp"

namespace elastocheck::compare {
namespace {

using families::Family;
using families::Hinge;
using families::Kind;
using support::PlanarChain;

// [mm] distance of a reference from the closed form, or from the other reference
constexpr double references = 1e-8;
constexpr double expansions = 1e-9;  // [mm] distance of the series from the equilibrium leg

std::string named(const Family& f) {
    return fmt::format("{} of {} on {}s", name(f.kind), f.bodies, name(f.hinge));
}

// A family with its branch and the results of a leg. Leg::recursive is the series,
// tolerance 1e-13 m.
struct FamilyScene {
    Family family;
    Scene scene;
    Model model;

    explicit FamilyScene(const Family& f)
        : FamilyScene(f, parse_scene(families::scene(f), named(f))) {}
    FamilyScene(const Family& f, const Scene& s) : family(f), scene(s), model(compile(s)) {}

    EquilibriumPath by(Leg leg) const {
        const auto path = solve_branch(
            sides_of(model, model.branches[0]),
            {.leg = leg,
             .recursion = {.method = {"series", 0, recursive::Series{.tolerance = 1e-13}}}});
        EXPECT_EQ(path.outcome, Outcome::converged)
            << named(family) << " by " << name(leg) << ": " << path.detail;
        EXPECT_EQ(path.points.size(), 6u) << named(family) << " by " << name(leg);
        return path;
    }
    Eigen::Vector3d end(const Equilibrium& point) const {  // the probe [m]
        const auto& at = model.probes[0].at;
        const Pose& pose = point.poses[static_cast<std::size_t>(at.body)];
        return pose.r + pose.p * at.s_local;
    }
};

// The larger one; NaN propagates.
double larger(double a, double b) { return a >= b || std::isnan(a) ? a : b; }

// Largest distance of all bodies' origins over the branch.
double furthest_apart_mm(const EquilibriumPath& a, const EquilibriumPath& b) {
    double most = a.points.size() == b.points.size() && !a.points.empty() ? 0 : NAN;
    for (std::size_t k = 0; k < std::min(a.points.size(), b.points.size()); ++k)
        for (std::size_t i = 0; i < a.points[k].poses.size(); ++i)
            most = larger(most, 1e3 * (a.points[k].poses[i].r - b.points[k].poses[i].r).norm());
    return most;
}

// ---- Closed forms: positions of all bodies under the load F.

// Chain, tree, grid: the bodies in a row along x have the positions of one chain's links.
Eigen::Vector3d on_chain(const Family& f, const PlanarChain::Shape& shape, int links,
                         const Eigen::Vector3d& drawn) {
    const auto link = static_cast<std::size_t>(std::lround(drawn.x() * links / families::length));
    EXPECT_LT(link, shape.x.size()) << named(f);
    return {static_cast<double>(shape.x.at(link)), drawn.y(),
            static_cast<double>(shape.z.at(link))};
}

// The axle: the housing only rises by u, as its links are mirror images. Each link has V = F/n
// across its end, and H along, since its end stays above its place. With ℓ its length, c the total
// compliance of its ends under a force and K_R the bending stiffness at either end,
//
//   ℓ cos φ + c H = ℓ     ℓ sin φ + c V = u     ℓ (V cos φ - H sin φ) = 2 K_R φ
struct Lifted {
    double phi = 0, H = 0, u = 0, c_ground = 0;
};
Lifted lifted(Hinge hinge, double F) {
    const double l = families::link, c_ground = hinge == Hinge::bushing ? 1 / families::K_T : 0,
                 c = c_ground + 1 / families::K_T;
    double low = 0, high = std::numbers::pi / 2;
    for (int i = 0; i < 60; ++i) {
        const double phi = (low + high) / 2, H = l * (1 - std::cos(phi)) / c;
        (l * (F * std::cos(phi) - H * std::sin(phi)) > 2 * families::K_R * phi ? low : high) = phi;
    }
    return {low, l * (1 - std::cos(low)) / c, l * std::sin(low) + c * F, c_ground};
}
Eigen::Vector3d on_axle(const Lifted& at, double F, const Eigen::Vector3d& drawn) {
    if (drawn.x() == 0) return {0, drawn.y(), at.u};
    return {drawn.x() - std::copysign(at.c_ground * at.H, drawn.x()), drawn.y(), at.c_ground * F};
}

double off_the_closed_form_mm(const FamilyScene& w, const EquilibriumPath& path) {
    const Family& f = w.family;
    const int links = f.kind == Kind::chain  ? f.bodies
                      : f.kind == Kind::tree ? families::levels(f.bodies)
                                             : f.bodies / families::rows(f.bodies);
    const double h = families::length / links;
    const auto chain = PlanarChain::links(links, h, families::EI / h,
                                          f.hinge == Hinge::bushing ? h / families::EA : 0);
    double most = path.points.empty() ? NAN : 0;
    for (const auto& point : path.points) {
        if (point.load == 0) continue;
        const auto shape = chain.under(0, point.load);
        const auto axle = lifted(f.hinge, point.load);
        for (std::size_t i = 0; i < point.poses.size(); ++i) {
            const auto& drawn = w.model.bodies[i].design.r;
            const auto known = f.kind == Kind::axle ? on_axle(axle, point.load, drawn)
                                                    : on_chain(f, shape, links, drawn);
            most = larger(most, 1e3 * (point.poses[i].r - known).norm());
        }
    }
    return most;
}

const std::vector<Family> of_fifteen{{Kind::chain, 15},
                                     {Kind::tree, 15},
                                     {Kind::grid, 15},
                                     {Kind::axle, 15},
                                     {Kind::chain, 15, Hinge::revolute},
                                     {Kind::tree, 15, Hinge::revolute},
                                     {Kind::grid, 15, Hinge::revolute},
                                     {Kind::axle, 15, Hinge::revolute}};
const std::vector<Family> of_sixty{{Kind::chain, 60},
                                   {Kind::tree, 63},
                                   {Kind::grid, 60},
                                   {Kind::axle, 61},
                                   {Kind::chain, 60, Hinge::revolute},
                                   {Kind::tree, 63, Hinge::revolute},
                                   {Kind::grid, 60, Hinge::revolute},
                                   {Kind::axle, 61, Hinge::revolute}};

TEST(SceneFamilies, EqualTheirClosedFormInEveryLeg) {
    for (const Family& family : of_fifteen) {
        const FamilyScene w(family);
        for (const Leg leg : {Leg::equilibrium, Leg::energy, Leg::series, Leg::recursive})
            EXPECT_LE(off_the_closed_form_mm(w, w.by(leg)), references)
                << named(family) << " by " << name(leg);
    }
}

TEST(SceneFamilies, EqualTheirClosedFormWithFourTimesTheBodies) {
    for (const Family& family : of_sixty) {
        const FamilyScene w(family);
        const auto equilibrium = w.by(Leg::equilibrium), series = w.by(Leg::recursive);
        EXPECT_LE(off_the_closed_form_mm(w, equilibrium), references) << named(family);
        EXPECT_LE(furthest_apart_mm(equilibrium, series), expansions) << named(family);
    }
}

// ---- Unequal load sharing and beams: the legs are compared with each other.

FamilyScene pushed_at_a_corner() {
    const Family grid{Kind::grid, 15};
    Scene scene = parse_scene(families::scene(grid), "grid");
    scene.branches[0].drivers.erase(scene.branches[0].drivers.begin(),
                                    scene.branches[0].drivers.end() - 1);
    return {grid, scene};
}

TEST(SceneFamilies, ReferencesAgreeOnFamiliesWithoutAClosedForm) {
    std::vector<FamilyScene> all{pushed_at_a_corner()};
    for (const Family& family : {Family{Kind::tree, 12},
                                 {Kind::tree, 12, Hinge::revolute},
                                 {Kind::axle, 12},
                                 {Kind::axle, 12, Hinge::revolute},
                                 {Kind::leaf_spring, 15},
                                 {Kind::ladder_frame, 15}})
        all.emplace_back(family);
    for (const FamilyScene& w : all) {
        const auto equilibrium = w.by(Leg::equilibrium);
        EXPECT_LE(furthest_apart_mm(equilibrium, w.by(Leg::energy)), references) << named(w.family);
        EXPECT_LE(furthest_apart_mm(equilibrium, w.by(Leg::recursive)), expansions)
            << named(w.family);
    }
}

TEST(SceneFamilies, LargeBeamsAgreeBetweenEquilibriumLegAndSeries) {
    for (const Kind kind : {Kind::leaf_spring, Kind::ladder_frame}) {
        const FamilyScene w({kind, 60});
        EXPECT_LE(furthest_apart_mm(w.by(Leg::equilibrium), w.by(Leg::recursive)), expansions)
            << name(kind);
    }
}

// ---- Beams under small loads.

// Rise of the probe per load, by central differences with a thousandth of the load:
// even orders cancel.
double flexibility(const Family& family, Leg leg) {
    Scene scene = parse_scene(families::scene(family), named(family));
    const double F = scene.branches[0].to / 1000;
    double rise = 0;
    for (const double sign : {1, -1}) {
        scene.branches[0].to = sign * F;
        const FamilyScene w(family, scene);
        rise += sign * (w.end(w.by(leg).points.back()).z() - w.end(w.by(leg).points.front()).z());
    }
    return rise / (2 * F);
}

// Leaf k is a cantilever of a_k from the seat, with X_k on its tip from the leaf above (X_0 = F/2
// from the eye) and X_k+1 from the one below, at that one's tip. A force P at a bends a leaf by P
// s²(3a - s)/(6EI) at s ≤ a, and by P a²(3s - a)/(6EI) beyond; a pad is compressed by X_k/k. So for
// every pad
//
//   w_k-1(a_k) - w_k(a_k) = X_k/k
//   w_k(s) = X_k s²(3a_k - s)/(6EI) - X_k+1 a²(3s - a)/(6EI),   a = a_k+1
double leaf_flexibility(const families::Leaves& pack) {
    const double EI = families::E * pack.width * std::pow(pack.thick, 3) / 12;
    const int m = pack.count;
    const auto tip = [&](int k) { return std::pow(pack.half_of(k), 3) / (3 * EI); };
    const auto far = [&](int k) {  // at the tip of k, from a force at that of k+1, and vice versa
        const double a = pack.half_of(k + 1);
        return a * a * (3 * pack.half_of(k) - a) / (6 * EI);
    };
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(m, m);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(m);
    A(0, 0) = 1;
    b[0] = 0.5;
    for (int k = 1; k < m; ++k) {
        A(k, k - 1) = far(k - 1);
        A(k, k) = -tip(k) - tip(k) - 1 / pack.pad;
        if (k + 1 < m) A(k, k + 1) = far(k);
    }
    const Eigen::VectorXd X = A.partialPivLu().solve(b);
    return X[0] * tip(0) - (m > 1 ? X[1] * far(0) : 0);
}

TEST(LeafSpring, SmallLoadIsSharedAmongItsLeavesByBeamTheory) {
    for (const int n : {3, 9, 15, 30}) {
        const double known = leaf_flexibility(families::leaves(n));
        for (const Leg leg : {Leg::equilibrium, Leg::recursive})
            EXPECT_NEAR(flexibility({Kind::leaf_spring, n}, leg) / known, 1, 1e-7)
                << n << " by " << name(leg);
    }
}

// Grillage: w, φ_x, φ_y at every crossing; bending about one axis and torsion about the
// other in between.
double frame_flexibility(const families::Frame& frame) {
    const int c = frame.cross_members;
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(6 * c, 6 * c);
    // Beam of length l from node i to j. Its slope is sign · (degree of freedom `slope`), its
    // torsion `twist`.
    const auto add = [&](int i, int j, double l, const families::Tube& tube, int slope, double sign,
                         int twist) {
        const double inner = tube.diameter - 2 * tube.wall,
                     I = std::numbers::pi * (std::pow(tube.diameter, 4) - std::pow(inner, 4)) / 64;
        const double EI = families::E * I, GJ = families::G * 2 * I;
        const int at[] = {3 * i, 3 * i + slope, 3 * j, 3 * j + slope};
        const double s = sign * l;
        Eigen::Matrix4d bend;
        bend << 12, 6 * s, -12, 6 * s, 6 * s, 4 * l * l, -6 * s, 2 * l * l, -12, -6 * s, 12, -6 * s,
            6 * s, 2 * l * l, -6 * s, 4 * l * l;
        for (int a = 0; a < 4; ++a)
            for (int b = 0; b < 4; ++b) K(at[a], at[b]) += EI / (l * l * l) * bend(a, b);
        for (const int a : {i, j})
            for (const int b : {i, j}) K(3 * a + twist, 3 * b + twist) += (a == b ? GJ : -GJ) / l;
    };
    const auto left = [](int k) { return 2 * k; };
    const auto right = [](int k) { return 2 * k + 1; };
    for (int k = 0; k < c; ++k) {
        add(right(k), left(k), frame.width, frame.cross, 1, 1, 2);  // along y: w' = φ_x
        if (k + 1 < c)
            for (const auto& side : {left(k), right(k)})
                add(side, side + 2, frame.length / (c - 1), frame.rail, 2, -1,
                    1);  // along x: w' = -φ_y
    }
    for (const int held : {left(0), right(0), left(c - 1)}) {
        K.row(3 * held).setZero();
        K.col(3 * held).setZero();
        K(3 * held, 3 * held) = 1;
    }
    return K.partialPivLu().solve(Eigen::VectorXd::Unit(6 * c, 3 * right(c - 1)))[3 * right(c - 1)];
}

TEST(LadderFrame, SmallDeflectionEqualsThatOfAGrillage) {
    for (const int n : {4, 9, 15, 30}) {
        const double known = frame_flexibility(families::frame(n));
        for (const Leg leg : {Leg::equilibrium, Leg::recursive})
            EXPECT_NEAR(flexibility({Kind::ladder_frame, n}, leg) / known, 1, 1e-7)
                << n << " by " << name(leg);
    }
}

// ---- Methods.

// Methods with a declared order converge to the truth. A method without one converges to its own
// limit with order 1, which has a gap, unless no stored force has a rotating lever: torsion springs
// about fixed axes.
TEST(SceneFamilies, MethodsConvergeAtTheirFormalOrder) {
    std::vector<Family> all = of_fifteen;
    all.push_back({Kind::leaf_spring, 15});
    all.push_back({Kind::ladder_frame, 15});
    for (const Family& family : all) {
        const FamilyScene w(family);
        const bool nothing_turns = family.hinge == Hinge::revolute && family.kind != Kind::axle;
        // nearly inextensible: large higher-order terms
        const bool beams = !has_hinges(family.kind);
        const Eigen::Vector3d truth = w.end(w.by(Leg::equilibrium).points.back());
        for (const auto& method : recursive::methods) {
            if (!has_steps(method)) continue;
            std::vector<Eigen::Vector3d> ends;
            for (const int refine : {20, 40, 80}) {
                const auto path = solve_branch(
                    sides_of(w.model, w.model.branches[0]),
                    {.leg = Leg::recursive, .recursion = {.method = method}, .refine = refine});
                ASSERT_EQ(path.outcome, Outcome::converged)
                    << named(family) << " " << method.name << path.detail;
                ends.push_back(w.end(path.points.back()));
            }
            const double own = std::log2((ends[0] - ends[1]).norm() / (ends[1] - ends[2]).norm());
            const double to_truth = std::log2((ends[1] - truth).norm() / (ends[2] - truth).norm());
            const std::string what = fmt::format(
                "{} {}: own {:.3f}, to the truth {:.3f}, off by {:.2e} mm", named(family),
                method.name, own, to_truth, 1e3 * (ends[2] - truth).norm());
            if (method.formal_order == 0) {
                EXPECT_NEAR(own, 1, 0.1) << what;
                EXPECT_NEAR(to_truth, nothing_turns ? 1 : 0, 0.1) << what;
            } else if (beams) {
                EXPECT_GE(to_truth, method.formal_order - 0.1) << what;
            } else {
                EXPECT_NEAR(to_truth, method.formal_order, 0.1) << what;
            }
        }
    }
}

// ---- Sizes.

TEST(SceneFamilies, HaveTheRequestedNumberOfBodiesAndASimilarMovement) {
    for (const Kind kind : families::kinds)
        for (const Hinge hinge : {Hinge::bushing, Hinge::revolute}) {
            if (hinge == Hinge::revolute && !has_hinges(kind)) continue;
            for (const int n : {families::min_bodies(kind), 7, 24, 100, 2000}) {
                const Family family{kind, n, hinge};
                EXPECT_EQ(static_cast<int>(FamilyScene(family).model.bodies.size()), n)
                    << named(family);
            }
            for (const int n : {16, 31, 33}) {
                const FamilyScene w({kind, n, hinge});
                const double z = w.end(w.by(Leg::recursive).points.back()).z();
                EXPECT_GT(z, 0.03) << named(w.family);
                EXPECT_LT(z, 0.45) << named(w.family);
            }
        }
}

TEST(SceneFamilies, InvalidSizeOrJointIsRejected) {
    for (const Kind kind : families::kinds) {
        EXPECT_THROW(families::scene({kind, families::min_bodies(kind) - 1}), std::out_of_range)
            << name(kind);
        EXPECT_THROW(families::scene({kind, families::max_bodies + 1}), std::out_of_range)
            << name(kind);
        if (!has_hinges(kind)) {
            EXPECT_THROW(families::scene({kind, 30, Hinge::revolute}), std::invalid_argument)
                << name(kind);
        }
    }
}

}  // namespace
}  // namespace elastocheck::compare
