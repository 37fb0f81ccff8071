// Asymptotic numerical method (Cochelin 1994): the equilibrium branch as a piecewise power series.
//
// x(τ) = x_0 + x_1 τ + ... + x_p τ^p satisfies the full equations up to order p. All orders share
// one matrix, the consistent tangent at τ = 0, factorised once:
//
// ⎡ ∂G/∂q   Φ_qᵀ ⎤ ⎧ Δq_k ⎫     ⎧ G_k ⎫         ⎧ f ⎫
// ⎣ Φ_q      0   ⎦ ⎩ λ_k  ⎭ = - ⎩ Φ_k ⎭  +  a_k ⎩ 0 ⎭      G_k, Φ_k of the lower orders only  (24)
//
// f the branch's load per unit of the load factor. With the load as parameter, a = a_0 + τ. With
// arc length, τ is the motion of the bodies projected on its first coefficient, and a_k follows
// from it; the path then passes limit points. The derivation is in derivation.md.
#pragma once

#include <optional>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/recursive_method.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/formula/inputs.hpp"

namespace elastocheck::recursive::series {

// Pole or branch point nearest to τ = 0, estimated from the coefficients.
struct Singularity {
    double radius = 0;  // |τ|
    // of τ in the complex plane: 0 straight ahead, ±π/2 beside the path, π behind [rad]
    double angle = 0;
    double misfit = 0;  // relative residual of the fit: 0 exact, 1 no fit
};

// A-posteriori check of an expansion: residual forces of the full equations at the middle and end
// of its range, and the Newton correction with fresh factors at its end, which is the error there.
struct Certificate {
    double force_middle = 0, force_end = 0;            // [N], or [N·m] for moments
    double constraint_middle = 0, constraint_end = 0;  // [m], [-]
    double error_end = 0;                              // [m]: position, and orientation times L
};

struct Expansion {
    std::vector<Pose> start;  // at τ = 0
    Eigen::MatrixXd x;  // (r_k, 2 g_k; λ_k) for k = 0 ... p: [(6nb + m) × (p+1)]; r_0 = 2 g_0 = 0
    Eigen::VectorXd load;  // a_k
    double reach = 0;      // used for 0 ≤ τ ≤ reach
    int knots = 0;         // knots crossed at the end
    Singularity singularity;
    Certificate certificate;

    int order() const { return static_cast<int>(x.cols()) - 1; }
};

struct Path {
    Outcome outcome = Outcome::converged;
    std::string detail;
    std::vector<Expansion> expansions;
    std::vector<double> limits;  // values of a at which the path turns back (arc length), or ends
    bool arc_length = false;
    int rejected = 0;  // expansions shortened because the error at their end was too large
    Counts counts;     // iterations: back-substitutions; evaluations: residuals, not coefficients
};

// The settled equilibrium at load factor 0, with its factors. Branches whose drivers have the same
// values there start in it, whatever their rates.
struct Start {
    std::vector<Driver> drivers;  // whose value at load factor 0 is not 0
    State<double> q;
    Vector<double> lambda, Phi_d;
    SaddlePoint<double> system;
    std::vector<Piece> pieces;  // of the curves
    StartStability stability;
};

// Settles the start of the branch and keeps it in the analysis, for follow(): from the start that is
// kept there where that is near, else from the design position. Keeps nothing where it does not
// settle, for which follow() has the words.
void keep_start(const Model& model, const Branch& branch, const recursive::Series& options,
                Analysis& analysis);

// Follows the branch from load factor 0 to branch.to. With the load as parameter, ends with
// `limit_point` where no equilibrium continues the branch.
Path follow(const Model& model, const Branch& branch, const recursive::Series& options,
            const Analysis& analysis);
Path follow(const Model& model, const Branch& branch, const recursive::Series& options = {});

// Position on the path; find() returns the first position with the given load factor.
struct Place {
    std::size_t expansion = 0;
    double tau = 0;
};
std::optional<Place> find(const Path& path, double load);

// The configuration at a position, with joint wrenches from λ; evaluates the polynomial only.
Equilibrium evaluate(const Model& model, const Branch& branch, const Path& path, Place place);

// The same at `points` equal increments of the load factor from 0 to branch.to, as far as the path
// extends; with arc length as parameter, at equal increments of arc length along the path.
EquilibriumPath sample(const Model& model, const Path& path, const Branch& branch, int points,
                       const PointVisitor& visit = {});

// Derivative of the path with respect to the load factor, exact for the polynomial.
struct Rates {
    std::vector<Eigen::Vector3d> dr;     // of the bodies' origins [m]
    std::vector<Eigen::Vector3d> omega;  // rotation, ground axes [rad]
};
Rates rates(const Path& path, Place place);

}  // namespace elastocheck::recursive::series
