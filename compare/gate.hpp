// The gate: what one run of a scene measured, against what was accepted before.
//
// Both are lists of series of numbers with a key. Everything that was accepted must be there again, nothing
// else may be, and every number must lie within its tolerance. What cannot be compared is never a pass.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compare/compare.hpp"

namespace elastocheck::compare {

// How alike the build that was accepted and the one that is judged are.
enum class ToleranceClass {
    same_build,   // compiler, flags, libraries and CPU are the same: only rounding of the file
    cross_build,  // any of them differs: round-off, measured over compilers and flags
    physical,     // other methods or libraries: what an engineer would notice
};
inline constexpr std::array tolerance_classes{ToleranceClass::same_build, ToleranceClass::cross_build,
                                              ToleranceClass::physical};
const char* name(ToleranceClass kind);  // "same-build", ...

// What a series tells about a branch.
enum class Quantity {
    recursive,                 // a channel of the recursion along the branch
    equilibrium,               // ... of the equilibrium leg
    characteristic_recursive,  // kinematics and compliance at the start and the ends of the branch, by the recursion
    characteristic_equilibrium,  // ... by the equilibrium leg
    compliance_recursive,        // a row of the compliance matrix at the start of the first branch, likewise
    compliance_equilibrium,
    deviation_at_equal_parameter,  // the largest |recursion - equilibrium leg| over all points, one number
    deviation_at_equal_abscissa,   // likewise
    work_recursive,                // counters of a leg: steps, factorisations, iterations, evaluations
    work_equilibrium,
    work_energy,
};
inline constexpr std::array quantities{Quantity::recursive,
                                       Quantity::equilibrium,
                                       Quantity::characteristic_recursive,
                                       Quantity::characteristic_equilibrium,
                                       Quantity::compliance_recursive,
                                       Quantity::compliance_equilibrium,
                                       Quantity::deviation_at_equal_parameter,
                                       Quantity::deviation_at_equal_abscissa,
                                       Quantity::work_recursive,
                                       Quantity::work_equilibrium,
                                       Quantity::work_energy};
const char* name(Quantity quantity);  // "recursive", "deviation at equal parameter", "work of recursive", ...

struct Series {
    std::string branch;
    Quantity quantity = Quantity::recursive;
    std::string channel;  // or counter
    std::string unit;     // "mm", "deg", "N", "N·m", "count"
    std::vector<double>
        values;  // one per kept parameter of the branch for a channel; of a characteristic at the
                 // first of them, at the one nearest to 0 and at the last; a row of a matrix; else one
};

struct GatedBranch {
    std::string name;
    std::string unit;       // of the parameter: "N", "mm", ...
    std::vector<double> a;  // parameters at which channels are kept
};

struct Measurement {
    std::string scene;
    std::vector<GatedBranch> branches;
    std::vector<Series> series;             // sorted by branch, quantity, channel
    std::vector<std::string> inconclusive;  // why the run itself proves nothing; empty when it does. The
                                            // worst three of a branch and how many more
};

// Up to eleven points a branch, evenly spread, both ends included. Values are rounded to what a baseline
// file holds.
Measurement measure(const Model& model, const Comparison& comparison);

// |new - old| <= atol + rtol × scale. Scale: the range of the accepted curve; the largest entry of a characteristic or of a
// row of compliances; of the equilibrium leg's curve
// for a deviation; the accepted number for a counter, so that rtol 0.1 is 10 %.
struct Allowance {
    double atol = 0, rtol = 0;
};

// By channel where it is listed, else "characteristic", "compliance", else by unit.
using Tolerances = std::map<std::string, Allowance>;
Tolerances default_tolerances(ToleranceClass kind);

// An absolute bound on a deviation, in the channel's unit, over every branch: it gates accuracy, not change.
struct Limit {
    Quantity deviation = Quantity::deviation_at_equal_abscissa;
    std::string channel;
    double max = 0;
};

struct Baseline {
    Measurement accepted;
    std::map<ToleranceClass, Tolerances> tolerances;
    std::vector<Limit> limits;
    std::string reason;  // of the last acceptance, in the words of who accepted it
};

struct Offence {
    std::string branch;
    Quantity quantity = Quantity::recursive;
    std::string channel, unit;
    std::optional<double> a = {};  // where on the branch, for a channel, ...
    std::string a_unit = {};       // ... in the unit of its parameter
    bool of_limit = false;         // an absolute limit is broken; `was` is then the limit
    double was = 0, is = 0;        // accepted, measured
    double tolerance = 0;
    double noticeable = 0;  // its tolerance in the class physical: by so much an engineer notices

    double difference() const { return is - was; }
    double share() const;    // of the tolerance, or of the limit; infinite where nothing is tolerated
    double noticed() const;  // of what is noticeable, or of the limit
};

// Which of two offences a reader is told first. Round-off is judged in tolerances, but 0.18 N of a joint's reaction may
// be 10⁸ of them and no news: a broken limit, then what an engineer would notice, then what he would not; of each, the
// outputs before forces within the suspension and counters of work; of those, the larger share of what is noticeable.
bool comes_before(const Offence& a, const Offence& b);

enum class Judgement { passed, failed, could_not_judge };
const char* name(Judgement judgement);  // "passed", "FAILED", "COULD NOT JUDGE"

struct Verdict {
    ToleranceClass kind = ToleranceClass::same_build;
    int compared = 0;                  // numbers compared
    std::vector<Offence> offences;     // in the order of comes_before
    std::vector<std::string> reasons;  // why (a part) could not be judged

    // A broken limit is broken whatever else could not be judged; nothing compared is not a pass.
    Judgement judgement() const;
};

Verdict judge(const Baseline& baseline, const Measurement& measurement, ToleranceClass kind);

}  // namespace elastocheck::compare
