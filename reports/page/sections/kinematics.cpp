// Sections: outputs of the full solution over travel, steering and load, one figure a quantity with
// all load cases on it, and tables with the wheels as columns.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/inputs/candidate.hpp"
#include "reports/page/sections/inputs/measured.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

// How a quantity of a wheel is shown.
enum class Shown {
    as_is,
    change,          // since the start of the branch, where the suspension is settled
    outward_change,  // likewise, of a y coordinate
    steer_angle,     // toe, positive to the left
};

struct Quantity {
    std::string name;  // "toe"; "wheel_load"
    std::string title, sign;
    Shown shown = Shown::as_is;
};

const std::vector<Quantity> over_travel{
    {"toe", "Toe angle", "toe-in positive"},
    {"camber", "Camber angle", "top outwards positive"},
    {"track_change", "Lateral position of the contact patch",
     "from its drawn position, outwards positive"},
    {"wheel_centre_x", "Longitudinal movement of the wheel centre",
     "since the start of the branch, forward positive", Shown::change},
    {"caster", "Caster angle", "top backwards positive"},
    {"wheel_load", "Wheel load", "the force of the road; negative: the wheel would lift off"},
    {"wheel_rate", "Wheel rate", "both wheels loaded alike, without the tyre"},
    {"roll_centre_height", "Roll centre height", "above the road"},
};
const std::vector<Quantity> over_steering{
    {"toe", "Steer angle", "to the left positive", Shown::steer_angle},
    {"camber", "Camber angle", "top outwards positive"},
    {"ackermann", "Ackermann", "100 %: no tyre slips at low speed"},
    {"caster", "Caster angle", "top backwards positive"},
    {"scrub_radius", "Scrub radius", "steering axis inboard of the patch positive"},
    {"mechanical_trail", "Mechanical trail", "steering axis ahead of the patch positive"},
};
const std::vector<Quantity> over_load{
    {"toe", "Toe change", "toe-in positive", Shown::change},
    {"camber", "Camber change", "top outwards positive", Shown::change},
    {"track_change", "Lateral displacement of the contact patch", "outwards positive",
     Shown::change},
    {"wheel_centre_x", "Longitudinal displacement of the wheel centre", "forward positive",
     Shown::change},
};
// Drawn only where they were measured, or computed by a candidate.
const std::vector<Quantity> when_given{
    {"wheel_centre_y", "Lateral movement of the wheel centre", "outwards positive",
     Shown::outward_change},
    {"wheel_centre_z", "Vertical movement of the wheel centre", "up positive", Shown::change},
};

// From the values of an output to what is shown: factor · (value - origin).
struct Scale {
    double factor = 1, origin = 0;
    double operator()(double value) const { return factor * (value - origin); }
};
Scale scale_of(const Quantity& quantity, int side, const std::vector<double>& values,
               std::size_t start) {
    const double first = start < values.size() ? values[start] : 0;
    switch (quantity.shown) {
        case Shown::as_is: return {};
        case Shown::change: return {1, first};
        case Shown::outward_change: return {1.0 * side, first};
        case Shown::steer_angle: return {-1.0 * side, 0};
    }
    return {};
}

// ---- Curves

struct Case {
    Sweep sweep;
    SweepCurve curve;
    std::string legend() const { return as_words(sweep.name); }
};

// Force or moment on a wheel as the figures of a K&C test count it: the parameter times `factor`; of
// a wheel that is not loaded that on the other one.
struct Push {
    double factor = 1;
    std::string positive{};  // "inwards"; empty: the parameter as it stands
};
Push push_of(const Case& c, const std::vector<WheelInfo>& wheels, const WheelInfo& wheel) {
    const auto pushes = c.sweep.branches.front().find("pushes");
    if (!pushes || !pushes->value->is_object()) return {};
    const auto factors = (*pushes)["per_unit"].numbers();
    Push push{0, (*pushes)["positive"].text()};
    for (std::size_t w = 0; w < std::min(wheels.size(), factors.size()); ++w)
        if (factors[w] != 0 && (push.factor == 0 || wheels[w].name == wheel.name))
            push.factor = factors[w];
    return push;
}

// Load cases that share an abscissa, and what is drawn over it.
struct Family {
    std::string id, x;         // "travel", "wheel travel [mm]"
    bool over_travel = false;  // each wheel over its own travel; else over the parameter
    std::vector<Case> cases{};
    std::vector<Quantity> quantities{};
    bool over_push = false;  // each wheel over the force on it, not over the parameter
};

