#include "reports/live/wishes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "compare/comparison/trim.hpp"
#include "compare/design/solve_for.hpp"
#include "compare/outputs/curve.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "elastocheck/compile.hpp"
#include "reports/live/outputs.hpp"

namespace elastocheck::live {
namespace {

using compare::Figure;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using json = nlohmann::ordered_json;

// Half the distance of a central difference, as a share of the range of a number; and the difference
// that counts as none, of 1 and the value: the trim is solved to about 1e-10.
constexpr double share_of_range = 1e-4, rounding = 1e-9;

struct Varied {
    std::vector<std::string> paths;
    std::vector<Figure> figures;
    compare::Wishes wishes;
};

[[noreturn]] void not_as_described() {
    throw std::invalid_argument("the wishes are not as wishes.hpp describes them");
}

double number_at(const json& list, std::size_t k) {
    if (!list.is_array() || list.size() <= k || !list[k].is_number()) not_as_described();
    return list[k].get<double>();
}
std::string text_at(const json& list, std::size_t k) {
    if (!list.is_array() || list.size() <= k || !list[k].is_string()) not_as_described();
    return list[k].get<std::string>();
}

Varied varied_of(const json& read, const Scene& scene, const Model& model) {
    if (!read.contains("vary") || !read.contains("want")) not_as_described();
    const json &vary = read["vary"], &want = read["want"];
    if (!vary.is_array() || !want.is_array() || vary.empty() || want.empty())
        throw std::invalid_argument("at least one number and one wanted figure are needed");
    Varied all;
    compare::Wishes& wishes = all.wishes;
    for (VectorXd* list : {&wishes.start, &wishes.low, &wishes.high})
        list->resize(std::ssize(vary));
    wishes.target.resize(std::ssize(want));
    for (std::size_t i = 0; i < vary.size(); ++i) {
        const auto at = static_cast<Index>(i);
        const std::string path = text_at(vary[i], 0);
        const auto number = std::ranges::find(scene.numbers, path, &Number::path);
        if (number == scene.numbers.end())
            throw std::invalid_argument(path + ": the scene has no such number");
        wishes.start[at] = number->value;
        wishes.low[at] = number_at(vary[i], 1), wishes.high[at] = number_at(vary[i], 2);
        if (!(wishes.low[at] < wishes.high[at] && wishes.low[at] <= number->value &&
              number->value <= wishes.high[at]))
            throw std::invalid_argument(fmt::format("{}: {} is not within its limits {} to {}",
                                                    path, number->value, wishes.low[at],
                                                    wishes.high[at]));
        all.paths.push_back(path);
    }
    const auto outputs = channels_of(model);
    for (std::size_t j = 0; j < want.size(); ++j) {
        Figure figure{.name = text_at(want[j], 0), .branch = text_at(want[j], 1)};
        const auto branch = std::ranges::find(model.branches, figure.branch, &Branch::name);
        if (branch == model.branches.end() || compare::find_channel(outputs, figure.name) < 0)
            throw std::invalid_argument(fmt::format("the scene has no output '{}' on branch '{}'",
                                                    figure.name, figure.branch));
        figure.at = number_at(want[j], 2) / in_unit(compare::unit_of(branch->unit));
        wishes.target[static_cast<Index>(j)] = number_at(want[j], 3);
        all.figures.push_back(std::move(figure));
    }
    return all;
}

// Central differences, within the limits.
MatrixXd differences(const std::function<VectorXd(const VectorXd&)>& value,
                     const compare::Wishes& wishes, const VectorXd& p) {
    MatrixXd J(wishes.target.size(), p.size());
    for (Index i = 0; i < p.size(); ++i) {
        const double h = share_of_range * (wishes.high[i] - wishes.low[i]);
        VectorXd up = p, down = p;
        up[i] = std::min(p[i] + h, wishes.high[i]);
        down[i] = std::max(p[i] - h, wishes.low[i]);
        const VectorXd above = value(up), by = above - value(down);
        for (Index j = 0; j < by.size(); ++j)
            J(j, i) = std::abs(by[j]) <= rounding * (1 + std::abs(above[j]))
                          ? 0
                          : by[j] / (up[i] - down[i]);
    }
    return J;
}

json or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

}  // namespace

json wish(Session& session, std::string_view text) {
    if (!session.parsed) throw std::logic_error("no scene is open");
    const auto settings = request_of(text).settings;
    const auto model_of = [&](const std::vector<Setting>& with) {
        compare::TrimStart start = session.trim;  // the same for each, so that it is a function
        const auto trimmed = compare::trim_by_series(session.parsed->read(with), &start);
        return trimmed.record && !trimmed.record->reached()
                   ? std::nullopt
                   : std::optional<Model>(compile(trimmed.scene));
    };
    const auto drawn = model_of(settings);
    if (!drawn) throw std::invalid_argument("the trim is not reached");
    const Varied all = varied_of(json::parse(text), session.parsed->read(settings), *drawn);
    const auto value = [&](const VectorXd& p) -> VectorXd {
        auto with = settings;
        std::erase_if(with, [&](const Setting& setting) {
            return std::ranges::find(all.paths, setting.path) != all.paths.end();
        });
        for (std::size_t i = 0; i < all.paths.size(); ++i)
            with.push_back({all.paths[i], fmt::format("{:.17g}", p[static_cast<Index>(i)])});
        const auto model = model_of(with);
        return model ? compare::evaluate(*model, all.figures, compare::Leg::series).value
                     : VectorXd::Constant(std::ssize(all.figures), compare::nan);
    };
    const auto found = compare::solve_for(
        {value,
         [&](const VectorXd& p) {
             return compare::FigureGradient{differences(value, all.wishes, p), {}};
         }},
        all.wishes);

    json answer = {{"met", found.met}, {"converged", found.converged}};
    for (Index i = 0; i < found.p.size(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        answer["numbers"].push_back(
            {{"path", all.paths[at]},
             {"from", all.wishes.start[i]},
             {"to", found.p[i]},
             {"at_limit", found.at_limit.empty() ? 0 : found.at_limit[at]}});
    }
    const auto outputs = channels_of(*drawn);
    for (Index j = 0; j < found.before.size(); ++j) {
        const auto at = static_cast<std::size_t>(j);
        const Figure& figure = all.figures[at];
        const auto& output =
            outputs[static_cast<std::size_t>(compare::find_channel(outputs, figure.name))];
        const auto branch = std::ranges::find(drawn->branches, figure.branch, &Branch::name);
        answer["figures"].push_back(
            {{"name", figure.name},
             {"branch", figure.branch},
             {"a", compare::parameter_in(compare::unit_of(branch->unit), figure.at)},
             {"unit", symbol(output.unit)},
             {"target", all.wishes.target[j]},
             {"before", or_null(found.before[j])},
             {"after", or_null(found.after[j])},
             {"still", !found.still.empty() && found.still[at]},
             {"conflict", found.conflict.size() == 0 ? 0 : found.conflict[j]}});
        const bool has_value = std::isfinite(found.before[j]),
                   no_rate =
                       found.gradient.rate.rows() > 0 && !found.gradient.rate.row(j).allFinite();
        if ((!has_value || no_rate) && !answer.contains("why_not"))
            answer["why_not"] = fmt::format(
                "{} has no {} at {} {} of {}", figure.name, has_value ? "rate" : "value",
                compare::parameter_in(compare::unit_of(branch->unit), figure.at),
                symbol(compare::unit_of(branch->unit)), figure.branch);
    }
    return answer;
}

}  // namespace elastocheck::live
