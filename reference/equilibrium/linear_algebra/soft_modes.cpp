#include "reference/equilibrium/linear_algebra/soft_modes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Deformations below this part of the motion are rounding; the threshold for G, relative to the
// largest entry of J, is its square.
constexpr double no_deformation = 1e-12;

// Modes with a smaller part on bodies are self-stresses of redundant joints.
constexpr double part_of_bodies = 1e-3;

// Threshold of the null vectors of J, relative to its largest entry. The vector v of an idle motion
// may contain a part δ of motions whose stiffness μ is above this threshold. Then G = μ δ² and
// |J v| = μ δ, hence G ≤ |J v|² / threshold; a soft motion has G = |J v|.
constexpr double threshold = 1e-11;

// Relative to the largest eigenvalue of G: smaller ones are zero.
constexpr double zero_eigenvalue = 1e-12;

// Relative to the largest entry of J: smaller stiffnesses are below its rounding.
constexpr double entry_rounding = 16 * std::numeric_limits<double>::epsilon();

// Largest allowed ratio of G to |J v|.
constexpr double max_ratio = 4;

struct SplitModes {
    Sparse idle;       // unresisted modes [n × k]
    double least = 0;  // least stiffness of the others
    Index resisted = 0;
};
SplitModes split_modes(const System& system, const Loading& loading, const VectorXd& x,
                       const Sparse& J, const Sparse& modes) {
    const Index n = 6 * system.bodies;
    const double size = largest_entry(J);
    std::vector<Index> idle, resisted;
    std::vector<DeformationRates> deformations_of;
    for (Index k = 0; k < modes.cols(); ++k) {
        const VectorXd v = modes.col(k);
        const double motion = v.head(n).norm(), imbalance = (J * v).head(n).norm();
        DeformationRates deformation = deformation_rates(system, loading, x, v);
        const double zero_tolerance = std::max(std::pow(no_deformation * motion, 2) * size,
                                               imbalance * imbalance / (threshold * size));
        // The elastic stiffness may be cancelled by the geometric one, as of a loaded bushing that
        // spins: then G exceeds |J v|.
        const double stored = deformation.rate.dot(deformation.force_rate),
                     max_stored = max_ratio * imbalance * motion + entry_rounding * size;
        if (motion < part_of_bodies * v.norm() ||
            !(stored > zero_tolerance && stored <= max_stored)) {
            idle.push_back(k);
        } else {
            resisted.push_back(k);
            deformations_of.push_back(std::move(deformation));
        }
    }
    const auto count = static_cast<Index>(resisted.size());
    SplitModes result{modes, 0, count};
    if (count == 0) return result;
    MatrixXd G(count, count);
    for (Index a = 0; a < count; ++a)
        for (Index b = 0; b < count; ++b)
            G(a, b) = deformations_of[static_cast<std::size_t>(a)].rate.dot(
                deformations_of[static_cast<std::size_t>(b)].force_rate);
    G = ((G + G.transpose()) / 2).eval();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(G);
    const double largest = solver.eigenvalues()[count - 1];
    const Index zeros = (solver.eigenvalues().array() <= zero_eigenvalue * largest).count();
    MatrixXd idle_modes(modes.rows(), static_cast<Index>(idle.size()) + zeros);
    for (std::size_t k = 0; k < idle.size(); ++k)
        idle_modes.col(static_cast<Index>(k)) = VectorXd(modes.col(idle[k]));
    MatrixXd resisted_modes(modes.rows(), count);
    for (Index k = 0; k < count; ++k)
        resisted_modes.col(k) = VectorXd(modes.col(resisted[static_cast<std::size_t>(k)]));
    idle_modes.rightCols(zeros) = resisted_modes * solver.eigenvectors().leftCols(zeros);
    // relative to motions of size one
    const VectorXd softest = resisted_modes * solver.eigenvectors().col(zeros);
    result.idle = idle_modes.sparseView();
    result.resisted = count - zeros;
    result.least = solver.eigenvalues()[zeros] / softest.head(n).squaredNorm();
    return result;
}

}  // namespace

void remove_resisted_modes(const System& system, const Loading& loading, const VectorXd& x,
                           Linearisation& linearisation, Counts& counts) {
    if (linearisation.modes.count() == 0 || system.elements.empty()) return;
    const double size = largest_entry(linearisation.J);
    const SplitModes right =
        split_modes(system, loading, x, linearisation.J, linearisation.modes.right);
    if (right.resisted == 0) return;
    const SplitModes left =
        split_modes(system, loading, x, linearisation.J.transpose(), linearisation.modes.left);
    linearisation.modes_are_soft =
        !(right.least > entry_rounding * size) || left.resisted != right.resisted;
    if (linearisation.modes_are_soft) return;
    linearisation.modes = {right.idle, left.idle};
    linearisation.bordered = bordered_like(linearisation, linearisation.J);
    ++counts.factorisations;
}

}  // namespace elastocheck::reference::equilibrium
