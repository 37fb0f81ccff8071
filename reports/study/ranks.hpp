// A study computed by the processes ("ranks") that mpirun has started.
//
// Rank 0 hands out ranges of variants, computes too, and writes the results; each rank records its
// rows in a ledger of its own. A process that fails ends without MPI_Finalize, whereupon mpirun ends
// the others, which lose at most the batches that they compute; the same command goes on.
//
// An optional component, the module elastocheck-mpi.so (ranks_module.cpp, where alone the header of
// MPI is included), which is loaded only below mpirun.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <thread>
#include <vector>

#include "reports/study/run_study.hpp"

namespace elastocheck::reports {

class Ranks {
  public:
    // None where mpirun has not started several processes. Throws std::invalid_argument where it has
    // and there is no module.
    static std::optional<Ranks> join();

    int rank() const { return rank_; }
    int size() const { return size_; }

    // Of rank 0: the others begin when it calls serve(), which answers their requests from `open`
    // until each has called done(); wait() returns then, with the number of variants of each rank.
    void serve(OpenRanges& open);
    std::vector<std::uint64_t> wait();

    // Of the others.
    void wait_for_first() const;
    std::optional<Range> next(std::uint64_t finished) const;
    // When all rows are recorded and the ledger is closed.
    void done(std::uint64_t variants) const;

    // What the module provides, by its only symbol.
    struct Message {
        enum Kind : std::uint64_t { begin, request, range, nothing, done } kind = begin;
        std::uint64_t a = 0, b = 0;
    };
    struct Functions {
        void (*begin)(int* rank, int* size);
        void (*send)(int to, const Message& message);
        // Whether there was one; `from` is the sender.
        bool (*receive)(int* from, Message* message);
        void (*end)();
    };
    static constexpr const char* module_file = "elastocheck-mpi.so";
    static constexpr const char* module_symbol = "elastocheck_mpi_functions";

  private:
    Ranks() = default;
    Message await(int* from) const;

    const Functions* mpi_ = nullptr;
    int rank_ = 0, size_ = 1;
    std::vector<std::uint64_t> variants_ = {};
    std::jthread serving_ = {};  // ends early where rank 0 fails
};

// "FOLDER/ledger-rank-3.sqlite"
std::filesystem::path ledger_of_rank(const std::filesystem::path& folder, int rank);

// Moves the rows of all ledgers of ranks in the folder, those of a run that was killed too, into
// `ledger`. Throws FileError, also where a process still writes to one of them after ten seconds.
void gather(const StudyFile& file, Ledger& ledger, const std::filesystem::path& folder);

}  // namespace elastocheck::reports
