// Rows of the studies' tables. A number without a value is NaN.
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
};
void describe(auto& field, Described<CharacteristicRow> auto& r) {
    using enum Digits;
    field("output", r.output, {"", "", words});
    field("unit", r.unit, {"", "", words});
    field("value", r.value,
          {"", "at a = 0 of the first branch, by the equilibrium leg; none if it is undefined",
           four});
    field("distance of references", r.apart, {"", "second reference less equilibrium leg"});
    field("recursion", r.recursion, {"", "by the matrix that the recursion factorises there"});
    field("off", r.off, {"", "recursion less equilibrium leg", deviation, "error"});
    field("off %", r.off_percent, {"%", "of the value", three, "share"});
    field("undefined", r.undefined, {"", "reason for a missing value"});
    field("definition", r.definition);
}

// An output of a wheel as drawn and as settled at the start of a branch.
struct StaticRow {
    std::string wheel{}, output{}, unit{};
    double drawn = nan, settled = nan;
};
void describe(auto& field, Described<StaticRow> auto& r) {
    field("wheel", r.wheel);
    field("output", r.output);
    field("unit", r.unit);
    field("drawn", r.drawn, {"", "in the design position, as the file has it"});
    field("settled", r.settled, {"", "in equilibrium, after the trim where there is one"});
}

// A displacement component at a point of a wheel, by one leg.
struct ComplianceRow {
    static constexpr std::array causes{"force x",  "force y",  "force z",
                                       "moment x", "moment y", "moment z"};
    std::string branch{};
    double a = nan;
    std::string unit{}, leg{}, point{}, wheel{}, answer{}, loaded_wheel{};
    std::array<double, 6> by_cause{};
    double reciprocity = nan;
};
void describe(auto& field, Described<ComplianceRow> auto& r) {
    field("branch", r.branch);
    field("a", r.a, {"", "parameter of the branch"});
    field("unit", r.unit, {"", "of a"});
    field("leg", r.leg);
    field("point", r.point,
          {"", "where forces act and displacements are read: wheel centre or contact patch"});
    field("wheel", r.wheel, {"", "whose displacement is given"});
    field("answer", r.answer,
          {"", "displacement of the point in mm, rotation of the wheel in deg, ground axes"});
    field("loaded wheel", r.loaded_wheel,
          {"", "on which forces and moments act, all jacks and tyres removed"});
    for (std::size_t k = 0; k < 6; ++k)
        field(r.causes[k], r.by_cause[k],
              {"", k < 3 ? "response per kN" : "response per 100 N·m", Digits::four});
    field("reciprocity", r.reciprocity,
          {"",
           "|C - Cᵀ| / |C| of the whole matrix at the wheel centres, rotations counted by the "
           "tyre's radius"});
}

// An element or a link at an end of a branch.
struct ForceRow {
    std::string branch{};
    double end = nan;
    std::string end_unit{}, element{}, output{}, unit{};
    double value = nan, error = nan, share = nan;
};
void describe(auto& field, Described<ForceRow> auto& r) {
    field("branch", r.branch);
    field("end", r.end, {"", "parameter there"});
    field("end unit", r.end_unit);
    field("element", r.element);
    field("output", r.output);
    field("unit", r.unit);
    field("value", r.value, {"", "of the equilibrium leg"});
    field("error", r.error, {"", "recursion less equilibrium leg, in the same unit"});
    field("share", r.share, {"%", "of the value"});
}

// Largest force or moment of an element over the points of a branch, by the equilibrium leg.
struct LargestForceRow {
    std::string branch{};
    double at = nan;
    std::string parameter_unit{}, element{}, output{};
    double value = nan;
    std::string unit{};
    double deformation = nan;
    std::string deformation_unit{};
};
void describe(auto& field, Described<LargestForceRow> auto& r) {
    field("branch", r.branch);
    field("at", r.at, {"", "parameter of the branch where it is largest"});
    field("parameter unit", r.parameter_unit);
    field("element", r.element);
    field("output", r.output, {"", "its component of the largest absolute value"});
    field("value", r.value, {"", "by the equilibrium leg"});
    field("unit", r.unit);
    field("deformation", r.deformation, {"", "conjugate to the force, at the same point"});
    field("deformation unit", r.deformation_unit);
}

