// Rows of the studies' tables. A number without a value is NaN; columns() has name, unit, definition, and for readers
// digits, heading and place of each column.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "compare/result/table.hpp"

namespace elastocheck {
struct Model;
}

namespace elastocheck::compare {

// Kinematics and compliance at the design position, with the error of the recursion.
struct CharacteristicRow {
    std::string output{}, unit{};
    double value = nan, apart = nan, recursion = nan, off = nan, off_percent = nan;
    std::string undefined{}, definition{};
    static std::vector<ColumnOf<CharacteristicRow>> columns();
};

// An output of a wheel as drawn and as settled at the start of a branch.
struct StaticRow {
    std::string wheel{}, output{}, unit{};
    double drawn = nan, settled = nan;
    static std::vector<ColumnOf<StaticRow>> columns();
};

// A displacement component at a point of a wheel, by one leg.
struct ComplianceRow {
    static constexpr std::array causes{"force x",  "force y",  "force z",
                                       "moment x", "moment y", "moment z"};
    std::string branch{};
    double a = nan;
    std::string unit{}, leg{}, point{}, wheel{}, answer{}, loaded_wheel{};
    std::array<double, 6> by_cause{};
    double reciprocity = nan;
    static std::vector<ColumnOf<ComplianceRow>> columns();
};

// An element or a link at an end of a branch.
struct ForceRow {
    std::string branch{};
    double end = nan;
    std::string end_unit{}, element{}, output{}, unit{};
    double value = nan, error = nan, share = nan;
    static std::vector<ColumnOf<ForceRow>> columns();
};

// Largest force or moment of an element over the points of a branch, by the equilibrium leg.
struct LargestForceRow {
    std::string branch{};
    double at = nan;
    std::string parameter_unit{}, element{}, output{};
    double value = nan;
    std::string unit{};
    double deformation = nan;
    std::string deformation_unit{};
    static std::vector<ColumnOf<LargestForceRow>> columns();
};

// Spread of a main output over the formulations, beside the deviations of the same scene.
struct FormulationRow {
    std::string branch{}, output{}, unit{};
    double spread = nan, at = nan;
    std::string parameter_unit{}, smallest_by{}, largest_by{};
    double apart = nan, deviation = nan;
    static std::vector<ColumnOf<FormulationRow>> columns();
};

// A figure by another definition, beside the deviation of the recursion from the equilibrium leg.
struct DefinitionRow {
    std::string branch{}, output{}, unit{};
    double difference = nan, at = nan;
    std::string parameter_unit{};
    double drawn = nan, deviation = nan;
    std::string formula{};
    static std::vector<ColumnOf<DefinitionRow>> columns();
};

// A method and output over a side of a branch, by one reading.
struct StudyRow {
    std::string branch{}, method{}, reading{}, output{}, unit{}, behaviour{};
    double order = nan, order_error = nan;
    bool as_formal = false;
    double limit = nan, band = nan, finest_step_error = nan, gap = nan, gap_max = nan,
           gap_rms = nan, gap_exponent = nan, apart = nan, range = nan, gap_share = nan,
           constraint_order = nan, constraint_order_error = nan;
    std::string not_studied{};
    static std::vector<ColumnOf<StudyRow>> columns();
};

// A method and output over a side of a branch, by one reading and with one step count.
struct StepRow {
    std::string branch{}, method{}, reading{}, output{}, unit{};
    double steps = nan;
    std::string outcome{};
    double end = nan, largest = nan, rms = nan, error = nan, constraint_error = nan;
    static std::vector<ColumnOf<StepRow>> columns();
};

// The gap of an output on a branch side, and its parts (GapShare).
struct GapRow {
    std::string branch{}, reading{}, output{}, unit{};
    double whole = nan, lever = nan, axis = nan, load = nan, rest = nan, band = nan,
           lever_share = nan, axis_share = nan, load_share = nan;
    std::array<double, 8> following{nan, nan, nan, nan, nan, nan, nan, nan};
    std::string not_attributed{};
    static std::vector<ColumnOf<GapRow>> columns();
};

// A configuration of a method, or a leg.
struct TradeRow {
    std::string leg{}, method{};
    double steps = nan, tolerance = nan;
    std::string outcome{};
    double error = nan, angle_error = nan, share = nan, solves = nan, factorisations = nan,
           evaluations = nan, price = nan, time = nan, time_ratio = nan;
    std::string front{}, not_ranked{};
    bool recommended = false;
    std::string detail{};
    static std::vector<ColumnOf<TradeRow>> columns();
};

// Effect of a number of the scene on a figure, by the equilibrium leg.
struct EffectRow {
    std::string branch{};
    double at = nan;
    std::string parameter_unit{}, output{}, unit{}, number{}, step{};
    double effect = nan;
    std::string undefined{};
    static std::vector<ColumnOf<EffectRow>> columns();
};

struct BranchAttribution;
struct Channel;
struct Comparison;
struct FormulationStudy;
struct Gradients;
struct PrecisionStudy;
struct Study;
struct Trade;

// Empty without a wheel.
std::vector<CharacteristicRow> characteristic_rows(const Comparison& comparison);
// Per branch, landmark, leg and point.
std::vector<ComplianceRow> compliance_rows(const Model& model, const Comparison& comparison);
// At both ends of a two-sided branch; no rows where a leg did not reach the end.
std::vector<ForceRow> force_rows(const Model& model, const Comparison& comparison);
std::vector<LargestForceRow> largest_force_rows(const Comparison& comparison);
std::vector<FormulationRow> formulation_rows(const FormulationStudy& study,
                                             const Comparison& comparison);
// Solves the branches of the comparison again.
std::vector<DefinitionRow> definition_rows(const Model& model, const Comparison& comparison);
std::vector<StudyRow> study_rows(const Study& study);
std::vector<StepRow> step_rows(const Study& study);
std::vector<GapRow> gap_rows(const std::vector<Channel>& main,
                             const std::vector<BranchAttribution>& attribution);
std::vector<TradeRow> trade_rows(const Trade& trade);
// Per side of a branch, station, output and number; the design position only of the first side.
std::vector<EffectRow> effect_rows(const Gradients& all);

}  // namespace elastocheck::compare
