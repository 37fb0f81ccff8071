// Mutation tests: puts one fault at a time into the sources of this checkout, builds the suite that
// should fail on it, takes the fault out again and runs the suite beside the build of the next one.
//
//   mutate run ROOT BUILD [--again] [FAULT...]   faults without a current result, or those named;
//                                                --again: all that were not run at this commit
//   mutate check ROOT BUILD                      is every fault in its place, with a current result?
//   mutate list ROOT                             the faults, their files and suites
//
// Results go to tests/mutation/results.json after each fault: a run that was interrupted goes on
// where it stopped. Exit code 1: a fault survived, does not compile, or has no current result.
#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <future>
#include <map>
#include <mutex>
#include <regex>
#include <stdexcept>
#include <thread>

#include "tests/mutation/faults.hpp"

namespace fs = std::filesystem;
using namespace elastocheck::mutation;
using nlohmann::ordered_json;

namespace {

struct Paths {
    std::string root, build;
    std::string faults() const { return root + "/tests/mutation/faults.txt"; }
    std::string results() const { return root + "/tests/mutation/results.json"; }
    std::string work() const { return build + "/../mutation"; }
    std::string sound() const { return work() + "/sound"; }  // the build without a fault
    std::string stamp() const {
        return work() + "/stamp";
    }  // older than what a fault's build wrote
    std::string seeded() const { return work() + "/seeded.json"; }  // what is in the checkout now
};

// ---- Results.

ordered_json read_results(const Paths& paths) {
    return fs::exists(paths.results()) ? ordered_json::parse(read_file(paths.results()))
                                       : ordered_json::array();
}

// One line a fault, in the order of faults.txt; results of no fault are dropped.
void write_results(const Paths& paths, const std::vector<Fault>& faults,
                   const ordered_json& results) {
    std::string text;
    for (const Fault& fault : faults)
        for (const auto& result : results)
            if (result.at("fault") == fault.name)
                text += (text.empty() ? "[\n " : ",\n ") + result.dump();
    write_file(paths.results() + ".new", text.empty() ? "[]\n" : text + "\n]\n");
    fs::rename(paths.results() + ".new", paths.results());
}

void record(ordered_json& results, const ordered_json& result) {
    for (auto& known : results)
        if (known.at("fault") == result.at("fault")) {
            known = result;
            return;
        }
    results.push_back(result);
}

std::string output_of(const std::string& command) {
    std::string text;
    FILE* pipe = ::popen(command.c_str(), "r");
    if (!pipe) return text;
    for (char c; std::fread(&c, 1, 1, pipe) == 1;) text += c;
    ::pclose(pipe);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
}

std::string head(const Paths& paths) {
    return output_of("git -C '" + paths.root + "' rev-parse --short HEAD 2>/dev/null");
}

// Of the sources as they are: "6df94b7", and "+" where they differ from it.
std::string commit(const Paths& paths) {
    const std::string git = "git -C '" + paths.root + "' ";
    return head(paths) +
           (output_of(git + "status --porcelain -- . ':!tests/mutation' 2>/dev/null").empty()
                ? ""
                : "+");
}

// What ctest lists.
std::vector<std::string> built_suites(const Paths& paths) {
    std::vector<std::string> suites;
    const std::regex entry(R"(add_test\(\[=+\[([^\]]+)\])");
    for (const auto& file : fs::recursive_directory_iterator(paths.build + "/tests")) {
        const std::string name = file.path().filename().string();
        if (!name.ends_with("_suites.cmake") && name != "CTestTestfile.cmake") continue;
        const std::string text = read_file(file.path().string());
        for (std::sregex_iterator i(text.begin(), text.end(), entry), none; i != none; ++i)
            suites.push_back((*i)[1]);
    }
    return suites;
}

// ---- A fault in the checkout. What it replaced is on disk first, so that the next run puts back
// what a killed one left. A file that was edited since is left alone.

void put_back(const Paths& paths) {
    if (!fs::exists(paths.seeded())) return;
    const ordered_json changes = ordered_json::parse(read_file(paths.seeded()));
    for (const auto& [file, texts] : changes.items()) {
        const std::string now = read_file(file);
        if (now == texts.at("seeded"))
            write_file(file, texts.at("sound").get<std::string>());
        else if (now != texts.at("sound"))
            throw std::runtime_error(fmt::format(
                "{}: was edited while a fault was in it; take the fault out, then remove {}", file,
                paths.seeded()));
    }
    fs::remove(paths.seeded());
}

// Returns when the files that it changed were written last.
std::map<std::string, fs::file_time_type> seed(const Paths& paths, const Fault& fault) {
    std::map<std::string, fs::file_time_type> times;
    ordered_json changes;
    std::vector<std::pair<Place, std::string>> edits;
    for (const Edit& edit : fault.edits) edits.emplace_back(locate(paths.root, edit), edit.make);
    // From the end, so that places in one file stay where they were found.
    std::ranges::sort(edits, std::greater<>{},
                      [](const auto& edit) { return edit.first.expression.begin; });
    for (const auto& [place, make] : edits) {
        auto& change = changes[place.file];
        if (change.is_null()) change["sound"] = change["seeded"] = read_file(place.file);
        std::string text = change["seeded"];
        const Range& at = place.expression;
        text.replace(at.begin, at.end - at.begin, make);
        change["seeded"] = text;
    }
    write_file(paths.seeded(), changes.dump());
    for (const auto& [file, texts] : changes.items()) {
        times[file] = fs::last_write_time(file);
        write_file(file, texts.at("seeded").get<std::string>());
    }
    return times;
}

// ---- Building and running.

// The exit code; throws where the command was interrupted.
int run(const std::string& command) {
    const int status = std::system(command.c_str());
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    if (code >= 128) throw std::runtime_error("interrupted");
    return code;
}

// The test that failed first, how many did, and measured over allowed where the first says both.
struct Rang {
    std::string first, margin;
    int tests = 0;
};

Rang rang(const std::string& log, int code) {
    Rang result;
    std::smatch found;
    static const std::regex failed(R"(\[  FAILED  \] ([^ ,]+),?.* \(\d+ ms\))");
    for (std::sregex_iterator i(log.begin(), log.end(), failed), none; i != none; ++i) {
        if (result.tests++ == 0) result.first = (*i)[1];
    }
    if (code == 124) result.first = "takes longer than 600 s";
    if (result.first.empty() && code != 0) result.first = "ends with a crash";
    static const std::regex compared(R"(actual: ([-+0-9.e]+) vs ([-+0-9.e]+))");
    if (std::regex_search(log, found, compared)) {
        const double measured = std::strtod(found[1].str().c_str(), nullptr);
        const double allowed = std::strtod(found[2].str().c_str(), nullptr);
        if (allowed > 0 && measured > allowed)
            result.margin = fmt::format("{:.2g}", measured / allowed);
    }
    return result;
}

// One fault, from its seeding to its record.
struct Trial {
    Fault fault;
    std::string file, stamp;  // below the root
    std::string folder;       // for its logs
    std::chrono::steady_clock::time_point begin;

