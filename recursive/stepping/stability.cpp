#include "recursive/stepping/stability.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <algorithm>

#include "models/eigen/dense.hpp"
#include "recursive/stepping/stiffness.hpp"

namespace elastocheck::recursive {

bool has_energy(const Model& model, const Branch& branch) {
    return std::ranges::none_of(model.static_loads,
                                [&](const Load& load) { return !has_potential(load.kind); }) &&
           std::ranges::none_of(branch.drivers,
                                [&](const Driver& driver) {
                                    const Load* load = driven_load(driver.what);
                                    return load != nullptr && !has_potential(load->kind);
                                }) &&
           std::ranges::all_of(model.elastics, [](const auto& element) {
               const auto* formulation = member<Formulation>(element.kind);
               return formulation == nullptr || elastocheck::has_energy(*formulation);
           });
}

namespace {

// For the matrix of (24) [n + m square], in the norm |W x|, `weight` [n]. `held` lists one unknown
// for each idle mode, large in that mode, which is fixed.
bool has_negative_eigenvalue(const Eigen::SparseMatrix<double>& saddle,
                             const Eigen::VectorXd& weight, const std::vector<int>& held) {
    using Sparse = Eigen::SparseMatrix<double>;
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    // bound on |K - Kᵀ| / |K|: the residual asymmetry after Newton's method
    constexpr double symmetric = 1e-6;
    // ρ over the largest stiffness: if it is too small, motions that the joints forbid may have
    // negative pivots; if it is too large, K is lost in round-off.
    constexpr double penalties[] = {1, 1e3, 1e6};
    const Eigen::Index n = weight.size(), m = saddle.rows() - n;
    const auto scale = weight.cwiseInverse().asDiagonal();
    const Sparse K = scale * Sparse(saddle.topLeftCorner(n, n)) * scale, K_T = K.transpose();
    const double stiffest = K.nonZeros() > 0 ? K.coeffs().abs().maxCoeff() : 0;
    if (!(stiffest > 0) || !K.coeffs().allFinite() || Sparse(K - K_T).norm() > symmetric * K.norm())
        return false;
    Sparse Phi = Sparse(saddle.bottomLeftCorner(m, n)) * scale, Phi_T = Phi.transpose();
    for (Eigen::Index row = 0; row < m; ++row)
        if (const double size = Phi_T.col(row).norm(); size > 0) Phi_T.col(row) /= size;
    const Sparse forbidden = Phi_T * Sparse(Phi_T.transpose());
    std::vector<Eigen::Triplet<double>> diagonal;
    for (const int k : held) diagonal.emplace_back(k, k, stiffest);
    Sparse fixed(n, n);
    fixed.setFromTriplets(diagonal.begin(), diagonal.end());
    Sparse identity(n, n);
    identity.setIdentity();
    const Sparse S = (K + K_T) / 2 + fixed;
    return std::ranges::all_of(penalties, [&](double rho) {
        const double rounding = 16 * epsilon * static_cast<double>(n) * rho;
        const Eigen::SimplicialLDLT<Sparse> factors(
            Sparse(S + rho * stiffest * forbidden + rounding * stiffest * identity));
        return factors.info() == Eigen::Success && (factors.vectorD().array() < 0).any();
    });
}

}  // namespace

bool is_unstable(const SteppingState& s) {
    if (s.setup.free <= 0 || !has_energy(s.model, s.branch)) return false;
    const Held<double>& idle = s.system.held;
    std::vector<int> held;
    for (int c = 0; c < idle.idle; ++c) {
        int largest = -1;
        double size = 0;
        for (int e = idle.begin(c); e < idle.end(c); ++e) {
            const auto at = static_cast<std::size_t>(e);
            const int row = idle.row[at];
            if (const double here = std::abs(idle.value[at] * s.system.weight[row]);
                here > size && std::ranges::find(held, row) == held.end()) {
                largest = row;
                size = here;
            }
        }
        if (largest >= 0) held.push_back(largest);
    }
    return has_negative_eigenvalue(sparse(s.system.M), s.system.weight.head(s.n()), held);
}

namespace {

// The bodies that a motion W x displaces, and the one that it turns most.
std::string moving_bodies(const Model& model, const Eigen::VectorXd& motion) {
    constexpr double zero_tolerance = 1e-6, with_the_largest = 0.5;
    std::vector<double> displaced, turned;
    for (Eigen::Index row = 0; row < motion.size(); row += 6) {
        displaced.push_back(motion.segment<3>(row).norm());
        turned.push_back(motion.segment<3>(row + 3).norm());
    }
    const double farthest = std::ranges::max(displaced);
    std::string text;
    for (std::size_t b = 0; b < displaced.size(); ++b)
        if (displaced[b] > zero_tolerance && displaced[b] >= with_the_largest * farthest)
            text += fmt::format("{}'{}'", text.empty() ? "bodies that are displaced: " : ", ",
                                model.bodies[b].name);
    const auto most = std::ranges::max_element(turned);
    if (*most > zero_tolerance)
        text += fmt::format("{}body that turns most: '{}'", text.empty() ? "" : "; ",
                            model.bodies[static_cast<std::size_t>(most - turned.begin())].name);
    return text;
}

// Z, a basis of the null space of Φ_q [n × d], and ZᵀKZ with the matrix in the system, in the norm
// |W x|; computed densely.
struct ReducedStiffness {
    Eigen::MatrixXd Z, K;
};
constexpr int max_reduced = 600;  // coordinates
ReducedStiffness reduced(const SteppingState& s) {
    constexpr double independent = 1e-9;  // of rows of length one
    const Eigen::Index n = s.n(), m = s.m();
    const Eigen::MatrixXd M = sparse(s.system.M);
    const auto scale = s.system.weight.head(n).cwiseInverse().asDiagonal();
    const Eigen::MatrixXd K = scale * M.topLeftCorner(n, n) * scale;
    Eigen::MatrixXd Z = Eigen::MatrixXd::Identity(n, n);
    if (m > 0) {
        Eigen::MatrixXd Phi_T = (M.bottomLeftCorner(m, n) * scale).transpose();
        Phi_T.colwise().normalize();
        Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(n, m);
        qr.setThreshold(independent);
        qr.compute(Phi_T);
        Z = matrix_Q(qr).rightCols(n - qr.rank());
    }
    return {Z, congruence(K, Z)};
}

// The motion of least stiffness: an eigenvector of the symmetric part of ZᵀKZ.
std::string softest_motion(const SteppingState& s) {
    if (s.n() > max_reduced) return "a motion of a model too large to say which bodies move";
    const ReducedStiffness at = reduced(s);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
        Eigen::MatrixXd((at.K + at.K.transpose()) / 2));
    return moving_bodies(s.model, at.Z * solver.eigenvectors().col(0));
}

// Whether ZᵀKZ has a negative real eigenvalue where a dead moment makes it unsymmetric. Statics
// does not decide on complex ones.
bool is_unstable_under_moments(const SteppingState& s) {
    constexpr double rounding = 1e-12;  // of the largest eigenvalue
    if (s.setup.free <= 0 || s.n() > max_reduced || s.system.held.idle > 0) return false;
    const Eigen::EigenSolver<Eigen::MatrixXd> solver(reduced(s).K, false);
    const auto& mu = solver.eigenvalues();
    const double size = mu.cwiseAbs().maxCoeff();
    return solver.info() == Eigen::Success &&
           std::any_of(mu.begin(), mu.end(), [&](const auto& of) {
               return of.imag() == 0 && of.real() < -rounding * size;
           });
}

}  // namespace

