// State shared by the parts of the .adm importer.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "models/import/adm/expression.hpp"
#include "models/import/adm/geometry.hpp"
#include "models/import/import.hpp"

namespace elastocheck::importer::adm {

// A joint that a MOTION or a COUPLER may refer to.
struct WrittenJoint {
    std::string kind;       // as in ADAMS: "REVOLUTE"
    std::size_t entry = 0;  // in Draft::joints
    int i = 0, j = 0;       // markers
};

// A FUNCTION expression evaluated at Conversion::times.
struct TimeFunction {
    Value first;  // at time 0; unknown, with the reason, if it is unknown at any time
    // Value::constant at each of Conversion::times; one entry if it does not vary
    std::vector<double> path = {};
    double least = 0, most = 0;  // extrema of the constant, also between these times
    bool varies() const { return path.size() > 1; }
};

// A motion or load of the file that changes with time, which a branch drives or holds: the offset of a joint
// from the design position [length of the scene, rad], or the change of a load from its value at time 0.
struct Drive {
    enum class Kind { joint, force, moment } kind = Kind::joint;
    std::string quantity;           // "joints.crank", or the name of the load
    std::vector<double> path = {};  // at Conversion::times; one entry if it does not move
    double least = 0, most = 0;
    SourceLocation from = {};
    bool moves() const { return least != most; }
};

// A SPLINE.
struct Table {
    std::vector<double> x, y;
    bool extrapolates = false;  // linearly beyond its ends
};

// A damper between parts i and j, written only if other elements hold both parts.
struct DamperBetween {
    int i, j;
    Entry entry;
};

struct Conversion {
    const Dataset& data;
    const std::string& file;
    const Geometry& geometry;
    const Options& options;
    Draft& draft;

    Names body_names = {}, joint_names = {}, element_names = {}, load_names = {};
    std::map<int, std::string> bodies = {};  // by part; ground is "ground"
    std::set<int> held = {};                 // parts attached to a joint or element
    std::map<int, WrittenJoint> joints = {};
    std::map<int, Table> splines = {};
    std::vector<Drive> drives = {};
    std::vector<DamperBetween> dampers = {};
    std::map<int, const Statement*> variables = {};
    // from 0 to the end of the functions of TIME: their events, and fine steps between
    std::vector<double> times = {};
    bool has_events =
        false;  // times end at that of the last STEP or IF of TIME; else after one second
    int variables_left = 1'000'000;  // substitutions of VARIABLEs that the file may still use
    double characters_left = 2e8;    // characters of functions of TIME that may still be evaluated
    std::map<int, std::optional<std::string>> variable_functions = {};  // by id; none: user-written

    // ---- Look-up functions; throw SceneError for an undefined reference.
    const Marker& marker(const Statement& s, std::string_view argument) const;
    const Marker& marker(const Statement& s, int id) const;
    bool is_ground(int part) const { return geometry.parts.at(part).is_ground; }
    const std::string& body(int part) const { return bodies.at(part); }
    // "[BODY_I, BODY_J]"; both parts count as held.
    std::string pair(int i, int j) {
        held.insert({i, j});
        return "[" + body(i) + ", " + body(j) + "]";
    }
    std::string point(const Marker& marker);
    std::string origin(int part);  // hardpoint at the centre of mass, or at the part's origin
    std::string name(Names& names, const Statement& s) const;
    bool is_flexible(const Marker& marker) const { return !geometry.parts.contains(marker.part); }
    // Whether both parts exist and differ; else notes why the statement is not converted.
    bool is_between_two(const Statement& s, const Marker& I, const Marker& J);

    // ---- Notes on a statement (draft.hpp): converted, converted inexactly, not representable, without effect.
    void count(const std::string& kind) { draft.notes.count(kind); }
    template <class... A>
    void warn(const Statement& s, fmt::format_string<A...> what, A&&... a) {
        draft.notes.warn(s.place(), fmt::format(what, std::forward<A>(a)...));
    }
    void miss(const Statement& s, const std::string& why) { draft.notes.miss(s.place(), why); }
    template <class... A>
    void miss(const Statement& s, fmt::format_string<A...> why, A&&... a) {
        miss(s, fmt::format(why, std::forward<A>(a)...));
    }
    void leave_out(const Statement& s, const std::string& why) {
        draft.notes.leave_out(why, s.place());
    }
    // A part of the statement, "damping".
    void leave_out(const Statement& s, const std::string& part, const std::string& why) {
        draft.notes.leave_out(why, {s.line, part + " of " + s.place().what});
    }

    // Value of a function at a time, with VARIABLEs substituted, in units of the file; `events` as in Context.
    Value function(const std::string& text, double time = 0, std::vector<double>* events = nullptr);
    TimeFunction time_function(const std::string& text);
};

// AZ(I, J): the angle of I relative to J about z of J [rad].
double angle_about_z(const Marker& I, const Marker& J);

void read_splines(Conversion& c);
void convert_joints(Conversion& c);  // JOINT, JPRIM, GCON, COUPLER, MOTION
// BUSHING, FIELD, BEAM, SPRINGDAMPER, SFORCE, VFORCE, VTORQUE, GFORCE
void convert_forces(Conversion& c);

}  // namespace elastocheck::importer::adm
