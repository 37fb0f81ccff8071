// What the parts of the .adm importer share while a dataset becomes a draft.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "models/import/adm/expression.hpp"
#include "models/import/adm/geometry.hpp"
#include "models/import/import.hpp"

namespace elastocheck::importer::adm {

// A joint that a MOTION or a COUPLER may speak of.
struct WrittenJoint {
    std::string kind;       // ADAMS': "REVOLUTE"
    std::size_t entry = 0;  // in Draft::joints
    int i = 0, j = 0;       // markers
};

// What moves or is held along an offset of a joint, counted from the design position [length of the scene, rad].
struct Drive {
    std::string quantity;  // "joints.crank"
    double start = 0, end = 0;
    bool moves() const { return start != end; }
};

struct Table {
    std::vector<double> x, y;
    bool goes_on = false;  // straight beyond its ends
    const Statement* statement = nullptr;
};

struct Conversion {
    const Dataset& data;
    const Geometry& geometry;
    const Options& options;
    Draft& draft;

    Names body_names = {}, joint_names = {}, element_names = {}, load_names = {};
    std::map<int, std::string> bodies = {};  // by part; ground is "ground"
    std::set<int> held = {};                 // parts that something holds
    std::map<int, WrittenJoint> joints = {};
    std::map<int, Table> splines = {};
    std::vector<Drive> drives = {};
    std::map<int, const Statement*> variables = {};
    double end_time = 0;          // of the programme that the file's functions of TIME run through
    int variables_left = 10'000;  // to be put into functions, over the whole file

    // ---- Looking up. Throw SceneError where there is none.
    const Marker& marker(const Arguments& at, std::string_view name) const;
    const Marker& marker(const Arguments& at, int id) const;
    bool is_ground(int part) const { return geometry.parts.at(part).is_ground; }
    const std::string& body(int part) const { return bodies.at(part); }
    std::string pair(int i, int j) {
        held.insert({i, j});
        return "[" + body(i) + ", " + body(j) + "]";
    }
    std::string point(const Marker& marker);
    std::string name(Names& names, const Statement& statement) const;
    bool is_flexible(const Marker& marker) const { return !geometry.parts.contains(marker.part); }

    // A function at a time, VARIABLEs put in. Numbers are the file's.
    Value function(const std::string& text, double time);
    Value function(const std::string& text) { return function(text, 0); }
};

// Whether it is worth converting: on parts that are there, and on two of them; else it is noted why not.
bool is_between_two(Conversion& c, const Statement& s, const Marker& I, const Marker& J, const Arguments& at);

void read_splines(Conversion& c);
void convert_joints(Conversion& c);  // JOINT, JPRIM, GCON, COUPLER, MOTION
void convert_forces(Conversion& c);  // BUSHING, FIELD, BEAM, SPRINGDAMPER, SFORCE, VFORCE, VTORQUE, GFORCE

}  // namespace elastocheck::importer::adm
