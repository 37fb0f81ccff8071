// Results of solve-for, optimise, fit and tolerances for readers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/design/fit.hpp"
#include "compare/design/optimise.hpp"
#include "compare/design/tolerances.hpp"
#include "compare/proofs/certify.hpp"
#include "compare/result/result.hpp"

namespace elastocheck::compare {

struct SolvedFor {
    const Varied& varied;
    std::vector<Figure> wanted = {};
    Eigen::VectorXd target = {};  // wanted value of each figure, in its unit
    SearchStart start = {};
    Solution solution = {};
    Eigen::VectorXd after = {};  // figures at the numbers of the solution, in their units
    Confirmation by = {};        // confirmation of `after` by the other legs
    bool met() const { return after.allFinite() && solution.excess() <= met_within; }
};
Result result_of(const SolvedFor& solved);

// A band of an output at one point, or at the points of a curve.
struct Goal {
    std::vector<Figure> points = {};  // figures in the order of their stations
    double low = -INFINITY, high = INFINITY;
    std::string where =
        {};  // station of its point, or range of its curve, "travel from -80 to 80 mm"
    // Only for a curve: the output, or the branch whose parameter is the abscissa, and its unit.
    std::string along = {}, along_unit = {};
    double along_factor = 1;     // factor from Figure::station to that unit
    bool any_branch = false;     // each point lies on the branch that reaches its place
    int line = 0;                // line of the file
    std::string not_moved = {};  // reason why no number moves it; the search leaves it out

    std::string output() const;  // "toe (change)"
};
// Where a curve is furthest outside of its band between its points, in the unit of the output.
struct Between {
    double excess = 0;
    std::string what;  // "toe at travel = 77.5 mm"
};
struct OptimisedScene {
    const Varied& varied;
    std::vector<Goal> goals = {};
    std::optional<Figure> minimised = {};  // if none, the change of the numbers is minimised
    // The points of the goals in order, then the minimised figure.
    std::vector<Figure> figures = {};
    Optimum optimum = {};
    std::vector<Search> searches = {};  // those before points were added between the goals' points
    Confirmation by = {};               // confirmation of the figures by the other legs
    std::optional<Between> between = {};
    std::optional<CertifyStudy> certificate = {};  // if the bands are met
};
Result result_of(const OptimisedScene& scene);

// An output that was not measured, and that would determine a combination of numbers that the
// measured outputs leave undetermined.
struct ProposedOutput {
    Figure figure = {};  // without a name if no output moves with the combination
    Proposal by = {};    // how far it moves
};
struct FittedScene {
    Varied varied;
    Measured measured;
    std::vector<Channel> columns;       // outputs that are fitted
    std::vector<std::string> left_out;  // columns and rows that are not, and why
    Fitted fitted = {};
    std::vector<ProposedOutput> proposed = {};  // one for each undetermined combination
};
Result result_of(const FittedScene& fit);

struct ToleratedScene {
    ToleratedNumbers tolerances = {};
    std::vector<Figure> figures = {};
    std::vector<double> nominal = {};  // values of the figures, in their units
    std::vector<Scatter> scatter = {};
    std::vector<std::string> missing = {};  // reasons why requested figures have no scatter
};
// With the `max_shares` largest shares of each figure; 0: all.
Result result_of(const ToleratedScene& scene, int max_shares);

}  // namespace elastocheck::compare
