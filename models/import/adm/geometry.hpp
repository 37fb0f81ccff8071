// Parts and markers of a dataset, where they stand, and in what units.
//
// Lengths and forces come out in those of the scene, which are the file's where a scene has them: m or mm, N or kN. The
// four units of a dataset need not be coherent (kN, kg, m): each quantity is converted by its own.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "models/import/adm/statements.hpp"

namespace elastocheck::importer::adm {

struct Units {
    double length = 1;  // of the scene's unit, for one of the file's
    double force = 1;
    double mass = 1;          // [kg]
    double metre = 1;         // for one of the file's lengths
    double second = 1;        // for one of the file's times
    std::string length_name;  // of the scene: "mm"
    std::string force_name;
    std::string remark;
};

struct Frame {
    Eigen::Vector3d r = Eigen::Vector3d::Zero();      // [length of the scene]
    Eigen::Matrix3d A = Eigen::Matrix3d::Identity();  // its axes as columns
};
// a, b in the axes of a
Frame placed(const Frame& a, const Frame& b_in_a);

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
    bool floats = false;
    Frame pose;  // in the axes of ground
};

struct Geometry {
    Units units;
    std::map<int, Part> parts;
    std::map<int, Marker> markers;
    double size = 1;  // of the box around all markers
};

// Throws SceneError for what is missing, twice there, or refers to itself.
Geometry read_geometry(const Dataset& data);

}  // namespace elastocheck::importer::adm
