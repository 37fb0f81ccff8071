// Derivatives of outputs of a state of a leg, by differences over models with a changed number.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/comparison/compliance.hpp"
#include "elastocheck/channels.hpp"
#include "elastocheck/legs.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::compare {

// A difference formula: offsets t of its points in h, and weights times h of the derivative, of the error
// of a formula of lower order, and of the kink, the difference of the slopes to both sides.
struct Stencil {
    std::array<double, 4> t, weight, check, kink;
};

// The scene and its compiled model where a number is larger by some amount.
struct Changed {
    Model model;
    std::optional<Trim> trim;  // as read, for its conditions
};
struct Changing {
    std::function<Changed(double by)> at;  // throws SceneError where the file does not accept it
    double h = 0;                          // step of the differences
    double step = 1;                       // step in which the effect is shown
};

// The models of one stencil: around the number, or on the side that the file accepts.
struct Compiled {
    std::vector<Changed> points = {};
    const Stencil* stencil = nullptr;
    double h = 0;
    int side = 0;                // 0 around the number, 1 or -1 where it grows or falls
    std::string undefined = {};  // reason why there are none
};
Compiled compiled(const Changing& changing);

// Outputs that are read on a side of a branch, also for neighbouring models.
struct Outputs {
    std::vector<Channel> channels;  // of the model of the side
    // The same channels in a neighbouring model: what they read, and the values they are counted from.
    struct Placed {
        std::vector<Reads> reads;
        Eigen::VectorXd from;
    };
    std::function<Placed(const Model& on_side, const std::optional<Trim>& trim)> placed;
};
struct ReadSide {
    BranchSide side;  // with its analysis
    Outputs outputs;
};
// The models on a side of a branch.
struct Neighbouring {
    std::vector<BranchSide> sides;
    std::vector<Outputs::Placed> placed;
    const Stencil* stencil = nullptr;
    double h = 0;
    std::string undefined = {};
};
Neighbouring on_side(const Compiled& compiled, const ReadSide& of);

// One-sided derivatives where there is no derivative [outputs × numbers], in the same units: where
// the number grows, and where it falls. NaN where there are none; empty matrices where every entry
// has a derivative.
struct OneSided {
    Eigen::MatrixXd growing, falling;
    bool empty() const { return growing.size() == 0; }
};

struct Rates {
    Eigen::MatrixXd at;  // [outputs × numbers], NaN where there is none
    // [outputs × numbers] rounding of the derivative, which stiff elements amplify, by the kinks over all
    // numbers
    Eigen::MatrixXd rounding;
    std::vector<std::string> why;  // per number: why there is none
    OneSided one_sided = {};
};
struct StateOfLeg {
    const ReadSide& side;
    Leg leg;
    const Equilibrium& state;
};
// `near`: of each of `numbers`. With `judges_kinks` an entry whose slopes to both sides differ
// has no derivative.
Rates rates_at(const StateOfLeg& of, std::span<const Changing> numbers,
               std::span<const Neighbouring> near, bool judges_kinks, Analyses& analyses);

// Sizes of the rows of such a matrix: `largest`, the largest entry of each times the step of its number, but
// at least a millionth of the largest of its kind (motions, forces) and 1e-5 of its unit; for a
// characteristic at least a thousandth of its unit.
std::vector<double> min_sizes(std::span<const Channel> outputs, std::vector<double> largest);

}  // namespace elastocheck::compare
