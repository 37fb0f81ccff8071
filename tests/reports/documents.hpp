// Parts of result.json, for tests.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace elastocheck::reports {

// The rows of a table as objects by the names of the columns.
inline nlohmann::ordered_json objects(const nlohmann::ordered_json& table) {
    auto rows = nlohmann::ordered_json::array();
    for (const auto& row : table["rows"]) {
        auto& object = rows.emplace_back(nlohmann::ordered_json::object());
        for (std::size_t c = 0; c < row.size(); ++c)
            object[table["columns"][c]["name"].get<std::string>()] = row[c];
    }
    return rows;
}

// The result of an analysis of a scene; null without one.
inline nlohmann::ordered_json result_in(const nlohmann::ordered_json& scene,
                                        const std::string& analysis) {
    for (const auto& result : scene["results"])
        if (result["analysis"] == analysis) return result;
    return nullptr;
}

}  // namespace elastocheck::reports
