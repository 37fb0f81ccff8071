// Figures of a scene, outputs at stations of its branches, as functions of numbers of its file.
//
// The algorithms of this room know a scene by `Figures` alone. Its implementation here is the
// equilibrium leg: values by solution of the scene, from the reader on, rates by the derivatives of
// compare/sensitivity. Settled start and trim are part of the function. A figure y at a value of
// another output x is at the parameter a where x(a, p) has it, so that
//
//   dy/dp = ∂y/∂p - (∂y/∂a) / (∂x/∂a) ∂x/∂p
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
    std::string name;       // of the output: "bump_steer", "toe"
    std::string branch;     // its name
    double at = 0;          // parameter of the branch [SI]; or, with `over`, a value of that output
    std::string over = {};  // output that gives the place: "travel"; in its unit
    bool change = false;    // counts from the design position
};

// Rates of the figures by the numbers [figures × numbers], unit of the figure per unit of the
// number in the file.
struct FigureGradient {
    Eigen::MatrixXd rate;
    std::string why_not = {};  // figure, number and reason of the first rate that is NaN
};

struct Figures {
    // in the units of the outputs; NaN where there is none
    std::function<Eigen::VectorXd(const Eigen::VectorXd& p)> value;
    std::function<FigureGradient(const Eigen::VectorXd& p)> gradient;
};

// The scene with these values of the varied numbers. May throw std::runtime_error: no such scene.
using SceneAt = std::function<Scene(const Eigen::VectorXd& p)>;

// All outputs of a model that a figure can be: channels, characteristics, forces of elements, sums
// of what redundant joints share.
std::vector<Channel> figure_outputs(const Model& model, bool with_sums = true);

// Values of figures by one leg, in their units, and the parameters of their branches where they are
// [SI]. NaN where there is none, with the reason in `why_not` (of the first).
struct FigureValues {
    Eigen::VectorXd value, place;
    std::string why_not = {};
    bool not_applicable = false;  // the reason is that the leg does not apply to the scene
};
FigureValues evaluate(const Model& model, std::span<const Figure> figures, Leg leg);
// Of the scene with its trim.
FigureValues figure_values(const Scene& scene, std::span<const Figure> figures, Leg leg);

// Rates of the figures by the equilibrium leg; `scene` is `varying` at its values. NaN where there is
// none: a figure without value, a kink. Branches on several threads.
FigureGradient figure_gradient(const Scene& scene, const VaryingScene& varying,
                               std::span<const Figure> figures, int threads = 1);

// The step in which the effect of a number is shown: 1 mm of a length, else 1 % of the value; one
// unit where that is zero.
double step_of(const Number& number);

// By the equilibrium leg; `numbers`: those of p, by their paths and units.
Figures solved_figures(SceneAt scene_at, std::vector<Number> numbers, std::vector<Figure> figures,
                       int threads = 1);

// Figures that the equilibrium leg found, by the energy leg and by the series.
struct Confirmation {
    Eigen::VectorXd energy, series;  // figures in their units; NaN where a leg does not apply
    // A leg other than the equilibrium leg applies, and each that applies agrees on every figure, to
    // a millionth of its movement over the ranges of the numbers.
    bool confirmed = false;
    std::string why_not = {};
};
// `values` and `movement` per figure, in the units that `units` name in messages.
Confirmation confirm(const Scene& scene, std::span<const Figure> figures,
                     const std::vector<std::string>& units, const Eigen::VectorXd& values,
                     const Eigen::VectorXd& movement);

// What moves a figure of this value by less, does not move it: rounding.
inline double least_movement(double value) { return 1e-10 * (1 + std::abs(value)); }

}  // namespace elastocheck::compare
