#include "compare/sensitivity/sensitivity.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/comparison/trim.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/outputs/deformation.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/rates.hpp"
#include "elastocheck/compile.hpp"
#include "models/branch.hpp"
#include "models/eigen/dense.hpp"
#include "models/kinds.hpp"
#include "recursive/diagnosis/analysis.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Coordinates up to which the energy leg costs less than the two others together.
constexpr int cheap_for_the_energy_leg = 60;
// Number of parts of all models that are in memory at a time.
constexpr std::size_t held_at_a_time = 100000;

// ---- The changing numbers, then the adjustments of the trim.

// Whether the adjustments of a trim follow from its conditions at a fixed state. With balanced bushings
// a trim is found again for each changed number.
bool adjusts(const Trimmed& trimmed) {
    return trimmed.record && trimmed.record->bushings == Trim::Bushings::unloaded;
}

// Found adjustments, SI.
VectorXd adjusted(const Trimmed& trimmed) {
    if (!adjusts(trimmed)) return {};
    VectorXd x(std::ssize(trimmed.record->adjusted));
    for (Index k = 0; k < x.size(); ++k) {
        const auto& one = trimmed.record->adjusted[static_cast<std::size_t>(k)];
        x[k] = one.change / in_unit(one.unit);
    }
    return x;
}

Changed with_adjustments(Scene scene, const VectorXd& x) {
    if (scene.trim && x.size() == 0) {
        const Trimmed again = trim_by_series(scene);
        if (!again.record->reached()) throw std::invalid_argument("trim: " + again.record->detail);
        return {compile(again.scene), {}};
    }
    if (x.size() == 0) return {compile(scene), {}};
    std::optional<Trim> trim = scene.trim;
    return {compile(with_adjusted(std::move(scene), x)), std::move(trim)};
}

std::vector<Changing> all_changing(const Scene& scene, const Trimmed& trimmed,
                                   const VaryingScene& varying) {
    const VectorXd x = adjusted(trimmed);
    std::vector<Changing> changing;
    for (std::size_t k = 0; k < varying.numbers.size(); ++k)
        changing.push_back(
            {[&varying, x, k](double by) { return with_adjustments(varying.with(k, by), x); },
             difference_step(varying.numbers[k]), varying.numbers[k].step});
    for (Index k = 0; k < x.size(); ++k) {
        const Unit unit = trimmed.record->adjusted[static_cast<std::size_t>(k)].unit;
        const double h = unit == Unit::mm    ? 2e-5
                         : unit == Unit::deg ? 3e-4
                                             : 1;  // [m, rad, N, N·m]
        changing.push_back({[&scene, x, k](double by) {
                                return with_adjustments(scene,
                                                        x + by * VectorXd::Unit(x.size(), k));
                            },
                            h, 100 * h});
    }
    return changing;
}

// The parameter of the branch, as if it were a number: all drivers start later.
Changing by_parameter(const BranchSide& side) {
    const double step = std::abs(side.branch.to) / 100;
    return {[&side](double by) {
                Changed changed{side.model, {}};
                for (Driver& driver : changed.model.branches.front().drivers)
                    driver.start += by * driver.rate;
                return changed;
            },
            step / 100, step};
}

// ---- What is read.

Outputs outputs_of(std::span<const Channel> outputs, const std::vector<bool>& changes) {
    Outputs result{{outputs.begin(), outputs.end()}, {}};
    // only outputs of channels() read points and numbers that differ between the models
    result.placed = [list = result.channels, changes](const Model& model,
                                                      const std::optional<Trim>&) {
        Outputs::Placed placed{{}, VectorXd::Zero(std::ssize(list))};
        const auto every = channels(model);
        for (std::size_t c = 0; c < list.size(); ++c) {
            Channel here = list[c];
            if (const int at = find_channel(every, here.name); at >= 0)
                here.reads = every[static_cast<std::size_t>(at)].reads;
            if (!changes.empty() && changes[c])
                placed.from[static_cast<Index>(c)] =
                    evaluate(model, std::span(&here, 1), design_state(model)).front();
            placed.reads.push_back(here.reads);
        }
        return placed;
    };
    return result;
}