// Channel of a quantity of a wheel, or of the whole scene; empty if there is none.
struct Found {
    std::string channel, unit;
    WheelInfo wheel;
    bool of_all = false;  // of no wheel alone
};
std::vector<Found> find(const std::vector<ChannelInfo>& channels,
                        const std::vector<WheelInfo>& wheels, const std::string& quantity) {
    std::vector<Found> found;
    for (const auto& wheel : wheels)
        for (const auto& c : channels)
            if (c.name == wheel.channel(quantity)) found.push_back({c.name, c.unit, wheel});
    if (found.empty())
        for (const auto& c : channels)
            if (c.name == quantity)
                found.push_back({c.name, c.unit, wheels.empty() ? WheelInfo{} : wheels[0], true});
    return found;
}

std::vector<double> values_of(const Case& c, const Found& of) {
    return c.curve.channel(of.channel);
}
std::vector<double> abscissa_of(const Case& c, const Family& family, const WheelInfo& wheel,
                                double push) {
    auto x = family.over_travel ? c.curve.channel(wheel.channel("travel")) : c.curve.a;
    for (double& value : x) value *= push;
    return x;
}

constexpr double rest = 1e-9;  // mm, deg, N: less is rounding
double at_rest(double value) { return std::abs(value) < rest ? 0 : value; }

using Rows = std::vector<std::vector<double>>;
// In the same order, or in the opposite one, as of two wheels in roll.
bool in_order(const Rows& a, const Rows& b) {
    double size = 0;
    for (const auto& row : a)
        for (const double v : row) size = std::max(size, std::abs(v));
    if (a.size() != b.size()) return false;
    for (std::size_t k = 0; k < a.size(); ++k) {
        if (a[k].size() != b[k].size()) return false;
        for (std::size_t j = 0; j < a[k].size(); ++j)
            if (!(std::abs(a[k][j] - b[k][j]) <= 1e-6 * size)) return false;
    }
    return true;
}

bool same(const Rows& a, const Rows& b) {
    return in_order(a, b) || in_order(a, {b.rbegin(), b.rend()});
}

constexpr Colour case_colours[] = {vermilion, blue, green, purple, ochre, pink, slate, sky};

// Numbers of a figure: of every curve some points.
Table numbers(const Figure& figure) {
    Table table{.caption = fmt::format("{} over {}", figure.y, figure.x), .folded = true};
    std::size_t most = 0;
    std::vector<Rows> stations;
    for (const auto& series : figure.series) {
        Rows rows;
        for (const auto& row : series.rows)
            if (!row.empty()) rows.push_back(row);
        Rows kept;
        for (const auto k : thinned(rows.size(), 7)) kept.push_back(rows[k]);
        most = std::max(most, kept.size());
        stations.push_back(std::move(kept));
        table.columns.push_back({series.title + ": " + figure.x});
        table.columns.push_back({figure.y});
    }
    for (std::size_t k = 0; k < most; ++k) {
        table.rows.emplace_back();
        for (const auto& rows : stations)
            for (std::size_t j = 0; j < 2; ++j)
                table.rows.back().push_back(k < rows.size() ? number(rows[k][j], 4) : "–");
    }
    return table;
}

