// Imports Chrono::Vehicle suspension templates.
// Points and joints as in the templates; chassis and subchassis are ground, and so is the steering of
// a suspension without its vehicle.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>

#include "models/import/chrono/suspension.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer::chrono {
namespace {

using reader::Cursor;

const Matrix3d no_turn = Matrix3d::Identity();
using OuterEnd = Suspension::OuterEnd;

// An arm on an axis through two points: chassis to arm at their middle.
void arm(Suspension& s, const std::string& name, const std::string& part,
         const char* front = "Location Chassis Front", const char* back = "Location Chassis Back") {
    s.body(name + "*", part);
    const FilePoint f = s.point(part + "/" + front), b = s.point(part + "/" + back);
    s.joint_or_bushing(Kind::revolute, name + ".axis*", "ground", name + "*",
                       s.midpoint(name + ".axis", "front", f, "rear", b),
                       frame_along(f - b, Vector3d::UnitZ()), s.optional(part + "/Bushing Data"));
}

// The same with a ball joint on the upright.
void wishbone(Suspension& s, const std::string& name, const std::string& part) {
    arm(s, name, part);
    s.spherical(name + ".ball_joint*", name + "*", "upright*", part + "/Location Upright");
}

// Links with the same joints, by their names in the scene and in the file.
using Named = std::pair<std::string, std::string>;

void spring_and_shock(Suspension& s, const std::string& end, const std::string& on,
                      const std::string& spring = "Spring") {
    for (const auto& [name, part] :
         {Named{spring == "Spring" ? "spring*" : "auxiliary_spring*", spring},
          {"damper*", "Shock"}})
        if (const auto data = s.optional(part))
            s.tsda(s.on_side(name), "ground", s.point(part + "/Location Chassis"), s.on_side(on),
                   s.point(part + "/" + end), *data);
}

void wheel_on(Suspension& s, const char* carrier) { s.spindle(s.on_side(carrier)); }

// ---- Independent suspensions: one side, mirrored by the scene.

// What all with an upright have besides their links; the spring acts on `on`.
void tierod_spring_and_wheel(Suspension& s, const char* end, const char* on) {
    s.tierod("Location Chassis", "Location Upright", "upright*");
    spring_and_shock(s, end, on);
    wheel_on(s, "upright*");
}

void double_wishbone(Suspension& s) {
    s.body("upright*", "Upright");
    wishbone(s, "upper_arm", "Upper Control Arm");
    wishbone(s, "lower_arm", "Lower Control Arm");
    tierod_spring_and_wheel(s, "Location Arm", "lower_arm*");
}

void double_wishbone_reduced(Suspension& s) {
    s.body("upright*", "Upright");
    for (const auto& [level, part] :
         {Named{"upper", "Upper Control Arm"}, {"lower", "Lower Control Arm"}})
        for (const auto& [name, end] : {Named{"_front*", "Front"}, {"_rear*", "Back"}})
            s.distance(level + name, "ground", s.point(part + "/Location Chassis " + end),
                       "upright*", s.point(part + "/Location Upright"));
    tierod_spring_and_wheel(s, "Location Upright", "upright*");
}

void mcpherson(Suspension& s) {
    s.body("upright*", "Upright");
    wishbone(s, "arm", "Control Arm");
    const FilePoint top = s.point("Spring/Location Chassis"),
                    seat = s.point("Spring/Location Upright");
    s.body("strut*", 0.5 * (top + seat), "Strut");
    const Matrix3d A = frame_along(seat - top, Vector3d::UnitX());
    s.universal("strut.mount*", "ground", "strut*", top, A);
    s.joint("strut.tube*", "cylindrical", "strut*", "upright*", seat,
            Fields{}.add("axis", direction(A.col(2))));
    tierod_spring_and_wheel(s, "Location Upright", "upright*");
}

void multi_link(Suspension& s) {
    s.body("upright*", "Upright");
    wishbone(s, "upper_arm", "Upper Arm");
    // x of the universal joint is fixed to the link, y to the chassis.
    for (const auto& [name, part] :
         {Named{"lateral", "Lateral"}, {"trailing_link", "Trailing Link"}}) {
        s.body(name + "*", part);
        s.spherical(name + ".outer*", name + "*", "upright*", part + "/Location Upright");
        s.universal(name + ".inner*", name + "*", "ground", s.point(part + "/Location Chassis"),
                    s.point(part + "/Universal Joint Axis Chassis"),
                    s.point(part + "/Universal Joint Axis Link"));
    }
    tierod_spring_and_wheel(s, "Location Link", "trailing_link*");
}

void semi_trailing_arm(Suspension& s) {
    s.point("Trailing Arm/Location Spindle");
    arm(s, "arm", "Trailing Arm", "Location Chassis Outer", "Location Chassis Inner");
    spring_and_shock(s, "Location Arm", "arm*");
    wheel_on(s, "arm*");
}

void three_link_irs(Suspension& s) {
    s.point("Trailing Arm/Location Spindle");
    s.body("arm*", "Trailing Arm");
    const auto on_chassis = s.optional("Bushing Data Chassis"),
               on_arm = s.optional("Bushing Data Arm");
    s.joint_or_bushing(Kind::spherical, "arm.joint*", "ground", "arm*",
                       s.point("Trailing Arm/Location Chassis"), no_turn, on_chassis);
    for (const auto& [name, part] :
         {Named{"upper_link", "Upper Link"}, {"lower_link", "Lower Link"}}) {
        s.body(name + "*", part);
        const FilePoint c = s.point(part + "/Location Chassis"),
                        a = s.point(part + "/Location Arm");
        s.joint_or_bushing(Kind::spherical, name + ".outer*", name + "*", "arm*", a, no_turn,
                           on_arm);
        s.joint_or_bushing(Kind::universal, name + ".inner*", name + "*", "ground", c,
                           frame_along(c - a, s.point(part + "/Universal Joint Axis")), on_chassis);
    }
    spring_and_shock(s, "Location Arm", "arm*");
    wheel_on(s, "arm*");
}

void single_wishbone(Suspension& s) {
    s.body("upright*", "Upright");
    s.body("arm*", "Control Arm");
    s.joint_or_bushing(
        Kind::revolute, "arm.axis*", "ground", "arm*", s.point("Control Arm/Location Chassis"),
        frame_along(Vector3d::UnitX(), Vector3d::UnitZ()), s.optional("Control Arm/Bushing Data"));
    s.revolute("king_pin*", "arm*", "upright*", s.point("Control Arm/Location Upright"),
               Vector3d::UnitZ());
    tierod_spring_and_wheel(s, "Location Arm", "arm*");
}

// ---- Axles: both sides written out, since their shared parts are not symmetric.

void both(Suspension& s, const std::function<void()>& make) {
    for (const int side : {+1, -1}) {
        s.side = side;
        make();
    }
    s.side = +1;
}

// A knuckle on the axle's king pin.
void knuckle(Suspension& s, const char* lower = "Knuckle/Location Lower",
             const char* upper = "Knuckle/Location Upper") {
    s.body("knuckle*", "Knuckle");
    const FilePoint low = s.point(lower), high = s.point(upper);
    s.revolute("king_pin*", "axle", "knuckle*", s.midpoint("king_pin", "lower", low, "upper", high),
               low - high);
}

// Spring, shock and wheel of both sides, and the knuckles of a steered axle.
enum class Axle { rigid, steered };
void spring_and_wheel(Suspension& s, Axle axle, const char* spring = "Spring") {
    if (axle == Axle::steered) knuckle(s);
    spring_and_shock(s, "Location Axle", "axle", spring);
    wheel_on(s, axle == Axle::steered ? "knuckle*" : "axle");
}

// The track rod between both knuckles.
void shared_tierod(Suspension& s) {
    const FilePoint end = s.point("Tierod/Location Knuckle"),
                    other{Vector3d(end.x(), -end.y(), end.z()), end.path};
    s.body("tierod", 0.5 * (end + other), "Tierod");
    s.spherical("tierod.left", "tierod", "knuckle_left", end);
    s.universal("tierod.right", "tierod", "knuckle_right", other, Vector3d::UnitX(),
                Vector3d::UnitZ());
}

// The drag link from ground to one of the knuckles, as the sign of y says.
void draglink(Suspension& s, OuterEnd outer) {
    const FilePoint end = s.point("Knuckle/Location Draglink");
    s.link("draglink", "Draglink", s.steering(), s.point("Draglink/Location Chassis"),
           end.y() > 0 ? "knuckle_left" : "knuckle_right", end, outer);
}

void solid_axle(Suspension& s) {
    s.body("axle", "Axle Tube");
    both(s, [&] {
        knuckle(s);
        for (const auto& [level, part, beside] : {std::tuple<std::string, std::string, std::string>{
                                                      "upper", "Upper Link", "Lower Link"},
                                                  {"lower", "Lower Link", "Upper Link"}}) {
            const std::string name = level + "_link";
            const FilePoint c = s.point(part + "/Location Chassis"),
                            a = s.point(part + "/Location Axle");
            s.body(name + "*", part);
            s.universal(name + ".inner*", "ground", name + "*", c,
                        frame_along(c - a, a - s.point(beside + "/Location Axle")));
            s.spherical(name + ".outer*", "axle", name + "*", a);
        }
        spring_and_shock(s, "Location Axle", "axle");
        wheel_on(s, "knuckle*");
    });
    shared_tierod(s);
    if (s.has("Trackbar")) {  // without it the non-parallel links already hold the axle sideways
        s.one_freedom = true;
        s.draft().notes.warn(
            s.place("Trackbar"),
            "links and track bar leave the axle a single, poorly determined degree of freedom: the "
            "branch drives the left wheel, the right one follows");
        s.link("trackbar", "Trackbar", "ground", s.point("Trackbar/Location Chassis"), "axle",
               s.point("Trackbar/Location Axle"));
    }
    // Drag link, bell crank, and the pin of the bell crank in the track rod's plane.
    const FilePoint d = s.point("Draglink/Location Bell Crank"),
                    pivot = s.point("Bell Crank/Location Axle"),
                    pin = s.point("Bell Crank/Location Tierod");
    s.body("bell_crank", (d + pivot + pin) / 3, "Bell Crank");
    s.link("draglink", "Draglink", s.steering(), s.point("Draglink/Location Chassis"), "bell_crank",
           d, OuterEnd::universal);
    const Vector3d axis = (d - pivot).cross(pin - pivot);
    if (!(axis.norm() > 1e-12))
        s.at(pivot.path).fail("on one line with the other points of the bell crank");
    s.revolute("bell_crank.pivot", "bell_crank", "axle", pivot, axis);
    s.in_plane("bell_crank.pin", "bell_crank", "tierod", pin, Vector3d::UnitY());
}

// Triangle and links of the three-link axles.
void three_links(Suspension& s) {
    FilePoint c = s.point("Triangular Link/Location Chassis"),
              a = s.point("Triangular Link/Location Axle");
    c.y() = a.y() = 0;  // the middle of both sides
    s.draft().points.at(c, "triangle.axis", {0, c.path + ", at y = 0"});
    s.draft().points.at(a, "triangle.ball_joint", {0, a.path + ", at y = 0"});
    s.body("triangle", 0.5 * (c + a), "Triangular Link");
    s.revolute("triangle.axis", "triangle", "ground", c, Vector3d::UnitY());
    s.spherical("triangle.ball_joint", "triangle", "axle", a);
    both(s, [&] {
        const FilePoint chassis = s.point("Longitudinal Link/Location Chassis"),
                        axle = s.point("Longitudinal Link/Location Axle");
        s.body("link*", 0.5 * (chassis + axle), "Longitudinal Link");
        s.spherical("link.outer*", "link*", "axle", axle);
        s.universal("link.inner*", "link*", "ground", chassis,
                    frame_along(chassis - axle, Vector3d::UnitY()));
    });
}

void solid_three_link(Suspension& s) {
    s.body("axle", "Axle Tube");
    three_links(s);
    both(s, [&] { spring_and_wheel(s, Axle::rigid); });
}

void solid_bellcrank_three_link(Suspension& s) {
    s.body("axle", "Axle Tube");
    three_links(s);
    const FilePoint pivot = s.point("Bellcrank/Location Axle");
    s.body("bellcrank", pivot, "Bellcrank");
    s.revolute("bellcrank.pivot", "axle", "bellcrank", pivot, Vector3d::UnitZ());
    s.link("draglink", "Draglink", s.steering(), s.point("Draglink/Location Steering"), "bellcrank",
           s.point("Draglink/Location Bellcrank"), OuterEnd::universal);
    both(s, [&] {
        knuckle(s);
        s.link("tierod*", "Tierod", "bellcrank", s.point("Bellcrank/Location Tierod"), "knuckle*",
               s.point("Knuckle/Location Tierod"));
        spring_and_shock(s, "Location Axle", "axle");
        wheel_on(s, "knuckle*");
    });
}

// The axle's ball joint on the chassis.
void axle_on_a_ball(Suspension& s) {
    s.body("axle", "Axle Tube");
    s.spherical("axle.ball_joint", "axle", "ground", "Axle Tube/Location Connector Chassis");
}

// De Dion axle, with a Watt linkage for lateral guidance.
void dedion(Suspension& s) {
    axle_on_a_ball(s);
    const std::string watt = "Watt Mechanism/Location ";
    const Vector3d middle =
        0.5 * (s.point(watt + "Left Link to Center") + s.point(watt + "Right Link to Center"));
    s.draft().points.at(
        middle, "watt_centre.pivot",
        {0, "midpoint of Watt Mechanism/Location Left Link to Center and Right Link to Center"});
    s.body("watt_centre", middle, "Watt Mechanism", "Center Link Mass");
    s.revolute("watt_centre.pivot", "watt_centre", "axle", {middle, "Watt Mechanism"},
               Vector3d::UnitX());
    for (const auto& [name, side] :
         {Named{"watt_link_left", "Left"}, {"watt_link_right", "Right"}}) {
        const FilePoint centre = s.point(watt + side + " Link to Center"),
                        chassis = s.point(watt + side + " Link to Chassis");
        s.body(name, 0.5 * (centre + chassis), "Watt Mechanism", "Side Link Mass");
        s.spherical(name + ".inner", name, "watt_centre", centre);
        s.spherical(name + ".outer", name, "ground", chassis);
    }
}

// Allows only heave along z and roll about x.
void leafspring_guide(Suspension& s) {
    s.body("axle", "Axle Tube");
    const FilePoint p{s.point("Axle Tube/COM"), "Axle Tube"};
    s.in_plane("axle.fore_aft", "axle", "ground", p, Vector3d::UnitX());
    s.in_plane("axle.lateral", "axle", "ground", p, Vector3d::UnitY());
    s.joint("axle.roll_axis", "parallel", "axle", "ground", Fields{}.add("axis", "x"),
            s.place("Axle Tube"));
}

// `on`: how the fields of its ends begin.
void panhard_rod(Suspension& s, const std::string& on) {
    s.link("panhard_rod", "Panhard Rod", "ground", s.point(on + "Chassis"), "axle",
           s.point(on + "Axle"));
}

void push_pipe(Suspension& s) {
    axle_on_a_ball(s);
    if (const auto offset = s.optional("Axle Tube/Portal Offset"); offset && offset->number() != 0)
        s.draft().notes.miss(s.place("Axle Tube/Portal Offset"),
                             "a portal axle, whose gears are not supported");
    panhard_rod(s, "Panhard Rod/Location Connector ");
}

void rigid_panhard(Suspension& s) {
    s.body("axle", "Axle Tube");
    s.joint(
        "axle.guide", "planar", "ground", "axle",
        Fields{}.add("at", s.hardpoint("axle.guide", s.point("Axle Tube/COM"))).add("normal", "x"),
        s.place("Axle Tube"));
    panhard_rod(s, "Panhard Rod/Location ");
    // An anti-roll bar in two halves: the left one rotates in the chassis, the right one relative
    // to it.
    const FilePoint chassis = s.point("Anti Roll Bar/Location Chassis"),
                    middle{Vector3d(chassis.x(), 0, chassis.z()), chassis.path};
    s.draft().points.at(middle, "antiroll_bar.bearing", {0, chassis.path + ", at y = 0"});
    both(s, [&] {
        s.body("antiroll_bar*", 0.5 * (s.point("Anti Roll Bar/Location Chassis") + middle),
               "Anti Roll Bar");
    });
    s.revolute("antiroll_bar.bearing", "ground", "antiroll_bar_left", middle, Vector3d::UnitY());
    s.revolute("antiroll_bar.middle", "antiroll_bar_left", "antiroll_bar_right", middle,
               Vector3d::UnitY());
    const char* const rate = "Anti Roll Bar/Rotational Stiffness";
    s.torsion("antiroll_bar.twist", "antiroll_bar_left", "antiroll_bar_right", {middle, rate},
              Vector3d::UnitY(), s.real(rate));
    both(s, [&] {
        s.in_plane("antiroll_bar.slide*", "antiroll_bar*", "axle",
                   s.point("Anti Roll Bar/Location Axle"), Vector3d::UnitZ());
    });
}

void rigid_wheels(Suspension& s) {
    both(s, [&] { spring_and_wheel(s, Axle::rigid); });
}

void steered_wheels(Suspension& s, OuterEnd draglink_end = OuterEnd::universal) {
    both(s, [&] { spring_and_wheel(s, Axle::steered); });
    shared_tierod(s);
    draglink(s, draglink_end);
}

// A leaf spring in two halves (SAE): a spring about y and one about z at each clamp. The preload is
// shared equally.
void leaf(Suspension& s) {
    const std::string in = "Leafspring/";
    const FilePoint hanger = s.point(in + "Location Front Hanger"),
                    a = s.point(in + "Location Clamp A"), b = s.point(in + "Location Clamp B"),
                    shackle = s.point(in + "Location Shackle"),
                    rear = s.point(in + "Location Rear Hanger");
    const double bias = s.real(in + "Stiffness Bias"),
                 preload = s.real(in + "Vertical Preload Force");
    const double vertical = s.real(in + "Vertical Stiffness") / (1 + bias),
                 lateral = s.real(in + "Lateral Stiffness") / (1 + bias);
    s.body("front_leaf*", 0.5 * (hanger + a), in + "Frontleaf");
    s.body("rear_leaf*", 0.5 * (shackle + b), in + "Rearleaf");
    s.body("clamp_a*", 0.75 * a + 0.25 * b, in + "Half Clamp");
    s.body("clamp_b*", 0.75 * b + 0.25 * a, in + "Half Clamp");
    s.body("shackle*", 0.5 * (rear + shackle), in + "Shackle");
    const Matrix3d about_y = frame_along(-Vector3d::UnitY(), Vector3d::UnitZ());
    const auto on_shackle = s.optional(in + "Shackle Bushing Data"),
               on_clamp = s.optional(in + "Clamp Bushing Data"),
               on_leaf = s.optional(in + "Leafspring Bushing Data");
    s.joint_or_bushing(Kind::revolute, "shackle.hanger*", "shackle*", "ground", rear, about_y,
                       on_shackle);
    s.spherical("front_leaf.hanger*", "front_leaf*", "ground", hanger);
    s.spherical("rear_leaf.shackle*", "rear_leaf*", "shackle*", shackle);
    struct Half {
        std::string name, leaf;
        FilePoint p;
        Vector3d arm;
        double share;
    };
    for (const auto& [name, half, p, arm, share] :
         {Half{"clamp_a", "front_leaf*", a, a - hanger, 1},
          Half{"clamp_b", "rear_leaf*", b, b - shackle, bias}}) {
        const double square = arm.squaredNorm();
        s.joint_or_bushing(Kind::revolute, name + ".yaw*", name + "*", "axle", p, no_turn,
                           on_clamp);
        s.torsion(name + ".lateral*", name + "*", "axle", p, Vector3d::UnitZ(),
                  share * lateral * square);
        s.joint_or_bushing(Kind::revolute, name + ".pitch*", name + "*", half, p, about_y, on_leaf);
        // Moment about y on the leaf whose far end then pushes the chassis up with half the
        // preload: arm × force.
        s.torsion(name + ".vertical*", name + "*", half, p, Vector3d::UnitY(),
                  share * vertical * square, -0.5 * preload * arm.x());
    }
    if (preload != 0 && s.side > 0)
        s.draft().notes.warn(s.place(in + "Vertical Preload Force"),
                             "interpreted as the force that supports the chassis at the design "
                             "position: the sign of Chrono's rest angle is not documented");
}

void sae_leafspring(Suspension& s, Axle axle) {
    s.body("axle", "Axle Tube");
    both(s, [&] {
        leaf(s);
        spring_and_wheel(s, axle, "Auxiliary Spring");
    });
    if (axle == Axle::rigid) return;
    shared_tierod(s);
    draglink(s, OuterEnd::universal);
}

// The lower shock end is on the housing, as in Chrono.
void hendrickson(Suspension& s) {
    s.one_freedom = true;
    s.draft().notes.warn(s.place("Lower Beam"),
                         "beams and rods that rotate only about y prevent roll of the axle: the "
                         "branch drives the left wheel, the right one follows");
    s.body("axle", "Axle Housing");
    s.body("transverse_beam", "Transverse Beam");
    both(s, [&] {
        knuckle(s, "Knuckle/Lower Attachment Point", "Knuckle/Upper Attachment Point");
        for (const auto& [name, part] :
             {Named{"torque_rod", "Torque Rod"}, {"lower_beam", "Lower Beam"}}) {
            s.body(name + "*", part);
            s.revolute(name + ".inner*", "ground", name + "*",
                       s.point(part + "/Chassis Attachment Point"), Vector3d::UnitY());
            s.spherical(name + ".outer*", "axle", name + "*",
                        part + "/Axle Housing Attachment Point");
        }
        s.spherical("transverse_beam.end*", "lower_beam*", "transverse_beam",
                    "Lower Beam/Transverse Beam Attachment Point");
        s.tierod("Location Chassis", "Location Knuckle", "knuckle*");
        for (const auto& [name, end] :
             {Named{"housing_shock", "Axle Housing"}, {"beam_shock", "Lower Beam"}})
            s.tsda(s.sided(name), "ground", s.point("Shock " + end + "/Location Chassis"), "axle",
                   s.point("Shock " + end + "/Location " + end), s.at("Shock " + end));
        wheel_on(s, "knuckle*");
    });
}

// ---- GenericWheeledSuspension: parts and joints by name.

// On the right side the y components of the frame's x and z change sign; y completes the frame.
Matrix3d rotation_on_side(const Suspension& s, const Cursor& at) {
    const Matrix3d A = rotation(at);
    if (s.side > 0) return A;
    const Vector3d x = s.mirrored(A.col(0)), z = s.mirrored(A.col(2));
    Matrix3d B;
    B << x, z.cross(x), z;
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
        if (name == "Steering") return s.steering();
        if (name == "Chassis" || name == "Subchassis") return "ground";
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
            if (is_mirrored(entry))
                both(s, [&] { make(entry, s.sided(name)); });
            else
                make(entry, name);
        }
    }

    Vector3d at(const Cursor& entry, const char* key) const {
        return s.mirrored(vector(entry.require(key)));
    }
};

