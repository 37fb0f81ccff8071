#include "reports/study/ranks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>

#include "reports/files/files.hpp"
#include "reports/study/optional_component.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;

// A batch takes a hundred times as long; a waiting call of MPI would keep a core busy.
constexpr std::chrono::microseconds between_looks{500};
constexpr std::chrono::seconds patience{10};

// As mpirun of Open MPI says it; 1 without.
int processes() {
    const char* const text = std::getenv("OMPI_COMM_WORLD_SIZE");
    int count = 1;
    if (text != nullptr) std::from_chars(text, text + std::string_view(text).size(), count);
    return count;
}

bool is_lock_of_rank(const fs::path& file) {
    const std::string name = file.filename().string();
    return name.starts_with("ledger-rank-") && name.ends_with(".sqlite.lock");
}

}  // namespace

std::optional<Ranks> Ranks::join() {
    if (processes() < 2) return std::nullopt;
    Ranks ranks;
    ranks.mpi_ = &optional_component<Functions>(
        module_file, module_symbol,
        fmt::format("mpirun has started {} processes, and this program has no MPI, an optional "
                    "component",
                    processes()),
        "install the package elastocheck-mpi, or libopenmpi-dev and build again; without MPI, "
        "--shard K/N computes a part");
    ranks.mpi_->begin(&ranks.rank_, &ranks.size_);
    return ranks;
}

Ranks::Message Ranks::await(int* from) const {
    Message message;
    while (!mpi_->receive(from, &message)) std::this_thread::sleep_for(between_looks);
    return message;
}

void Ranks::serve(OpenRanges& open) {
    for (int other = 1; other < size_; ++other) mpi_->send(other, {Message::begin});
    variants_.assign(static_cast<std::size_t>(size_), 0);
    serving_ =
        std::jthread([&open, mpi = mpi_, &variants = variants_](const std::stop_token& stop) {
            std::size_t working = variants.size() - 1;
            while (working > 0 && !stop.stop_requested()) {
                int from = 0;
                Message message;
                if (!mpi->receive(&from, &message)) {
                    std::this_thread::sleep_for(between_looks);
                } else if (message.kind == Message::done) {
                    variants[static_cast<std::size_t>(from)] = message.a;
                    --working;
                } else if (const auto range = open.next(message.a)) {
                    mpi->send(from, {Message::range, range->first, range->end});
                } else {
                    mpi->send(from, {Message::nothing});
                }
            }
        });
}

std::vector<std::uint64_t> Ranks::wait() {
    serving_.join();
    mpi_->end();
    return variants_;
}

void Ranks::wait_for_first() const {
    int from = 0;
    await(&from);
}

std::optional<Range> Ranks::next(std::uint64_t finished) const {
    mpi_->send(0, {Message::request, finished});
    int from = 0;
    const Message answer = await(&from);
    return answer.kind == Message::range ? std::optional(Range{answer.a, answer.b}) : std::nullopt;
}

void Ranks::done(std::uint64_t variants) const {
    mpi_->send(0, {Message::done, variants});
    mpi_->end();
}

fs::path ledger_of_rank(const fs::path& folder, int rank) {
    return folder / fmt::format("ledger-rank-{}.sqlite", rank);
}

void gather(const StudyFile& file, Ledger& ledger, const fs::path& folder) {
    // By their locks: a rank that is killed may have created no more than that.
    std::vector<fs::path> locks;
    for (const auto& entry : fs::directory_iterator(folder))
        if (is_lock_of_rank(entry.path())) locks.push_back(entry.path());
    std::ranges::sort(locks);
    for (const fs::path& lock_file : locks) {
        fs::path of_rank = lock_file;
        of_rank.replace_extension();
        {
            const LedgerLock lock(of_rank, patience);
            // Completes one that was being created, and undoes an open transaction.
            Ledger(of_rank, file.identity, file.study.figures, Ledger::Access::write);
            ledger.merge(of_rank);
            fs::remove(of_rank);
        }
        fs::remove(lock_file);
    }
}

}  // namespace elastocheck::reports
