// Sections: outputs of the full solution over travel, steering and load, one figure a quantity with
// all load cases on it, and tables with the wheels as columns.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "compare/outputs/catalogue/catalogue.hpp"
#include "reports/given/wheels.hpp"
#include "reports/page/common.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/sections/inputs/candidate.hpp"
#include "reports/page/sections/inputs/measured.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::drawn_over;
using compare::Over;
using Quantity = compare::DrawnFigure;
using compare::Shown;

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
Push push_of(const SceneAnalyses& scene, const Case& c, const Wheel& wheel) {
    const auto pushes = pushes_of(scene.model, *c.sweep.branches.front().requested);
    if (!pushes) return {};
    Push push{0, pushes->positive};
    for (std::size_t w = 0; w < pushes->per_unit.size(); ++w)
        if (const double factor = pushes->per_unit[w];
            factor != 0 && (push.factor == 0 || scene.model.wheels[w].name == wheel.name))
            push.factor = factor;
    return push;
}

// Load cases that share an abscissa, and what is drawn over it.
struct Family {
    std::string id, x;         // "travel", "wheel travel [mm]"
    bool over_travel = false;  // each wheel over its own travel; else over the parameter
    std::vector<Case> cases{};
    std::vector<Quantity> quantities{};
    bool over_push = false;  // each wheel over the force on it, not over the parameter

    bool several() const { return cases.size() > 1; }
    // Channel that is the abscissa of a wheel; empty: the parameter.
    std::string by(const Wheel& wheel) const {
        return over_travel ? output_of(wheel, compare::figure::travel) : "";
    }
};

// Channel of a quantity of a wheel, or of the whole scene.
struct Found {
    std::string channel, unit;
    Wheel wheel;
    bool of_all = false;  // of no wheel alone
};
std::vector<Found> find(const SceneAnalyses& scene, const std::string& quantity) {
    const auto& channels = scene.comparison.channels;
    const auto& wheels = scene.model.wheels;
    std::vector<Found> found;
    const auto add = [&](const std::string& name, const Wheel& wheel, bool of_all) {
        if (const int c = compare::find_channel(channels, name); c >= 0)
            found.push_back(
                {name, symbol(channels[static_cast<std::size_t>(c)].unit), wheel, of_all});
    };
    for (const auto& wheel : wheels) add(output_of(wheel, quantity), wheel, false);
    if (found.empty()) add(quantity, wheels.empty() ? Wheel{} : wheels[0], true);
    return found;
}

constexpr double rest = 1e-9;  // mm, deg, N: less is rounding
double at_rest(double value) { return std::abs(value) < rest ? 0 : value; }

using Rows = std::vector<std::vector<double>>;
// In the same order, or in the opposite one, as of two wheels in roll.
bool in_order(const Rows& a, const Rows& b) {
    double size = 0;
    for (const auto& row : a)
        for (const double v : row) size = std::max(size, std::abs(v));
    return std::ranges::equal(a, b, [&](const auto& one, const auto& other) {
        return std::ranges::equal(
            one, other, [&](double v, double w) { return std::abs(v - w) <= 1e-6 * size; });
    });
}

bool same(const Rows& a, const Rows& b) {
    return in_order(a, b) || in_order(a, {b.rbegin(), b.rend()});
}

constexpr Colour case_colours[] = {vermilion, blue, green, purple, ochre, pink, slate, sky};

// Numbers of a figure: of every curve some points.
Table numbers(const Figure& figure) {
    constexpr std::size_t most = 7;
    Table table{.rows = std::vector<std::vector<compare::Cell>>(most),
                .caption = fmt::format("{} over {}", figure.y, figure.x),
                .detail = true};
    for (const auto& series : figure.series) {
        Rows rows = series.rows;
        std::erase_if(rows, [](const auto& row) { return row.empty(); });
        const auto kept = thinned(rows.size(), most);
        table.columns.push_back({.name = series.title + ": " + figure.x, .digits = Digits::place});
        table.columns.push_back({.name = figure.y, .digits = Digits::four});
        for (std::size_t k = 0; k < most; ++k)
            for (std::size_t j = 0; j < 2; ++j)
                table.rows[k].emplace_back(k < kept.size() ? rows[kept[k]][j] : compare::nan);
    }
    std::erase_if(table.rows, [](const auto& row) {
        return std::ranges::all_of(row,
                                   [](const auto& c) { return std::isnan(std::get<double>(c)); });
    });
    return table;
}

