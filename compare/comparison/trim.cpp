#include "elastocheck/trim.hpp"
#include "compare/comparison/trim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "compare/comparison/legs.hpp"
#include "compare/comparison/trim_once.hpp"
#include "compare/deviation/agreement.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/deformation.hpp"
#include "elastocheck/compile.hpp"
#include "models/branch.hpp"
#include "models/eigen/dense.hpp"
#include "models/overloaded.hpp"
#include "models/structure.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/series/path.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int max_iterations = 30;
constexpr int max_halvings = 10;
// |c| at which the conditions are met [m, rad]: the accuracy of the states x(p).
constexpr double condition_tolerance = 1e-12;
// A step h that changes the conditions by less has no effect on them [m, rad].
constexpr double min_effect = 1e-10;
// Largest ratio of |c| after and before an iteration with the J of another scene.
constexpr double contraction = 0.5;
// Smallest ratio of two singular values that is not zero: the accuracy of the differences.
constexpr double min_singular_ratio = 1e-6;

// The trim equations c(x(p)) = 0 (elastocheck/trim.hpp): p the adjustments, x(p) the equilibrium with
// them, c the values of the conditions less their targets.
struct TrimProblem {
    const Trim* trim = nullptr;
    BranchSide side;                                // branch on which the adjustments are constant
    std::vector<Channel> channels;                  // read by the conditions
    VectorXd at_design_position, target;            // values of the conditions [m, rad]
    Leg solver = Leg::equilibrium;                  // computes the equilibria x(p)
    std::shared_ptr<recursive::Analysis> analysis;  // of the series, with its last settled state
};

struct TrimAttempt {
    Outcome outcome = Outcome::converged;
    std::string detail;
    Equilibrium state;
    VectorXd residual;  // c(x(p)) [m, rad]
};

Channel channel_of(const Model& model, const ConditionKind& kind) {
    const Equilibrium drawn = design_state(model);
    const auto coordinate_from_design = [&](const Point& at, int axis) {
        Channel channel{.name = "", .reads = Coordinate{at, axis}};
        const double from = evaluate(model, {&channel, 1}, drawn).front() / in_unit(Unit::mm);
        std::get<Coordinate>(channel.reads).counted_from = from;
        return channel;
    };
    return std::visit(
        overloaded{[&](const WheelTravel& c) {
                       const Wheel& wheel = model.wheels[static_cast<std::size_t>(c.wheel)];
                       return coordinate_from_design({wheel.body, wheel.centre_local}, 2);
                   },
                   [&](const WheelToe& c) {
                       return figure_channel(model, figure::toe, static_cast<std::size_t>(c.wheel));
                   },
                   [&](const WheelCamber& c) {
                       return figure_channel(model, figure::camber,
                                             static_cast<std::size_t>(c.wheel));
                   },
                   [&](const ProbeCoordinate& c) {
                       return coordinate_from_design(
                           model.probes[static_cast<std::size_t>(c.probe)].at, c.axis);
                   }},
        kind);
}

// Values of the conditions at a state [m, rad]: c plus the targets.
VectorXd condition_values(const TrimProblem& problem, const Equilibrium& state) {
    const auto shown = evaluate(problem.side.model, problem.channels, state);
    VectorXd value(static_cast<Index>(shown.size()));
    for (std::size_t k = 0; k < shown.size(); ++k)
        value[static_cast<Index>(k)] = shown[k] / in_unit(problem.channels[k].unit);
    return value;
}

}  // namespace

std::vector<Channel> condition_channels(const Model& model, const Trim& trim) {
    std::vector<Channel> list;
    for (const auto& condition : trim.until) list.push_back(channel_of(model, condition.what));
    return list;
}

