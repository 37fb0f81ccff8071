// Imports Chrono::Vehicle suspension templates.
// Points and joints as in the templates; chassis, subchassis and steering do not move, so all three
// become ground.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>

#include "models/import/chrono/json.hpp"
#include "models/import/chrono/suspension.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer::chrono {
namespace {

using reader::Cursor;

const Matrix3d no_turn = Matrix3d::Identity();

std::optional<Cursor> bushing_of(const Suspension& s, const char* path) {
    if (!s.has(path)) return std::nullopt;
    return s.at(path);
}

// An arm on an axis through two points: chassis to arm at their middle, arm to upright at its ball
// joint.
void arm(Suspension& s, const std::string& name, const char* part, const char* front,
         const char* back, const char* ball, const std::string& upright) {
    const std::string p(part);
    const auto path = [&](const char* key) { return p + "/" + key; };
    const std::string of = s.sided(name), data = path("Bushing Data");
    s.body(of, s.point(path("COM").c_str()), part);
    const Vector3d f = s.point(path(front).c_str()), b = s.point(path(back).c_str());
    const Vector3d middle =
        s.midpoint(name + ".axis", "front", path(front).c_str(), "rear", path(back).c_str());
    s.joint_or_bushing(Kind::revolute, s.sided(name + ".axis"), "ground", of, middle,
                       frame_along(f - b, Vector3d::UnitZ()), part, bushing_of(s, data.c_str()));
    if (ball)
        s.spherical(s.sided(name + ".ball_joint"), of, upright, s.point(path(ball).c_str()),
                    path(ball).c_str());
}

void upright_body(Suspension& s) { s.body(s.sided("upright"), s.point("Upright/COM"), "Upright"); }

void spring_and_shock(Suspension& s, const char* end, const std::string& on,
                      const char* spring = "Spring") {
    for (const char* part : {spring, "Shock"}) {
        if (!s.has(part)) continue;
        const std::string p(part);
        std::string name = p == "Shock" ? "damper" : p == "Spring" ? "spring" : "auxiliary_spring";
        s.tsda(s.sided(name), "ground", s.point((p + "/Location Chassis").c_str()), on,
               s.point((p + "/" + end).c_str()), s.at(part));
    }
}

// ---- Independent suspensions: one side, mirrored by the scene.

void double_wishbone(Suspension& s) {
    upright_body(s);
    const std::string upright = s.sided("upright");
    arm(s, "upper_arm", "Upper Control Arm", "Location Chassis Front", "Location Chassis Back",
        "Location Upright", upright);
    arm(s, "lower_arm", "Lower Control Arm", "Location Chassis Front", "Location Chassis Back",
        "Location Upright", upright);
    s.tierod("Tierod", "Location Chassis", "Location Upright", upright);
    spring_and_shock(s, "Location Arm", s.sided("lower_arm"));
    s.spindle(upright);
}

void double_wishbone_reduced(Suspension& s) {
    upright_body(s);
    const std::string upright = s.sided("upright");
    for (const auto& [name, part] :
         {std::pair{"upper", "Upper Control Arm"}, {"lower", "Lower Control Arm"}})
        for (const auto& [way, key] :
             {std::pair{"front", "Location Chassis Front"}, {"rear", "Location Chassis Back"}}) {
            const std::string from = std::string(part) + "/" + key,
                              to = std::string(part) + "/Location Upright";
            s.distance(s.sided(fmt::format("{}_{}", name, way)), "ground", s.point(from.c_str()),
                       from.c_str(), upright, s.point(to.c_str()), to.c_str());
        }
    s.tierod("Tierod", "Location Chassis", "Location Upright", upright);
    spring_and_shock(s, "Location Upright", upright);
    s.spindle(upright);
}

void mcpherson(Suspension& s) {
    upright_body(s);
    const std::string upright = s.sided("upright"), strut = s.sided("strut");
    arm(s, "arm", "Control Arm", "Location Chassis Front", "Location Chassis Back",
        "Location Upright", upright);
    const Vector3d top = s.point("Spring/Location Chassis"),
                   seat = s.point("Spring/Location Upright");
    s.body(strut, 0.5 * (top + seat), "Strut");
    const Matrix3d A = frame_along(seat - top, Vector3d::UnitX());
    s.universal(s.sided("strut.mount"), "ground", strut, top, A.col(0), A.col(1),
                "Spring/Location Chassis");
    s.joint(s.sided("strut.tube"), "cylindrical", strut, upright,
            Fields{}
                .add("at", s.hardpoint(s.sided("strut.tube"), seat, "Spring/Location Upright"))
                .add("axis", direction(A.col(2))),
            s.place("Spring/Location Upright"));
    s.tierod("Tierod", "Location Chassis", "Location Upright", upright);
    spring_and_shock(s, "Location Upright", upright);
    s.spindle(upright);
}

// x of the universal joint is fixed to the link, y to the chassis.
void axes_link(Suspension& s, const std::string& name, const char* part,
               const std::string& upright) {
    const std::string p(part), of = s.sided(name);
    const auto at = [&](const char* key) { return p + "/" + key; };
    s.body(of, s.point(at("COM").c_str()), part);
    s.spherical(s.sided(name + ".outer"), of, upright, s.point(at("Location Upright").c_str()),
                at("Location Upright").c_str());
    s.universal(s.sided(name + ".inner"), of, "ground", s.point(at("Location Chassis").c_str()),
                s.point(at("Universal Joint Axis Chassis").c_str()),
                s.point(at("Universal Joint Axis Link").c_str()), at("Location Chassis").c_str());
}

void multi_link(Suspension& s) {
    upright_body(s);
    const std::string upright = s.sided("upright");
    arm(s, "upper_arm", "Upper Arm", "Location Chassis Front", "Location Chassis Back",
        "Location Upright", upright);
    axes_link(s, "lateral", "Lateral", upright);
    axes_link(s, "trailing_link", "Trailing Link", upright);
    s.tierod("Tierod", "Location Chassis", "Location Upright", upright);
    spring_and_shock(s, "Location Link", s.sided("trailing_link"));
    s.spindle(upright);
}

void semi_trailing_arm(Suspension& s) {
    s.left("Trailing Arm/Location Spindle");
    arm(s, "arm", "Trailing Arm", "Location Chassis Outer", "Location Chassis Inner", nullptr, "");
    spring_and_shock(s, "Location Arm", s.sided("arm"));
    s.spindle(s.sided("arm"));
}

void three_link_irs(Suspension& s) {
    s.left("Trailing Arm/Location Spindle");
    const std::string arm_name = s.sided("arm");
    s.body(arm_name, s.point("Trailing Arm/COM"), "Trailing Arm");
    const auto on_chassis = bushing_of(s, "Bushing Data Chassis"),
               on_arm = bushing_of(s, "Bushing Data Arm");
    s.joint_or_bushing(Kind::spherical, s.sided("arm.joint"), "ground", arm_name,
                       s.point("Trailing Arm/Location Chassis"), no_turn,
                       "Trailing Arm/Location Chassis", on_chassis);
    for (const auto& [name, part] :
         {std::pair{"upper_link", "Upper Link"}, {"lower_link", "Lower Link"}}) {
        const std::string of = s.sided(name), p(part), inner = p + "/Location Chassis",
                          outer = p + "/Location Arm";
        s.body(of, s.point((p + "/COM").c_str()), part);
        const Vector3d c = s.point(inner.c_str()), a = s.point(outer.c_str());
        s.joint_or_bushing(Kind::spherical, s.sided(std::string(name) + ".outer"), of, arm_name, a,
                           no_turn, outer.c_str(), on_arm);
        s.joint_or_bushing(Kind::universal, s.sided(std::string(name) + ".inner"), of, "ground", c,
                           frame_along(c - a, s.point((p + "/Universal Joint Axis").c_str())),
                           inner.c_str(), on_chassis);
    }
    spring_and_shock(s, "Location Arm", arm_name);
    s.spindle(arm_name);
}

void single_wishbone(Suspension& s) {
    upright_body(s);
    const std::string upright = s.sided("upright"), arm_name = s.sided("arm");
    s.body(arm_name, s.point("Control Arm/COM"), "Control Arm");
    s.joint_or_bushing(Kind::revolute, s.sided("arm.axis"), "ground", arm_name,
                       s.point("Control Arm/Location Chassis"),
                       frame_along(Vector3d::UnitX(), Vector3d::UnitZ()),
                       "Control Arm/Location Chassis", bushing_of(s, "Control Arm/Bushing Data"));
    s.revolute(s.sided("king_pin"), arm_name, upright, s.point("Control Arm/Location Upright"),
               Vector3d::UnitZ(), "Control Arm/Location Upright");
    s.tierod("Tierod", "Location Chassis", "Location Upright", upright);
    spring_and_shock(s, "Location Arm", arm_name);
    s.spindle(upright);
}

// ---- Axles: both sides written out, since their shared parts are not symmetric.

void both(Suspension& s, const std::function<void()>& make) {
    for (const int side : {+1, -1}) {
        s.side = side;
        make();
    }
    s.side = +1;
}

void axle_tube(Suspension& s) { s.body("axle", s.left("Axle Tube/COM"), "Axle Tube"); }

// A knuckle on the axle's king pin.
void knuckle(Suspension& s, const char* lower = "Knuckle/Location Lower",
             const char* upper = "Knuckle/Location Upper") {
    s.body(s.sided("knuckle"), s.point("Knuckle/COM"), "Knuckle");
    const Vector3d middle = s.midpoint("king_pin", "lower", lower, "upper", upper);
    s.revolute(s.sided("king_pin"), "axle", s.sided("knuckle"), middle,
               s.point(lower) - s.point(upper), "Knuckle");
}

// The track rod between both knuckles, and the drag link from ground to one of them.
void shared_tierod(Suspension& s) {
    const Vector3d end = s.left("Tierod/Location Knuckle");
    s.side = -1;
    const Vector3d other = s.point("Tierod/Location Knuckle");
    s.side = +1;
    s.body("tierod", 0.5 * (end + other), "Tierod");
    s.spherical("tierod.left", "tierod", "knuckle_left", end, "Tierod/Location Knuckle");
    s.universal("tierod.right", "tierod", "knuckle_right", other, Vector3d::UnitX(),
                Vector3d::UnitZ(), "Tierod/Location Knuckle");
}

void draglink(Suspension& s, bool universal) {
    const Vector3d chassis = s.left("Draglink/Location Chassis");
    const Vector3d end = s.left("Knuckle/Location Draglink");  // the sign of y tells the knuckle
    s.link("draglink", "Draglink", 0.5 * (chassis + end), "ground", chassis,
           end.y() > 0 ? "knuckle_left" : "knuckle_right", end, universal,
           "Draglink/Location Chassis", "Knuckle/Location Draglink");
}

void solid_axle(Suspension& s) {
    axle_tube(s);
    both(s, [&] {
        knuckle(s);
        for (const auto& [name, part, other] :
             {std::tuple{"upper_link", "Upper Link", "Lower Link"},
              std::tuple{"lower_link", "Lower Link", "Upper Link"}}) {
            const std::string of = s.sided(name), p(part), inner = p + "/Location Chassis",
                              outer = p + "/Location Axle";
            const Vector3d c = s.point(inner.c_str()), a = s.point(outer.c_str());
            s.body(of, s.point((p + "/COM").c_str()), part);
            const Vector3d beside = s.point((std::string(other) + "/Location Axle").c_str());
            const Matrix3d A = frame_along(c - a, a - beside);
            s.universal(s.sided(std::string(name) + ".inner"), "ground", of, c, A.col(0), A.col(1),
                        inner.c_str());
            s.spherical(s.sided(std::string(name) + ".outer"), "axle", of, a, outer.c_str());
        }
        spring_and_shock(s, "Location Axle", "axle");
        s.spindle(s.sided("knuckle"));
    });
    shared_tierod(s);
    if (s.has("Trackbar")) {  // without it the non-parallel links already hold the axle sideways
        s.one_freedom = true;
        s.draft().notes.warn(
            s.place("Trackbar"),
            "links and track bar leave the axle a single, poorly determined degree of freedom: the "
            "branch drives the left wheel, the right one follows");
        const Vector3d a = s.left("Trackbar/Location Axle"),
                       c = s.left("Trackbar/Location Chassis");
        s.link("trackbar", "Trackbar", 0.5 * (a + c), "ground", c, "axle", a, false,
               "Trackbar/Location Chassis", "Trackbar/Location Axle");
    }
    // Drag link, bell crank, and the pin of the bell crank in the track rod's plane.
    const Vector3d d = s.left("Draglink/Location Bell Crank"),
                   steering = s.left("Draglink/Location Chassis");
    const Vector3d pivot = s.left("Bell Crank/Location Axle"),
                   pin = s.left("Bell Crank/Location Tierod");
    s.body("bell_crank", (d + pivot + pin) / 3, "Bell Crank");
    s.link("draglink", "Draglink", 0.5 * (d + steering), "ground", steering, "bell_crank", d, true,
           "Draglink/Location Chassis", "Draglink/Location Bell Crank");
    const Vector3d axis = (d - pivot).cross(pin - pivot);
    if (!(axis.norm() > 1e-12))
        s.at("Bell Crank/Location Axle")
            .fail("on one line with the other points of the bell crank");
    s.revolute("bell_crank.pivot", "bell_crank", "axle", pivot, axis, "Bell Crank/Location Axle");
    s.in_plane("bell_crank.pin", "bell_crank", "tierod", pin, Vector3d::UnitY(),
               s.place("Bell Crank/Location Tierod"));
}

// Triangle and links of the three-link axles.
void three_links(Suspension& s) {
    Vector3d c = s.left("Triangular Link/Location Chassis"),
             a = s.left("Triangular Link/Location Axle");
    c.y() = a.y() = 0;  // the middle of both sides
    s.draft().points.at(c, "triangle.axis", {0, "Triangular Link/Location Chassis, at y = 0"});
    s.draft().points.at(a, "triangle.ball_joint", {0, "Triangular Link/Location Axle, at y = 0"});
    s.body("triangle", 0.5 * (c + a), "Triangular Link");
    s.revolute("triangle.axis", "triangle", "ground", c, Vector3d::UnitY(),
               "Triangular Link/Location Chassis");
    s.spherical("triangle.ball_joint", "triangle", "axle", a, "Triangular Link/Location Axle");
    both(s, [&] {
        const Vector3d chassis = s.point("Longitudinal Link/Location Chassis"),
                       axle = s.point("Longitudinal Link/Location Axle");
        s.body(s.sided("link"), 0.5 * (chassis + axle), "Longitudinal Link");
        s.spherical(s.sided("link.outer"), s.sided("link"), "axle", axle,
                    "Longitudinal Link/Location Axle");
        const Matrix3d A = frame_along(chassis - axle, Vector3d::UnitY());
        s.universal(s.sided("link.inner"), s.sided("link"), "ground", chassis, A.col(0), A.col(1),
                    "Longitudinal Link/Location Chassis");
    });
}

void solid_three_link(Suspension& s) {
    axle_tube(s);
    three_links(s);
    both(s, [&] {
        spring_and_shock(s, "Location Axle", "axle");
        s.spindle("axle");
    });
}

void solid_bellcrank_three_link(Suspension& s) {
    axle_tube(s);
    three_links(s);
    const Vector3d pivot = s.left("Bellcrank/Location Axle");
    s.body("bellcrank", pivot, "Bellcrank");
    s.revolute("bellcrank.pivot", "axle", "bellcrank", pivot, Vector3d::UnitZ(),
               "Bellcrank/Location Axle");
    const Vector3d d = s.left("Draglink/Location Bellcrank"),
                   steering = s.left("Draglink/Location Steering");
    s.link("draglink", "Draglink", 0.5 * (d + steering), "ground", steering, "bellcrank", d, true,
           "Draglink/Location Steering", "Draglink/Location Bellcrank");
    both(s, [&] {
        knuckle(s);
        const Vector3d inner = s.point("Bellcrank/Location Tierod"),
                       outer = s.point("Knuckle/Location Tierod");
        s.link(s.sided("tierod"), "Tierod", 0.5 * (inner + outer), "bellcrank", inner,
               s.sided("knuckle"), outer, false, "Bellcrank/Location Tierod",
               "Knuckle/Location Tierod");
        spring_and_shock(s, "Location Axle", "axle");
        s.spindle(s.sided("knuckle"));
    });
}

// De Dion axle: ball joint on the chassis, and a Watt linkage for lateral guidance.
void dedion(Suspension& s) {
    axle_tube(s);
    s.spherical("axle.ball_joint", "axle", "ground", s.left("Axle Tube/Location Connector Chassis"),
                "Axle Tube/Location Connector Chassis");
    const Vector3d left = s.left("Watt Mechanism/Location Left Link to Center"),
                   right = s.left("Watt Mechanism/Location Right Link to Center");
    s.draft().points.at(
        0.5 * (left + right), "watt_centre.pivot",
        {0, "midpoint of Watt Mechanism/Location Left Link to Center and Right Link to Center"});
    s.body("watt_centre", 0.5 * (left + right), "Watt Mechanism", "Center Link Mass");
    s.revolute("watt_centre.pivot", "watt_centre", "axle", 0.5 * (left + right), Vector3d::UnitX(),
               "Watt Mechanism");
    for (const auto& [name, centre, chassis] :
         {std::tuple{"watt_link_left", "Watt Mechanism/Location Left Link to Center",
                     "Watt Mechanism/Location Left Link to Chassis"},
          std::tuple{"watt_link_right", "Watt Mechanism/Location Right Link to Center",
                     "Watt Mechanism/Location Right Link to Chassis"}}) {
        s.body(name, 0.5 * (s.left(centre) + s.left(chassis)), "Watt Mechanism", "Side Link Mass");
        s.spherical(std::string(name) + ".inner", name, "watt_centre", s.left(centre), centre);
        s.spherical(std::string(name) + ".outer", name, "ground", s.left(chassis), chassis);
    }
}

// Allows only heave along z and roll about x.
void leafspring_guide(Suspension& s) {
    axle_tube(s);
    const Vector3d p = s.left("Axle Tube/COM");
    s.in_plane("axle.fore_aft", "axle", "ground", p, Vector3d::UnitX(), s.place("Axle Tube"));
    s.in_plane("axle.lateral", "axle", "ground", p, Vector3d::UnitY(), s.place("Axle Tube"));
    s.joint("axle.roll_axis", "parallel", "axle", "ground", Fields{}.add("axis", "x"),
            s.place("Axle Tube"));
}

void panhard_rod(Suspension& s, const char* chassis, const char* axle) {
    const Vector3d c = s.left(chassis), a = s.left(axle);
    s.link("panhard_rod", "Panhard Rod", 0.5 * (c + a), "ground", c, "axle", a, false, chassis,
           axle);
}

void push_pipe(Suspension& s) {
    axle_tube(s);
    if (s.has("Axle Tube/Portal Offset") && s.real("Axle Tube/Portal Offset") != 0)
        s.draft().notes.miss(s.place("Axle Tube/Portal Offset"),
                             "a portal axle, whose gears are not supported");
    s.spherical("axle.ball_joint", "axle", "ground", s.left("Axle Tube/Location Connector Chassis"),
                "Axle Tube/Location Connector Chassis");
    panhard_rod(s, "Panhard Rod/Location Connector Chassis", "Panhard Rod/Location Connector Axle");
}

void rigid_panhard(Suspension& s) {
    axle_tube(s);
    s.joint("axle.guide", "planar", "ground", "axle",
            Fields{}
                .add("at", s.hardpoint("axle.guide", s.left("Axle Tube/COM"), "Axle Tube/COM"))
                .add("normal", "x"),
            s.place("Axle Tube"));
    panhard_rod(s, "Panhard Rod/Location Chassis", "Panhard Rod/Location Axle");
    // An anti-roll bar in two halves: the left one rotates in the chassis, the right one relative
    // to it.
    const Vector3d chassis = s.left("Anti Roll Bar/Location Chassis");
    const Vector3d middle(chassis.x(), 0, chassis.z());
    s.draft().points.at(middle, "antiroll_bar.bearing",
                        {0, "Anti Roll Bar/Location Chassis, at y = 0"});
    both(s, [&] {
        s.body(s.sided("antiroll_bar"), 0.5 * (s.point("Anti Roll Bar/Location Chassis") + middle),
               "Anti Roll Bar");
    });
    s.revolute("antiroll_bar.bearing", "ground", "antiroll_bar_left", middle, Vector3d::UnitY(),
               "Anti Roll Bar/Location Chassis");
    s.revolute("antiroll_bar.middle", "antiroll_bar_left", "antiroll_bar_right", middle,
               Vector3d::UnitY(), "Anti Roll Bar/Location Chassis");
    s.torsion("antiroll_bar.twist", "antiroll_bar_left", "antiroll_bar_right", middle,
              Vector3d::UnitY(), s.real("Anti Roll Bar/Rotational Stiffness"), 0,
              "Anti Roll Bar/Rotational Stiffness");
    both(s, [&] {
        s.in_plane(s.sided("antiroll_bar.slide"), s.sided("antiroll_bar"), "axle",
                   s.point("Anti Roll Bar/Location Axle"), Vector3d::UnitZ(),
                   s.place("Anti Roll Bar/Location Axle"));
    });
}

void rigid_wheels(Suspension& s) {
    both(s, [&] {
        spring_and_shock(s, "Location Axle", "axle");
        s.spindle("axle");
    });
}

void steered_wheels(Suspension& s, bool universal_draglink) {
    both(s, [&] {
        knuckle(s);
        spring_and_shock(s, "Location Axle", "axle");
        s.spindle(s.sided("knuckle"));
    });
    shared_tierod(s);
    draglink(s, universal_draglink);
}

// A leaf spring in two halves (SAE): a spring about y and one about z at each clamp. The preload is
// shared equally.
void leaf(Suspension& s) {
    const Vector3d hanger = s.point("Leafspring/Location Front Hanger"),
                   a = s.point("Leafspring/Location Clamp A"),
                   b = s.point("Leafspring/Location Clamp B"),
                   shackle = s.point("Leafspring/Location Shackle"),
                   rear = s.point("Leafspring/Location Rear Hanger");
    const double bias = s.real("Leafspring/Stiffness Bias"),
                 preload = s.real("Leafspring/Vertical Preload Force");
    const double vertical = s.real("Leafspring/Vertical Stiffness") / (1 + bias),
                 lateral = s.real("Leafspring/Lateral Stiffness") / (1 + bias);
    const auto mass = [&](const char* part, const std::string& name, const Vector3d& p) {
        s.body(name, p, part);
    };
    const std::string front_leaf = s.sided("front_leaf"), rear_leaf = s.sided("rear_leaf"),
                      clamp_a = s.sided("clamp_a"), clamp_b = s.sided("clamp_b"),
                      shackle_name = s.sided("shackle");
    mass("Leafspring/Frontleaf", front_leaf, 0.5 * (hanger + a));
    mass("Leafspring/Rearleaf", rear_leaf, 0.5 * (shackle + b));
    mass("Leafspring/Half Clamp", clamp_a, 0.75 * a + 0.25 * b);
    mass("Leafspring/Half Clamp", clamp_b, 0.75 * b + 0.25 * a);
    mass("Leafspring/Shackle", shackle_name, 0.5 * (rear + shackle));
    const Matrix3d about_y = frame_along(-Vector3d::UnitY(), Vector3d::UnitZ());
    const auto on_shackle = bushing_of(s, "Leafspring/Shackle Bushing Data"),
               on_clamp = bushing_of(s, "Leafspring/Clamp Bushing Data"),
               on_leaf = bushing_of(s, "Leafspring/Leafspring Bushing Data");
    s.joint_or_bushing(Kind::revolute, s.sided("shackle.hanger"), shackle_name, "ground", rear,
                       about_y, "Leafspring/Location Rear Hanger", on_shackle);
    s.spherical(s.sided("front_leaf.hanger"), front_leaf, "ground", hanger,
                "Leafspring/Location Front Hanger");
    s.spherical(s.sided("rear_leaf.shackle"), rear_leaf, shackle_name, shackle,
                "Leafspring/Location Shackle");
    struct Half {
        const char *name, *path;
        const std::string &clamp, &leaf;
        Vector3d p, arm;
        double share;
    };
    for (const Half& half :
         {Half{"clamp_a", "Leafspring/Location Clamp A", clamp_a, front_leaf, a, a - hanger, 1},
          Half{"clamp_b", "Leafspring/Location Clamp B", clamp_b, rear_leaf, b, b - shackle,
               bias}}) {
        const std::string name(half.name);
        const double square = half.arm.squaredNorm();
        s.joint_or_bushing(Kind::revolute, s.sided(name + ".yaw"), half.clamp, "axle", half.p,
                           no_turn, half.path, on_clamp);
        s.torsion(s.sided(name + ".lateral"), half.clamp, "axle", half.p, Vector3d::UnitZ(),
                  half.share * lateral * square, 0, half.path);
        s.joint_or_bushing(Kind::revolute, s.sided(name + ".pitch"), half.clamp, half.leaf, half.p,
                           about_y, half.path, on_leaf);
        // Moment about y on the leaf whose far end then pushes the chassis up with half the
        // preload: arm × force.
        s.torsion(s.sided(name + ".vertical"), half.clamp, half.leaf, half.p, Vector3d::UnitY(),
                  half.share * vertical * square, -0.5 * preload * half.arm.x(), half.path);
    }
    if (preload != 0 && s.side > 0)
        s.draft().notes.warn(s.place("Leafspring/Vertical Preload Force"),
                             "interpreted as the force that supports the chassis at the design "
                             "position: the sign of Chrono's rest angle is not documented");
}

void sae_leafspring(Suspension& s, bool steered) {
    axle_tube(s);
    both(s, [&] {
        leaf(s);
        if (steered) knuckle(s);
        spring_and_shock(s, "Location Axle", "axle", "Auxiliary Spring");
        s.spindle(steered ? s.sided("knuckle") : "axle");
    });
    if (!steered) return;
    shared_tierod(s);
    draglink(s, true);
}

// The lower shock end is on the housing, as in Chrono.
void hendrickson(Suspension& s) {
    s.one_freedom = true;
    s.draft().notes.warn(s.place("Lower Beam"),
                         "beams and rods that rotate only about y prevent roll of the axle: the "
                         "branch drives the left wheel, the right one follows");
    s.body("axle", s.left("Axle Housing/COM"), "Axle Housing");
    s.body("transverse_beam", s.left("Transverse Beam/COM"), "Transverse Beam");
    both(s, [&] {
        knuckle(s, "Knuckle/Lower Attachment Point", "Knuckle/Upper Attachment Point");
        for (const auto& [name, part] :
             {std::pair{"torque_rod", "Torque Rod"}, {"lower_beam", "Lower Beam"}}) {
            const std::string of = s.sided(name), p(part), inner = p + "/Chassis Attachment Point",
                              outer = p + "/Axle Housing Attachment Point";
            s.body(of, s.point((p + "/COM").c_str()), part);
            s.revolute(s.sided(std::string(name) + ".inner"), "ground", of, s.point(inner.c_str()),
                       Vector3d::UnitY(), inner.c_str());
            s.spherical(s.sided(std::string(name) + ".outer"), "axle", of, s.point(outer.c_str()),
                        outer.c_str());
        }
        s.spherical(s.sided("transverse_beam.end"), s.sided("lower_beam"), "transverse_beam",
                    s.point("Lower Beam/Transverse Beam Attachment Point"),
                    "Lower Beam/Transverse Beam Attachment Point");
        s.tierod("Tierod", "Location Chassis", "Location Knuckle", s.sided("knuckle"));
        for (const auto& [name, part, end] :
             {std::tuple{"housing_shock", "Shock Axle Housing", "Location Axle Housing"},
              std::tuple{"beam_shock", "Shock Lower Beam", "Location Lower Beam"}})
            s.tsda(s.sided(name), "ground",
                   s.point((std::string(part) + "/Location Chassis").c_str()), "axle",
                   s.point((std::string(part) + "/" + end).c_str()), s.at(part));
        s.spindle(s.sided("knuckle"));
    });
}

// ---- GenericWheeledSuspension: parts and joints by name.

Vector3d vector(const Cursor& at) {
    const auto items = at.list(3, "numbers");
    return {items[0].number(), items[1].number(), items[2].number()};
}

// On the right side the y components of the frame's x and z change sign; y completes the frame.
Matrix3d rotation(const Suspension& s, const Cursor& at) {
    const auto q = at.list(4, "numbers, a quaternion");
    const Eigen::Quaterniond p(q[0].number(), q[1].number(), q[2].number(), q[3].number());
    if (!(p.norm() > 1e-6)) at.fail("not a quaternion: all components are zero");
    const Matrix3d A = p.normalized().toRotationMatrix();
    if (s.side > 0) return A;
    Matrix3d B;
    B.col(0) = s.mirrored(A.col(0));
    B.col(2) = s.mirrored(A.col(2));
    B.col(1) = Vector3d(B.col(2)).cross(Vector3d(B.col(0)));
    return B;
}

std::string scene_name(const std::string& name) {
    std::string result;
    for (const char c : name) result += c == ' ' || c == '/' ? '_' : c;
    return result;
}

struct Generic {
    Suspension& s;
    std::set<std::string> sided, shared;

