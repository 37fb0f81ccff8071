// Imports Chrono::Vehicle suspension templates.
// Points and joints as in the templates, whose steps are in templates.yaml; chassis and subchassis are
// ground, and so is the steering of a suspension without its vehicle.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <span>

#include "chrono_embedded.hpp"  // generated: text of templates.yaml
#include "models/import/chrono/suspension.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer::chrono {

using reader::Cursor, reader::Value;

const Value& templates_section(std::string_view name) {
    static const Value file = reader::parse_yaml(embedded_chrono[0].text, "templates.yaml");
    return *entry(file, name);
}

namespace {

const Matrix3d no_turn = Matrix3d::Identity();
using OuterEnd = Suspension::OuterEnd;

// ---- Steps of more than one part.

// An arm on an axis through two points: chassis to arm at their middle.
void arm(Suspension& s, const std::string& name, const std::string& part,
         const std::string& front = "Location Chassis Front",
         const std::string& back = "Location Chassis Back") {
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

// Spring and damper, where given.
void springs(Suspension& s, const std::string& end, const std::string& on,
             const std::string& spring) {
    for (const auto& [name, part] :
         {std::pair<const char*, std::string>{spring == "Spring" ? "spring*" : "auxiliary_spring*",
                                              spring},
          {"damper*", "Shock"}})
        if (const auto data = s.optional(part))
            s.tsda(s.on_side(name), "ground", s.point(part + "/Location Chassis"), s.on_side(on),
                   s.point(part + "/" + end), *data);
}

void both(Suspension& s, const std::function<void()>& make) {
    for (const int side : {+1, -1}) {
        s.side = side;
        make();
    }
    s.side = +1;
}

// A knuckle on the axle's king pin.
void knuckle(Suspension& s, const std::string& lower, const std::string& upper) {
    s.body("knuckle*", "Knuckle");
    const FilePoint low = s.point(lower), high = s.point(upper);
    s.revolute("king_pin*", "axle", "knuckle*", s.midpoint("king_pin", "lower", low, "upper", high),
               low - high);
}

// The track rod between both knuckles.
void track_rod(Suspension& s) {
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

void bell_crank(Suspension& s) {
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

// The triangle of the three-link axles, in the middle of both sides.
void triangle(Suspension& s) {
    FilePoint c = s.point("Triangular Link/Location Chassis"),
              a = s.point("Triangular Link/Location Axle");
    c.y() = a.y() = 0;
    s.draft().points.at(c, "triangle.axis", {0, c.path + ", at y = 0"});
    s.draft().points.at(a, "triangle.ball_joint", {0, a.path + ", at y = 0"});
    s.body("triangle", 0.5 * (c + a), "Triangular Link");
    s.revolute("triangle.axis", "triangle", "ground", c, Vector3d::UnitY());
    s.spherical("triangle.ball_joint", "triangle", "axle", a);
}

// Lateral guidance of the De Dion axle.
void watt_linkage(Suspension& s) {
    const std::string watt = "Watt Mechanism/Location ";
    const Vector3d middle =
        0.5 * (s.point(watt + "Left Link to Center") + s.point(watt + "Right Link to Center"));
    s.draft().points.at(
        middle, "watt_centre.pivot",
        {0, "midpoint of Watt Mechanism/Location Left Link to Center and Right Link to Center"});
    s.body("watt_centre", middle, "Watt Mechanism", "Center Link Mass");
    s.revolute("watt_centre.pivot", "watt_centre", "axle", {middle, "Watt Mechanism"},
               Vector3d::UnitX());
    for (const std::string side : {"Left", "Right"}) {
        const std::string name = side == "Left" ? "watt_link_left" : "watt_link_right";
        const FilePoint centre = s.point(watt + side + " Link to Center"),
                        chassis = s.point(watt + side + " Link to Chassis");
        s.body(name, 0.5 * (centre + chassis), "Watt Mechanism", "Side Link Mass");
        s.spherical(name + ".inner", name, "watt_centre", centre);
        s.spherical(name + ".outer", name, "ground", chassis);
    }
}

// Allows only heave along z and roll about x.
void heave_and_roll(Suspension& s) {
    const FilePoint p{s.point("Axle Tube/COM"), "Axle Tube"};
    s.in_plane("axle.fore_aft", "axle", "ground", p, Vector3d::UnitX());
    s.in_plane("axle.lateral", "axle", "ground", p, Vector3d::UnitY());
    s.joint("axle.roll_axis", "parallel", "axle", "ground", Fields{}.add("axis", "x"),
            s.place("Axle Tube"));
}

void guide_across_x(Suspension& s) {
    s.joint(
        "axle.guide", "planar", "ground", "axle",
        Fields{}.add("at", s.hardpoint("axle.guide", s.point("Axle Tube/COM"))).add("normal", "x"),
        s.place("Axle Tube"));
}

void no_portal(Suspension& s) {
    if (const auto offset = s.optional("Axle Tube/Portal Offset"); offset && offset->number() != 0)
        s.draft().notes.miss(s.place("Axle Tube/Portal Offset"),
                             "a portal axle, whose gears are not supported");
}

void roll_bar_in_halves(Suspension& s) {
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

// Half of a leaf spring (SAE), from its clamp to its end: a spring about z and one about y at the clamp.
// Both halves have an equal part of the preload.
void half_leaf(Suspension& s, const std::string& name, const std::string& half,
               const std::string& clamp, const std::string& end) {
    const std::string in = "Leafspring/";
    const FilePoint p = s.point(in + clamp);
    const Vector3d arm = p - s.point(in + end);
    const double bias = s.real(in + "Stiffness Bias"), share = half == "front_leaf*" ? 1 : bias,
                 preload = s.real(in + "Vertical Preload Force"),
                 vertical = s.real(in + "Vertical Stiffness") / (1 + bias),
                 lateral = s.real(in + "Lateral Stiffness") / (1 + bias),
                 square = arm.squaredNorm();
    s.joint_or_bushing(Kind::revolute, name + ".yaw*", name + "*", "axle", p, no_turn,
                       s.optional(in + "Clamp Bushing Data"));
    s.torsion(name + ".lateral*", name + "*", "axle", p, Vector3d::UnitZ(),
              share * lateral * square);
    s.joint_or_bushing(Kind::revolute, name + ".pitch*", name + "*", half, p,
                       frame_along(-Vector3d::UnitY(), Vector3d::UnitZ()),
                       s.optional(in + "Leafspring Bushing Data"));
    // Moment about y on the leaf whose far end then pushes the chassis up with half the preload: arm ×
    // force.
    s.torsion(name + ".vertical*", name + "*", half, p, Vector3d::UnitY(),
              share * vertical * square, -0.5 * preload * arm.x());
    if (preload != 0 && s.side > 0 && half != "front_leaf*")
        s.draft().notes.warn(s.place(in + "Vertical Preload Force"),
                             "interpreted as the force that supports the chassis at the design "
                             "position: the sign of Chrono's rest angle is not documented");
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

// ---- Steps of a template, by their names in templates.yaml.

using Words = std::vector<std::string>;

// "y", "-y"; a point of the file; or the difference of two.
Vector3d vector_of(const Suspension& s, const std::string& word) {
    for (const int axis : {0, 1, 2})
        if (word.back() == "xyz"[axis] && word.size() <= 2)
            return word.front() == '-' ? Vector3d(-Vector3d::Unit(axis)) : Vector3d::Unit(axis);
    const auto minus = word.find(" - ");
    if (minus == word.npos) return s.point(word);
    const Vector3d to = s.point(word.substr(0, minus));
    return to - s.point(word.substr(minus + 3));
}

template <Kind kind>
void joint_or_bushing(Suspension& s, const Words& w) {
    const FilePoint at = s.point(w.at(3));
    s.joint_or_bushing(kind, w.at(0), w.at(1), w.at(2), at,
                       kind != Kind::spherical
                           ? frame_along(vector_of(s, w.at(4)), vector_of(s, w.at(5)))
                           : no_turn,
                       s.optional(w.back()));
}

template <OuterEnd outer>
void link(Suspension& s, const Words& w) {
    s.link(w.at(0), w.at(1), w.at(2) == "steering" ? s.steering() : w.at(2), s.point(w.at(3)),
           w.at(4), s.point(w.at(5)), outer);
}

using Step = void (*)(Suspension&, const Words&);
const std::map<std::string_view, Step> steps{
    {"body", [](Suspension& s, const Words& w) { s.body(w.at(0), w.at(1)); }},
    {"body between",
     [](Suspension& s, const Words& w) {
         const double share = w.size() > 4 ? 0.25 : 0.5;
         s.body(w.at(0), (1 - share) * s.point(w.at(2)) + share * s.point(w.at(3)), w.at(1));
     }},
    {"spherical",
     [](Suspension& s, const Words& w) { s.spherical(w.at(0), w.at(1), w.at(2), w.at(3)); }},
    {"revolute",
     [](Suspension& s, const Words& w) {
         s.revolute(w.at(0), w.at(1), w.at(2), s.point(w.at(3)), vector_of(s, w.at(4)));
     }},
    {"cylindrical",
     [](Suspension& s, const Words& w) {
         const Vector3d axis = vector_of(s, w.at(4)).normalized();
         s.joint(w.at(0), "cylindrical", w.at(1), w.at(2), s.point(w.at(3)),
                 Fields{}.add("axis", direction(axis)));
     }},
    {"universal",
     [](Suspension& s, const Words& w) {
         s.universal(w.at(0), w.at(1), w.at(2), s.point(w.at(3)), vector_of(s, w.at(4)),
                     vector_of(s, w.at(5)));
     }},
    {"universal along",
     [](Suspension& s, const Words& w) {
         s.universal(w.at(0), w.at(1), w.at(2), s.point(w.at(3)),
                     frame_along(vector_of(s, w.at(4)), vector_of(s, w.at(5))));
     }},
    {"spherical or bushing", joint_or_bushing<Kind::spherical>},
    {"revolute or bushing", joint_or_bushing<Kind::revolute>},
    {"universal or bushing", joint_or_bushing<Kind::universal>},
    {"distance",
     [](Suspension& s, const Words& w) {
         s.distance(w.at(0), w.at(1), s.point(w.at(2)), w.at(3), s.point(w.at(4)));
     }},
    {"link", link<OuterEnd::spherical>},
    {"link universal", link<OuterEnd::universal>},
    {"arm", [](Suspension& s, const Words& w) { arm(s, w.at(0), w.at(1), w.at(2), w.at(3)); }},
    {"wishbone", [](Suspension& s, const Words& w) { wishbone(s, w.at(0), w.at(1)); }},
    {"tierod",
     [](Suspension& s, const Words& w) { s.tierod("Location Chassis", w.at(0), w.at(1)); }},
    {"springs", [](Suspension& s, const Words& w) { springs(s, w.at(0), w.at(1), w.at(2)); }},
    {"shock",
     [](Suspension& s, const Words& w) {
         s.tsda(s.on_side(w.at(0)), "ground", s.point(w.at(1) + "/Location Chassis"), "axle",
                s.point(w.at(1) + "/" + w.at(2)), s.at(w.at(1)));
     }},
    {"wheel", [](Suspension& s, const Words& w) { s.spindle(s.on_side(w.at(0))); }},
    {"one freedom",
     [](Suspension& s, const Words& w) {
         s.one_freedom = true;
         s.draft().notes.warn(s.place(w.at(0)), w.at(1));
     }},
    {"read", [](Suspension& s, const Words& w) { s.point(w.at(0)); }},
    {"knuckle", [](Suspension& s, const Words& w) { knuckle(s, w.at(0), w.at(1)); }},
    {"track rod", [](Suspension& s, const Words&) { track_rod(s); }},
    {"draglink", [](Suspension& s, const Words&) { draglink(s, OuterEnd::spherical); }},
    {"draglink universal", [](Suspension& s, const Words&) { draglink(s, OuterEnd::universal); }},
    {"bell crank", [](Suspension& s, const Words&) { bell_crank(s); }},
    {"triangle", [](Suspension& s, const Words&) { triangle(s); }},
    {"watt linkage", [](Suspension& s, const Words&) { watt_linkage(s); }},
    {"heave and roll", [](Suspension& s, const Words&) { heave_and_roll(s); }},
    {"guide across x", [](Suspension& s, const Words&) { guide_across_x(s); }},
    {"no portal", [](Suspension& s, const Words&) { no_portal(s); }},
    {"roll bar in halves", [](Suspension& s, const Words&) { roll_bar_in_halves(s); }},
    {"half leaf",
     [](Suspension& s, const Words& w) { half_leaf(s, w.at(0), w.at(1), w.at(2), w.at(3)); }},
    {"generic", [](Suspension& s, const Words&) { generic(s); }}};

void run(Suspension& s, std::span<const Value> list) {
    for (const Value& step : list) {
        const std::string& verb = step.items[0].text;
        const auto rest = std::span(step.items).subspan(1);
        if (verb == "mirrors") continue;
        if (verb == "both") {
            both(s, [&] { run(s, rest); });
        } else if (verb == "like") {
            run(s, entry(templates_section("groups"), rest[0].text)->items);
        } else if (verb == "if given") {
            if (s.has(rest[0].text)) run(s, rest.subspan(1));
        } else {
            Words words;
            for (const Value& word : rest) words.push_back(word.text);
            steps.at(verb)(s, words);
        }
    }
}

}  // namespace

Made make(Suspension& s) {
    const Cursor& root = s.file();
    const auto named = root.require("Template");
    const std::string name = named.text("a template");
    if (name == "RigidPinnedAxle" || name == "RigidSuspension")
        named.fail(
            fmt::format("{}: the template has no spring, so the wheel is not supported", name));
    const Value* found = entry(templates_section("templates"), name);
    if (found == nullptr)
        named.fail(
            fmt::format("{} is not a supported template{}", reader::quote(name),
                        reader::did_you_mean(name, templates_section("templates").keys, "known")));
    Draft& draft = s.draft();
    draft.title = root.optional("Name") ? root.require("Name").text("a name") : name;
    draft.format = "Chrono::Vehicle " + name;
    draft.units = "{length: m, angle: rad, force: N}";
    const auto& first = found->items[0].items;
    const bool mirrors = first[0].text == "mirrors";
    if (mirrors) draft.mirror = "left -> right";
    run(s, found->items);
    s.report_unread();
    return {mirrors, mirrors && first.size() > 1 ? first[1].text : ""};
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
