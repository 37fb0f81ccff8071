// Computes the variants of a study that its ledger does not have.
#pragma once

#include <cstdint>
#include <functional>
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

// OpenRanges::next, of this process or of another one.
using NextRange = std::function<std::optional<Range>(std::uint64_t finished)>;

// Solves and records ranges until there is none. Each is one transaction, and its rows do not depend
// on which others are computed where. Returns the number of variants.
std::uint64_t run_study(const StudyFile& file, Ledger& ledger, const NextRange& next, int threads);

// Figures of variants with these values [variants × variables], which no ledger records.
std::vector<compare::variants::VariantFigures> solve_values(const StudyFile& file,
                                                            const Eigen::MatrixXd& values);

// Adds the version of this program to a ledger that another version has written, once up to 64 of
// its rows, evenly spread, have been computed again with the same result, bit for bit. Throws
// FileError where one differs. Returns how many were compared, 0 where the version is known.
std::size_t check_version(const StudyFile& file, Ledger& ledger);

}  // namespace elastocheck::reports
