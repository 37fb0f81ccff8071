// Computes the variants of a study that its ledger does not have.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "elastocheck/compare.hpp"
#include "reports/study/ledger.hpp"
#include "reports/study/study_file.hpp"

namespace elastocheck::reports {

// Variants that are drawn, solved and recorded together; the unit that shards divide.
inline constexpr std::uint64_t batch_size = 256;

struct Shard {
    std::uint64_t at = 1, of = 1;  // every `of`-th batch, from `at` - 1
};

struct Range {  // of variants, within a batch
    std::uint64_t first = 0, end = 0;
};

// Hands out the variants that a ledger does not have, batch after batch. Thread-safe.
class OpenRanges {
  public:
    OpenRanges(const Ledger& ledger, std::uint64_t count, const Shard& shard,
               compare::Progress progress);

    // The next one, none at the end. `finished` is the number of variants that the caller has
    // recorded since it called last, for the progress.
    std::optional<Range> next(std::uint64_t finished);
    std::uint64_t variants() const { return variants_; }  // of all

  private:
    std::vector<Range> ranges_ = {};
    std::uint64_t variants_ = 0, done_ = 0;
    std::size_t next_ = 0;
    compare::Progress progress_;
    std::int64_t start_ = 0;  // [ns]
    std::mutex handing_out_ = {};
};

// Solves and records ranges until there is none. Each is one transaction, and its rows do not depend
// on which others are computed where.
void run_study(const StudyFile& file, Ledger& ledger, OpenRanges& open, int threads);

}  // namespace elastocheck::reports
