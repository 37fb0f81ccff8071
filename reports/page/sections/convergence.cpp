// Error over the number of steps: what the paper's Fig. 11 shows, and what it cannot see.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/page/numbers.hpp"
#include "reports/page/sections/common.hpp"
#include "reports/page/sections/sections.hpp"

namespace elastocheck::reports {
namespace {

double worse(double a, double b) { return std::isnan(a) || std::isnan(b) ? NAN : std::max(a, std::abs(b)); }

// At the end of a branch, worst over the positions, per level of steps.
struct Levels {
    std::vector<double> step, truth;
};
Levels levels_of(const Field& reading, std::size_t count) {
    Levels levels{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)};
    for (const auto& entry : reading.items()) {
        if (entry["unit"].text() != "mm") continue;
        const auto errors = entry["step_error_end"].numbers();
        const double gap = entry["gap"].number();
        if (errors.size() != count) entry["step_error_end"].fail("not as many numbers as step counts");
        for (std::size_t l = 0; l < count; ++l) {
            levels.step[l] = worse(levels.step[l], errors[l]);
            levels.truth[l] = worse(levels.truth[l], errors[l] + gap);
        }
    }
    return levels;
}

std::vector<std::vector<double>> rows(const std::vector<double>& steps, const std::vector<double>& values) {
    std::vector<std::vector<double>> result;
    for (std::size_t l = 0; l < steps.size(); ++l)
        if (values[l] > 1e-16) result.push_back({steps[l], values[l]});
    return result;
}

// The readings of a branch as a study has it: the key in the document, and what it is called.
std::vector<std::pair<const char*, std::string>> readings_of(const Field& branch) {
    const auto abscissa = branch.find("abscissa");
    const std::string by = abscissa ? ChannelInfo{abscissa->text(), ""}.label() : "";
    return {{"at_equal_parameter", at_equal_parameter(branch["unit"].text())},
            {"at_equal_abscissa", at_equal_abscissa(by)}};
}

std::optional<FigureGroup> group(const Field& study, const Field& method) {
    const std::string branch = study["name"].text();
    const auto steps = study["steps"].numbers();
    if (steps.empty()) study["steps"].fail("no step counts");
    FigureGroup group;
    group.table.caption = fmt::format("Errors at the end of branch {}, published recursion [mm]", branch);
    group.table.columns = {{"steps"}, {"|Φ|, eq. (31)"}};
    group.table.folded = true;
    std::vector<double> phi = method["constraint_error"].numbers();
    if (phi.size() != steps.size()) method["constraint_error"].fail("not as many numbers as step counts");
    for (double& value : phi) value *= 1e3;
    std::vector<Levels> both;
    for (const auto& [key, name] : readings_of(study)) {
        if (method[key].items().empty()) continue;
        const Levels levels = levels_of(method[key], steps.size());
        Figure figure{.id = fmt::format("steps-{}-{}", slug(branch), slug(name)),
                      .title = fmt::format("{}: {}", branch, name),
                      .description = {},
                      .x = "steps per branch",
                      .y = "at the end of the branch [mm]",
                      .log_x = true,
                      .log_y = true};
        figure.series = {
            {"error to the truth", Series::Style::line_points, vermilion, 6, rows(steps, levels.truth)},
            {"step error", Series::Style::line_points, blue, 4, rows(steps, levels.step)},
            {"|Φ|, eq. (31)", Series::Style::rings, green, 5, rows(steps, phi)}};
        std::erase_if(figure.series, [](const Series& s) { return s.rows.empty(); });
        if (figure.series.empty()) continue;
        figure.description = fmt::format(
            "Logarithmic plot, {}: from {} to {} steps the constraint error of eq. (31) goes from {} to {} "
            "mm, "
            "the step error from {} to {} mm, the error to the truth from {} to {} mm.",
            name, number(steps.front(), 4), number(steps.back(), 4), number(phi.front(), 2),
            number(phi.back(), 2), number(levels.step.front(), 2), number(levels.step.back(), 2),
            number(levels.truth.front(), 2), number(levels.truth.back(), 2));
        group.table.columns.push_back({fmt::format("step error, {}", name)});
        group.table.columns.push_back({fmt::format("error to the truth, {}", name)});
        group.figures.push_back(std::move(figure));
        both.push_back(levels);
    }
    if (group.figures.empty()) return std::nullopt;
    for (std::size_t l = 0; l < steps.size(); ++l) {
        std::vector<std::string> row{whole_number(std::lround(steps[l])), number(phi[l])};
        for (const auto& levels : both) {
            row.push_back(number(levels.step[l]));
            row.push_back(number(levels.truth[l]));
        }
        group.table.rows.push_back(row);
    }
    group.caption = fmt::format("Branch {}: worst position at its end, published recursion.", branch);
    return group;
}

std::string order(const Field& entry) {
    const double p = entry["order"].number(), error = entry["order_error"].number();
    if (std::isnan(p)) return entry["behaviour"].text();
    return std::isnan(error) ? number(p, 3) : fmt::format("{} ± {}", number(p, 3), number(error, 1));
}

Table orders(const Field& branch) {
    Table table{.caption = fmt::format("Orders and gaps, branch {}, {}", branch["name"].text(),
                                       at_equal_parameter(branch["unit"].text())),
                .columns = {{"method", true},
                            {"output", true},
                            {"order"},
                            {"step error, finest"},
                            {"gap at the end"},
                            {"± band"},
                            {"gap, share of range"}},
                .rows = {},
                .folded = true};
    for (const auto& method : branch["methods"].items()) {
        const std::string why = method["not_studied"].text();
        if (!why.empty()) {
            table.rows.push_back({method["method"].text(), why, "–", "–", "–", "–", "–"});
            continue;
        }
        bool first = true;
        for (const auto& entry : method["at_equal_parameter"].items()) {
            const auto errors = entry["step_error_max"].numbers();
            ChannelInfo channel{entry["channel"].text(), entry["unit"].text()};
            table.rows.push_back({first ? method["method"].text() : "", channel.heading(), order(entry),
                                  errors.empty() ? "–" : number(errors.back(), 2),
                                  deviation_number(entry["gap"].number()), number(entry["band"].number(), 2),
                                  percent(entry["gap"].number() / entry["range"].number())});
            first = false;
        }
    }
    return table;
}

}  // namespace

std::optional<Section> convergence_section(const Field& scene) {
    const auto study = scene.find("convergence");
    if (!study) return std::nullopt;
    Section section{.id = "convergence", .title = "Error over steps"};
    section.words["reasons"] = (*study)["reasons"].texts();
    for (const auto& branch : (*study)["branches"].items()) {
        for (const auto& method : branch["methods"].items()) {
            if (method["method"].text() != "published" || !method["not_studied"].text().empty()) continue;
            if (auto made = group(branch, method)) section.figures.push_back(std::move(*made));
            if (const std::string why = method["no_abscissa"].text(); !why.empty())
                section.words["notes"].push_back({{"branch", branch["name"].text()},
                                                  {"reading", readings_of(branch).back().second},
                                                  {"why", why}});
        }
        section.tables.push_back(orders(branch));
    }
    return section;
}

}  // namespace elastocheck::reports