    std::string body(const Cursor& at) const {
        std::string name;
        int side = s.side;
        if (at.is_list()) {
            const auto pair = at.list(2, "words, a body and its side");
            name = pair[0].text("a body");
            side = pair[1].one_of("a side", {"Left", "Right"}) == 0 ? 1 : -1;
        } else {
            name = at.text("a body");
        }
        if (name == "Chassis" || name == "Subchassis" || name == "Steering") return "ground";
        if (sided.contains(name)) return scene_name(name) + (side > 0 ? "_left" : "_right");
        if (shared.contains(name)) return scene_name(name);
        std::vector<std::string> known{"Chassis", "Subchassis", "Steering"};
        known.insert(known.end(), sided.begin(), sided.end());
        known.insert(known.end(), shared.begin(), shared.end());
        at.fail(fmt::format("{} is not a body of this suspension{}", at.found(),
                            reader::did_you_mean(name, known, "there are")));
    }

    static bool is_mirrored(const Cursor& entry) {
        const auto field = entry.optional("Mirrored");
        return field && field->yes_or_no();
    }

    // Calls `make` for each entry of a section and for each of its sides.
    void each(const char* section,
              const std::function<void(const Cursor&, const std::string&)>& make) {
        if (!s.has(section)) return;
        for (const Cursor& entry : s.at(section).items()) {
            const std::string name = scene_name(entry.require("Name").text("a name"));
            s.side = +1;
            if (!is_mirrored(entry)) {
                make(entry, name);
                continue;
            }
            for (const int side : {+1, -1}) {
                s.side = side;
                make(entry, s.sided(name));
            }
            s.side = +1;
        }
    }

