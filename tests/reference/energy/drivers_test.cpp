// Branches driven by joints, free lengths and preloads, alone and together.
#include <numbers>

#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;

const Vector3d X = Vector3d::UnitX(), Y = Vector3d::UnitY(), Z = Vector3d::UnitZ();

Driver motion_of(const Scene& scene, const std::string& joint, double rate, double start = 0) {
    for (std::size_t k = 0; k < scene.joints.size(); ++k)
        if (scene.joints[k].name == joint) return {Motion{static_cast<int>(k)}, start, rate};
    throw std::out_of_range(joint);
}

Branch driven_branch(const std::string& name, const std::vector<Driver>& drivers, double to,
                     ParameterUnit unit = ParameterUnit::metre) {
    return {.name = name, .to = to, .steps = 10, .unit = unit, .drivers = drivers};
}

std::vector<double> values_to(double to, int steps) {
    std::vector<double> values;
    for (int i = 0; i <= steps; ++i) values.push_back(to * i / steps);
    return values;
}

EquilibriumPath walk(Scene scene, const Branch& branch, const std::vector<double>& values) {
    scene.branches = {branch};
    return solve(scene, 0, values);
}

// Distance of origins and of determined orientations: the strut's spin, body 2, is idle and
// path-dependent.
double furthest(const Equilibrium& one, const Equilibrium& two) {
    double worst = 0;
    for (std::size_t b = 0; b < one.poses.size(); ++b) {
        worst = std::max(worst, (one.poses[b].r - two.poses[b].r).norm());
        if (b != 2) worst = std::max(worst, one.poses[b].p.angularDistance(two.poses[b].p));
    }
    return worst;
}

std::size_t joint_named(const Model& model, const std::string& name) {
    for (std::size_t k = 0; k < model.joints.size(); ++k)
        if (model.joints[k].name == name) return k;
    throw std::out_of_range(name);
}

// A crank about z at `pivot`, in the design position at angle `theta` from x, its pin at distance
// `radius`; body axes parallel to ground axes, so that the design angle is the zero of the drive.
BodyId add_crank(Scene& scene, const std::string& name, const Vector3d& pivot) {
    const auto body = static_cast<BodyId>(scene.bodies.size());
    scene.bodies.push_back({name, {pivot, Quaterniond::Identity()}});
    scene.joints.push_back(
        {name + "_pivot", Revolute{{body}, {ground, pivot}, {body, Z}, {ground, Z}}});
    return body;
}

void add_angle_drive(Scene& scene, BodyId body) {
    scene.joints.push_back({"drive", Angle{{body, X}, {ground, X}, {ground, Y}, 0}, true});
}

// Slider-crank: x = r cos θ + √(l² - (r sin θ - h)²), the slider on a line at height h.
TEST(Drivers, SliderCrankTurnsFullyAsItsGeometrySays) {
    const double r = 0.1, l = 0.3, h = 0.02;
    const double x_0 = r + std::sqrt(l * l - h * h);
    Scene scene;
    const BodyId crank = add_crank(scene, "crank", Vector3d::Zero());
    const BodyId slider = 1;
    scene.bodies.push_back({"slider", {{x_0, h, 0}, Quaterniond::Identity()}});
    scene.joints.push_back(
        {"guide", Translational{{slider}, {ground, {0, h, 0}}, {slider, X}, {ground, X}}});
    scene.joints.push_back({"rod", Distance{{crank, r * X}, {slider}, l}});
    add_angle_drive(scene, crank);
    scene.probes = {{"slider", {slider}}};
    const Branch branch =
        driven_branch("turn", {motion_of(scene, "drive", 1)}, 2 * pi, ParameterUnit::radian);
    for (const double direction : {1.0, -1.0}) {
        const auto path = walk(scene, branch, values_to(direction * 2 * pi, 72));
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        double worst = 0;
        for (const auto& state : path.points) {
            const double y = r * std::sin(state.load) - h;
            const Vector3d expected(r * std::cos(state.load) + std::sqrt(l * l - y * y), h, 0);
            worst = std::max(worst, (state.poses[1].r - expected).norm());
            worst = std::max(worst, state.poses[0].p.angularDistance(
                                        Quaterniond(Eigen::AngleAxisd(state.load, Z))));
        }
        EXPECT_LE(worst, 1e-12) << direction;
        RecordProperty(direction > 0 ? "worst" : "worst_back", fmt::format("{:.1e}", worst));
    }
}

