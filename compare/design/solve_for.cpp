#include "compare/design/solve_for.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/design/least_squares.hpp"
#include "elastocheck/compile.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::array weights_of_change{1e-2, 1e-4, 1e-6};  // μ

// [r; μ x] and [J; μ I]
VectorXd stacked(const VectorXd& r, double mu, const VectorXd& x) {
    VectorXd all(r.size() + x.size());
    all << r, mu * x;
    return all;
}
MatrixXd stacked(const MatrixXd& J, double mu) {
    MatrixXd all(J.rows() + J.cols(), J.cols());
    all << J, mu * MatrixXd::Identity(J.cols(), J.cols());
    return all;
}

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
            if (!(effect > 1e-10 * (1 + std::abs(values[k])))) continue;
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
    const Index n = range.size(), m = wishes.target.size();
    Solution found;
    found.p = wishes.start;
    found.before = found.after = figures.value(found.p);
    if (!found.before.allFinite()) return found;
    found.gradient = figures.gradient(found.p);
    found.movement = (found.gradient.rate * range.asDiagonal()).rowwise().norm();
    bool moves = true;
    for (Index j = 0; j < m; ++j) {
        const double rounding = 1e-10 * (1 + std::abs(found.before[j]));
        found.still.push_back(!(found.movement[j] > rounding));
        moves = moves && !found.still.back();
    }
    if (!moves) return found;

    const auto number_at = [&](const VectorXd& x) -> VectorXd {
        return wishes.start + range.cwiseProduct(x);
    };
    const Box box{(wishes.low - wishes.start).cwiseQuotient(range),
                  (wishes.high - wishes.start).cwiseQuotient(range)};
    const VectorXd weight = found.movement.cwiseInverse();
    VectorXd x = VectorXd::Zero(n).cwiseMax(box.low).cwiseMin(box.high);
    Minimum nearest;
    for (const double mu : weights_of_change) {
        const LeastSquares problem{
            [&](const VectorXd& at) {
                const VectorXd f = figures.value(number_at(at));
                return stacked(VectorXd((f - wishes.target).cwiseProduct(weight)), mu, at);
            },
            [&](const VectorXd& at) {
                return stacked(MatrixXd(weight.asDiagonal() * figures.gradient(number_at(at)).rate *
                                        range.asDiagonal()),
                               mu);
            }};
        nearest = minimise(problem, x, box);
        found.iterations += nearest.iterations;
        x = nearest.x;
    }
    const VectorXd r = nearest.residual.head(m);
    found.converged = nearest.converged;
    // A number at its limit has exactly that value.
    found.p = number_at(x).cwiseMax(wishes.low).cwiseMin(wishes.high);
    found.after = figures.value(found.p);
    found.met = r.allFinite() && r.cwiseAbs().maxCoeff() <= met_within;
    found.conflict = found.met ? VectorXd::Zero(m) : VectorXd(r.cwiseAbs() / r.norm());
    const VectorXd descent = -nearest.jacobian.topRows(m).transpose() * r;
    for (Index i = 0; i < n; ++i) {
        const bool outwards = !found.met && std::abs(descent[i]) > 1e-6 * r.norm();
        found.at_limit.push_back(!outwards                               ? 0
                                 : x[i] <= box.low[i] && descent[i] < 0  ? -1
                                 : x[i] >= box.high[i] && descent[i] > 0 ? 1
                                                                         : 0);
    }
    return found;
}

}  // namespace elastocheck::compare
