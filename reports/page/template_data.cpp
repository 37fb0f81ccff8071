#include "reports/page/template_data.hpp"

#include "reports/page/svg.hpp"

namespace elastocheck::reports {

using json = nlohmann::ordered_json;

json table_data(const Table& table) {
    json columns = json::array(), rows = json::array();
    for (const auto& column : table.columns)
        columns.push_back({{"name", column.name}, {"words", column.words}, {"note", column.note}});
    for (const auto& row : table.rows) {
        json cells = json::array();
        for (std::size_t c = 0; c < row.size(); ++c)
            cells.push_back({{"text", row[c]},
                             {"words", c < table.columns.size() && table.columns[c].words},
                             {"note", c < table.columns.size() && table.columns[c].note},
                             {"head", c == 0}});
        rows.push_back({{"cells", cells}});
    }
    return {
        {"caption", table.caption}, {"columns", columns}, {"rows", rows}, {"folded", table.folded}};
}

json tints() {
    json all = json::array();
    for (std::size_t k = 0; k < palette.size(); ++k)
        all.push_back({{"k", k}, {"light", palette[k].light}, {"dark", palette[k].dark}});
    return all;
}

}  // namespace elastocheck::reports