    std::string program() const { return "test_" + fault.suite.substr(0, fault.suite.find('.')); }
    std::string filter() const { return fault.suite.substr(fault.suite.find('.') + 1) + ".*"; }
};

bool builds(const Paths& paths, const Trial& trial) {
    const std::string& target = trial.fault.target.empty() ? trial.program() : trial.fault.target;
    const std::string log = trial.folder + "/build.log";
    const int code =
        run(fmt::format("cmake --build '{}' --target '{}' >'{}' 2>&1", paths.build, target, log));
    if (code != 0 && read_file(log).find("interrupted by user") != std::string::npos)
        throw std::runtime_error("interrupted");
    return code == 0;
}

// A copy of the test program as it was built, so that the next build may go on beside it.
std::string copy_of_program(const Paths& paths, const Trial& trial) {
    const std::string copy = trial.folder + "/" + trial.program();
    fs::copy_file(output_of("find '" + paths.build + "/tests' -type f -name " + trial.program()),
                  copy, fs::copy_options::overwrite_existing);
    return copy;
}

// The build is copied before the first fault, and what a fault's build wrote is replaced by the
// copies after it, times included: no fault waits for the repair of what another one changed.
void copy_build(const Paths& paths, const std::vector<Trial>& trials) {
    std::string targets;
    for (const Trial& trial : trials) {
        const std::string& target = trial.fault.target;
        targets += " '" + (target.empty() ? trial.program() : target) + "'";
    }
    fmt::print("mutate: building the suites of {} faults\n", trials.size());
    std::fflush(stdout);
    if (run(fmt::format("cmake --build '{}' --target{} >'{}/build.log' 2>&1", paths.build, targets,
                        paths.work())) != 0)
        throw std::runtime_error("the suites do not build without a fault: " + paths.work() +
                                 "/build.log");
    run(fmt::format("rm -rf '{0}' && cp -a '{1}' '{0}'", paths.sound(), paths.build));
}

void restore_build(const Paths& paths) {
    run(
        fmt::format("cd '{}' && find . -type f -newer '{}' | while read -r file; do "
                    "cp -p '{}'/\"$file\" \"$file\" 2>/dev/null || rm -f \"$file\"; done",
                    paths.build, paths.stamp(), paths.sound()));
}

Rang run_program(const Trial& trial, const std::string& program, const std::string& filter) {
    const std::string log = trial.folder + "/test.log";
    const int code = run(fmt::format(
        "timeout 600 '{}' '--gtest_filter={}' --gtest_brief=1 >'{}' 2>&1", program, filter, log));
    return rang(read_file(log), code);
}

// Where the suite does not fail, which other one of its program does is printed.
Rang run_suite(const Trial& trial, const std::string& program) {
    const Rang found = run_program(trial, program, trial.filter());
    if (found.first.empty())
        fmt::print("mutate: {} survives {}; of its program fails: {}\n", trial.fault.name,
                   trial.fault.suite, run_program(trial, program, "*").first);
    return found;
}

Rang run_ctest(const Paths& paths, const Trial& trial) {
    const int code =
        run(fmt::format("ctest --test-dir '{}' -R '^{}$' --no-tests=error >'{}/test.log' 2>&1",
                        paths.build, trial.fault.suite, trial.folder));
    return code == 0 ? Rang{} : Rang{.first = trial.fault.suite, .margin = {}, .tests = 1};
}

int run_faults(const Paths& paths, const std::vector<Fault>& all,
               const std::vector<Fault>& chosen) {
    fs::create_directories(paths.work());
    put_back(paths);
    ordered_json results = read_results(paths);
    const std::string at = commit(paths);
    std::vector<Trial> trials;
    for (const Fault& fault : chosen)
        trials.push_back({fault,
                          fs::relative(locate(paths.root, fault.edits.front()).file, paths.root),
                          stamp(paths.root, fault),
                          paths.work() + "/" + fault.name,
                          {}});
    if (trials.empty()) return 0;
    copy_build(paths, trials);

    std::mutex mutex;
    std::size_t done = 0, bad = 0;
    const auto finish = [&](const Trial& trial, const Rang& found) {
        const std::lock_guard lock(mutex);
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - trial.begin;
        bad += found.first.empty();
        fmt::print("mutate: {} of {}: {}: {} ({:.0f} s)\n", ++done, trials.size(), trial.fault.name,
                   found.first.empty() ? "SURVIVED" : found.first, passed.count());
        std::fflush(stdout);
        record(results, {{"fault", trial.fault.name},
                         {"in", trial.file},
                         {"simulates", trial.fault.is},
                         {"first", found.first},
                         {"margin", found.margin},
                         {"alarms", found.tests},
                         {"suite", trial.fault.suite},
                         {"commit", at},
                         {"stamp", trial.stamp}});
        write_results(paths, all, results);
    };
    std::vector<std::future<void>> running;
    fmt::print("mutate: the sources hold faults until this ends: neither edit nor commit\n");
    std::fflush(stdout);
    const std::string head_before = head(paths);
    for (Trial& trial : trials) {
        if (head(paths) != head_before)
            throw std::runtime_error(
                "a commit was made while a fault was in the sources; it may "
                "contain the fault");
        trial.begin = std::chrono::steady_clock::now();
        fs::create_directories(trial.folder);
        write_file(paths.stamp(), "");
        const auto times = seed(paths, trial.fault);
        const bool is_built = builds(paths, trial);
        // What is run while the fault is in the build: ctest, and suites that run the command.
        std::string program;
        if (is_built && trial.fault.target.empty()) program = copy_of_program(paths, trial);
        const bool runs_command =
            !program.empty() &&
            read_file(program).find(paths.build + "/reports/elastocheck") != std::string::npos;
        if (is_built && program.empty()) finish(trial, run_ctest(paths, trial));
        if (runs_command) {
            finish(trial, run_suite(trial, program));
            fs::remove(program);
        }
        // The build first: killed between the two, the next run makes the sources newer than it.
        restore_build(paths);
        put_back(paths);
        for (const auto& [file, time] : times) fs::last_write_time(file, time);
        if (!is_built) {
            const std::lock_guard lock(mutex);
            ++bad;
            fmt::print("mutate: {} of {}: {}: does not compile, see {}/build.log\n", ++done,
                       trials.size(), trial.fault.name, trial.folder);
            std::fflush(stdout);
        } else if (!program.empty() && !runs_command) {
            running.push_back(std::async(std::launch::async, [&finish, &trial, program] {
                finish(trial, run_suite(trial, program));
                fs::remove(program);
            }));
        }
        while (running.size() >= std::max(2U, std::thread::hardware_concurrency())) {
            running.front().get();
            running.erase(running.begin());
        }
    }
    for (auto& test : running) test.get();
    return bad == 0 ? 0 : 1;
}

int check(const Paths& paths, const std::vector<Fault>& faults) {
    auto found = problems(paths.root, faults, read_results(paths), built_suites(paths));
    if (fs::exists(paths.seeded())) found.push_back("a fault is still in the checkout");
    for (const auto& problem : found) fmt::print("{}\n", problem);
    fmt::print(
        "{} faults, {} problems, {} not run yet; ./dev mutate runs what has no current result\n",
        faults.size(), found.size(), never_run(faults, read_results(paths)));
    return found.empty() ? 0 : 1;
}

// Those named, those without a current result, or all that were not run at this commit.
std::vector<Fault> choose(const Paths& paths, const std::vector<Fault>& faults,
                          const std::vector<std::string>& names, bool again) {
    std::vector<Fault> chosen;
    for (const std::string& name : names) {
        const auto found = std::ranges::find(faults, name, &Fault::name);
        if (found == faults.end()) throw std::runtime_error(fmt::format("no fault '{}'", name));
        chosen.push_back(*found);
    }
    if (!names.empty()) return chosen;
    const ordered_json results = read_results(paths);
    const std::string at = commit(paths);
    for (const Fault& fault : faults) {
        const auto found = std::ranges::find_if(
            results, [&](const auto& result) { return result.at("fault") == fault.name; });
        const bool is_current = found != results.end() &&
                                found->at("stamp") == stamp(paths.root, fault) &&
                                found->at("suite") == fault.suite && found->at("first") != "" &&
                                (!again || found->at("commit") == at);
        if (!is_current) chosen.push_back(fault);
    }
    return chosen;
}

}  // namespace

int main(int count, char** words) {
    std::vector<std::string> arguments(words + 1, words + count);
    const std::string command = arguments.empty() ? "" : arguments.front();
    if ((command == "list" && count == 3) || (command == "check" && count == 4) ||
        (command == "run" && count >= 4))
        try {
            const Paths paths{arguments[1], command == "list" ? "" : arguments[2]};
            const auto faults = parse_faults(read_file(paths.faults()));
            if (command == "check") return check(paths, faults);
            if (command == "list") {
                for (const Fault& fault : faults)
                    fmt::print("{}\t{}\t{}\n", fault.name,
                               locate(paths.root, fault.edits.front()).file, fault.suite);
                return 0;
            }
            arguments.erase(arguments.begin(), arguments.begin() + 3);
            const bool again = std::erase(arguments, "--again") > 0;
            return run_faults(paths, faults, choose(paths, faults, arguments, again));
        } catch (const std::exception& e) {
            fmt::print(stderr, "mutate: {}\n", e.what());
            return 2;
        }
    fmt::print(stderr, "usage: mutate run|check ROOT BUILD [--again] [FAULT...]\n");
    return 2;
}
