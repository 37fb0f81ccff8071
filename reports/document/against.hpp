// Comparison of two variants of a scene: numbers, figures and curves that differ.
#pragma once

#include <string>
#include <vector>

#include "compare/comparison/changes.hpp"
#include "compare/result/result.hpp"

namespace elastocheck::reports {

struct SceneAnalyses;

// What differs between a scene (the base) and a variant, by the equilibrium leg.
struct Against {
    // Output or K&C figure at the design position; NaN: undefined. Swing arms differ by reciprocals.
    struct Figure {
        std::string output, unit;
        double base, variant, difference;
        std::string unit_of_difference;
        // ratio of the difference to what an engineer notices; infinite where one is undefined
        double noticed;
    };
    struct Line {
        std::vector<double> a{}, y{};  // parameters and values, each in the unit that is shown
    };
    struct Curve {  // a main output over a branch, at equal load or drive
        std::string output, unit;
        double largest, at, noticed;  // largest difference, its parameter, as in Figure
        Line base, variant;
    };
    struct Branch {
        std::string name, unit;
        std::vector<Curve> curves;
    };
    std::string name, source, hash;  // of the variant
    std::vector<compare::Change> numbers{};
    std::vector<Figure> figures{};  // noticed most first
    std::vector<Branch> branches{};
    std::vector<std::string> only_base{}, only_variant{};  // outputs and branches
};

Against differences(const SceneAnalyses& base, const SceneAnalyses& variant);

// Its tables: numbers of the scene, figures at the design position (two parts: those that an engineer
// notices, the others), largest differences of the curves, and the curves.
compare::Result result_of(const Against& against);

// "B against A: 1 number of the scene and 31 figures at the design position differ, most bump_steer
// [deg/m] from -2.16 to 0.0812."
std::string against_sentence(const std::string& base_source, const Against& against);

}  // namespace elastocheck::reports
