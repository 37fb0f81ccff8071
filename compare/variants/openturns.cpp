#include "compare/variants/openturns.hpp"

#include <algorithm>
#include <cmath>
#include <locale>
#include <openturns/Beta.hxx>
#include <openturns/Binomial.hxx>
#include <openturns/ComposedDistribution.hxx>
#include <openturns/DistFunc.hxx>
#include <openturns/JansenSensitivityAlgorithm.hxx>
#include <openturns/LHSExperiment.hxx>
#include <openturns/Normal.hxx>
#include <openturns/NormalCopula.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/SobolSequence.hxx>
#include <openturns/Triangular.hxx>
#include <openturns/TruncatedNormal.hxx>
#include <openturns/Uniform.hxx>
#include <stdexcept>

#include "models/overloaded.hpp"

namespace elastocheck::compare::variants::openturns {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

OT::UnsignedInteger size(Index n) { return static_cast<OT::UnsignedInteger>(n); }
OT::UnsignedInteger size(std::size_t n) { return static_cast<OT::UnsignedInteger>(n); }

OT::Distribution distribution(const Distribution& of) {
    const auto none = []() -> OT::Distribution {
        throw std::invalid_argument("not a continuous distribution");
    };
    return std::visit(
        overloaded{[](const Normal& d) -> OT::Distribution { return OT::Normal(d.mean, d.sd); },
                   [](const Uniform& d) -> OT::Distribution { return OT::Uniform(d.low, d.high); },
                   [](const Triangular& d) -> OT::Distribution {
                       return OT::Triangular(d.low, d.mode, d.high);
                   },
                   [](const TruncatedNormal& d) -> OT::Distribution {
                       return OT::TruncatedNormal(d.mean, d.sd, d.low, d.high);
                   },
                   [&](const Levels&) { return none(); }, [&](const Given&) { return none(); }},
        of);
}

}  // namespace

bool available() { return true; }

namespace {

// OpenTURNS writes formulas in the locale of the process and parses them with a decimal point.
struct ClassicLocale {
    std::locale before = std::locale::global(std::locale::classic());
    ~ClassicLocale() { std::locale::global(before); }
};

}  // namespace

Transformation transformation(const std::vector<Distribution>& distributions,
                              const MatrixXd& correlation) {
    const ClassicLocale in_force;
    OT::Collection<OT::Distribution> marginals;
    for (const Distribution& one : distributions) marginals.add(distribution(one));
    OT::ComposedDistribution joint(marginals);
    if (correlation.size() > 0) {
        OT::CorrelationMatrix R(size(correlation.rows()));
        for (Index i = 0; i < correlation.rows(); ++i)
            for (Index j = 0; j < i; ++j) R(size(i), size(j)) = correlation(i, j);
        joint.setCopula(OT::NormalCopula(R));
    }
    return [inverse = joint.getInverseIsoProbabilisticTransformation()](const MatrixXd& u) {
        const ClassicLocale also_here;
        OT::Sample z(size(u.rows()), size(u.cols()));
        for (Index i = 0; i < u.rows(); ++i)
            for (Index j = 0; j < u.cols(); ++j)
                z(size(i), size(j)) = OT::DistFunc::qNormal(u(i, j));
        const OT::Sample x = inverse(z);
        MatrixXd values(u.rows(), u.cols());
        for (Index i = 0; i < u.rows(); ++i)
            for (Index j = 0; j < u.cols(); ++j) values(i, j) = x(size(i), size(j));
        return values;
    };
}

std::vector<std::vector<std::uint64_t>> sobol_directions(std::size_t dimension, int bits) {
    // The Gray code of n = 2ʲ⁺¹ - 1 is 2ʲ: this point, the first of them n = 1, is direction j itself.
    OT::SobolSequence sequence(size(dimension));
    std::vector<std::vector<std::uint64_t>> directions(dimension);
    std::uint64_t n = 0;
    constexpr std::uint64_t at_once = 4096;  // of which the memory is bounded
    for (int j = 0; j < bits; ++j) {
        const std::uint64_t next = (std::uint64_t{2} << j) - 1;
        OT::Sample points(0, size(dimension));
        for (; n < next; n += points.getSize())
            points = sequence.generate(std::min(at_once, next - n));
        for (std::size_t d = 0; d < dimension; ++d)
            directions[d].push_back(
                static_cast<std::uint64_t>(std::ldexp(points(points.getSize() - 1, size(d)), 53)));
    }
    return directions;
}

