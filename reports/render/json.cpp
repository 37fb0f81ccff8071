#include "reports/render/render.hpp"

namespace elastocheck::reports {

using compare::Table;
using json = nlohmann::ordered_json;

json table_json(const Table& table) {
    json columns = json::array(), rows = json::array();
    for (const auto& column : table.columns)
        columns.push_back(
            {{"name", column.name}, {"unit", column.unit}, {"description", column.description}});
    for (const auto& row : table.rows) {
        json cells = json::array();
        for (const auto& cell : row)
            std::visit([&](const auto& value) { cells.push_back(value); }, cell);
        rows.push_back(std::move(cells));
    }
    return {{"columns", std::move(columns)}, {"rows", std::move(rows)}};
}

json json_of(const compare::Result& result) {
    const compare::Verdict& verdict = result.verdict;
    json tables = json::object(), charts = json::array();
    for (const auto& id : table_ids(result)) {
        const Table whole = whole_table(result, id);
        tables[id] = table_json(whole);
        if (!whole.notes.empty()) tables[id]["notes"] = whole.notes;
    }
    for (const auto& chart : result.charts) {
        charts.push_back({{"id", chart.id},
                          {"title", chart.title},
                          {"table", chart.table},
                          {"x", chart.x},
                          {"y", chart.y},
                          {"by", chart.by},
                          {"log_x", chart.log_x},
                          {"log_y", chart.log_y}});
        if (chart.kind != compare::Chart::Kind::curves)
            charts.back().update({{"kind", compare::chart_kinds[static_cast<int>(chart.kind)]},
                                  {"only", chart.only},
                                  {"axis", chart.axis},
                                  {"marks", chart.marks}});
    }
    return {{"analysis", result.analysis},
            {"verdict",
             {{"grade", verdict.requested || verdict.grade == compare::Grade::not_judged
                            ? name(verdict.grade)
                            : "not requested"},
              {"sentence", verdict.sentence},
              {"reasons", verdict.reasons},
              {"compared", verdict.compared}}},
            {"about", result.about},
            {"tables", tables},
            {"charts", charts},
            {"notes", result.notes}};
}

}  // namespace elastocheck::reports
