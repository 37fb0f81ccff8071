// Figures of a scene, outputs at stations of its branches, as functions of numbers of its file.
//
// The algorithms of this room know a scene by `Figures` alone. Its implementation here differences
// solutions of the equilibrium leg at changed numbers, each from the reader on: settled start and
// trim are part of the function.
//
//   D(h) = (f(p + h) - f(p - h)) / 2h      R(h) = (4 D(h/2) - D(h)) / 3      (Richardson)
//   df/dp ≈ (16 R(h/2) - R(h)) / 15
//
// The estimate of its error is |R(h/2) - R(h)|, which is larger than the error of R(h/2). At a kink
// (a stop that just touches) it has the size of the jump.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

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
    Eigen::MatrixXd error;  // estimate; zero where the rate is exact
};

struct Figures {
    // in the units of the outputs; NaN where there is none
    std::function<Eigen::VectorXd(const Eigen::VectorXd& p)> value;
    std::function<FigureGradient(const Eigen::VectorXd& p)> gradient;
};

// The scene with these values of the varied numbers. May throw std::runtime_error: no such scene.
using SceneAt = std::function<Scene(const Eigen::VectorXd& p)>;

// All outputs of a model that a figure can be: channels, characteristics, forces of elements.
std::vector<Channel> figure_outputs(const Model& model);

// Values of the figures by one leg, in their units. NaN where there is none, with the reason in
// `why_not` (of the first).
struct FigureValues {
    Eigen::VectorXd value;
    std::string why_not = {};
    bool not_applicable = false;  // the reason is that the leg does not apply to the scene
};
FigureValues figure_values(const Scene& scene, std::span<const Figure> figures, Leg leg);

// The step in which the effect of a number is differenced and shown: 1 mm of a length, else 1 % of
// the value; one unit where that is zero.
double step_of(const Number& number);

// By the equilibrium leg, and by differences with h = 0.4 of the step of each number.
Figures differenced_figures(SceneAt scene_at, std::vector<Figure> figures,
                            std::vector<Number> numbers, int threads = 1);

}  // namespace elastocheck::compare
