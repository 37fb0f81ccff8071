#include "recursive/paper.hpp"

#include <Eigen/QR>

#include "recursive/assembly.hpp"
#include "recursive/diagnosis.hpp"
#include "recursive/drive.hpp"

namespace elastocheck::recursive {
namespace {

// The shortest (W Δq, λ) with M (Δq, λ) = b, W = 1 for Δr and L for Δπ: what is idle stays.
Vector<double> solve(const Matrix<double>& M, const Vector<double>& b, const Vector<double>& W) {
    const Vector<double> D = equilibration<double>(M);
    // λ in forces as large as the stiffness, so that rank is seen on a matrix without units.
    const Vector<double> columns = (W.array() > 0).select(W.cwiseInverse(), D);
    const Matrix<double> A = D.asDiagonal() * M * columns.asDiagonal();
    Eigen::CompleteOrthogonalDecomposition<Matrix<double>> orthogonal(A.rows(), A.cols());
    orthogonal.setThreshold(1e-11);
    orthogonal.compute(A);
    return columns.cwiseProduct(orthogonal.solve(D.cwiseProduct(b)));
}

}  // namespace

// ⎡ K(qⁿ)    Φ_q(qⁿ)ᵀ ⎤ ⎧ Δq ⎫ⁿ   ⎧ Δf_ext - ∂f_elast/∂a Δa + Φ_q(qⁿ⁻¹)ᵀ λⁿ⁻¹ ⎫
// ⎣ Φ_q(qⁿ)     0     ⎦ ⎩ λ  ⎭  = ⎩                -∂Φ/∂a Δa                    ⎭      (29)
//
// with Δf_ext = f_ext(qⁿ, aⁿ⁺¹) - f_ext(qⁿ⁻¹, aⁿ), so that it is (28) also where the lever of a load moves.
std::vector<PaperStep> paper(const Model& model, const Branch& branch, int N) {
    const int n = coordinates(model), m = constraint_rows(model);
    const double da = branch.to / N;
    State<double> q = design_state<double>(model);
    Inputs<double> inputs = inputs_at<double>(model, branch, 0);
    Matrix<double> M(n + m, n + m);
    Vector<double> lambda = Vector<double>::Zero(m), f_ext, f_before, carried, Phi(m), W = Vector<double>::Zero(n + m);
    for (int k = 0; k < n; ++k) W[k] = k % 6 < 3 ? 1 : diagnose(model).length;
    external_force<double>(model, branch, inputs, q, f_before);
    carried = f_before - elastic_force<double>(model, inputs, q);  // at rest: Φ_qᵀ λ⁻¹
    std::vector<PaperStep> path{{q, lambda}};

    for (int k = 0; k < N; ++k) {
        assemble<double>(model, inputs, q, M, Phi);
        Vector<double> b = Vector<double>::Zero(n + m), stored = Vector<double>::Zero(n), rate = Vector<double>::Zero(m);
        external_force<double>(model, branch, inputs_at<double>(model, branch, da * (k + 1)), q, f_ext);
        add_stored_rate<double>(model, branch, inputs, Drive::rate, da, q, stored);
        add_constraint_rate<double>(model, branch, inputs, Drive::rate, da, q, rate);
        b << f_ext - f_before - stored + carried, -rate;
        const Vector<double> x = solve(M, b, W);
        lambda = x.tail(m);
        carried = M.topRightCorner(n, m) * lambda;
        advance(q, x.head(n));
        f_before = f_ext;
        inputs = inputs_at<double>(model, branch, da * (k + 1));
        path.push_back({q, lambda});
    }
    return path;
}

}  // namespace elastocheck::recursive
