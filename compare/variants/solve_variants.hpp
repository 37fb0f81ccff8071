// The figures of many variants of a scene by `series` in lockstep, of those of another structure each
// alone, and of a variant by the equilibrium leg, also of one that series declines.
//
// All branches that the figures read are followed together where every part of the model is active
// on each of them, else one after the other. States are recorded in equal increments of the
// parameter, as few as have all stations among them; extremes are those of at least 21 points.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/comparison/compliance.hpp"
#include "elastocheck/channels.hpp"
#include "elastocheck/legs.hpp"
#include "elastocheck/model.hpp"
#include "recursive/diagnosis/analysis.hpp"

namespace elastocheck::compare::variants {

// ---- Figures: an output at a station of a branch, or its extreme over the branch.

enum class Over { station, least, largest };

struct VariantFigure {
    std::string name;    // the user's own
    std::string output;  // "toe", "bump_steer"
    std::string branch;
    Over over = Over::station;
    double at = 0;  // parameter of the branch [SI], of a station
    Unit unit = Unit::none;
};

// Parses "toe@jounce:3000", "min toe@jounce", "bump_steer". `outputs`: figure_outputs() of the model.
// Throws std::invalid_argument for a name that the scene lacks, with the nearest name, and for a reaction
// that redundant joints share.
VariantFigure parse_variant_figure(const std::string& name, std::string words, const Model& model,
                                   std::span<const Channel> outputs);

// ---- Variants.

// Outcomes of a variant, as in a ledger.
namespace outcome {
inline constexpr const char *solved = "solved",
                            *no_scene = "no scene",            // the numbers make the scene invalid
                                *not_trimmed = "not trimmed",  // its trim was not reached
                                    *ended_early = "ended early",  // a branch ends before a station
                                        *no_value = "no value";    // a figure could not be computed
}  // namespace outcome

struct VariantFigures {
    std::string outcome = outcome::solved;
    // why it is not solved, or, of a variant that the equilibrium leg solved, why series did not
    std::string reason = {};
    std::vector<double> values = {};  // per figure; NaN where there is none, infinite: undefined
    Leg leg = Leg::series;            // by which the values are
    bool declined = false;            // the leg gave up on a branch that another may follow further
};

class VariantSolver {
  public:
    // Throws std::invalid_argument for an output or a branch that the model has not, and for stations
    // that no 1000 equal increments have among them.
    VariantSolver(const Model& design, std::vector<VariantFigure> figures);

    // Compiled models of the variants. Thread-safe; a result does not depend on the other variants. What
    // series declines is solved by the equilibrium leg.
    std::vector<VariantFigures> solve(std::span<const Model> variants, Leg leg = Leg::series) const;
    // By one leg, alone, at the same stations.
    VariantFigures solve_alone(const Model& variant, Leg leg) const;

    int points() const { return points_; }  // increments of a branch side

  private:
    struct Reading {
        std::size_t figure = 0;
        int point = -1;  // recorded point; -1: every one
    };
    // A branch side with the figures that are read on it.
    struct Way {
        std::size_t branch = 0, side = 0;  // position in Model::branches, in branch_sides() of it
        std::vector<Reading> readings = {};
        Analyses responses = {};  // of the design, where a characteristic is read
    };
    struct Group {  // ways that are followed together
        std::vector<Way> ways;
        Model design = {};
        recursive::Analysis analysis = {};
    };

    void place(const Model& design);
    Model followed(const Model& model, const std::vector<Way>& ways) const;
    std::optional<std::vector<Channel>> outputs(const Model& model) const;
    VariantFigures without_values(Leg leg) const;
    struct Followed {  // a way of a variant
        const Model& model;
        const Branch& side;
        const Way& way;
        const EquilibriumPath& path;
    };
    void read(const Followed& followed, const std::vector<Channel>& outputs, Analyses analyses,
              VariantFigures& into) const;
    bool is_as_design(const Model& model) const;  // but for numbers
    void finish(VariantFigures& figures) const;

    std::vector<VariantFigure> figures_;
    std::vector<Channel> outputs_ = {};  // of the design, one a figure
    std::vector<std::function<Point(const Model&)>> points_read_ = {};  // of coordinates
    std::vector<int> structure_ = {};                                   // of the design
    bool only_motion_ = true;  // every output is a position or an angle
    bool with_sums_ = true;    // an output is a sum of redundant joints
    bool together_ = true;
    int points_ = 1;
    std::vector<Group> groups_ = {};
};

}  // namespace elastocheck::compare::variants
