// A study of many variants of a scene, as data: which numbers vary and how, which variants are
// computed, what is read from each.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "elastocheck/channels.hpp"

namespace elastocheck::compare::variants {

// ---- Distributions of a number, in its unit in the scene file, or of a factor.

struct Normal {
    double mean = 0, sd = 1;
};
struct Uniform {
    double low = 0, high = 1;
};
struct Triangular {
    double low = 0, mode = 0.5, high = 1;
};
struct TruncatedNormal {  // a normal distribution, given that the value lies between the ends
    double mean = 0, sd = 1, low = -1, high = 1;
};
struct Levels {  // each equally likely
    std::vector<double> values;
};
struct Given {};  // by the design alone, a list of variants
using Distribution = std::variant<Normal, Uniform, Triangular, TruncatedNormal, Levels, Given>;

struct Scaled {
    std::string path;
    double nominal = 0;  // multiplied by the factor
};
struct Variable {
    std::string name;  // of a number of the scene, or the user's own name of a factor
    std::string unit;
    double nominal = 0;  // of the scene; 1 of a factor
    Distribution distribution;
    std::vector<Scaled> scaled = {};  // by the factor; empty: the variable is a number itself
};

// ---- Designs of experiments. Variant k, from 0, is a function of the study and k alone.

struct Grid {};  // all combinations of levels; the last variable changes fastest
struct List {
    Eigen::MatrixXd values;  // [variants × variables]
};
struct MonteCarlo {};
struct LatinHypercube {};  // a function of the number of variants, too: it cannot be extended
struct Sobol {};           // a low-discrepancy sequence with a random digital shift
using DesignKind = std::variant<Grid, List, MonteCarlo, LatinHypercube, Sobol>;

struct Design {
    DesignKind kind = MonteCarlo{};
    std::uint64_t count = 0;
    std::uint64_t seed = 0;
    // Variants in blocks of d + 2 for Sobol indices of d variables: a, b, then a with one variable
    // after the other from b. Only of Monte Carlo and Sobol, of independent variables.
    bool indices = false;
};

// ---- Figures: an output at a station of a branch, or its extreme over the branch.

enum class Over { station, least, largest };
struct StudyFigure {
    std::string name;    // the user's own
    std::string output;  // "toe", "bump_steer"
    std::string branch;
    Over over = Over::station;
    double at = 0;  // parameter of the branch [SI], of a station
    Unit unit = Unit::none;
    std::string words = {};  // as written: "toe@jounce:3000"
    // limits in the unit of the output
    double low = -std::numeric_limits<double>::infinity(),
           high = std::numeric_limits<double>::infinity();

    bool has_limits() const {
        return low > -std::numeric_limits<double>::infinity() ||
               high < std::numeric_limits<double>::infinity();
    }
};

struct Study {
    std::vector<Variable> variables;
    // of the normal copula [variables × variables], positive definite; empty: independent variables
    Eigen::MatrixXd correlation;
    Design design;
    std::vector<StudyFigure> figures;
    int witness =
        0;  // every so many variants, from 0, are solved by the equilibrium leg too; 0: none
};

// The last variant number plus one that a study may have.
inline constexpr std::uint64_t most_variants = 1'000'000'000;
inline constexpr std::size_t most_variables = 500;

}  // namespace elastocheck::compare::variants
