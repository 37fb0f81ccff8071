#include "reports/page/result_page.hpp"

#include <fmt/format.h>

#include "reports/files/templates.hpp"
#include "reports/page/chart.hpp"
#include "reports/page/common.hpp"
#include "reports/page/plot.hpp"
#include "reports/page/svg.hpp"
#include "reports/render/render.hpp"

namespace elastocheck::reports {

using json = nlohmann::ordered_json;

std::string result_page(const compare::Result& result, const std::string& title,
                        const std::map<std::string, std::string>& words,
                        const std::string& reproduce,
                        const std::vector<std::pair<std::string, std::string>>& made) {
    constexpr std::size_t max_rows = 15;
    json data{{"title", title},
              {"answer", result.verdict.sentence},
              {"notes", result.verdict.reasons},
              {"reproduce", reproduce},
              {"tints", tints()},
              {"figures", json::array()},
              {"tables", json::array()}};
    for (const compare::Chart& chart : result.charts) {
        json& figures = data["figures"];
        if (figures.empty() || figures.back()["name"] != chart.only)
            figures.push_back({{"id", fmt::format("figure-{}", figures.size() + 1)},
                               {"name", chart.only},
                               {"words", words.at(chart.only)},
                               {"plots", json::array()}});
        const auto figure = figure_of(chart, compare::whole_table(result, chart.table));
        const auto drawn = illustrate(draw(figure), chart.id, figure.title, figure.description);
        figures.back()["plots"].push_back({{"title", figure.title}, {"svg", drawn.inlined}});
    }
    for (const Table& table : result.tables) {
        if (page_columns(table).empty()) continue;
        data["tables"].push_back(page_table(table));
        data["tables"].back()["folded"] = table.rows.size() > max_rows;
    }
    Table by = words_table("Made by", {"what", "which"});
    for (const auto& [what, which] : made) by.rows.push_back({what, which});
    data["provenance"] = page_table(by);
    return render("html/study", data, Escape::html);
}

}  // namespace elastocheck::reports