// The conditions of a trim, counted from what it asks.
Outputs conditions_of(const Trim& trim, const Model& model) {
    return {condition_channels(model, trim),
            [as_read = trim](const Model& on_side, const std::optional<Trim>& changed) {
                const Trim& asked = changed ? *changed : as_read;
                const auto list = condition_channels(on_side, asked);
                Outputs::Placed placed{{}, VectorXd::Zero(std::ssize(list))};
                const auto drawn = evaluate(on_side, list, design_state(on_side));
                for (std::size_t c = 0; c < list.size(); ++c) {
                    const auto& value = asked.until[c].value;
                    placed.reads.push_back(list[c].reads);
                    placed.from[static_cast<Index>(c)] =
                        value ? in_unit(list[c].unit) * *value : drawn[c];
                }
                return placed;
            }};
}

// The branch without drivers, whose start is the trimmed state.
BranchSide at_rest(const Model& model) {
    Branch branch;
    branch.name = "trim";
    branch.to = 1;
    branch.steps = 1;
    branch.unit = ParameterUnit::none;
    return {"trim", on_branch(model, branch), branch, {}};
}

// Reason why an output of an element has no derivative: an idle mode deforms the element at the design
// position and turns its axes, so that no component is determined. Empty for other outputs.
std::string idle_motion_of(const BranchSide& side, const Channel& output) {
    constexpr double moves = 1e-9, h = 1e-5;  // [m, rad] of a unit motion
    const auto* of = std::get_if<ElementComponent>(&output.reads);
    if (of == nullptr || side.analysis->diagnosis.idle.empty()) return {};
    const auto element = static_cast<std::size_t>(of->element);
    const Index axes = member<ScalarLaw>(side.model.elastics[element].kind) != nullptr ? 1 : 6;
    const Equilibrium drawn = design_state(side.model);
    const auto deformed_by = [&](const VectorXd& dq) {
        std::vector<Increment> motion;
        for (Index b = 0; b < dq.size(); b += 6)
            motion.push_back({dq.segment<3>(b), dq.segment<3>(b + 3)});
        return deformation(side.model.elastics[element].kind, element, side.branch,
                           compare::moved_by(drawn, motion, 1));
    };
    for (const auto& mode : side.analysis->diagnosis.idle) {
        const VectorXd dq = mode.dq;
        const Vector6 rate = (deformed_by(h * dq) - deformed_by(-h * dq)) / (2 * h);
        if (rate.head(axes).cwiseAbs().maxCoeff() > moves)
            return "it takes part in a motion that nothing resists: " + mode.description;
    }
    return {};
}

// The values on this side of a branch, from its start on; the start is on the first side.
std::vector<double> on_this_side(std::vector<double> values, const BranchSide& side, bool first) {
    std::erase_if(values, [&](double a) { return a == 0 ? !first : !(a * side.branch.to > 0); });
    std::ranges::sort(values, {}, [](double a) { return std::abs(a); });
    const auto again = std::ranges::unique(values);
    values.erase(again.begin(), again.end());
    return values;
}

// ---- The sides of the branches.

struct SideWork {
    ReadSide read;
    SideGradients result;
    std::vector<std::vector<Equilibrium>> states = {};  // per leg and station
    std::vector<Analyses> analyses = {};                // per leg
    std::vector<std::vector<Rates>> rates = {};         // per leg and station, of all columns
    std::vector<double> stations = {};                  // chosen ones