StartStability start_stability(SteppingState& s) {
    StartStability start;
    start.least = min_stiffness(s, start.softest);
    // modes soft relative to the stiffest are below the rounding of is_unstable()
    start.unstable =
        is_unstable(s) || negative_idle_stiffness(s, s.q, s.lambda) < 0 ||
        (has_energy(s.model, s.branch) &&
         (start.least.of_energy ? start.least.value < 0 : is_unstable_under_moments(s)));
    if (start.unstable) start.motion = softest_motion(s);
    return start;
}

Outcome check_start_stability(SteppingState& s, const StartStability& start) {
    if (!start.unstable || !has_energy(s.model, s.branch)) return Outcome::converged;
    s.start.unstable = start.motion;
    return Outcome::singular;
}

namespace {

// How far beside a step a predicted minimum counts, as a fraction of the step.
constexpr double outside_step = 0.1;

// Minimum of the parabola through d(t) at three t, if it dips below half of the least of the three
// or below 2 % of their range, which is the error of the parabola. The minimum may lie outside the
// interval of t by at most `outside` of its length. In Newton's form, with the slopes `before` and
// `behind`,
//
//   d_0 + (t - t_0) (before + bend (t - t_1)),   bend = (behind - before) / (t_2 - t_0)
std::optional<Dip> parabola_dips(const std::array<double, 3>& t, const std::array<double, 3>& d,
                                 double outside) {
    constexpr double deep = 0.5, curved = 0.02;
    const double before = (d[1] - d[0]) / (t[1] - t[0]), behind = (d[2] - d[1]) / (t[2] - t[1]),
                 bend = (behind - before) / (t[2] - t[0]);
    const double low = (t[0] + t[1]) / 2 - before / (2 * bend),
                 value = d[0] + (low - t[0]) * (before + bend * (low - t[1]));
    const auto [least, most] = std::ranges::minmax(d);
    const double slack = outside * (t[2] - t[0]);
    const bool near = bend > 0 && low > t[0] - slack && low < t[2] + slack;
    return near && value < std::max(deep * least, curved * (most - least))
               ? std::optional(Dip{low, value})
               : std::nullopt;
}

}  // namespace

bool determinant_dips(double log_from, double log_middle, double log_to) {
    constexpr double deep = 0.5;
    const double most = std::max({log_from, log_middle, log_to});
    const double from = std::exp2(log_from - most), middle = std::exp2(log_middle - most),
                 to = std::exp2(log_to - most);
    return middle < deep * std::min(from, to) ||
           parabola_dips({0, 0.5, 1}, {from, middle, to}, 0).has_value();
}