// A figure in work: the curves of one quantity over all cases and wheels.
struct Curves {
    const SceneAnalyses& scene;
    const Family& family;
    const Quantity& quantity;
    Figure figure{};
    double low = INFINITY, high = -INFINITY, moved = 0;
    bool apart = false;            // some wheels have curves of their own
    std::vector<Series> others{};  // measured, candidates

    // The curve of a wheel in one case; empty where the quantity is undefined.
    Rows rows(const std::vector<double>& x, const std::vector<double>& values, Scale scale) {
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
        return rows;
    }

    void add_others(const Case& c, const Found& of, double push, Scale scale) {
        const std::string by = family.by(of.wheel);
        auto given = candidate_series(scene, c.sweep, by, of.channel);
        if (auto points = measured_series(scene, c.sweep, by, of.channel))
            given.insert(given.begin(), std::move(*points));
        for (auto& points : given) {
            for (auto& row : points.rows)
                if (!row.empty()) row[0] *= push, row[1] = scale(row[1]);
            others.push_back(std::move(points));
        }
    }

    void add(std::size_t k, const std::vector<Found>& found) {
        const Case& c = family.cases[k];
        std::vector<Rows> drawn;
        for (const auto& of : found) {
            const double push = family.over_push ? push_of(scene, c, of.wheel).factor : 1;
            const auto values = c.curve.channel(of.channel);
            const std::string by = family.by(of.wheel);
            auto x = by.empty() ? c.curve.a : c.curve.channel(by);
            for (double& value : x) value *= push;
            if (values.empty() || values.size() != x.size()) continue;
            const Scale scale = scale_of(quantity, of.wheel.side, values, c.curve.start);
            Rows curve = rows(x, values, scale);
            add_others(c, of, push, scale);
            if (curve.empty() ||
                std::ranges::any_of(drawn, [&](const Rows& r) { return same(r, curve); }))
                continue;
            const bool first = drawn.empty(), several = family.several();
            apart = apart || (!first && scene.model.wheels.size() > 1);
            const std::string whose = of.of_all ? "" : of.wheel.name;
            figure.series.push_back({.title = several && !whose.empty() ? c.legend() + ", " + whose
                                              : several                 ? c.legend()
                                              : whose.empty()           ? "full solution"
                                                                        : whose,
                                     .style = !first              ? Series::Style::dashed
                                              : several && k == 0 ? Series::Style::heavy
                                                                  : Series::Style::line,
                                     .colour = several ? case_colours[k % std::size(case_colours)]
                                               : first ? vermilion
                                                       : blue,
                                     .rows = curve,
                                     .keys = {k}});
            if (found.size() > 1) figure.series.back().keys.push_back(first ? 0 : 1);
            drawn.push_back(std::move(curve));
        }
    }

    // ", inwards"
    std::string direction(std::size_t k) const {
        if (!family.over_push) return "";
        const Push push = push_of(scene, family.cases[k], scene.model.wheels[0]);
        return push.positive.empty() ? "" : ", " + push.positive;
    }

