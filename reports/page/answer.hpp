// The answers of a report: how far its numbers can be trusted, and which fast method is good enough.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "reports/document/scene_analyses.hpp"

namespace elastocheck::reports {

// "Every number on these pages: two independent solutions agree to 9e-12 mm and 2e-13 deg, proved at
// 33 points."; or why nothing can be relied on.
std::string trust_sentence(const SceneAnalyses& scene);

// A fast method at one setting: the cheapest that is good enough, else the most accurate one.
struct MethodRow {
    std::string method, setting;  // "tangent", "40 steps"
    // largest error [mm], [deg] at equal parameter, and at the ends of the branches at equal
    // abscissa; NaN where not studied
    double mm = std::numeric_limits<double>::quiet_NaN();
    double deg = std::numeric_limits<double>::quiet_NaN();
    double mm_at_abscissa = std::numeric_limits<double>::quiet_NaN();
    double deg_at_abscissa = std::numeric_limits<double>::quiet_NaN();
    double cost = std::numeric_limits<double>::quiet_NaN();  // work over that of the full solution
    bool within = false;                                     // of the tolerance
    bool chosen = false;                                     // recommended
};
// In ascending order of their cost; empty where no method was studied.
std::vector<MethodRow> method_rows(const SceneAnalyses& scene);

// "0.01 mm and 0.001 deg"; empty without a tolerance.
std::string tolerance_of(const SceneAnalyses& scene);

// The cheapest method within the tolerance, and how far the published one is off; empty where
// nothing was studied.
std::string method_sentence(const SceneAnalyses& scene);

}  // namespace elastocheck::reports
