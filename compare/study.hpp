// Where the error of a stepping method comes from: its steps, its formulation, or the reference.
//
//   value(N) - truth = [value(N) - own limit]  +  [own limit - reference]  +  [reference - truth]
//                       step error                formulation gap             reference uncertainty
//
// The own limit is Richardson's, per channel (convergence.hpp). Read at equal parameter and at equal
// abscissa (curve.hpp). |Φ|
// of eq. (31) stands beside them: it falls with the steps whatever the method converges to.
//
// A branch with two ways is studied as two: each has an end of its own.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/channels.hpp"
#include "compare/convergence.hpp"
#include "compare/curve.hpp"
#include "models/equilibrium_path.hpp"
#include "models/model.hpp"
#include "recursive/method.hpp"

namespace elastocheck::compare {

struct StudyOptions {
    std::vector<recursive::Method> methods{recursive::Method{}};  // fixed-step ones
    std::vector<int> steps{75, 150, 300, 600, 1200, 2400};  // per branch, shared by its ways; increasing, at
                                                            // least five
    std::function<void(std::string_view)> progress = {};
};

// One channel of one method over one branch, in the channel's unit.
struct ChannelStudy {
    StepConvergence end;                                 // at the end of the branch
    std::vector<double> step_error_end;                  // per level: value - own limit, signed
    std::vector<double> step_error_max, step_error_rms;  // per level, over the branch
    double gap = 0;                                      // own limit - reference at the end, signed
    double gap_max = 0, gap_rms = 0;                     // over the branch
    double gap_exponent = 0;  // of |gap| over the parameter or abscissa; NaN where it is at its floor
    double uncertainty = 0;   // largest difference of the references over the branch
    double range = 0;         // of the reference over the branch
};

struct MethodStudy {
    std::string method;
    std::vector<Outcome> outcomes;              // per level
    std::vector<double> constraint_error;       // |Φ| at the end, eq. (31), per level
    OrderFit constraint_order;                  // at which it falls
    std::vector<ChannelStudy> equal_parameter;  // one per main channel; empty when a level did not converge
    std::vector<ChannelStudy> equal_abscissa;   // the same; empty where it cannot be read
    std::string not_studied;                    // why there is nothing, empty when there is
    std::string no_abscissa;                    // why there is nothing at equal abscissa
};

struct BranchStudy {
    std::string branch;      // its name, or of one way of it: "bounce to -80 mm"
    std::string belongs_to;  // the name of the branch
    Unit unit{};             // in which its parameter is shown
    std::string abscissa;    // name of the channel, empty where there is none
    std::vector<int> steps;  // of this way
    std::vector<MethodStudy> methods;
};

struct Study {
    std::vector<int> steps;
    std::vector<Channel> channels;  // the main ones
    std::vector<BranchStudy> branches;
    std::vector<std::string> inconclusive;  // references that failed or disagree

    bool conclusive() const;  // and something was studied
};

// Throws std::invalid_argument when the step counts are not at least five, positive and increasing.
Study study(const Model& model, const StudyOptions& options = {});

// One method on one way whose levels are walked already, by whomever: curves of `all` channels, of which the main ones that
// `studied` names (positions in `all`) are studied, in the order of `steps`. Formal order: NaN if unknown.
struct References;
void study_levels(MethodStudy& study, const std::vector<Channel>& all,
                  const std::vector<std::size_t>& studied, const std::vector<int>& steps,
                  const std::vector<Curve>& levels, const References& references, double formal_order);

// Why the references do not do for a study: they failed, or are further apart than is allowed.
std::vector<std::string> unfit(const References& references, const std::string& way);

// The ways of a branch as the references of a study walk them, each with its share of every number of steps.
struct Way;
std::vector<std::pair<Way, std::vector<int>>> ways_with_steps(const Model& model, const Branch& branch,
                                                              const std::vector<int>& steps);

// The channels that are studied: positions and angles, no reaction.
std::vector<Channel> motion(const Model& model);

// ---- What the formulation gap is made of.
//
// The published recursion never turns what is stored. Three things can be made to follow the bodies
// (recursive/method.hpp): the lever of the stored elastic force, its axis and law, and the lever of the load.
// Every combination has a limit of its own; with all three it is equilibrium. A term's contribution is its
// mean effect over all orders of adding it (Shapley), so the three add up to the whole gap exactly.

struct GapShare {
    double whole = 0;                      // gap of the recursion in which nothing follows, signed
    double lever = 0, axis = 0, load = 0;  // contributions; whole = lever + axis + load + rest
    double rest = 0;                       // what is left with all three: 0 within `band`
    double band = 0;                       // uncertainty of the limits and the reference
    std::vector<double> combinations;      // gap of each of the 8 combinations; bit 0 lever, 1 axis, 2 load
};

struct BranchAttribution {
    std::string branch, belongs_to;                         // as in BranchStudy
    Unit unit{};                                            // likewise
    std::string abscissa;                                   // likewise
    std::vector<GapShare> equal_parameter, equal_abscissa;  // per main channel; empty where it cannot be read
    std::string not_attributed;                             // why there is nothing
    std::string no_abscissa;                                // why there is nothing at equal abscissa
};

std::vector<BranchAttribution> attribute_gap(const Model& model,
                                             const std::function<void(std::string_view)>& progress = {});

}  // namespace elastocheck::compare
