// Stability of the variants in the lanes.
#include <algorithm>
#include <cmath>
#include <limits>

#include "recursive/batch/pack.hpp"
#include "recursive/stepping/stability.hpp"
#include "recursive/stepping/step_check.hpp"
#include "recursive/stepping/stiffness.hpp"

namespace elastocheck::recursive::batch {
namespace {

constexpr int max_coordinates = 300;  // of a stability test with a dense matrix

// Whether an idle mode may be unstable under load: screening by the first test of
// negative_idle_stiffness(), a stiffness below -10⁻⁶ (forces / L).
bool may_be_unstable_idle(SteppingState& s) {
    constexpr double significant = 1e-6;
    const double stiffness = min_of_idle(s);
    if (!(stiffness < 0)) return false;
    external_force<double>(s.model, s.branch, s.inputs, s.q, s.work.upper);
    elastic_force<double>(s.model, s.inputs, s.q, s.work.force);
    const double forces = size_of_force(s, s.work.upper) + size_of_force(s, s.work.force);
    return !(stiffness >= -significant * forces / s.setup.length);
}

// Lower half of a dense symmetric matrix in one lane.
struct LaneMatrix {
    Matrix<Lanes>& values;
    int lane;

    void add(Eigen::Index i, Eigen::Index j, double value) {
        set_lane(values(i, j), lane, values(i, j)[lane] + value);
    }
};

// Adds the symmetric part of W⁻¹ K W⁻¹ and returns κ, the largest entry of that matrix. Each pair
// (i, j), (j, i) is visited twice, so that half of each of its entries is added.
double add_tangent(const SteppingState& s, LaneMatrix& A) {
    const SaddleMatrix<double>& M = s.system.M;
    const Vector<double>& W = s.system.weight;
    const int n = s.n();
    double stiffness = 0;
    for_each_entry(M, [&](int i, int j, int entry) {
        if (i >= n || j >= n) return;
        const double K = M.values[static_cast<std::size_t>(entry)] / (W[i] * W[j]);
        stiffness = std::max(stiffness, std::abs(K));
        A.add(std::max(i, j), std::min(i, j), i == j ? K : K / 2);
    });
    return stiffness;
}

// Adds κ r rᵀ / r·r for each row r of Φ_q W⁻¹. A row has at most two bodies, six coordinates each.
void add_constraint_penalty(const SteppingState& s, double stiffness, LaneMatrix& A) {
    const SaddleMatrix<double>& M = s.system.M;
    const Vector<double>& W = s.system.weight;
    for (int row = 0; row < M.m; ++row) {
        std::array<double, 12> r{};
        std::array<int, 12> coordinate{};
        double square = 0;
        std::size_t count = 0;
        for (int end = 0; end < 2; ++end) {
            const BodyId b = M.ends[static_cast<std::size_t>(row)][static_cast<std::size_t>(end)];
            for (int k = 0; b != ground && k < 6; ++k, ++count) {
                coordinate[count] = 6 * b + k;
                r[count] = M.part(row, end)[k] / W[6 * b + k];
                square += r[count] * r[count];
            }
        }
        const double rho = square > 0 ? stiffness / square : 0;
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < count; ++j)
                if (coordinate[i] >= coordinate[j])
                    A.add(coordinate[i], coordinate[j], rho * r[i] * r[j]);
    }
}

// Adds κ to the diagonal at the largest unknown of each idle mode: it holds that mode, which another
// test covers.
void add_idle_penalty(const SteppingState& s, double stiffness, LaneMatrix& A) {
    const Held<double>& held = s.system.held;
    for (int c = 0; c < held.idle; ++c) {
        int largest_row = -1;
        double largest = 0;
        for (int e = held.begin(c); e < held.end(c); ++e) {
            const auto k = static_cast<std::size_t>(e);
            const double size = std::abs(held.value[k] * s.system.weight[held.row[k]]);
            if (size > largest) {
                largest_row = held.row[k];
                largest = size;
            }
        }
        if (largest_row >= 0) A.add(largest_row, largest_row, stiffness);
    }
}

}  // namespace