// Joints of Chrono: one that a bushing may replace, or the type in a scene with the name of its
// direction and the axis of the joint's frame; neither: one that Chrono's reader treats as a lock.
struct ChronoJoint {
    std::string_view name, capitals;
    std::optional<Kind> bushing_in_place = {};
    const char *type = nullptr, *direction = nullptr;
    int axis = 0;
};
constexpr ChronoJoint chrono_joints[] = {
    {"Revolute", "REVOLUTE", Kind::revolute},
    {"Spherical", "SPHERICAL", Kind::spherical},
    {"Universal", "UNIVERSAL", Kind::universal},
    {"Lock", "LOCK", {}, "fixed"},
    {"Point Line", "POINTLINE", {}, "in_line", "axis", 0},
    {"Point Plane", "POINTPLANE", {}, "in_plane", "normal", 2},
    {"Prismatic", "PRISMATIC"},
    {"Cylindrical", "CYLINDRICAL"},
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
        draft.bodies.push_back({name, fields.braced(), from});
        draft.notes.count("bodies");
    });
    g.each("Joints", [&](const Cursor& entry, const std::string& name) {
        const std::string type = entry.require("Type").text("a type of joint");
        const std::string i = g.body(entry.require("Body1")), j = g.body(entry.require("Body2"));
        const Vector3d p = g.at(entry, "Position");
        const Matrix3d A =
            entry.optional("Rotation") ? rotation_on_side(s, entry.require("Rotation")) : no_turn;
        const SourceLocation from{entry.value->line, "Joints/" + name};
        const auto data = entry.optional("Bushing Data");
        const std::string at = draft.points.at(p, name, from);
        const auto found = std::ranges::find_if(chrono_joints, [&](const ChronoJoint& joint) {
            return type == joint.name || type == joint.capitals;
        });
        if (found == std::end(chrono_joints))
            entry.require("Type").fail(fmt::format("{} is not a supported joint of Chrono",
                                                   entry.require("Type").found()));
        if (found->bushing_in_place)
            return s.joint_or_bushing(*found->bushing_in_place, name, i, j, {p, "Joints"}, A, data);
        if (!found->type)
            entry.require("Type").fail(
                "Chrono reads this as a lock, probably not intended; write Lock, or change the "
                "joint");
        const bool is_lock = std::string_view(found->type) == "fixed";
        if (data) {
            s.ignore(*data, is_lock ? "a bushing instead of a lock"
                                    : "Chrono ignores the bushing of this joint; the scene has the "
                                      "joint");
            if (is_lock) draft.notes.miss(from, "a bushing instead of a lock");
        }
        Fields fields;
        fields.add("at", at);
        if (found->direction) fields.add(found->direction, direction(A.col(found->axis)));
        s.joint(name, found->type, i, j, fields, from);
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
    const char* antiroll_body = nullptr;  // to which Chrono attaches the links of an anti-roll bar
};

const Template templates[] = {
    {"DoubleWishbone", true, double_wishbone, "lower_arm*"},
    {"DoubleWishboneReduced", true, double_wishbone_reduced, "upright*"},
    {"MacPhersonStrut", true, mcpherson, "arm*"},
    {"MultiLink", true, multi_link, "trailing_link*"},
    {"SemiTrailingArm", true, semi_trailing_arm},
    {"ThreeLinkIRS", true, three_link_irs},
    {"SingleWishbone", true, single_wishbone, "arm*"},
    {"SolidAxle", false, solid_axle},
    {"SolidThreeLinkAxle", false, solid_three_link},
    {"SolidBellcrankThreeLinkAxle", false, solid_bellcrank_three_link},
    {"DeDionAxle", false, [](Suspension& s) { dedion(s), rigid_wheels(s); }},
    {"ToeBarDeDionAxle", false,
     [](Suspension& s) { dedion(s), steered_wheels(s, OuterEnd::spherical); }},
    {"LeafspringAxle", false, [](Suspension& s) { leafspring_guide(s), rigid_wheels(s); }},
    {"ToeBarLeafspringAxle", false, [](Suspension& s) { leafspring_guide(s), steered_wheels(s); }},
    {"PushPipeAxle", false, [](Suspension& s) { push_pipe(s), rigid_wheels(s); }},
    {"ToeBarPushPipeAxle", false, [](Suspension& s) { push_pipe(s), steered_wheels(s); }},
    {"RigidPanhardAxle", false, [](Suspension& s) { rigid_panhard(s), rigid_wheels(s); }},
    {"ToeBarRigidPanhardAxle", false, [](Suspension& s) { rigid_panhard(s), steered_wheels(s); }},
    {"SAELeafspringAxle", false, [](Suspension& s) { sae_leafspring(s, Axle::rigid); }},
    {"SAEToeBarLeafspringAxle", false, [](Suspension& s) { sae_leafspring(s, Axle::steered); }},
    {"HendricksonPRIMAXX", false, hendrickson},
    {"GenericWheeledSuspension", false, generic},
};

}  // namespace

