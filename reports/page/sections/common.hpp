// What several sections need of a scene in result.json.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/readings.hpp"
#include "reports/document/field.hpp"
#include "reports/page/page.hpp"
#include "reports/tables/render.hpp"

namespace elastocheck::reports {

struct ChannelInfo {
    std::string name, unit;
    bool main = true, kinematic = true;  // kinematic: a position or an angle, no force
    std::string definition = {};

    bool angle() const { return unit == "deg"; }
    std::string label() const;    // "wheel centre y"
    std::string heading() const;  // "wheel centre y [mm]"
};
std::vector<ChannelInfo> channels_of(const Field& scene);
std::vector<ChannelInfo> main_channels_of(const Field& scene);

// One leg's curve over one branch.
struct LegCurve {
    std::string leg;
    std::vector<double> a;  // the branch's parameter
    std::vector<double> x;  // what else it is read over, empty where it cannot be
    Field values;

    std::vector<double> channel(const std::string& name) const { return values[name].numbers(); }
    std::size_t start() const;  // the point nearest to a = 0; 0 of an empty curve
};
LegCurve curve_of(const Field& branch, std::string_view leg);

// Name and unit of what a branch is read over besides its parameter: "travel [mm]"; empty where there is nothing.
std::string abscissa_of(const Field& scene, const Field& branch);

// Branches that are one sweep out from the design position both ways share a plot.
struct Sweep {
    std::string name;      // "jounce and rebound"
    std::string unit;      // of the parameter, "N"
    std::string abscissa;  // what else they are drawn over, "travel [mm]"; empty where it cannot be
    std::vector<Field> branches;
    bool lifts = false;  // a wheel, and moves nothing else: wheel rates are said of it

    std::string parameter() const;           // "load [N]", "parameter [mm]"
    std::string at_equal_parameter() const;  // "at equal load"
    std::string at_equal_abscissa() const;   // "at equal travel"
};
std::vector<Sweep> sweeps_of(const Field& scene);
Sweep sweep_of(const Field& scene, const Field& branch);  // alone; its abscissa even where it turns back

// The one that leads the page: the first that lifts a wheel, else the first.
std::optional<Sweep> leading_sweep(const Field& scene);

// Up to `count` positions evenly over 0 ... size - 1, both ends among them.
std::vector<std::size_t> thinned(std::size_t size, std::size_t count);

double largest(const std::vector<double>& values);  // in size; NaN where one is

// Columns of a study's table as a table of the page; those in which nothing stands are left out.
Table page_table(std::string caption, const compare::Table& table, const std::vector<Shown>& shown);

// "a", "a and b", "a, b and c"
std::string enumerated(const std::vector<std::string>& words);

// "tangent, 60 steps"; "adaptive, tolerance 0.1 mm"; "equilibrium solution". Of a point or a recommendation.
std::string configuration(const Field& chosen);

std::string slug(const std::string& text);  // for ids and file names: a-z, 0-9, -

}  // namespace elastocheck::reports