    void follow(std::span<const Leg> used) {
        analyses.resize(used.size());
        for (std::size_t l = 0; l < used.size(); ++l) {
            LegGradients& by = result.legs.emplace_back();
            by.leg = used[l];
            auto& found = states.emplace_back();
            const auto visit = [&](const Equilibrium& state) { found.push_back(state); };
            const EquilibriumPath path = stations.empty()
                                             ? solve_branch(read.side, {.leg = used[l]}, visit)
                                             : solve_at(read.side, used[l], stations, visit);
            if (path.outcome != Outcome::converged) {
                by.failure = fmt::format("{}: {}", elastocheck::name(path.outcome), path.detail);
                by.not_applicable = is_not_applicable(path.outcome);
            }
            if (l > 0) continue;
            for (const Equilibrium& state : found) {
                result.a.push_back(state.load + 0.0);  // no -0
                result.values.push_back(row_of(read.side.model, read.outputs.channels, read.side,
                                               {.leg = used[l]}, state, analyses[l])
                                            .values);
            }
        }
    }
    // The state of the start alone, for the conditions of a trim.
    void stay(std::span<const Leg> used) {
        analyses.resize(used.size());
        for (const Leg leg : used) {
            result.legs.emplace_back().leg = leg;
            states.push_back(settle_start(read.side, leg).points);
        }
    }
    // Appends the columns of these numbers.
    void differentiate(std::span<const Changing> numbers, std::span<const Compiled> points) {
        std::vector<Neighbouring> near;
        for (const Compiled& of_number : points) near.push_back(on_side(of_number, read));
        rates.resize(states.size());
        for (std::size_t l = 0; l < states.size(); ++l) {
            rates[l].resize(states[l].size());
            for (std::size_t s = 0; s < states[l].size(); ++s)
                append(rates[l][s], rates_at({read, result.legs[l].leg, states[l][s]}, numbers,
                                             near, l == 0, analyses[l]));
        }
    }

  private:
    static void append(MatrixXd& to, const MatrixXd& more, Index rows, Index before,
                       Index columns) {
        if (to.size() == 0 && more.size() == 0) return;
        if (to.size() == 0) to = MatrixXd::Constant(rows, before, nan);
        to.conservativeResize(rows, before + columns);
        to.rightCols(columns) =
            more.size() == 0 ? MatrixXd(MatrixXd::Constant(rows, columns, nan)) : more;
    }
    static void append(Rates& to, const Rates& more) {
        const Index rows = more.at.rows(), before = to.at.cols(), columns = more.at.cols();
        append(to.at, more.at, rows, before, columns);
        append(to.rounding, more.rounding, rows, before, columns);
        append(to.one_sided.growing, more.one_sided.growing, rows, before, columns);
        append(to.one_sided.falling, more.one_sided.falling, rows, before, columns);
        to.why.insert(to.why.end(), more.why.begin(), more.why.end());
    }
};

std::vector<SideWork> sides_to_follow(const Model& model, std::span<const Channel> outputs,
                                      const GradientOptions& options) {
    std::vector<SideWork> works;
    for (const Branch& branch : model.branches) {
        if (!options.branches.empty() && std::ranges::count(options.branches, branch.name) == 0)
            continue;
        bool first_side = true;
        for (BranchSide side : sides_of(model, branch, options.points)) {
            const bool chosen = options.stations.contains(branch.name);
            SideWork work;
            if (chosen)
                work.stations = on_this_side(options.stations.at(branch.name), side, first_side);
            first_side = false;
            if (chosen && work.stations.empty()) continue;
            side.analysis =
                std::make_shared<const recursive::Analysis>(recursive::analyse(side.model));
            work.result.name = side.name;
            work.result.branch = branch.name;
            work.result.unit = unit_of(side.branch.unit);
            const auto active = active_channels(outputs, side.model);
            Analyses as_drawn;
            const auto drawn =
                evaluate(side.model, side, outputs, design_state(side.model), as_drawn);
            for (std::size_t c = 0; c < outputs.size(); ++c)
                work.result.why_output.push_back(!active[c] ? "its joint is inactive on this branch"
                                                 : !outputs[c].joints().empty() &&
                                                         drawn[c] == undefined
                                                     ? why_undefined(outputs[c])
                                                     : idle_motion_of(side, outputs[c]));
            work.read = {std::move(side), outputs_of(outputs, options.changes)};
            works.push_back(std::move(work));
        }
    }
    return works;
}

