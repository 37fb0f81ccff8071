// What a suspension is made of, as plain data: bodies, joints, elastic elements, loads.
//
// Everything here is SI (m, N, rad) and ISO 8855 (x forward, y left, z up). A name ending in _local is in the
// axes of its body; no suffix means ground axes. There is no mechanics in models/, not even r + A s: each leg
// writes its own.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <variant>

namespace elastocheck {

using BodyId = int;  // position in Scene::bodies or Model::bodies
inline constexpr BodyId ground = -1;

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

struct Pose {
    Eigen::Vector3d r = Eigen::Vector3d::Zero();            // origin of the body [m]
    Eigen::Quaterniond p = Eigen::Quaterniond::Identity();  // body axes to ground axes, unit
};

struct Body {
    std::string name;
    Pose design;
};

struct Point {
    BodyId body = ground;
    Eigen::Vector3d s_local = Eigen::Vector3d::Zero();  // from the body's origin [m]
};

struct Direction {
    BodyId body = ground;
    Eigen::Vector3d u_local = Eigen::Vector3d::UnitZ();  // unit
};

struct Marker {
    BodyId body = ground;
    Eigen::Vector3d s_local = Eigen::Vector3d::Zero();            // from the body's origin [m]
    Eigen::Quaterniond A_local = Eigen::Quaterniond::Identity();  // marker axes to body axes
};

// ---- Joints, under their usual names. `i` is the first body,
// `j` the second. lowering.hpp says what each is made of.

struct Spherical {
    Point i, j;
};
struct Revolute {
    Point i, j;
    Direction axis_i, axis_j;
};
struct Universal {
    Point i, j;
    Direction axis_i, axis_j;
};  // the two axes of the cross, perpendicular
struct Cylindrical {
    Point i, j;
    Direction axis_i, axis_j;
};
struct Translational {
    Point i, j;
    Direction axis_i, axis_j;
};
struct Planar {
    Point i, j;
    Direction normal_i, normal_j;
};
struct Fixed {
    Point i, j;
    Direction x_i, y_i, x_j, y_j;
};  // x, y: the same two perpendicular directions on each
struct Distance {
    Point i, j;
    double length = 0;
};  // [m] > 0
struct InPlane {
    Point i, j;
    Direction normal_j;
};  // i stays in the plane through j
struct InLine {
    Point i, j;
    Direction axis_j;
};  // i stays on the line through j
struct Perpendicular {
    Direction i, j;
};
struct Parallel {
    Direction i, j;
};

using JointKind = std::variant<Spherical, Revolute, Universal, Cylindrical, Translational, Planar, Fixed,
                               Distance, InPlane, InLine, Perpendicular, Parallel>;
struct Joint {
    std::string name;
    JointKind kind;
};

// ---- Elastic elements. The potential energy is the law; every force follows from it.

// U = ½ k (ℓ - ℓ₀)²,  ℓ = |p_j - p_i|
struct AxialSpring {
    Point i, j;
    double k = 0;            // [N/m] ≥ 0
    double free_length = 0;  // ℓ₀ [m]
};

// U = ½ eᵀ K e + preloadᵀ e,  e = (d, θ),  d = A_iᵀ (p_j - p_i),  θ = log(A_iᵀ A_j)
// with p, A the positions and axes of the two markers. The frame rides on marker i, as in eqs. (10)-(11).
// K is symmetric, [N/m  N; N  N·m/rad]; K = diag(K_T', K_R') is eqs. (8)-(9). `preload` is (force [N], moment
// [N·m]) in marker axes at e = 0, positive where it pulls j back against +e, as K e does.
struct Bushing {
    Marker i, j;
    Matrix6 K = Matrix6::Zero();
    Vector6 preload = Vector6::Zero();
};

using ElasticKind = std::variant<AxialSpring, Bushing>;
struct Elastic {
    std::string name;
    ElasticKind kind;
};

// ---- Dead loads: they keep their direction in ground axes while their point of application moves.

struct DeadForce {
    Point at;
    Eigen::Vector3d f = Eigen::Vector3d::Zero();  // [N], or [-] when it is the direction of a branch
};
struct DeadMoment {
    BodyId body = ground;
    Eigen::Vector3d m = Eigen::Vector3d::Zero();  // [N·m], or [m] when it is the direction of a branch
};
using LoadKind = std::variant<DeadForce, DeadMoment>;
struct Load {
    std::string name;
    LoadKind kind;
};

}  // namespace elastocheck
