// The matrix of eq. (24) at a configuration.
#pragma once

#include "recursive/formula/constraints.hpp"
#include "recursive/formula/elastic.hpp"
#include "recursive/formula/tangent.hpp"
#include "recursive/linear_algebra/saddle_point.hpp"

namespace elastocheck::recursive {

// ⎡ 0       Φ_qᵀ ⎤
// ⎣ Φ_q      0   ⎦  → M, everything else zero,  and Φ(q) → Phi
template <class Real>
void assemble_constraints(const Model& model, const Inputs<Real>& inputs, const State<Real>& q,
                          SaddleMatrix<Real>& M, Vector<Real>& Phi) {
    std::fill_n(M.values.begin(), 36 * M.blocks(), Real(0));
    for_each_row<Real>(model, inputs, q, [&](int k, const Row<Real>& row) {
        if (row.i != ground) M.part(k, 0) = row.on_i();
        if (row.j != ground) M.part(k, 1) = row.on_j();
        Phi[k] = row.Phi;
    });
}

// ⎡ K(q)    Φ_q(q)ᵀ ⎤
// ⎣ Φ_q(q)    0     ⎦  → M     (24)
//
// With the consistent tangent ∂G/∂q in place of K: assemble_constraints(), add_consistent_tangent().
template <class Real>
void assemble(const Model& model, const Inputs<Real>& inputs, const State<Real>& q,
              SaddleMatrix<Real>& M, Vector<Real>& Phi) {
    assemble_constraints<Real>(model, inputs, q, M, Phi);
    add_stiffness<Real>(model, inputs, q, M);
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

// Instantiated in linear_algebra/in_double.cpp.
extern template void add_stiffness<double>(const Model&, const Inputs<double>&,
                                           const State<double>&, SaddleMatrix<double>&);
extern template void add_elastic_tangent<double>(const Model&, const Inputs<double>&,
                                                 const State<double>&, SaddleMatrix<double>&);
extern template void add_curvature<double>(const Model&, const Inputs<double>&,
                                           const State<double>&, const Vector<double>&,
                                           SaddleMatrix<double>&);
extern template void add_load_stiffness<double>(const Model&, const Branch&, const Inputs<double>&,
                                                const State<double>&, SaddleMatrix<double>&);
extern template void assemble<double>(const Model&, const Inputs<double>&, const State<double>&,
                                      SaddleMatrix<double>&, Vector<double>&);
extern template void assemble_constraints<double>(const Model&, const Inputs<double>&,
                                                  const State<double>&, SaddleMatrix<double>&,
                                                  Vector<double>&);
extern template void constraint_force<double>(const Model&, const Inputs<double>&,
                                              const State<double>&, const Vector<double>&,
                                              Vector<double>&, Vector<double>&);

}  // namespace elastocheck::recursive
