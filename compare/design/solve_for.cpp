#include "compare/design/solve_for.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "compare/design/least_squares.hpp"
#include "elastocheck/compile.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::array weights_of_change{1e-2, 1e-4, 1e-6};  // μ

}  // namespace

std::vector<std::string> why_still(const SceneAt& scene_at, const Figure& figure,
                                   const std::vector<Number>& numbers, const VectorXd& p) {
    const Scene scene = scene_at(p);
    // All outputs of the state at the same station.
    std::vector<Figure> all;
    const Model model = compile(scene);
    for (const Channel& channel : channels(model)) {
        all.push_back(figure);
        all.back().name = channel.name;
    }
    const Figures outputs = solved_figures(scene_at, numbers, all);
    const VectorXd values = outputs.value(p);
    const FigureGradient gradient = outputs.gradient(p);
    std::vector<std::string> reasons;
    for (Index i = 0; i < p.size(); ++i) {
        const Number& number = numbers[static_cast<std::size_t>(i)];
        std::string why = "no output moves with it";
        for (const Omission& omission : scene.omitted) {
            const auto name = omission.what.find('\'');
            const std::string_view quoted =
                std::string_view(omission.what).substr(std::min(name + 1, omission.what.size()));
            const auto part = quoted.substr(0, quoted.find('\''));
            if (!part.empty() &&
                number.path.find("." + std::string(part) + ".") != std::string::npos)
                why = fmt::format("{} is left out: {}", omission.what, omission.why);
        }
        for (Index k = 0; k < values.size(); ++k) {
            const double effect = std::abs(gradient.rate(k, i)) * step_of(number);
            if (!(effect > least_movement(values[k]))) continue;
            const std::string& moved = all[static_cast<std::size_t>(k)].name;
            why = fmt::format("it moves {}, for example, and not {}", moved, figure.name);
            break;
        }
        reasons.push_back(number.path + ": " + why);
    }
    return reasons;
}

Solution solve_for(const Figures& figures, const Wishes& wishes) {
    const VectorXd range = wishes.high - wishes.low;
    Solution found{.p = wishes.start, .before = figures.value(wishes.start)};
    found.after = found.before;
    if (!found.before.allFinite()) return found;
    found.gradient = figures.gradient(found.p);
    if (!found.gradient.rate.allFinite()) return found;
    found.movement = (found.gradient.rate * range.asDiagonal()).rowwise().norm();
    for (Index j = 0; j < found.movement.size(); ++j)
        found.still.push_back(!(found.movement[j] > least_movement(found.before[j])));
    if (std::ranges::count(found.still, true) > 0) return found;

    const auto number_at = [&](const VectorXd& x) -> VectorXd {
        return within({wishes.low, wishes.high}, wishes.start + range.cwiseProduct(x));
    };
    const VectorXd weight = found.movement.cwiseInverse();
    LeastSquares problem{
        [&](const VectorXd& x) -> VectorXd {
            return (figures.value(number_at(x)) - wishes.target).cwiseProduct(weight);
        },
        [&](const VectorXd& x) -> MatrixXd {
            return weight.asDiagonal() * figures.gradient(number_at(x)).rate * range.asDiagonal();
        },
        {(wishes.low - wishes.start).cwiseQuotient(range),
         (wishes.high - wishes.start).cwiseQuotient(range)},
        VectorXd::Zero(range.size())};
    Minimum nearest{.x = within(problem.box, problem.about)};
    for (const double mu : weights_of_change) {
        problem.pull = mu;
        nearest = minimise(problem, nearest.x);
    }
    found.converged = nearest.converged;
    found.p = number_at(nearest.x);
    found.after = figures.value(found.p);
    const VectorXd r = nearest.residual.cwiseAbs();
    found.met = r.allFinite() && r.maxCoeff() <= met_within;
    found.conflict = found.met ? VectorXd::Zero(r.size()) : VectorXd(r / r.norm());
    found.at_limit =
        found.met ? std::vector<int>(wishes.start.size(), 0) : limits_reached(problem, nearest);
    return found;
}

}  // namespace elastocheck::compare
