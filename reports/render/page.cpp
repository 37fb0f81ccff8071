#include <fmt/format.h>

#include <cmath>

#include "reports/render/render.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

// With as many digits as entered, up to six.
std::string as_given(double value) {
    int digits = 1;
    while (digits < 6 && parsed_number(fmt::format("{:.{}e}", value, digits - 1)) != value)
        ++digits;
    return number(value, digits);
}

std::string on_page(double value, Digits digits) {
    const bool is_rounding = std::abs(value) < 1e-9;
    if (!std::isfinite(value)) return number(value);
    switch (digits) {
        case Digits::whole:
            return std::abs(value) < 1e15 ? whole_number(std::lround(value)) : number(value);
        case Digits::given: return as_given(value);
        case Digits::place: return short_number(value);
        case Digits::size: return number(value, 2);
        case Digits::three: return number(value, 3);
        case Digits::four: return is_rounding ? "0" : number(value, 4);
        case Digits::deviation: return deviation_number(value);
        case Digits::rounded:
        case Digits::shaded: return is_rounding ? "0" : number(value, 2);
        case Digits::percent: return percent(value);
        case Digits::hidden:
        case Digits::note:
        case Digits::words: break;
    }
    return {};
}

}  // namespace

std::vector<ShownColumn> page_columns(const compare::Table& table) {
    return shown_columns(table, on_page);
}

json page_table(const compare::Table& table) {
    json columns = json::array(), rows = json::array();
    for (std::size_t r = 0; r < table.rows.size(); ++r) rows.push_back({{"cells", json::array()}});
    for (const auto& column : page_columns(table)) {
        const bool first = columns.empty();
        columns.push_back(
            {{"name", column.heading}, {"words", column.words}, {"note", column.note}});
        for (std::size_t r = 0; r < rows.size(); ++r) {
            rows[r]["cells"].push_back({{"text", column.cells[r]},
                                        {"words", column.words},
                                        {"note", column.note},
                                        {"head", first}});
            if (!column.shades.empty())
                rows[r]["cells"].back()["share"] = fmt::format("{:.2f}", column.shades[r]);
        }
    }
    return {{"caption", table.caption},
            {"columns", columns},
            {"rows", rows},
            {"remarks", table.notes},
            {"folded", table.detail}};
}

}  // namespace elastocheck::reports