    Vector3d at(const Cursor& entry, const char* key) const {
        return s.mirrored(vector(entry.require(key)));
    }
};

void generic(Suspension& s) {
    Generic g{s, {}, {}};
    if (s.has("Bodies"))
        for (const Cursor& entry : s.at("Bodies").items())
            (Generic::is_mirrored(entry) ? g.sided : g.shared)
                .insert(entry.require("Name").text("a name"));
    auto& draft = s.draft();
    g.each("Bodies", [&](const Cursor& entry, const std::string& name) {
        const SourceLocation from{entry.value->line, "Bodies/" + name};
        Fields fields;
        fields.add("origin", draft.points.at(g.at(entry, "Position"), name + ".cm", from));
        if (const auto mass = entry.optional("Mass")) fields.add("mass", mass->number());
        if (const auto turned = entry.optional("Rotation"))
            s.leave_out(*turned, "axes of the inertia, without effect at rest");
        draft.bodies.push_back({name, "{" + fields.text() + "}", from});
        draft.notes.count("bodies");
    });
    g.each("Joints", [&](const Cursor& entry, const std::string& name) {
        const std::string type = entry.require("Type").text("a type of joint");
        const std::string i = g.body(entry.require("Body1")), j = g.body(entry.require("Body2"));
        const Vector3d p = g.at(entry, "Position");
        const Matrix3d A =
            entry.optional("Rotation") ? rotation(s, entry.require("Rotation")) : no_turn;
        const SourceLocation from{entry.value->line, "Joints/" + name};
        const auto data = entry.optional("Bushing Data");
        const std::string at = draft.points.at(p, name, from);
        const auto is = [&](std::initializer_list<const char*> names) {
            return std::ranges::any_of(names, [&](const char* other) { return type == other; });
        };
        if (is({"Revolute", "REVOLUTE"}))
            s.joint_or_bushing(Kind::revolute, name, i, j, p, A, "Joints", data);
        else if (is({"Spherical", "SPHERICAL"}))
            s.joint_or_bushing(Kind::spherical, name, i, j, p, A, "Joints", data);
        else if (is({"Universal", "UNIVERSAL"}))
            s.joint_or_bushing(Kind::universal, name, i, j, p, A, "Joints", data);
        else if (is({"Lock", "LOCK"})) {
            if (data) {
                s.ignore(*data, "a bushing instead of a lock");
                draft.notes.miss(from, "a bushing instead of a lock");
            }
            s.joint(name, "fixed", i, j, Fields{}.add("at", at), from);
        } else if (is({"Point Line", "POINTLINE"})) {
            if (data)
                s.ignore(*data,
                         "Chrono ignores the bushing of this joint; the scene has the joint");
            s.joint(name, "in_line", i, j, Fields{}.add("at", at).add("axis", direction(A.col(0))),
                    from);
        } else if (is({"Point Plane", "POINTPLANE"})) {
            if (data)
                s.ignore(*data,
                         "Chrono ignores the bushing of this joint; the scene has the joint");
            s.joint(name, "in_plane", i, j,
                    Fields{}.add("at", at).add("normal", direction(A.col(2))), from);
        } else if (is({"Prismatic", "PRISMATIC", "Cylindrical", "CYLINDRICAL"})) {
            entry.require("Type").fail(
                "Chrono reads this as a lock, probably not intended; write Lock, or change the "
                "joint");
        } else
            entry.require("Type").fail(fmt::format("{} is not a supported joint of Chrono",
                                                   entry.require("Type").found()));
    });
    g.each("Distance Constraints", [&](const Cursor& entry, const std::string& name) {
        const SourceLocation from{entry.value->line, "Distance Constraints/" + name};
        s.joint(name, "distance", g.body(entry.require("Body1")), g.body(entry.require("Body2")),
                Fields{}
                    .add("from", draft.points.at(g.at(entry, "Point1"), name + ".1", from))
                    .add("to", draft.points.at(g.at(entry, "Point2"), name + ".2", from)),
                from);
    });
    g.each("TSDAs", [&](const Cursor& entry, const std::string& name) {
        s.tsda(name, g.body(entry.require("Body1")), g.at(entry, "Point1"),
               g.body(entry.require("Body2")), g.at(entry, "Point2"), entry);
    });
    g.each("RSDAs", [&](const Cursor& entry, const std::string& name) {
        s.rsda(name, g.body(entry.require("Body1")), g.body(entry.require("Body2")),
               g.at(entry, "Position"), g.at(entry, "Axis").normalized(), entry);
    });
    both(s, [&] { s.spindle(g.body(s.at("Spindle/Attachment Body"))); });
}

// ---- The templates by name.

struct Template {
    std::string_view name;
    bool mirrors;  // independent: the left side is written, the scene mirrors it
    void (*make)(Suspension&);
};

const Template templates[] = {
    {"DoubleWishbone", true, double_wishbone},
    {"DoubleWishboneReduced", true, double_wishbone_reduced},
    {"MacPhersonStrut", true, mcpherson},
    {"MultiLink", true, multi_link},
    {"SemiTrailingArm", true, semi_trailing_arm},
    {"ThreeLinkIRS", true, three_link_irs},
    {"SingleWishbone", true, single_wishbone},
    {"SolidAxle", false, solid_axle},
    {"SolidThreeLinkAxle", false, solid_three_link},
    {"SolidBellcrankThreeLinkAxle", false, solid_bellcrank_three_link},
    {"DeDionAxle", false, [](Suspension& s) { dedion(s), rigid_wheels(s); }},
    {"ToeBarDeDionAxle", false, [](Suspension& s) { dedion(s), steered_wheels(s, false); }},
    {"LeafspringAxle", false, [](Suspension& s) { leafspring_guide(s), rigid_wheels(s); }},
    {"ToeBarLeafspringAxle", false,
     [](Suspension& s) { leafspring_guide(s), steered_wheels(s, true); }},
    {"PushPipeAxle", false, [](Suspension& s) { push_pipe(s), rigid_wheels(s); }},
    {"ToeBarPushPipeAxle", false, [](Suspension& s) { push_pipe(s), steered_wheels(s, true); }},
    {"RigidPanhardAxle", false, [](Suspension& s) { rigid_panhard(s), rigid_wheels(s); }},
    {"ToeBarRigidPanhardAxle", false,
     [](Suspension& s) { rigid_panhard(s), steered_wheels(s, true); }},
    {"SAELeafspringAxle", false, [](Suspension& s) { sae_leafspring(s, false); }},
    {"SAEToeBarLeafspringAxle", false, [](Suspension& s) { sae_leafspring(s, true); }},
    {"HendricksonPRIMAXX", false, hendrickson},
    {"GenericWheeledSuspension", false, generic},
};

}  // namespace
}  // namespace elastocheck::importer::chrono