// Four-bar: the rocker's pin is the intersection of two circles on the side of the design position.
// Once with the coupler as a distance, once as a body with redundant joints.
TEST(Drivers, FourBarTurnsFullyAsItsGeometrySays) {
    const double crank_radius = 0.1, coupler = 0.35, rocker_radius = 0.25, base = 0.4;
    const auto pin = [&](double theta) {
        const Vector2d a = crank_radius * Vector2d(std::cos(theta), std::sin(theta)),
                       d = Vector2d(base, 0) - a;
        const double s = d.norm();
        const double along = (coupler * coupler - rocker_radius * rocker_radius + s * s) / (2 * s);
        const Vector2d p =
            a + along * d / s +
            std::sqrt(coupler * coupler - along * along) * Vector2d(-d.y(), d.x()) / s;
        return Vector3d(p.x(), p.y(), 0);
    };
    for (const bool body_coupler : {false, true}) {
        Scene scene;
        const BodyId crank = add_crank(scene, "crank", Vector3d::Zero());
        const BodyId rocker = add_crank(scene, "rocker", base * X);
        const Point crank_pin{crank, crank_radius * X}, rocker_pin{rocker, pin(0) - base * X};
        if (body_coupler) {
            const BodyId rod = 2;
            scene.bodies.push_back({"coupler", {crank_radius * X, Quaterniond::Identity()}});
            scene.joints.push_back({"big_end", Revolute{{rod}, crank_pin, {rod, Z}, {crank, Z}}});
            scene.joints.push_back(
                {"small_end", Spherical{{rod, pin(0) - crank_radius * X}, rocker_pin}});
        } else {
            scene.joints.push_back({"coupler", Distance{crank_pin, rocker_pin, coupler}});
        }
        add_angle_drive(scene, crank);
        scene.probes = {{"pin", rocker_pin}};
        const Branch branch =
            driven_branch("turn", {motion_of(scene, "drive", 1)}, 2 * pi, ParameterUnit::radian);
        const auto path = walk(scene, branch, values_to(2 * pi, 60));
        ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
        double worst = 0;
        for (const auto& state : path.points)
            worst = std::max(worst, (position(state, rocker_pin) - pin(state.load)).norm());
        EXPECT_LE(worst, 1e-12) << body_coupler;
        RecordProperty(body_coupler ? "worst_body" : "worst_distance",
                       fmt::format("{:.1e} m", worst));
    }
}

// ---- The arch of models/scenes with a jack at its apex.

struct Arch {
    double b = 0.3, h = 0.08, k = 1e5, l_0 = std::hypot(b, h);
    double load(double z) const { return 2 * k * (1 - l_0 / std::hypot(b, z)) * z; }
    double energy(double z) const { return k * std::pow(std::hypot(b, z) - l_0, 2); }
};

Scene jacked_arch() {
    Scene scene = scene_named("two_spring_arch");
    scene.joints.push_back({"jack", InPlane{{0}, {ground}, {ground, Z}, 0.08}, true});
    return scene;
}

// ∫ f da over [0, to] by five-point Gauss-Legendre in each of `panels`: the evaluation points, and
// the sum.
struct Quadrature {
    std::vector<double> a, weight;
    Quadrature(double to, int panels) {
        const double x_1 = std::sqrt(5 - 2 * std::sqrt(10.0 / 7)) / 3,
                     x_2 = std::sqrt(5 + 2 * std::sqrt(10.0 / 7)) / 3;
        const double w_1 = (322 + 13 * std::sqrt(70.0)) / 900,
                     w_2 = (322 - 13 * std::sqrt(70.0)) / 900;
        const double x[] = {-x_2, -x_1, 0, x_1, x_2}, w[] = {w_2, w_1, 128.0 / 225, w_1, w_2};
        for (int k = 0; k < panels; ++k)
            for (int i = 0; i < 5; ++i) {
                a.push_back(to / panels * (k + 0.5 + 0.5 * x[i]));
                weight.push_back(to / panels * 0.5 * w[i]);
            }
        a.push_back(to);
        weight.push_back(0);
    }
};