std::optional<FigureGroup> figure(const JsonCursor& scene, const Family& family,
                                  const std::vector<ChannelInfo>& channels,
                                  const std::vector<WheelInfo>& wheels, const Quantity& quantity) {
    const auto found = find(channels, wheels, quantity.name);
    if (found.empty()) return std::nullopt;
    Figure figure{.id = fmt::format("{}-{}", slug(quantity.name), family.id),
                  .title = quantity.title,
                  .x = family.x,
                  .y = fmt::format("{} [{}]",
                                   quantity.shown == Shown::as_is         ? as_words(quantity.name)
                                   : quantity.shown == Shown::steer_angle ? "steer angle"
                                                                          : "change",
                                   found[0].unit)};
    const bool several = family.cases.size() > 1;
    const auto direction = [&](std::size_t k) {
        const Push push = family.over_push ? push_of(family.cases[k], wheels, wheels[0]) : Push{};
        return push.positive.empty() ? "" : ", " + push.positive;
    };
    if (!several && family.over_push) figure.x += direction(0);
    double low = INFINITY, high = -INFINITY, moved = 0;
    bool apart = false;          // some wheels have curves of their own
    std::vector<Series> others;  // measured, candidates
    for (std::size_t k = 0; k < family.cases.size(); ++k) {
        const Case& c = family.cases[k];
        std::vector<Rows> drawn;
        for (const auto& of : found) {
            const double push = family.over_push ? push_of(c, wheels, of.wheel).factor : 1;
            const auto values = values_of(c, of), x = abscissa_of(c, family, of.wheel, push);
            if (values.empty() || values.size() != x.size()) continue;
            const Scale scale = scale_of(quantity, of.wheel.side, values, c.curve.start);
            Rows rows;
            double least = INFINITY, most = -INFINITY;
            for (const auto j : thinned(values.size(), 41)) {
                const double y = scale(values[j]);
                if (!std::isfinite(y) || !std::isfinite(x[j])) {
                    if (!rows.empty()) rows.emplace_back();
                    continue;
                }
                rows.push_back({at_rest(x[j]), at_rest(y)});
                least = std::min(least, y), most = std::max(most, y);
            }
            low = std::min(low, least), high = std::max(high, most);
            if (most > least) moved = std::max(moved, most - least);
            const std::string by = family.over_travel ? of.wheel.channel("travel") : "";
            if (!of.channel.empty()) {
                auto given = candidate_series(scene, c.sweep, by, of.channel);
                if (auto points = measured_series(scene, c.sweep, by, of.channel))
                    given.insert(given.begin(), std::move(*points));
                for (auto& points : given) {
                    for (auto& row : points.rows)
                        if (!row.empty()) row[0] *= push, row[1] = scale(row[1]);
                    others.push_back(std::move(points));
                }
            }
            if (rows.empty() ||
                std::ranges::any_of(drawn, [&](const Rows& r) { return same(r, rows); }))
                continue;
            apart = apart || (!drawn.empty() && wheels.size() > 1);
            const std::string whose = of.of_all || of.wheel.name.empty() ? "" : of.wheel.name;
            figure.series.push_back({.title = several && !whose.empty() ? c.legend() + ", " + whose
                                              : several                 ? c.legend()
                                              : whose.empty()           ? "full solution"
                                                                        : whose,
                                     .style = !drawn.empty()      ? Series::Style::dashed
                                              : several && k == 0 ? Series::Style::heavy
                                                                  : Series::Style::line,
                                     .colour = several ? case_colours[k % std::size(case_colours)]
                                                       : (drawn.empty() ? vermilion : blue),
                                     .rows = rows,
                                     .keys = {k}});
            if (found.size() > 1) figure.series.back().keys.push_back(drawn.empty() ? 0 : 1);
            drawn.push_back(std::move(rows));
        }
    }
    // a quantity that does not move is left out, unless it was measured
    if (figure.series.empty() ||
        (others.empty() && !(moved > 1e-6 * std::max(1e-3, std::max(std::abs(low), high)))))
        return std::nullopt;
    const auto entry = [](std::string title, Series::Style style, Colour colour) {
        return Series{.title = std::move(title), .style = style, .colour = colour};
    };
    if (several || apart) {
        if (several)
            for (std::size_t k = 0; k < family.cases.size(); ++k)
                figure.legend.push_back(entry(family.cases[k].legend() + direction(k),
                                              k == 0 ? Series::Style::heavy : Series::Style::line,
                                              case_colours[k % std::size(case_colours)]));
        const std::size_t sides = figure.legend.size();
        if (apart) {
            figure.legend.push_back(
                entry(wheels[0].name, Series::Style::line, several ? ink : vermilion));
            figure.legend.push_back(
                entry(wheels[1].name, Series::Style::dashed, several ? ink : blue));
        }
        for (auto& series : figure.series) {
            std::vector<std::size_t> keys;
            if (several) keys.push_back(series.keys[0]);
            if (apart && series.keys.size() > 1) keys.push_back(sides + series.keys[1]);
            series.keys = keys;
        }
    }
    for (auto& series : others) {
        const auto of = std::ranges::find(figure.legend, series.title, &Series::title);
        series.keys = {static_cast<std::size_t>(of - figure.legend.begin())};
        if (of == figure.legend.end() && !figure.legend.empty())
            figure.legend.push_back(entry(series.title, series.style, series.colour)),
                figure.legend.back().mark = series.mark;
        figure.series.push_back(std::move(series));
    }
    std::vector<std::string> names;
    for (const auto& c : family.cases) names.push_back(c.sweep.name);
    figure.description =
        fmt::format("{} over {} by the full solution, {}: from {} to {} {}.", quantity.title,
                    family.x, enumerated(names), number(low), number(high), found[0].unit);
    const bool pair = found.size() > 1 && wheels.size() > 1 && !apart;
    FigureGroup group{
        fmt::format(
            "{}{}", quantity.sign,
            pair ? fmt::format("; {} and {} coincide", wheels[0].name, wheels[1].name) : ""),
        {figure},
        numbers(figure)};
    if (group.caption.empty()) group.caption = figure.title;
    group.caption[0] = static_cast<char>(std::toupper(group.caption[0]));
    return group;
}

