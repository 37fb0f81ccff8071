#include "reports/page/common.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/outputs/curve.hpp"
#include "compare/studies/findings.hpp"
#include "reports/tables/select.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {

std::string ChannelInfo::label() const { return as_words(name); }

std::string ChannelInfo::heading() const { return fmt::format("{} [{}]", label(), unit); }

std::vector<ChannelInfo> channels_of(const JsonCursor& scene) {
    std::vector<ChannelInfo> all;
    for (const auto& c : scene["channels"].items())
        all.push_back({c["name"].text(), c["unit"].text(), c["main"].truth(),
                       c["kinematic"].truth(), c["definition"].text()});
    return all;
}

std::vector<ChannelInfo> main_channels_of(const JsonCursor& scene) {
    auto all = channels_of(scene);
    std::erase_if(all, [](const ChannelInfo& c) { return !c.main; });
    return all;
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
    legs.fail(fmt::format("no leg '{}'", leg));
}

std::string Sweep::parameter() const {
    return fmt::format("{} [{}]", compare::parameter_word(unit), unit);
}

std::string Sweep::at_equal_parameter() const { return compare::parameter_reading(unit); }
std::string Sweep::at_equal_abscissa() const {
    return compare::abscissa_reading(abscissa.substr(0, abscissa.find(" [")));
}

Sweep sweep_of(const JsonCursor& scene, const JsonCursor& branch) {
    return {branch["name"].text(), branch["unit"].text(), abscissa_of(scene, branch), {branch}};
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
            sweeps.push_back({name, branch["unit"].text(), abscissa, {branch}});
        } else {
            twin->name += " and " + name;
            if (twin->abscissa != abscissa) twin->abscissa.clear();
            twin->branches.push_back(branch);
        }
    }
    if (const auto rates = scene.find("rate_errors"))
        for (const auto& rate : rates->items())
            for (auto& sweep : sweeps)
                for (const auto& branch : sweep.branches)
                    if (branch["name"].text() == rate["branch"].text()) sweep.lifts = true;
    return sweeps;
}

std::optional<Sweep> leading_sweep(const JsonCursor& scene) {
    if (!scene.find("branches")) return std::nullopt;
    auto sweeps = sweeps_of(scene);
    if (sweeps.empty()) return std::nullopt;
    for (auto& sweep : sweeps)
        if (sweep.lifts) return std::move(sweep);
    return std::move(sweeps.front());
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

double largest(const std::vector<double>& values) {
    double most = 0;
    for (const double value : values) {
        if (!std::isfinite(value)) return value;
        most = std::max(most, std::abs(value));
    }
    return most;
}

namespace {

// With as many digits as entered, up to six.
std::string given(double value) {
    int digits = 1;
    while (digits < 6 && std::stod(fmt::format("{:.{}e}", value, digits - 1)) != value) ++digits;
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
    }
    return {};
}

}  // namespace

Table page_table(std::string caption, const compare::Table& table,
                 const std::vector<ShownColumn>& shown) {
    Table page{.caption = std::move(caption),
               .rows = std::vector<std::vector<std::string>>(table.rows.size())};
    for (const auto& s : nonempty_columns(table, shown)) {
        const std::size_t c = column(table, s.column);
        page.columns.push_back({heading(table, s), table.columns[c].words});
        for (std::size_t r = 0; r < table.rows.size(); ++r) {
            const auto* value = std::get_if<double>(&table.rows[r][c]);
            page.rows[r].push_back(value != nullptr ? written(*value, s.digits)
                                                    : std::get<std::string>(table.rows[r][c]));
        }
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
