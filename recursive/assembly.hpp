// The matrix of eq. (24) at a configuration.
#pragma once

#include "recursive/constraints.hpp"
#include "recursive/elastic.hpp"
#include "recursive/saddle_point.hpp"
#include "recursive/tangent.hpp"

namespace elastocheck::recursive {

// ⎡ 0       Φ_qᵀ ⎤
// ⎣ Φ_q      0   ⎦  → M, everything else zero,  and Φ(q) → Phi
template <class Real>
void assemble_constraints(const Model& model, const Inputs<Real>& inputs, const State<Real>& q,
                          Matrix<Real>& M, Vector<Real>& Phi) {
    const int n = coordinates(model);
    M.setZero();
    for_each_row<Real>(model, inputs, q, [&](int k, const Row<Real>& row) {
        const auto put = [&](BodyId b, const Vector6<Real>& block) {
            if (b == ground) return;
            M.row(n + k).template segment<6>(6 * b) += block.transpose();
            M.col(n + k).template segment<6>(6 * b) += block;
        };
        put(row.i, row.on_i());
        put(row.j, row.on_j());
        Phi[k] = row.Phi;
    });
}

// ⎡ K(q)    Φ_q(q)ᵀ ⎤
// ⎣ Φ_q(q)    0     ⎦  → M     (24)
template <class Real>
void assemble(const Model& model, const Inputs<Real>& inputs, const State<Real>& q, Matrix<Real>& M,
              Vector<Real>& Phi) {
    assemble_constraints<Real>(model, inputs, q, M, Phi);
    add_stiffness<Real>(model, inputs, q, M);
}

// The same with the consistent tangent ∂G/∂q in place of K (tangent.hpp).
template <class Real>
void assemble_consistent(const Model& model, const Branch& branch, const Inputs<Real>& inputs,
                         const State<Real>& q, const Vector<Real>& lambda, Matrix<Real>& M,
                         Vector<Real>& Phi) {
    assemble_constraints<Real>(model, inputs, q, M, Phi);
    add_consistent_tangent<Real>(model, branch, inputs, q, lambda, M);
}

// The matrix somewhere where nothing vanishes by chance: what is zero here is zero everywhere.
template <class Real>
Matrix<Real> generic_matrix(const Model& model, const Branch& branch, const Matrix<Real>& like) {
    // Multiples of the golden ratio, less their whole part: no two alike, none zero.
    const auto fill = [](Vector<Real>& v, Real size) {
        for (Eigen::Index k = 0; k < v.size(); ++k) {
            const Real x = static_cast<Real>(k + 1) * Real(0.6180339887498949);
            v[k] = size * (x - std::floor(x) + Real(0.1));
        }
    };
    State<Real> q = design_state<Real>(model);
    Vector<Real> dq(coordinates(model)), lambda(constraint_rows(model)), Phi(constraint_rows(model));
    fill(dq, Real(0.3));
    fill(lambda, Real(1e3));
    advance(q, dq);
    Matrix<Real> M = like;
    Inputs<Real> inputs = inputs_at<Real>(model, branch, Real(0));
    for (std::size_t k = 0; k < inputs.load_factor.size(); ++k)
        inputs.load_factor[k] += Real(1e3) * static_cast<Real>(k + 1);
    for (auto& offset : inputs.offset) offset += Real(0.1);
    assemble_consistent<Real>(model, branch, inputs, q, lambda, M, Phi);
    return M;
}

// Φ_qᵀ λ [6nb] and Φ(q), without the matrix.
template <class Real>
void constraint_force(const Model& model, const Inputs<Real>& inputs, const State<Real>& q,
                      const Vector<Real>& lambda, Vector<Real>& f, Vector<Real>& Phi) {
    f.setZero(coordinates(model));
    for_each_row<Real>(model, inputs, q, [&](int k, const Row<Real>& row) {
        if (row.i != ground) f.template segment<6>(6 * row.i) += lambda[k] * row.on_i();
        if (row.j != ground) f.template segment<6>(6 * row.j) += lambda[k] * row.on_j();
        Phi[k] = row.Phi;
    });
}

}  // namespace elastocheck::recursive