// ---- Tables

// Columns of a table over a sweep: a quantity of each wheel, once where the wheels agree.
void add_columns(Table& table, const Case& c, const std::vector<std::size_t>& at,
                 const std::vector<ChannelInfo>& channels, const std::vector<WheelInfo>& wheels,
                 const Quantity& quantity, const std::string& heading, int digits) {
    const auto found = find(channels, wheels, quantity.name);
    std::vector<std::vector<std::string>> columns;
    std::vector<std::string> names;
    for (const auto& of : found) {
        const auto values = values_of(c, of);
        if (values.empty()) continue;
        const Scale scale = scale_of(quantity, of.wheel.side, values, c.curve.start);
        std::vector<std::string> cells;
        for (const auto k : at)
            cells.push_back(table.columns.empty() ? short_number(at_rest(scale(values[k])))
                                                  : number(at_rest(scale(values[k])), digits));
        if (std::ranges::all_of(cells, [](const auto& cell) { return cell == "–"; })) continue;
        columns.push_back(std::move(cells));
        names.push_back(of.of_all ? "" : of.wheel.name);
    }
    if (columns.size() == 2 && columns[0] == columns[1]) columns.pop_back(), names = {""};
    for (std::size_t k = 0; k < columns.size(); ++k) {
        table.columns.push_back({fmt::format("{}{}{} [{}]", heading, names[k].empty() ? "" : " ",
                                             names[k], found[0].unit)});
        for (std::size_t r = 0; r < at.size(); ++r) table.rows[r].push_back(columns[k][r]);
    }
}

// Outputs over a sweep at some points of it.
Table stations(const Case& c, const std::string& caption, const std::vector<ChannelInfo>& channels,
               const std::vector<WheelInfo>& wheels, const std::vector<Quantity>& quantities) {
    Table table{.caption = caption};
    std::vector<std::size_t> at = thinned(c.curve.a.size(), 9);
    if (std::ranges::find(at, c.curve.start) == at.end() && c.curve.start < c.curve.a.size())
        at.insert(std::ranges::lower_bound(at, c.curve.start), c.curve.start);
    table.rows.resize(at.size());
    if (!c.sweep.lifts()) {  // else by travel
        table.columns.push_back({c.sweep.parameter()});
        for (std::size_t r = 0; r < at.size(); ++r)
            table.rows[r].push_back(short_number(c.curve.a[at[r]]));
    }
    for (const auto& quantity : quantities)
        add_columns(table, c, at, channels, wheels, quantity,
                    quantity.shown == Shown::steer_angle ? "steer angle" : as_words(quantity.name),
                    4);
    return table;
}

