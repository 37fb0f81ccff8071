// Invariance of the energy leg: unit of length, ground frame, body frames, order, mirror image.
#include <numeric>

#include "support.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// Transform of a scene, by the kind of its parts; the identity by default.
struct Change {
    std::function<void(Body&)> body = [](Body&) {};
    std::function<void(Point&)> point = [](Point&) {};
    std::function<void(Direction&)> direction = [](Direction&) {};
    std::function<void(Marker&)> marker = [](Marker&) {};
    std::function<void(double&)> length = [](double&) {};
    std::function<void(Bushing&)> bushing = [](Bushing&) {};
    std::function<void(AxialSpring&)> spring = [](AxialSpring&) {};
    std::function<void(Vector3d&)> force = [](Vector3d&) {};
    std::function<void(Vector3d&)> moment = [](Vector3d&) {};
    std::function<void(BodyId&)> id = [](BodyId&) {};
    std::function<void(int&)> joint = [](int&) {};
    std::function<void(Vector6&)> preload = [](Vector6&) {};
};

Scene changed(Scene scene, const Change& change) {
    const auto point = [&](Point& p) { change.point(p), change.id(p.body); };
    const auto direction = [&](Direction& d) { change.direction(d), change.id(d.body); };
    const auto marker = [&](Marker& m) { change.marker(m), change.id(m.body); };
    const auto load = [&](Load& l) {
        if (auto* force = std::get_if<DeadForce>(&l.kind)) {
            point(force->at);
            change.force(force->f);
        } else {
            auto& moment = std::get<DeadMoment>(l.kind);
            change.id(moment.body);
            change.moment(moment.m);
        }
    };
    for (auto& body : scene.bodies) change.body(body);
    for (auto& joint : scene.joints) {
        std::visit(
            [&](auto& s) {
                if constexpr (requires { s.i.s_local; }) point(s.i), point(s.j);
                if constexpr (requires { s.i.u_local; }) direction(s.i), direction(s.j);
                if constexpr (requires { s.axis_i; }) direction(s.axis_i);
                if constexpr (requires { s.axis_j; }) direction(s.axis_j);
                if constexpr (requires { s.normal_i; }) direction(s.normal_i);
                if constexpr (requires { s.normal_j; }) direction(s.normal_j);
                if constexpr (requires { s.x_i; })
                    direction(s.x_i), direction(s.y_i), direction(s.x_j), direction(s.y_j);
                if constexpr (requires { s.length; }) change.length(s.length);
                if constexpr (requires { s.offset; }) change.length(s.offset);
            },
            joint.kind);
    }
    for (auto& elastic : scene.elastics) {
        if (auto* spring = std::get_if<AxialSpring>(&elastic.kind)) {
            point(spring->i), point(spring->j);
            change.spring(*spring);
        } else {
            auto& bushing = std::get<Bushing>(elastic.kind);
            marker(bushing.i), marker(bushing.j);
            change.bushing(bushing);
        }
    }
    for (auto& l : scene.static_loads) load(l);
    for (auto& branch : scene.branches)
        for (auto& driver : branch.drivers)
            if (auto* l = std::get_if<Load>(&driver.what)) {
                load(*l);
            } else if (auto* motion = std::get_if<Motion>(&driver.what)) {
                change.length(driver.start), change.length(driver.rate);
                change.joint(motion->joint);
            } else if (std::holds_alternative<FreeLength>(driver.what)) {
                change.length(driver.start), change.length(driver.rate);
            } else {
                change.preload(std::get<Preload>(driver.what).direction);
            }
    for (auto& probe : scene.probes) point(probe.at);
    for (auto& damper : scene.dampers) point(damper.i), point(damper.j);
    for (auto& wheel : scene.wheels) {
        Point centre{wheel.body, wheel.centre_local};
        Point contact{wheel.body, wheel.contact_local};
        Direction axis{wheel.body, wheel.spin_axis_local};
        point(centre), point(contact), direction(axis);
        wheel.body = centre.body;
        wheel.centre_local = centre.s_local;
        wheel.contact_local = contact.s_local;
        wheel.spin_axis_local = axis.u_local;
        if (auto& steering = wheel.steering_axis) point(steering->lower), point(steering->upper);
    }
    return scene;
}

