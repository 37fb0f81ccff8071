// Figures of a scene, outputs at stations of its branches, as functions of numbers of its file, and
// their rates by differences of whole solutions:
//
//   dy/dp = (8 (y(h) - y(-h)) - (y(2h) - y(-2h))) / 12h
//
// Each evaluation of y trims the scene, and computes the equilibria anew. Where the slopes to both sides
// differ, h is shortened; where they still differ, there is no rate.
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
    double station = 0;  // parameter of the branch [SI], or value of `abscissa` in its unit
    std::string abscissa =
        {};               // output over which the station is given, "travel"; empty: the parameter
    bool change = false;  // the figure is the change from the design position, not the value
    std::string unit = {}, station_text = {};  // shown to the user: "deg", "jounce = 3000 N"
};

// Outputs of a model that figures can name: channels, characteristics, forces of elements, and with
// `with_sums` the total reactions of groups of redundant joints.
std::vector<Channel> figure_outputs(const Model& model, bool with_sums = true);

// Values of figures by one leg (one of the solvers), in their units; NaN for a figure without a value.
struct FigureValues {
    Eigen::VectorXd value;
    std::string why_not = {};     // reason for the first figure without a value
    bool not_applicable = false;  // the reason is that the leg does not apply to the scene
};
FigureValues evaluate(const Model& model, std::span<const Figure> figures, Leg leg);

// States of a leg at which figures of one branch are read: at values of its parameter, or along the
// whole branch for figures over another output.
struct StatesOfFigures {
    std::size_t branch = 0;     // position in Model::branches
    bool whole_branch = false;  // the states are those of the whole branch
    std::vector<BranchSide> sides;
    std::vector<Equilibrium> states = {};
    Outcome outcome = Outcome::converged;  // why states are missing
    std::string detail = {};

    bool complete() const { return outcome == Outcome::converged; }
};
// The two parts of evaluate(): solve for the states, and read the figures at them.
std::vector<StatesOfFigures> states_of(const Model& model, std::span<const Figure> figures,
                                       Leg leg);
FigureValues read_figures(const Model& model, std::span<const StatesOfFigures> states,
                          std::span<const Figure> figures, Leg leg);
// For each model, solves for the states at the stations of `states`, which belong to a similar model: by the
// equilibrium leg with the chord method (models/neighbours.hpp), one factorisation per state for all models.
// The entry of a model is empty if the model is null or of another structure, and where the method does not
// converge.
std::vector<std::vector<StatesOfFigures>> neighbouring_states(
    std::span<const StatesOfFigures> states, std::span<const Model* const> models, int threads);

// Values of the figures after the trim of the scene.
FigureValues figure_values(const Scene& scene, std::span<const Figure> figures,
                           Leg leg = Leg::equilibrium);

// Start and limits of the numbers of a search, in their units. The limits are infinite where there are none;
// point() and shares() need finite limits.
struct SearchRange {
    Eigen::VectorXd start, low, high;
    // p = start + shares · (high - low), clamped to the limits.
    Eigen::VectorXd point(const Eigen::VectorXd& shares) const;
    // Inverse of point() within the limits.
    Eigen::VectorXd shares(const Eigen::VectorXd& p) const;
};

// Numbers of a scene that may change, in the units of its file.
struct Varied : SearchRange {
    std::vector<Number> numbers = {};
    // The scene with these values. May throw std::runtime_error: no such scene.
    std::function<Scene(const Eigen::VectorXd& p)> scene = {};
};

// Figures as functions of the numbers p. The algorithms of this folder see a scene only as these functions.
struct Figures {
    // Values at points that are near the first one, in the units of the outputs; NaN where there is none.
    std::function<std::vector<Eigen::VectorXd>(const std::vector<Eigen::VectorXd>& p)> values;
    Eigen::VectorXd step;  // step h of the differences, per number

    Eigen::VectorXd value(const Eigen::VectorXd& p) const { return values({p}).front(); }
    // dy/dp [figures × numbers]; NaN where there is no rate.
    Eigen::MatrixXd gradient(const Eigen::VectorXd& p) const;
};
// Functions that solve by the equilibrium leg, points on several threads. Trim and states start from those at p[0] of
// the last call where that is near, else from the design position.
Figures solved_figures(const Varied& varied, std::vector<Figure> figures, int threads = 1);

// Reason why one of the figures has no value, or else no rate, at p: "no rate at the start: ..."; empty if
// all have both. `where` is the name of p in the text.
std::string why_not_solved(const Varied& varied, std::span<const Figure> figures,
                           const Eigen::VectorXd& p, const char* where = "the start");
// Reasons why none of the numbers moves a figure at the start, a line for each number:
// "springs.coil.rate: no output moves with it".
std::string why_still(const Varied& varied, const Figure& figure);

// Figures of the equilibrium leg, computed again by the energy leg and by the series.
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

// Smallest change of a figure of this value that is not rounding.
inline double min_movement(double value) { return 1e-9 * (1 + std::abs(value)); }

}  // namespace elastocheck::compare