TEST(Drivers, JackTakesTheArchThroughBothLimitPoints) {
    const Arch arch;
    Scene scene = jacked_arch();
    const Branch branch = driven_branch("down", {motion_of(scene, "jack", -1)}, 0.16);
    scene.branches = {branch};
    const std::size_t jack = joint_named(compile(scene), "jack");
    const Quadrature quadrature(0.16, 8);
    const auto path = walk(scene, branch, quadrature.a);
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    double worst = 0, worst_z = 0, least = 0, most = 0, work = 0;
    for (std::size_t k = 0; k < path.points.size(); ++k) {
        const auto& state = path.points[k];
        const double z = 0.08 - state.load, force = state.reactions[jack].force.z();
        worst = std::max(worst, std::abs(force - arch.load(z)));
        worst_z = std::max(worst_z, std::abs(state.poses[0].r.z() - z));
        least = std::min(least, force);
        most = std::max(most, force);
        work -= quadrature.weight[k] * force;
        // Through the middle, where no energy is stored, and out again.
        EXPECT_NEAR(state.reactions[jack].force.head<2>().norm(), 0, 1e-9);
    }
    EXPECT_LE(least, -211);  // the limit loads are ∓ 211.5 N
    EXPECT_GE(most, 211);
    EXPECT_LE(worst, 1e-9 * 211);
    EXPECT_LE(worst_z, 1e-12);
    EXPECT_NEAR(work, arch.energy(-0.08) - arch.energy(0.08), 1e-9 * arch.energy(0));
    RecordProperty("worst_force", fmt::format("{:.1e} N", worst));
}

TEST(Drivers, WorkOfTheJackIsTheEnergyStored) {
    const Arch arch;
    Scene scene = jacked_arch();
    const Branch branch = driven_branch("down", {motion_of(scene, "jack", -1)}, 0.08);
    scene.branches = {branch};
    const std::size_t jack = joint_named(compile(scene), "jack");
    const Quadrature quadrature(0.08, 6);
    const auto path = walk(scene, branch, quadrature.a);
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    double work = 0;
    for (std::size_t k = 0; k < path.points.size(); ++k)
        work -= quadrature.weight[k] * path.points[k].reactions[jack].force.z();
    EXPECT_NEAR(work, arch.energy(0), 1e-9 * arch.energy(0));
}

// ---- The McPherson strut on a jack under its wheel.

Scene jacked_strut() {
    Scene scene = scene_named("chrono_mcpherson");
    const Wheel& wheel = scene.wheels[0];
    const Point centre{wheel.body, wheel.centre_local};
    const Pose& design = scene.bodies[static_cast<std::size_t>(wheel.body)].design;
    scene.joints.push_back(
        {"jack",
         InPlane{centre, {ground, design.r + design.p * wheel.centre_local}, {ground, Z}, 0},
         true});
    return scene;
}

Driver force_on_wheel(const Scene& scene, const Vector3d& f, double rate, double start = 0) {
    return {Load{"force", DeadForce{{scene.wheels[0].body, scene.wheels[0].centre_local}, f}},
            start, rate};
}

// Energy of the linear elements, implemented independently.
double stored(const Scene& scene, const Equilibrium& state) {
    double U = 0;
    for (const auto& elastic : scene.elastics) {
        if (const auto* spring = std::get_if<AxialSpring>(&elastic.kind)) {
            const double x = (position(state, spring->j) - position(state, spring->i)).norm() -
                             spring->free_length;
            U += 0.5 * rate_of(*spring) * x * x;
            continue;
        }
        const auto& b = std::get<Bushing>(elastic.kind);
        const auto axes = [&](const Marker& m) {
            return m.body == ground ? m.A_local
                                    : state.poses[static_cast<std::size_t>(m.body)].p * m.A_local;
        };
        const Eigen::AngleAxisd turn(axes(b.i).conjugate() * axes(b.j));
        Vector6 e;
        e << axes(b.i).conjugate() * (position(state, {b.j.body, b.j.s_local}) -
                                      position(state, {b.i.body, b.i.s_local})),
            turn.angle() * turn.axis();
        U += 0.5 * e.dot(stiffness_of(b) * e) + b.preload.dot(e);
    }
    return U;
}