// McPherson scene with more effects: preload, a moment, coupling in a bushing, a static load.
std::vector<Scene> scenes() {
    Random random;
    Scene hard = scene_named("chrono_mcpherson");
    auto& coil = std::get<AxialSpring>(hard.elastics[0].kind);
    coil.free_length += 3000 / rate_of(coil);
    auto& bushing = std::get<Bushing>(hard.elastics[2].kind);
    Matrix6 R;
    for (int i = 0; i < 6; ++i) R.col(i) = random.many(6);
    stiffness_of(bushing) += 100 * R * R.transpose();
    bushing.preload = random.many(6, 50);
    hard.static_loads = {
        {"weight", DeadForce{{hard.wheels[0].body, Vector3d(0, 0.01, -0.1)}, {50, 30, 2500}}},
        {"moment", DeadMoment{hard.wheels[0].body, {5, -10, 7}}}};
    hard.branches[0].drivers.push_back(
        {Load{"turn", DeadMoment{hard.wheels[0].body, {0.002, -0.01, 0.005}}}, 0, 1});
    // A scene with all kinds of drivers: jack, tie rod, free length, preload, a load held and
    // moved.
    Scene driven = hard;
    driven.name = "driven McPherson";
    const Wheel& wheel = driven.wheels[0];
    const Pose& design = driven.bodies[static_cast<std::size_t>(wheel.body)].design;
    driven.joints.push_back({"jack",
                             InPlane{{wheel.body, wheel.centre_local},
                                     {ground, design.r + design.p * wheel.centre_local},
                                     {ground, Vector3d(0, 0.6, 0.8)},
                                     0.001},
                             true});
    driven.branches = {
        {.name = "all",
         .to = 1,
         .steps = 10,
         .unit = ParameterUnit::none,
         .drivers = {{Motion{4}, 0.01, 0.03},
                     {Motion{2}, -0.001, 0.002},
                     {FreeLength{0}, 0.002, 0.01},
                     {Preload{3, random.many(6, 20)}, 1, 2},
                     {Load{"brake", DeadForce{{wheel.body, Vector3d(0, 0.05, 0)}, {-1, 0.2, 0}}},
                      300, 200}}}};
    return {scene_named("chrono_mcpherson"),
            hard,
            driven,
            scene_named("pinned_bar"),
            scene_named("bushing_pair"),
            scene_named("pendulum"),
            scene_named("two_spring_arch")};
}

using Map = std::function<Vector3d(const Vector3d&)>;

Vector3d same(const Vector3d& v) { return v; }

// Inverse of a transform.
struct Back {
    Map position = same, force = same, moment = same;
    std::vector<std::size_t> joint = {};  // new positions of the joints; empty: unchanged
};

struct Compared {
    double moved = 0, worst = 0;        // [m]
    double force = 0, worst_force = 0;  // [N], [N·m]
};

// Compares positions of all attachment points and all reactions at points of every branch. Points
// instead of poses, since body frames differ.
void compare(Compared& c, const Scene& scene, const Scene& other, const Back& back) {
    for (std::size_t b = 0; b < scene.branches.size(); ++b) {
        const auto loads = sweep(scene.branches[b], 12);
        const auto one = solve(scene, b, loads), two = solve(other, b, loads);
        ASSERT_EQ(one.outcome, Outcome::converged) << scene.name << ": " << one.detail;
        ASSERT_EQ(two.outcome, Outcome::converged) << scene.name << ": " << two.detail;
        for (std::size_t k = 0; k < loads.size(); ++k) {
            const auto track = [&](const auto& p, const auto& q) {
                const Vector3d here = position(one.points[k], {p.body, p.s_local});
                const Vector3d there = position(two.points[k], {q.body, q.s_local});
                c.worst = std::max(c.worst, (here - back.position(there)).norm());
                c.moved =
                    std::max(c.moved, (here - position(one.points[0], {p.body, p.s_local})).norm());
            };
            for (std::size_t e = 0; e < scene.elastics.size(); ++e) {
                std::visit(
                    [&](const auto& s) {
                        const auto& t = std::get<std::decay_t<decltype(s)>>(other.elastics[e].kind);
                        track(s.i, t.i);
                        track(s.j, t.j);
                    },
                    scene.elastics[e].kind);
            }
            for (std::size_t p = 0; p < scene.probes.size(); ++p)
                track(scene.probes[p].at, other.probes[p].at);
            for (std::size_t w = 0; w < scene.wheels.size(); ++w)
                track(Point{scene.wheels[w].body, scene.wheels[w].contact_local},
                      Point{other.wheels[w].body, other.wheels[w].contact_local});
            ASSERT_EQ(one.points[k].reactions.size(), scene.joints.size());
            for (std::size_t j = 0; j < scene.joints.size(); ++j) {
                const Wrench& w = one.points[k].reactions[j];
                const Wrench& v = two.points[k].reactions[back.joint.empty() ? j : back.joint[j]];
                c.force = std::max(c.force, w.force.norm());
                c.worst_force = std::max({c.worst_force, (w.force - back.force(v.force)).norm(),
                                          (w.moment - back.moment(v.moment)).norm()});
            }
        }
    }
}

