// Figures of a scene, outputs at stations of its branches, as functions of numbers of its file, and
// their rates by differences of whole solutions:
//
//   dy/dp = (8 (y(h) - y(-h)) - (y(2h) - y(-2h))) / 12h
//
// Settled start and trim are part of the function. Where the slopes to both sides differ, h is
// shortened; where they still do, there is no rate.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "compare/sensitivity/varying.hpp"
#include "elastocheck/channels.hpp"
#include "elastocheck/legs.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::compare {

// An output at one station of a branch.
struct Figure {
    std::string name;    // name of the output: "bump_steer", "toe"
    std::string branch;  // name of the branch
    double at = 0;       // the station: parameter of the branch [SI], or value of the output `over`
    std::string over = {};              // "travel"; empty: the station is a parameter
    bool change = false;                // the change from the design position, not the value
    std::string unit = {}, place = {};  // for readers: "deg", "jounce = 3000 N"
};

// All outputs of a model that a figure can be: channels, characteristics, forces of elements, sums
// of what redundant joints share.
std::vector<Channel> figure_outputs(const Model& model, bool with_sums = true);

// Values of figures by one leg, in their units; NaN where there is none, with the reason for the first.
struct FigureValues {
    Eigen::VectorXd value;
    std::string why_not = {};
    bool not_applicable = false;  // the reason is that the leg does not apply to the scene
};
FigureValues evaluate(const Model& model, std::span<const Figure> figures, Leg leg);

// States of a leg at which figures of one branch are read: at values of its parameter, or along the
// whole branch for figures over another output.
struct ReadStates {
    std::size_t branch = 0;  // position in Model::branches
    bool whole = false;
    std::vector<BranchSide> sides;
    std::vector<Equilibrium> states = {};
    Outcome outcome = Outcome::converged;  // why states are missing
    std::string detail = {};

    bool complete() const { return outcome == Outcome::converged; }
};
// evaluate() in its two parts.
std::vector<ReadStates> states_of(const Model& model, std::span<const Figure> figures, Leg leg);
FigureValues read_figures(const Model& model, std::span<const ReadStates> states,
                          std::span<const Figure> figures, Leg leg);
// States of each model (null: none) by the equilibrium leg at the places of `states`, those of a similar
// model, solved from these by the chord method (models/neighbours.hpp) with one factorisation per state
// for all models. Empty for a model of another structure, and where the method does not converge.
std::vector<std::vector<ReadStates>> neighbouring_states(std::span<const ReadStates> states,
                                                         std::span<const Model* const> models,
                                                         int threads);

// Values of figures of the trimmed scene.
FigureValues figure_values(const Scene& scene, std::span<const Figure> figures,
                           Leg leg = Leg::equilibrium);

// Limits of the numbers of a search, in their units; infinite where there are none.
struct SearchRange {
    Eigen::VectorXd start, low, high;
    // p = start + shares · (high - low), kept within the limits; and its inverse.
    Eigen::VectorXd at(const Eigen::VectorXd& shares) const;
    Eigen::VectorXd shares(const Eigen::VectorXd& p) const;
};

// Numbers of a scene that may change, in the units of its file.
struct Varied : SearchRange {
    std::vector<Number> numbers = {};
    // The scene with these values. May throw std::runtime_error: no such scene.
    std::function<Scene(const Eigen::VectorXd& p)> scene = {};
};

// Figures as functions of the numbers p: all that the algorithms of this folder use of a scene.
struct Figures {
    // at points near the first one, in the units of the outputs; NaN where there is none
    std::function<std::vector<Eigen::VectorXd>(const std::vector<Eigen::VectorXd>& p)> values;
    Eigen::VectorXd step;  // h, per number

    Eigen::VectorXd value(const Eigen::VectorXd& p) const { return values({p}).front(); }
    // [figures × numbers], NaN where there is no rate
    Eigen::MatrixXd gradient(const Eigen::VectorXd& p) const;
};
// By the equilibrium leg, points on several threads. Trim and states start from those at p[0] of
// the last call where that is near, else from the design position.
Figures solved_figures(const Varied& varied, std::vector<Figure> figures, int threads = 1);

// Reason why one of the figures has no value, or else no rate, at p: "no rate at the start: ...".
std::string why_not_solved(const Varied& varied, std::span<const Figure> figures,
                           const Eigen::VectorXd& p, const char* where = "the start");
// Reasons why none of the numbers moves a figure at the start, a line for each number:
// "springs.coil.rate: no output moves with it".
std::string why_still(const Varied& varied, const Figure& figure);

// Figures that the equilibrium leg found, by the energy leg and by the series.
struct Confirmation {
    Eigen::VectorXd energy, series;  // figures in their units; NaN where a leg does not apply
    // A leg other than the equilibrium leg applies, and each that applies agrees on every figure, to
    // a millionth of its movement over the ranges of the numbers; and so does the equilibrium leg,
    // solved from the design position.
    bool confirmed = false;
    std::string why_not = {};
};
Confirmation confirm(const Scene& scene, std::span<const Figure> figures,
                     const Eigen::VectorXd& values, const Eigen::VectorXd& movement);

// The step in which the effect of a number is shown: 1 mm of a length, else 1 % of the value; one
// unit where that is zero.
inline double step_of(const Number& number) { return varied_number(number).step; }

// Smaller changes of a figure of this value are rounding.
inline double min_movement(double value) { return 1e-9 * (1 + std::abs(value)); }

}  // namespace elastocheck::compare