// Changes at the ends of a load case, a quantity a row.
Table at_ends(const Case& c, const std::vector<ChannelInfo>& channels,
              const std::vector<WheelInfo>& wheels, const std::vector<Quantity>& quantities) {
    const std::string direction = push_of(c, wheels, wheels[0]).positive;
    Table table{.caption = fmt::format("{}{}{}: changes since the start of the branch", c.legend(),
                                       direction.empty() ? "" : ", ", direction),
                .columns = {{"change", true}}};
    std::vector<std::size_t> ends;
    for (const std::size_t k : {std::size_t{0}, c.curve.a.size() - 1})
        if (k != c.curve.start) ends.push_back(k);
    for (const auto k : ends)
        for (const auto& wheel : wheels)
            table.columns.push_back({fmt::format(
                "{}{}{} {}", wheel.name, wheel.name.empty() ? "at " : ", ",
                short_number(push_of(c, wheels, wheel).factor * c.curve.a[k]), c.sweep.unit)});
    for (const auto& quantity : quantities) {
        const auto found = find(channels, wheels, quantity.name);
        if (found.size() != wheels.size()) continue;
        std::vector<std::string> row{
            fmt::format("{} [{}], {}", as_words(quantity.name), found[0].unit, quantity.sign)};
        for (const auto k : ends)
            for (const auto& of : found) {
                const auto values = values_of(c, of);
                row.push_back(values.empty()
                                  ? "–"
                                  : number(at_rest(scale_of(quantity, of.wheel.side, values,
                                                            c.curve.start)(values[k]))));
            }
        table.rows.push_back(std::move(row));
    }
    return table;
}

// ---- Sections

std::vector<Case> cases_of(const JsonCursor& scene, const std::function<bool(const Sweep&)>& in) {
    std::vector<Case> cases;
    if (!scene.find("branches")) return cases;
    for (const auto& sweep : sweeps_of(scene))
        if (in(sweep)) {
            cases.push_back({sweep, sweep_curve(sweep)});
            if (cases.back().curve.a.size() < 2) cases.pop_back();
        }
    return cases;
}

void add_figures(Section& section, const JsonCursor& scene, const Family& family) {
    if (family.cases.empty()) return;
    const auto channels = channels_of(scene);
    const auto wheels = wheels_of(scene);
    for (const auto& quantity : family.quantities)
        if (auto made = figure(scene, family, channels, wheels, quantity))
            section.figures.push_back(std::move(*made));
    for (const auto& quantity : when_given) {
        const auto found = find(channels, wheels, quantity.name);
        const bool given = std::ranges::any_of(found, [&](const Found& of) {
            return std::ranges::any_of(family.cases, [&](const Case& c) {
                const std::string by = family.over_travel ? of.wheel.channel("travel") : "";
                return measured_series(scene, c.sweep, by, of.channel) ||
                       !candidate_series(scene, c.sweep, by, of.channel).empty();
            });
        });
        if (given)
            if (auto made = figure(scene, family, channels, wheels, quantity))
                section.figures.push_back(std::move(*made));
    }
}

// Forces or moments of the joints that the parameter moves.
std::vector<std::string> efforts_of(const Sweep& sweep) {
    const auto efforts = sweep.branches.front().find("efforts");
    return efforts ? efforts->texts() : std::vector<std::string>{};
}

// Outputs of a scene without wheels, of those that the parameter moves.
std::vector<Quantity> all_outputs(const JsonCursor& scene, const std::vector<Case>& cases) {
    std::vector<Quantity> quantities;
    for (const auto& c : channels_of(scene)) {
        const bool drives = std::ranges::any_of(cases, [&](const Case& k) {
            const auto efforts = efforts_of(k.sweep);
            return std::ranges::find(efforts, c.name) != efforts.end();
        });
        if (c.main || drives)
            quantities.push_back({c.name, c.label(), "", drives ? Shown::as_is : Shown::change});
    }
    return quantities;
}

// Diameter of the circle that the outer front wheel's patch follows, the rear wheels rolling along
// it: 2 l / sin δ of the smaller angle.
std::string turning_circle(const JsonCursor& scene, const Case& c) {
    const auto vehicle = scene["wheels"].find("vehicle");
    if (!vehicle) return {};
    double angle = INFINITY;
    for (const std::size_t k : {std::size_t{0}, c.curve.a.size() - 1}) {
        if (k == c.curve.start) continue;
        for (const auto& wheel : wheels_of(scene)) {
            const auto toe = c.curve.channel(wheel.channel("toe"));
            if (!toe.empty()) angle = std::min(angle, std::abs(toe[k]));
        }
    }
    if (!(angle > 2 && angle < 90)) return {};
    const double diameter =
        2e-3 * (*vehicle)["wheelbase_mm"].number() / std::sin(angle * M_PI / 180);
    return fmt::format("{}\u00a0m", number(diameter));
}

bool pushes(const Sweep& sweep) {
    return sweep.kind == "lateral force" || sweep.kind == "longitudinal force" ||
           sweep.kind == "moment";
}

}  // namespace

