#include "reports/page/survival_map.hpp"

#include <fmt/format.h>

#include <string>

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

// Style-sheet class of a sign.
const char* tint(char sign) {
    switch (sign) {
        case '!': return "failed";
        case '~': return "elsewhere";
        case '?': return "unknown";
        case 'X': return "wrong";
        case '.': return "not-run";
        default: return sign >= '6' ? "many" : sign >= '3' ? "some" : "few";
    }
}

// Adjacent signs of the same class, grouped.
json runs(const JsonCursor& field, std::size_t solvers) {
    const std::string signs = field.text();
    if (signs.size() != solvers || signs.find_first_not_of("0123456789!~?X.") != signs.npos)
        field.fail("expected one sign a solver, each one of 0 ... 9 ! ~ ? X .");
    json list = json::array();
    for (std::size_t from = 0, to = 0; from < signs.size(); from = to) {
        while (to < signs.size() && std::string_view(tint(signs[to])) == tint(signs[from])) ++to;
        list.push_back({{"tint", tint(signs[from])}, {"signs", signs.substr(from, to - from)}});
    }
    return {{"signs", signs}, {"runs", list}};
}

}  // namespace

json survival(const JsonCursor& result) {
    const auto found = result.find("stress");
    if (!found) return nullptr;
    const JsonCursor& part = *found;
    const std::size_t solvers = part["solvers"].items().size();
    json data = *part.value, rows = json::array();
    for (const auto& scene : part["map"].items()) {
        json cells = json::array();
        for (const auto& signs : scene["signs"].items()) cells.push_back(runs(signs, solvers));
        if (cells.size() != part["sweeps"].items().size())
            scene["signs"].fail("expected the signs of every sweep");
        rows.push_back({{"name", scene["scene"].text()}, {"cells", cells}});
    }
    const auto extremes = part["extremes"].items();
    for (std::size_t k = 0; k < extremes.size(); ++k)
        data["extremes"][k]["cells"] = json::array({runs(extremes[k]["signs"], solvers)});
    int all = 0;
    for (const auto& [verdict, count] : part["counts"].entries()) all += count.whole();
    data["solvers"] = fmt::format("{}", fmt::join(part["solvers"].texts(), ", "));
    data["rows"] = rows;
    data["count"] = all;
    data["has_rows"] = !rows.empty();
    data["has_extremes"] = !extremes.empty();
    data["has_wrong"] = !part["wrong"].items().empty();
    return data;
}

}  // namespace elastocheck::reports
