// Model reduction: what compile() keeps of a scene, what it removes and the reported reason.
#include "elastocheck/compile.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <random>

#include "elastocheck/read_scene.hpp"
#include "models/kinds.hpp"
#include "models/lowering.hpp"

namespace elastocheck {
namespace {

using Eigen::Vector3d;

// ---- Small scenes. Bodies a, b, c, ... are one metre apart along x; a is the output.

Scene bodies(int count) {
    Scene scene;
    for (int n = 0; n < count; ++n)
        scene.bodies.push_back(
            {std::string(1, static_cast<char>('a' + n % 26)), {.r = Vector3d(n, 0, 0)}});
    scene.probes.push_back({"output", {.body = 0}});
    return scene;
}

Vector3d origin(const Scene& scene, BodyId body) {
    return body == ground ? Vector3d(Vector3d::Zero())
                          : scene.bodies[static_cast<std::size_t>(body)].design.r;
}

// A point of each body at the origin of i.
std::pair<Point, Point> at_origin_of_i(const Scene& scene, BodyId i, BodyId j) {
    return {{i, Vector3d::Zero()}, {j, origin(scene, i) - origin(scene, j)}};
}

void ball(Scene& scene, const std::string& name, BodyId i, BodyId j) {
    const auto [p_i, p_j] = at_origin_of_i(scene, i, j);
    scene.joints.push_back({name, Spherical{p_i, p_j}});
}

void spring(Scene& scene, const std::string& name, BodyId i, BodyId j, double k,
            double preload = 0) {
    const double length = 0.5;
    const Point p_i{i, Vector3d::Zero()},
        p_j{j, origin(scene, i) - origin(scene, j) + Vector3d(0, 0, length)};
    scene.elastics.push_back(
        {name, AxialSpring{p_i, p_j, LinearRate{k}, k > 0 ? length + preload / k : length}});
}

Matrix6& K_of(Bushing& b) { return std::get<LinearStiffness>(b.law).K; }

Bushing& bushing(Scene& scene, const std::string& name, BodyId i, BodyId j, double k) {
    const auto [p_i, p_j] = at_origin_of_i(scene, i, j);
    Bushing b;
    b.i = {i, p_i.s_local};
    b.j = {j, p_j.s_local};
    K_of(b).diagonal().setConstant(k);
    scene.elastics.push_back({name, b});
    return std::get<Bushing>(scene.elastics.back().kind);
}

Load push(const std::string& name, BodyId on, double f = 1) {
    return {name, DeadForce{{on, Vector3d::Zero()}, Vector3d(0, 0, f)}};
}
Load twist(const std::string& name, BodyId on, double m = 1) {
    return {name, DeadMoment{on, Vector3d(m, 0, 0)}};
}

Branch branch(const std::string& name, const std::vector<Load>& loads, double to = 1,
              int steps = 1) {
    Branch result;
    result.name = name;
    result.to = to;
    result.steps = steps;
    for (const Load& load : loads) result.drivers.push_back({.what = load, .start = 0, .rate = 1});
    return result;
}

std::vector<Load> loads_of(const Branch& branch) {
    std::vector<Load> loads;
    for (const Driver& driver : branch.drivers)
        if (const auto* load = std::get_if<Load>(&driver.what)) loads.push_back(*load);
    return loads;
}

void hinge(Scene& scene, const std::string& name, BodyId i, BodyId j) {
    const auto [p_i, p_j] = at_origin_of_i(scene, i, j);
    scene.joints.push_back(
        {name, Revolute{p_i, p_j, {i, Vector3d::UnitY()}, {j, Vector3d::UnitY()}}});
}

// A chain a, b, c, ... of hinged bodies, the first on ground.
Scene chain(int count) {
    Scene scene = bodies(count);
    hinge(scene, "root", 0, ground);
    for (BodyId n = 1; n < count; ++n) hinge(scene, fmt::format("joint_{}", n), n, n - 1);
    return scene;
}

std::string kept(const Model& model) {
    std::string names;
    for (const Body& body : model.bodies) names += body.name;
    return names;
}

std::map<std::string, std::string> omitted(const Model& model) {
    std::map<std::string, std::string> reasons;
    for (const auto& [what, why] : model.omitted)
        EXPECT_TRUE(reasons.emplace(what, why).second) << what << " twice";
    return reasons;
}

const std::string follower =
    "it is attached to one other body only and has no load, no preload and no output";
const std::string with_its_body = "a body that it connects is left out";

// ---- Removed parts.

// Two of the built-in scenes contain removable parts, the others none.
TEST(Compile, OmissionsOfTheShippedScenesAreAsListed) {
    struct Fewer {
        std::size_t bodies = 0, joints = 0;
    };
    const std::map<std::string, Fewer> part_by_part{
        {"multi_link",
         {.bodies = 2,
          .joints = 3}},  // the subframe, the hub; their joints, and one that is there twice
        {"front_axle",
         {.bodies = 2, .joints = 2}}};  // drop links: two balls and a body each are one distance
    for (const auto& entry : std::filesystem::directory_iterator(ELASTOCHECK_SCENES)) {
        if (entry.path().extension() != ".yaml") continue;
        const Scene scene = read_scene(entry.path());
        const Model model = compile(scene);
        const auto found = part_by_part.find(entry.path().stem());
        const Fewer fewer = found == part_by_part.end() ? Fewer{} : found->second;
        EXPECT_EQ(model.omitted.empty(), found == part_by_part.end()) << entry.path();
        EXPECT_EQ(model.bodies.size() + fewer.bodies, scene.bodies.size()) << entry.path();
        EXPECT_EQ(model.joints.size() + fewer.joints, scene.joints.size()) << entry.path();
        EXPECT_EQ(model.elastics.size(), scene.elastics.size());
        EXPECT_EQ(model.branches.size(), scene.branches.size());
        EXPECT_EQ(model.name, scene.name);
    }
}

TEST(Compile, FreeChainIsOmittedFromItsLooseEndInwards) {
    for (int count = 2; count <= 26; ++count) {
        const Model model = compile(chain(count));
        EXPECT_EQ(kept(model), "a");
        const auto reasons = omitted(model);
        EXPECT_EQ(reasons.size(), 2U * static_cast<std::size_t>(count - 1));
        for (const auto& [what, why] : reasons)
            EXPECT_EQ(why, what.starts_with("body") ? follower : with_its_body);
    }
}

// A reason to keep the body b, whose neighbour n is, that no file states; others are in fixtures/chain.facts.
struct Reason {
    const char* name;
    void (*give)(Scene&, BodyId b, BodyId n);
};
const Reason reasons_to_stay[] = {
    {"a bushing between points apart",
     [](Scene& s, BodyId b, BodyId n) { bushing(s, "rubber", n, b, 1e3).j.s_local.y() += 1e-9; }},
    {"a bushing between frames apart",
     [](Scene& s, BodyId b, BodyId n) {
         bushing(s, "rubber", n, b, 1e3).j.A_local = Eigen::AngleAxisd(1e-9, Vector3d::UnitX());
     }},
    {"a spring of no number",
     [](Scene& s, BodyId b, BodyId n) { spring(s, "coil", b, n, 1e3, std::nan("")); }},
};

// In a chain a-b-c-d with a reason to keep c, d is removed and a, b, c are kept; a link between two balls that has such a
// reason stays a body.
TEST(Compile, LoadedBodyOfAFreeChainAndLoadedLinkAreKept) {
    for (const auto& [name, give] : reasons_to_stay) {
        Scene scene = chain(4);
        give(scene, 2, 1);
        const Model model = compile(scene);
        EXPECT_EQ(kept(model), "abc") << "for " << name;
        EXPECT_EQ(omitted(model), (std::map<std::string, std::string>{
                                      {"body 'd'", follower}, {"joint 'joint_3'", with_its_body}}))
            << "for " << name;
        Scene link = bodies(2);
        spring(link, "a_ground", 0, ground, 1e3, 50);
        ball(link, "outer", 0, 1);
        ball(link, "inner", 1, ground);
        EXPECT_EQ(kept(compile(link)), "a");
        give(link, 1, 0);
        EXPECT_EQ(kept(compile(link)), "ab") << "for " << name;
    }
}

TEST(Compile, ThousandsOfBodiesAreCompiledQuickly) {
    const int count = 20'000;
    Scene forwards = chain(count), backwards = bodies(count), star = bodies(count);
    ball(backwards, "root", 0, ground);
    ball(backwards, "last", count - 1, 0);
    for (BodyId n = 1; n < count - 1; ++n) ball(backwards, "link", n, n + 1);
    for (BodyId n = 1; n < count; ++n) ball(star, "arm", n, 0);
    for (const Scene* scene : {&forwards, &backwards, &star}) {
        const auto begin = std::chrono::steady_clock::now();
        EXPECT_EQ(kept(compile(*scene)), "a");
        const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
        EXPECT_LT(time.count(), 2.0);
    }
}

// ---- Drivers.

// A jack: the body's origin stays in a plane of ground.
int jack(Scene& scene, const std::string& name, BodyId body, bool active_only_where_driven = true) {
    scene.joints.push_back({name,
                            InPlane{.i = {body, Vector3d::Zero()},
                                    .j = {ground, origin(scene, body)},
                                    .normal_j = {ground, Vector3d::UnitZ()}},
                            active_only_where_driven});
    return static_cast<int>(scene.joints.size()) - 1;
}

Branch driven(const std::string& name, const Driven& what, double start = 0, double rate = 1) {
    Branch result = branch(name, {});
    result.drivers.push_back({what, start, rate});
    return result;
}

TEST(Compile, BodyOnAJackThatIsDrivenOrHeldIsKept) {
    for (const auto& [start, rate] : {std::pair(0.0, 1.0), {0.1, 0.0}, {0.0, 0.0}}) {
        Scene scene = chain(4);
        scene.branches = {branch("up", {push("p", 0)}),
                          driven("jacked", Motion{jack(scene, "jack", 2)}, start, rate)};
        const Model model = compile(scene);
        EXPECT_EQ(kept(model), "abc") << start << " " << rate;
        ASSERT_EQ(model.joints.size(), 4U);
        EXPECT_EQ(model.joints[3].name, "jack");
        EXPECT_TRUE(model.joints[3].active_only_where_driven);
        const int constraint = model.joints[3].driven;
        ASSERT_GE(constraint, 0);
        EXPECT_EQ(model.constraints[static_cast<std::size_t>(constraint)].joint, 3);
        EXPECT_EQ(std::get<Motion>(model.branches[1].drivers.at(0).what).joint, 3);
    }
}

TEST(Compile, JackThatNoBranchDrivesIsLeftOut) {
    Scene scene = chain(4);
    jack(scene, "jack", 2);
    scene.branches = {branch("up", {push("p", 0)})};
    const Model model = compile(scene);
    EXPECT_EQ(kept(model), "a");
    EXPECT_EQ(omitted(model).at("joint 'jack'"), "no branch drives it");

    Scene held = chain(4);
    jack(held, "support", 2, false);
    EXPECT_EQ(kept(compile(held)), "abc") << "what stands always, holds always";
}

TEST(Compile, BodyJoinedByADrivenElementOrJointIsKept) {
    Scene scene = chain(3);
    spring(scene, "coil", 2, 1, 1e3);
    scene.branches = {driven("trim", FreeLength{0})};
    EXPECT_EQ(kept(compile(scene)), "abc");

    Scene rubber = chain(3);
    bushing(rubber, "rubber", 2, 1, 0);
    rubber.branches = {driven("trim", Preload{0, Vector6::Unit(2)})};
    const Model model = compile(rubber);
    EXPECT_EQ(kept(model), "abc");
    EXPECT_EQ(model.elastics.size(), 1U) << "zero until its preload is driven";

    Scene rod = chain(2);
    rod.joints.push_back({"rod", Distance{{1, Vector3d(0, 0.3, 0)}, {0, Vector3d(1, 0, 0)}, 0.3}});
    EXPECT_EQ(kept(compile(rod)), "a");
    rod.branches = {driven("length", Motion{2})};
    EXPECT_EQ(kept(compile(rod)), "ab");
    rod.branches.clear();
    std::get<Distance>(rod.joints[2].kind).length = 0.31;
    EXPECT_EQ(kept(compile(rod)), "ab") << "another length than drawn moves something";
}

TEST(Compile, DriversReferToTheRenumberedParts) {
    Scene scene = bodies(3);
    ball(scene, "gone", 2, ground);  // c is unconnected
    spring(scene, "gone_too", 2, ground, 1e3);
    const int first = jack(scene, "jack", 1);
    ball(scene, "ab", 1, 0);
    spring(scene, "coil", 0, ground, 1e3);
    bushing(scene, "rubber", 0, ground, 1e3);
    scene.branches = {driven("jacked", Motion{first}), driven("coil", FreeLength{1}, 0.1, 0.2),
                      driven("rubber", Preload{2, Vector6::Unit(4)})};
    const Model model = compile(scene);
    EXPECT_EQ(kept(model), "ab");
    const auto motion = std::get<Motion>(model.branches[0].drivers.at(0).what);
    EXPECT_EQ(model.joints.at(static_cast<std::size_t>(motion.joint)).name, "jack");
    const auto length = std::get<FreeLength>(model.branches[1].drivers.at(0).what);
    EXPECT_EQ(model.elastics.at(static_cast<std::size_t>(length.elastic)).name, "coil");
    EXPECT_EQ(model.branches[1].drivers[0].start, 0.1);
    EXPECT_EQ(model.branches[1].drivers[0].rate, 0.2);
    const auto preload = std::get<Preload>(model.branches[2].drivers.at(0).what);
    EXPECT_EQ(model.elastics.at(static_cast<std::size_t>(preload.elastic)).name, "rubber");
    EXPECT_EQ(preload.direction, Vector6(Vector6::Unit(4)));
}

TEST(Compile, BranchLeftWithoutDriversIsListedAsOmitted) {
    Scene scene = bodies(2);
    ball(scene, "a_ground", 0, ground);
    ball(scene, "b_ground", 1, ground);
    spring(scene, "coil", 0, ground, 0);
    spring(scene, "far", 1, ground, 1e3);
    bushing(scene, "rubber", 0, ground, 1e3);
    const int moved = jack(scene, "jack", 1);
    scene.branches = {branch("load", {push("far", 1)}),
                      driven("jacked", Motion{moved}),
                      driven("ball", Motion{0}),
                      driven("coil", FreeLength{0}),
                      driven("far", FreeLength{1}),
                      driven("rubber", Preload{2, Vector6::Zero()}),
                      driven("held", FreeLength{0}, 0.1, 0),
                      driven("still", Preload{2, Vector6::Unit(0)}, 0, 0),
                      branch("none", {}),
                      branch("sound", {push("near", 0)})};
    const Model model = compile(scene);
    ASSERT_EQ(model.branches.size(), scene.branches.size());
    std::map<std::string, int> named;
    for (const Omission& omission : model.omitted)
        if (omission.what.starts_with("branch")) ++named[omission.what];
    for (const Branch& b : model.branches) {
        const bool is_sound = b.name == "sound";
        EXPECT_EQ(b.drivers.size(), is_sound ? 1U : 0U) << b.name;
        EXPECT_EQ(named["branch '" + b.name + "'"], is_sound ? 0 : 1) << b.name;
    }
}

// ---- Random scenes: after reduction all references still point to the same bodies.

struct RandomScene {
    std::mt19937 random;
    int below(int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }
    bool one_in(int n) { return below(n) == 0; }
    Vector3d vector() { return {below(100) / 100.0, below(100) / 100.0, 1 + below(100) / 100.0}; }
    Direction direction(BodyId body) { return {body, vector().normalized()}; }
    Point point(BodyId body) { return {body, vector()}; }

