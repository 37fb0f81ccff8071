// Plain data of a suspension mechanism: bodies, joints, elastic elements, loads.
//
// Units are SI (m, N, rad, and products of these), axes ISO 8855 (x forward, y left, z up). A name ending in
// _local is in body axes; no suffix means ground axes. models/ contains no mechanics, not even r + A s:
// each leg has its own.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <variant>
#include <vector>

namespace elastocheck {

// ---- Bodies and what is fixed in them.

using BodyId = int;  // position in Scene::bodies or Model::bodies
inline constexpr BodyId ground = -1;

using Vector3 = Eigen::Matrix<double, 3, 1>;
using Matrix3 = Eigen::Matrix<double, 3, 3>;
using Quaternion = Eigen::Quaternion<double>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

struct Pose {
    Vector3 r = Vector3::Zero();            // origin of the body [m]
    Quaternion p = Quaternion::Identity();  // body axes to ground axes, unit
};

struct Body {
    std::string name;
    Pose design;
};

struct Point {
    BodyId body = ground;
    Vector3 s_local = Vector3::Zero();  // from the body's origin [m]
};

struct Direction {
    BodyId body = ground;
    Vector3 u_local = Vector3::UnitZ();  // unit
};

struct Marker {
    BodyId body = ground;
    Vector3 s_local = Vector3::Zero();            // from the body's origin [m]
    Quaternion A_local = Quaternion::Identity();  // marker axes to body axes
};

// ---- Joints, under their usual names. `i` is the first body, `j` the second. lowering.hpp lists
// their constraints.

struct Spherical {
    Point i, j;
};
struct Revolute {
    Point i, j;
    Direction axis_i, axis_j;
};
// The axes of the cross, perpendicular.
struct Universal {
    Point i, j;
    Direction axis_i, axis_j;
};
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
// x, y: the same two perpendicular directions on each body.
struct Fixed {
    Point i, j;
    Direction x_i, y_i, x_j, y_j;
};
struct Distance {
    Point i, j;
    double length = 0;  // [m] > 0
};
// i stays in the plane at `offset` from j.
struct InPlane {
    Point i, j;
    Direction normal_j;
    double offset = 0;  // of the plane from j along its normal [m]
};
// i stays on the line through j.
struct InLine {
    Point i, j;
    Direction axis_j;
};
struct Perpendicular {
    Direction i, j;
};
struct Parallel {
    Direction i, j;
};

// Direction i is at this angle from x_j = j towards y_j, if it is in their plane: the drive of a revolute or
// cylindrical joint, which keeps it there; never a joint by itself.
struct Angle {
    Direction i;
    Direction j, y_j;  // perpendicular
    double angle = 0;  // [rad]
};

using JointKind = std::variant<Spherical, Revolute, Universal, Cylindrical, Translational, Planar,
                               Fixed, Distance, InPlane, InLine, Perpendicular, Parallel, Angle>;
struct Joint {
    std::string name;
    JointKind kind;
    bool active_only_where_driven = false;  // a jack: active only on the branches that drive it
};

// ---- Elastic elements: geometry times law. The geometry defines the deformation, the law its
// energy; all forces follow from the energy.

// Laws of one deformation x.

// u(x) = ½ k x²
struct LinearRate {
    double k = 0;  // [N/m] or [N·m/rad] ≥ 0
};

// Force over a deformation, a piecewise cubic polynomial:
//
//   f(x) = Σ c_kn (x - x_k)ⁿ, n = 0 ... 3,  on the pieces  x < x_0 | x_0 ≤ x < x_1 | ... | x ≥ x_K
//   u(x) = ∫₀ˣ f
//
// The pieces before the first and behind the last knot are linear and unbounded. f is continuous.
// Its slope is continuous for a smooth interpolant; it jumps at the rows of a piecewise linear
// table and where a stop closes.
struct Curve {
    std::vector<double> knots;  // x_0 < x_1 < ... < x_K, at least one [m] or [rad]
    // c [N, N/m, ...] of the piece before the first knot, about it, then of the piece behind each
    // knot, about that knot
    std::vector<std::array<double, 4>> pieces;
    bool known_outside = true;  // false: undefined beyond the end knots, and a branch ends there
};
using ScalarLaw = std::variant<LinearRate, Curve>;

// Laws of six deformations e = (d, θ).

// u(e) = ½ eᵀ K e;  K = diag(K_T', K_R') is eqs. (8)-(9)
struct LinearStiffness {
    Matrix6 K = Matrix6::Zero();  // symmetric, positive semidefinite, [N/m  N; N  N·m/rad]
};
// u(e) = Σ u_k(e_k), x y z of d, x y z of θ
struct PerAxis {
    std::array<ScalarLaw, 6> axis;
};
using SpatialLaw = std::variant<LinearStiffness, PerAxis>;

// Two points:  U = u(ℓ - ℓ₀),  ℓ = |p_j - p_i|
struct AxialSpring {
    Point i, j;
    ScalarLaw law;
    double free_length = 0;  // ℓ₀ [m]
};

// Deformation measure of a bushing and the direction of its forces. Programs differ here and all choices are
// valid. The default is eqs. (10)-(11) as an energy. B = A_iᵀ A_j is the rotation from marker axes i to j.
struct Formulation {
    // The axes A_f of d:  on_i: A_i   middle: A_i B^½   on_j: A_j. A frame on j equals a frame on i
    // of the same bushing with its markers swapped and the signs of its deformations reversed:
    // compile() does that, so that no leg sees it.
    enum class Frame { on_i, on_j, middle } frame = Frame::on_i;
    // The three angles θ of B:
    //   rotation_vector  log(B)
    //   cardan           B = R_x(θ_x) R_y(θ_y) R_z(θ_z)
    //   projected        θ_x = atan2(-B_12, B_22)   θ_y = atan2(B_02, B_22)
    //                    θ_z = atan2(B_10, B_00), indices from 0: each axis of j projected along an
    //                    axis of i, the small angles of a commercial code
    enum class Angles { rotation_vector, cardan, projected } angles = Angles::rotation_vector;
    // true:  forces and moments are conjugate to (d, θ): -∂U/∂q. They have an energy.
    // false: (F', M') = ∂u/∂e + preload along the axes A_f: F = A_f F', M = A_f M', F acting at p_j
    //        on both bodies. In general no energy. Not defined with the frame in the middle.
    bool conjugate = true;
    // false: F acts on each body at its own marker. The moment D × F of the offset between the
    // points is left out, and in the middle also its part on j: M = A_i (∂θ/∂φ)ᵀ M' alone, φ the
    // rotation of j relative to i. No energy.
    bool offset_moment = true;

