// Imports Chrono::Vehicle suspension templates: runs the steps that templates.yaml lists for each.
// Chassis and subchassis are ground, and so is the steering of a suspension without its vehicle.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <numbers>
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

const Matrix3d no_rotation = Matrix3d::Identity();

void for_both_sides(Suspension& s, const std::function<void()>& make) {
    for (const int side : {+1, -1}) {
        s.side = side;
        make();
    }
    s.side = +1;
}

using Words = std::vector<std::string>;

// Half of a leaf spring (SAE), from its clamp to its far end: torsion springs about z and y at the clamp,
// of the rates k |arm|² for the rates k of the end. The stiffness is shared 1 : bias between front and
// rear half, the preload equally.
// Words: body of the clamp, body of the leaf, clamp point, end point.
void half_leaf(Suspension& s, const Words& words) {
    const std::string &name = words.at(0), &half = words.at(1), &clamp = words.at(2),
                      &end = words.at(3), in = "Leafspring/";
    const FilePoint p = s.point(in + clamp);
    const Vector3d arm = p - s.point(in + end);
    const double bias = s.real(in + "Stiffness Bias"), share = half == "front_leaf*" ? 1 : bias,
                 preload = s.real(in + "Vertical Preload Force"),
                 vertical = s.real(in + "Vertical Stiffness") / (1 + bias),
                 lateral = s.real(in + "Lateral Stiffness") / (1 + bias),
                 square = arm.squaredNorm();
    s.joint_or_bushing("revolute", {name + ".yaw*", name + "*", "axle"}, p, no_rotation,
                       s.optional(in + "Clamp Bushing Data"));
    s.torsion({name + ".lateral*", name + "*", "axle"}, p, Vector3d::UnitZ(),
              share * lateral * square);
    s.joint_or_bushing("revolute", {name + ".pitch*", name + "*", half}, p,
                       frame_along(-Vector3d::UnitY(), Vector3d::UnitZ()),
                       s.optional(in + "Leafspring Bushing Data"));
    // The end pushes the chassis up with half the preload: the moment about y is that of arm × force.
    s.torsion({name + ".vertical*", name + "*", half}, p, Vector3d::UnitY(),
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
    std::string result = name;
    for (char& c : result)
        if (std::string_view(" /*").find(c) != std::string::npos) c = '_';
    return result;
}

struct ChronoJoint {
    std::string_view name, capitals;
    const char* type = nullptr;   // in a scene; null: Chrono's reader treats it as a lock
    bool may_be_bushing = false;  // with "Bushing Data"
    int axis = -1;                // of its frame, the direction of the scene's joint; -1: none
};
constexpr ChronoJoint chrono_joints[] = {
    {"Revolute", "REVOLUTE", "revolute", true},
    {"Spherical", "SPHERICAL", "spherical", true},
    {"Universal", "UNIVERSAL", "universal", true},
    {"Lock", "LOCK", "fixed"},
    {"Point Line", "POINTLINE", "in_line", false, 0},
    {"Point Plane", "POINTPLANE", "in_plane", false, 2},
    {"Prismatic", "PRISMATIC"},
    {"Cylindrical", "CYLINDRICAL"},
};

struct Generic {
    Suspension& s;
    std::set<std::string> sided = {}, shared = {};  // bodies with and without a mirror image

    std::string body(const Cursor& cursor) const {
        std::string name;
        int side = s.side;
        if (cursor.is_list()) {
            const auto pair = cursor.list(2, "words, a body and its side");
            name = pair[0].text("a body");
            side = pair[1].one_of("a side", {"Left", "Right"}) == 0 ? 1 : -1;
        } else {
            name = cursor.text("a body");
        }
        if (name == "Steering") return "steering link";
        if (name == "Chassis" || name == "Subchassis") return "ground";
        if (sided.contains(name)) return scene_name(name) + (side > 0 ? "_left" : "_right");
        if (shared.contains(name)) return scene_name(name);
        std::vector<std::string> known{"Chassis", "Subchassis", "Steering"};
        known.insert(known.end(), sided.begin(), sided.end());
        known.insert(known.end(), shared.begin(), shared.end());
        cursor.fail(fmt::format("{} is not a body of this suspension{}", cursor.found(),
                                reader::did_you_mean(name, known, "there are")));
    }

    static bool is_mirrored(const Cursor& entry) {
        const auto field = entry.optional("Mirrored");
        return field && field->yes_or_no();
    }

    // An entry of a section, on one side.
    struct Part {
        const Generic& all;
        const Cursor& entry;
        std::string name;
        SourceLocation from;

        Vector3d vector_at(const char* key) const {
            return all.s.mirrored(vector(entry.require(key)));
        }
        FilePoint at(const char* key) const { return {vector_at(key), from}; }
        std::string body1() const { return all.body(entry.require("Body1")); }
        std::string body2() const { return all.body(entry.require("Body2")); }
    };
    // Calls `make` for each entry of a section and for each of its sides.
    void each(const char* section, const std::function<void(const Part&)>& make) const {
        if (!s.has(section)) return;
        for (const Cursor& entry : s.at(section).items()) {
            const std::string name = scene_name(entry.require("Name").text("a name"));
            const auto make_part = [&](const std::string& part_name) {
                make({*this,
                      entry,
                      part_name,
                      {entry.value->line, fmt::format("{}/{}", section, part_name)}});
            };
            if (is_mirrored(entry))
                for_both_sides(s, [&] { make_part(name + s.on_side("*")); });
            else
                make_part(name);
        }
    }

    void add_body(const Part& part) const {
        Fields fields;
        fields.add("origin", s.hardpoint(part.name + ".cm", part.at("Position")));
        if (const auto mass = part.entry.optional("Mass")) fields.add("mass", mass->number());
        if (const auto turned = part.entry.optional("Rotation"))
            s.leave_out(*turned, "axes of the inertia, without effect at rest");
        s.draft().bodies.push_back({part.name, fields.braced(), part.from});
        s.draft().notes.count("body");
    }

    void add_joint(const Part& part) const {
        const Cursor type = part.entry.require("Type");
        const std::string name = type.text("a type of joint"), i = part.body1(), j = part.body2();
        const FilePoint position = part.at("Position");
        const auto rotated = part.entry.optional("Rotation"),
                   data = part.entry.optional("Bushing Data");
        const Matrix3d A = rotated ? rotation_on_side(s, *rotated) : no_rotation;
        const auto kind = std::ranges::find_if(chrono_joints, [&](const ChronoJoint& joint) {
            return name == joint.name || name == joint.capitals;
        });
        if (kind == std::end(chrono_joints))
            type.fail(fmt::format("{} is not a supported joint of Chrono", type.found()));
        if (!kind->type)
            type.fail(
                "Chrono reads this as a lock, probably not intended; write Lock, or change the "
                "joint");
        if (kind->may_be_bushing)
            return s.joint_or_bushing(kind->type, {part.name, i, j}, position, A, data);
        const bool is_lock = kind->name == "Lock";
        if (data) {
            s.ignore(*data, is_lock ? "a bushing instead of a lock"
                                    : "Chrono ignores the bushing of this joint; the scene has the "
                                      "joint");
            if (is_lock) s.draft().notes.miss(part.from, "a bushing instead of a lock");
        }
        std::vector<Vector3d> along;
        if (kind->axis >= 0) along = {A.col(kind->axis)};
        s.joint(kind->type, {part.name, i, j}, position, along);
    }
};

void generic(Suspension& s) {
    Generic g{s};
    if (s.has("Bodies"))
        for (const Cursor& entry : s.at("Bodies").items())
            (Generic::is_mirrored(entry) ? g.sided : g.shared)
                .insert(entry.require("Name").text("a name"));
    g.each("Bodies", [&](const auto& part) { g.add_body(part); });
    g.each("Joints", [&](const auto& part) { g.add_joint(part); });
    g.each("Distance Constraints", [&](const auto& part) {
        s.distance(part.name, part.body1(), part.at("Point1"), part.body2(), part.at("Point2"));
    });
    g.each("TSDAs", [&](const auto& part) {
        s.tsda(part.name, part.body1(), part.at("Point1"), part.body2(), part.at("Point2"),
               part.entry);
    });
    g.each("RSDAs", [&](const auto& part) {
        s.rsda(part.name, part.body1(), part.body2(), part.vector_at("Position"),
               part.vector_at("Axis").normalized(), part.entry);
    });
    for_both_sides(s, [&] { s.spindle(g.body(s.at("Spindle/Attachment Body"))); });
}

// ---- Steps of a template, by their names in templates.yaml.

// [JOINT, NAME, BODY, BODY, POINT, VECTOR..., held]; "JOINT along": with the axes x and y of a frame from two
// vectors; "JOINT or bushing": the last word is the field of a bushing that replaces the joint if given.
void joint_step(Suspension& s, const std::string& verb, const Words& w) {
    const std::string type = verb.substr(0, verb.find(' '));
    const FilePoint place = s.point(w.at(3));
    std::vector<Vector3d> along;
    const bool may_be_bushing = verb.ends_with(" or bushing"), held = w.back() == "held",
               has_frame = verb.ends_with(" along");
    for (std::size_t k = 4; k + (may_be_bushing || held ? 1 : 0) < w.size(); ++k)
        along.push_back(s.vector_of(w[k]));
    const Matrix3d frame = along.size() == 2 && (has_frame || may_be_bushing)
                               ? frame_along(along[0], along[1])
                               : no_rotation;
    if (has_frame) along = {frame.col(0), frame.col(1)};
    if (may_be_bushing)
        s.joint_or_bushing(type, {w[0], w[1], w[2]}, place, frame, s.optional(w.back()));
    else
        s.joint(type, {w[0], w[1], w[2]}, place, along, held);
}

// Warns if two vectors are not perpendicular.
void expect_across(Suspension& s, const Words& w) {
    const Vector3d a = s.vector_of(w.at(1)), b = s.vector_of(w.at(2));
    if (!(std::abs(a.normalized().dot(b)) <= 1e-6 * b.norm()))
        s.draft().notes.warn(s.place(w[0]), w.at(3));
}

using Step = void (*)(Suspension&, const Words&);
const std::map<std::string_view, Step> steps{
    {"body",
     [](Suspension& s, const Words& w) {
         s.body(w.at(0), w.at(1), s.point(w.size() > 2 ? w[2] : w[1] + "/COM"),
                w.size() > 3 ? w[3] : "Mass");
     }},
    {"point", [](Suspension& s, const Words& w) { s.hardpoint(w.at(0), s.point(w.at(1))); }},
    {"distance",
     [](Suspension& s, const Words& w) {
         s.distance(w.at(0), w.at(1), s.point(w.at(2)), w.at(3), s.point(w.at(4)));
     }},
    {"spring",
     [](Suspension& s, const Words& w) {
         s.tsda(w.at(0), "ground", s.point(w.at(1) + "/Location Chassis"), w.at(3),
                s.point(w[1] + "/" + w.at(2)), s.at(w[1]));
     }},
    {"torsion spring",
     [](Suspension& s, const Words& w) {
         FilePoint at = s.point(w.at(3));
         at.from = s.place(w.at(5));
         s.torsion({w.at(0), w.at(1), w.at(2)}, at, s.vector_of(w.at(4)), s.real(w.at(5)));
     }},
    {"wheel", [](Suspension& s, const Words& w) { s.spindle(w.at(0)); }},
    {"one freedom",
     [](Suspension& s, const Words& w) {
         s.one_freedom = true;
         s.draft().notes.warn(s.place(w.at(0)), w.at(1));
     }},
    {"bar on", [](Suspension& s, const Words& w) { s.antiroll_body = w.at(0); }},
    {"steers",
     [](Suspension& s, const Words& w) {
         s.steering_joint = w.at(0);
         s.steering_range = s.positive(w.at(1)) * std::numbers::pi / 180;
         if (w.size() > 2) s.steering_range *= s.positive(w[2]);
     }},
    {"read", [](Suspension& s, const Words& w) { s.point(w.at(0)); }},
    {"above zero", [](Suspension& s, const Words& w) { (void)s.positive(w.at(0)); }},
    {"not zero",
     [](Suspension& s, const Words& w) {
         if (s.real(w.at(0)) == 0) s.at(w[0]).fail(w.at(1));
     }},
    {"expect zero",
     [](Suspension& s, const Words& w) {
         if (const auto x = s.optional(w.at(0)); x && x->number() != 0)
             s.draft().notes.miss(s.place(w[0]), w.at(1));
     }},
    {"expect across", expect_across},
    {"leave out",
     [](Suspension& s, const Words& w) {
         if (const auto field = s.optional(w.at(0))) s.leave_out(*field, w.at(1));
     }},
    {"not used", [](Suspension& s, const Words& w) { s.ignore(s.optional(w.at(0)), w.at(1)); }},
    {"half leaf", half_leaf},
    {"generic", [](Suspension& s, const Words&) { generic(s); }}};

// `given` replaces $1, $2, ... of a group.
void run(Suspension& s, std::span<const Value> list, const Words& given) {
    for (const Value& step : list) {
        const std::string& verb = step.items[0].text;
        const auto rest = std::span(step.items).subspan(1);
        Words words;
        for (const Value& word : rest) {
            words.push_back(word.text);
            for (std::size_t k = 0; k < given.size(); ++k)
                words.back() = replaced(words.back(), fmt::format("${}", k + 1), given[k]);
        }
        if (verb == "both") {
            for_both_sides(s, [&] { run(s, rest, given); });
        } else if (verb == "like") {
            run(s, entry(templates_section("groups"), words[0])->items,
                {words.begin() + 1, words.end()});
        } else if (verb == "if given" || verb == "unless given") {
            const bool has_all = std::ranges::all_of(
                split(words[0], "; "), [&](const std::string& field) { return s.has(field); });
            if (has_all == (verb == "if given")) run(s, rest.subspan(1), given);
        } else if (const auto found = steps.find(verb); found != steps.end()) {
            found->second(s, words);
        } else {
            joint_step(s, verb, words);
        }
    }
}

}  // namespace