    JointKind joint(BodyId i, BodyId j) {
        const Direction a = direction(i), b = direction(j);
        switch (below(12)) {  // no spherical joints, which form links
            case 0:
            case 1: return Revolute{point(i), point(j), a, b};
            case 2: return Cylindrical{point(i), point(j), a, b};
            case 3: return Distance{point(i), point(j), 1};
            case 4: return InPlane{point(i), point(j), b};
            case 5: return Translational{point(i), point(j), a, b};
            case 6: return Universal{point(i), point(j), a, b};
            case 7: return Planar{point(i), point(j), a, b};
            case 8:
                return Fixed{point(i),
                             point(j),
                             {i, Vector3d::UnitX()},
                             {i, Vector3d::UnitY()},
                             {j, Vector3d::UnitX()},
                             {j, Vector3d::UnitY()}};
            case 9: return InLine{point(i), point(j), b};
            case 10: return Perpendicular{a, b};
            default: return Parallel{a, b};
        }
    }

    Scene scene() {
        Scene scene;
        const int count = 2 + below(9);
        for (int n = 0; n < count; ++n)
            scene.bodies.push_back({fmt::format("body_{}", n), {.r = vector()}});
        const auto any = [&] { return below(count + 1) - 1; };  // or ground
        for (int n = 0; n < count + below(4); ++n) {
            const BodyId i = any(), j = any();
            if (i == j) continue;
            if (one_in(2)) {
                scene.joints.push_back({fmt::format("joint_{}", n), joint(i, j)});
            } else if (one_in(2)) {
                const double k = one_in(4) ? 0 : 1e3;
                scene.elastics.push_back({fmt::format("spring_{}", n),
                                          AxialSpring{point(i), point(j), LinearRate{k}, 0.3}});
            } else {
                // Both markers at the origin of ground: unloaded unless preloaded.
                Bushing b;
                b.i = {i, -origin(scene, i)};
                b.j = {j, -origin(scene, j)};
                if (!one_in(4)) K_of(b).diagonal().setConstant(1e3);
                if (one_in(4)) b.preload[0] = 1;
                scene.elastics.push_back({fmt::format("bushing_{}", n), b});
            }
        }
        const auto load = [&](const std::string& name) {
            return one_in(2) ? push(name, below(count), below(3))
                             : twist(name, below(count), below(3));
        };
        if (one_in(2)) scene.static_loads.push_back(load("static"));
        for (int n = 0; n <= below(3); ++n)
            scene.branches.push_back(branch(fmt::format("branch_{}", n),
                                            {load("load_1"), load("load_2")}, 100.0 * n + 1,
                                            n + 1));
        if (one_in(2)) scene.wheels.emplace_back().body = below(count);
        if (scene.wheels.empty() || one_in(2))
            scene.probes.push_back({"probe", point(below(count))});
        return scene;
    }
};

template <class Owner, class Part>
std::string ends(const Owner& owner, const Part& part) {
    const auto [i, j] = elastocheck::ends(part);
    return body_name(owner, i) + "-" + body_name(owner, j);
}

template <class Owner>
std::string target(const Owner& owner, const Load& load) {
    return body_name(owner, body_of(load.kind));
}

template <class List>
const auto* find(const List& list, const std::string& name) {
    for (const auto& item : list)
        if (item.name == name) return &item;
    return static_cast<decltype(&list.front())>(nullptr);
}

constexpr int scenes = 3000;

TEST(Compile, PartsOfRandomModelsReferToTheBodiesOfTheirScene) {
    RandomScene random{std::mt19937(42)};
    for (int n = 0; n < scenes; ++n) {
        const Scene scene = random.scene();
        const Model model = compile(scene);
        for (const Body& body : model.bodies) {
            const Body* original = find(scene.bodies, body.name);
            ASSERT_TRUE(original);
            EXPECT_EQ(original->design.r, body.design.r);
        }
        for (const ModelJoint& joint : model.joints) {
            const Joint* original = find(scene.joints, joint.name);
            ASSERT_TRUE(original);
            EXPECT_EQ(ends(scene, original->kind),
                      body_name(model, joint.i) + "-" + body_name(model, joint.j));
            EXPECT_EQ(joint.at.body, joint.i);
        }
        int joint = 0;
        for (const Constraint& constraint : model.constraints) {
            EXPECT_GE(constraint.joint, joint);
            joint = constraint.joint;
            const ModelJoint& owner = model.joints.at(static_cast<std::size_t>(joint));
            std::visit(
                [&](const auto& c) {
                    EXPECT_EQ(c.i.body, owner.i);
                    EXPECT_EQ(c.j.body, owner.j);
                    if constexpr (requires { c.normal_j; }) {
                        EXPECT_EQ(c.normal_j.body, owner.j);
                    }
                },
                constraint.kind);
        }
        for (const Elastic& elastic : model.elastics)
            EXPECT_EQ(ends(scene, find(scene.elastics, elastic.name)->kind),
                      ends(model, elastic.kind));
        for (const Load& load : model.static_loads)
            EXPECT_EQ(target(scene, *find(scene.static_loads, load.name)), target(model, load));
        ASSERT_EQ(model.branches.size(), scene.branches.size());
        for (std::size_t b = 0; b < model.branches.size(); ++b) {
            EXPECT_EQ(model.branches[b].to, scene.branches[b].to);
            EXPECT_EQ(model.branches[b].steps, scene.branches[b].steps);
            for (const Load& load : loads_of(model.branches[b]))
                EXPECT_EQ(target(scene, *find(loads_of(scene.branches[b]), load.name)),
                          target(model, load));
        }
        ASSERT_EQ(model.wheels.size(), scene.wheels.size());
        for (std::size_t k = 0; k < model.wheels.size(); ++k)
            EXPECT_EQ(body_name(model, model.wheels[k].body),
                      body_name(scene, scene.wheels[k].body));
        ASSERT_EQ(model.probes.size(), scene.probes.size());
        for (std::size_t k = 0; k < model.probes.size(); ++k)
            EXPECT_EQ(body_name(model, model.probes[k].at.body),
                      body_name(scene, scene.probes[k].at.body));
    }
}

TEST(Compile, EveryPartOfTheSceneIsKeptOrListedAsOmitted) {
    RandomScene random{std::mt19937(43)};
    for (int n = 0; n < scenes; ++n) {
        const Scene scene = random.scene();
        const Model model = compile(scene);
        std::size_t loads = scene.static_loads.size(), kept_loads = model.static_loads.size(),
                    joint_rows = 0;
        for (const auto& branch : scene.branches) loads += branch.drivers.size();
        for (const auto& branch : model.branches) kept_loads += branch.drivers.size();
        const auto parts =
            scene.bodies.size() + scene.joints.size() + scene.elastics.size() + loads;
        const auto kept_parts =
            model.bodies.size() + model.joints.size() + model.elastics.size() + kept_loads;
        const auto is_branch = [](const Omission& omission) {
            return omission.what.starts_with("branch");
        };
        // A branch is kept even without drivers.
        const auto branches = std::ranges::count_if(model.omitted, is_branch);
        EXPECT_EQ(parts + static_cast<std::size_t>(branches), kept_parts + model.omitted.size());
        for (const Branch& left : model.branches)
            EXPECT_EQ(
                std::ranges::count(model.omitted, "branch '" + left.name + "'", &Omission::what),
                left.drivers.empty() ? 1 : 0);
        for (const ModelJoint& joint : model.joints)
            for (const auto& constraint : lower(find(scene.joints, joint.name)->kind, scene.bodies))
                joint_rows += static_cast<std::size_t>(rows(constraint));
        EXPECT_EQ(joint_rows, static_cast<std::size_t>(constraint_rows(model)));
        for (const auto& omission : model.omitted)
            EXPECT_FALSE(omission.what.empty() || omission.why.empty());
    }
}

// Independent implementation of the reduction rule: removes bodies one at a time as
// long as possible.
std::string kept_by_the_rule(const Scene& scene) {
    struct Edge {
        BodyId i, j;
        bool loaded;
    };
    std::vector<Edge> edges;
    const auto connect = [&](const auto& kind, bool loaded) {
        const auto [i, j] = elastocheck::ends(kind);
        edges.push_back({i, j, loaded});
    };
    const auto at = [&](const Point& p) -> Vector3d { return origin(scene, p.body) + p.s_local; };
    for (const auto& joint : scene.joints) {
        bool strained = false;  // bodies of random scenes are parallel to ground
        if (const auto* d = std::get_if<Distance>(&joint.kind))
            strained = std::abs((at(d->i) - at(d->j)).norm() - d->length) > 1e-9;
        if (const auto* p = std::get_if<InPlane>(&joint.kind))
            strained = std::abs(p->normal_j.u_local.dot(at(p->i) - at(p->j)) - p->offset) > 1e-9;
        connect(joint.kind, strained);
    }
    for (const auto& elastic : scene.elastics) {
        if (const auto* s = std::get_if<AxialSpring>(&elastic.kind)) {
            if (std::get<LinearRate>(s->law).k > 0)
                connect(elastic.kind, true);  // no random spring is at its free length
        } else {
            const auto& b = std::get<Bushing>(elastic.kind);
            if (!b.preload.isZero() || !std::get<LinearStiffness>(b.law).K.isZero())
                connect(elastic.kind, !b.preload.isZero());
        }
    }
    std::vector<bool> is_output(scene.bodies.size()), is_loaded(scene.bodies.size());
    for (const auto& wheel : scene.wheels) is_output[static_cast<std::size_t>(wheel.body)] = true;
    for (const auto& probe : scene.probes)
        is_output[static_cast<std::size_t>(probe.at.body)] = true;
    const auto mark = [&](const Load& load) {
        if (load_vector(load.kind).norm() > 0)
            is_loaded[static_cast<std::size_t>(body_of(load.kind))] = true;
    };
    for (const auto& load : scene.static_loads) mark(load);
    for (const auto& branch : scene.branches)
        for (const auto& load : loads_of(branch)) mark(load);

    std::vector<bool> in = is_output;
    for (std::size_t pass = 0; pass < in.size(); ++pass)
        for (const Edge& e : edges)
            if (e.i != ground && e.j != ground &&
                (in[static_cast<std::size_t>(e.i)] || in[static_cast<std::size_t>(e.j)]))
                in[static_cast<std::size_t>(e.i)] = in[static_cast<std::size_t>(e.j)] = true;
    for (std::size_t pass = 0; pass < in.size(); ++pass)
        for (std::size_t b = 0; b < in.size(); ++b) {
            if (!in[b] || is_output[b] || is_loaded[b]) continue;
            std::map<BodyId, int> neighbours;
            bool loaded = false;
            for (const Edge& e : edges) {
                if (e.i != static_cast<BodyId>(b) && e.j != static_cast<BodyId>(b)) continue;
                const BodyId other = e.i == static_cast<BodyId>(b) ? e.j : e.i;
                if (other != ground && !in[static_cast<std::size_t>(other)]) continue;
                ++neighbours[other];
                loaded = loaded || e.loaded;
            }
            if (neighbours.size() <= 1 && !loaded) in[b] = false;
        }
    std::string names;
    for (std::size_t b = 0; b < in.size(); ++b)
        if (in[b]) names += scene.bodies[b].name;
    return names;
}

TEST(Compile, KeptBodiesOfRandomScenesEqualThoseOfAnIndependentRule) {
    RandomScene random{std::mt19937(44)};
    std::size_t left_out_bodies = 0;
    for (int n = 0; n < scenes; ++n) {
        const Scene scene = random.scene();
        const Model model = compile(scene);
        EXPECT_EQ(kept(model), kept_by_the_rule(scene)) << "scene " << n;
        left_out_bodies += scene.bodies.size() - model.bodies.size();
    }
    EXPECT_GT(left_out_bodies, static_cast<std::size_t>(scenes));  // both outcomes occur
}

// ---- Reactions.

TEST(ModelJoint, ReactionActsAtItsPointOrAtTheOriginOfItsFirstBody) {
    Scene scene = bodies(2);
    scene.joints = {
        {"rod", Distance{{0, Vector3d(1, 2, 3)}, {1, Vector3d(4, 5, 6)}, 1}},
        {"square", Perpendicular{{1, Vector3d::UnitX()}, {0, Vector3d::UnitY()}}},
        {"ground_first", Spherical{{ground, Vector3d(7, 8, 9)}, {0, Vector3d::Zero()}}}};
    scene.probes.push_back({"other", {.body = 1}});
    const Model model = compile(scene);
    ASSERT_EQ(model.joints.size(), 3U);
    EXPECT_EQ(model.joints[0].at.s_local, Vector3d(1, 2, 3));
    EXPECT_EQ(model.joints[1].at.body, 1);
    EXPECT_EQ(model.joints[1].at.s_local, Vector3d::Zero());
    EXPECT_EQ(model.joints[2].at.body, ground);
    EXPECT_EQ(model.joints[2].at.s_local, Vector3d(7, 8, 9));
}

}  // namespace
}  // namespace elastocheck
