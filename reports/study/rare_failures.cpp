#include "reports/study/rare_failures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compare/variants/sampler.hpp"
#include "compare/variants/statistics.hpp"
#include "reports/study/run_study.hpp"

namespace elastocheck::reports {
namespace {

namespace openturns = compare::variants::openturns;

// A variant without a value ends the search for a limit.
struct NoValue : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// From independent standard normal variables to those of the study.
openturns::Transformation from_normal(const compare::variants::Study& study) {
    std::vector<compare::variants::Distribution> distributions;
    for (const auto& variable : study.variables) distributions.push_back(variable.distribution);
    return [inverse = openturns::transformation(distributions, study.correlation)](
               const Eigen::MatrixXd& z) -> Eigen::MatrixXd {
        static constexpr double most = 1 - 0x1p-53;
        return inverse(z.unaryExpr([](double x) {
            return std::clamp(0.5 * std::erfc(-x / std::sqrt(2.0)), 1e-300, most);
        }));
    };
}

}  // namespace

std::vector<RareFailure> rare_failures(const StudyFile& file, std::uint64_t most,
                                       const compare::Progress& progress) {
    const auto& study = file.study;
    for (const auto& variable : study.variables)
        if (!is_continuous(variable.distribution))
            throw std::invalid_argument(fmt::format(
                "--rare needs continuous distributions, and '{}' has none", variable.name));
    std::vector<RareFailure> all;
    for (std::size_t j = 0; j < study.figures.size(); ++j)
        for (const bool above : {false, true}) {
            const double limit = above ? study.figures[j].high : study.figures[j].low;
            if (std::isfinite(limit)) all.push_back({.figure = j, .limit = {above, limit}});
        }
    if (all.empty()) throw std::invalid_argument("--rare needs limits, and the study has none");
    const auto transform = from_normal(study);
    for (std::size_t r = 0; r < all.size(); ++r) {
        RareFailure& rare = all[r];
        const std::string& name = study.figures[rare.figure].name;
        std::uint64_t evaluated = 0;
        const auto values = [&](const Eigen::MatrixXd& z) {
            const auto solved = solve_values(file, transform(z));
            Eigen::VectorXd y(z.rows());
            for (std::size_t i = 0; i < solved.size(); ++i) {
                y[static_cast<Eigen::Index>(i)] = solved[i].values[rare.figure];
                if (!std::isfinite(solved[i].values[rare.figure]))
                    throw NoValue(solved[i].reason.empty() ? "an infinite value"
                                                           : solved[i].reason);
            }
            evaluated += solved.size();
            const double part =
                std::min(1.0, static_cast<double>(evaluated) / static_cast<double>(most));
            if (progress)
                progress(fmt::format("rare failures: {}", name),
                         (static_cast<double>(r) + part) / static_cast<double>(all.size()));
            return y;
        };
        try {
            const double design = values(
                Eigen::MatrixXd::Zero(1, static_cast<Eigen::Index>(study.variables.size())))[0];
            if (rare.limit.above ? design > rare.limit.at : design < rare.limit.at) {
                // Importance sampling about a point of failure would miss most failures.
                rare.trouble = "the design is beyond this limit, so that failures are not rare";
                continue;
            }
            rare.found =
                openturns::rare(values, study.variables.size(), rare.limit,
                                compare::variants::confidence, study.design.seed, most, batch_size);
            const Eigen::MatrixXd x = transform(rare.found.point.transpose());
            for (std::size_t v = 0; v < study.variables.size(); ++v)
                rare.at += fmt::format("{}{} {:.5g}", v > 0 ? ", " : "", study.variables[v].name,
                                       x(0, static_cast<Eigen::Index>(v)));
            if (!rare.found.is_found)
                rare.trouble = "the search for the most probable failure did not converge";
        } catch (const NoValue& error) {
            rare.trouble = fmt::format("a variant has no value: {}", error.what());
        }
    }
    return all;
}

}  // namespace elastocheck::reports
