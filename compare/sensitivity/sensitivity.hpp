// Derivatives of the outputs by the numbers of a scene along its branches, by every leg.
// Outputs are channels, K&C characteristics, and forces and deformations of elements.
//
// Each leg follows the branch and differentiates its own conditions at its own states:
// recursive/sensitivity.hpp, reference/equilibrium/sensitivity.hpp, reference/energy/sensitivity.hpp.
// A derivative is taken at a constant parameter of the branch; the settled start is part of it.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "compare/sensitivity/trim_rates.hpp"
#include "elastocheck/channels.hpp"
#include "elastocheck/legs.hpp"
#include "models/rates/model_rates.hpp"

namespace elastocheck::compare {

// A number of the file, its unit there, and the step in which its effect is shown: 1 mm of a
// length, else 1 % of the value; one unit where that is zero.
struct VariedNumber {
    std::string path = {};
    double value = 0;
    std::string unit = {};
    double step = 1;  // in its unit
    const char* step_name = "1 %";
    int side = 0;  // 1, -1: at the end of its range; derivatives are those where it grows (falls)
    std::string undefined = {};  // reason why the model has no derivative by it
};
// Of the first where the rate is that of several numbers together.
VariedNumber varied_number(const ModelRate& rate, std::span<const Number> numbers);

// Of one leg along one side of a branch.
struct LegGradients {
    Leg leg = Leg::equilibrium;
    // per station [outputs × numbers], unit of the output per unit of the number in the file; NaN
    // where there is none
    std::vector<Eigen::MatrixXd> at;
    std::string failure;  // reason why stations are missing; empty if none is
    bool not_applicable = false;
};

// One-sided derivatives where there is no derivative [outputs × numbers], in the same units: where
// the number grows, and where it falls. NaN where there are none; empty matrices where every entry
// has a derivative.
struct OneSided {
    Eigen::MatrixXd growing, falling;
    bool empty() const { return growing.size() == 0; }
};

// Legs agree where no entry differs by more than this, as a share of the largest entry of its row:
// the output over all numbers and stations of the side, each number by its step. The largest entry
// counts as at least a millionth of the largest of all rows of motions (mm, deg), or of forces and
// moments (N, N·m), and 1e-5 of its unit; that of a characteristic as at least a thousandth of its unit.
inline constexpr double gradients_agree = 1e-8;
// The same of characteristics by the energy leg, whose third derivatives are extrapolated
// differences of its Hessian (reference/energy/linear_response.hpp).
inline constexpr double differences_agree = 1e-6;

// Difference of two legs that is the largest share of what is allowed.
struct Disagreement {
    double share = 0;  // of the largest entry of the output's row
    double allowed = gradients_agree;
    std::string where;  // "toe by points.a.z at 100 N: equilibrium 1.2, energy 1.3"
    long compared = 0;
    bool agrees() const { return share <= allowed; }
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
};

struct Gradients {
    std::vector<Channel> outputs;
    std::vector<VariedNumber> numbers;
    std::vector<SideGradients> sides;

    bool conclusive() const;  // every leg that applies converged, something is compared, all agree
};

struct GradientOptions {
    int points = 4;  // stations per branch after the start, equal increments of a
    // in place of them, per name of a branch: values of its parameter [SI]
    std::map<std::string, std::vector<double>> stations = {};
    std::vector<std::string> branches = {};  // names; empty: all
    std::vector<Leg> legs = {Leg::equilibrium, Leg::energy, Leg::series};
    // of a trimmed scene: `rates` are then TrimRates::numbers
    const TrimRates* trim = nullptr;
    std::function<void(const std::string&)> progress = {};
};

// `outputs`: of channels(model), characteristics(model) or element_channels(model). `rates`: of
// `model`, one per number.
Gradients gradients(const Model& model, std::span<const Channel> outputs,
                    std::span<const VariedNumber> numbers, std::span<const ModelRate> rates,
                    const GradientOptions& options = {});

}  // namespace elastocheck::compare
