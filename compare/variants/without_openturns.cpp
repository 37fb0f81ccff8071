#include <stdexcept>

#include "compare/variants/openturns.hpp"

namespace elastocheck::compare::variants::openturns {
namespace {

[[noreturn]] void fail() {
    throw std::invalid_argument(
        "a study needs OpenTURNS, which this program was built without; install libopenturns-dev "
        "and build again, as ./dev study does");
}

}  // namespace

bool available() { return false; }

Transformation transformation(const std::vector<Distribution>&, const Eigen::MatrixXd&) { fail(); }
std::vector<std::vector<std::uint64_t>> sobol_directions(std::size_t, int) { fail(); }
Eigen::MatrixXd latin_hypercube(std::uint64_t, std::size_t, std::uint64_t) { fail(); }
std::pair<double, double> clopper_pearson(std::uint64_t, std::uint64_t, double) { fail(); }
std::pair<std::int64_t, std::int64_t> percentile_ranks(std::uint64_t, double, double) { fail(); }
SobolIndices sobol_indices(const Eigen::MatrixXd&, double, std::uint64_t) { fail(); }

}  // namespace elastocheck::compare::variants::openturns
