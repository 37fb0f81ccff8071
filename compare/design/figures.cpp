#include "compare/design/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "compare/comparison/legs.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/sensitivity/sensitivity.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double legs_agree = 1e-6;  // of a figure's movement

// Reason why the trim of a scene is not reached; empty if it is.
std::string why_not_trimmed(const Trimmed& trimmed) {
    return !trimmed.record || trimmed.record->reached() ? "" : "trim: " + trimmed.record->detail;
}

// Rates of the figures of one branch.
struct BranchGradient {
    const Scene& scene;
    const Trimmed& trimmed;
    const Model& model;
    const VaryingScene& varying;
    std::span<const Figure> figures;
    FigureGradient& result;
    std::vector<Channel> outputs = {};
    std::vector<bool> changes = {};             // of `outputs`: counted from the design position
    std::map<std::size_t, double> places = {};  // of the figures
    std::string why = {};  // of the first rate that is missing, with its figure and number

    // Position in `outputs`, where it is added.
    Index output(const std::string& name, bool change) {
        for (std::size_t c = 0; c < outputs.size(); ++c)
            if (outputs[c].name == name && changes[c] == change) return static_cast<Index>(c);
        const auto all = figure_outputs(model);
        outputs.push_back(all[static_cast<std::size_t>(find_channel(all, name))]);
        changes.push_back(change);
        return std::ssize(outputs) - 1;
    }
    void place(const std::string& branch) {
        std::vector<std::size_t> which;
        std::vector<Figure> over;
        for (std::size_t k = 0; k < figures.size(); ++k) {
            if (figures[k].branch != branch) continue;
            if (figures[k].over.empty())
                places[k] = figures[k].at;
            else
                which.push_back(k), over.push_back(figures[k]);
        }
        if (over.empty()) return;
        const FigureValues found = evaluate(model, over, Leg::equilibrium);
        why = found.why_not;
        for (std::size_t i = 0; i < which.size(); ++i)
            if (const double a = found.place[static_cast<Index>(i)]; std::isfinite(a))
                places[which[i]] = a;
    }
    void add(const std::string& branch) {
        place(branch);
        if (places.empty()) return;
        GradientOptions options{.branches = {branch}, .legs = {Leg::equilibrium}};
        for (const auto& [k, a] : places) {
            output(figures[k].name, figures[k].change);
            options.stations[branch].push_back(a);
            if (figures[k].over.empty()) continue;
            output(figures[k].over, false);
            options.by_parameter = true;
        }
        options.changes = changes;
        const Gradients found = gradients(scene, trimmed, model, varying, outputs, options);
        for (const SideGradients& side : found.sides) {
            const LegGradients& leg = side.legs.front();
            if (why.empty()) why = leg.failure;
            for (const auto& [k, a] : places)
                for (std::size_t s = 0; s < leg.at.size(); ++s)
                    if (side.a[s] == a) row(k, leg.at[s], side.why_number[s]);
        }
    }
    void row(std::size_t k, const MatrixXd& at, const std::vector<std::string>& reasons) {
        const Figure& figure = figures[k];
        const auto n = std::ssize(varying.numbers);
        const Index y = output(figure.name, figure.change);
        Eigen::RowVectorXd rate = at.row(y).head(n);
        if (!figure.over.empty()) {
            const Index x = output(figure.over, false);
            // a branch that drives x has the same x at the same parameter, whatever the number
            rate -= at(y, n) / at(x, n) * at.row(x).head(n);
        }
        result.rate.row(static_cast<Index>(k)) = rate;
        for (Index p = 0; p < n && why.empty(); ++p)
            if (!std::isfinite(rate[p])) {
                const auto& reason = reasons[static_cast<std::size_t>(p)];
                why = fmt::format("{} on branch '{}' by {}: {}", figure.name, figure.branch,
                                  varying.numbers[static_cast<std::size_t>(p)].path,
                                  reason.empty() ? "it is not defined there" : reason);
            }
    }
};

}  // namespace

