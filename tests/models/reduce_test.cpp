// Model reduction by compile(): merged bodies, links, parts within one body, duplicates.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/compile/parts.hpp"
#include "models/compile/passes.hpp"

namespace elastocheck {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// ---- Small scenes. Bodies a, b, c, ... have arbitrary poses; a is the output.

Scene bodies(int count) {
    Scene scene;
    for (int n = 0; n < count; ++n) {
        const Vector3d axis = Vector3d(1, n, 2 - n).normalized();
        scene.bodies.push_back(
            {std::string(1, static_cast<char>('a' + n)),
             {Vector3d(n, 0.3 * n, -0.2 * n), Quaterniond(AngleAxisd(0.4 * n + 0.1, axis))}});
    }
    scene.probes.push_back({"output", {.body = 0}});
    return scene;
}

// A point at p, or a direction along u, in ground axes, as a part of the body.
Point at(const Scene& scene, BodyId body, const Vector3d& p) {
    const Pose pose = reduce::design(scene, body);
    return {body, pose.p.conjugate() * (p - pose.r)};
}
Direction along(const Scene& scene, BodyId body, const Vector3d& u) {
    return {body, reduce::design(scene, body).p.conjugate() * u.normalized()};
}
Marker marker(const Scene& scene, BodyId body, const Vector3d& p) {
    return {body, at(scene, body, p).s_local, reduce::design(scene, body).p.conjugate()};
}

Fixed fixed(const Scene& s, BodyId i, BodyId j, const Vector3d& p) {
    const Vector3d x(1, 2, 0), y(-2, 1, 0);
    return {at(s, i, p),    at(s, j, p),    along(s, i, x),
            along(s, i, y), along(s, j, x), along(s, j, y)};
}
Revolute hinge(const Scene& s, BodyId i, BodyId j, const Vector3d& p, const Vector3d& axis) {
    return {at(s, i, p), at(s, j, p), along(s, i, axis), along(s, j, axis)};
}
Spherical ball(const Scene& s, BodyId i, BodyId j, const Vector3d& p) {
    return {at(s, i, p), at(s, j, p)};
}
Bushing bushing(const Scene& s, BodyId i, BodyId j, const Vector3d& p) {
    return {
        .i = marker(s, i, p), .j = marker(s, j, p), .law = LinearStiffness{Matrix6::Identity()}};
}
AxialSpring spring(const Scene& s, BodyId i, BodyId j, const Vector3d& p, const Vector3d& q) {
    return {at(s, i, p), at(s, j, q), LinearRate{1e3}, 0.9 * (q - p).norm()};
}
Load push(const Scene& s, const std::string& name, BodyId on, const Vector3d& p) {
    return {name, DeadForce{at(s, on, p), Vector3d(1, 2, 3)}};
}
Branch pushing(const Load& load) {
    Branch branch;
    branch.name = "up";
    branch.to = 1;
    branch.steps = 1;
    branch.drivers.push_back({.what = load, .start = 0, .rate = 1});
    return branch;
}

using Reasons = std::map<std::string, std::string>;
template <class Owner>
Reasons omitted(const Owner& owner) {
    Reasons reasons;
    for (const auto& [what, why] : owner.omitted)
        EXPECT_TRUE(reasons.emplace(what, why).second) << what << " twice";
    return reasons;
}

template <class List>
std::string names(const List& list) {
    std::string names;
    for (const auto& item : list) names += (names.empty() ? "" : " ") + item.name;
    return names;
}

// Positions and directions of all parts in ground axes, by name.
std::map<std::string, std::vector<Vector3d>> places(Scene scene) {
    std::map<std::string, std::vector<Vector3d>> result;
    std::vector<Vector3d>* list = nullptr;
    const auto note =
        overloaded{[&](const Point& p) { list->push_back(reduce::position(scene, p)); },
                   [&](const Direction& u) { list->push_back(reduce::direction(scene, u)); },
                   [&](const Marker& m) {
                       list->push_back(reduce::position(scene, {m.body, m.s_local}));
                       const Quaterniond A = reduce::design(scene, m.body).p * m.A_local;
                       list->emplace_back(A * Vector3d::UnitX());
                       list->emplace_back(A * Vector3d::UnitY());
                   }};
    for (Joint& joint : scene.joints) {
        list = &result["joint " + joint.name];
        each_member(joint.kind, note);
    }
    for (Elastic& elastic : scene.elastics) {
        list = &result["element " + elastic.name];
        each_member(elastic.kind, note);
    }
    const auto load = [&](const Load& l) {
        list = &result["load " + l.name];
        std::visit(overloaded{[&](const DeadForce& f) { note(f.at), list->push_back(f.f); },
                              [&](const DeadMoment& m) { list->push_back(m.m); },
                              [&](const FollowerForce& f) {
                                  note(f.at), note(Direction{f.at.body, f.f_local});
                              },
                              [&](const FollowerMoment& m) {
                                  note(Direction{m.body, m.m_local});
                              },
                              [&](const BrakeForce& b) { note(b.patch), list->push_back(b.f); }},
                   l.kind);
    };
    for (const Load& l : scene.static_loads) load(l);
    for (const Branch& branch : scene.branches)
        for (const Driver& driver : branch.drivers)
            if (const auto* l = std::get_if<Load>(&driver.what)) load(*l);
    for (const Wheel& wheel : scene.wheels) {
        list = &result["wheel " + wheel.name];
        note(Point{wheel.body, wheel.centre_local}), note(wheel.contact);
        note(Direction{wheel.body, wheel.spin_axis_local});
        if (wheel.steering_axis) note(wheel.steering_axis->lower), note(wheel.steering_axis->upper);
    }
    for (const Damper& damper : scene.dampers) {
        list = &result["damper " + damper.name];
        note(damper.i), note(damper.j);
    }
    for (const Probe& probe : scene.probes) {
        list = &result["probe " + probe.name];
        note(probe.at);
    }
    return result;
}

// All kinds of parts on bodies b and c, which a chain of Fixed joints connects to each other
// and to d.
Scene welded() {
    Scene s = bodies(5);
    const Vector3d p(0.3, -0.2, 0.5), q(1, 0.4, 0.2), n(1, 1, 3);
    s.joints = {{"weld_cb", fixed(s, 2, 1, p)},
                {"weld_dc", fixed(s, 3, 2, q)},
                {"hinge", hinge(s, 2, 0, p, n)},
                {"ball", ball(s, 3, 0, q)},
                {"rod", Distance{at(s, 3, p), at(s, 4, q), (q - p).norm()}},
                {"plane", InPlane{at(s, 4, p), at(s, 2, p), along(s, 2, n), 0}},
                {"square", Perpendicular{along(s, 3, {1, 1, 0}), along(s, 4, {1, -1, 0})}},
                {"cross", Universal{at(s, 3, p), at(s, 4, p), along(s, 3, {1, 1, 0}),
                                    along(s, 4, {1, -1, 0})}},
                {"drive",
                 Angle{along(s, 4, {1, 0, 0}), along(s, 3, {1, 0, 0}), along(s, 3, {0, 1, 0}), 0}}};
    s.elastics = {{"coil", spring(s, 3, 0, p, q)}, {"rubber", bushing(s, 0, 2, q)}};
    s.static_loads = {push(s, "weight", 3, q), {"twist", DeadMoment{2, Vector3d(1, 2, 3)}}};
    s.branches = {pushing({"thrust", FollowerForce{at(s, 3, q), Vector3d(1, 2, 3)}}),
                  pushing({"spin", FollowerMoment{2, Vector3d(1, 2, 3)}})};
    s.wheels.push_back({.name = "wheel",
                        .body = 3,
                        .centre_local = Vector3d(1, 2, 3),
                        .contact = {3, Vector3d(4, 5, 6)}});
    s.wheels.back().steering_axis = {at(s, 3, p), at(s, 2, q)};
    s.probes.push_back({"tip", at(s, 2, n)});
    s.dampers.push_back({"damper", at(s, 3, q), at(s, 2, p)});
    return s;
}

TEST(Weld, BodiesFixedToEachOtherAreMerged) {
    Scene scene = welded();
    const auto before = places(scene);
    reduce::weld(scene);
    EXPECT_EQ(names(scene.bodies), "a b e");
    EXPECT_EQ(names(scene.joints), "hinge ball rod plane square cross drive");
    const std::string weld =
        "the bodies that it fixes to each other become one; its reaction is not an output";
    EXPECT_EQ(omitted(scene),
              (Reasons{{"joint 'weld_cb'", weld},
                       {"joint 'weld_dc'", weld},
                       {"body 'c'", "fixed to body 'b', with which it becomes one body"},
                       {"body 'd'", "fixed to body 'b', with which it becomes one body"}}));
    EXPECT_EQ(scene.wheels.at(0).body, 1);
    EXPECT_EQ(ends(scene.elastics.at(1).kind).j, 1);
    const auto after = places(scene);
    double worst = 0;
    for (const auto& [what, where] : after) {
        ASSERT_EQ(where.size(), before.at(what).size()) << what;
        for (std::size_t k = 0; k < where.size(); ++k) {
            const double moved = (where[k] - before.at(what)[k]).norm();
            EXPECT_LE(moved, 1e-15 * 40) << what << ", place " << k;
            worst = std::max(worst, moved);
        }
    }
    EXPECT_EQ(after.size() + 2, before.size());
    RecordProperty("worst_moved", fmt::format("{:g}", worst));
}

TEST(Weld, BodyFixedToGroundIsRemovedWithItsLoads) {
    Scene s = bodies(3);
    s.joints = {{"root", hinge(s, 0, 1, Vector3d(0, 0, 1), Vector3d(1, 0, 0))},
                {"weld", fixed(s, 1, 2, Vector3d(1, 1, 1))},
                {"foot", fixed(s, ground, 2, Vector3d(0, 1, 1))}};
    s.elastics = {{"coil", spring(s, 0, 2, Vector3d(0, 0, 0), Vector3d(0, 0, 1))}};
    s.static_loads = {push(s, "weight", 1, Vector3d(0, 0, 0))};
    s.branches = {pushing(push(s, "load", 2, Vector3d(0, 0, 0))),
                  pushing(push(s, "near", 0, Vector3d(0, 0, 0)))};
    const Model model = compile(s);
    EXPECT_EQ(names(model.bodies), "a");
    EXPECT_EQ(names(model.joints), "root");
    EXPECT_EQ(model.joints.at(0).j, ground);
    EXPECT_TRUE(model.static_loads.empty());
    const Reasons reasons = omitted(model);
    EXPECT_EQ(reasons.at("body 'b'"), "fixed to ground");
    EXPECT_EQ(reasons.at("body 'c'"), "fixed to ground");
    EXPECT_EQ(reasons.at("load 'weight'"), "body 'b' is welded to ground");
    EXPECT_EQ(reasons.at("load 'load'"), "body 'c' is welded to ground (branch 'up')");
    const auto& coil = std::get<AxialSpring>(model.elastics.at(0).kind);
    EXPECT_EQ(coil.j.body, ground);
    EXPECT_LE((coil.j.s_local - Vector3d(0, 0, 1)).norm(), 1e-15);
}

TEST(Weld, GapPreventsMergingAndOutputsOnGroundAreKept) {
    Scene apart = bodies(2);
    Fixed weld = fixed(apart, 0, 1, Vector3d(1, 1, 1));
    weld.j.s_local.x() += 1e-9;
    apart.joints = {{"weld", weld}};
    reduce::weld(apart);
    EXPECT_EQ(names(apart.bodies), "a b");
    Scene turned = bodies(2);
    weld = fixed(turned, 0, 1, Vector3d(1, 1, 1));
    weld.x_i.u_local = AngleAxisd(1e-9, Vector3d::UnitZ()) * weld.x_i.u_local;
    turned.joints = {{"weld", weld}};
    reduce::weld(turned);
    EXPECT_EQ(names(turned.bodies), "a b");

    for (const bool output_first : {true, false}) {
        Scene s = bodies(2);
        s.joints = {{"foot", fixed(s, output_first ? 0 : 1, ground, Vector3d(0, 0, 0))},
                    {"weld", fixed(s, 0, 1, Vector3d(1, 1, 1))}};
        reduce::weld(s);
        EXPECT_EQ(s.probes.at(0).at.body, 0);
        EXPECT_EQ(s.joints.size(), 1U) << "one weld holds the output to ground";
    }
}

// ---- Within one body.

TEST(PartsWithinOneBody, JointsAndElementsWithoutEffectAreRemoved) {
    Scene s = bodies(3);
    const Vector3d o(0, 0, 0), p(0, 0, 1);
    s.joints = {{"weld", fixed(s, 1, 2, p)},
                {"foot", fixed(s, 2, ground, p)},
                {"root", hinge(s, 0, 1, o, p)},
                {"inner", ball(s, 1, 2, o)},
                {"grounded", Distance{at(s, 1, o), {ground, p}, 1}}};
    s.elastics = {{"coil", spring(s, 1, ground, o, p)}, {"rubber", bushing(s, 1, 2, p)}};
    const Model model = compile(s);
    EXPECT_EQ(names(model.joints), "root");
    EXPECT_TRUE(model.elastics.empty());
    const Reasons reasons = omitted(model);
    EXPECT_EQ(reasons.at("joint 'inner'"),
              "both its ends are on ground; its reaction is not an output");
    EXPECT_EQ(reasons.at("joint 'grounded'"),
              "both its ends are on ground; its reaction is not an output");
    EXPECT_EQ(reasons.at("element 'coil'"), "both its ends are on ground");
    EXPECT_EQ(reasons.at("element 'rubber'"), "both its ends are on ground");
}

TEST(PartsWithinOneBody, StrainedDrivenOrFollowerPartsAreKept) {
    const Vector3d o(0, 0, 0), p(0, 0, 1);
    const auto scene = [&] {
        Scene s = bodies(2);
        s.joints = {{"weld", fixed(s, 0, 1, p)}};
        return s;
    };
    Scene strained = scene();
    strained.joints.push_back({"rod", Distance{at(strained, 0, o), at(strained, 1, p), 1.1}});
    EXPECT_EQ(names(compile(strained).joints), "rod");

    Scene driven = scene();
    driven.joints.push_back({"rod", Distance{at(driven, 0, o), at(driven, 1, p), 1}});
    driven.branches = {pushing(push(driven, "load", 0, o))};
    driven.branches[0].drivers.push_back({.what = Motion{1}, .start = 0, .rate = 1});
    const Model model = compile(driven);
    EXPECT_EQ(names(model.joints), "rod");
    EXPECT_EQ(std::get<Motion>(model.branches.at(0).drivers.at(1).what).joint, 0);

    for (const bool loaded : {true, false})
        for (const bool energy : {true, false}) {
            Scene s = scene();
            Bushing rubber = bushing(s, 0, 1, p);
            rubber.formulation.offset_moment = energy;
            if (loaded) rubber.preload[1] = 3;
            s.elastics = {{"rubber", rubber}};
            EXPECT_EQ(compile(s).elastics.size(), loaded && !energy ? 1U : 0U) << loaded << energy;
        }
}

// ---- Links.

// a has a spring, and link b connects it to ground.
Scene linked() {
    Scene s = bodies(2);
    s.joints = {{"outer", ball(s, 0, 1, Vector3d(0.1, 0, 0))},
                {"inner", ball(s, 1, ground, Vector3d(0.1, -0.4, 0.3))},
                {"root", hinge(s, 0, ground, Vector3d(0, 0, 0), Vector3d(0, 0, 1))}};
    s.elastics = {{"coil", spring(s, 0, ground, Vector3d(0, 0, 0), Vector3d(0, 0, 1))}};
    s.branches = {pushing(push(s, "load", 0, Vector3d(1, 0, 0)))};
    return s;
}

TEST(Link, BodyWithTwoBallJointsBecomesADistance) {
    const Model model = compile(linked());
    EXPECT_EQ(names(model.bodies), "a");
    EXPECT_EQ(names(model.joints), "b root");
    const auto& distance = std::get<DistanceBetween>(model.constraints.at(0).kind);
    EXPECT_NEAR(distance.length, 0.5, 1e-15);
    EXPECT_EQ(distance.i.body, 0);
    EXPECT_EQ(distance.j.body, ground);
    EXPECT_LE((distance.j.s_local - Vector3d(0.1, -0.4, 0.3)).norm(), 1e-15);
    EXPECT_EQ(
        omitted(model),
        (Reasons{{"body 'b'",
                  "a link with a ball at each end and no load: replaced by the distance joint 'b'"},
                 {"joint 'outer'",
                  "an end of body 'b'; its reaction is not an output, that of joint 'b' is"},
                 {"joint 'inner'",
                  "an end of body 'b'; its reaction is not an output, that of joint 'b' is"}}));
    // The link's 6 coordinates and 6 rows become 1 row: its spin is removed.
    EXPECT_EQ(model.as_written, (Size{2, 3, 1, 3 + 3 + 5}));
    EXPECT_EQ(model.as_solved, (Size{1, 2, 1, 1 + 5}));
}

// All other reasons to keep a link are tested in Compile.LoadedBodyOfAFreeChainAndLoadedLinkAreKept.
TEST(Link, BodyWithAnotherJointOrCoincidentBallsIsKept) {
    Scene hinged = linked(), short_link = linked();
    hinged.joints[0].kind = hinge(hinged, 0, 1, Vector3d(0.1, 0, 0), Vector3d(0.2, 0.1, 0));
    short_link.joints[1].kind = ball(short_link, 1, ground, Vector3d(0.1, 0, 0));
    for (const Scene& scene : {hinged, short_link}) EXPECT_EQ(names(compile(scene).bodies), "a b");
}

TEST(Link, DistanceJointOfALinkGetsAnUnusedName) {
    Scene own = linked();
    own.joints[0].name = "b";  // name of the removed link
    const Model model = compile(own);
    EXPECT_EQ(names(model.joints), "b root");
    EXPECT_EQ(omitted(model).count("joint 'b'"), 0U);
    Scene taken = linked();
    taken.joints[2].name = "b";
    EXPECT_EQ(names(compile(taken).joints), "b.link b");
}

TEST(Link, OfTwoInSeriesOneBecomesADistanceAndOneStaysABody) {
    for (const bool outer_first : {true, false}) {
        Scene s = linked();
        s.bodies.push_back({"c", {Vector3d(1, 2, 3), Quaterniond::Identity()}});
        const Joint middle{"middle", ball(s, 1, 2, Vector3d(0.1, -0.4, 0.3))};
        s.joints[1].kind = ball(s, 2, ground, Vector3d(0.5, -0.4, 0.3));
        s.joints.insert(outer_first ? s.joints.end() : s.joints.begin(), middle);
        const Model model = compile(s);
        EXPECT_EQ(model.bodies.size(), 2U);
        EXPECT_EQ(model.joints.size(), 3U);
        for (const ModelJoint& joint : model.joints) {
            EXPECT_LT(joint.i, 2);
            EXPECT_LT(joint.j, 2);
            EXPECT_NE(joint.i, joint.j);
        }
    }
}

TEST(Link, WithADuplicatedBallJointBecomesADistance) {
    Scene s = linked();
    s.joints.push_back({"again", s.joints[0].kind});
    EXPECT_EQ(names(compile(s).joints), "b root");
}

TEST(Link, EndsOnWeldedBodiesAreKept) {
    Scene s = linked();
    s.bodies.push_back({"c", {Vector3d(1, 2, 3), Quaterniond(AngleAxisd(1, Vector3d::UnitX()))}});
    s.joints[1].kind = ball(s, 1, 2, Vector3d(0.1, -0.4, 0.3));
    s.joints.push_back({"foot", fixed(s, 2, ground, Vector3d(1, 1, 1))});
    const Model model = compile(s);
    EXPECT_EQ(names(model.bodies), "a");
    const auto& distance = std::get<DistanceBetween>(model.constraints.at(0).kind);
    EXPECT_NEAR(distance.length, 0.5, 1e-15);
    EXPECT_LE((distance.j.s_local - Vector3d(0.1, -0.4, 0.3)).norm(), 1e-15);
}

// ---- Duplicates.

Scene twice(JointKind (*first)(const Scene&), JointKind (*second)(const Scene&)) {
    Scene s = bodies(2);
    s.joints = {{"one", first(s)}, {"two", second(s)}};
    return s;
}
std::string kept(JointKind (*first)(const Scene&), JointKind (*second)(const Scene&)) {
    Scene s = twice(first, second);
    reduce::drop_duplicates(s);
    return names(s.joints);
}

TEST(DuplicateJoint, ImpliedByAnotherIsRemoved) {
    static const Vector3d p(0.1, 0.2, 0.3), q(0.5, 0.2, 0.1), n(1, 2, 3);
    using J = JointKind;
    const auto a_ball = [](const Scene& s) -> J { return ball(s, 0, 1, p); };
    const auto back = [](const Scene& s) -> J { return ball(s, 1, 0, p); };
    const auto other_ball = [](const Scene& s) -> J { return ball(s, 0, 1, q); };
    const auto a_hinge = [](const Scene& s) -> J { return hinge(s, 0, 1, p, n); };
    const auto reversed_hinge = [](const Scene& s) -> J { return hinge(s, 0, 1, p, -n); };
    const auto rod = [](const Scene& s) -> J { return Distance{at(s, 0, p), at(s, 1, q), 0.5}; };
    const auto rod_back = [](const Scene& s) -> J {
        return Distance{at(s, 1, q), at(s, 0, p), 0.5};
    };
    const auto longer = [](const Scene& s) -> J {
        return Distance{at(s, 0, p), at(s, 1, q), 0.5 + 1e-11};
    };
    const auto plane = [](const Scene& s) -> J {
        return InPlane{at(s, 0, p), at(s, 1, p), along(s, 1, n), 0.1};
    };
    const auto flipped = [](const Scene& s) -> J {
        return InPlane{at(s, 0, p), at(s, 1, p), along(s, 1, -n), -0.1};
    };
    const auto other_side = [](const Scene& s) -> J {
        return InPlane{at(s, 0, p), at(s, 1, p), along(s, 1, -n), 0.1};
    };
    EXPECT_EQ(kept(a_ball, a_ball), "one") << "of two that are the same the first stays";
    EXPECT_EQ(kept(a_ball, back), "one");
    EXPECT_EQ(kept(a_ball, a_hinge), "two") << "a hinge holds what the ball at its point does";
    EXPECT_EQ(kept(a_hinge, a_ball), "one");
    EXPECT_EQ(kept(a_hinge, reversed_hinge), "one");
    EXPECT_EQ(kept(rod, rod_back), "one");
    EXPECT_EQ(kept(plane, flipped), "one");
    EXPECT_EQ(kept(a_ball, other_ball), "one two");
    EXPECT_EQ(kept(rod, longer), "one two") << "a contradiction is for those who solve";
    EXPECT_EQ(kept(plane, other_side), "one two");
    EXPECT_EQ(kept(a_ball, rod), "one two");

    Scene named = twice(a_ball, a_ball);
    reduce::drop_duplicates(named);
    EXPECT_EQ(
        omitted(named),
        (Reasons{{"joint 'two'",
                  "joint 'one' imposes the same constraint and carries the whole reaction"}}));
}

TEST(DuplicateJoint, DrivenOrTemporaryIsKept) {
    Scene s = bodies(2);
    const Vector3d p(0, 0, 0), q(0, 0, 1);
    const Distance rod{at(s, 0, p), at(s, 1, q), 1};
    s.joints = {{"one", rod}, {"two", rod}};
    s.branches = {pushing(push(s, "load", 0, p))};
    s.branches[0].drivers.push_back({.what = Motion{1}, .start = 0, .rate = 1});
    reduce::drop_duplicates(s);
    EXPECT_EQ(s.joints.size(), 2U);
    s.joints[0].active_only_where_driven = true;
    s.branches[0].drivers[1].what = Motion{0};
    reduce::drop_duplicates(s);
    EXPECT_EQ(s.joints.size(), 2U);
}

// ---- All passes together.

TEST(CompileDetail, EverythingKeepsAllPartsOfTheScene) {
    Scene scene = linked();
    scene.joints.push_back({"again", ball(scene, 0, 1, Vector3d(0.1, 0, 0))});
    scene.elastics.push_back(
        {"nothing", AxialSpring{at(scene, 0, {0, 0, 0}), {}, LinearRate{0}, 1}});
    scene.static_loads.push_back({"none", DeadForce{{0, Vector3d::Zero()}, Vector3d::Zero()}});
    const Model model = compile(scene, Detail::everything);
    EXPECT_EQ(names(model.bodies), names(scene.bodies));
    EXPECT_EQ(names(model.joints), names(scene.joints));
    EXPECT_EQ(names(model.elastics), names(scene.elastics));
    EXPECT_EQ(names(model.static_loads), "none");
    EXPECT_TRUE(model.omitted.empty());
    EXPECT_EQ(model.as_written, model.as_solved);
    EXPECT_EQ(model.as_solved.rows, constraint_rows(model));
}

TEST(CompileDetail, RemovedPartsAreNamed) {
    std::vector<Scene> scenes{linked(), welded()};
    for (const auto& entry : std::filesystem::directory_iterator(ELASTOCHECK_SCENES))
        if (entry.path().extension() == ".yaml") scenes.push_back(read_scene(entry.path()));
    EXPECT_GT(scenes.size(), 10U);
    for (const Scene& scene : scenes) {
        const Model whole = compile(scene, Detail::everything), model = compile(scene);
        EXPECT_EQ(model.as_written, whole.as_solved) << scene.source;
        EXPECT_LE(model.as_solved.bodies, model.as_written.bodies) << scene.source;
        EXPECT_LE(model.as_solved.joints, model.as_written.joints) << scene.source;
        EXPECT_LE(model.as_solved.elastics, model.as_written.elastics) << scene.source;
        EXPECT_LE(model.as_solved.rows, model.as_written.rows) << scene.source;
        EXPECT_LE(coordinates(model) + constraint_rows(model),
                  coordinates(whole) + constraint_rows(whole));
        EXPECT_EQ(model.as_solved.bodies, static_cast<int>(model.bodies.size()));
        EXPECT_EQ(model.as_solved.rows, constraint_rows(model));
        EXPECT_EQ(model.wheels.size(), whole.wheels.size());
        EXPECT_EQ(model.probes.size(), whole.probes.size());
        const auto told = [&](const auto& all, const auto& left, const char* kind) {
            std::set<std::string> there;
            for (const auto& part : left) there.insert(part.name);
            for (const auto& part : all)
                EXPECT_EQ(std::ranges::count(model.omitted, reduce::named(kind, part.name),
                                             &Omission::what),
                          there.contains(part.name) ? 0 : 1)
                    << scene.source << ": " << kind << " " << part.name;
        };
        told(whole.bodies, model.bodies, "body");
        told(whole.joints, model.joints, "joint");
        told(whole.elastics, model.elastics, "element");
    }
}

TEST(CompileDetail, DriversReferToTheSamePartsAfterAllPasses) {
    Scene s = welded();
    s.elastics[1].kind = [&] {
        Bushing b = std::get<Bushing>(s.elastics[1].kind);
        b.formulation.frame = Formulation::Frame::on_j;
        return b;
    }();
    Branch branch = pushing(push(s, "load", 0, Vector3d(0, 0, 0)));
    for (const Driven& what :
         {Driven(Motion{4}), Driven(FreeLength{0}), Driven(Preload{1, Vector6::Unit(2)})})
        branch.drivers.push_back({.what = what, .start = 0.1, .rate = 0.2});
    s.branches.push_back(branch);
    for (const Detail detail : {Detail::required, Detail::everything}) {
        const Model model = compile(s, detail);
        const auto& drivers = model.branches.at(2).drivers;
        ASSERT_EQ(drivers.size(), 4U);
        EXPECT_EQ(
            model.joints.at(static_cast<std::size_t>(std::get<Motion>(drivers[1].what).joint)).name,
            "rod");
        const auto element = [&](int k) {
            return model.elastics.at(static_cast<std::size_t>(k)).name;
        };
        EXPECT_EQ(element(std::get<FreeLength>(drivers[2].what).elastic), "coil");
        EXPECT_EQ(element(std::get<Preload>(drivers[3].what).elastic), "rubber");
        EXPECT_EQ(std::get<Preload>(drivers[3].what).direction, Vector6(-Vector6::Unit(2)))
            << "turned round";
        EXPECT_EQ(drivers[3].start, 0.1);
        EXPECT_EQ(drivers[3].rate, 0.2);
    }
}

TEST(CompileDetail, ReducedModelIsNotReducedFurther) {
    for (Scene scene : {linked(), welded()}) {
        const auto reduced = [](Scene s) {
            reduce::drop_zero_loads(s), reduce::drop_never_active(s), reduce::weld(s);
            reduce::drop_within_one_body(s), reduce::drop_unconnected_to_outputs(s);
            reduce::drop_free_followers(s), reduce::drop_duplicates(s), reduce::replace_links(s);
            return s;
        };
        Scene once = reduced(scene);
        once.omitted.clear();
        EXPECT_TRUE(reduced(once).omitted.empty());
    }
}

TEST(CompileDetail, TyreWithoutABranchIsOmitted) {
    Scene s = linked();
    s.elastics.push_back({"tyre", bushing(s, ground, 0, Vector3d(0, 0, 0)), true});
    EXPECT_EQ(omitted(compile(s)).at("element 'tyre'"), "no branch drives it");
    s.branches[0].drivers.push_back({.what = Preload{1, Vector6::Unit(2)}, .start = 0, .rate = 1});
    EXPECT_EQ(names(compile(s).elastics), "coil tyre");
}

TEST(CompileDetail, QuantitiesAdjustedByTheTrimCountAsDriven) {
    Scene s = bodies(2);
    s.joints = {{"root", hinge(s, 0, ground, Vector3d(0, 0, 0), Vector3d(1, 0, 0))},
                {"joint", hinge(s, 1, 0, Vector3d(0, 0, 1), Vector3d(1, 0, 0))}};
    s.elastics = {{"rubber", bushing(s, 1, 0, Vector3d(0, 0, 1))}};
    EXPECT_EQ(names(compile(s).bodies), "a");
    s.trim = Trim{};
    s.trim->adjust.push_back({.name = "x", .what = Preload{0, Vector6::Unit(3)}});
    EXPECT_EQ(names(compile(s).bodies), "a b");
}

}  // namespace
}  // namespace elastocheck