// As min_stiffness() of one variant, with the factors of the lanes: inverse subspace iteration
// V = K⁻¹ W² U, in the inner product a·b = aᵀ W² b, and the eigenvalues 1/μ of H = Uᵀ W² V.
std::array<LeastStiffness, Lanes::count> Pack::min_stiffness(const Mask& mask, Matrix<Lanes>& U) {
    constexpr int vectors = 3, first_iterations = 5, iterations = 2;
    std::array<LeastStiffness, Lanes::count> stiffness{};
    const int n = design.system.n;
    const int free =
        design.diagnosis.degrees_of_freedom() - static_cast<int>(design.diagnosis.idle.size());
    if (free <= 0) return stiffness;
    Vector<Lanes> W(n), W2(n);
    for (int k = 0; k < n; ++k) {
        W[k] = 1;
        each(mask, [&](LaneState& state, int lane) {
            set_lane(W[k], lane, state.stepping->system.weight[k]);
        });
        W2[k] = W[k] * W[k];
    }
    const auto inner = [&](const Matrix<Lanes>& A, Eigen::Index a, const Matrix<Lanes>& B,
                           Eigen::Index b) {
        Lanes sum = 0;
        for (int k = 0; k < n; ++k) sum += A(k, a) * W2[k] * B(k, b);
        return sum;
    };
    const auto orthonormalise_columns = [&] {
        constexpr double zero_tolerance = 1e-9;
        for (Eigen::Index c = 0; c < U.cols(); ++c) {
            const Lanes square = inner(U, c, U, c);
            for (int pass = 0; pass < 2; ++pass)
                for (Eigen::Index b = 0; b < c; ++b) {
                    const Lanes part = inner(U, b, U, c);
                    for (int k = 0; k < n; ++k) U(k, c) -= part * U(k, b);
                }
            const Lanes remainder = inner(U, c, U, c), inverse = 1 / sqrt(remainder);
            for (int k = 0; k < n; ++k) U(k, c) *= inverse;
            // The scalar path would drop a dependent vector. A lane cannot, so its variant leaves it.
            each(mask, [&](LaneState& state, int lane) {
                if (!(remainder[lane] > zero_tolerance * zero_tolerance * square[lane]))
                    state.in_lockstep = false;
            });
        }
    };
    const bool is_first = U.cols() == 0;
    if (is_first) {
        U.resize(n, std::min(vectors, free));
        for (Eigen::Index c = 0; c < U.cols(); ++c)
            for (Eigen::Index k = 0; k < n; ++k) U(k, c) = scattered(k + c * n) / W[k];
        orthonormalise_columns();
    }
    const Vector<double>& scale = design.system.scale;
    Matrix<Lanes> V(n, U.cols()), H(U.cols(), U.cols());
    for (int iteration = is_first ? first_iterations : iterations; iteration > 0; --iteration) {
        std::fill(rhs.begin(), rhs.end(), Lanes(0));
        for (Eigen::Index c = 0; c < U.cols(); ++c) {
            for (int k = 0; k < n; ++k)
                rhs[static_cast<std::size_t>(k)] = U(k, c) * W2[k] * Lanes(scale[k]);
            solve(lu, rhs.data(), solution.data());
            for (int k = 0; k < n; ++k)
                V(k, c) = solution[static_cast<std::size_t>(k)] * Lanes(scale[k]);
        }
        if (iteration == 1)
            for (Eigen::Index a = 0; a < U.cols(); ++a)
                for (Eigen::Index b = 0; b < U.cols(); ++b) H(a, b) = inner(U, a, V, b);
        U = V;
        orthonormalise_columns();
    }
    each(mask, [&](LaneState&, int lane) {
        Eigen::MatrixXd H_lane(H.rows(), H.cols());
        for (Eigen::Index k = 0; k < H.size(); ++k) H_lane.data()[k] = H.data()[k][lane];
        stiffness[static_cast<std::size_t>(lane)] = detail::min_of(H_lane);
    });
    return stiffness;
}

// Tests that the starts are stable; a variant that fails a test leaves its lane. With the least
// stiffness and the idle modes, as in stability.hpp, and by the pivots of
//
//   W⁻¹ K W⁻¹ + κ Σ r rᵀ / r·r + κ (rounding I + Σ e eᵀ)     κ the largest entry of W⁻¹ K W⁻¹
//
// r the rows of Φ_q W⁻¹ and e the unit vector of the largest unknown of each idle mode: where it is
// positive definite, so is K on the motions that the constraints allow (Finsler), and it is positive
// definite where the pivots of its LDLᵀ are positive (Sylvester). `rounding` covers the rounding of the
// factorisation. `definite` holds the lower half.
void Pack::judge_start(Matrix<Lanes>& softest) {
    const int n = design.system.n;
    const auto least = min_stiffness(in_lockstep(), softest);
    if (n > max_coordinates)
        each(in_lockstep(), [](LaneState& state, int) { state.in_lockstep = false; });
    each(in_lockstep(), [&](LaneState& state, int lane) {
        const auto& [mu, of_energy] = least[static_cast<std::size_t>(lane)];
        state.in_lockstep = of_energy && mu > 0 && !may_be_unstable_idle(*state.stepping);
    });
    definite.setZero(n, n);
    each(in_lockstep(), [&](LaneState& state, int lane) {
        const SteppingState& s = *state.stepping;
        LaneMatrix A{definite, lane};
        const double stiffness = add_tangent(s, A);
        add_constraint_penalty(s, stiffness, A);
        const double rounding = 16 * std::numeric_limits<double>::epsilon() * n;
        for (int k = 0; k < n; ++k) A.add(k, k, rounding * stiffness);
        add_idle_penalty(s, stiffness, A);
    });
    const Lanes min_of_all = min_pivot(definite);
    each(in_lockstep(),
         [&](LaneState& state, int lane) { state.in_lockstep = min_of_all[lane] > 0; });
}

// Checks the determinant's sign and reversed elements at the ends of the ranges; with stiffness
// also the stability there and the determinant in between.
void Pack::check_ends(bool with_stiffness, Matrix<Lanes>& softest) {
    std::array<LeastStiffness, Lanes::count> least{};
    if (with_stiffness) least = min_stiffness(under_way(), softest);
    each(under_way(), [&](LaneState& state, int lane) {
        const double log_end = log_determinant(lu, lane);
        state.in_lockstep =
            static_cast<int>(lu.sign[lane]) == state.sign_at_start &&
            !any_reversed(state.stepping->model, state.expansion_point, state.stepping->q);
        if (with_stiffness) {
            const auto& [mu, of_energy] = least[static_cast<std::size_t>(lane)];
            state.in_lockstep =
                state.in_lockstep && of_energy && mu > 0 &&
                !may_be_unstable_idle(*state.stepping) &&
                !may_reach_zero({1, state.det_ratio_at_middle, std::exp2(log_end - state.log_det)});
        }
        state.log_det = log_end;
    });
}

}  // namespace elastocheck::recursive::batch
