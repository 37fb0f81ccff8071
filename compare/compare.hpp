// One scene, three legs, side by side.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/channels.hpp"
#include "compare/deviation.hpp"
#include "models/equilibrium_path.hpp"
#include "models/model.hpp"
#include "recursive/solve.hpp"

namespace elastocheck::compare {

enum class Leg { recursive, equilibrium, energy };
inline constexpr std::array legs{Leg::recursive, Leg::equilibrium, Leg::energy};
const char* name(Leg leg);

// One leg along one branch.
struct LegRun {
    Leg leg = Leg::recursive;
    std::string method = {};  // of the recursion, else empty
    EquilibriumPath path;
    Curve curve;
    double seconds = 0;
    std::array<Residuals, legs.size()> judged;  // worst over the points, by the equations of each leg
};

// The recursion goes as `recursion` says, the published one unless it says otherwise; the references visit
// the load factors of its steps.
LegRun run(const Model& model, const Branch& branch, Leg leg, const recursive::Options& recursion = {});

// Deviation of b from a.
struct Pair {
    Leg a = Leg::equilibrium, b = Leg::recursive;
    Reading equal_load, equal_travel;
};

struct BranchComparison {
    std::string branch;
    std::vector<LegRun> runs;               // in the order of `legs`
    Pair deviation;                         // the recursion against the equilibrium leg
    Pair cross_check;                       // the recursion against the energy leg
    Pair uncertainty;                       // the energy leg against the equilibrium leg
    std::vector<std::string> inconclusive;  // why this branch cannot be judged; empty when it can
};

struct Comparison {
    std::vector<Channel> channels;
    std::vector<bool>
        unique;  // per channel; the reaction of a redundant joint is not determined, so never compared
    std::vector<BranchComparison> branches;
    int compared = 0;  // numbers compared in all

    bool conclusive() const;  // every leg converged, the references agree, something was compared
};

// When the references count as one truth. The bound on wrenches is a share of the largest one in the branch.
struct Agreement {
    double length = 1e-6;           // [mm]
    double angle = 1e-6;            // [deg]
    double wrench = 1e-7;           // [-]
    double residual_force = 1e-5;   // [N], [N·m]: each reference's states judged by the other leg
    double residual_length = 1e-8;  // [mm]
};

struct Options {
    recursive::Options recursion = {};  // method, steps (0: as each branch says) and the like
    Agreement agreement;
    std::function<void(std::string_view)> progress = {};  // told what is being solved
};

Comparison compare(const Model& model, const Options& options = {});

}  // namespace elastocheck::compare
