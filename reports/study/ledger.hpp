// Ledger of a study: one row for every variant that was computed, in a file of SQLite that the
// program `sqlite3` reads.
//
//   variants   k, outcome, method, reason, f1, f2, ..., checksum   a figure without a value is NULL
//   witnesses  the same by the reference, of every so many variants
//   results    a view of `variants` with the names of outcomes and figures
//   meta, figures, outcomes, methods   what the study is, and what the numbers mean
//
// Rows are added in transactions, so that a process that is killed leaves a ledger without the rows
// of its open transaction. A row whose checksum is not that of its content is an error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "compare/variants/solve_variants.hpp"
#include "compare/variants/study.hpp"

namespace elastocheck::reports {

struct StudyIdentity {
    std::string scene, study;  // hashes
    std::string version;       // of the program, with its commit
};

struct LedgerRow {
    std::uint64_t k = 0;
    compare::variants::VariantFigures figures;
    std::vector<compare::variants::VariantFigures> witness = {};  // none or one
};

struct LedgerSummary {
    std::uint64_t rows = 0, by_equilibrium = 0;
    std::vector<std::uint64_t> by_outcome;  // per VariantOutcome
};

// Differences between witnesses and variants, per figure.
struct WitnessDifference {
    std::uint64_t count = 0;      // of variants in which both have a finite value
    std::uint64_t one_sided = 0;  // only one of them has one
    double largest = 0;           // absolute difference
    std::uint64_t at = 0;         // its variant
};

class Ledger {
  public:
    enum class Access { write, merge, read };
    // Opens or, to write, creates it. Throws FileError for a file that is no ledger, a ledger of
    // another scene, study or, but to read, version of the program (what differs is named), and what
    // SQLite reports. Checks every row.
    Ledger(const std::filesystem::path& file, const StudyIdentity& identity,
           const std::vector<compare::variants::StudyFigure>& figures, Access access);
    ~Ledger();
    Ledger(const Ledger&) = delete;
    Ledger& operator=(const Ledger&) = delete;

    const std::filesystem::path& file() const;

    // In one transaction.
    void add(std::span<const LedgerRow> rows);
    // Rows of another ledger of this study that are not here yet. Throws FileError, also for a row
    // that both have with different content.
    void merge(const Ledger& other);

    // Numbers of rows by k / size, of k below `count`; the variants of the range that have a row.
    std::vector<std::uint64_t> rows_by_batch(std::uint64_t size, std::uint64_t count) const;
    std::set<std::uint64_t> rows_in(std::uint64_t first, std::uint64_t end) const;

    LedgerSummary summary(std::uint64_t count) const;
    // Of one figure, by variant; NaN where there is none.
    std::vector<double> values(std::size_t figure, std::uint64_t count) const;
    std::vector<WitnessDifference> witnesses(std::uint64_t count) const;
    // First failed variants, in their order.
    std::vector<LedgerRow> failed(std::uint64_t count, std::size_t most) const;
    // In their order.
    void each_row(std::uint64_t count, const std::function<void(const LedgerRow&)>& visit) const;
    // Of all rows and witnesses of variants below `count`: equal for equal content.
    std::string content_hash(std::uint64_t count) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Excludes other processes that would write the same ledger, for its lifetime. Throws FileError
// where there is one.
class LedgerLock {
  public:
    explicit LedgerLock(const std::filesystem::path& ledger);
    ~LedgerLock();
    LedgerLock(const LedgerLock&) = delete;
    LedgerLock& operator=(const LedgerLock&) = delete;

  private:
    int file_ = -1;
};

}  // namespace elastocheck::reports