TEST(Drivers, TravelAndLoadMeetAtTheSameStates) {
    const Scene scene = jacked_strut();
    for (const double to : {0.08, -0.08}) {
        Scene driven = scene;
        const Branch travel = driven_branch("travel", {motion_of(scene, "jack", 1)}, to);
        driven.branches = {travel};
        const Model model = compile(driven);
        const std::size_t jack = joint_named(model, "jack");
        const Quadrature quadrature(to, 3);
        const auto up = walk(scene, travel, quadrature.a);
        ASSERT_EQ(up.outcome, Outcome::converged) << up.detail;
        std::vector<double> forces;
        double work = 0;
        for (std::size_t k = 0; k < up.points.size(); ++k) {
            forces.push_back(up.points[k].reactions[jack].force.z());
            work += quadrature.weight[k] * forces.back();
            EXPECT_LE(largest(residuals(on_branch(model, travel), travel, up.points[k])), 1e-7);
        }
        Branch load = load_branch("load", {}, forces.back(), 10);
        load.drivers = {force_on_wheel(scene, Z, 1)};
        const auto pushed = walk(scene, load, forces);
        ASSERT_EQ(pushed.outcome, Outcome::converged) << pushed.detail;
        double worst = 0, worst_force = 0;
        for (std::size_t k = 0; k < forces.size(); ++k) {
            worst = std::max(worst, furthest(up.points[k], pushed.points[k]));
            for (std::size_t j = 0; j < jack; ++j)
                worst_force = std::max(
                    worst_force,
                    (up.points[k].reactions[j].force - pushed.points[k].reactions[j].force).norm());
            // no jack where no branch drives it
            EXPECT_EQ(pushed.points[k].reactions.size(), jack);
        }
        EXPECT_GT(std::abs(forces.back()), 1000);
        EXPECT_LE(worst, 1e-9);
        EXPECT_LE(worst_force, 1e-9 * std::abs(forces.back()));
        EXPECT_NEAR(work, stored(scene, up.points.back()), 1e-9 * work);
        RecordProperty(to > 0 ? "jounce" : "rebound",
                       fmt::format("{:.1e} m, {:.1e} N", worst, worst_force));
    }
}

// Jounce at a constant braking force: held by the branch, or as a static load of the scene.
TEST(Drivers, AHeldLoadIsAStaticLoad) {
    const Scene scene = jacked_strut();
    const Vector3d brake(-800, 0, 0);
    const auto values = values_to(0.06, 6);
    const auto held = walk(
        scene,
        driven_branch("travel",
                      {motion_of(scene, "jack", 1), force_on_wheel(scene, brake / 4, 0, 4)}, 0.06),
        values);
    Scene loaded = scene;
    loaded.static_loads = {std::get<Load>(force_on_wheel(scene, brake, 0).what)};
    const auto fixed =
        walk(loaded, driven_branch("travel", {motion_of(scene, "jack", 1)}, 0.06), values);
    ASSERT_EQ(held.outcome, Outcome::converged) << held.detail;
    ASSERT_EQ(fixed.outcome, Outcome::converged) << fixed.detail;
    for (std::size_t k = 0; k < values.size(); ++k)
        EXPECT_LE(furthest(held.points[k], fixed.points[k]), 1e-10) << values[k];
}

// A fore-and-aft sweep at three heights starts at the states of the jack's own branch, and two
// simultaneous drivers end in the same state as two consecutive ones: the curve of minima is
// unique.
TEST(Drivers, HeldHeightsAreReachedBySettling) {
    Scene scene = jacked_strut();
    scene.joints.erase(scene.joints.begin() +
                       3);  // a bushing's compliance replaces the fore-and-aft plane
    for (const double height : {-0.06, 0.03, 0.08}) {
        const auto lifted =
            walk(scene, driven_branch("lift", {motion_of(scene, "jack", 1)}, height), {height});
        const auto sweep_at =
            walk(scene,
                 driven_branch("sweep",
                               {motion_of(scene, "jack", 0, height), force_on_wheel(scene, X, 1)},
                               600, ParameterUnit::newton),
                 {0, 300, 600});
        ASSERT_EQ(lifted.outcome, Outcome::converged) << lifted.detail;
        ASSERT_EQ(sweep_at.outcome, Outcome::converged) << sweep_at.detail;
        EXPECT_LE(furthest(lifted.points[0], sweep_at.points[0]), 1e-9) << height;
        const auto both = walk(
            scene,
            driven_branch("both", {motion_of(scene, "jack", height), force_on_wheel(scene, X, 600)},
                          1, ParameterUnit::none),
            {1});
        ASSERT_EQ(both.outcome, Outcome::converged) << both.detail;
        EXPECT_LE(furthest(both.points[0], sweep_at.points[2]), 1e-9) << height;
    }
}

