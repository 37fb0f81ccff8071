#include "recursive/soft_motion.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "recursive/diagnosis/analysis.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "recursive/linear_response.hpp"
#include "recursive/response_system.hpp"
#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive {
namespace {

// The matrix of soft_motion.hpp at the state, dense; empty where it is too large or not finite.
Eigen::MatrixXd scaled_matrix(SteppingState& s, const Equilibrium& state) {
    constexpr Eigen::Index max_unknowns = 1200;
    const Eigen::Index n = s.n(), m = s.m();
    if (n + m > max_unknowns) return {};
    s.q = state_of<double>(state.poses);
    go_to(s, {1, state.load});
    ResponseOrders orders;
    (void)factorise_response(s, true, orders);
    Eigen::MatrixXd M = sparse(s.system.M);
    const auto scale = s.system.weight.head(n).cwiseInverse().asDiagonal();
    const Eigen::MatrixXd K = scale * M.topLeftCorner(n, n) * scale;
    const double stiffest = K.size() > 0 ? K.cwiseAbs().maxCoeff() : 0;
    M.topLeftCorner(n, n) = (K + K.transpose()) / 2;
    Eigen::MatrixXd Phi = M.bottomLeftCorner(m, n) * scale;
    Phi.rowwise().normalize();
    M.bottomLeftCorner(m, n) = (stiffest > 0 ? stiffest : 1) * Phi;
    M.topRightCorner(n, m) = M.bottomLeftCorner(m, n).transpose();
    return M.allFinite() ? M : Eigen::MatrixXd();
}

// ", with 'rack'": other bodies that move at least a fifth as much.
std::string moving_along(const Model& model, const Eigen::VectorXd& motion, double length,
                         BodyId most) {
    constexpr double much = 0.2;
    const auto size = [&](BodyId b) {
        return std::hypot(motion.segment<3>(6 * b).norm(),
                          length * motion.segment<3>(6 * b + 3).norm());
    };
    std::string names;
    for (BodyId b = 0; b < static_cast<BodyId>(model.bodies.size()); ++b)
        if (b != most && size(b) > much * size(most))
            names += fmt::format("{}'{}'", names.empty() ? ", with " : ", ",
                                 model.bodies[static_cast<std::size_t>(b)].name);
    return names;
}

}  // namespace

std::string softest_motion(const Model& model, const Branch& branch, const Equilibrium& state,
                           bool moves_output) {
    constexpr double no_motion = 1e-6;  // of an eigenvector of length one
    constexpr double rounding = 1e-12;  // of the largest eigenvalue
    const Analysis analysis = analyse(model);
    SteppingState s(model, branch, analysis);
    const Eigen::MatrixXd M = scaled_matrix(s, state);
    if (M.size() == 0) return {};
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(M);
    std::vector<Eigen::Index> order(static_cast<std::size_t>(M.rows()));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::ranges::sort(order, {}, [&](Eigen::Index k) { return std::abs(solver.eigenvalues()[k]); });
    // Idle motions and redundant rows come first and are left out; a motion that is idle at the
    // design position may be soft here.
    const auto held = static_cast<std::size_t>(analysis.diagnosis.null_space.cols());
    const double zero = rounding * solver.eigenvalues().cwiseAbs().maxCoeff();
    for (std::size_t k = 0; k < order.size(); ++k) {
        if (k < held && std::abs(solver.eigenvalues()[order[k]]) <= zero) continue;
        const Eigen::VectorXd motion =
            solver.eigenvectors().col(order[k]).head(s.n()).cwiseQuotient(
                s.system.weight.head(s.n()));
        if (!(motion.norm() > no_motion)) continue;
        const IdleMode mode = motion_of(model, state.poses, motion.normalized(), s.setup.length);
        if (!moves_output || !mode.outputs.empty())
            return mode.description + moving_along(model, motion, s.setup.length, mode.body) +
                   (k < held ? ", which nothing resists as drawn" : "");
    }
    return {};
}

std::vector<std::string> free_or_locked(const Model& model) {
    const Diagnosis diagnosis = diagnose(model);
    std::vector<std::string> lines = locked_bodies(model, diagnosis);
    BodyId named = ground;
    for (const IdleMode& mode : diagnosis.idle)
        if (!mode.outputs.empty() && std::exchange(named, mode.body) != mode.body)
            lines.push_back(fmt::format("nothing resists a motion of '{}': {}",
                                        mode.outputs.front(), mode.description));
    return lines;
}

}  // namespace elastocheck::recursive
