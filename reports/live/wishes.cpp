#include "reports/live/wishes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
using Eigen::VectorXd;
using json = nlohmann::ordered_json;

constexpr double share_of_range = 1e-4;  // step of the differences, as a share of a number's range

struct Varied {
    std::vector<std::string> paths;
    std::vector<Figure> figures;
    VectorXd target;
    compare::SearchRange range;
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
    Varied varied;
    compare::SearchRange& range = varied.range;
    for (VectorXd* list : {&range.start, &range.low, &range.high}) list->resize(std::ssize(vary));
    varied.target.resize(std::ssize(want));
    for (std::size_t i = 0; i < vary.size(); ++i) {
        const auto index = static_cast<Index>(i);
        const std::string path = text_at(vary[i], 0);
        const auto number = std::ranges::find(scene.numbers, path, &Number::path);
        if (number == scene.numbers.end())
            throw std::invalid_argument(path + ": the scene has no such number");
        range.start[index] = number->value;
        range.low[index] = number_at(vary[i], 1), range.high[index] = number_at(vary[i], 2);
        if (!(range.low[index] < range.high[index] && range.low[index] <= number->value &&
              number->value <= range.high[index]))
            throw std::invalid_argument(fmt::format("{}: {} is not within its limits {} to {}",
                                                    path, number->value, range.low[index],
                                                    range.high[index]));
        varied.paths.push_back(path);
    }
    const auto outputs = channels_of(model);
    for (std::size_t j = 0; j < want.size(); ++j) {
        Figure figure{.name = text_at(want[j], 0), .branch = text_at(want[j], 1)};
        const auto branch = std::ranges::find(model.branches, figure.branch, &Branch::name);
        if (branch == model.branches.end() || compare::find_channel(outputs, figure.name) < 0)
            throw std::invalid_argument(fmt::format("the scene has no output '{}' on branch '{}'",
                                                    figure.name, figure.branch));
        figure.station = number_at(want[j], 2) / in_unit(compare::unit_of(branch->unit));
        varied.target[static_cast<Index>(j)] = number_at(want[j], 3);
        varied.figures.push_back(std::move(figure));
    }
    return varied;
}

json or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

}  // namespace

json wish(Session& session, std::string_view text) {
    if (!session.parsed) throw std::logic_error("no scene is open");
    const auto settings = request_of(text).settings;
    const auto model_of = [&](const std::vector<Setting>& changed) {
        // Every trim has the same start, so that the figures are a function of the numbers.
        compare::TrimStart start = session.trim;
        const auto trimmed = compare::trim_by_series(session.parsed->read(changed), &start);
        return trimmed.record && !trimmed.record->reached()
                   ? std::nullopt
                   : std::optional<Model>(compile(trimmed.scene));
    };
    const auto drawn = model_of(settings);
    if (!drawn) throw std::invalid_argument("the trim is not reached");
    const Varied varied = varied_of(json::parse(text), session.parsed->read(settings), *drawn);
    const auto value = [&](const VectorXd& p) -> VectorXd {
        auto changed = settings;
        std::erase_if(changed, [&](const Setting& setting) {
            return std::ranges::find(varied.paths, setting.path) != varied.paths.end();
        });
        for (std::size_t i = 0; i < varied.paths.size(); ++i)
            changed.push_back({varied.paths[i], fmt::format("{:.17g}", p[static_cast<Index>(i)])});
        const auto model = model_of(changed);
        return model ? compare::evaluate(*model, varied.figures, compare::Leg::series).value
                     : VectorXd::Constant(std::ssize(varied.figures), compare::nan);
    };
    const auto at_all = [&](const std::vector<VectorXd>& points) {
        std::vector<VectorXd> values;
        for (const VectorXd& p : points) values.push_back(value(p));
        return values;
    };
    const compare::SearchRange& range = varied.range;
    const compare::Figures figures{at_all, share_of_range * (range.high - range.low)};
    const auto start = compare::start_of(figures, range);
    const bool moves = start.complete() && std::ranges::count(start.still, true) == 0;
    compare::Solution solution{.p = range.start, .off = VectorXd::Zero(varied.target.size())};
    if (moves)
        solution = compare::solve_for(figures, {varied.target, varied.target, start.movement},
                                      range, range.start);
    const VectorXd after = figures.value(solution.p);
    const bool met = moves && solution.excess() <= compare::met_within;

    json answer = {{"met", met}, {"converged", solution.converged}};
    for (Index i = 0; i < solution.p.size(); ++i) {
        const auto index = static_cast<std::size_t>(i);
        answer["numbers"].push_back({{"path", varied.paths[index]},
                                     {"from", range.start[i]},
                                     {"to", solution.p[i]},
                                     {"at_limit", met || !moves ? 0 : solution.at_limit[index]}});
    }
    const auto outputs = channels_of(*drawn);
    for (Index j = 0; j < after.size(); ++j) {
        const auto index = static_cast<std::size_t>(j);
        const Figure& figure = varied.figures[index];
        const auto& output =
            outputs[static_cast<std::size_t>(compare::find_channel(outputs, figure.name))];
        const auto branch = std::ranges::find(drawn->branches, figure.branch, &Branch::name);
        answer["figures"].push_back(
            {{"name", figure.name},
             {"branch", figure.branch},
             {"a", compare::parameter_in(compare::unit_of(branch->unit), figure.station)},
             {"unit", symbol(output.unit)},
             {"target", varied.target[j]},
             {"before", or_null(start.value[j])},
             {"after", or_null(after[j])},
             {"still", !start.still.empty() && start.still[index]},
             {"conflict", met || !moves ? 0 : solution.conflict()[j]}});
        const bool has_value = std::isfinite(start.value[j]),
                   no_rate = start.gradient.rows() > 0 && !start.gradient.row(j).allFinite();
        if ((!has_value || no_rate) && !answer.contains("why_not"))
            answer["why_not"] = fmt::format(
                "{} has no {} at {} {} of {}", figure.name, has_value ? "rate" : "value",
                compare::parameter_in(compare::unit_of(branch->unit), figure.station),
                symbol(compare::unit_of(branch->unit)), figure.branch);
    }
    return answer;
}

}  // namespace elastocheck::live