void expect_same(const Compared& c, const std::string& what) {
    EXPECT_GT(c.moved, 1e-3) << what;
    EXPECT_LE(c.worst, 1e-9 * c.moved) << what;  // required: 1e-7
    EXPECT_LE(c.worst_force, 1e-8 * (1 + c.force)) << what;
}

TEST(Invariance, GroundFrameDoesNotMatter) {
    Random random;
    for (const auto& scene : scenes()) {
        Compared c;
        for (int repeat = 0; repeat < 3; ++repeat) {
            const Quaterniond Q = random.rotation();
            const Vector3d t = random.vector(5);
            Change change;
            change.body = [&](Body& body) {
                body.design = {Q * body.design.r + t, Q * body.design.p};
            };
            change.point = [&](Point& p) {
                if (p.body == ground) p.s_local = Q * p.s_local + t;
            };
            change.direction = [&](Direction& d) {
                if (d.body == ground) d.u_local = Q * d.u_local;
            };
            change.marker = [&](Marker& m) {
                if (m.body == ground) m = {ground, Q * m.s_local + t, Q * m.A_local};
            };
            change.force = change.moment = [&](Vector3d& f) { f = Q * f; };
            const auto back = [&](const Vector3d& p) -> Vector3d {
                return Q.conjugate() * (p - t);
            };
            const auto back_force = [&](const Vector3d& f) -> Vector3d {
                return Q.conjugate() * f;
            };
            compare(c, scene, changed(scene, change), {back, back_force, back_force});
        }
        expect_same(c, scene.name);
    }
}

// At a distance where a double resolves 2e-12 m, the results are the same to some thousand of
// these.
TEST(Invariance, TenKilometresFromTheOriginIsAsGoodAsAtHome) {
    const Vector3d t(1e4, 0, 0);
    Change change;
    change.body = [&](Body& body) { body.design.r += t; };
    change.point = [&](Point& p) {
        if (p.body == ground) p.s_local += t;
    };
    change.marker = [&](Marker& m) {
        if (m.body == ground) m.s_local += t;
    };
    for (const char* name : {"four_bar", "chrono_mcpherson_preload"}) {
        const Scene scene = scene_named(name);
        const Model home = compile(scene), away = compile(changed(scene, change));
        const auto way = [](const Model& model) { return ways(model.branches[0]).back(); };
        std::vector<double> values;
        for (int n = 0; n <= 4; ++n) values.push_back(way(home).to * n / 4);
        const auto here = solve(on_branch(home, way(home)), way(home), values),
                   there = solve(on_branch(away, way(away)), way(away), values);
        ASSERT_EQ(here.outcome, Outcome::converged) << name << ": " << here.detail;
        ASSERT_EQ(there.outcome, Outcome::converged) << name << ": " << there.detail;
        for (std::size_t p = 0; p < values.size(); ++p)
            for (std::size_t b = 0; b < home.bodies.size(); ++b)
                EXPECT_LE((there.points[p].poses[b].r - t - here.points[p].poses[b].r).norm(), 1e-8)
                    << name << " " << values[p];
    }
}

TEST(Invariance, BodyFramesDoNotMatter) {
    Random random;
    for (const auto& scene : scenes()) {
        std::vector<Pose> frames;
        for (std::size_t b = 0; b < scene.bodies.size(); ++b)
            frames.push_back({random.vector(0.5), random.rotation()});
        const auto frame = [&](BodyId body) {
            return body == ground ? Pose{} : frames[static_cast<std::size_t>(body)];
        };
        Change change;
        std::size_t next = 0;
        change.body = [&](Body& body) {
            const Pose& f = frames[next++];
            body.design = {body.design.r + body.design.p * f.r, body.design.p * f.p};
        };
        change.point = [&](Point& p) {
            p.s_local = frame(p.body).p.conjugate() * (p.s_local - frame(p.body).r);
        };
        change.direction = [&](Direction& d) {
            d.u_local = frame(d.body).p.conjugate() * d.u_local;
        };
        change.marker = [&](Marker& m) {
            const Pose f = frame(m.body);
            m = {m.body, f.p.conjugate() * (m.s_local - f.r), f.p.conjugate() * m.A_local};
        };
        Compared c;
        compare(c, scene, changed(scene, change), {});
        expect_same(c, scene.name);
    }
}