namespace {

// The scene with one branch whose drivers are the adjustments. They move until compile() is done, which
// would leave out a driver at rest.
TrimProblem trim_problem(const Scene& scene) {
    TrimProblem problem;
    problem.trim = &*scene.trim;
    Scene held = scene;
    Branch branch{
        .name = "trim", .from = 0, .to = 1, .steps = 1, .unit = ParameterUnit::none, .drivers = {}};
    for (const auto& adjustment : problem.trim->adjust)
        branch.drivers.push_back({adjustment.what, 0, 1});
    held.branches = {branch};
    Model model = compile(held);
    if (model.branches.front().drivers.size() != branch.drivers.size()) {
        std::string why;
        for (const auto& omission : model.omitted)
            if (omission.why.find("(branch 'trim')") != std::string::npos) why = omission.what;
        throw std::invalid_argument(
            fmt::format("the adjusted quantities have no influence on any output{}{}",
                        why.empty() ? "" : ": ", why));
    }
    for (auto& driver : model.branches.front().drivers) driver.rate = 0;
    problem.side = {"trim", on_branch(model, model.branches.front()), model.branches.front()};
    problem.channels = condition_channels(problem.side.model, *problem.trim);
    const VectorXd at_design_position = condition_values(problem, design_state(problem.side.model));
    problem.at_design_position = problem.target = at_design_position;
    for (std::size_t k = 0; k < problem.trim->until.size(); ++k)
        if (const auto& value = problem.trim->until[k].value)
            problem.target[static_cast<Index>(k)] = *value;
    return problem;
}

// The branch with the adjustments p, constant.
BranchSide side_with_adjustments(const TrimProblem& problem, const VectorXd& p) {
    BranchSide side = problem.side;
    for (std::size_t k = 0; k < side.branch.drivers.size(); ++k)
        side.branch.drivers[k].start = problem.trim->adjust[k].per_unit * p[static_cast<Index>(k)];
    side.model.branches = {side.branch};
    return side;
}

// Equilibrium x(p) by a solver, and the residual c(x(p)); only the outcome if there is no equilibrium.
TrimAttempt settle(const TrimProblem& problem, const VectorXd& p, Leg leg) {
    BranchSide held = side_with_adjustments(problem, p);
    if (problem.analysis && leg == Leg::series) {
        recursive::series::keep_start(held.model, held.branch, {}, *problem.analysis);
        held.analysis = problem.analysis;
    }
    const EquilibriumPath path = settle_start(held, leg);
    if (path.points.empty()) return {path.outcome, path.detail, {}, {}};
    return {Outcome::converged, "", path.points.front(),
            condition_values(problem, path.points.front()) - problem.target};
}

// Step h of the differences (elastocheck/trim.hpp), in the unit of the adjustment.
double step(const Trim::Adjustment& adjustment) {
    const double h = std::visit(overloaded{[](const Load&) { return 10.0; },        // [N]
                                           [](const Motion&) { return 1e-4; },      // [m, rad]
                                           [](const FreeLength&) { return 1e-4; },  // [m]
                                           [](const Preload& l) {
                                               return 10 / std::max(1e-30, l.direction.norm());
                                           }},  // [N, N·m]
                                adjustment.what);
    return h / std::abs(adjustment.per_unit);
}

// c(x(p + h e_k)) - c(x(p - h e_k)), h the step of adjustment k. The series computes each of the two states
// anew; a reference reaches both along a branch that moves the adjustment, from one start. Empty if the
// solver failed, which `failed` describes.
std::optional<VectorXd> central_difference(const TrimProblem& problem, const VectorXd& p, Index k,
                                           TrimAttempt& failed) {
    const auto& adjustment = problem.trim->adjust[static_cast<std::size_t>(k)];
    const double h = step(adjustment);
    std::array<VectorXd, 2> residual;  // at p + h, p - h
    if (problem.solver == Leg::series) {
        for (const int side : {0, 1}) {
            const double change = side == 0 ? h : -h;
            failed = settle(problem, p + change * VectorXd::Unit(p.size(), k), problem.solver);
            if (failed.outcome != Outcome::converged) return std::nullopt;
            residual[static_cast<std::size_t>(side)] = failed.residual;
        }
        return residual[0] - residual[1];
    }
    BranchSide along = side_with_adjustments(problem, p);
    along.branch.drivers[static_cast<std::size_t>(k)].rate = adjustment.per_unit * h;
    along.model.branches = {along.branch};
    constexpr std::array both{1.0, -1.0};
    const EquilibriumPath path =
        solve_at(along, problem.solver, both, [&](const Equilibrium& state) {
            residual[state.load > 0 ? 0 : 1] = condition_values(problem, state) - problem.target;
        });
    failed = {path.outcome, path.detail, {}, {}};
    if (path.outcome != Outcome::converged) return std::nullopt;
    return residual[0] - residual[1];
}

// J [conditions × adjustments]: change of each condition with one step h of each adjustment [m, rad]. Empty
// if the solver failed, which `failed` describes.
std::optional<MatrixXd> condition_jacobian(const TrimProblem& problem, const VectorXd& p,
                                           TrimAttempt& failed) {
    MatrixXd J(static_cast<Index>(problem.channels.size()), p.size());
    for (Index k = 0; k < p.size(); ++k) {
        const auto change = central_difference(problem, p, k, failed);
        if (!change) return std::nullopt;
        J.col(k) = 0.5 * *change;
    }
    return J;
}

std::string listed(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t k = 0; k < names.size(); ++k)
        text += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + names[k];
    return text;
}

