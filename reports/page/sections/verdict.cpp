// Section: verdict on the recursion in sentences.
#include <fmt/format.h>

#include <cmath>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

constexpr double nothing = 1e-9;  // mm, deg: smaller deviations are rounding

struct Worst {
    std::string branch, channel, unit;
    std::string reading;  // "at equal load"
    double max = -1, range = 0;

    double share() const { return max / range; }
    std::string text() const { return quantity(max, unit); }
    json words() const {
        return {{"value", text()},
                {"channel", channel},
                {"branch", branch},
                {"reading", reading},
                {"share", percent(share())}};
    }
    std::string label() const { return fmt::format("{}, worst {}", channel, reading); }
};

std::optional<Worst> worst_of(const JsonCursor& scene, const char* reading, const char* unit) {
    const auto found = scene["findings"][reading].find(unit);
    if (!found) return std::nullopt;
    const ChannelInfo channel{(*found)["channel"].text(), unit};
    Worst worst{(*found)["branch"].text(), channel.label(),           unit, "",
                (*found)["max"].number(),  (*found)["range"].number()};
    for (const auto& branch : scene["branches"].items()) {
        if (branch["name"].text() != worst.branch) continue;
        const Sweep sweep = sweep_of(scene, branch);
        worst.reading = std::string_view(reading) == "worst_at_equal_parameter"
                            ? sweep.at_equal_parameter()
                            : sweep.at_equal_abscissa();
    }
    if (worst.reading.empty()) (*found)["branch"].fail("no such branch");
    return worst;
}

// Position of a wheel rate: "jounce"; "travel at −80 mm", "jounce (left wheel)" if otherwise
// ambiguous.
std::string end_of(const JsonCursor& scene, const JsonCursor& rate) {
    std::string text = rate["branch"].text();
    const std::string wheel = rate["wheel"].text();
    int ends = 0;
    for (const auto& other : scene["rate_errors"].items())
        ends += other["branch"].text() == text && other["wheel"].text() == wheel;
    if (ends > 1) text += " at " + quantity(rate["to"].number(), rate["unit"].text());
    if (!wheel.empty()) text += fmt::format(" ({} wheel)", wheel);
    return text;
}

// Wheel-rate error of the recursion for each branch that lifts a wheel: "2.9 % too soft".
json rate_words(const JsonCursor& scene) {
    json list = json::array();
    for (const auto& rate : scene["rate_errors"].items()) {
        const double off = rate["off"].number();
        if (!std::isfinite(off)) continue;
        list.push_back({{"value", percent(std::abs(off))},
                        {"soft", off < 0},
                        {"branch", end_of(scene, rate)},
                        {"comma", !list.empty()}});
    }
    return list;
}

// Force with the largest error: of a driver of a branch if it has an error at all, else of a joint.
// Positions under a prescribed motion are exact whatever the error of the driving force.
json force_words(const JsonCursor& scene) {
    json words = nullptr;
    bool of_drive = false;
    double most = 1e-6;  // [N], [N·m]: smaller errors are rounding
    for (const auto& branch : scene["branches"].items())
        for (const auto& channel : channels_of(scene)) {
            if (channel.kinematic) continue;
            const auto d = branch["deviation"]["at_equal_parameter"]["channels"].find(channel.name);
            const bool drive = channel.name.find(".drive_") != channel.name.npos;
            if (!d || (of_drive && !drive)) continue;
            const double max = (*d)["max"].number();
            if (max <= 1e-6 || (drive == of_drive && max <= most)) continue;
            most = max, of_drive = drive;
            words = {{"value", quantity(max, channel.unit)},
                     {"channel", channel.label()},
                     {"share", percent(max / (*d)["range"].number())},
                     {"drive", drive}};
        }
    return words;
}

// Branches on which the recursion failed.
json failures(const JsonCursor& scene) {
    json list = json::array();
    for (const auto& branch : scene["branches"].items())
        for (const auto& leg : branch["legs"].items())
            if (leg["leg"].text() == "recursive" && leg["outcome"].text() != "converged")
                list.push_back(
                    {{"branch", branch["name"].text()}, {"outcome", leg["outcome"].text()}});
    return list;
}

json gap_words(const JsonCursor& scene) {
    const auto part = scene["findings"].find("gap");
    if (!part) return nullptr;
    const double gap = (*part)["gap"].number(), share = gap / (*part)["deviation"].number();
    return {{"value", quantity(std::abs(gap), "mm")},
            {"share", percent(share)},
            {"share_number", share},
            {(*part)["role"].text(), true}};
}

// Largest error, on the ladder and in the confirming run, and the reference uncertainty.
std::string error_text(const JsonCursor& chosen) {
    std::string text;
    for (const char* unit : {"mm", "deg"}) {
        const auto found = chosen["expected_error"].find(unit),
                   again = chosen["confirmed_error"].find(unit);
        if (!found || !again) continue;
        if (!text.empty()) text += " and ";
        text += quantity(std::max(found->number(), again->number()), unit);
    }
    const auto share = chosen["expected_error"].find("share"),
               again = chosen["confirmed_error"].find("share");
    if (share && again)
        text += fmt::format(", forces and moments {} of their extent",
                            percent(std::max(share->number(), again->number())));
    return text;
}

// "1/86" of the reference's time, or "1.4 times" it.
std::string time_ratio(double ratio) {
    if (ratio < 0.7) return fmt::format("1/{:.0f} of", 1 / ratio);
    return fmt::format("{} times", number(ratio, 2));
}

