// Access to the results of a scene, shared by several sections.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/outputs/readings.hpp"
#include "reports/document/scene_analyses.hpp"
#include "reports/page/page.hpp"
#include "reports/render/render.hpp"
#include "reports/text/words.hpp"

namespace elastocheck::reports {

std::string heading(const compare::Channel& channel);  // "wheel centre y [mm]"

// "left.toe"; "toe" of the only wheel.
std::string output_of(const Wheel& wheel, std::string_view quantity);

// A branch as requested and as solved.
struct ComparedBranch {
    const Branch* requested;
    const compare::BranchComparison* result;

    const std::string& name() const { return result->branch; }
    std::string unit() const { return symbol(result->unit); }
    double from() const;  // [unit]
    double to() const;
    const compare::Curve& truth() const { return result->run(compare::Leg::equilibrium).curve; }
};
std::vector<ComparedBranch> branches_of(const SceneAnalyses& scene);

// Values of a channel along a curve; NaN where it is undefined.
std::vector<double> values_of(const compare::Curve& curve, std::size_t channel);

// Branches that together form one two-sided sweep from the design position share a plot.
struct Sweep {
    std::string name;       // "jounce and rebound"
    std::string unit;       // of the parameter, "N"
    std::string parameter;  // "load [N]", "rack [mm]"
    std::string abscissa;   // other abscissa, "travel [mm]"; empty if unusable
    std::vector<ComparedBranch> branches;
    std::string kind = "other";  // what it moves: load_case() in wheels.hpp

    bool has(std::string_view branch) const;  // by its name
    bool lifts() const { return kind == "heave" || kind == "roll" || kind == "travel"; }
    std::string at_equal_parameter() const;  // "at equal load"
    std::string at_equal_abscissa() const;   // "at equal travel"
};
std::vector<Sweep> sweeps_of(const SceneAnalyses& scene);
// The sweep of one branch; has its abscissa even if that is not monotonic.
Sweep sweep_of(const SceneAnalyses& scene, const ComparedBranch& branch);

// Leading sweep of the page: heave of all wheels, else the first travel, else the first.
std::optional<Sweep> leading_sweep(const SceneAnalyses& scene);

// Whether a side of a branch ("travel to 80 mm"), or a branch, is of the leading sweep, the only one of
// which the studies of methods have figures.
bool leads(const SceneAnalyses& scene, const std::string& side);

// Curves of the full solution over a sweep: both sides of the design position as one, in ascending
// order of the parameter.
struct SweepCurve {
    SweepCurve(const SceneAnalyses& scene, const Sweep& sweep);

    std::vector<double> a{};
    std::size_t start = 0;  // the point nearest to a = 0

    std::vector<double> channel(const std::string& name) const;  // empty if there is none

    const std::vector<compare::Channel>* channels;
    std::vector<const compare::Curve*> curves{};
    std::vector<std::pair<std::size_t, std::size_t>> order{};  // curve and point
};

// A curve of a figure. `legend`: a load case, a spring, "measured" or a candidate; `wheel`: its name, empty
// for a curve of no wheel. A row is abscissa and ordinate; an empty row is a gap.
struct DrawnCurve {
    std::string legend, wheel{};
    std::vector<std::vector<double>> rows{};
};

// Up to `count` evenly spaced indices of 0 ... size - 1, including both ends.
std::vector<std::size_t> thinned(std::size_t size, std::size_t count);

// A table of texts alone.
Table words_table(std::string caption, const std::vector<const char*>& columns);

// "tangent, 60 steps"; "adaptive, tolerance 0.1 mm"; "equilibrium solution".
std::string configuration(const compare::TradePoint& chosen);

std::string slug(const std::string& text);  // for ids and file names: a-z, 0-9, -

}  // namespace elastocheck::reports