// Names whose share in a combination exceeds a twentieth of the largest.
template <class Entry>
std::vector<std::string> names_of_contributors(const std::vector<Entry>& all,
                                               const VectorXd& share) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < all.size(); ++k)
        if (std::abs(share[static_cast<Index>(k)]) > 0.05 * share.cwiseAbs().maxCoeff())
            names.push_back(all[k].name);
    return names;
}

// Names the adjustment or condition that makes the trim ill-posed; empty if none does.
std::string ill_posed(const Trim& trim, const MatrixXd& J) {
    MatrixXd scaled = J;
    for (Index k = 0; k < J.cols(); ++k) {
        const double size = J.col(k).norm();
        if (!(size > min_effect))
            return fmt::format(
                "'{}' has no influence on {}: adjust another quantity, or choose a condition that "
                "it changes",
                trim.adjust[static_cast<std::size_t>(k)].name,
                listed(names_of_contributors(trim.until, VectorXd::Ones(J.rows()))));
        scaled.col(k) /= size;
    }
    for (Index k = 0; k < J.rows(); ++k) {
        if (!(J.row(k).norm() > min_effect))
            return fmt::format(
                "no adjustment changes '{}': {} does not",
                trim.until[static_cast<std::size_t>(k)].name,
                listed(names_of_contributors(trim.adjust, VectorXd::Ones(J.cols()))));
        scaled.row(k).normalize();
    }
    const Svd svd = svd_of(scaled, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const VectorXd& s = svd.values;
    if (s[s.size() - 1] > min_singular_ratio * s[0]) return {};
    return fmt::format(
        "ambiguous: {} change only together, whatever {} do; a condition that separates these is "
        "missing",
        listed(names_of_contributors(trim.until, svd.U.rightCols<1>())),
        listed(names_of_contributors(trim.adjust, svd.V.rightCols<1>())));
}

// ---- Result as plain data and as text.

void apply(const Trim& trim, const VectorXd& p, Scene& scene) {
    for (std::size_t k = 0; k < trim.adjust.size(); ++k) {
        const double change = trim.adjust[k].per_unit * p[static_cast<Index>(k)];
        std::visit(
            overloaded{
                [](const Load&) {},
                [&](const Motion& m) {
                    std::visit(overloaded{[&](Distance& j) { j.length += change; },
                                          [&](InPlane& j) { j.offset += change; },
                                          [&](Angle& j) { j.angle += change; }, [](auto&) {}},
                               scene.joints[static_cast<std::size_t>(m.joint)].kind);
                },
                [&](const FreeLength& l) {
                    std::get<AxialSpring>(scene.elastics[static_cast<std::size_t>(l.elastic)].kind)
                        .free_length += change;
                },
                [&](const Preload& l) {
                    std::get<Bushing>(scene.elastics[static_cast<std::size_t>(l.elastic)].kind)
                        .preload += change * l.direction;
                }},
            trim.adjust[k].what);
    }
    scene.trim.reset();
}

// TrimRecord::Adjustment::resulting of an adjusted quantity; `driven` is its driver in the model.
std::string resulting_value(const Scene& scene, const Driven& adjusted, const TrimProblem& problem,
                            const Driven& driven, const BranchSide& held,
                            const Equilibrium& state) {
    return std::visit(
        overloaded{
            [](const Load&) { return std::string(); },
            [&](const Motion& m) {
                const JointKind& kind = scene.joints[static_cast<std::size_t>(m.joint)].kind;
                return std::visit(
                    overloaded{[](const Distance& j) {
                                   return fmt::format("length {:.6g} mm", 1e3 * j.length);
                               },
                               [](const InPlane& j) {
                                   return fmt::format("offset {:.6g} mm", 1e3 * j.offset);
                               },
                               [](const Angle& j) {
                                   return fmt::format("angle {:.6g} deg",
                                                      in_unit(Unit::deg) * j.angle);
                               },
                               [](const auto&) { return std::string(); }},
                    kind);
            },
            [&](const FreeLength& l) {
                const auto& spring =
                    std::get<AxialSpring>(scene.elastics[static_cast<std::size_t>(l.elastic)].kind);
                const auto element = static_cast<std::size_t>(std::get<FreeLength>(driven).elastic);
                const ElasticKind& elastic = problem.side.model.elastics[element].kind;
                const double f =
                    force(elastic, deformation(elastic, element, held.branch, state))[0];
                return fmt::format("force {:.6g} N in {}, free length {:.6g} mm", std::abs(f),
                                   f < 0 ? "compression" : "tension", 1e3 * spring.free_length);
            },
            [&](const Preload& l) {
                const auto& bushing =
                    std::get<Bushing>(scene.elastics[static_cast<std::size_t>(l.elastic)].kind);
                const double size = bushing.preload.dot(l.direction) / l.direction.norm();
                return fmt::format("preload {:.6g} {} along it", size,
                                   l.direction.head<3>().isZero(0) ? "N·m" : "N");
            }},
        adjusted);
}

// An iterate of the solution of the trim equations.
struct TrimIteration {
    VectorXd p, h;  // adjustments, and the steps of their differences
    MatrixXd J;     // the last one
    TrimAttempt current = {};
    int iterations = 0;
    std::string stop_reason = {};  // why the iteration ended early: "; at the next iterate: ..."

    bool meets_conditions() const {
        return current.outcome == Outcome::converged &&
               current.residual.norm() <= condition_tolerance;
    }
    // Adjustments p + h s, s the steps in units of h.
    VectorXd after_step(const VectorXd& s) const { return p + h.cwiseProduct(s); }
};

// Broyden's method (1965) from p and J of another scene: with J s = -c and Δc the change of c by the
// step s, J ← J + (Δc - J s) sᵀ / sᵀs = J + c_next sᵀ / sᵀs.
void iterate_from(const TrimStart& start, const TrimProblem& problem, TrimIteration& it) {
    it.p = start.p;
    it.J = start.J;
    it.current = settle(problem, it.p, problem.solver);
    for (; it.current.outcome == Outcome::converged &&
           it.current.residual.norm() > condition_tolerance;
         ++it.iterations) {
        const VectorXd s = solve_by_qr(it.J, -it.current.residual);
        TrimAttempt next = settle(problem, it.after_step(s), problem.solver);
        if (next.outcome != Outcome::converged ||
            !(next.residual.norm() < contraction * it.current.residual.norm()))
            break;
        it.p = it.after_step(s);
        it.J += next.residual * s.transpose() / s.squaredNorm();
        it.current = std::move(next);
    }
}

// Adds the first of dp, dp/2, dp/4, ... to p that decreases |c|; returns false if none does.
// Unreachable conditions lead to a singular state, beyond which rounding decides which are met.
bool step_with_halving(const TrimProblem& problem, const VectorXd& dp, TrimIteration& it) {
    TrimAttempt next;
    double share = 1;
    for (int halvings = 0; halvings <= max_halvings; ++halvings, share /= 2) {
        next = settle(problem, it.p + share * dp, problem.solver);
        if (next.outcome == Outcome::converged &&
            next.residual.norm() < it.current.residual.norm()) {
            it.p += share * dp;
            it.current = std::move(next);
            ++it.iterations;
            return true;
        }
    }
    if (next.outcome != Outcome::converged)
        it.stop_reason = fmt::format("; at the next iterate: {}: {}",
                                     elastocheck::name(next.outcome), next.detail);
    return false;
}

// Newton's method with J by differences. `check_J`: J is computed and checked even where the
// conditions are met at once, since they may be met by chance with p undetermined. Returns the failed
// attempt if a neighbour of the first iterate does not settle.
std::optional<TrimAttempt> iterate(const TrimProblem& problem, bool check_J, TrimIteration& it) {
    for (bool check_conditioning = check_J;
         check_conditioning || it.current.residual.norm() > condition_tolerance;
         check_conditioning = false) {
        TrimAttempt failed;
        const auto J = condition_jacobian(problem, it.p, failed);
        if (!J && it.iterations == 0) return failed;
        if (!J) {
            it.stop_reason = fmt::format("; at a neighbouring state: {}: {}",
                                         elastocheck::name(failed.outcome), failed.detail);
            break;
        }
        it.J = *J;
        if (const std::string why = ill_posed(*problem.trim, *J); !why.empty()) {
            // Well-posed at an earlier iterate: the iteration has reached the limit of what
            // can be trimmed.
            if (it.iterations == 0 || it.current.residual.norm() <= accepted_residual)
                throw std::invalid_argument(why);
            it.stop_reason = "; at that state " + why;
            break;
        }
        if (!(it.current.residual.norm() > condition_tolerance) || it.iterations == max_iterations)
            break;
        const VectorXd dp = it.h.cwiseProduct(solve_by_qr(*J, -it.current.residual));
        if (!step_with_halving(problem, dp, it)) break;
    }
    return std::nullopt;
}

// Computes the equilibrium of the trimmed scene by the energy leg, or by the series if that is not
// applicable, and records the residuals of the conditions. Returns the attempt if it did not converge.
std::optional<TrimAttempt> confirm_trim(const TrimProblem& problem, const TrimIteration& it,
                                        const BranchSide& held, TrimRecord& record) {
    record.confirmed_by = Leg::energy;
    TrimAttempt second = settle(problem, it.p, Leg::energy);
    if (is_not_applicable(second.outcome)) {
        record.confirmed_by = Leg::series;
        second = settle(problem, it.p, Leg::series);
    }
    if (second.outcome != Outcome::converged) return second;
    const Bounds bounds = bounds_of({}, scale_of(held.model, held.branch, {&it.current.state, 1}));
    for (std::size_t k = 0; k < record.conditions.size(); ++k) {
        auto& c = record.conditions[k];
        c.confirming_residual = in_unit(c.unit) * second.residual[static_cast<Index>(k)];
        const double bound = c.unit == Unit::deg ? bounds.angle : bounds.length;
        if (!(std::isfinite(c.confirming_residual) && std::abs(c.confirming_residual) <= bound))
            record.detail = fmt::format(
                "not confirmed: the {} leg misses '{}' by {:.3g} {}, at most {:.3g} is allowed",
                name(record.confirmed_by), c.name, c.confirming_residual, symbol(c.unit), bound);
    }
    return std::nullopt;
}

// Records by how much each condition is missed; false beyond `accepted_residual`, with the reason.
bool record_conditions(const TrimProblem& problem, const TrimIteration& it, TrimRecord& record) {
    for (std::size_t k = 0; k < problem.trim->until.size(); ++k) {
        const Unit unit = problem.channels[k].unit;
        const auto i = static_cast<Index>(k);
        record.conditions.push_back({problem.trim->until[k].name, unit,
                                     in_unit(unit) * problem.target[i],
                                     in_unit(unit) * it.current.residual[i], std::nan("")});
    }
    if (it.current.residual.norm() <= accepted_residual) return true;
    const auto worst = std::ranges::max_element(record.conditions, {}, [](const auto& c) {
        return std::abs(c.residual) / in_unit(c.unit);
    });
    record.outcome = Outcome::iteration_limit;
    record.detail =
        fmt::format("the conditions cannot be met: the closest iterate misses '{}' by {:.3g} {}{}",
                    worst->name, worst->residual, symbol(worst->unit), it.stop_reason);
    return false;
}

}  // namespace

