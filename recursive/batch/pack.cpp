#include "recursive/batch/pack.hpp"

#include <algorithm>
#include <cmath>

#include "recursive/diagnosis/diagnosis.hpp"
#include "recursive/formula/recentre.hpp"
#include "recursive/series/path.hpp"
#include "recursive/series/polynomial.hpp"
#include "recursive/series/sides.hpp"
#include "recursive/stepping/settle.hpp"
#include "recursive/stepping/stability.hpp"
#include "recursive/stepping/stiffness.hpp"

namespace elastocheck::recursive::batch {
namespace {
// Relative correction of x_1 above which all coefficients of a lane are corrected, which costs half
// an expansion more. The scalar path does so from 1e-13 on. Here x_1 itself is always corrected,
// and 3e-12 of the higher orders, a fraction of the travel, is below the tolerance of the series.
constexpr double loses_digits = 30 * series::loses_digits;

// Sets the parameter of the equations, t or a, and the inputs there.
void set_parameter(SteppingState& s, Drive drive, double to) {
    go_to(s, drive == Drive::start ? Parameters{to, 0} : Parameters{1, to});
    s.a = s.parameters.a;
}

// Sets the state to the polynomial about the expansion point at τ.
void move_to(LaneState& state, Drive drive, double tau) {
    SteppingState& s = *state.stepping;
    series::horner(state.expansion.x, tau, state.x);
    series::displace(state.expansion_point, state.x, s.q);
    s.lambda = state.x.tail(s.m());
    set_parameter(s, drive, series::polynomial(state.expansion.load, tau));
}

// Reads the coefficients of the curves' deformations in the last expansion.
void read_deformations(const series::Equations<Lanes>& e, LaneState& state, int lane) {
    state.deformations.resize(e.order() + 1, static_cast<Eigen::Index>(state.curves.size()));
    for (std::size_t c = 0; c < state.curves.size(); ++c)
        for (int k = 0; k <= e.order(); ++k)
            state.deformations(k, static_cast<Eigen::Index>(c)) =
                series::deformation(e, state.curves[c].elastic, state.curves[c].axis, k)[lane];
}

}  // namespace

Pack::Pack(const Model& model, const Analysis& analysis, const BatchOptions& batch_options)
    : design(analysis),
      options(batch_options),
      lu(reserve_factors(*analysis.system.lu.order)),
      rhs(lu.size(), 0),
      solution(lu.size(), 0) {
    const SaddlePoint<double>& system = design.system;
    std::vector<bool> covered(static_cast<std::size_t>(system.M.part_at(system.m, 0)), false);
    for (const int source : system.lu.source)
        if (const auto k = static_cast<std::size_t>(source); k < covered.size())  // else border
            covered[k] = true;
    for (std::size_t k = 0; k < covered.size(); ++k)
        if (!covered[k]) omitted_entries.push_back(static_cast<int>(k));
    for (std::size_t k = 0; k < model.branches.size(); ++k) {
        const auto same = [&](const auto& group) {
            return series::same_drivers(model.branches[group.front()], model.branches[k]);
        };
        const auto found = std::ranges::find_if(groups, same);
        found == groups.end() ? groups.push_back({k}) : found->push_back(k);
    }
    const int order = options.series.order;
    for (const auto& group : groups) {
        const Branch& branch = model.branches[group.front()];
        equations.push_back({series::equations<Lanes>(model, branch, order, Drive::start),
                             series::equations<Lanes>(model, branch, order, Drive::rate)});
    }
    const int unknowns = system.n + system.m;
    start_expansion = expansion = series::reserve_coefficients<Lanes>(unknowns, order);
    x.setZero(unknowns);
    for (LaneState& state : lanes) {
        state.expansion = series::reserve_coefficients<double>(unknowns, order);
        state.paths.resize(model.branches.size());
    }
}

Mask Pack::in_lockstep() const {
    Mask mask{};
    for (std::size_t k = 0; k < lanes.size(); ++k) mask[k] = lanes[k].in_lockstep;
    return mask;
}
Mask Pack::under_way() const {
    Mask mask{};
    for (std::size_t k = 0; k < lanes.size(); ++k)
        mask[k] = lanes[k].in_lockstep && lanes[k].under_way;
    return mask;
}

void Pack::solve_variants(std::span<const Model* const> variants) {
    for (std::size_t k = 0; k < lanes.size(); ++k) {
        LaneState& state = lanes[k];
        state.in_lockstep = k < variants.size();
        if (!state.in_lockstep) continue;
        state.model = *variants[k];
        if (far_centre(state.model)) state.in_lockstep = false;
    }
    for (std::size_t group = 0; group < groups.size(); ++group) solve_group(group);
}

// Sets the lane to the design position of its variant: state, inputs, residuals, matrix.
void Pack::prepare(int lane, const Branch& branch) {
    LaneState& state = lanes[static_cast<std::size_t>(lane)];
    state.branch = branch;
    if (!state.stepping)
        state.stepping = std::make_unique<SteppingState>(state.model, state.branch, design);
    SteppingState& s = *state.stepping;
    s.setup.consistent = true;
    s.counts = {};
    s.q = design_state<double>(state.model);
    s.lambda.setZero();
    s.start.drawn = inputs_as_drawn<double>(state.model);
    s.inputs = s.start.drawn;
    s.setup.length = characteristic_length(state.model);
    for (int b = 0; b < s.n() / 6; ++b)
        s.system.weight.segment(6 * b + 3, 3).setConstant(s.setup.length);
    s.system.held.value = design.system.held.value;
    state.curves = series::curves_of(state.model);
    const Branch undriven;
    go_to(s, {0, 0});
    assemble_constraints<double>(s.model, s.inputs, s.q, s.system.M, s.work.Phi);
    add_consistent_tangent<double>(s.model, undriven, s.inputs, s.q, s.lambda, s.system.M);
    external_force<double>(s.model, undriven, s.inputs, s.q, s.start.R_d);
    s.start.R_d -= elastic_force<double>(s.model, s.inputs, s.q);
    s.start.Phi_d = s.work.Phi;
    state.at_rest = is_at_rest(s.system, s.start.R_d, s.work.Phi, s.setup.length);
    if (!s.start.R_d.allFinite() || !s.work.Phi.allFinite()) state.in_lockstep = false;
}

void Pack::solve_group(std::size_t group) {
    const std::vector<std::size_t>& branches = groups[group];
    bool settles = false;
    each(in_lockstep(), [&](LaneState& state, int lane) {
        const Branch& front = state.model.branches[branches.front()];
        state.in_lockstep = has_energy(state.model, front);
        for (const std::size_t k : branches) {
            const Branch& branch = state.model.branches[k];
            state.in_lockstep = state.in_lockstep && series::same_drivers(front, branch) &&
                                branch.to != 0 && std::isfinite(branch.to);
        }
        if (state.in_lockstep) prepare(lane, front);
        if (state.in_lockstep) settles = settles || !state.at_rest || !starts_as_drawn(front);
    });
    if (settles) {
        solve_branch(group, Drive::start, true);
        each(in_lockstep(), [&](LaneState& state, int) {
            SteppingState& s = *state.stepping;
            if (s.start.Phi_d.norm() <= guard::closed) s.start.Phi_d.setZero();
            if (settled(s, Outcome::converged, 0.0) != Outcome::converged)
                state.in_lockstep = false;
        });
    }
    solve_branch(group, Drive::rate, !settles);
}

// Writes the present pieces of a lane's curves into the equations and the inputs.
void Pack::use_pieces(series::Equations<Lanes>& e, int lane) {
    LaneState& state = lanes[static_cast<std::size_t>(lane)];
    for (const series::CurvePiece& f : state.curves) {
        const auto piece = static_cast<std::size_t>(f.piece);
        series::CubicSeries<Lanes>& cubic = series::cubic_of(e, f.elastic, f.axis);
        for (std::size_t k = 0; k < 4; ++k) set_lane(cubic.c[k], lane, f.curve->pieces[piece][k]);
        set_lane(cubic.about, lane, f.curve->knots[piece == 0 ? 0 : piece - 1]);
        series::set_piece(f, state.stepping->inputs);
    }
}

void Pack::start_at_design(series::Equations<Lanes>& e, Drive drive,
                           const std::vector<LaneEnds>& ends) {
    each(in_lockstep(), [&](LaneState& state, int) { set_parameter(*state.stepping, drive, 0); });
    if (e.curved) {
        each(in_lockstep(), [&](LaneState& state, int lane) {
            series::begin(e, state.stepping->q, state.stepping->lambda, 0, lane);
        });
        evaluate(e, {0, series::Pass::known});
        each(in_lockstep(), [&](LaneState& state, int lane) {
            for (series::CurvePiece& f : state.curves)
                f.piece =
                    piece_at<double>(*f.curve, series::deformation(e, f.elastic, f.axis, 0)[lane]);
            use_pieces(e, lane);
        });
    }
    each(in_lockstep(), [&](LaneState& state, int lane) {
        SteppingState& s = *state.stepping;
        for (const auto& end : ends) {
            set_parameter(s, drive, end[static_cast<std::size_t>(lane)]);
            state.in_lockstep =
                state.in_lockstep &&
                !(drive == Drive::start ? loads_idle_mode(s)
                                        : check_idle_load_here(s, 0) != Outcome::converged);
        }
        set_parameter(s, drive, 0);
        if (!state.in_lockstep) return;
        e.curved ? assemble(lane) : load_matrix(lane);  // without curves that of prepare()
    });
    // The first elimination gives the held directions of the variant, the second holds them.
    if (design.system.held.size() > 0) {
        factorise(in_lockstep(), false);
        each(in_lockstep(), [&](LaneState&, int lane) { load_matrix(lane); });
    }
    factorise(in_lockstep(), true);
}

// Computes the polynomials about the states of the lanes, with the factors of the last elimination.
void Pack::expand(series::Equations<Lanes>& e, series::Coefficients<Lanes>& c, Drive drive,
                  const LaneEnds& to) {
    const SaddlePoint<double>& saddle_point = design.system;
    const int n = saddle_point.n, m = saddle_point.m;
    each(in_lockstep(), [&](LaneState& state, int lane) {
        SteppingState& s = *state.stepping;
        series::begin(e, s.q, s.lambda, series::parameter(s, drive), lane);
        drive_at(s, drive, 1.0, s.q, s.lambda);
        load_rhs(lane);
    });
    evaluate(e, {0, series::Pass::known});
    solve(lu, rhs.data(), solution.data());
    for (int k = 0; k < n + m; ++k)
        c.unit[k] = solution[static_cast<std::size_t>(k)] * Lanes(saddle_point.scale[k]);
    c.x.setZero();
    for (int row = 0; row < m; ++row)
        c.x(n + row, 0) = e.lambda[static_cast<std::size_t>(row)].c[0];
    c.load.setZero();
    c.load[0] = e.a.c[0];
    c.load[1] = each_lane([&](int lane) { return to[static_cast<std::size_t>(lane)]; });
    for (int k = 0; k < n + m; ++k) c.x(k, 1) = c.load[1] * c.unit[k];
    x = c.x.col(1);
    Lanes corrected = 0;  // 1 in lanes that lose digits, else 0
    series::compute_orders(
        e, c, x,
        series::OrderSteps{
            [&] {
                for (int k = 0; k < n; ++k)
                    rhs[static_cast<std::size_t>(k)] = e.G[k] * Lanes(-saddle_point.scale[k]);
                for (int k = 0; k < m; ++k)
                    rhs[static_cast<std::size_t>(n + k)] =
                        e.Phi[k] * Lanes(-saddle_point.scale[n + k]);
                solve(lu, rhs.data(), solution.data());
                for (int k = 0; k < n + m; ++k)
                    x[k] = solution[static_cast<std::size_t>(k)] * Lanes(saddle_point.scale[k]);
            },
            [](int) {},
            [&](auto&& correct) {
                correct();
                Lanes correction = 0, whole = 0;
                for (int k = 0; k < n; ++k) {
                    correction += x[k] * x[k];
                    whole += c.x(k, 1) * c.x(k, 1);
                }
                each(in_lockstep(), [&](LaneState&, int lane) {
                    const bool too_large =
                        !(std::sqrt(correction[lane]) <= loses_digits * std::sqrt(whole[lane]));
                    set_lane(corrected, lane, too_large ? 1 : 0);
                });
                for (int k = 0; k < n + m; ++k) c.x(k, 1) += x[k] - only_where(corrected, x[k]);
                return !is_zero(corrected);
            },
            // A lane that loses no digits keeps its x_k to the last bit beside one that does.
            [&] {
                for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = only_where(corrected, x[k]);
            },
            // All orders: which of them suffice would depend on the other lanes.
            [](int) { return false; }});
}

// Shortens the range of a lane to where the first deformation leaves its piece. The variant leaves
// the lane where one does so at τ = 0: its expansion began on the wrong piece.
static void stop_at_knots(LaneState& state, const series::KnotTolerance& near) {
    std::vector<series::PieceExit> met;
    std::vector<std::size_t> crossed;
    state.crossings.clear();
    const auto column = [&](std::size_t k) {
        return Eigen::VectorXd(state.deformations.col(static_cast<Eigen::Index>(k)));
    };
    const double reach = state.tau_end;
    for (std::size_t k = 0; k < state.curves.size(); ++k)
        if (const auto exit = series::exit_from_piece(column(k), state.curves[k], reach, near)) {
            met.push_back(*exit);
            crossed.push_back(k);
            if (exit->wrong_piece) state.in_lockstep = false;
            if (exit->tau < state.tau_end) {
                state.tau_end = exit->tau;
                state.ends_side = false;
            }
        }
    // Several deformations may reach their knots at the same τ.
    for (std::size_t k = 0; k < met.size(); ++k)
        if (met[k].tau <= state.tau_end ||
            series::is_at_knot(column(crossed[k]), state.curves[crossed[k]], met[k].direction,
                               state.tau_end, near))
            state.crossings.emplace_back(crossed[k], met[k].direction);
}

// Range of validity of a lane's polynomial. The variant leaves the lane near a limit point.
void Pack::find_range(const series::Coefficients<Lanes>& c, int lane, Drive drive, double to) {
    LaneState& state = lanes[static_cast<std::size_t>(lane)];
    SteppingState& s = *state.stepping;
    for (Eigen::Index k = 0; k < c.x.size(); ++k) state.expansion.x.data()[k] = c.x.data()[k][lane];
    for (Eigen::Index k = 0; k < c.load.size(); ++k) state.expansion.load[k] = c.load[k][lane];
    state.expansion_point = s.q;
    const series::Singularity nearest = series::nearest_singularity(s, state.expansion);
    const double tolerance = options.series.tolerance, per_unit = s.setup.length / std::abs(to),
                 tau = series::reach(s, state.expansion, tolerance, per_unit, nearest.radius),
                 rest = (to - series::parameter(s, drive)) / to;
    state.ends_side = tau >= rest;
    state.tau_end = state.ends_side ? rest : tau;
    if (!(tau > 0) || !(tau >= 1e-9)) {
        state.in_lockstep = false;
        return;
    }
    const bool reaches_end = state.ends_side;
    stop_at_knots(state, {s.setup.length, 0.1 * tolerance, 10 * tolerance});
    constexpr double close = 1e-4;
    const bool straight_ahead = nearest.angle < 1e-3 && nearest.misfit < 1e-2;
    if (!reaches_end && nearest.radius < close && straight_ahead) state.in_lockstep = false;
}

// Records the points of the branch in the accepted range.
void Pack::sample(int lane, std::size_t branch) {
    LaneState& state = lanes[static_cast<std::size_t>(lane)];
    SteppingState& s = *state.stepping;
    EquilibriumPath& path = state.paths[branch];
    const auto points = static_cast<std::size_t>(options.points);
    const double to = state.model.branches[branch].to, end = s.a;
    const Vector<double>& load = state.expansion.load;
    const auto load_at = [&](std::size_t k) {
        return to * static_cast<double>(k) / static_cast<double>(options.points);
    };
    constexpr double eps = std::numeric_limits<double>::epsilon();
    std::size_t count = 0;
    powers.resize(state.expansion.x.cols(), static_cast<Eigen::Index>(points) + 1);
    for (; state.next_point + count <= points; ++count) {
        const double a = load_at(state.next_point + count), tau = (a - load[0]) / load[1],
                     slack = 1e-12 * state.tau_end +
                             4 * eps * (std::abs(a) + std::abs(load[0])) / std::abs(load[1]);
        if (!state.ends_side && tau > state.tau_end + slack) break;
        double power = 1;
        const double t = std::clamp(tau, 0.0, state.tau_end);
        for (Eigen::Index k = 0; k < powers.rows(); ++k, power *= t)
            powers(k, static_cast<Eigen::Index>(count)) = power;
    }
    values.noalias() = state.expansion.x * powers.leftCols(static_cast<Eigen::Index>(count));
    for (std::size_t k = 0; k < count; ++k) {
        const auto at_tau = values.col(static_cast<Eigen::Index>(k));
        Equilibrium& to_point = path.points[state.next_point + k];
        point = state.expansion_point;
        series::displace(state.expansion_point, at_tau, point);
        to_point.load = load_at(state.next_point + k);
        if (options.wrenches) {
            set_parameter(s, Drive::rate, to_point.load);
            const Vector<double> lambda = at_tau.tail(s.m());
            record(s.model, s.inputs, point, {lambda, point}, to_point);
        } else {
            for (BodyId b = 0; b < point.bodies(); ++b)
                to_point.poses[static_cast<std::size_t>(b)] = {point[b].r, point[b].p};
            to_point.constraint_error = std::numeric_limits<double>::quiet_NaN();
        }
    }
    state.next_point += count;
    if (options.wrenches) set_parameter(s, Drive::rate, end);
}

// Changes to the pieces behind the knots at the ends of the ranges.
void Pack::cross_knots(series::Equations<Lanes>& e) {
    Mask jumping{};
    each(under_way(), [&](LaneState& state, int lane) {
        for (const auto& [k, direction] : state.crossings)
            if (series::cross_knot(state.curves[k], direction))
                jumping[static_cast<std::size_t>(lane)] = true;
        if (state.crossings.empty()) return;
        use_pieces(e, lane);
        if (jumping[static_cast<std::size_t>(lane)]) assemble(lane);
    });
    if (std::ranges::count(jumping, true) == 0) return;
    factorise(jumping, false);
    each(jumping, [&](LaneState& state, int lane) {
        state.in_lockstep =
            state.in_lockstep && static_cast<int>(lu.sign[lane]) == state.sign_at_start;
        state.log_det = log_determinant(lu, lane);
    });
}

std::vector<LaneEnds> Pack::load_group(std::size_t group, Drive drive) {
    const bool rate = drive == Drive::rate;
    series::Equations<Lanes>& e = rate ? equations[group].rate : equations[group].start;
    const std::vector<std::size_t>& branches = groups[group];
    std::vector<LaneEnds> ends(rate ? branches.size() : 1);
    for (auto& end : ends) end.fill(1);
    each(in_lockstep(), [&](LaneState& state, int lane) {
        const auto k = static_cast<std::size_t>(lane);
        series::take(e, state.model, state.branch, lane);
        for (std::size_t side = 0; rate && side < ends.size(); ++side)
            ends[side][k] = state.model.branches[branches[side]].to;
        for (Eigen::Index row = 0; !rate && row < e.G_d.size(); ++row)
            set_lane(e.G_d[row], lane, -state.stepping->start.R_d[row]);
        for (Eigen::Index row = 0; !rate && row < e.Phi_d.size(); ++row)
            set_lane(e.Phi_d[row], lane, state.stepping->start.Phi_d[row]);
    });
    series::settle_on_constants(e);
    return ends;
}

void Pack::keep_start(const series::Equations<Lanes>& e) {
    each(in_lockstep(), [&](LaneState& state, int lane) {
        read_deformations(e, state, lane);
        state.deformations_at_start = state.deformations;
        state.curves_at_start = state.curves;
        state.q_start = state.stepping->q;
        state.lambda_start = state.stepping->lambda;
        state.sign_at_start = static_cast<int>(lu.sign[lane]);
        state.log_det_at_start = log_determinant(lu, lane);
    });
}

// The expansion at the start of another side is that of the first side in another unit of τ:
// coefficient k times rᵏ, r the quotient of the sides' ends.
void Pack::begin_side(series::Equations<Lanes>& e, Drive drive, const std::vector<LaneEnds>& ends,
                      std::size_t side) {
    expansion = start_expansion;
    const auto share = [&](int lane) {
        const auto k = static_cast<std::size_t>(lane);
        return ends[side][k] / ends.front()[k];
    };
    if (side > 0) {
        const Lanes shares = each_lane(share);
        Lanes power = 1;
        for (Eigen::Index k = 1; k < expansion.x.cols(); ++k) {
            power *= shares;
            for (Eigen::Index row = 0; row < expansion.x.rows(); ++row)
                expansion.x(row, k) *= power;
        }
        expansion.load[1] *= shares;
    }
    each(in_lockstep(), [&](LaneState& state, int lane) {
        state.stepping->q = state.q_start;
        state.stepping->lambda = state.lambda_start;
        set_parameter(*state.stepping, drive, 0);
        state.log_det = state.log_det_at_start;
        state.deformations = state.deformations_at_start;
        state.curves = state.curves_at_start;
        use_pieces(e, lane);
        double power = 1;
        for (Eigen::Index row = 0; row < state.deformations.rows(); ++row) {
            state.deformations.row(row) *= power;
            power *= share(lane);
        }
        state.under_way = true;
        state.next_point = 0;
    });
}

void Pack::clear_paths(std::size_t branch) {
    each(in_lockstep(), [&](LaneState& state, int) {
        EquilibriumPath& path = state.paths[branch];
        path.outcome = Outcome::converged;
        path.detail.clear();
        const Equilibrium blank{0, std::vector<Pose>(state.model.bodies.size()),
                                std::vector<Wrench>(state.model.joints.size()), 0};
        path.points.resize(static_cast<std::size_t>(options.points) + 1, blank);
    });
}

void Pack::measure_middle(Drive drive) {
    each(under_way(), [&](LaneState& state, int lane) {
        move_to(state, drive, state.tau_end / 2);
        assemble(lane);
    });
    factorise(under_way(), false);
    each(under_way(), [&](LaneState& state, int lane) {
        state.det_ratio_at_middle = static_cast<int>(lu.sign[lane]) == state.sign_at_start
                                        ? std::exp2(log_determinant(lu, lane) - state.log_det)
                                        : -1;
    });
}

void Pack::solve_branch(std::size_t group, Drive drive, bool from_design) {
    const bool rate = drive == Drive::rate;
    series::Equations<Lanes>& e = rate ? equations[group].rate : equations[group].start;
    const std::vector<std::size_t>& branches = groups[group];
    const std::vector<LaneEnds> ends = load_group(group, drive);
    if (from_design)
        start_at_design(e, drive, ends);
    else
        each(in_lockstep(), [&](LaneState& state, int lane) {
            set_parameter(*state.stepping, drive, 0);
            use_pieces(e, lane);
        });
    expand(e, start_expansion, drive, ends.front());
    Matrix<Lanes> softest_at_start, softest;
    if (rate) judge_start(softest_at_start);
    keep_start(e);
    for (std::size_t side = 0; side < ends.size(); ++side) {
        softest = softest_at_start;
        begin_side(e, drive, ends, side);
        if (rate) clear_paths(branches[side]);
        int knots = 0;
        for (const auto& f : lanes.front().curves) knots += static_cast<int>(f.curve->knots.size());
        const int max_expansions = options.series.expansions * (1 + knots);
        for (int k = 0; std::ranges::count(under_way(), true) > 0; ++k) {
            if (k == max_expansions) {
                each(under_way(), [](LaneState& state, int) { state.in_lockstep = false; });
                break;
            }
            if (k > 0) {
                expand(e, expansion, drive, ends[side]);
                each(under_way(),
                     [&](LaneState& state, int lane) { read_deformations(e, state, lane); });
            }
            each(under_way(), [&](LaneState&, int lane) {
                find_range(expansion, lane, drive, ends[side][static_cast<std::size_t>(lane)]);
            });
            if (rate) measure_middle(drive);
            correct_ends(drive, ends[side]);
            check_ends(rate, softest);
            each(under_way(), [&](LaneState& state, int lane) {
                if (rate) sample(lane, branches[side]);
                state.under_way = !state.ends_side;
                if (state.under_way || !rate) return;
                state.paths[branches[side]].counts = state.stepping->counts;
                if (state.next_point != static_cast<std::size_t>(options.points) + 1)
                    state.in_lockstep = false;
            });
            cross_knots(e);
        }
    }
}

}  // namespace elastocheck::recursive::batch