// ---- The columns of the numbers, from those of numbers and adjustments.

// dx/dp of the adjustments x by one leg, SI per unit of the number, with its rounding; NaN where none.
struct Adjusting {
    MatrixXd dx, rounding;
};
Adjusting adjusting(const Rates& conditions, Index numbers) {
    const Index n = conditions.at.rows();
    const MatrixXd J = conditions.at.middleCols(numbers, n);
    if (!J.allFinite()) return {MatrixXd::Constant(n, numbers, nan), MatrixXd::Zero(n, numbers)};
    const MatrixXd inverse = inverse_of(Eigen::PartialPivLU<MatrixXd>(J)),
                   dx = -matrix_product(inverse, conditions.at.leftCols(numbers));
    return {dx, matrix_product(
                    inverse.cwiseAbs(),
                    conditions.rounding.leftCols(numbers) +
                        matrix_product(conditions.rounding.middleCols(numbers, n), dx.cwiseAbs()))};
}

// `all`: numbers, adjustments, then perhaps the parameter. A number that moves no adjustment takes
// none of their derivatives, which may be undefined.
MatrixXd with_adjustments(const MatrixXd& all, Index numbers, const MatrixXd& dx) {
    if (all.size() == 0) return all;
    MatrixXd total(all.rows(), all.cols() - dx.rows());
    total << all.leftCols(numbers), all.rightCols(all.cols() - numbers - dx.rows());
    for (Index k = 0; k < numbers; ++k)
        for (Index j = 0; j < dx.rows(); ++j)
            if (dx(j, k) != 0) total.col(k) += dx(j, k) * all.col(numbers + j);
    return total;
}

// Sets the gradients of a side: the columns of numbers with their part through the trim, zero within
// rounding.
void take(SideWork& work, Index numbers, const std::vector<Adjusting>& adjusting) {
    SideGradients& result = work.result;
    for (std::size_t l = 0; l < work.rates.size(); ++l) {
        const MatrixXd& dx = adjusting[l].dx;
        const MatrixXd off = (dx.array() != 0).select(adjusting[l].rounding, 0);
        for (const Rates& at : work.rates[l]) {
            MatrixXd moved = at.at.cwiseAbs();
            if (moved.size() > 0) moved.leftCols(numbers).setZero();
            MatrixXd rounding = with_adjustments(at.rounding, numbers, dx.cwiseAbs());
            rounding.leftCols(numbers) += with_adjustments(moved, numbers, off).leftCols(numbers);
            const MatrixXd all = with_adjustments(at.at, numbers, dx);
            result.legs[l].at.push_back((all.array().abs() <= rounding.array()).select(0, all));
            result.legs[l].rounding.push_back(std::move(rounding));
            if (l > 0) continue;
            result.one_sided.push_back({with_adjustments(at.one_sided.growing, numbers, dx),
                                        with_adjustments(at.one_sided.falling, numbers, dx)});
            auto& why = result.why_number.emplace_back(at.why);
            why.resize(static_cast<std::size_t>(numbers));
            for (Index k = 0; k < numbers && dx.rows() > 0; ++k)
                if (auto& reason = why[static_cast<std::size_t>(k)];
                    reason.empty() && !dx.col(k).allFinite())
                    reason = "the trim has no derivative by it";
        }
    }
}

