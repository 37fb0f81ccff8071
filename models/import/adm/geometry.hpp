// Reads parts and markers of an ADAMS dataset, their poses, and the units.
//
// Lengths and forces are converted to the units of the scene, which are the file's if a scene allows them: m or
// mm, N or kN. The four units of a dataset need not be coherent (kN, kg, m): each quantity has its own factor.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <string>

#include "models/import/adm/statements.hpp"

namespace elastocheck::importer::adm {

// Three numbers of a statement; zeros if there are none.
Eigen::Vector3d vector(const Statement& s, std::string_view argument);

struct Units {
    double length = 1;  // scene units per unit of the file
    double force = 1;
    double mass = 1;          // [kg]
    double metre = 1;         // metres per length unit of the file
    double second = 1;        // seconds per time unit of the file
    std::string length_name;  // of the scene: "mm"
    std::string force_name;
    std::string remark;
};

struct Frame {
    Eigen::Vector3d r = Eigen::Vector3d::Zero();      // [length of the scene]
    Eigen::Matrix3d A = Eigen::Matrix3d::Identity();  // its axes as columns
};
// b, given in the axes of a, in the axes in which a is given.
Frame composed(const Frame& a, const Frame& b_in_a);

struct Part {
    const Statement* statement = nullptr;
    bool is_ground = false;
    Frame pose;
    double mass = 0;  // [kg]
    int cm = 0;       // a marker, or 0
};

struct Marker {
    const Statement* statement = nullptr;
    int part = 0;
    bool floats = false;  // FLOATING: without a position
    Frame pose;           // in the axes of ground

    Eigen::Vector3d axis(int k) const { return pose.A.col(k); }
};

struct Geometry {
    Units units;
    std::map<int, Part> parts;
    std::map<int, Marker> markers;
    double size = 1;  // diagonal of the bounding box of all markers [length of the scene]
};

// Throws SceneError for missing, duplicate or circular definitions.
Geometry read_geometry(const Dataset& data, const std::string& file);

}  // namespace elastocheck::importer::adm
