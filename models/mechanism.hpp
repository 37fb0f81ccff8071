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
    double offset = 0;  // of the plane from j along its normal [m]
};                      // i stays in the plane
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

// i stays in the plane of x_j = j and y_j at this angle from x_j towards y_j, when it is in that plane
// already: the drive of a revolute or cylindrical joint, never a joint by itself.
struct Angle {
    Direction i;
    Direction j, y_j;  // perpendicular
    double angle = 0;  // [rad]
};

using JointKind = std::variant<Spherical, Revolute, Universal, Cylindrical, Translational, Planar, Fixed,
                               Distance, InPlane, InLine, Perpendicular, Parallel, Angle>;
struct Joint {
    std::string name;
    JointKind kind;
    bool only_where_driven = false;  // a jack: stands only on the branches that drive it
};

// ---- Elastic elements: geometry times law. The geometry says what deforms, the law what energy that costs;
// every force follows from the energy.

// Laws of one deformation x, and of six, e.
struct LinearRate {
    double k = 0;  // [N/m] ≥ 0
};                 // u(x) = ½ k x²
struct LinearStiffness {
    Matrix6 K = Matrix6::Zero();  // symmetric, positive semidefinite, [N/m  N; N  N·m/rad]
};                                // u(e) = ½ eᵀ K e;  K = diag(K_T', K_R') is eqs. (8)-(9)

using ScalarLaw = std::variant<LinearRate>;
using SpatialLaw = std::variant<LinearStiffness>;

// Two points:  U = u(ℓ - ℓ₀),  ℓ = |p_j - p_i|
struct AxialSpring {
    Point i, j;
    ScalarLaw law;
    double free_length = 0;  // ℓ₀ [m]
};

// Two markers:  U = u(e) + preloadᵀ e,  e = (d, θ),  d = A_iᵀ (p_j - p_i),  θ = log(A_iᵀ A_j)
// with p, A the positions and axes of the two markers. The frame rides on marker i, as in eqs. (10)-(11).
// `preload` is (force [N], moment [N·m]) in marker axes at e = 0, positive where it pulls j back against +e,
// as ∂u/∂e does.
struct Bushing {
    Marker i, j;
    SpatialLaw law;
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
    Eigen::Vector3d f = Eigen::Vector3d::Zero();  // [N], or [-] where a driver multiplies it by newtons
};
struct DeadMoment {
    BodyId body = ground;
    Eigen::Vector3d m = Eigen::Vector3d::Zero();  // [N·m]; [m] or [-] where a driver multiplies it
};
using LoadKind = std::variant<DeadForce, DeadMoment>;
struct Load {
    std::string name;
    LoadKind kind;
};

}  // namespace elastocheck
