// Square system of this leg, as a function of the unknowns z and of the branch's parameter a:
//
//   unknowns z    per body    r - c [m], the quaternion (w, x, y, z) [-]
//                 per row     its reaction R [N, N·m]
//                 per curve   deformation x, force f
//   equations E   per body    Σ forces [N], Σ moments about its origin [N·m]
//                 per row     Φ [m, -]
//                 per curve   x(r, p; a) - x, f - ∂u/∂x
//                 per body    |p|² - 1
//
// A law of cubic pieces is separated along a branch, and at points that are not proved otherwise:
// its deformation x and force f become unknowns, so that its slope, an interval across a corner, is
// in one entry of ∂E/∂z (derivation.md, "Curves of laws"). The solutions are the same: x and f are
// functions of (r, p).
//
// c is a double near the model, the origin of all positions, so that the origin of the ground frame
// does not matter. Every quantity that a driver may move is start + rate·a in intervals: stored
// numbers enter exactly, and no product is rounded before the proof begins.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "models/driven_inputs.hpp"
#include "reference/certificate/statement/equations.hpp"
#include "reference/certificate/statement/sparse_rows.hpp"

namespace elastocheck::reference::certificate {

struct Affine {
    Interval start, rate;
    template <class T>
    T at(const T& a) const {
        return a * constant<Base<T>>(rate) + constant<Base<T>>(start);
    }
};

// Driven quantities of an element along the branch, and how its law is evaluated.
struct ElementPath : DrivenElement<Affine> {
    bool rotational = false;          // bushing forces depend on the markers' relative rotation
    std::array<bool, 6> separated{};  // separated laws; of a spring the first
    // Axes of a bushing's frame with equal rates across: rotating the frame about one leaves the
    // forces unchanged.
    std::array<bool, 3> turns_freely{};
};
// A separated law: its deformation and force are unknowns.
struct SeparatedCurve {
    std::size_t element = 0, axis = 0;
};
using LoadPath = DrivenLoad<Affine>;

struct System {
    const Model* model = nullptr;
    const Branch* branch = nullptr;
    std::vector<Affine> values;         // per Model::constraints: its offset, length or angle
    std::vector<int> first_row;         // per Model::constraints
    std::vector<ElementPath> elements;  // per Model::elastics
    std::vector<LoadPath> loads;        // static and driven
    std::vector<SeparatedCurve> separated;
    Eigen::Vector3d c = {0, 0, 0};  // [m]
    double length = 1;              // L, size of the model: reference length of scaling [m]
    // largest distance of a point from the origin of the stored coordinates, at least `length` [m]
    double farthest = 1;
    int bodies = 0, rows = 0;  // nb, m
    bool conservative = true;  // no follower, no formulation without energy
    int curves() const { return 2 * static_cast<int>(separated.size()); }
    int n() const { return 7 * bodies + rows + curves(); }
    int pose(BodyId body) const { return 7 * body; }
    int reaction(std::size_t constraint) const { return 7 * bodies + first_row[constraint]; }
    int balance(BodyId body) const { return 6 * body; }
    int closure(std::size_t constraint) const { return 6 * bodies + first_row[constraint]; }
    int deformation(std::size_t curve) const {
        return 7 * bodies + rows + 2 * static_cast<int>(curve);
    }
    int curve(std::size_t curve) const { return 6 * bodies + rows + 2 * static_cast<int>(curve); }
    int norm(BodyId body) const { return 6 * bodies + rows + curves() + body; }
};

enum class Curves {
    in_place,  // a curve is evaluated inside its element
    separated  // its deformation and its force are unknowns
};
// Throws std::invalid_argument where model and branch do not fit, or a driver moves a quantity that
// does not exist.
System make_system(const Model& model, const Branch& branch, Curves curves = Curves::in_place);
// Reason why no proof is tried: the size, or the arithmetic of the thread. Empty where one is
// tried.
std::string why_not_tried(const System& system, int max_unknowns);
const ScalarLaw& law_of(const System& system, const SeparatedCurve& curve);
// Sets x and f of the separated curves from the poses of z.
void set_separated(const System& system, Eigen::VectorXd& z, double a);

// A law's force is evaluated to f̂ ± ρ and acts on its two bodies. As one number in all equations it
// leaves a far smaller |Y F| than as independent ones:
//
//   E ∈ E(f̂) + D [-ρ, ρ]     D: the actions of unit forces, six columns per element, by entries
//
// Along a curve, E_k the Taylor coefficients below the last, Σ E_k sᵏ ∈ Σ E_k(f̂) sᵏ + D [-ρ, ρ] for
// |s| ≤ 1: with f_j ∈ f̂_j ± ρ_j and the coefficients D_i, ρ = Σ ρ_j and D = D_0 + Σ D_i [-1, 1].
struct Laws {
    std::vector<Slope<Interval>> D;
    Eigen::VectorXd rho;
    int column = 0;  // of D, first one of the element that is being assembled
};
// E [n], with slopes ∂E/∂z = J [n × n] and ∂E/∂a = E_a [n], or with the laws.
template <class S>
struct Values {
    std::vector<S> E, E_a;
    SparseRows<S> J;
    Laws laws;
};
enum class Slopes { no, yes };
// E(f̂) and the laws, in intervals.
template <class S>
Values<S> residual(const System& system, const std::vector<S>& z, const S& a);
template <class S>
Values<S> evaluate(const System& system, const std::vector<S>& z, const S& a, Slopes slopes);
// Number types along a branch piece: for the equations and for their Jacobian.
using Along = Jet<6>;
using SlopesAlong = Jet<2>;
template <class S>
Values<S> evaluate_without_slopes(const System& system, const std::vector<S>& z, const S& a);

// ∂E/∂z [n × n] at constant elastic forces, and the size of the acting forces on each body,
// Σ |force| + |moment| / L over its elements, reactions and loads [N].
struct Geometry {
    SparseRows<double> J;
    std::vector<double> force_sizes;
};
Geometry geometry(const System& system, const std::vector<double>& z, double a);
// ∂e/∂z of the deformation of an element, springs in the first row only [6 × 7 nb].
Eigen::MatrixXd deformation_slopes(const System& system, std::size_t element,
                                   const std::vector<double>& z, double a);

// Wrenches of the joints: on body i, about ModelJoint::at.
template <class S>
struct JointWrench {
    Vec<S> force, moment;
};
template <class S>
std::vector<JointWrench<S>> wrenches(const System& system, const std::vector<S>& z, const S& a);

// Wrench of the joint for a unit reaction in each of its rows, as columns.
template <class S>
std::vector<JointWrench<S>> unit_wrenches(const System& system, int joint, const std::vector<S>& z,
                                          const S& a);
// Positions of the rows of a joint among all rows.
std::vector<int> rows_of_joint(const System& system, int joint);

// Deformation that enters the law of each element; for springs only the first entry.
std::vector<std::array<Interval, 6>> deformations(const System& system,
                                                  const std::vector<Interval>& z,
                                                  const Interval& a);

}  // namespace elastocheck::reference::certificate
