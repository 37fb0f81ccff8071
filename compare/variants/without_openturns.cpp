// The program without OpenTURNS.
#include <stdexcept>

#include "compare/variants/openturns.hpp"

namespace elastocheck::compare::variants::openturns {
namespace {

[[noreturn]] void missing() {
    throw std::invalid_argument(
        "built without OpenTURNS, which draws the variants of a study; install libopenturns-dev "
        "and "
        "build again, or run ./dev study");
}

}  // namespace

struct Joint::State {};
bool available() { return false; }
Joint::Joint(const std::vector<Distribution>&, const Eigen::MatrixXd&) { missing(); }
Joint::~Joint() = default;
Joint::Joint(Joint&&) noexcept = default;
Eigen::MatrixXd Joint::values(const Eigen::MatrixXd&) const { missing(); }
std::vector<std::vector<std::uint64_t>> sobol_directions(std::size_t, int) { missing(); }
Eigen::MatrixXd latin_hypercube(std::uint64_t, std::size_t, std::uint64_t) { missing(); }
std::pair<double, double> clopper_pearson(std::uint64_t, std::uint64_t, double) { missing(); }
std::pair<std::int64_t, std::int64_t> percentile_ranks(std::uint64_t, double, double) { missing(); }
SobolIndices sobol_indices(const Eigen::MatrixXd&, double, std::uint64_t) { missing(); }

}  // namespace elastocheck::compare::variants::openturns
