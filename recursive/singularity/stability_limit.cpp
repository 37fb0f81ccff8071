#include "recursive/singularity/stability_limit.hpp"

#include <Eigen/Eigenvalues>

#include "models/eigen/dense.hpp"
#include "recursive/stepping/stiffness.hpp"

namespace elastocheck::recursive {
namespace {

// K_G in the place of K, all other entries zero.
void assemble_delayed(const SteppingState& s, const StoredForces& forces, SaddleMatrix<double>& G) {
    std::fill(G.values.begin(), G.values.end(), 0.);
    if (forces.lever_follows || forces.axis_follows) {
        SaddleMatrix<double> levers = G;
        for (std::size_t k = 0; k < s.model.elastics.size(); ++k) {
            const ElasticKind& kind = s.model.elastics[k].kind;
            const auto [i, j] = bodies_of(kind);
            const auto* formulation = member<Formulation>(kind);
            detail::add_levers<double>(i, j, element_force<double>(kind, s.inputs.rest[k], s.q),
                                       formulation != nullptr && formulation->offset_moment,
                                       levers);
        }
        if (forces.axis_follows) {
            SaddleMatrix<double> K = G;
            add_stiffness<double>(s.model, s.inputs, s.q, K);
            add_elastic_tangent<double>(s.model, s.inputs, s.q, G);
            for (std::size_t k = 0; k < G.values.size(); ++k)
                G.values[k] -= K.values[k] + (forces.lever_follows ? 0. : levers.values[k]);
        } else {
            G = levers;
        }
    }
    add_curvature<double>(s.model, s.inputs, s.q, s.lambda, G);
    if (forces.load_follows) add_load_stiffness<double>(s.model, s.branch, s.inputs, s.q, G);
}

// G u for the top left block of G.
Vector<double> times(const SaddleMatrix<double>& G, const Vector<double>& u) {
    Vector<double> f = Vector<double>::Zero(G.n);
    for_each_entry(G, [&](int i, int j, int at) {
        if (i < G.n && j < G.n) f[i] += G.values[static_cast<std::size_t>(at)] * u[j];
    });
    return f;
}

// Largest eigenvalue of T K_G by subspace iteration on three vectors.
double largest(SteppingState& s, const SaddleMatrix<double>& G) {
    constexpr int vectors = 3, iterations = 12;
    const int n = s.n();
    const auto W2 = s.system.weight.head(n).array().square();
    Matrix<double> U(n, std::min(vectors, s.setup.free));
    for (Eigen::Index c = 0; c < U.cols(); ++c)
        for (Eigen::Index k = 0; k < n; ++k) U(k, c) = scattered(k + c * n) / s.system.weight[k];
    Eigen::MatrixXd H;
    s.work.lower.setZero();
    for (int k = 0; k < iterations; ++k) {
        detail::orthonormalise(s.system.weight, U);
        Matrix<double> V(n, U.cols());
        for (Eigen::Index c = 0; c < U.cols(); ++c) {
            s.work.upper = times(G, U.col(c));
            back_substitute(s);
            V.col(c) = s.work.x.head(n);
        }
        if (!V.allFinite()) return std::numeric_limits<double>::quiet_NaN();
        H = U.transpose() * W2.matrix().asDiagonal() * V;
        if (V.isZero(0)) return 0;
        U = V;
    }
    return std::max(0., eigenvalues_of(H).real().maxCoeff());
}

}  // namespace

double delayed_stiffness(const Model& model, const Branch& branch, const Method& method,
                         const Analysis& analysis, const Equilibrium& state) {
    const auto* linear = std::get_if<Linear>(&method.kind);
    SteppingState s(model, branch, analysis);
    if (linear == nullptr || s.setup.free <= 0) return 0;
    s.q = state_of<double>(state.poses);
    go_to(s, {1, state.load});
    if (factorise_at(s, s.q, s.lambda) != Outcome::converged)
        return std::numeric_limits<double>::quiet_NaN();
    residual_at(s, s.q, s.lambda);  // λ = 0: solves for the reactions
    s.work.lower.setZero();
    back_substitute(s);
    s.lambda = s.work.x.tail(s.m());
    SaddleMatrix<double> G = s.system.M;
    assemble_delayed(s, linear->stored, G);
    return largest(s, G);
}

// The eigenvalue is sampled on the true branch and the interval around one is refined until it is
// short relative to the load; linear interpolation then gives enough digits.
std::optional<double> stability_limit(const Model& model, const Branch& branch,
                                      const Method& method, const Analysis& analysis) {
    constexpr int points = 64, passes = 24;
    constexpr double near = 1. / 32;
    if (!std::holds_alternative<Linear>(method.kind)) return std::nullopt;
    Branch searched = branch;
    for (int pass = 0; pass < passes; ++pass) {
        const EquilibriumPath path =
            solve(model, searched, {.method = find_method("adaptive").value(), .steps = points},
                  analysis);
        double before = 0, before_load = 0, now = 0;  // eigenvalues below and at `beyond`
        const Equilibrium* beyond = nullptr;          // the first point with an eigenvalue of one
        for (const Equilibrium& point : path.points) {
            now = delayed_stiffness(model, branch, method, analysis, point);
            if (now >= 1) {
                beyond = &point;
                break;
            }
            before = now;
            before_load = point.load;
        }
        if (beyond == nullptr || beyond->load == 0)
            return beyond ? std::optional(0.) : std::nullopt;
        if (std::abs(beyond->load - before_load) <= near * std::abs(beyond->load))
            return before_load + (1 - before) / (now - before) * (beyond->load - before_load);
        searched.to = beyond->load;
    }
    return std::nullopt;
}

}  // namespace elastocheck::recursive