// Spread of a main output over the formulations, beside the deviations of the same scene.
struct FormulationRow {
    std::string branch{}, output{}, unit{};
    double spread = nan, at = nan;
    std::string parameter_unit{}, smallest_by{}, largest_by{};
    double apart = nan, deviation = nan;
};
void describe(auto& field, Described<FormulationRow> auto& r) {
    using enum Digits;
    field("branch", r.branch);
    field("output", r.output, {"", "", words});
    field("unit", r.unit, {"", "", words});
    field(
        "spread", r.spread,
        {"", "largest less smallest value over the formulations, maximum over the branch", three});
    field("at", r.at, {"", "parameter there", given});
    field("parameter unit", r.parameter_unit, {"", "", words, "unit"});
    field("smallest by", r.smallest_by,
          {"", "the formulation that gives the smallest value there", words});
    field("largest by", r.largest_by, {"", "likewise", words});
    field("distance of references", r.apart, {"", "at most, at equal parameter", size});
    field("deviation", r.deviation,
          {"", "of the recursion from the equilibrium leg at equal parameter, at most", three});
}

// A figure by another definition, beside the deviation of the recursion from the equilibrium leg.
struct DefinitionRow {
    std::string branch{}, output{}, unit{};
    double difference = nan, at = nan;
    std::string parameter_unit{};
    double drawn = nan, deviation = nan;
    std::string formula{};
};
void describe(auto& field, Described<DefinitionRow> auto& r) {
    using enum Digits;
    field("branch", r.branch, {"", "", words});
    field("output", r.output, {"", "the figure, and its other definition after @", words});
    field("unit", r.unit, {"", "", words});
    field("difference", r.difference,
          {"", "from the figure as defined here, by the equilibrium leg, largest over the branch",
           three});
    field("at", r.at, {"", "parameter there", given});
    field("parameter unit", r.parameter_unit, {"", "", words, "unit"});
    field("drawn", r.drawn, {"", "difference in the design position", three});
    field(
        "deviation", r.deviation,
        {"", "of the recursion from the equilibrium leg in the figure, at equal parameter, at most",
         three});
    field("formula", r.formula, {"", "of the other definition"});
}

// A method and output over a side of a branch, by one reading.
struct StudyRow {
    std::string branch{}, method{}, reading{}, output{}, unit{}, behaviour{};
    double order = nan, order_error = nan;
    bool as_formal = false;
    double limit = nan, band = nan, finest_step_error = nan, gap = nan, gap_max = nan,
           gap_rms = nan, gap_exponent = nan, apart = nan, range = nan, gap_share = nan,
           constraint_order = nan, constraint_order_error = nan;
    std::string not_studied{};
};
void describe(auto& field, Described<StudyRow> auto& r) {
    using enum Digits;
    field("branch", r.branch);
    field("method", r.method, {"", "", words});
    field("reading", r.reading);
    field("output", r.output, {"", "", words});
    field("unit", r.unit, {"", "", words});
    field("behaviour", r.behaviour,
          {"", "of the value with the largest step error on the branch", words});
    field("order", r.order, {"", "at which the largest step error over the branch falls", three});
    field("order error", r.order_error, {"", "its standard error", size, "±"});
    field("as formal", r.as_formal, {"", "the order agrees with the method's"});
    field("limit", r.limit, {"", "own limit for infinitely many steps, at the end"});
    field("band", r.band, {"", "uncertainty of the limit", size, "± band", 13});
    field("finest step error", r.finest_step_error,
          {"", "largest over the branch with the most steps", size});
    field("gap", r.gap, {"", "own limit less reference at the end", three, "gap at end"});
    field("largest gap", r.gap_max);
    field("rms gap", r.gap_rms);
    field("gap exponent", r.gap_exponent,
          {"", "power of the parameter or abscissa with which it grows", three, "growth a^"});
    field("distance of references", r.apart, {"", "", size});
    field("range", r.range, {"", "of the reference over the branch"});
    field("gap share", r.gap_share,
          {"%", "gap at the end, of the range", three, "of the range", 14});
    field("constraint order", r.constraint_order,
          {"", "order at which |Φ| of eq. (31) decreases at the end"});
    field("constraint order error", r.constraint_order_error, {"", "its standard error"});
    field("not studied", r.not_studied, {"", "why", words});
}