Made make(Suspension& s) {
    const Cursor& root = s.file();
    const auto named = root.require("Template");
    const std::string name = named.text("a template");
    if (name == "RigidPinnedAxle" || name == "RigidSuspension")
        named.fail(
            fmt::format("{}: the template has no spring, so the wheel is not supported", name));
    const auto found = std::ranges::find(templates, name, &Template::name);
    if (found == std::end(templates)) {
        std::vector<std::string> known;
        for (const Template& t : templates) known.emplace_back(t.name);
        named.fail(fmt::format("{} is not a supported template{}", reader::quote(name),
                               reader::did_you_mean(name, known, "known")));
    }
    Draft& draft = s.draft();
    draft.title = root.optional("Name") ? root.require("Name").text("a name") : name;
    draft.format = "Chrono::Vehicle " + name;
    draft.units = "{length: m, angle: rad, force: N}";
    if (found->mirrors) draft.mirror = "left -> right";
    found->make(s);
    s.report_unread();
    return {found->mirrors, found->antiroll_body ? found->antiroll_body : ""};
}

void add_travel(const Suspension& s, bool roll, Draft& draft) {
    const char* const range = "from: -0.06, to: 0.06, steps: 120}";
    draft.branches.push_back(
        {"travel",
         fmt::format("{{drive: {}, {}",
                     s.one_freedom ? "left.travel" : "[left.travel, right.travel]", range),
         {}});
    if (roll && !s.one_freedom)
        draft.branches.push_back(
            {"roll", fmt::format("{{drive: {{left.travel: 1, right.travel: -1}}, {}", range), {}});
}

}  // namespace elastocheck::importer::chrono

namespace elastocheck::importer {

Draft import_chrono(std::string_view text, const std::string& file, const Options& options) {
    using namespace chrono;
    const JsonFile json(text, file);
    const std::string type = json.root.require("Type").text("a type");
    if (!options.wheel.empty())
        reader::fail(file, 0, "--wheel",
                     "the wheels of a suspension of Chrono::Vehicle are given by its file");
    if (type == "Vehicle") return import_vehicle(json, options);
    if (type != "Suspension")
        json.root.require("Type").fail(fmt::format(
            "{} is not a suspension; allowed: Suspension, Vehicle (with wheels, not tracks)",
            reader::quote(type)));
    if (!options.axle.empty())
        reader::fail(file, 0, "--axle", "only for a vehicle; this file is one suspension");
    Draft draft;
    draft.source = file;
    draft.remarks = {
        "m, N, kg, rad as in the file; x forward, y left, z up. Chassis, subchassis and steering "
        "are ground.",
        "The file has no gravity and no tyre: the branches move the wheels on jacks."};
    Suspension suspension(json.root, options, draft);
    const Made made = make(suspension);
    add_travel(suspension, !made.mirrors, draft);
    return draft;
}

}  // namespace elastocheck::importer
