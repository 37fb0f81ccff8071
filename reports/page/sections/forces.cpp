// Section: forces of bushings, springs and links in their own axes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "compare/tables/table.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/tables/render.hpp"
#include "reports/tables/select.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

constexpr std::size_t most_elements = 40;
constexpr double nothing = 1e-6;  // [N], [N·m]

// Deformation conjugate to a force: "mount.displacement_x" for "mount.elastic_force_x".
std::string deformation_of(std::string output) {
    constexpr std::pair<const char*, const char*> pairs[] = {{".elastic_force_", ".displacement_"},
                                                             {".elastic_moment_", ".rotation_"},
                                                             {".force", ".deflection"},
                                                             {".moment", ".angle"}};
    for (const auto& [force, deformation] : pairs)
        if (const auto at = output.rfind(force); at != std::string::npos)
            return output.replace(at, std::string(force).size(), deformation);
    return {};
}

// Row with the largest value of each output, and the largest force of each element.
struct Largest {
    std::vector<std::size_t> rows;             // one per output, in the order of the table
    std::map<std::string, double> of_element;  // [N] or [N·m]
};
Largest largest_of(const compare::Table& forces) {
    Largest result;
    std::map<std::string, std::size_t> place;  // index in `rows`
    for (std::size_t r = 0; r < forces.rows.size(); ++r) {
        const std::string& unit = words(forces, r, "unit");
        const double size = std::abs(number(forces, r, "value"));
        if ((unit != "N" && unit != "N·m") || !(size > nothing)) continue;
        double& most = result.of_element[words(forces, r, "element")];
        most = std::max(most, size);
        const auto [known, is_new] = place.emplace(words(forces, r, "output"), result.rows.size());
        if (is_new)
            result.rows.push_back(r);
        else if (std::size_t& row = result.rows[known->second];
                 size > std::abs(number(forces, row, "value")))
            row = r;
    }
    return result;
}

// Smallest displayed force; 0 if all are displayed.
double threshold(const std::map<std::string, double>& of_element) {
    if (of_element.size() <= most_elements) return 0;
    std::vector<double> sizes;
    for (const auto& [name, size] : of_element) sizes.push_back(size);
    std::ranges::sort(sizes, std::ranges::greater{});
    return sizes[most_elements - 1];
}

// Key: branch, end, output.
using Deformations = std::map<std::tuple<std::string, double, std::string>, std::size_t>;

}  // namespace

std::optional<Section> forces_section(const JsonCursor& scene) {
    const auto field = scene.find("forces");
    if (!field) return std::nullopt;
    const compare::Table forces = read_table(*field, compare::force_table({}));
    const Largest largest = largest_of(forces);
    if (largest.rows.empty()) return std::nullopt;
    Deformations at;
    for (std::size_t r = 0; r < forces.rows.size(); ++r)
        at[{words(forces, r, "branch"), number(forces, r, "end"), words(forces, r, "output")}] = r;
    const double least = threshold(largest.of_element);

    Section section{.id = "forces", .title = "Forces in bushings, springs and links"};
    Table table{.caption = "Largest force of each element at the ends of the branches",
                .columns = {{"element and axis", true},
                            {"largest"},
                            {"unit", true},
                            {"where", true},
                            {"deformed by"},
                            {"unit", true},
                            {"error of the recursion"},
                            {"share"}}};
    for (const std::size_t r : largest.rows) {
        if (!(largest.of_element.at(words(forces, r, "element")) >= least)) continue;
        const std::string& output = words(forces, r, "output");
        const auto deformed =
            at.find({words(forces, r, "branch"), number(forces, r, "end"), deformation_of(output)});
        const bool known = deformed != at.end();
        table.rows.push_back(
            {output, number(number(forces, r, "value")), words(forces, r, "unit"),
             fmt::format("{}, {} {}", words(forces, r, "branch"), number(number(forces, r, "end")),
                         words(forces, r, "end unit")),
             known ? number(number(forces, deformed->second, "value")) : "",
             known ? words(forces, deformed->second, "unit") : "",
             deviation_number(number(forces, r, "error")),
             percent(std::abs(number(forces, r, "share")) / 100)});
    }
    const auto shown =
        std::ranges::count_if(largest.of_element, [&](const auto& e) { return e.second >= least; });
    if (const auto rest = largest.of_element.size() - static_cast<std::size_t>(shown); rest > 0)
        section.words["left_out"] = whole_number(static_cast<long>(rest));
    section.tables.push_back(std::move(table));
    return section;
}

}  // namespace elastocheck::reports