// A method and output over a side of a branch, by one reading and with one step count.
struct StepRow {
    std::string branch{}, method{}, reading{}, output{}, unit{};
    double steps = nan;
    std::string outcome{};
    double end = nan, largest = nan, rms = nan, error = nan, constraint_error = nan;
};
void describe(auto& field, Described<StepRow> auto& r) {
    field("branch", r.branch);
    field("method", r.method);
    field("reading", r.reading);
    field("output", r.output);
    field("unit", r.unit);
    field("steps", r.steps);
    field("outcome", r.outcome);
    field("end", r.end, {"", "value less own limit at the end"});
    field("largest", r.largest);
    field("rms", r.rms);
    field("error", r.error, {"", "value less reference at the end: step error and gap"});
    field("constraint error", r.constraint_error, {"m", "or rad: |Φ| at the end, eq. (31)"});
}

// The gap of an output on a branch side, and its parts (GapShare).
struct GapRow {
    std::string branch{}, reading{}, output{}, unit{};
    double whole = nan, lever = nan, axis = nan, load = nan, rest = nan, band = nan,
           lever_share = nan, axis_share = nan, load_share = nan;
    std::array<double, 8> following{nan, nan, nan, nan, nan, nan, nan, nan};
    std::string not_attributed{};
};
void describe(auto& field, Described<GapRow> auto& r) {
    using enum Digits;
    field("branch", r.branch);
    field("reading", r.reading);
    field("output", r.output, {"", "", words});
    field("unit", r.unit, {"", "", words});
    field("whole", r.whole,
          {"", "gap of the recursion in which forces do not follow the bodies", three});
    field("lever", r.lever,
          {"", "contribution of the lever of the stored force", three, "stored force's lever"});
    field("axis", r.axis, {"", "contribution of its axis and law", three, "its axis and law"});
    field("load", r.load, {"", "contribution of the lever of the load", three, "load's lever"});
    field("rest", r.rest, {"", "remaining gap when all three follow: 0 within the band", size});
    field("band", r.band, {"", "", size, "± band"});
    field("lever share", r.lever_share, {"%", "of the whole", three, "share", 5});
    field("axis share", r.axis_share, {"%", "likewise", three, "share", 6});
    field("load share", r.load_share, {"%", "likewise", three, "share", 7});
    // In the order of GapShare::combinations.
    constexpr std::array follows{
        "gap, following: nothing",       "gap, following: lever",
        "gap, following: axis",          "gap, following: lever and axis",
        "gap, following: load",          "gap, following: lever and load",
        "gap, following: axis and load", "gap, following: lever, axis and load"};
    for (std::size_t k = 0; k < follows.size(); ++k) field(follows[k], r.following[k]);
    field("not attributed", r.not_attributed, {"", "why", words});
}

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
};
void describe(auto& field, Described<TradeRow> auto& r) {
    using enum Digits;
    field("leg", r.leg);
    field("method", r.method, {"", "", words});
    field("steps", r.steps, {"", "per branch; none if the method chooses them", whole});
    field("tolerance", r.tolerance,
          {"mm", "that is required of a method that chooses its steps", given});
    field("outcome", r.outcome);
    field("error", r.error, {"mm", "", size});
    field("angle error", r.angle_error, {"deg", "", size, "error"});
    field("share", r.share, {"", "of the tolerance"});
    field("solves", r.solves, {"", "", whole});
    field("factorisations", r.factorisations, {"", "", whole});
    field("evaluations", r.evaluations, {"", "", whole});
    field("price", r.price,
          {"", "in back-substitutions: N/3 · factorisations + solves + evaluations", whole});
    field("time", r.time, {"s", "median over the rounds", three});
    field("time ratio", r.time_ratio, {"", "to the equilibrium leg", three, "ratio"});
    field("front", r.front,
          {"",
           "no other is as accurate with s: fewer solves, f: fewer factorisations + evaluations, "
           "t: less time",
           words});
    field("not ranked", r.not_ranked, {"", "why", words});
    field("recommended", r.recommended);
    field("detail", r.detail, {"", "of the outcome"});
}

// Effect of a number of the scene on a figure, by the equilibrium leg.
struct EffectRow {
    std::string branch{};
    double at = nan;
    std::string parameter_unit{}, output{}, unit{}, number{}, step{};
    double effect = nan;
    std::string undefined{};
};
void describe(auto& field, Described<EffectRow> auto& r) {
    field("branch", r.branch);
    field("at", r.at, {"", "parameter of the branch"});
    field("parameter unit", r.parameter_unit);
    field("output", r.output);
    field("unit", r.unit);
    field("number", r.number, {"", "path in the scene file"});
    field("step", r.step, {"", "1 mm of a length, else 1 % of the value"});
    field("effect", r.effect, {"", "derivative of the output times the step"});
    field("undefined", r.undefined, {"", "reason for a missing effect"});
}

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
