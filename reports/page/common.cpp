#include "reports/page/common.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/outputs/curve.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

std::string ChannelInfo::label() const { return as_words(name); }

std::string ChannelInfo::heading() const { return fmt::format("{} [{}]", label(), unit); }

std::string ChannelInfo::owner() const {
    const auto dot = name.rfind('.');
    return dot == std::string::npos ? "" : name.substr(0, dot);
}

std::string ChannelInfo::quantity() const { return name.substr(name.rfind('.') + 1); }

std::vector<ChannelInfo> channels_of(const JsonCursor& scene) {
    std::vector<ChannelInfo> all;
    for (const auto& c : scene["channels"].items())
        all.push_back({c["name"].text(), c["unit"].text(), c["main"].truth(),
                       c["kinematic"].truth(), c["definition"].text(),
                       c.find("kind") && c["kind"].text() == "drive"});
    return all;
}

std::vector<ChannelInfo> main_channels_of(const JsonCursor& scene) {
    auto all = channels_of(scene);
    std::erase_if(all, [](const ChannelInfo& c) { return !c.main; });
    return all;
}

std::vector<double> LegCurve::channel(const std::string& name) const {
    return values.value->is_object() ? values[name].numbers() : std::vector<double>{};
}

std::size_t LegCurve::start() const {
    std::size_t nearest = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
        if (std::abs(a[k]) < std::abs(a[nearest])) nearest = k;
    return nearest;
}

LegCurve curve_of(const JsonCursor& branch, std::string_view leg) {
    const JsonCursor legs = branch["legs"];
    for (const auto& run : legs.items()) {
        if (run["leg"].text() != leg) continue;
        const JsonCursor curve = run["curve"];
        LegCurve found{std::string(leg), curve["a"].numbers(), {}, curve["values"]};
        for (const auto& [name, values] : found.values.entries())
            if (values.value->size() != found.a.size())
                values.fail("not as many numbers as parameters");
        if (const auto abscissa = branch.find("abscissa")) {
            found.x = found.channel(abscissa->text());
            if (!compare::trend(found.x).monotonic()) found.x.clear();
        }
        return found;
    }
    return {std::string(leg), {}, {}, legs};
}

bool Sweep::has(std::string_view branch) const {
    return std::ranges::any_of(branches,
                               [&](const JsonCursor& b) { return b["name"].text() == branch; });
}

std::string Sweep::parameter() const {
    std::string word = compare::parameter_word(unit);
    if (lifts() && word != "load") {
        word = "travel";
    } else if (word != "load") {
        std::vector<std::string> moved;
        for (const auto& joint : branches.front()["drivers"]["moved"].texts())
            moved.push_back(
                as_words(joint.ends_with(".drive") ? joint.substr(0, joint.rfind('.')) : joint));
        if (!moved.empty()) word = enumerated(moved);
    }
    return fmt::format("{} [{}]", word, unit);
}

std::string Sweep::at_equal_parameter() const { return compare::parameter_reading(unit); }
std::string Sweep::at_equal_abscissa() const {
    return compare::abscissa_reading(abscissa.substr(0, abscissa.find(" [")));
}

Sweep sweep_of(const JsonCursor& scene, const JsonCursor& branch) {
    const auto kind = branch.find("case");
    return {branch["name"].text(),
            branch["unit"].text(),
            abscissa_of(scene, branch),
            {branch},
            kind ? kind->text() : "other"};
}

std::string abscissa_of(const JsonCursor& scene, const JsonCursor& branch) {
    const auto abscissa = branch.find("abscissa");
    if (!abscissa) return {};
    for (const auto& channel : channels_of(scene))
        if (channel.name == abscissa->text()) return channel.heading();
    abscissa->fail("no such channel");
}

namespace {

// Whether every leg's curve has this abscissa and it is useful: with a travel below a millimetre
// the branch does not lift the wheel.
bool over_abscissa(const JsonCursor& branch) {
    if (const auto abscissa = branch.find("abscissa");
        abscissa && abscissa->text().ends_with("travel")) {
        const auto x = curve_of(branch, "equilibrium").channel(abscissa->text());
        const auto [low, high] = std::ranges::minmax_element(x);
        if (low == x.end() || !(*high - *low >= compare::least_travel)) return false;
    }
    return std::ranges::all_of(branch["legs"].items(), [&](const JsonCursor& leg) {
        const LegCurve curve = curve_of(branch, leg["leg"].text());
        return curve.a.empty() || !curve.x.empty();
    });
}

}  // namespace

std::vector<Sweep> sweeps_of(const JsonCursor& scene) {
    std::vector<Sweep> sweeps;
    const auto same_drive = [](const JsonCursor& a, const JsonCursor& b) {
        return a["unit"].text() == b["unit"].text() &&
               a["drivers"]["moved"].texts() == b["drivers"]["moved"].texts() &&
               a["drivers"]["held"].texts() == b["drivers"]["held"].texts() &&
               a["from"].number() == 0 && b["from"].number() == 0 &&
               a["to"].number() * b["to"].number() < 0;
    };
    for (const auto& branch : scene["branches"].items()) {
        Sweep* twin = nullptr;
        for (auto& sweep : sweeps)
            if (sweep.branches.size() == 1 && same_drive(sweep.branches.front(), branch))
                twin = &sweep;
        const std::string name = branch["name"].text(),
                          abscissa = over_abscissa(branch) ? abscissa_of(scene, branch) : "";
        if (twin == nullptr) {
            sweeps.push_back(sweep_of(scene, branch));
            sweeps.back().abscissa = abscissa;
        } else {
            twin->name += " and " + name;
            if (twin->abscissa != abscissa) twin->abscissa.clear();
            twin->branches.push_back(branch);
        }
    }
    return sweeps;
}

