// Section: the differences between two variants: numbers of the scene, figures at the design
// position, and outputs over the branches on common axes.
#include "reports/document/against.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/kinematics/figures.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

// Names of the base and the variant: of the scenes, or of their files where those are the same.
std::pair<std::string, std::string> names_of(const SceneAnalyses& scene, const Against& against) {
    const auto file = [](const std::string& source) {
        return std::filesystem::path(source).filename().string();
    };
    if (scene.scene.name != against.name) return {scene.scene.name, against.name};
    return {file(scene.scene.source), file(against.source)};
}

DrawnCurve curve(const char* legend, const Against::Line& line) {
    DrawnCurve drawn{legend};
    for (std::size_t k = 0; k < line.a.size(); ++k) drawn.rows.push_back({line.a[k], line.y[k]});
    return drawn;
}

// Whether two lines can be distinguished: by a hundredth of the range of the curve.
bool is_visible(const Against::Curve& curve) {
    const auto [low, high] = std::ranges::minmax_element(curve.base.y);
    return low != curve.base.y.end() && std::abs(curve.largest) >= 0.01 * (*high - *low);
}

// Curves whose difference an engineer notices: of the first branch every output, of others the angles.
FigureGroup figures(const SceneAnalyses& scene, const Against& against) {
    constexpr std::size_t most = 12;
    const auto [base, variant] = names_of(scene, against);
    FigureGroup group{.caption = fmt::format("Wide line: {}. Thin line: {}.", base, variant),
                      .table = whole_table(result_of(against), "differences")};
    const auto branches = branches_of(scene);
    for (const auto& branch : against.branches) {
        const auto same = std::ranges::find(branches, branch.name, &ComparedBranch::name);
        for (const auto& c : branch.curves) {
            const bool first = &branch == &against.branches.front();
            if (!(c.noticed > 1) || (!first && c.unit != "deg") || !is_visible(c)) continue;
            if (group.figures.size() == most) return group;
            const std::string output = as_words(c.output);
            group.figures.push_back(
                figure_of_curves(
                    {.id = fmt::format("against-{}-{}", slug(c.output), slug(branch.name)),
                     .title = fmt::format("{}, {}", output, branch.name),
                     .x = sweep_of(scene, *same).parameter,
                     .y = {fmt::format("{} [{}]", output, c.unit)}},
                    {curve("base", c.base), curve("variant", c.variant)},
                    fmt::format("{} of both variants, {}; they differ by up to {} {}", output,
                                branch.name, number(std::abs(c.largest), 2), c.unit))
                    .figures.front());
        }
    }
    return group;
}

}  // namespace

std::optional<Section> against_section(const SceneAnalyses& scene) {
    if (!scene.against) return std::nullopt;
    const Against& against = *scene.against;
    Section section{.id = "against", .title = "Differences of " + names_of(scene, against).second};
    section.words = {{"base", scene.scene.source},
                     {"variant", against.source},
                     {"numbers", counted(against.numbers.size(), "number")},
                     {"figures", counted(against.figures.size(), "figure")}};
    if (!against.only_base.empty()) section.words["only_base"] = enumerated(against.only_base);
    if (!against.only_variant.empty())
        section.words["only_variant"] = enumerated(against.only_variant);
    compare::Result result = result_of(against);
    for (Table& table : result.tables)
        if ((table.id == "numbers" || table.id == "figures") && !table.rows.empty())
            section.tables.push_back(std::move(table));
    FigureGroup group = figures(scene, against);
    if (!group.figures.empty())
        section.figures.push_back(std::move(group));
    else if (!group.table.rows.empty())
        section.tables.push_back(std::move(group.table));
    return section;
}

}  // namespace elastocheck::reports
