#include "compare/result/result.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace elastocheck::compare {

std::vector<std::string> table_ids(const Result& result) {
    std::vector<std::string> ids;
    for (const auto& table : result.tables)
        if (!table.id.empty() && std::ranges::find(ids, table.id) == ids.end())
            ids.push_back(table.id);
    return ids;
}

Table with_columns(const Table& table, const std::vector<std::string>& names) {
    Table chosen{.rows = std::vector<std::vector<Cell>>(table.rows.size()),
                 .id = table.id,
                 .caption = table.caption,
                 .notes = table.notes,
                 .detail = table.detail};
    for (const auto& name : names) {
        const auto column = std::ranges::find(table.columns, name, &Column::name);
        if (column == table.columns.end()) continue;
        chosen.columns.push_back(*column);
        if (column->digits == Digits::hidden) {  // of texts
            chosen.columns.back().words = true;
            chosen.columns.back().digits = Digits::words;
        }
        chosen.columns.back().place = -1;
        for (std::size_t r = 0; r < table.rows.size(); ++r)
            chosen.rows[r].push_back(
                table.rows[r][static_cast<std::size_t>(column - table.columns.begin())]);
    }
    return chosen;
}

Table whole_table(const Result& result, const std::string& id) {
    Table whole;
    for (const auto& table : result.tables) {
        if (table.id != id) continue;
        if (whole.id.empty())
            whole = {.columns = table.columns, .id = id, .caption = table.caption};
        std::ranges::copy(table.rows, std::back_inserter(whole.rows));
        std::ranges::copy(table.notes, std::back_inserter(whole.notes));
    }
    if (whole.id.empty()) throw std::out_of_range(result.analysis + ": no table " + id);
    return whole;
}

}  // namespace elastocheck::compare
