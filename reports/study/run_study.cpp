#include "reports/study/run_study.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "compare/jobs/jobs.hpp"
#include "compare/variants/sampler.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::reports {
namespace {

using namespace compare::variants;
using Eigen::Index;

// The model with these values; without one, the reason.
std::optional<Model> model_of(const StudyFile& file, const Eigen::VectorXd& values,
                              VariantFigures& figures) {
    try {
        Scene scene = file.parsed.read(settings_of(file.study, values));
        if (!scene.trim) return compile(scene);
        const compare::Trimmed trimmed = compare::trim(scene);
        if (!trimmed.record || trimmed.record->reached()) return compile(trimmed.scene);
        figures.outcome = VariantOutcome::not_trimmed;
        figures.reason = trimmed.record->detail;
    } catch (const SceneError& error) {
        figures.outcome = VariantOutcome::no_scene;
        figures.reason = error.what();
    } catch (const std::invalid_argument& error) {  // an ill-posed trim
        figures.outcome = VariantOutcome::not_trimmed;
        figures.reason = error.what();
    }
    figures.values.assign(file.study.figures.size(), std::numeric_limits<double>::quiet_NaN());
    return std::nullopt;
}

std::vector<LedgerRow> solve_rows(const StudyFile& file, const Sampler& sampler,
                                  std::uint64_t first, std::uint64_t end,
                                  const std::set<std::uint64_t>& present) {
    const Eigen::MatrixXd values = sampler.values(first, end - first);
    std::vector<LedgerRow> rows;
    std::vector<Model> models;
    std::vector<std::size_t> at;  // row of each model
    for (std::uint64_t k = first; k < end; ++k) {
        if (present.contains(k)) continue;
        rows.push_back({.k = k, .figures = {}});
        auto model = model_of(file, values.row(static_cast<Index>(k - first)), rows.back().figures);
        const bool is_witness =
            file.study.witness > 0 && k % static_cast<std::uint64_t>(file.study.witness) == 0;
        if (is_witness)
            rows.back().witness.push_back(
                model ? file.solver.solve_alone(*model, compare::Leg::equilibrium)
                      : rows.back().figures);
        if (!model) continue;
        models.push_back(std::move(*model));
        at.push_back(rows.size() - 1);
    }
    auto solved = file.solver.solve(models);
    for (std::size_t m = 0; m < models.size(); ++m) rows[at[m]].figures = std::move(solved[m]);
    return rows;
}

}  // namespace

Computed run_study(const StudyFile& file, Ledger& ledger, const Shard& shard, int threads,
                   const compare::Progress& progress) {
    const std::uint64_t count = file.study.design.count;
    struct Batch {
        std::uint64_t first, end;
        bool is_partly_there;
    };
    std::vector<Batch> open;
    const auto rows = ledger.rows_by_batch(batch_size, count);
    std::uint64_t variants = 0;
    for (std::uint64_t b = shard.at - 1; b < rows.size(); b += shard.of) {
        const std::uint64_t first = b * batch_size, end = std::min(first + batch_size, count);
        if (rows[b] == end - first) continue;
        open.push_back({first, end, rows[b] > 0});
        variants += end - first - rows[b];
    }
    const auto start = std::chrono::steady_clock::now();
    const auto seconds = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    if (open.empty()) return {};
    const Sampler sampler(file.study);
    std::atomic<std::size_t> next = 0;
    std::mutex recording;
    std::uint64_t done = 0;
    const auto work = [&] {
        for (std::size_t b = next++; b < open.size(); b = next++) {
            const auto& [first, end, is_partly_there] = open[b];
            std::set<std::uint64_t> present;
            if (is_partly_there) {
                const std::scoped_lock guard(recording);
                present = ledger.rows_in(first, end);
            }
            const auto solved = solve_rows(file, sampler, first, end, present);
            const std::scoped_lock guard(recording);
            ledger.add(solved);
            done += solved.size();
            if (progress)
                progress(fmt::format("{} of {} variants, {:.0f} per second", done, variants,
                                     static_cast<double>(done) / seconds()),
                         static_cast<double>(done) / static_cast<double>(variants));
        }
    };
    // A failure of one ends the others after their batches.
    const auto guarded = [&] {
        try {
            work();
        } catch (...) {
            next = open.size();
            throw;
        }
    };
    compare::run_jobs(std::vector<compare::Job>(static_cast<std::size_t>(threads),
                                                compare::Job{"variants", guarded}),
                      threads, {});
    return {variants, seconds()};
}

}  // namespace elastocheck::reports