bool run_template(Suspension& s, std::string_view section) {
    const Value* found =
        entry(templates_section(section), s.file().require("Template").text("a template"));
    if (!found) return false;
    run(s, found->items, {});
    s.report_unread();
    return true;
}

bool make(Suspension& s) {
    const auto named = s.file().require("Template");
    const std::string name = named.text("a template");
    const bool mirrors = entry(templates_section("mirrored"), name);
    Draft& draft = s.draft();
    draft.title = s.file().optional("Name") ? s.file().require("Name").text("a name") : name;
    draft.format = "Chrono::Vehicle " + name;
    draft.units = "{length: m, angle: rad, force: N}";
    if (mirrors) draft.mirror = "left -> right";
    if (mirrors || entry(templates_section("templates"), name)) {
        run_template(s, mirrors ? "mirrored" : "templates");
        return mirrors;
    }
    if (const Value* why = entry(templates_section("refused"), name))
        named.fail(fmt::format("{}: {}", name, why->text));
    std::vector<std::string> known = templates_section("mirrored").keys;
    const auto& others = templates_section("templates").keys;
    known.insert(known.end(), others.begin(), others.end());
    named.fail(fmt::format("{} is not a supported template{}", reader::quote(name),
                           reader::did_you_mean(name, known, "known")));
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
    const bool mirrors = make(suspension);
    add_travel(suspension, !mirrors, draft);
    return draft;
}

}  // namespace elastocheck::importer