// The largest entry of every output's row by the first leg, each number by its step.
std::vector<double> row_sizes(const Gradients& gradients, const SideGradients& side) {
    std::vector<double> sizes(gradients.outputs.size(), 0);
    for (std::size_t c = 0; c < sizes.size(); ++c) {
        if (!side.why_output[c].empty()) continue;
        for (const MatrixXd& at : side.legs.front().at)
            for (std::size_t k = 0; k < gradients.numbers.size(); ++k) {
                const double entry = std::abs(at(static_cast<Index>(c), static_cast<Index>(k)) *
                                              gradients.numbers[k].step);
                if (entry > sizes[c]) sizes[c] = entry;
            }
    }
    return min_sizes(gradients.outputs, std::move(sizes));
}

Disagreement compared(const Gradients& gradients, const SideGradients& side) {
    Disagreement worst;
    const auto sizes = row_sizes(gradients, side);
    const LegGradients& first = side.legs.front();
    for (const LegGradients& other : std::span(side.legs).subspan(1)) {
        if (other.not_applicable) continue;
        for (std::size_t s = 0; s < std::min(first.at.size(), other.at.size()); ++s)
            for (std::size_t c = 0; c < sizes.size(); ++c) {
                if (!side.why_output[c].empty()) continue;
                for (std::size_t k = 0; k < gradients.numbers.size(); ++k) {
                    const auto row = static_cast<Index>(c), column = static_cast<Index>(k);
                    const double a = first.at[s](row, column), b = other.at[s](row, column);
                    if ((std::isnan(a) && std::isnan(b)) || !side.why_number[s][k].empty())
                        continue;
                    ++worst.compared;
                    const double rounding = first.rounding[s](row, column) +
                                            other.rounding[s](row, column),
                                 distance = std::abs(a - b) * gradients.numbers[k].step,
                                 off = distance - rounding * gradients.numbers[k].step,
                                 share = off <= 0 ? 0 : off / sizes[c];
                    worst.whole = std::max(worst.whole, distance / sizes[c]);
                    if (share <= worst.share || std::isnan(worst.share)) continue;
                    worst.share = share;
                    worst.where = fmt::format("{} by {} at {:g} {}: {} {:.12g}, {} {:.12g}",
                                              gradients.outputs[c].name, gradients.numbers[k].path,
                                              in_unit(side.unit) * side.a[s], symbol(side.unit),
                                              name(first.leg), a, name(other.leg), b);
                }
            }
    }
    return worst;
}

std::vector<Leg> legs_for(const Model& model, const std::vector<Leg>& asked) {
    if (!asked.empty()) return asked;
    if (6 * std::ssize(model.bodies) <= cheap_for_the_energy_leg)
        return {Leg::equilibrium, Leg::energy, Leg::series};
    return {Leg::equilibrium, Leg::series};
}

}  // namespace

std::vector<std::string> SideGradients::not_confirmed() const {
    std::vector<std::string> reasons;
    for (const LegGradients& by : legs)
        if (!by.failure.empty() && !by.not_applicable)
            reasons.push_back(
                fmt::format("{}: {} leg: {}", name, compare::name(by.leg), by.failure));
    if (!worst.agrees())
        reasons.push_back(fmt::format("{}: {}, which differ by {:.1e} of the largest of the row",
                                      name, worst.where, worst.share));
    return reasons;
}

std::vector<std::string> Gradients::not_confirmed() const {
    std::vector<std::string> reasons;
    long compared = 0;
    for (const SideGradients& side : sides) {
        std::ranges::move(side.not_confirmed(), std::back_inserter(reasons));
        compared += side.worst.compared;
    }
    if (compared == 0) reasons.emplace_back("no derivative was compared");
    return reasons;
}

Gradients gradients(const Scene& scene, const Trimmed& trimmed, const Model& model,
                    const VaryingScene& varying, std::span<const Channel> outputs,
                    const GradientOptions& options) {
    const GradientGroup group{{outputs.begin(), outputs.end()}, options};
    return std::move(gradients(scene, trimmed, model, varying, std::span(&group, 1)).front());
}