// A tie rod 3 mm longer than in the design position equals one that a branch has lengthened by 3
// mm.
TEST(Drivers, ADistanceMayHaveAnotherLengthThanDrawn) {
    const Scene scene = scene_named("chrono_mcpherson");
    for (const double longer : {0.003, -0.02}) {
        const auto driven = walk(
            scene, driven_branch("toe", {motion_of(scene, "tie_rod", 1)}, longer), {0, longer});
        Scene other = scene;
        auto& rod = std::get<Distance>(other.joints[2].kind);
        rod.length += longer;
        const auto drawn = walk(other, load_branch("rest", {}, 1, 1), {0});
        ASSERT_EQ(driven.outcome, Outcome::converged) << driven.detail;
        ASSERT_EQ(drawn.outcome, Outcome::converged) << drawn.detail;
        EXPECT_LE(furthest(driven.points[1], drawn.points[0]), 1e-9) << longer;
        EXPECT_GT(furthest(driven.points[0], drawn.points[0]), 1e-3) << longer;
        EXPECT_NEAR((position(drawn.points[0], rod.i) - position(drawn.points[0], rod.j)).norm(),
                    rod.length, 1e-13);
    }
}

// Open joints of the design position are closed: a hinge 10 mm beside its axis, a plane at another
// offset, another angle.
TEST(Drivers, WhatIsDrawnOpenIsClosed) {
    Scene scene;
    const BodyId crank = add_crank(scene, "crank", Vector3d::Zero());
    std::get<Revolute>(scene.joints[0].kind).j.s_local = {0.01, -0.02, 0.03};
    scene.joints.push_back({"stand", Angle{{crank, X}, {ground, X}, {ground, Y}, 2.5}});
    scene.probes = {{"crank", {crank}}};
    const auto path = walk(scene, load_branch("rest", {}, 1, 1), {0});
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    EXPECT_LE((path.points[0].poses[0].r - Vector3d(0.01, -0.02, 0.03)).norm(), 1e-13);
    EXPECT_LE(path.points[0].poses[0].p.angularDistance(Quaterniond(Eigen::AngleAxisd(2.5, Z))),
              1e-12);
}

// ---- Elements.

// Between two springs in line, k_1 with a growing free length: z = k_1 a / (k_1 + k_2).
TEST(Drivers, FreeLengthPushesAsItsRateSays) {
    const double k_1 = 2e4, k_2 = 3e4;
    Scene scene;
    scene.bodies = {{"block", {0.3 * Z, Quaterniond::Identity()}}};
    scene.joints = {{"guide", Translational{{0}, {ground}, {0, Z}, {ground, Z}}}};
    scene.elastics = {{"lower", AxialSpring{{0}, {ground}, LinearRate{k_1}, 0.3}},
                      {"upper", AxialSpring{{0}, {ground, Z}, LinearRate{k_2}, 0.7}}};
    scene.probes = {{"block", {0}}};
    const double start = -0.01;  // held; settles first
    const auto path =
        walk(scene, driven_branch("lift", {{FreeLength{0}, start, 1}}, 0.05), values_to(0.05, 10));
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    for (const auto& state : path.points)
        EXPECT_NEAR(state.poses[0].r.z(), 0.3 + k_1 * (start + state.load) / (k_1 + k_2), 1e-12)
            << state.load;
}

