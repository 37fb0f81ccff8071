// Results of solve-for, of a fit and of a tolerance analysis as terminal text and JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/design/fit.hpp"
#include "compare/design/solve_for.hpp"
#include "compare/design/tolerances.hpp"
#include "compare/result/table.hpp"

namespace elastocheck::reports {

// Incremented when a field changes its meaning or is removed; new fields do not increment them.
inline constexpr const char* solve_for_schema = "elastocheck/solve-for/1";
inline constexpr const char* fit_schema = "elastocheck/fit/1";
inline constexpr const char* tolerances_schema = "elastocheck/tolerances/2";

// A figure with its place, "jounce = 3000 N".
struct NamedFigure {
    compare::Figure figure;
    compare::Channel output;
    std::string place;
};

// ---- Results of a search

// Numbers of a scene before and after a search within limits, in their units.
struct ChangedNumbers {
    const std::vector<Number>& numbers;
    const Eigen::VectorXd &from, &to, &low, &high;
    const std::vector<int>& at_limit;  // -1, 0, +1: held by this limit; empty: none is
};
compare::Table numbers_table(const ChangedNumbers& changed);
std::string confirmation_text(const compare::Confirmation& by);
// A line that names the limits beyond which `what` ("bands") would come nearer.
std::string limits_text(const ChangedNumbers& changed, const char* what);

// ---- solve-for

struct SolvedFor {
    std::vector<Number> numbers;
    std::vector<NamedFigure> wanted = {};
    compare::Wishes wishes;
    compare::Solution solution = {};
    compare::Confirmation by = {};
};
std::string solve_for_text(const SolvedFor& solved);
nlohmann::ordered_json solve_for_json(const SolvedFor& solved);

// ---- fit

// An output that was not measured and tells an undetermined combination apart.
struct ProposedOutput {
    std::string output, unit, place;  // without output: none moves with the combination
    double movement = 0, share = 0;   // compare::Proposal
};
struct FittedScene {
    std::vector<Number> numbers;
    compare::Measured measured;
    std::vector<compare::Channel> columns;
    std::vector<std::string> left_out;
    compare::Fitted fitted;
    std::vector<ProposedOutput> proposed = {};  // per undetermined combination
};
std::string fit_text(const FittedScene& fit);
nlohmann::ordered_json fit_json(const FittedScene& fit);

// ---- tolerances

struct ToleratedFigure {
    NamedFigure named;
    double nominal = 0;
    compare::Scatter scatter;
};
struct ToleratedScene {
    std::vector<compare::Tolerated> numbers;
    std::vector<ToleratedFigure> figures;
};
std::string tolerances_text(const ToleratedScene& all, int most);
nlohmann::ordered_json tolerances_json(const ToleratedScene& all);

}  // namespace elastocheck::reports
