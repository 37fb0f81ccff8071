// Access to a scene in result.json, shared by several sections.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/outputs/readings.hpp"
#include "reports/json/json_cursor.hpp"
#include "reports/page/page.hpp"
#include "reports/render/render.hpp"
#include "reports/text/words.hpp"

namespace elastocheck::reports {

struct ChannelInfo {
    std::string name, unit;
    bool main = true, kinematic = true;  // kinematic: a position or an angle, not a force
    std::string definition = {};
    bool drive = false;  // effort of a driver

    std::string owner() const;     // of "left.toe": "left"; empty without
    std::string quantity() const;  // of "left.toe": "toe"

    bool angle() const { return unit == "deg"; }
    std::string label() const;    // "wheel centre y"
    std::string heading() const;  // "wheel centre y [mm]"
};
std::vector<ChannelInfo> channels_of(const JsonCursor& scene);
std::vector<ChannelInfo> main_channels_of(const JsonCursor& scene);

// One leg's curve over one branch.
struct LegCurve {
    std::string leg;
    std::vector<double> a;  // the branch's parameter
    std::vector<double> x;  // other abscissa, empty if unusable
    JsonCursor values;

    std::vector<double> channel(const std::string& name) const;
    std::size_t start() const;  // the point nearest to a = 0; 0 of an empty curve
};
// Empty where the branch has no such leg.
LegCurve curve_of(const JsonCursor& branch, std::string_view leg);

// Name and unit of the abscissa of a branch besides its parameter: "travel [mm]"; empty if there is
// none.
std::string abscissa_of(const JsonCursor& scene, const JsonCursor& branch);

// Branches that together form one two-sided sweep from the design position share a plot.
struct Sweep {
    std::string name;      // "jounce and rebound"
    std::string unit;      // of the parameter, "N"
    std::string abscissa;  // other abscissa, "travel [mm]"; empty if unusable
    std::vector<JsonCursor> branches;
    std::string kind = "other";  // what it moves: "heave", "roll", "steering", ... (README.md)

    bool has(std::string_view branch) const;  // by its name
    bool lifts() const { return kind == "heave" || kind == "roll" || kind == "travel"; }
    std::string parameter() const;           // "load [N]", "rack [mm]"
    std::string at_equal_parameter() const;  // "at equal load"
    std::string at_equal_abscissa() const;   // "at equal travel"
};
std::vector<Sweep> sweeps_of(const JsonCursor& scene);
// of one branch; includes its abscissa even if that is not monotonic
Sweep sweep_of(const JsonCursor& scene, const JsonCursor& branch);

// Leading sweep of the page: heave of all wheels, else the first travel, else the first.
std::optional<Sweep> leading_sweep(const JsonCursor& scene);

// Whether a side of a branch ("travel to 80 mm", or the branch itself) is of the leading sweep: the
// studies have a figure of these alone.
bool leads(const JsonCursor& scene, const std::string& side);

// Curves of the full solution over a sweep: both sides of the design position as one, in ascending
// order of the parameter.
struct SweepCurve {
    std::vector<double> a;
    std::size_t start = 0;  // the point nearest to a = 0

    std::vector<double> channel(const std::string& name) const;  // empty if there is none

    std::vector<JsonCursor> branches{};
    std::vector<LegCurve> curves{};
    std::vector<std::pair<std::size_t, std::size_t>> order{};  // curve and point
};
SweepCurve sweep_curve(const Sweep& sweep);

// A wheel of the scene. `side` is +1 left, -1 right.
struct WheelInfo {
    std::string name;  // empty of the only one
    int side = 1;
    std::string channel(std::string_view quantity) const;  // "left.toe"
};
std::vector<WheelInfo> wheels_of(const JsonCursor& scene);

// Up to `count` evenly spaced indices of 0 ... size - 1, including both ends.
std::vector<std::size_t> thinned(std::size_t size, std::size_t count);

// The larger one; NaN if one of them is NaN.
double worse(double a, double b);

// A study's table as a table of the page, without empty columns.
Table page_table(std::string caption, const compare::Table& table);
template <class Row>
Table page_table(std::string caption, const std::vector<Row>& rows) {
    return page_table(std::move(caption), compare::table_of(rows));
}

// "tangent, 60 steps"; "adaptive, tolerance 0.1 mm"; "equilibrium solution". For a point or a
// recommendation.
std::string configuration(const JsonCursor& chosen);

std::string slug(const std::string& text);  // for ids and file names: a-z, 0-9, -

}  // namespace elastocheck::reports