std::optional<Sweep> leading_sweep(const JsonCursor& scene) {
    if (!scene.find("branches")) return std::nullopt;
    const auto sweeps = sweeps_of(scene);
    if (sweeps.empty()) return std::nullopt;
    auto leading = std::ranges::find(sweeps, "heave", &Sweep::kind);
    if (leading == sweeps.end()) leading = std::ranges::find_if(sweeps, &Sweep::lifts);
    return leading == sweeps.end() ? sweeps.front() : *leading;
}

bool leads(const JsonCursor& scene, const std::string& side) {
    const auto sweep = leading_sweep(scene);
    return sweep && (sweep->has(side) || sweep->has(side.substr(0, side.rfind(" to "))));
}

SweepCurve sweep_curve(const Sweep& sweep) {
    SweepCurve all;
    all.branches = sweep.branches;
    for (const auto& branch : sweep.branches) {
        all.curves.push_back(curve_of(branch, "equilibrium"));
        const auto& a = all.curves.back().a;
        for (std::size_t k = 0; k < a.size(); ++k)
            if (all.curves.size() == 1 || a[k] != 0)
                all.order.emplace_back(all.curves.size() - 1, k);
    }
    const auto at = [&](const auto& place) { return all.curves[place.first].a[place.second]; };
    std::ranges::stable_sort(all.order, {}, at);
    for (const auto& place : all.order) all.a.push_back(at(place));
    for (std::size_t k = 0; k < all.a.size(); ++k)
        if (std::abs(all.a[k]) < std::abs(all.a[all.start])) all.start = k;
    return all;
}

namespace {

// `values(k)`: of the k-th branch, as many as it has points; or none.
template <class Values>
std::vector<double> joined(const SweepCurve& curve, Values&& values) {
    std::vector<std::vector<double>> each;
    for (std::size_t k = 0; k < curve.curves.size(); ++k) {
        each.push_back(values(k));
        if (each.back().size() != curve.curves[k].a.size()) return {};
    }
    std::vector<double> all;
    for (const auto& [branch, point] : curve.order) all.push_back(each[branch][point]);
    return all;
}

}  // namespace

std::vector<double> SweepCurve::channel(const std::string& name) const {
    return joined(*this, [&](std::size_t k) {
        const JsonCursor& values = curves[k].values;
        const auto found = values.value->is_object() ? values.find(name) : std::nullopt;
        return found ? found->numbers() : std::vector<double>{};
    });
}

std::string WheelInfo::channel(std::string_view quantity) const {
    return name.empty() ? std::string(quantity) : fmt::format("{}.{}", name, quantity);
}

std::vector<WheelInfo> wheels_of(const JsonCursor& scene) {
    std::vector<WheelInfo> wheels;
    if (const auto part = scene.find("wheels"))
        for (const auto& wheel : (*part)["names"].items())
            wheels.push_back({wheel["name"].text(), wheel["side"].text() == "left" ? 1 : -1});
    return wheels;
}

std::vector<std::size_t> thinned(std::size_t size, std::size_t count) {
    std::vector<std::size_t> kept;
    if (size == 0) return kept;
    count = std::min(size, count);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t at = count == 1 ? size - 1 : k * (size - 1) / (count - 1);
        kept.push_back(at);
    }
    return kept;
}

double worse(double a, double b) { return std::isnan(a) || a > b ? a : b; }

namespace {

// With as many digits as entered, up to six.
std::string given(double value) {
    int digits = 1;
    while (digits < 6 && parsed_number(fmt::format("{:.{}e}", value, digits - 1)) != value)
        ++digits;
    return number(value, digits);
}

std::string written(double value, Digits digits) {
    if (!std::isfinite(value)) return number(value);
    switch (digits) {
        case Digits::whole:
            return std::abs(value) < 1e15 ? whole_number(std::lround(value)) : number(value);
        case Digits::given: return given(value);
        case Digits::size: return number(value, 2);
        case Digits::three: return number(value, 3);
        case Digits::percent: return percent(value);
        case Digits::hidden:
        case Digits::words: break;
    }
    return {};
}

}  // namespace

Table page_table(std::string caption, const compare::Table& table) {
    Table page{.caption = std::move(caption),
               .rows = std::vector<std::vector<std::string>>(table.rows.size())};
    for (const auto& column : shown_columns(table, written)) {
        page.columns.push_back({column.heading, column.words});
        for (std::size_t r = 0; r < page.rows.size(); ++r) page.rows[r].push_back(column.cells[r]);
    }
    return page;
}

std::string configuration(const JsonCursor& chosen) {
    const std::string method = chosen["method"].text();
    if (const auto steps = chosen.find("steps"))
        return fmt::format("{}, {} steps", method, whole_number(steps->whole()));
    if (const auto own = chosen.find("own_tolerance_m"))
        return fmt::format("{}, tolerance {}", method, setting(1e3 * own->number(), "mm"));
    return method + " solution";
}

std::string slug(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        const bool plain = (lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9');
        if (plain)
            result.push_back(lower);
        else if (!result.empty() && result.back() != '-')
            result.push_back('-');
    }
    if (result.size() > 40) result.resize(40);
    while (!result.empty() && result.back() == '-') result.pop_back();
    return result.empty() ? "x" : result;
}

}  // namespace elastocheck::reports