json recommendation_words(const JsonCursor& scene, std::vector<json>& tiles) {
    const auto trade = scene.find("trade");
    if (!trade) return nullptr;
    const JsonCursor tolerance = (*trade)["tolerance"];
    std::vector<std::string> required;
    for (const char* unit : {"mm", "deg"})
        if (const auto t = tolerance.find(unit)) required.push_back(setting(t->number(), unit));
    json words = {{"asked", enumerated(required)}};
    const auto chosen = trade->find("recommendation");
    if (!chosen) {
        words[(*trade)["inconclusive"].items().empty() ? "none" : "unjudged"] = true;
        return words;
    }
    words["found"] = {{"text", configuration(*chosen)},
                      {"method", (*chosen)["method"].text()},
                      {"holds", error_text(*chosen)},
                      {"numbers", whole_number((*chosen)["confirmed_numbers"].whole())}};
    if (const auto steps = chosen->find("steps"))
        words["found"]["steps"] = whole_number(steps->whole());
    else if (const auto own = chosen->find("own_tolerance_m"))
        words["found"]["own"] = setting(1e3 * own->number(), "mm");
    words["found"]["factorisations"] = whole_number((*chosen)["factorisations"].whole());
    const double ratio = (*chosen)["time_ratio"].number();
    if (std::isfinite(ratio)) words["found"]["time"] = time_ratio(ratio);
    tiles.push_back({{"key", "chosen"},
                     {"value", configuration(*chosen)},
                     {"label", fmt::format("cheapest within {}: error {}", enumerated(required),
                                           error_text(*chosen))}});
    return words;
}

}  // namespace

std::optional<Section> verdict_section(const JsonCursor& scene) {
    Section section{.id = "verdict", .title = "Verdict"};
    json& words = section.words;
    std::vector<json> tiles;
    const JsonCursor verdict = scene["verdict"];
    words["conclusive"] = verdict["conclusive"].truth();
    words["reasons"] = verdict["reasons"].texts();
    words["numbers"] = whole_number(verdict["numbers_compared"].whole());
    if (scene.find("branches")) {
        json published = nullptr;
        std::vector<int> steps;
        for (const auto& branch : scene["branches"].items()) {
            const auto points = curve_of(branch, "recursive").a.size();
            const auto taken = branch.find("steps");
            const int count = taken        ? taken->whole()
                              : points > 0 ? static_cast<int>(points) - 1
                                           : 0;
            if (std::ranges::find(steps, count) == steps.end()) steps.push_back(count);
        }
        const bool wheel = [&] {
            for (const auto& c : main_channels_of(scene))
                if (c.angle()) return true;
            return false;
        }();
        const auto load_mm = worst_of(scene, "worst_at_equal_parameter", "mm");
        const auto load_deg = worst_of(scene, "worst_at_equal_parameter", "deg");
        const auto travel_mm = worst_of(scene, "worst_at_equal_abscissa", "mm");
        const auto travel_deg = worst_of(scene, "worst_at_equal_abscissa", "deg");
        if (load_mm || load_deg) {
            std::vector<std::string> counts;
            counts.reserve(steps.size());
            for (const int count : steps) counts.push_back(whole_number(count));
            published = {
                {"steps", enumerated(counts)}, {"wheel", wheel}, {"failed", failures(scene)}};
            const bool exact =
                (!load_mm || load_mm->max < nothing) && (!load_deg || load_deg->max < nothing);
            published["exact"] = exact;
            const json rates = rate_words(scene), forces = force_words(scene);
            published["forces"] = forces;
            if (rates.empty() && !forces.is_null() && forces["drive"].get<bool>())
                published["drive"] = forces;
            if (!exact && published["failed"].empty()) {
                const auto& travel = travel_deg ? travel_deg : travel_mm;
                const auto& load = load_mm ? load_mm : load_deg;
                published["load"] = load->words();
                if (travel) {
                    published["travel"] = travel->words();
                    published["travel"]["exact"] = travel->max < nothing;
                    if (!rates.empty()) published["rates"] = {{"each", rates}};
                }
                published["gap"] = gap_words(scene);
            }
            if (travel_deg && travel_deg->max >= nothing)
                tiles.push_back({{"key", "travel"},
                                 {"value", travel_deg->text()},
                                 {"label", travel_deg->label()}});
            else if (travel_mm && travel_mm->max >= nothing)
                tiles.push_back({{"key", "travel"},
                                 {"value", travel_mm->text()},
                                 {"label", travel_mm->label()}});
            if (load_mm)
                tiles.push_back(
                    {{"key", "load"}, {"value", load_mm->text()}, {"label", load_mm->label()}});
            for (const auto& rate : scene["rate_errors"].items())
                if (const double off = rate["off"].number(); std::isfinite(off))
                    tiles.push_back({{"key", "rate"},
                                     {"value", percent(off)},
                                     {"label", fmt::format("wheel rate at the end of {}, error",
                                                           end_of(scene, rate))}});
        }
        words["published"] = published;
        std::vector<std::string> agreement;
        for (const char* unit : {"mm", "deg"})
            if (const auto d = scene["findings"]["references_apart"].find(unit))
                agreement.push_back(quantity((*d)["max"].number(), unit));
        if (!agreement.empty()) words["agreement"] = enumerated(agreement);
    }
    words["recommendation"] = recommendation_words(scene, tiles);
    if (const auto measured = scene.find("measured"))
        words["measured"] = {{"file", (*measured)["file"].text()},
                             {"points", (*measured)["points"].whole()}};
    words["tiles"] = tiles;
    return section;
}

}  // namespace elastocheck::reports
