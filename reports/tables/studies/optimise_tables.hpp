// Result of `optimise` as terminal text and JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/design/optimise.hpp"
#include "compare/proofs/certify.hpp"

namespace elastocheck::reports {

// Incremented when a field changes its meaning or is removed; new fields do not increment it.
inline constexpr const char* optimise_schema = "elastocheck/optimise/1";

struct GoalPoint {
    compare::Figure figure;
    std::string place;  // "jounce = 3000 N", "travel = 80 mm"
};
// What the points of a curve lie on: "travel" in mm, or a branch by its parameter.
struct Along {
    std::string name, unit;
    double factor = 1;  // from Figure::at to the unit
};
// A band of an output at one point, or at the points of a curve.
struct Goal {
    std::string output, unit;
    std::string where;              // the place of its point, or "travel from -80 to 80 mm"
    double low = 0, high = 0;       // infinite: no bound
    std::vector<GoalPoint> points;  // in the order of their places
    Along along = {};               // of a curve
    int line = 0;                   // of the file
    std::string not_moved = {};     // reason why no number moves it; the search leaves it out
};

// Where a curve is furthest outside of its band between its points, in the unit of the output.
struct Between {
    double excess = 0;
    std::string what;  // "toe at travel = 77.5 mm"
};

struct OptimisedScene {
    std::vector<Number> numbers;
    std::vector<Goal> goals = {};
    std::string minimised = {},
                minimised_unit = {};  // "bump_steer at jounce = 0 N"; empty: the change
    // of the figures: the points of the goals in order, then the minimised one
    compare::Goals limits = {};
    compare::Optimum optimum;
    std::vector<compare::Search> searches = {};
    compare::Confirmation confirmation = {};
    std::optional<Between> between = {};
    std::optional<compare::CertifyStudy> certificate = {};  // if the bands are met
};
std::string optimise_text(const OptimisedScene& scene);
nlohmann::ordered_json optimise_json(const OptimisedScene& scene);

}  // namespace elastocheck::reports