    friend bool operator==(const Formulation&, const Formulation&) = default;
};
constexpr bool has_energy(const Formulation& f) { return f.conjugate && f.offset_moment; }

// Two markers:  U = u(e - e₀) + preloadᵀ e,  e = (d, θ),  d = A_fᵀ (p_j - p_i),  θ = log(A_iᵀ A_j)
// with p, A the positions and axes of the two markers. By default A_f = A_i, the frame is fixed in
// marker i as in eqs. (10)-(11), and θ is the rotation vector; see Formulation. `preload` is (force
// [N], moment [N·m]) in marker axes at e = e₀, positive where it pulls j back against +e, as ∂u/∂e
// does. `undeformed` is e₀ [m, rad], where the law has zero force.
//
// A torsion spring is a bushing that resists only θ_z; a tyre is one to ground that only pushes along z (the
// road moves its undeformed d_z); a segment of a beam is one at half its length with its frame in the
// middle (models/reader/definitions/beams.hpp).
struct Bushing {
    Marker i, j;
    SpatialLaw law;
    Vector6 preload = Vector6::Zero();
    Vector6 undeformed = Vector6::Zero();
    Formulation formulation = {};
};

using ElasticKind = std::variant<AxialSpring, Bushing>;

// Kind of element in the file, for output names and drawings; the legs do not read it.
enum class WrittenAs { itself, stop, torsion_spring, beam, tyre };  // itself: a spring or bushing

struct Elastic {
    std::string name;
    ElasticKind kind;
    bool active_only_where_driven = false;  // a tyre: active only on the branches that drive it
    WrittenAs written_as = WrittenAs::itself;
    // compile() swapped the markers, since the frame was on j: deformations and forces have changed sign
    bool markers_swapped = false;
};

// ---- Loads. Dead loads keep their direction in ground axes while their point of application
// moves. Followers rotate with their body and have no potential.

struct DeadForce {
    Point at;
    Vector3 f = Vector3::Zero();  // [N]; [-] if a driver multiplies it by newtons
};
struct DeadMoment {
    BodyId body = ground;
    Vector3 m = Vector3::Zero();  // [N·m]; [m] or [-] where a driver multiplies it
};
struct FollowerForce {
    Point at;
    Vector3 f_local = Vector3::Zero();  // [N] or [-], body axes
};
struct FollowerMoment {
    BodyId body = ground;
    Vector3 m_local = Vector3::Zero();  // [N·m], [m] or [-], body axes
};
// The force of the road on a braked wheel, which the caliper holds to its carrier `body`: a dead force f on
// the carrier, along a line through the contact patch p of the wheel, so that its moment about the
// carrier's origin r is (p - r) × f. No potential.
struct BrakeForce {
    Point patch;
    BodyId body = ground;
    Vector3 f = Vector3::Zero();  // [N]; [-] if a driver multiplies it by newtons
};
using LoadKind = std::variant<DeadForce, DeadMoment, FollowerForce, FollowerMoment, BrakeForce>;
struct Load {
    std::string name;
    LoadKind kind;
};

}  // namespace elastocheck
