// The matrices of the variants in the lanes: assembled, factorised, solved for corrections.
#include <algorithm>
#include <cmath>

#include "recursive/batch/pack.hpp"
#include "recursive/stepping/step_check.hpp"

namespace elastocheck::recursive::batch {
namespace {

// Smallest over largest pivot at the design position, as a fraction of the design's ratio: below it
// a variant may have an idle mode or a redundancy that the design has not, and leaves its lane.
constexpr double min_share_of_ratio = 1e-3;
// Strain up to which a held mode is exactly idle, or a combination exactly redundant.
constexpr double max_strain_of_held = 1e-12;
constexpr double largest_multiplier = 1e4;  // as series_state() in recursive/series/path.cpp

}  // namespace

void Pack::assemble(int lane) {
    LaneState& state = lanes[static_cast<std::size_t>(lane)];
    SteppingState& s = *state.stepping;
    assemble_constraints<double>(s.model, s.inputs, s.q, s.system.M, s.work.Phi);
    add_consistent_tangent<double>(s.model, s.branch, s.inputs, s.q, s.lambda, s.system.M);
    load_matrix(lane);
}

// Scales and borders the matrix of a lane.
void Pack::load_matrix(int lane) {
    LaneState& state = lanes[static_cast<std::size_t>(lane)];
    SteppingState& s = *state.stepping;
    for (const int k : omitted_entries)
        if (s.system.M.values[static_cast<std::size_t>(k)] != 0) state.in_lockstep = false;
    set_border(s.system);
    const SparseLU<double>& entries = s.system.lu;
    for (std::size_t e = 0; e < lu.values.size(); ++e)
        set_lane(
            lu.values[e], lane,
            s.system.M.values[static_cast<std::size_t>(entries.source[e])] * entries.factor[e]);
}

// Factorises the matrices of all lanes, and updates and checks the held directions of those
// in the mask.
void Pack::factorise(const Mask& mask, bool at_design) {
    eliminate(lu);
    const SaddlePoint<double>& shared = design.system;
    for (int c = 0; c < shared.held.size(); ++c) {
        std::fill(rhs.begin(), rhs.end(), Lanes(0));
        rhs[static_cast<std::size_t>(shared.n + shared.m + c)] = 1;
        solve(lu, rhs.data(), solution.data());
        each(mask, [&](LaneState& state, int lane) {
            Held<double>& held = state.stepping->system.held;
            for (int e = held.begin(c); e < held.end(c); ++e) {
                const int row = held.row[static_cast<std::size_t>(e)];
                held.value[static_cast<std::size_t>(e)] =
                    solution[static_cast<std::size_t>(row)][lane] * shared.scale[row];
            }
        });
    }
    each(mask, [&](LaneState& state, int lane) {
        SteppingState& s = *state.stepping;
        ++s.counts.factorisations;
        orthonormalise(s.system);
        const double ratio = lu.min_pivot[lane] / lu.largest_pivot[lane];
        const bool regular = lu.finite[lane] == 0 && is_regular(s, ratio) &&
                             lu.largest_multiplier[lane] <= largest_multiplier &&
                             check_factors(s, s.q, ratio) == Outcome::converged;
        state.in_lockstep =
            regular && (!at_design || (ratio > min_share_of_ratio * design.pivot_ratio &&
                                       strain_of_held(s, s.q) <= max_strain_of_held));
    });
}

void Pack::load_rhs(int lane) {
    const SteppingState& s = *lanes[static_cast<std::size_t>(lane)].stepping;
    const int n = s.n(), m = s.m();
    const auto put = [&](int k, double value) {
        set_lane(rhs[static_cast<std::size_t>(k)], lane, value * s.system.scale[k]);
    };
    for (int k = 0; k < n; ++k) put(k, s.work.upper[k]);
    for (int k = 0; k < m; ++k) put(n + k, s.work.lower[k]);
    for (int k = n + m; k < n + m + s.system.borders(); ++k)
        set_lane(rhs[static_cast<std::size_t>(k)], lane, 0);
}

void Pack::back_substitute(const Mask& mask) {
    solve(lu, rhs.data(), solution.data());
    each(mask, [&](LaneState& state, int lane) {
        SteppingState& s = *state.stepping;
        for (int k = 0; k < s.n() + s.m(); ++k)
            s.work.x[k] = solution[static_cast<std::size_t>(k)][lane] * s.system.scale[k];
        ++s.counts.iterations;
    });
}

// Newton corrections at the ends of the ranges; the last factors serve the next expansion.
void Pack::correct_ends(Drive drive, const LaneEnds& to) {
    Mask correcting = under_way();
    each(correcting, [&](LaneState& state, int lane) {
        move_to(state, drive, state.tau_end);
        if (state.ends_side)
            set_parameter(*state.stepping, drive, to[static_cast<std::size_t>(lane)]);
        state.last_correction = std::numeric_limits<double>::infinity();
    });
    constexpr int max_corrections = 8;
    for (int k = 0; k < max_corrections && std::ranges::count(correcting, true) > 0; ++k) {
        each(correcting, [&](LaneState&, int lane) { assemble(lane); });
        factorise(correcting, false);
        each(correcting, [&](LaneState& state, int lane) {
            residual_at(*state.stepping, state.stepping->q, state.stepping->lambda);
            load_rhs(lane);
        });
        back_substitute(correcting);
        for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
            LaneState& state = lanes[lane];
            correcting[lane] = correcting[lane] && state.in_lockstep;
            if (!correcting[lane]) continue;
            SteppingState& s = *state.stepping;
            const double size = std::sqrt(size_of_solution(s));
            if (!s.work.x.allFinite() || check_idle_load_here(s, size) != Outcome::converged) {
                state.in_lockstep = correcting[lane] = false;
                continue;
            }
            if (k == 0) state.error = size;
            if (!(size < state.last_correction)) {  // at rounding level
                correcting[lane] = false;
                continue;
            }
            state.last_correction = size;
            s.step.dq = s.work.x.head(s.n());
            advance(s.q, s.step.dq);
            s.lambda += s.work.x.tail(s.m());
            const double rounding = 10 * std::numeric_limits<double>::epsilon() * s.setup.length;
            // No expansion starts at the end of a branch: the first correction, which is the error
            // there, is enough.
            correcting[lane] = !(state.ends_side && drive == Drive::rate) &&
                               !(size <= std::max(rounding, 1e-2 * options.series.tolerance));
        }
    }
    each(under_way(), [&](LaneState& state, int) {
        SteppingState& s = *state.stepping;
        if (!(state.error <= 10 * options.series.tolerance)) state.in_lockstep = false;
        if (has_redundancy(s)) {
            residual_at(s, s.q, s.lambda);
            if (is_inconsistent(s, s.q)) state.in_lockstep = false;
        }
    });
}

}  // namespace elastocheck::recursive::batch
