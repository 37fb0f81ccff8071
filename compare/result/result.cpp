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

Table whole_table(const Result& result, const std::string& id) {
    Table whole;
    for (const auto& table : result.tables) {
        if (table.id != id) continue;
        if (whole.id.empty()) whole = {.columns = table.columns, .id = id};
        std::ranges::copy(table.rows, std::back_inserter(whole.rows));
        std::ranges::copy(table.notes, std::back_inserter(whole.notes));
    }
    if (whole.id.empty()) throw std::out_of_range(result.analysis + ": no table " + id);
    return whole;
}

}  // namespace elastocheck::compare