    // One entry a case and one a wheel, instead of one a curve.
    void make_legend() {
        const auto entry = [&](std::string title, Series::Style style, Colour colour) {
            figure.legend.push_back({.title = std::move(title), .style = style, .colour = colour});
        };
        const bool several = family.several();
        const auto& wheels = scene.model.wheels;
        if (several || apart) {
            for (std::size_t k = 0; several && k < family.cases.size(); ++k)
                entry(family.cases[k].legend() + direction(k),
                      k == 0 ? Series::Style::heavy : Series::Style::line,
                      case_colours[k % std::size(case_colours)]);
            const std::size_t sides = figure.legend.size();
            if (apart) {
                entry(wheels[0].name, Series::Style::line, several ? ink : vermilion);
                entry(wheels[1].name, Series::Style::dashed, several ? ink : blue);
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
            if (of == figure.legend.end() && !figure.legend.empty()) {
                entry(series.title, series.style, series.colour);
                figure.legend.back().mark = series.mark;
            }
            figure.series.push_back(std::move(series));
        }
    }
};

std::optional<FigureGroup> figure(const SceneAnalyses& scene, const Family& family,
                                  const Quantity& quantity) {
    const auto found = find(scene, quantity.name);
    if (found.empty()) return std::nullopt;
    Curves curves{scene, family, quantity};
    Figure& figure = curves.figure;
    figure = {.id = fmt::format("{}-{}", slug(quantity.name), family.id),
              .title = quantity.title,
              .x = family.x,
              .y = fmt::format("{} [{}]",
                               quantity.shown == Shown::as_is         ? as_words(quantity.name)
                               : quantity.shown == Shown::steer_angle ? "steer angle"
                                                                      : "change",
                               found[0].unit)};
    if (!family.several()) figure.x += curves.direction(0);
    for (std::size_t k = 0; k < family.cases.size(); ++k) curves.add(k, found);
    // a quantity that does not move is left out, unless it was measured
    const double size = std::max(1e-3, std::max(std::abs(curves.low), curves.high));
    if (figure.series.empty() || (curves.others.empty() && !(curves.moved > 1e-6 * size)))
        return std::nullopt;
    curves.make_legend();
    std::vector<std::string> names;
    for (const auto& c : family.cases) names.push_back(c.sweep.name);
    figure.description = fmt::format("{} over {} by the full solution, {}: from {} to {} {}.",
                                     quantity.title, family.x, enumerated(names),
                                     number(curves.low), number(curves.high), found[0].unit);
    const auto& wheels = scene.model.wheels;
    const bool pair = found.size() > 1 && wheels.size() > 1 && !curves.apart;
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

std::string column_heading(const Quantity& quantity, const Found& of, bool whose) {
    return fmt::format(
        "{}{}{} [{}]",
        quantity.shown == Shown::steer_angle ? "steer angle" : as_words(quantity.name),
        whose && !of.wheel.name.empty() ? " " : "", whose ? of.wheel.name : "", of.unit);
}

// Outputs over a sweep at some points of it: a quantity of each wheel, once where the wheels agree.
Table stations(const SceneAnalyses& scene, const Case& c, const std::string& caption,
               const std::vector<Quantity>& quantities) {
    std::vector<std::size_t> at = thinned(c.curve.a.size(), 9);
    if (std::ranges::find(at, c.curve.start) == at.end() && c.curve.start < c.curve.a.size())
        at.insert(std::ranges::lower_bound(at, c.curve.start), c.curve.start);
    std::vector<compare::ColumnOf<std::size_t>> columns;
    const auto add = [&](const std::string& name, std::vector<double> values) {
        columns.push_back(
            {name, columns.empty() ? Digits::place : Digits::four,
             [values = std::move(values)](std::size_t k) { return at_rest(values[k]); }});
    };
    if (!c.sweep.lifts()) add(c.sweep.parameter, c.curve.a);  // else by travel
    for (const auto& quantity : quantities) {
        const auto found = find(scene, quantity.name);
        std::vector<std::vector<double>> values;
        for (const auto& of : found) {
            values.push_back(c.curve.channel(of.channel));
            const Scale scale = scale_of(quantity, of.wheel.side, values.back(), c.curve.start);
            for (double& value : values.back()) value = scale(value);
        }
        const bool agree =
            values.size() == 2 && std::ranges::equal(values[0], values[1], [](double a, double b) {
                return std::isnan(a) ? std::isnan(b) : std::abs(a - b) <= rest + 1e-4 * std::abs(a);
            });
        for (std::size_t k = 0; k < (agree ? 1 : values.size()); ++k)
            add(column_heading(quantity, found[k], !found[k].of_all && !agree), values[k]);
    }
    Table table = compare::table("", columns, at);
    table.caption = caption;
    return table;
}

// Changes at the ends of a load case, a quantity a row.
Table at_ends(const SceneAnalyses& scene, const Case& c, std::vector<Quantity> quantities) {
    const auto& wheels = scene.model.wheels;
    const std::string direction = push_of(scene, c, wheels[0]).positive;
    std::erase_if(quantities, [&](const Quantity& quantity) {
        return find(scene, quantity.name).size() != wheels.size();
    });
    std::vector<compare::ColumnOf<Quantity>> columns{
        {"change", Digits::words, [&](const Quantity& quantity) {
             return fmt::format("{} [{}], {}", as_words(quantity.name),
                                find(scene, quantity.name)[0].unit, quantity.sign);
         }}};
    for (const std::size_t k : {std::size_t{0}, c.curve.a.size() - 1})
        for (std::size_t w = 0; w < wheels.size() && k != c.curve.start; ++w)
            columns.push_back(
                {fmt::format("{}{}{} {}", wheels[w].name, wheels[w].name.empty() ? "at " : ", ",
                             short_number(push_of(scene, c, wheels[w]).factor * c.curve.a[k]),
                             c.sweep.unit),
                 Digits::three, [&scene, &c, k, w](const Quantity& quantity) {
                     const Found of = find(scene, quantity.name)[w];
                     const auto values = c.curve.channel(of.channel);
                     return at_rest(
                         scale_of(quantity, of.wheel.side, values, c.curve.start)(values[k]));
                 }});
    Table table = compare::table("", columns, quantities);
    table.caption = fmt::format("{}{}{}: changes since the start of the branch", c.legend(),
                                direction.empty() ? "" : ", ", direction);
    return table;
}

// ---- Sections

std::vector<Case> cases_of(const SceneAnalyses& scene,
                           const std::function<bool(const Sweep&)>& in) {
    std::vector<Case> cases;
    for (const auto& sweep : sweeps_of(scene))
        if (in(sweep)) {
            cases.push_back({sweep, SweepCurve(scene, sweep)});
            if (cases.back().curve.a.size() < 2) cases.pop_back();
        }
    return cases;
}

// Whether a quantity was measured or computed by a candidate in one of the cases.
bool is_given(const SceneAnalyses& scene, const Family& family, const Quantity& quantity) {
    for (const auto& of : find(scene, quantity.name))
        for (const auto& c : family.cases)
            if (const std::string by = family.by(of.wheel);
                measured_series(scene, c.sweep, by, of.channel) ||
                !candidate_series(scene, c.sweep, by, of.channel).empty())
                return true;
    return false;
}

void add_figures(Section& section, const SceneAnalyses& scene, const Family& family) {
    if (family.cases.empty()) return;
    auto quantities = family.quantities;
    for (const auto& quantity : drawn_over(Over::if_given))
        if (is_given(scene, family, quantity)) quantities.push_back(quantity);
    for (const auto& quantity : quantities)
        if (auto made = figure(scene, family, quantity))
            section.figures.push_back(std::move(*made));
}

// Forces or moments of the joints that the parameter moves.
std::vector<std::string> efforts_of(const SceneAnalyses& scene, const Sweep& sweep) {
    return reports::efforts_of(*sweep.branches.front().requested, scene.comparison.channels);
}

// Outputs of a scene without wheels, of those that the parameter moves.
std::vector<Quantity> all_outputs(const SceneAnalyses& scene, const std::vector<Case>& cases) {
    std::vector<Quantity> quantities;
    for (const auto& c : scene.comparison.channels) {
        const bool drives = std::ranges::any_of(cases, [&](const Case& k) {
            const auto efforts = efforts_of(scene, k.sweep);
            return std::ranges::find(efforts, c.name) != efforts.end();
        });
        if (c.main || drives)
            quantities.push_back(
                {c.name, as_words(c.name), "", drives ? Shown::as_is : Shown::change});
    }
    return quantities;
}

// Diameter of the circle that the outer front wheel's patch follows, the rear wheels rolling along
// it: 2 l / sin δ of the smaller angle.
std::string turning_circle(const SceneAnalyses& scene, const Case& c) {
    if (!scene.model.vehicle) return {};
    double angle = INFINITY;
    for (const std::size_t k : {std::size_t{0}, c.curve.a.size() - 1}) {
        if (k == c.curve.start) continue;
        for (const auto& wheel : scene.model.wheels) {
            const auto toe = c.curve.channel(output_of(wheel, compare::figure::toe));
            if (!toe.empty()) angle = std::min(angle, std::abs(toe[k]));
        }
    }
    if (!(angle > 2 && angle < 90)) return {};
    const double wheelbase_mm = 1e3 * scene.model.vehicle->wheelbase;
    return fmt::format("{}\u00a0m", number(2e-3 * wheelbase_mm / std::sin(angle * M_PI / 180)));
}

bool pushes(const Sweep& sweep) {
    return sweep.kind == "lateral force" || sweep.kind == "longitudinal force" ||
           sweep.kind == "moment";
}

}  // namespace

std::optional<Section> kinematics_section(const SceneAnalyses& scene) {
    const auto cases = cases_of(scene, &Sweep::lifts);
    if (scene.model.wheels.empty() || cases.empty()) return std::nullopt;
    Section section{.id = "kinematics", .title = "Kinematics over travel", .part = Part::behaviour};
    section.words["several"] = scene.model.wheels.size() > 1;
    std::vector<Case> by_parameter;
    Family family{"travel", "wheel travel [mm]", true, {}, drawn_over(Over::travel)};
    for (const auto& c : cases)
        (measured_over_parameter(scene, c.sweep) ? by_parameter : family.cases).push_back(c);
    add_figures(section, scene, family);
    for (const auto& c : by_parameter)
        add_figures(section, scene,
                    {slug(c.sweep.name), c.sweep.parameter, false, {c}, family.quantities});
    std::vector<Quantity> quantities{{std::string(compare::figure::travel), "", ""}};
    quantities.insert(quantities.end(), family.quantities.begin(), family.quantities.begin() + 6);
    std::vector<std::string> shown;
    for (const auto& c : cases) {
        if (std::ranges::find(shown, c.sweep.kind) != shown.end()) continue;
        shown.push_back(c.sweep.kind);
        std::string caption = fmt::format("{}, load case {}", c.sweep.kind, c.legend());
        caption[0] = static_cast<char>(std::toupper(caption[0]));
        section.tables.push_back(stations(scene, c, caption, quantities));
    }
    return section;
}

std::optional<Section> steering_section(const SceneAnalyses& scene) {
    const auto cases = cases_of(scene, [](const Sweep& s) { return s.kind == "steering"; });
    if (cases.empty()) return std::nullopt;
    Section section{.id = "steering", .title = "Steering", .part = Part::behaviour};
    for (const auto& c : cases) {
        const Family family{
            slug(c.sweep.name), c.sweep.parameter, false, {c}, drawn_over(Over::steering)};
        add_figures(section, scene, family);
        std::vector<Quantity> quantities(family.quantities.begin(), family.quantities.begin() + 3);
        for (const auto& effort : efforts_of(scene, c.sweep))
            quantities.push_back({effort, "", ""});
        section.tables.push_back(
            stations(scene, c, "Steering, load case " + c.legend(), quantities));
        if (const std::string circle = turning_circle(scene, c); !circle.empty())
            section.words["circle"] = circle;
    }
    return section;
}

std::optional<Section> compliance_section(const SceneAnalyses& scene) {
    const auto cases = cases_of(scene, pushes);
    if (scene.model.wheels.empty() || cases.empty()) return std::nullopt;
    Section section{.id = "compliance",
                    .title = "Compliance under forces and moments",
                    .part = Part::behaviour};
    for (const bool moment : {false, true}) {
        const std::string unit = moment ? "N·m" : "N", id = moment ? "moment" : "force";
        Family family{.id = id, .x = fmt::format("{} [{}]", id, unit), .over_push = true};
        for (const auto& c : cases)
            if (c.sweep.unit == unit) family.cases.push_back(c);
        family.quantities = drawn_over(Over::load);
        if (moment) family.quantities.resize(2);
        add_figures(section, scene, family);
    }
    for (const auto& c : cases) section.tables.push_back(at_ends(scene, c, drawn_over(Over::load)));
    return section;
}

std::optional<Section> curves_section(const SceneAnalyses& scene) {
    const bool no_wheels = scene.model.wheels.empty();
    const auto cases = cases_of(scene, [&](const Sweep& s) {
        return no_wheels || !(s.lifts() || s.kind == "steering" || pushes(s));
    });
    if (cases.empty()) return std::nullopt;
    Section section{.id = "curves", .title = "Outputs over load or drive", .part = Part::behaviour};
    std::vector<std::string> done;
    for (const auto& c : cases) {
        const std::string& x = c.sweep.parameter;
        if (std::ranges::find(done, x) != done.end()) continue;
        done.push_back(x);
        Family family{slug(c.sweep.name), x};
        for (const auto& other : cases)
            if (other.sweep.parameter == x) family.cases.push_back(other);
        family.quantities = no_wheels ? all_outputs(scene, family.cases) : drawn_over(Over::load);
        add_figures(section, scene, family);
    }
    if (section.figures.empty()) return std::nullopt;
    return section;
}

}  // namespace elastocheck::reports