// A block on one bushing to ground: K e = -a b.
TEST(Drivers, PreloadPushesAsItsStiffnessSays) {
    Scene scene;
    scene.bodies = {{"block", {}}};
    Bushing bushing{Marker{ground}, Marker{0}, LinearStiffness{}, Vector6::Zero()};
    stiffness_of(bushing).diagonal() << 1e5, 2e5, 3e5, 100, 200, 300;
    bushing.preload << 10, 0, 0, 0, 0, 3;
    scene.elastics = {{"bushing", bushing}};
    scene.probes = {{"block", {0}}};
    Vector6 b;
    b << 1, -2, 0.5, 0, 0, 0.02;
    const auto path =
        walk(scene, driven_branch("preload", {{Preload{0, b}, 0, 1}}, 2000, ParameterUnit::newton),
             values_to(2000, 10));
    ASSERT_EQ(path.outcome, Outcome::converged) << path.detail;
    for (const auto& state : path.points) {
        const Vector6 e =
            -(bushing.preload + state.load * b).cwiseQuotient(stiffness_of(bushing).diagonal());
        EXPECT_LE((state.poses[0].r - e.head<3>()).norm(), 1e-13) << state.load;
        EXPECT_LE(state.poses[0].p.angularDistance(Quaterniond(Eigen::AngleAxisd(e[5], Z))), 1e-12)
            << state.load;
    }
}

// ---- Invalid or impossible branches.

TEST(Drivers, OnlyModelsThatStandOnTheBranchAreTaken) {
    Scene scene = jacked_arch();
    scene.branches.push_back(driven_branch("jack", {motion_of(scene, "jack", 1)}, 0.01));
    const Model model = compile(scene);
    const double values[] = {0.0};
    EXPECT_THROW(solve(model, model.branches[0], values), std::invalid_argument);
    EXPECT_THROW(residuals(model, model.branches[0], {}), std::invalid_argument);
    EXPECT_NO_THROW(solve(model, model.branches[2], values));
    EXPECT_NO_THROW(solve(on_branch(model, model.branches[0]), model.branches[0], values));
    Branch both_ways = model.branches[2];
    both_ways.from = -0.01;
    EXPECT_THROW(solve(model, both_ways, values), std::invalid_argument);
}

// A rod lengthened beyond reach: reported with the joint, in the branch's own unit.
TEST(Drivers, WhatIsOutOfReachNamesAJoint) {
    Scene scene = scene_named("pinned_bar");
    scene.joints.push_back(
        {"rod", Distance{{0, {0.5, 0, 0}}, {ground, {0, 0, -1}}, std::hypot(0.5, 1)}});
    const Branch stretch = driven_branch("stretch", {motion_of(scene, "rod", 1)}, 1);
    // The bar's tip is at most 1.5 m from the foot of the rod: a ≤ 1.5 - 1.118 m.
    for (const int steps : {1, 4, 50}) {
        const auto path = walk(scene, stretch, values_to(1, steps));
        EXPECT_EQ(path.outcome, Outcome::inconsistent_constraints) << path.detail;
        EXPECT_NE(path.detail.find("branch 'stretch', at "), std::string::npos) << path.detail;
        EXPECT_NE(path.detail.find(" m: joint '"), std::string::npos) << path.detail;
        EXPECT_NE(path.detail.find("cannot be closed"), std::string::npos) << path.detail;
        for (const auto& state : path.points) EXPECT_LE(state.load, 1.5 - std::hypot(0.5, 1));
    }
    // Held there from the start, it cannot settle.
    auto path = walk(scene, driven_branch("held", {motion_of(scene, "rod", 0, 1)}, 1), {0, 1});
    EXPECT_EQ(path.outcome, Outcome::inconsistent_constraints) << path.detail;
    EXPECT_NE(path.detail.find("settling from the design pose: joint '"), std::string::npos)
        << path.detail;
    EXPECT_TRUE(path.points.empty());
    // Or of negative length.
    path = walk(scene, driven_branch("shorten", {motion_of(scene, "rod", -1)}, 2), {0, 0.1, 2});
    EXPECT_EQ(path.outcome, Outcome::inconsistent_constraints) << path.detail;
    EXPECT_NE(path.detail.find("joint 'rod' would have the length -0.88"), std::string::npos)
        << path.detail;
    EXPECT_EQ(path.points.size(), 2u);
    path = walk(scene, driven_branch("none", {motion_of(scene, "rod", 0, -2)}, 2), {0});
    EXPECT_EQ(path.outcome, Outcome::inconsistent_constraints) << path.detail;
}