std::optional<Section> kinematics_section(const JsonCursor& scene) {
    const auto wheels = wheels_of(scene);
    const auto cases = cases_of(scene, &Sweep::lifts);
    if (wheels.empty() || cases.empty()) return std::nullopt;
    Section section{.id = "kinematics", .title = "Kinematics over travel", .part = Part::behaviour};
    section.words["several"] = wheels.size() > 1;
    std::vector<Case> by_parameter;
    Family family{"travel", "wheel travel [mm]", true, {}, over_travel};
    for (const auto& c : cases)
        (measured_over_parameter(scene, c.sweep) ? by_parameter : family.cases).push_back(c);
    add_figures(section, scene, family);
    for (const auto& c : by_parameter)
        add_figures(section, scene,
                    {slug(c.sweep.name), c.sweep.parameter(), false, {c}, over_travel});
    std::vector<std::string> shown;
    for (const auto& c : cases) {
        if (std::ranges::find(shown, c.sweep.kind) != shown.end()) continue;
        shown.push_back(c.sweep.kind);
        std::vector<Quantity> quantities{{"travel", "", ""}};
        quantities.insert(quantities.end(), over_travel.begin(), over_travel.begin() + 6);
        section.tables.push_back(stations(c,
                                          fmt::format("{}, load case {}", c.sweep.kind, c.legend()),
                                          channels_of(scene), wheels, quantities));
        section.tables.back().caption[0] =
            static_cast<char>(std::toupper(section.tables.back().caption[0]));
    }
    return section;
}

std::optional<Section> steering_section(const JsonCursor& scene) {
    const auto cases = cases_of(scene, [](const Sweep& s) { return s.kind == "steering"; });
    if (cases.empty()) return std::nullopt;
    Section section{.id = "steering", .title = "Steering", .part = Part::behaviour};
    for (const auto& c : cases) {
        const Family family{slug(c.sweep.name), c.sweep.parameter(), false, {c}, over_steering};
        add_figures(section, scene, family);
        std::vector<Quantity> quantities(over_steering.begin(), over_steering.begin() + 3);
        for (const auto& effort : efforts_of(c.sweep)) quantities.push_back({effort, "", ""});
        section.tables.push_back(stations(c, "Steering, load case " + c.legend(),
                                          channels_of(scene), wheels_of(scene), quantities));
        if (const std::string circle = turning_circle(scene, c); !circle.empty())
            section.words["circle"] = circle;
    }
    return section;
}

std::optional<Section> compliance_section(const JsonCursor& scene) {
    const auto wheels = wheels_of(scene);
    auto cases = cases_of(scene, pushes);
    if (wheels.empty() || cases.empty()) return std::nullopt;
    Section section{.id = "compliance",
                    .title = "Compliance under forces and moments",
                    .part = Part::behaviour};
    for (const char* unit : {"N", "N·m"}) {
        Family family{unit == std::string("N") ? "force" : "moment",
                      fmt::format("{} [{}]", unit == std::string("N") ? "force" : "moment", unit)};
        family.over_push = true;
        for (const auto& c : cases)
            if (c.sweep.unit == unit) family.cases.push_back(c);
        family.quantities = over_load;
        if (unit != std::string("N")) family.quantities.resize(2);
        add_figures(section, scene, family);
    }
    for (const auto& c : cases)
        section.tables.push_back(at_ends(c, channels_of(scene), wheels, over_load));
    return section;
}

std::optional<Section> curves_section(const JsonCursor& scene) {
    const bool no_wheels = wheels_of(scene).empty();
    const auto cases = cases_of(scene, [&](const Sweep& s) {
        return no_wheels || !(s.lifts() || s.kind == "steering" || pushes(s));
    });
    if (cases.empty()) return std::nullopt;
    Section section{.id = "curves", .title = "Outputs over load or drive", .part = Part::behaviour};
    std::vector<std::string> done;
    for (const auto& c : cases) {
        const std::string x = c.sweep.parameter();
        if (std::ranges::find(done, x) != done.end()) continue;
        done.push_back(x);
        Family family{slug(c.sweep.name), x};
        for (const auto& other : cases)
            if (other.sweep.parameter() == x) family.cases.push_back(other);
        family.quantities = no_wheels ? all_outputs(scene, family.cases) : over_load;
        add_figures(section, scene, family);
    }
    if (section.figures.empty()) return std::nullopt;
    return section;
}

}  // namespace elastocheck::reports