TEST(Invariance, OrderDoesNotMatter) {
    for (const auto& scene : scenes()) {
        const int nb = static_cast<int>(scene.bodies.size());
        Change change;
        change.id = [&](BodyId& id) {
            if (id != ground) id = nb - 1 - id;
        };
        change.joint = [&](int& joint) {
            joint = static_cast<int>(scene.joints.size()) - 1 - joint;
        };
        Scene other = changed(scene, change);
        std::reverse(other.bodies.begin(), other.bodies.end());
        std::reverse(other.joints.begin(), other.joints.end());
        std::vector<std::size_t> joint_of(scene.joints.size());
        std::iota(joint_of.rbegin(), joint_of.rend(), 0);
        Compared c;
        compare(c, scene, other, {.joint = joint_of});
        expect_same(c, scene.name);
    }
}

TEST(Invariance, SideOfTheCarDoesNotMatter) {
    const Vector3d mirror(1, -1, 1);
    const auto reflected = [&](const Vector3d& v) -> Vector3d { return mirror.cwiseProduct(v); };
    const auto reflected_axes = [&](const Quaterniond& q) {
        return Quaterniond(
            Matrix3d(mirror.asDiagonal() * q.toRotationMatrix() * mirror.asDiagonal()));
    };
    for (const auto& scene : scenes()) {
        Change change;
        change.body = [&](Body& body) {
            body.design = {reflected(body.design.r), reflected_axes(body.design.p)};
        };
        change.point = [&](Point& p) { p.s_local = reflected(p.s_local); };
        change.direction = [&](Direction& d) { d.u_local = reflected(d.u_local); };
        change.marker = [&](Marker& m) {
            m = {m.body, reflected(m.s_local), reflected_axes(m.A_local)};
        };
        change.bushing = [&](Bushing& b) {
            Vector6 T;
            T << mirror, -mirror;
            stiffness_of(b) = T.asDiagonal() * stiffness_of(b) * T.asDiagonal();
            b.preload = T.cwiseProduct(b.preload);
        };
        change.preload = [&](Vector6& b) {
            b.head<3>() = reflected(b.head<3>());
            b.tail<3>() = -reflected(b.tail<3>());
        };
        change.force = [&](Vector3d& f) { f = reflected(f); };
        change.moment = [&](Vector3d& m) { m = -reflected(m); };
        Scene other = changed(scene, change);
        for (auto& wheel : other.wheels) wheel.side = -1;
        Compared c;
        const auto axial = [&](const Vector3d& m) -> Vector3d { return -reflected(m); };
        compare(c, scene, other, {reflected, reflected, axial});
        expect_same(c, scene.name);
    }
}

// The same numbers in millimetres: every length times 1000, the same forces.
TEST(Invariance, UnitOfLengthDoesNotMatter) {
    for (const double unit : {1e-3, 1e3}) {
        for (const auto& scene : scenes()) {
            Change change;
            change.body = [&](Body& body) { body.design.r *= unit; };
            change.point = [&](Point& p) { p.s_local *= unit; };
            change.marker = [&](Marker& m) { m.s_local *= unit; };
            change.length = [&](double& length) { length *= unit; };
            change.spring = [&](AxialSpring& s) {
                rate_of(s) /= unit;
                s.free_length *= unit;
            };
            change.bushing = [&](Bushing& b) {
                Vector6 T;
                T << Vector3d::Constant(1 / unit), Vector3d::Ones();
                stiffness_of(b) = unit * T.asDiagonal() * stiffness_of(b) * T.asDiagonal();
                b.preload.tail<3>() *= unit;
            };
            change.preload = [&](Vector6& b) { b.tail<3>() *= unit; };
            change.moment = [&](Vector3d& m) { m *= unit; };
            Compared c;
            const auto smaller = [&](const Vector3d& v) -> Vector3d { return v / unit; };
            compare(c, scene, changed(scene, change), {smaller, same, smaller});
            expect_same(c, scene.name);
        }
    }
}

// The same bar in two scene files: in mm and degrees, and in m and radians.
TEST(Invariance, MillimetreTwinGivesTheSame) {
    const Scene twin = parse_scene(R"(
elastocheck: 1
name: Pinned bar in metres
units: {length: m, angle: rad, force: N}
points: {pin: [0, 0, 0], tip: [0.5, 0, 0]}
bodies: {bar: {origin: pin}}
joints: {pin: {type: revolute, bodies: [bar, ground], at: pin, axis: y}}
bushings: {tip: {bodies: [bar, ground], at: tip, rates: [20e3, 20e3, 20e3]}}
loads: {vertical: {on: bar, at: tip, force: [0, 0, 1]}}
branches: {up: {load: vertical, to: 5000, steps: 100}, down: {load: vertical, to: -5000, steps: 100}}
probes: {tip: {on: bar, at: tip}}
)",
                                   "twin");
    Compared c;
    compare(c, scene_named("pinned_bar"), twin, {});
    expect_same(c, "twin");
}

}  // namespace
}  // namespace elastocheck::reference::energy