TEST(Drivers, MessagesSpeakOfTheParameterInItsUnit) {
    Scene scene = jacked_arch();
    const std::pair<ParameterUnit, const char*> texts[] = {
        {ParameterUnit::newton, "at inf N:"},
        {ParameterUnit::newton_metre, "at inf N·m:"},
        {ParameterUnit::metre, "at inf m:"},
        {ParameterUnit::radian, "at inf rad:"},
        {ParameterUnit::none, "at inf:"}};
    for (const auto& [unit, text] : texts) {
        const Branch down = driven_branch("down", {motion_of(scene, "jack", -1)}, 0.01, unit);
        const auto path = walk(scene, down, {INFINITY});
        EXPECT_EQ(path.outcome, Outcome::not_finite);
        EXPECT_NE(path.detail.find(text), std::string::npos) << path.detail;
    }
}

TEST(Drivers, DriversThatAreNoNumbersNeverConverge) {
    const Scene scene = jacked_strut();
    for (const double bad : {double(NAN), double(INFINITY)}) {
        const std::vector<Driver> drivers{
            motion_of(scene, "jack", bad), motion_of(scene, "jack", 1, bad),
            motion_of(scene, "tie_rod", bad), Driver{FreeLength{0}, 0, bad},
            Driver{Preload{1, Vector6::Constant(bad)}, 0, 1}};
        for (const auto& driver : drivers) {
            const auto path = walk(scene, driven_branch("bad", {driver}, 0.01), {0, 0.01});
            EXPECT_NE(path.outcome, Outcome::converged) << path.detail;
            EXPECT_LT(path.points.size(), 2u);
        }
    }
}

// An angle satisfies its equation in the opposite direction too: the residuals must detect it.
TEST(Drivers, AnAngleTheOtherWayRoundIsNoGoodState) {
    Scene scene;
    const BodyId crank = add_crank(scene, "crank", Vector3d::Zero());
    add_angle_drive(scene, crank);
    scene.probes = {{"crank", {crank}}};
    scene.branches = {
        driven_branch("turn", {motion_of(scene, "drive", 1)}, 1, ParameterUnit::radian)};
    const Model model = compile(scene);
    Equilibrium state{1, {{Vector3d::Zero(), Quaterniond(Eigen::AngleAxisd(1, Z))}}, {}, 0};
    EXPECT_LE(largest(residuals(model, model.branches[0], state)), 1e-12);
    state.poses[0].p = Eigen::AngleAxisd(1 + pi, Z);
    EXPECT_EQ(residuals(model, model.branches[0], state).direction, 2);
}

// An angle held far from its design value is reached by rotation: beyond a right angle the opposite
// direction satisfies Φ = 0 as well and is nearer.
TEST(Drivers, AnAngleHeldBeyondARightAngleSettlesTheRightWayRound) {
    for (const double held : {-2.9, -2.0, -0.5, 0.5, 1.7, 2.5, 3.0}) {
        Scene scene;
        scene.bodies = {{"arm", {}}};
        scene.joints = {{"pin", Revolute{{0}, {ground}, {0, Z}, {ground, Z}}},
                        {"crank", Angle{{0, X}, {ground, X}, {ground, Y}, 0}}};
        scene.probes = {{"tip", {0, X}}};
        scene.branches = {{.name = "turn",
                           .to = 0.1,
                           .steps = 1,
                           .unit = ParameterUnit::radian,
                           .drivers = {{Motion{1}, held, 1}}}};
        const double values[] = {0, 0.1};
        const auto path = solve(scene, 0, values);
        ASSERT_EQ(path.outcome, Outcome::converged) << held << ": " << path.detail;
        for (const auto& state : path.points) {
            const double angle = held + state.load;
            const Eigen::Vector3d expected(std::cos(angle), std::sin(angle), 0);
            EXPECT_LE((position(state, scene.probes[0].at) - expected).norm(), 1e-12) << held;
        }
    }
}

}  // namespace
}  // namespace elastocheck::reference::energy