MatrixXd latin_hypercube(std::uint64_t count, std::size_t dimension, std::uint64_t seed) {
    OT::Collection<OT::Distribution> cube(size(dimension), OT::Uniform(0, 1));
    OT::RandomGenerator::SetSeed(static_cast<OT::UnsignedInteger>(seed));
    const OT::Sample points =
        OT::LHSExperiment(OT::ComposedDistribution(cube), static_cast<OT::UnsignedInteger>(count))
            .generate();
    MatrixXd u(static_cast<Index>(count), static_cast<Index>(dimension));
    for (Index i = 0; i < u.rows(); ++i)
        for (Index j = 0; j < u.cols(); ++j) u(i, j) = points(size(i), size(j));
    return u;
}

std::pair<double, double> clopper_pearson(std::uint64_t hits, std::uint64_t all, double level) {
    const double tail = (1 - level) / 2, k = static_cast<double>(hits),
                 n = static_cast<double>(all);
    return {hits == 0 ? 0.0 : OT::Beta(k, n - k + 1, 0, 1).computeQuantile(tail)[0],
            hits == all ? 1.0 : OT::Beta(k + 1, n - k, 0, 1).computeQuantile(1 - tail)[0]};
}

// With B the number of draws below the percentile, binomial: the value of rank r (from 1) is above
// it where B < r. P(B < low) <= tail, P(B >= high) <= tail.
std::pair<std::int64_t, std::int64_t> percentile_ranks(std::uint64_t all, double share,
                                                       double level) {
    const OT::Binomial below(static_cast<OT::UnsignedInteger>(all), share);
    const double tail = (1 - level) / 2;
    const auto n = static_cast<std::int64_t>(all);
    auto low = static_cast<std::int64_t>(below.computeQuantile(tail)[0]);
    while (low > 0 && below.computeCDF(static_cast<double>(low) - 1) > tail) --low;
    auto high = static_cast<std::int64_t>(below.computeQuantile(1 - tail)[0]) + 1;
    while (high <= n && below.computeCDF(static_cast<double>(high) - 1) < 1 - tail) ++high;
    return {low - 1, high - 1};
}

SobolIndices sobol_indices(const MatrixXd& outputs, double level, std::uint64_t seed) {
    // OpenTURNS takes block after block: all a, all b, all with variable 1 exchanged, ...
    const Index blocks = outputs.rows(), d = outputs.cols() - 2;
    OT::Sample y(size(outputs.size()), 1);
    for (Index c = 0; c < outputs.cols(); ++c)
        for (Index i = 0; i < blocks; ++i) y(size(c * blocks + i), 0) = outputs(i, c);
    // Of the inputs only the number is used.
    const OT::Sample x(size(outputs.size()), size(d));
    OT::RandomGenerator::SetSeed(static_cast<OT::UnsignedInteger>(seed));
    OT::JansenSensitivityAlgorithm algorithm(x, y, size(blocks));
    algorithm.setUseAsymptoticDistribution(false);
    algorithm.setConfidenceLevel(level);
    const OT::Point first = algorithm.getFirstOrderIndices(),
                    total = algorithm.getTotalOrderIndices();
    const OT::Interval first_in = algorithm.getFirstOrderIndicesInterval(),
                       total_in = algorithm.getTotalOrderIndicesInterval();
    SobolIndices found{Eigen::MatrixX3d(d, 3), Eigen::MatrixX3d(d, 3)};
    for (Index j = 0; j < d; ++j) {
        found.first.row(j) << first[size(j)], first_in.getLowerBound()[size(j)],
            first_in.getUpperBound()[size(j)];
        found.total.row(j) << total[size(j)], total_in.getLowerBound()[size(j)],
            total_in.getUpperBound()[size(j)];
    }
    return found;
}

}  // namespace elastocheck::compare::variants::openturns