namespace elastocheck::importer {

Draft import_chrono(std::string_view text, const std::string& file, const Options& options) {
    using namespace chrono;
    const reader::Value tree = parse_json(text, file);
    std::vector<Number> numbers;
    reader::Accesses accesses;
    const reader::Cursor root{&tree, "", &file, &numbers, {}, &accesses};
    if (tree.kind != reader::Value::Kind::map)
        root.fail("expected an object: this is not a suspension of Chrono::Vehicle");
    const std::string type = root.require("Type").text("a type");
    if (type != "Suspension")
        root.require("Type").fail(
            fmt::format("{} is not a suspension; allowed: Suspension (of a wheeled vehicle; its "
                        "file is named in the file of the vehicle)",
                        reader::quote(type)));
    const auto named = root.require("Template");
    const std::string name = named.text("a template");
    if (name == "RigidPinnedAxle" || name == "RigidSuspension")
        named.fail(
            fmt::format("{}: the template has no spring, so the wheel is not supported", name));
    const auto found = std::ranges::find(chrono::templates, name, &Template::name);
    if (found == std::end(chrono::templates)) {
        std::vector<std::string> known;
        for (const Template& t : chrono::templates) known.emplace_back(t.name);
        named.fail(fmt::format("{} is not a supported template{}", reader::quote(name),
                               reader::did_you_mean(name, known, "known")));
    }
    if (!options.wheel.empty())
        reader::fail(file, 0, "--wheel",
                     "the wheels of a suspension of Chrono::Vehicle are given by its file");

    Draft draft;
    draft.title = root.optional("Name") ? root.require("Name").text("a name") : name;
    draft.source = file;
    draft.format = "Chrono::Vehicle " + name;
    draft.units = "{length: m, angle: rad, force: N}";
    draft.remarks = {
        "m, N, kg, rad as in the file; x forward, y left, z up. Chassis, subchassis and steering "
        "are ground.",
        "The file has no gravity and no tyre: the branches move the wheels on jacks."};
    if (found->mirrors) draft.mirror = "left -> right";
    Suspension suspension(root, options, draft);
    found->make(suspension);
    suspension.report_unread();
    const char* const range = "from: -0.06, to: 0.06, steps: 120}";
    draft.branches.push_back(
        {"travel",
         fmt::format("{{drive: {}, {}",
                     suspension.one_freedom ? "left.travel" : "[left.travel, right.travel]", range),
         {}});
    if (!found->mirrors && !suspension.one_freedom)
        draft.branches.push_back(
            {"roll", fmt::format("{{drive: {{left.travel: 1, right.travel: -1}}, {}", range), {}});
    return draft;
}

}  // namespace elastocheck::importer
