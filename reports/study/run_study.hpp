// Computes the variants of a study that its ledger does not have.
#pragma once

#include <cstdint>

#include "elastocheck/compare.hpp"
#include "reports/study/ledger.hpp"
#include "reports/study/study_file.hpp"

namespace elastocheck::reports {

// Variants that are drawn, solved and recorded together; the unit that shards divide.
inline constexpr std::uint64_t batch_size = 256;

struct Shard {
    std::uint64_t at = 1, of = 1;  // every `of`-th batch, from `at` - 1
};

struct Computed {
    std::uint64_t variants = 0;  // by this run
    double seconds = 0;
};

// Each batch is one transaction. A batch is computed by one thread, and its rows do not depend on
// which others are.
Computed run_study(const StudyFile& file, Ledger& ledger, const Shard& shard, int threads,
                   const compare::Progress& progress);

}  // namespace elastocheck::reports