bool may_reach_zero(const std::array<double, 3>& d) {
    return !(d[1] >= 0) || parabola_dips({0, 0.5, 1}, d, outside_step).has_value();
}

Dip lowest_determinant(std::array<double, 3> d,
                       const std::function<double(double)>& determinant_at) {
    // Smallest distance of a new point from the others, as a fraction of their interval.
    constexpr double separation = 0.05;
    constexpr int max_evaluations = 20;
    std::array<double, 3> t{0, 0.5, 1};
    for (int k = 0; k < max_evaluations && d[1] >= 0; ++k) {
        const auto dip = parabola_dips(t, d, outside_step);
        if (!dip) break;
        const double nearest = separation * (t[2] - t[0]);
        double place = std::clamp(dip->t, t[0] + nearest, t[2] - nearest);
        if (!(std::abs(place - t[1]) > nearest))
            place = t[1] + (t[2] - t[1] > t[1] - t[0] ? nearest : -nearest);
        const double value = determinant_at(place);
        if (value < 0) return {place, value};
        const bool left = place < t[1];
        if (value < d[1]) {
            (left ? t[2] : t[0]) = t[1];
            (left ? d[2] : d[0]) = d[1];
            t[1] = place;
            d[1] = value;
        } else {
            (left ? t[0] : t[2]) = place;
            (left ? d[0] : d[2]) = value;
        }
    }
    const auto lowest = static_cast<std::size_t>(std::ranges::min_element(d) - d.begin());
    return {t[lowest], d[lowest]};
}

double min_eigenvalue(const Eigen::MatrixXd& Q) {
    const Eigen::MatrixXd S = (Q + Q.transpose()) / 2;
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S, Eigen::EigenvaluesOnly)
        .eigenvalues()[0];
}

double min_of_idle(const SteppingState& s) {
    constexpr double operations = 256;  // bound on the rounding of a sum, in units of round-off
    constexpr double epsilon = std::numeric_limits<double>::epsilon();
    const Held<double>& held = s.system.held;
    const SaddleMatrix<double>& M = s.system.M;
    double min_stiffness = 0;
    for (int first = 0, end = 0; first < held.idle; first = end) {
        for (end = first + 1; end < held.idle && held.with[static_cast<std::size_t>(end)] == first;)
            ++end;
        const int modes = end - first, entries = held.end(first) - held.begin(first);
        const auto z = [&](int mode, int entry) {
            return Eigen::Map<const Vector6<double>>(held.value.data() + held.begin(first + mode) +
                                                     entry);
        };
        const auto body = [&](int entry) {
            return held.row[static_cast<std::size_t>(held.begin(first) + entry)] / 6;
        };
        Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(modes, modes), sizes = Q;
        for (int i = 0; i < entries; i += 6)
            for (int j = 0; j < entries; j += 6) {
                const int at = M.block_at(body(i), body(j));
                if (at < 0) continue;
                const Eigen::Map<const Matrix6<double>> K(M.values.data() + at);
                for (int a = 0; a < modes; ++a)
                    for (int b = 0; b < modes; ++b) {
                        Q(a, b) += static_cast<double>(z(a, i).dot(K * z(b, j)));
                        sizes(a, b) += static_cast<double>(
                            z(a, i).cwiseAbs().dot(K.cwiseAbs() * z(b, j).cwiseAbs()));
                    }
            }
        if (!Q.allFinite()) continue;
        if (const double lowest = min_eigenvalue(Q); lowest < -operations * epsilon * sizes.norm())
            min_stiffness = std::min(min_stiffness, lowest);
    }
    return min_stiffness;
}

double negative_idle_stiffness(SteppingState& s, const State<double>& near,
                               const Vector<double>& lambda_near) {
    constexpr int corrections = 3;
    constexpr double significant = 1e-6;
    if (s.system.held.idle == 0 || !has_energy(s.model, s.branch)) return 0;
    const auto least = [&](const State<double>& q) {
        const double stiffness = min_of_idle(s);
        if (!(stiffness < 0)) return 0.;
        external_force<double>(s.model, s.branch, s.inputs, q, s.work.upper);
        elastic_force<double>(s.model, s.inputs, q, s.work.force);
        const double forces = size_of_force(s, s.work.upper) + size_of_force(s, s.work.force);
        return stiffness < -significant * forces / s.setup.length ? stiffness : 0.;
    };
    if (!(least(near) < 0)) return 0;
    const Counts counts = s.counts;  // a check only: not counted
    State<double> q = near;
    Vector<double> lambda = lambda_near;
    bool regular = true;
    for (int k = 0; k < corrections && regular; ++k) {
        residual_at(s, q, lambda);
        back_substitute(s);
        regular = s.work.x.allFinite();
        s.step.dq = s.work.x.head(s.n());
        advance(q, s.step.dq);
        lambda += s.work.x.tail(s.m());
        regular = regular && factorise_at(s, q, lambda) == Outcome::converged;
    }
    s.counts = counts;
    return regular ? least(q) : 0;
}

}  // namespace elastocheck::recursive