FigureValues figure_values(const Scene& scene, std::span<const Figure> figures, Leg leg) {
    const Trimmed trimmed = trim(scene);
    const VectorXd none = VectorXd::Constant(std::ssize(figures), nan);
    if (const auto why = why_not_trimmed(trimmed); !why.empty()) return {none, none, why};
    return evaluate(compile(trimmed.scene), figures, leg);
}

FigureGradient figure_gradient(const Scene& scene, const VaryingScene& varying,
                               std::span<const Figure> figures, int threads) {
    const Trimmed trimmed = trim(scene);
    FigureGradient result{MatrixXd::Constant(std::ssize(figures), std::ssize(varying.numbers), nan),
                          why_not_trimmed(trimmed)};
    if (!result.why_not.empty()) return result;
    const Model model = compile(trimmed.scene);
    std::vector<std::string> why(model.branches.size());
    std::vector<Job> jobs;
    for (std::size_t b = 0; b < model.branches.size(); ++b)
        jobs.push_back({model.branches[b].name, [&, b] {
                            BranchGradient on{scene, trimmed, model, varying, figures, result};
                            on.add(model.branches[b].name);
                            why[b] = on.why;
                        }});
    run_jobs(jobs, threads, {});
    if (!result.rate.allFinite())
        for (const std::string& reason : why)
            if (result.why_not.empty()) result.why_not = reason;
    return result;
}

Confirmation confirm(const Scene& scene, std::span<const Figure> figures,
                     const std::vector<std::string>& units, const VectorXd& values,
                     const VectorXd& movement) {
    Confirmation result;
    std::string& why = result.why_not;
    bool judged = false;
    for (const auto leg : {Leg::energy, Leg::series}) {
        const FigureValues found = figure_values(scene, figures, leg);
        (leg == Leg::energy ? result.energy : result.series) = found.value;
        if (found.not_applicable) continue;
        judged = true;
        for (std::size_t k = 0; k < figures.size(); ++k) {
            const auto i = static_cast<Index>(k);
            const double apart = std::abs(found.value[i] - values[i]);
            if (why.empty() && std::isfinite(apart) && !(apart <= legs_agree * movement[i]))
                why = fmt::format("{}: the {} differs by {:.2g} {}", figures[k].name,
                                  leg == Leg::energy ? "energy leg" : "series", apart, units[k]);
        }
        if (why.empty()) why = found.why_not;
        if (why.empty() && !found.value.allFinite()) why = "a figure has no value by another leg";
    }
    if (why.empty() && !judged) why = "no other leg applies to the scene";
    result.confirmed = why.empty();
    return result;
}

Figures solved_figures(SceneAt scene_at, std::vector<Number> numbers, std::vector<Figure> figures,
                       int threads) {
    const auto value = [scene_at, figures](const VectorXd& p) -> VectorXd {
        try {
            return figure_values(scene_at(p), figures, Leg::equilibrium).value;
        } catch (const std::runtime_error&) {  // no such scene: a negative rate, points that meet
            return VectorXd::Constant(static_cast<Index>(figures.size()), nan);
        }
    };
    const auto gradient = [scene_at, numbers, figures, threads](const VectorXd& p) {
        try {
            VaryingScene varying{{}, [&](std::size_t k, double by) {
                                     const auto at = static_cast<Index>(k);
                                     return scene_at(p + by * VectorXd::Unit(p.size(), at));
                                 }};
            for (Index k = 0; k < p.size(); ++k) {
                Number number = numbers[static_cast<std::size_t>(k)];
                number.value = p[k];
                varying.numbers.push_back(varied_number(number));
            }
            return figure_gradient(scene_at(p), varying, figures, threads);
        } catch (const std::runtime_error& error) {
            return FigureGradient{MatrixXd::Constant(std::ssize(figures), p.size(), nan),
                                  error.what()};
        }
    };
    return {value, gradient};
}

double step_of(const Number& number) { return varied_number(number).step; }

}  // namespace elastocheck::compare
