// Derivatives of the outputs by the numbers of a scene along its branches, by differences in every
// leg. Outputs are channels, K&C characteristics, and forces and deformations of elements.
//
// The scene with the number at p ± h, p ± 2h is read and compiled like any scene; each leg moves its
// own state to these models to first order (models/neighbours.hpp); the outputs are read from them
// by the ordinary code, and
//
//   dy/dp = (8 (y(h) - y(-h)) - (y(2h) - y(-2h))) / 12h
//
// Where the differences over h and 2h do not agree, h is shortened; where those to both sides do not
// agree either, there is no derivative but a kink. A derivative is taken at a constant parameter of
// the branch; settled start and trim are part of it: the adjustments x(p) of a trim solve
// c(x, p) = 0, so dy/dp = ∂y/∂p + ∂y/∂x dx/dp, dx/dp = -(∂c/∂x)⁻¹ ∂c/∂p, all by the same differences.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "compare/result/result.hpp"
#include "compare/sensitivity/differences.hpp"
#include "compare/sensitivity/varying.hpp"
#include "elastocheck/channels.hpp"
#include "elastocheck/legs.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::compare {

// Of one leg along one side of a branch.
struct LegGradients {
    Leg leg = Leg::equilibrium;
    // per station [outputs × numbers], unit of the output per unit of the number in the file; NaN
    // where there is none
    std::vector<Eigen::MatrixXd> at;
    std::vector<Eigen::MatrixXd> rounding;  // likewise, of `at`
    std::string failure;                    // reason why stations are missing; empty if none is
    bool not_applicable = false;
};

// Legs agree where no entry differs by more than this and its rounding, as a share of the largest entry
// of its row: the output over all numbers and stations of the side, each number by its step. The largest entry
// counts as at least a millionth of the largest of all rows of motions (mm, deg), or of forces and
// moments (N, N·m), and 1e-5 of its unit; that of a characteristic as at least a thousandth of its unit.
inline constexpr double gradients_agree = 1e-7;

// Difference of two legs that is the largest share of what is allowed.
struct Disagreement {
    double share = 0;   // beyond rounding, of the largest entry of the output's row
    double whole = 0;   // likewise, with its rounding
    std::string where;  // "toe by points.a.z at 100 N: equilibrium 1.2, energy 1.3"
    long compared = 0;
    bool agrees() const { return share <= gradients_agree; }
};

struct SideGradients {
    std::string name;  // of the side of the branch
    std::string branch;
    Unit unit = Unit::newton;
    std::vector<double> a;                    // stations [SI]
    std::vector<std::vector<double>> values;  // per station: of the outputs, in their units
    std::vector<LegGradients> legs;           // the equilibrium leg first
    // per station and number: reason why there is no derivative, by the equilibrium leg; empty: there
    // is one
    std::vector<std::vector<std::string>> why_number;
    std::vector<OneSided> one_sided;      // per station, by the equilibrium leg
    std::vector<std::string> why_output;  // per output, likewise: not determined on this branch
    Disagreement worst;

    // Every leg that failed, and the entry in which two differ most; empty where all agree.
    std::vector<std::string> not_confirmed() const;
};

struct Gradients {
    std::vector<Channel> outputs;
    std::vector<VariedNumber> numbers;
    std::vector<SideGradients> sides;

    // Likewise of all sides, and where nothing is compared.
    std::vector<std::string> not_confirmed() const;
    bool conclusive() const { return not_confirmed().empty(); }
};

struct GradientOptions {
    int points = 4;  // stations per branch after the start, equal increments of a
    // in place of them, per name of a branch: values of its parameter [SI]
    std::map<std::string, std::vector<double>> stations = {};
    std::vector<std::string> branches = {};  // names; empty: all
    // empty: equilibrium and series; the energy leg too where the scene is small, so that it costs
    // less than both
    std::vector<Leg> legs = {};
    // per output: whether it counts from the design position; empty: none does
    std::vector<bool> changes = {};
    bool by_parameter = false;  // one more number, the parameter of the branch [SI]
    int threads = 1;
    std::function<void(const std::string&)> progress = {};
};

// `scene` is `varying` at its values, `trimmed` the result of its trim (the scene itself without
// one), `model` compiled of that. `outputs`: of channels(model), characteristics(model) or
// element_channels(model).
Gradients gradients(const Scene& scene, const Trimmed& trimmed, const Model& model,
                    const VaryingScene& varying, std::span<const Channel> outputs,
                    const GradientOptions& options = {});

// Likewise of several groups of outputs: every scene is read, compiled and trimmed once for all of them.
// The legs, the threads and the progress are those of the first group.
struct GradientGroup {
    std::vector<Channel> outputs;
    GradientOptions options = {};
};
std::vector<Gradients> gradients(const Scene& scene, const Trimmed& trimmed, const Model& model,
                                 const VaryingScene& varying,
                                 std::span<const GradientGroup> groups);

// For every side and output the numbers with the largest effect, `most` of them (0: all), at the start
// and the end of the side; and in tables for programs every derivative, by the equilibrium leg.
Result result_of(const Gradients& all, int most);

}  // namespace elastocheck::compare
