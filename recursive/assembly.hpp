// The matrix of eq. (24) at a configuration.
#pragma once

#include "recursive/constraints.hpp"
#include "recursive/elastic.hpp"
#include "recursive/loads.hpp"
#include "recursive/saddle_point.hpp"

namespace elastocheck::recursive {

// ⎡ K(q)    Φ_q(q)ᵀ ⎤
// ⎣ Φ_q(q)    0     ⎦  → M,  and Φ(q) → Phi when asked for
template <class Real>
void assemble(const Model& model, const State<Real>& q, Matrix<Real>& M, Vector<Real>* Phi = nullptr) {
    const int n = coordinates(model);
    M.setZero();
    for (const auto& elastic : model.elastics)
        std::visit([&](const auto& e) { add_stiffness(element_stiffness<Real>(e, q), M); }, elastic.kind);
    for_each_row<Real>(model, q, [&](int k, const Row<Real>& row) {
        const auto put = [&](BodyId b, const Vector6<Real>& block) {
            if (b == ground) return;
            M.row(n + k).template segment<6>(6 * b) += block.transpose();
            M.col(n + k).template segment<6>(6 * b) += block;
        };
        put(row.i, row.on_i);
        put(row.j, row.on_j);
        if (Phi) (*Phi)[k] = row.Phi;
    });
}

}  // namespace elastocheck::recursive