std::vector<Gradients> gradients(const Scene& scene, const Trimmed& trimmed, const Model& model,
                                 const VaryingScene& varying,
                                 std::span<const GradientGroup> groups) {
    const GradientOptions& options = groups.front().options;
    const auto used = legs_for(model, options.legs);
    std::vector<Gradients> of_groups;
    std::vector<SideWork> sides;
    std::vector<std::size_t> group_of;  // of each side
    for (const GradientGroup& group : groups) {
        std::ranges::move(sides_to_follow(model, group.outputs, group.options),
                          std::back_inserter(sides));
        group_of.resize(sides.size(), of_groups.size());
        of_groups.push_back({group.outputs, varying.numbers, {}});
    }
    const auto on_every_side = [&](const std::function<void(SideWork&)>& run) {
        std::vector<Job> jobs;
        for (SideWork& side : sides) jobs.push_back({side.result.name, [&] { run(side); }});
        run_jobs(jobs, options.threads, [&](std::string_view what, double) {
            if (options.progress) options.progress(std::string(what));
        });
    };
    on_every_side([&](SideWork& side) { side.follow(used); });
    const bool trims = adjusts(trimmed);
    if (trims) {
        SideWork& start = sides.emplace_back();
        start.read.side = at_rest(model);
        start.read.side.analysis =
            std::make_shared<const recursive::Analysis>(recursive::analyse(start.read.side.model));
        start.read.outputs = conditions_of(*scene.trim, start.read.side.model);
        start.result.name = "trim";
        start.stay(used);
    }

    const auto changing = all_changing(scene, trimmed, varying);
    const std::size_t parts = model.bodies.size() + model.joints.size() + model.elastics.size() +
                              model.constraints.size(),
                      together = std::max<std::size_t>(1, held_at_a_time / (4 * parts + 1));
    for (std::size_t from = 0; from < changing.size(); from += together) {
        const auto numbers =
            std::span(changing).subspan(from, std::min(together, changing.size() - from));
        std::vector<Compiled> points(numbers.size());
        std::vector<Job> jobs;
        for (std::size_t k = 0; k < numbers.size(); ++k)
            jobs.push_back({"models", [&, k] { points[k] = compiled(numbers[k]); }});
        run_jobs(jobs, options.threads, {});
        for (Gradients& of_group : of_groups)
            for (std::size_t k = from; k < std::min(from + numbers.size(), varying.numbers.size());
                 ++k) {
                of_group.numbers[k].side = points[k - from].side;
                of_group.numbers[k].undefined = points[k - from].undefined;
            }
        on_every_side([&](SideWork& side) { side.differentiate(numbers, points); });
    }
    std::vector<Adjusting> dx(used.size());
    const auto numbers = std::ssize(varying.numbers);
    if (trims) {
        const SideWork start = std::move(sides.back());
        sides.pop_back();
        for (std::size_t l = 0; l < used.size(); ++l)
            dx[l] = start.rates[l].empty()
                        ? Adjusting{MatrixXd::Constant(std::ssize(scene.trim->until), numbers, nan),
                                    MatrixXd::Zero(std::ssize(scene.trim->until), numbers)}
                        : adjusting(start.rates[l].front(), numbers);
    }
    on_every_side([&](SideWork& side) {
        const std::size_t group = group_of[static_cast<std::size_t>(&side - sides.data())];
        if (groups[group].options.by_parameter) {
            const Changing parameter = by_parameter(side.read.side);
            const Compiled points = compiled(parameter);
            side.differentiate({&parameter, 1}, {&points, 1});
        }
        take(side, numbers, dx);
        if (std::ssize(used) > 1) side.result.worst = compared(of_groups[group], side.result);
    });
    for (std::size_t k = 0; k < sides.size(); ++k)
        of_groups[group_of[k]].sides.push_back(std::move(sides[k].result));
    return of_groups;
}

}  // namespace elastocheck::compare
