// Access to a scene in result.json, shared by several sections.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/outputs/readings.hpp"
#include "reports/json/json_cursor.hpp"
#include "reports/page/page.hpp"
#include "reports/tables/render.hpp"
#include "reports/text/words.hpp"

namespace elastocheck::reports {

struct ChannelInfo {
    std::string name, unit;
    bool main = true, kinematic = true;  // kinematic: a position or an angle, not a force
    std::string definition = {};

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

    std::vector<double> channel(const std::string& name) const { return values[name].numbers(); }
    std::size_t start() const;  // the point nearest to a = 0; 0 of an empty curve
};
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
    bool lifts = false;  // lifts a wheel and moves nothing else: wheel rates are defined

    std::string parameter() const;           // "load [N]", "parameter [mm]"
    std::string at_equal_parameter() const;  // "at equal load"
    std::string at_equal_abscissa() const;   // "at equal travel"
};
std::vector<Sweep> sweeps_of(const JsonCursor& scene);
// of one branch; includes its abscissa even if that is not monotonic
Sweep sweep_of(const JsonCursor& scene, const JsonCursor& branch);

// Leading sweep of the page: the first that lifts a wheel, else the first.
std::optional<Sweep> leading_sweep(const JsonCursor& scene);

// Up to `count` evenly spaced indices of 0 ... size - 1, including both ends.
std::vector<std::size_t> thinned(std::size_t size, std::size_t count);

double largest(const std::vector<double>& values);  // largest absolute value; NaN if any is NaN

// Columns of a study's table as a table of the page, without empty columns.
Table page_table(std::string caption, const compare::Table& table,
                 const std::vector<ShownColumn>& shown);

// "tangent, 60 steps"; "adaptive, tolerance 0.1 mm"; "equilibrium solution". For a point or a
// recommendation.
std::string configuration(const JsonCursor& chosen);

std::string slug(const std::string& text);  // for ids and file names: a-z, 0-9, -

}  // namespace elastocheck::reports
