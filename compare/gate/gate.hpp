// Regression gate: compares the measurement of one run of a scene with its accepted baseline.
//
// Both are lists of series of numbers with a key. Every accepted series must be present again, no
// other series may be present, and every number must lie within its tolerance. A series that cannot
// be compared is never a pass.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

// Classes of tolerances, by the similarity of the build that made the baseline and the judged build.
enum class ToleranceClass {
    same_build,   // same compiler, flags, libraries and CPU: only rounding of the file
    cross_build,  // any of them differs: round-off, measured over compilers and flags
    physical,     // other methods or libraries: differences that an engineer would notice
};
inline constexpr std::array tolerance_classes{
    ToleranceClass::same_build, ToleranceClass::cross_build, ToleranceClass::physical};
const char* name(ToleranceClass kind);  // "same-build", ...

// Quantity of a series on a branch.
enum class Quantity {
    recursive,  // outputs along the branch, by a leg
    equilibrium,
    range_equilibrium,  // smallest and largest value of a position or angle over all points
    characteristic_recursive,
    characteristic_equilibrium,
    range_characteristic_equilibrium,
    compliance_recursive,  // a row of the compliance matrix at the start of the first branch
    compliance_equilibrium,
    deviation_at_equal_parameter,  // largest |recursion - equilibrium leg| over all points
    deviation_at_equal_abscissa,
    work_recursive,  // counters of a leg: steps, factorisations, iterations, evaluations
    work_equilibrium,
    work_energy,
};
// What the numbers of a series belong to: the kept points of the branch (GatedBranch::a), the
// stations among these, the range over the branch, or none of them.
enum class Places { points, stations, range, elsewhere };
struct QuantityKind {
    const char* name;
    Places places = Places::elsewhere;
    const char* tolerance = "";  // key in Tolerances; "": the unit
};
// In the order of Quantity.
inline constexpr std::array quantities{
    QuantityKind{"recursive", Places::points},
    QuantityKind{"equilibrium", Places::points},
    QuantityKind{"range of equilibrium", Places::range},
    QuantityKind{"characteristic of recursive", Places::stations, "characteristic"},
    QuantityKind{"characteristic of equilibrium", Places::stations, "characteristic"},
    QuantityKind{"range of characteristic of equilibrium", Places::range, "characteristic"},
    QuantityKind{"compliance of recursive", Places::elsewhere, "compliance"},
    QuantityKind{"compliance of equilibrium", Places::elsewhere, "compliance"},
    QuantityKind{"deviation at equal parameter"},
    QuantityKind{"deviation at equal abscissa"},
    QuantityKind{"work of recursive"},
    QuantityKind{"work of equilibrium"},
    QuantityKind{"work of energy"}};
inline const QuantityKind& kind_of(Quantity quantity) {
    return quantities.at(static_cast<std::size_t>(quantity));
}
inline const char* name(Quantity quantity) { return kind_of(quantity).name; }

struct Series {
    std::string branch;
    Quantity quantity = Quantity::recursive;
    std::string channel;         // or name of the counter
    std::string unit;            // "mm", "deg", "N", "N·m", "1/m", "count"
    std::vector<double> values;  // one per place; a row of a matrix; smallest and largest; or one
    bool main = false;           // a figure that a reviewer of a baseline reads
};

// A swing arm is kept as 1 / arm, since a change from -110 m to -476 m is hardly a change.
inline constexpr const char* per_metre = "1/m";

struct GatedBranch {
    std::string name;
    std::string unit;       // of the parameter: "N", "mm", ...
    std::vector<double> a;  // parameters at which channel values are kept
};

// The stations of a branch among its kept parameters: five, evenly spaced, and the design position.
std::vector<std::size_t> stations(const std::vector<double>& a);

struct Measurement {
    std::string scene;
    std::vector<GatedBranch> branches;
    std::vector<Series> series;  // sorted by branch, quantity, channel
    // reasons why the run itself is inconclusive, else empty: per branch the worst three and the
    // number of the others
    std::vector<std::string> inconclusive;
};

// Keeps up to eleven evenly spaced points per branch, both ends included, and the design position.
// Values are rounded to the digits of a baseline file.
Measurement measure(const Model& model, const Comparison& comparison);

// |new - old| <= atol + rtol × scale. Scale: the range of the accepted curve for a channel and its
// range; the largest entry for a characteristic or a row of compliances; the range of the leg's
// curve for a deviation; the accepted number for a counter, so that rtol 0.1 is 10 %.
struct Allowance {
    double atol = 0, rtol = 0;
};

// Keys: the channel where listed, else "characteristic", "compliance", else the unit. A range has
// the tolerance of its curve.
using Tolerances = std::map<std::string, Allowance>;
Tolerances default_tolerances(ToleranceClass kind);

// Absolute bounds on a result, whatever was accepted: on a deviation over every branch, or on a
// figure (Quantity::equilibrium): an output or characteristic of the equilibrium leg.
struct Limit {
    Quantity of = Quantity::deviation_at_equal_abscissa;
    // "bump_steer" stands for both left.bump_steer and right.bump_steer
    std::string channel;
    double max = std::numeric_limits<double>::infinity();
    // for a figure only:
    double min = -std::numeric_limits<double>::infinity();
    std::string unit = {};  // unit of the bounds
    std::string over = {};  // branch on all points of which the limit holds; empty: design position
};
struct Baseline {
    Measurement accepted;
    std::map<ToleranceClass, Tolerances> tolerances;
    std::vector<Limit> limits;
    std::string reason;  // reason given by the user for the last acceptance
};

struct Offence {
    std::string branch;
    Quantity quantity = Quantity::recursive;
    std::string channel, unit;
    std::optional<double> a = {};  // parameter of a channel value, ...
    std::string a_unit = {};       // ... in the unit of the branch parameter
    bool of_limit = false;         // beyond an absolute limit, which is `was`
    double was = 0, is = 0;        // accepted, measured
    double tolerance = 0;
    // tolerance in class `physical`: the smallest change that an engineer notices
    double noticeable = 0;

    double difference() const { return is - was; }
    // ratio to the tolerance, infinite for tolerance zero; of a limit 1 + excess / |limit|
    double share() const;
    double noticed() const;  // ratio to `noticeable`; of a limit its share
};

// Report order of two offences: exceeded limits first, then changes above `noticeable`, then the
// others; within each class wheel outputs at the design position (the reference's, then the
// recursion's), then elsewhere, then inner forces and counters of work; then the larger ratio to
// `noticeable`. The ratio to the tolerance does not decide: 0.18 N of a joint reaction may be 10⁸
// round-off tolerances and still be irrelevant.
bool comes_before(const Offence& a, const Offence& b);

struct GateVerdict {
    ToleranceClass kind = ToleranceClass::same_build;
    int compared = 0;                  // numbers compared
    std::vector<Offence> offences;     // in the order of comes_before
    std::vector<std::string> reasons;  // reasons why all or part of it could not be judged

    // An exceeded limit fails whatever else could not be judged; nothing compared is not a pass.
    Grade grade() const;
};

GateVerdict judge(const Baseline& baseline, const Measurement& measurement, ToleranceClass kind);

// Tolerances of the baseline in this class, as edited by hand, that are wider than the default ones:
// "mm: atol 1e+09", sorted.
std::vector<std::string> widened(const Baseline& baseline, ToleranceClass kind);

}  // namespace elastocheck::compare
