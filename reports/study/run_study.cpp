#include "reports/study/run_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <set>
#include <utility>

#include "compare/jobs/jobs.hpp"
#include "compare/variants/sampler.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"
#include "reports/files/files.hpp"

namespace elastocheck::reports {
namespace {

using namespace compare::variants;
using Eigen::Index;

// The model with these values; without one, the reason.
std::optional<Model> model_of(const StudyFile& file, Variants& variants,
                              const Eigen::VectorXd& values, VariantFigures& figures) {
    try {
        const Scene scene = variants.scene(values);
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

std::vector<LedgerRow> solve_rows(const StudyFile& file, Variants& variants, const Sampler& sampler,
                                  const Range& range) {
    const Eigen::MatrixXd values = sampler.values(range.first, range.end - range.first);
    std::vector<LedgerRow> rows;
    std::vector<Model> models;
    std::vector<std::size_t> at;  // row of each model
    for (std::uint64_t k = range.first; k < range.end; ++k) {
        LedgerRow& row = rows.emplace_back(LedgerRow{.k = k, .figures = {}});
        auto model =
            model_of(file, variants, values.row(static_cast<Index>(k - range.first)), row.figures);
        if (file.study.witness > 0 && k % static_cast<std::uint64_t>(file.study.witness) == 0)
            row.witness.push_back(model ? file.solver.solve_alone(*model, compare::Leg::equilibrium)
                                        : row.figures);
        if (!model) continue;
        models.push_back(std::move(*model));
        at.push_back(rows.size() - 1);
    }
    auto solved = file.solver.solve(models);
    for (std::size_t m = 0; m < models.size(); ++m) rows[at[m]].figures = std::move(solved[m]);
    return rows;
}

std::int64_t nanoseconds() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

}  // namespace

OpenRanges::OpenRanges(const Ledger& ledger, std::uint64_t count, const Shard& shard,
                       compare::Progress progress)
    : progress_(std::move(progress)), start_(nanoseconds()) {
    const auto rows = ledger.rows_by_batch(batch_size, count);
    for (std::uint64_t b = shard.at - 1; b < rows.size(); b += shard.of) {
        const std::uint64_t first = b * batch_size, end = std::min(first + batch_size, count);
        if (rows[b] == end - first) continue;
        variants_ += end - first - rows[b];
        // A study that is extended has a part of its last batch.
        const std::set<std::uint64_t> present =
            rows[b] > 0 ? ledger.rows_in(first, end) : std::set<std::uint64_t>{};
        std::uint64_t from = first;
        for (const std::uint64_t k : present) {
            if (k > from) ranges_.push_back({from, k});
            from = k + 1;
        }
        if (from < end) ranges_.push_back({from, end});
    }
}

std::optional<Range> OpenRanges::next(std::uint64_t finished) {
    const std::scoped_lock guard(handing_out_);
    done_ += finished;
    if (finished > 0 && progress_)
        progress_(fmt::format("{} of {} variants, {:.0f} per second", done_, variants_,
                              static_cast<double>(done_) * 1e9 /
                                  static_cast<double>(nanoseconds() - start_)),
                  static_cast<double>(done_) / static_cast<double>(variants_));
    if (next_ == ranges_.size()) return std::nullopt;
    return ranges_[next_++];
}

void run_study(const StudyFile& file, Ledger& ledger, OpenRanges& open, int threads) {
    const Sampler sampler(file.study);
    std::atomic<bool> has_failed = false;
    std::mutex recording;
    const auto work = [&] {
        std::uint64_t finished = 0;
        Variants variants(file.parsed, file.study);
        while (!has_failed) {
            const auto range = open.next(finished);
            if (!range) return;
            const auto rows = solve_rows(file, variants, sampler, *range);
            {
                const std::scoped_lock guard(recording);
                ledger.add(rows);
            }
            finished = rows.size();
        }
    };
    // A failure of one ends the others after their batches.
    const auto guarded = [&] {
        try {
            work();
        } catch (...) {
            has_failed = true;
            throw;
        }
    };
    compare::run_jobs(std::vector<compare::Job>(static_cast<std::size_t>(threads),
                                                compare::Job{"variants", guarded}),
                      threads, {});
}

}  // namespace elastocheck::reports