Scene with_adjusted(Scene scene, const VectorXd& p) {
    const Trim trim = *scene.trim;  // apply() resets that of the scene
    apply(trim, p, scene);
    return scene;
}

VectorXd requested_from_drawn(const Scene& scene) {
    const TrimProblem problem = trim_problem(scene);
    return problem.target - problem.at_design_position;
}

Trimmed trim_once(const Scene& scene, Leg solver, bool confirm, TrimStart* start,
                  SettledTrim* settled) {
    Trimmed result{scene, std::nullopt};
    const Trim& trim = *scene.trim;
    if (trim.adjust.size() != trim.until.size() || trim.adjust.empty())
        throw std::invalid_argument(
            fmt::format("{} adjusted quantities for {} conditions; their numbers must be equal",
                        trim.adjust.size(), trim.until.size()));
    TrimProblem problem = trim_problem(scene);
    problem.solver = solver;
    std::vector<int> parts;
    structure(problem.side.model, parts);
    const bool is_similar = start != nullptr && start->structure == parts;
    if (solver == Leg::series) {
        const auto last = is_similar ? start->settled : nullptr;
        problem.analysis = std::make_shared<recursive::Analysis>(
            recursive::analyse(problem.side.model, last ? last->system.lu.order : nullptr));
        problem.analysis->settled = last;
    }
    TrimRecord& record = result.record.emplace();
    const auto give_up = [&](const TrimAttempt& attempt, const std::string& where) {
        record.outcome = attempt.outcome;
        record.detail =
            fmt::format("{}: {}: {}", where, elastocheck::name(attempt.outcome), attempt.detail);
        return result;
    };

    TrimIteration it{.p = VectorXd::Zero(static_cast<Index>(trim.adjust.size())), .h = {}, .J = {}};
    it.h = it.p;
    for (std::size_t k = 0; k < trim.adjust.size(); ++k)
        it.h[static_cast<Index>(k)] = step(trim.adjust[k]);
    const Index n = it.p.size();
    if (is_similar && start->J.rows() == n && start->J.cols() == n)
        iterate_from(*start, problem, it);
    const bool start_meets_conditions = it.J.size() > 0 && it.meets_conditions();
    if (!start_meets_conditions) {
        it.p.setZero();
        it.iterations = 0;
        it.current = settle(problem, it.p, problem.solver);
    }
    if (it.current.outcome != Outcome::converged)
        return give_up(it.current, "the scene has no settled equilibrium before the trim");
    if (const auto failed = iterate(problem, !start_meets_conditions, it))
        return give_up(*failed, "at a neighbouring state");
    record.iterations = it.iterations;
    if (!record_conditions(problem, it, record)) return result;

    const BranchSide held = side_with_adjustments(problem, it.p);
    record.confirmed_by =
        Leg::series;  // stays where no second reference confirms the trim (trim.hpp)
    if (confirm) {
        if (const auto failed = confirm_trim(problem, it, held, record))
            return give_up(*failed,
                           fmt::format("not confirmed: the {} leg", name(record.confirmed_by)));
        if (!record.detail.empty()) return result;
    }

    if (start != nullptr)
        *start = {it.p, it.J, std::move(parts),
                  problem.analysis ? problem.analysis->settled : start->settled};
    if (settled != nullptr) *settled = {held, it.current.state};
    apply(trim, it.p, result.scene);
    for (std::size_t k = 0; k < trim.adjust.size(); ++k) {
        const auto& adjusted = trim.adjust[k];
        const Unit unit = unit_of(adjusted.unit);
        record.adjusted.push_back(
            {adjusted.name, unit, in_unit(unit) * it.p[static_cast<Index>(k)],
             resulting_value(result.scene, adjusted.what, problem,
                             problem.side.branch.drivers[k].what, held, it.current.state)});
    }
    return result;
}

}  // namespace elastocheck::compare
