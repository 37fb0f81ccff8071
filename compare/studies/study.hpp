// Error decomposition of a stepping method: step error, formulation gap and reference uncertainty.
//
//   value(N) - truth = [value(N) - own limit]  +  [own limit - reference]  +  [reference - truth]
//                       step error                formulation gap             reference uncertainty
//
// The own limit is the Richardson limit per channel (convergence.hpp). Both readings are used:
// equal parameter and equal abscissa (curve.hpp). |Φ| of eq. (31) is reported beside them: it falls
// with the steps whatever the limit of the method is.
//
// The two sides of a branch are studied separately, since each has an end of its own.
#pragma once

#include <string>
#include <vector>

#include "compare/outputs/curve.hpp"
#include "compare/studies/convergence.hpp"
#include "compare/studies/solves.hpp"
#include "elastocheck/channels.hpp"
#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/recursive_method.hpp"

namespace elastocheck::compare {

struct StudyOptions {
    std::vector<recursive::Method> methods{recursive::Method{}};  // with fixed steps
    // per branch, shared by its sides; increasing, at least five
    std::vector<int> steps{75, 150, 300, 600, 1200, 2400};
    int threads = 1;
    Progress progress = {};
};

// One channel of one method over one branch, in the channel's unit.
struct ChannelStudy {
    // Behaviour of the value at the station with the largest change by the last refinement.
    Behaviour behaviour = Behaviour::too_few_levels;
    OrderFit order;  // order at which step_error_max falls; only where `behaviour` is converging
    bool as_formal = false;    // the order agrees with the formal order
    bool zero_at_end = false;  // the step error at the end is below a tenth of step_error_max
    StepConvergence end;  // convergence of the value at the end of the branch: own limit and band
    std::vector<double> step_error_end;                  // per level: value - own limit, signed
    std::vector<double> step_error_max, step_error_rms;  // per level, over the branch
    double gap = 0;                                      // own limit - reference at the end, signed
    double gap_max = 0, gap_rms = 0;                     // over the branch
    // Power of the parameter or abscissa with which |gap| grows; NaN at a floor.
    double gap_exponent = 0;
    double uncertainty = 0;  // largest difference of the references over the branch
    double range = 0;        // range of the reference over the branch
};

struct MethodStudy {
    std::string method;
    std::vector<Outcome> outcomes;         // per level
    std::vector<double> constraint_error;  // |Φ| at the end, eq. (31), per level
    OrderFit constraint_order;             // order at which it falls
    // one per main channel; empty when a level did not converge
    std::vector<ChannelStudy> equal_parameter;
    std::vector<ChannelStudy> equal_abscissa;  // the same; empty without an abscissa
    std::string not_studied;                   // reason why there is no study, else empty
    std::string no_abscissa;                   // reason why there is no equal abscissa
};

struct StudiedBranch {
    std::string branch;      // name of the branch, or of one side: "bounce to -80 mm"
    std::string belongs_to;  // name of the whole branch
    Unit unit{};             // display unit of the parameter
    std::string abscissa;    // name of the channel, empty where there is none
};

struct BranchStudy : StudiedBranch {
    std::vector<int> steps;  // of this branch side
    std::vector<MethodStudy> methods;
};

struct Study {
    std::vector<int> steps;
    std::vector<Channel> channels;  // the main channels
    std::vector<BranchStudy> branches;
    std::vector<std::string> inconclusive;  // references that failed or disagree

    bool conclusive() const;  // also requires that something was studied
};

// Throws std::invalid_argument when the step counts are not at least five, positive and increasing.
Study study(const Model& model, const StudyOptions& options = {});
// The same study from shared solves. Pre: where these share points (Solves::finest > 1), the step counts
// are their base times powers of two.
Study study(Solves& solves, const StudyOptions& options);

// Curves of one method, or of another solver, on one branch side with several step counts.
struct StudiedLevels {
    const std::vector<int>& steps;
    const std::vector<Curve>& curves;  // one for each step count
    const References& references;
    double formal_order;  // NaN if unknown
};
// Studies the levels. `all`: the channels of the curves; `studied`: positions of the studied ones.
void study_levels(MethodStudy& study, const std::vector<Channel>& all,
                  const std::vector<std::size_t>& studied, const StudiedLevels& levels);

// Reasons why the references cannot be used in a study: a failure, or a distance beyond Bounds.
std::vector<std::string> unfit(const References& references, const std::string& side);

// A branch side as the references of a study run it, with its share of every step count.
struct StudiedSide : BranchSide {
    std::vector<int> steps = {};
    References known = {};
};
// The references are not yet run.
std::vector<StudiedSide> sides_with_steps(const Model& model, const Branch& branch,
                                          const std::vector<int>& steps);
StudiedBranch studied_branch(const BranchSide& side, const std::vector<Channel>& all,
                             const Curve& truth);

// The studied channels: positions and angles, no reactions.
std::vector<Channel> motion(const Model& model);

// ---- Attribution of the formulation gap.
//
// The published recursion never rotates the stored forces. Three quantities can be made to follow
// the bodies (include/elastocheck/recursive_method.hpp): the lever of the stored elastic force, its axis and law, and
// the lever of the load. Every combination has its own limit; with all three the limit is
// equilibrium. The contribution of a term is its mean effect over all orders of adding it (Shapley
// value, 1953), so that the three contributions add up to the whole gap.

struct GapShare {
    double whole = 0;  // gap of the recursion in which none of the three follows, signed
    double lever = 0, axis = 0, load = 0;  // contributions; whole = lever + axis + load + rest
    double rest = 0;                       // remainder with all three: 0 within `band`
    double band = 0;                       // uncertainty of the limits and the reference
    // gap of each of the 8 combinations; bit 0 lever, 1 axis, 2 load
    std::vector<double> combinations;
};

struct BranchAttribution : StudiedBranch {
    // per main channel; empty without an abscissa
    std::vector<GapShare> equal_parameter = {}, equal_abscissa = {};
    std::string not_attributed = {};  // reason why there is none
    std::string no_abscissa = {};     // reason why there is no equal abscissa
};

std::vector<BranchAttribution> attribute_gap(const Model& model, int threads = 1,
                                             const Progress& progress = {});
std::vector<BranchAttribution> attribute_gap(Solves& solves, const std::vector<int>& steps,
                                             int threads, const Progress& progress);

}  // namespace elastocheck::compare
