#include "reports/page/survival_map.hpp"

#include <fmt/format.h>

#include <algorithm>
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

// Digits lost to other arithmetic, by scene, arithmetic and solver group.
json arithmetic(const JsonCursor& part) {
    std::string groups;
    for (const auto& group : part["groups"].texts()) groups += (groups.empty() ? "" : ", ") + group;
    const auto variants = part["variants"].texts();
    json rows = json::array(), gave_up = json::array();
    for (const auto& row : part["rows"].items()) {
        json cells = json::array();
        for (const auto& variant : row["lost"].items()) {
            std::string numbers;
            for (const auto& loss : variant.texts()) numbers += (numbers.empty() ? "" : " ") + loss;
            cells.push_back(numbers);
        }
        if (cells.size() != variants.size())
            row["lost"].fail("expected what is lost of every variant");
        rows.push_back({{"name", row["scene"].text()}, {"cells", cells}});
    }
    for (const auto& one : part["gave_up"].items())
        gave_up.push_back({{"where", one["where"].text()}, {"why", one["why"].text()}});
    return {{"groups", groups},
            {"variants", variants},
            {"lost", rows},
            {"worst", part["worst"].text()},
            {"worst_right", part["worst_right"].text()},
            {"gave_up", gave_up}};
}

}  // namespace

json survival(const JsonCursor& result) {
    const auto found = result.find("stress");
    if (!found) return nullptr;
    const JsonCursor& part = *found;
    const auto solvers = part["solvers"].texts();
    std::string who;
    for (const auto& solver : solvers) who += (who.empty() ? "" : ", ") + solver;
    json sweeps = json::array(), rows = json::array(), extremes = json::array(),
         wrong = json::array(), skipped = json::array();
    for (const auto& sweep : part["sweeps"].texts()) sweeps.push_back(sweep);
    for (const auto& scene : part["map"].items()) {
        json cells = json::array();
        for (const auto& signs : scene["signs"].items())
            cells.push_back(runs(signs, solvers.size()));
        if (cells.size() != sweeps.size()) scene["signs"].fail("expected the signs of every sweep");
        rows.push_back({{"name", scene["scene"].text()}, {"cells", cells}});
    }
    for (const auto& one : part["extremes"].items())
        extremes.push_back({{"scene", one["scene"].text()},
                            {"variant", one["variant"].text()},
                            {"cells", json::array({runs(one["signs"], solvers.size())})}});
    for (const auto& one : part["wrong"].items())
        wrong.push_back({{"scene", one["scene"].text()},
                         {"variant", one["variant"].text()},
                         {"way", one["way"].text()},
                         {"solver", one["solver"].text()},
                         {"why", one["why"].text()}});
    for (const auto& one : part["skipped"].items())
        skipped.push_back({{"scene", one["scene"].text()},
                           {"variant", one["variant"].text()},
                           {"why", one["why"].text()}});
    int all = 0;
    json counts = json::object();
    for (const auto& [verdict, count] : part["counts"].entries()) {
        counts[verdict] = count.whole();
        all += count.whole();
    }
    const auto other = part.find("arithmetic");
    const bool any = other && !(*other)["rows"].items().empty();
    return {{"arithmetic", any ? arithmetic(*other) : json(nullptr)},
            {"solvers", who},
            {"sweeps", sweeps},
            {"rows", rows},
            {"has_rows", !rows.empty()},
            {"extremes", extremes},
            {"has_extremes", !extremes.empty()},
            {"wrong", wrong},
            {"has_wrong", !wrong.empty()},
            {"skipped", skipped},
            {"count", all},
            {"counts", counts}};
}

}  // namespace elastocheck::reports
