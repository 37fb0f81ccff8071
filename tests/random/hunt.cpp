// Property-based stress test: random scenes solved by every leg and method.
//
//   hunt --count 20000 --seed 1 --workers 2 --found DIR
//
// `--family driven` selects scenes whose branches drive lengths and jacks. Each worker is a
// process, so that a crash or a time-out is reported with its seed and the run continues. Exit code
// 1 if any result is wrong, or a scene crashes or times out.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "compare/stress/stress.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/support/random_scenes.hpp"

namespace {

using namespace elastocheck;

compare::Family family = compare::Family::any;  // of all scenes of the run

double cpu_seconds() {
    rusage used{};
    ::getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

// ---- Child process: writes one line per result to the pipe.

std::string line(std::uint64_t seed, const std::string& solver, const std::string& verdict,
                 const std::string& outcome, const std::string& why) {
    return fmt::format("{}\t{}\t{}\t{}\t{}\n", seed, solver, verdict, outcome, why);
}

std::string judged(std::uint64_t seed, const Scene& scene) {
    std::string lines;
    const compare::Trial trial{
        fmt::format("{}", seed), "random", {.label = "as it is", .scene = scene}};
    for (const auto& cell : compare::stress({&trial, 1}, 1).cells)
        lines +=
            line(seed, cell.solver, compare::name(cell.verdict), elastocheck::name(cell.outcome),
                 fmt::format("{}: {}{}{}", cell.side, cell.why, cell.why.empty() ? "" : "; ",
                             cell.detail));
    return lines;
}

std::string judged(std::uint64_t seed) {
    try {
        return judged(seed, parse_scene(compare::random_scene(seed, family), "random.yaml"));
    } catch (const SceneError& error) {
        return line(seed, "reader", "refused", "", error.what());
    } catch (const std::exception& error) {
        return line(seed, "a leg", "thrown", "", error.what());
    }
}

[[noreturn]] void work(std::uint64_t from, std::uint64_t end, std::uint64_t stride, int limit,
                       int out) {
    for (std::uint64_t seed = from; seed < end; seed += stride) {
        const double start = cpu_seconds();
        const auto until = static_cast<rlim_t>(start + limit);
        const rlimit cpu{until, RLIM_INFINITY};
        ::setrlimit(RLIMIT_CPU, &cpu);
        std::string text = judged(seed);
        text += line(seed, "", "done", fmt::format("{:.3f}", cpu_seconds() - start), "");
        if (::write(out, text.data(), text.size()) != static_cast<ssize_t>(text.size()))
            std::_Exit(4);
    }
    std::_Exit(0);
}

// ---- Parent process.

struct Tally {
    // by solver; then by verdict, or by outcome for a failure that was reported as such
    std::map<std::string, std::map<std::string, int>> table;
    std::vector<std::string> wrong;  // one message each
    double seconds = 0, slowest = 0;
    std::uint64_t slowest_seed = 0;
    std::ofstream log;
    std::string found;  // folder for the scenes that failed

    void fail(std::uint64_t seed, const std::string& what) {
        wrong.push_back(what);
        fmt::print("{}\n", what);
        std::fflush(stdout);
        if (!found.empty())
            std::ofstream(fmt::format("{}/seed-{}.yaml", found, seed))
                << "# " << what << "\n"
                << compare::random_scene(seed, family);
    }
    void take(const std::array<std::string, 5>& told) {
        const auto& [seed, solver, verdict, outcome, why] = told;
        if (log.is_open()) log << fmt::format("{}\n", fmt::join(told, "\t"));
        if (verdict == "done") {
            const double took = std::stod(outcome);
            seconds += took;
            if (took > slowest) slowest = took, slowest_seed = std::stoull(seed);
            return;
        }
        ++table[solver][verdict == "reported failure" ? outcome : verdict];

        if (verdict == "wrong" || verdict == "thrown")
            fail(std::stoull(seed), fmt::format("seed {}: {}: {} {}", seed, solver, verdict, why));
    }
};

// One worker process and its seeds; after a crash it is restarted at the next seed.
struct Worker {
    std::uint64_t next = 0, end = 0, stride = 1;
    int limit = 0;
    pid_t child = 0;
    std::FILE* in = nullptr;

    void start() {
        int ends[2];
        if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
        std::fflush(stdout);
        child = ::fork();
        if (child < 0) throw std::runtime_error("no process");
        if (child == 0) {
            ::close(ends[0]);
            work(next, end, stride, limit, ends[1]);
        }
        ::close(ends[1]);
        in = ::fdopen(ends[0], "r");
    }
    // Reads the worker's results for its next seed; false if no seed is left.
    bool step(Tally& tally) {
        char* text = nullptr;
        std::size_t size = 0;
        while (::getline(&text, &size, in) > 0) {
            std::istringstream split(
                std::string(text, std::string(text).find_last_not_of('\n') + 1));
            std::array<std::string, 5> told;
            for (auto& field : told) std::getline(split, field, '\t');
            tally.take(told);
            if (told[2] != "done") continue;
            next += stride;
            std::free(text);
            return true;
        }
        std::free(text);
        std::fclose(in);
        int status = 0;
        ::waitpid(child, &status, 0);
        if (next >= end) return false;
        const bool too_slow = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
        const std::string what = too_slow ? "too slow" : "crash";
        ++tally.table["all"][what];
        tally.fail(next, fmt::format("seed {}: {} (status {})", next, what, status));
        next += stride;
        if (next >= end) return false;
        start();
        return true;
    }
};

}  // namespace

int main(int argc, char** argv) {
    std::uint64_t first = 1, count = 1000, workers = 2;
    int limit = 120;
    std::uint64_t print = 0;
    std::string scene, log;
    Tally tally;
    CLI::App app{"Random scenes by every leg and method: right, a reported failure, or wrong"};
    app.add_option("--seed", first, "the first");
    app.add_option("--count", count, "how many");
    app.add_option("--workers", workers, "processes")->check(CLI::Range(1, 64));
    app.add_option("--limit", limit, "CPU seconds that a scene may take");
    app.add_option("--found", tally.found, "folder for the scenes that fail");
    app.add_option("--log", log, "file for every answer, one a line");
    app.add_option("--family", family, "any, or driven: lengths and jacks on elastic freedom")
        ->transform(CLI::CheckedTransformer(std::map<std::string, compare::Family>{
            {"any", compare::Family::any}, {"driven", compare::Family::driven}}));
    app.add_option("--print", print, "only prints the scene of this seed");
    app.add_option("--scene", scene, "only this file");
    CLI11_PARSE(app, argc, argv);
    if (print > 0) {
        fmt::print("{}", compare::random_scene(print, family));
        return 0;
    }
    if (!scene.empty()) {
        const std::string lines = judged(0, read_scene(scene));
        fmt::print("{}", lines);
        return lines.find("\twrong\t") != lines.npos;
    }
    if (!tally.found.empty()) std::filesystem::create_directories(tally.found);
    if (!log.empty()) tally.log.open(log);
    std::vector<Worker> all;
    for (std::uint64_t k = 0; k < workers; ++k) {
        all.push_back({first + k, first + count, workers, limit});
        if (all.back().next < all.back().end)
            all.back().start();
        else
            all.pop_back();
    }
    while (!all.empty()) std::erase_if(all, [&](Worker& worker) { return !worker.step(tally); });
    for (const auto& [solver, verdicts] : tally.table) {
        fmt::print("{:12}", solver);
        for (const auto& [verdict, number] : verdicts) fmt::print("  {} {}", number, verdict);
        fmt::print("\n");
    }
    fmt::print(
        "{} scenes, {:.0f} s of CPU; the slowest, seed {}, {:.1f} s; {} "
        "wrong\n",
        count, tally.seconds, tally.slowest_seed, tally.slowest, tally.wrong.size());
    return tally.wrong.empty() ? 0 : 1;
}
