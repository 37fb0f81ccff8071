// `elastocheck study`: many variants of a scene, and the statistics of their figures.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "reports/command/delivery.hpp"
#include "reports/command/options/running.hpp"
#include "reports/command/program/command.hpp"
#include "reports/files/files.hpp"
#include "reports/files/terminal.hpp"
#include "reports/study/output/study_output.hpp"
#include "reports/study/output/study_page.hpp"
#include "reports/study/run_study.hpp"

namespace elastocheck::reports {
namespace {

struct StudyRequest {
    std::string file, folder, shard, csv;
    std::vector<std::string> merge;
    int count = 0;
    bool show = false, as_json = false;
    Running running;
};

constexpr FileKind statistics_file{"statistics of a study", R"({"schema":"elastocheck/study/)"};

Shard parse_shard(const std::string& word) {
    Shard shard;
    if (word.empty()) return shard;
    const char *at = word.data(), *end = at + word.size();
    const auto first = std::from_chars(at, end, shard.at);
    const bool has_slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
    const auto second = has_slash ? std::from_chars(first.ptr + 1, end, shard.of) : first;
    if (!has_slash || second.ec != std::errc() || second.ptr != end || shard.at < 1 ||
        shard.at > shard.of || shard.of > 1'000'000)
        throw std::invalid_argument(
            fmt::format("--shard '{}': allowed: K/N, such as 2/8, K from 1 to N", word));
    return shard;
}

// Variants of the shard that have no row.
std::uint64_t missing(const Ledger& ledger, std::uint64_t count, const Shard& shard,
                      std::vector<std::string>& ranges) {
    std::uint64_t all = 0;
    const auto rows = ledger.rows_by_batch(batch_size, count);
    for (std::uint64_t b = shard.at - 1; b < rows.size(); b += shard.of) {
        const std::uint64_t first = b * batch_size, end = std::min(first + batch_size, count);
        if (rows[b] == end - first) continue;
        all += end - first - rows[b];
        if (ranges.size() < 10)
            ranges.push_back(fmt::format("{} of {} to {}", end - first - rows[b], first, end - 1));
        else if (ranges.size() == 10)
            ranges.emplace_back("...");
    }
    return all;
}

StudyFile read(const StudyRequest& request) {
    return read_study(request.file, request.count > 0
                                        ? std::optional(static_cast<std::uint64_t>(request.count))
                                        : std::nullopt);
}

// Those of all shards in a folder.
std::vector<std::string> ledgers_in(const std::string& folder) {
    std::vector<std::string> files;
    std::error_code failed;
    for (auto at = std::filesystem::directory_iterator(folder, failed);
         !failed && at != std::filesystem::end(at); at.increment(failed))
        if (const std::string name = at->path().filename().string();
            name.starts_with("ledger-") && name.ends_with(".sqlite"))
            files.push_back(at->path().string());
    if (failed) throw FileError(folder + ": " + failed.message());
    if (files.empty())
        throw FileError(folder + ": no ledger of a shard, ledger-K-of-N.sqlite, in it");
    std::ranges::sort(files);
    return files;
}

void compute(const StudyRequest& request, const StudyFile& file, Ledger& ledger,
             const Shard& shard) {
    const auto start = std::chrono::steady_clock::now();
    OpenRanges open(ledger, file.study.design.count, shard, progress);
    if (open.variants() == 0) return;
    run_study(file, ledger, open, threads_of(request.running));
    progress("");
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    print_error("{} variants computed in {:.1f} s, {:.0f} per second\n", open.variants(), seconds,
                static_cast<double>(open.variants()) / seconds);
}

// Exit code 0: every variant has a row; 3: some have none, none is solved, or witnesses disagree.
int study(const StudyRequest& request, const Delivery& delivery) {
    const Shard shard = parse_shard(request.shard);
    if (request.show && (!request.merge.empty() || !request.shard.empty()))
        throw std::invalid_argument("--show computes nothing: not with --merge or --shard");
    if (!request.shard.empty() && !request.merge.empty())
        throw std::invalid_argument("--merge is for the whole study: not with --shard");
    const StudyFile file = read(request);
    for (const auto& warning : file.warnings) print_error("{} (warning)\n", warning);
    const std::filesystem::path folder = request.folder;
    const auto ledger_file = folder / (request.shard.empty() ? std::string("ledger.sqlite")
                                                             : fmt::format("ledger-{}-of-{}.sqlite",
                                                                           shard.at, shard.of));
    const auto statistics_json = folder / "statistics.json";
    if (!request.show) {
        std::filesystem::create_directories(folder);
        if (request.shard.empty()) check_may_write(statistics_json, statistics_file);
    }
    std::optional<LedgerLock> lock;
    if (!request.show) lock.emplace(ledger_file);
    Ledger ledger(ledger_file, file.identity, file.study.figures,
                  request.show ? Ledger::Access::read : Ledger::Access::write);
    for (const std::string& shards : request.merge)
        for (const std::string& other : ledgers_in(shards))
            ledger.merge({other, file.identity, file.study.figures, Ledger::Access::merge});
    if (!request.show && request.merge.empty()) compute(request, file, ledger, shard);
    std::vector<std::string> ranges;
    const std::uint64_t open = missing(ledger, file.study.design.count, shard, ranges);
    if (open > 0) print_error("{} variants are missing: {}\n", open, fmt::join(ranges, ", "));
    if (!request.csv.empty()) {
        write_study_csv(file, ledger, request.csv);
        print_error("Written: {}\n", request.csv);
    }
    if (!request.shard.empty()) {
        delivery.print_text(fmt::format("Shard {}/{}: {} variants in {}\n", shard.at, shard.of,
                                        ledger.summary(file.study.design.count).rows,
                                        ledger_file.string()));
        return open > 0 ? could_not_judge : fine;
    }
    const StudyResult result = evaluate_study(file, ledger);
    auto document = document_head(study_schema, delivery.command);
    document.update(study_json(file, result));
    if (!request.show) {
        write_whole(statistics_json, document.dump(1) + "\n", statistics_file);
        const auto page = folder / "study.html";
        write_study_page(file, result, ledger, delivery.command, page);
        print_error("Written: {}, {}\n", statistics_json.string(), page.string());
    }
    delivery.print_text(study_text(file, result));
    if (delivery.as_json) print_document(document);
    for (const std::string& sentence : result.disagreements) print_error("{}\n", sentence);
    const bool nothing_solved = result.summary.by_outcome.front() == 0;
    return open > 0 || nothing_solved || !result.disagreements.empty() ? could_not_judge : fine;
}

}  // namespace

const Command study_command{
    Group::change, "study",
    "Many variants of a scene, each with a row in a ledger, and the statistics of their "
    "figures; the same command goes on where it was interrupted",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<StudyRequest>();
        as_file(
            command.add_option("STUDY", request->file, "file with variables, design and figures"))
            ->required();
        as_folder(command.add_option(
                      "-o,--output", request->folder,
                      "folder of the ledger (ledger.sqlite), statistics.json and study.html"))
            ->required();
        command
            .add_option("--count", request->count,
                        "number of variants, instead of that in the file; more than before "
                        "extends the study")
            ->check(CLI::Range(1, 1'000'000'000));
        command
            .add_option("--shard", request->shard, "compute part K of N, into ledger-K-of-N.sqlite")
            ->type_name("K/N");
        as_folder(
            command.add_option("--merge", request->merge,
                               "add the rows of all shards in these folders, and compute nothing"));
        command.add_flag("--show", request->show,
                         "compute nothing, write nothing: show what there is");
        as_file(command.add_option("--csv", request->csv,
                                   "write variables and figures of all variants as CSV"));
        add_running(command, request->running);
        add_json(command, request->as_json);
        return [request](const std::string& line) {
            return study(*request, {.as_json = request->as_json, .command = line});
        };
    }};

}  // namespace elastocheck::reports
