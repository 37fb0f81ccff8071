// Mutation tests: puts one fault at a time into the sources of this checkout, builds the suite that
// should fail on it, runs it, and takes the fault out again.
//
//   mutate run ROOT BUILD [FAULT...]   all faults, or those named
//   mutate check ROOT                  is every fault in its place?
//
// Exit code 1: a fault survived, does not compile, or has not exactly one place.
#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <stdexcept>

#include "tests/mutation/faults.hpp"

using namespace elastocheck::mutation;

namespace {

// The fault is in the sources while this lives.
class Seeded {
  public:
    Seeded(const std::string& root, const Fault& fault) {
        std::vector<std::pair<Place, std::string>> edits;
        for (const Edit& edit : fault.edits) edits.emplace_back(locate(root, edit), edit.make);
        // From the end, so that places in one file stay where they were found.
        std::ranges::sort(edits, std::greater<>{},
                          [](const auto& edit) { return edit.first.expression.begin; });
        std::map<std::string, std::string> seeded;
        for (const auto& [place, make] : edits) {
            if (sound_.emplace(place.file, read_file(place.file)).second)
                seeded[place.file] = sound_[place.file];
            const Range& at = place.expression;
            seeded[place.file].replace(at.begin, at.end - at.begin, make);
        }
        for (const auto& [file, text] : seeded) write_file(file, text);
    }
    Seeded(const Seeded&) = delete;
    ~Seeded() {
        for (const auto& [file, text] : sound_) write_file(file, text);
    }

  private:
    std::map<std::string, std::string> sound_;  // texts without the fault, by file
};

// The exit code; throws where the command was interrupted.
int run(const std::string& command) {
    const int status = std::system(command.c_str());
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    if (code == 128 || code == 130) throw std::runtime_error("interrupted");
    return code;
}

// What became of a fault; empty: its suite failed on it.
std::string trial(const std::string& root, const std::string& build, const Fault& fault) {
    const std::string program = "test_" + fault.suite.substr(0, fault.suite.find('.'));
    const std::string log = fmt::format("{}/mutation-{}.log", build, fault.name);
    const Seeded seeded(root, fault);
    if (run(fmt::format("cmake --build '{}' --target '{}' >'{}' 2>&1", build,
                        fault.target.empty() ? program : fault.target, log)) != 0)
        return "does not compile: " + log;
    const int code = run(fmt::format(
        "timeout 900 ctest --test-dir '{}' -R '^{}$' --no-tests=error -C nightly >'{}' 2>&1", build,
        fault.suite, log));
    if (read_file(log).find("No tests were found") != std::string::npos)
        return "has no suite " + fault.suite;
    return code == 0 ? "SURVIVED " + fault.suite : "";
}

int run_faults(const std::string& root, const std::string& build,
               const std::vector<Fault>& faults) {
    fmt::print("mutate: the sources hold faults until this ends: neither edit nor commit\n");
    std::string bad;
    for (std::size_t i = 0; i < faults.size(); ++i) {
        const std::string result = trial(root, build, faults[i]);
        fmt::print("mutate: {} of {}: {}: {}\n", i + 1, faults.size(), faults[i].name,
                   result.empty() ? "found" : result);
        std::fflush(stdout);
        if (!result.empty()) bad += fmt::format("  {} {}\n", faults[i].name, result);
    }
    fmt::print("mutate: {}\n{}", bad.empty() ? "no fault survived" : "not found:", bad);
    return bad.empty() ? 0 : 1;
}

int check(const std::string& root, const std::vector<Fault>& faults) {
    int problems = 0;
    for (const Fault& fault : faults)
        for (const Edit& edit : fault.edits) try {
                locate(root, edit);
            } catch (const std::runtime_error& e) {
                ++problems;
                fmt::print("{}: {}\n", fault.name, e.what());
            }
    fmt::print("{} faults, {} without exactly one place\n", faults.size(), problems);
    return problems == 0 ? 0 : 1;
}

std::vector<Fault> choose(const std::vector<Fault>& faults, const std::vector<std::string>& names) {
    if (names.empty()) return faults;
    std::vector<Fault> chosen;
    for (const std::string& name : names) {
        const auto found = std::ranges::find(faults, name, &Fault::name);
        if (found == faults.end()) throw std::runtime_error(fmt::format("no fault '{}'", name));
        chosen.push_back(*found);
    }
    return chosen;
}

}  // namespace

int main(int count, char** words) {
    const std::vector<std::string> arguments(words + 1, words + count);
    try {
        const bool checks = arguments.size() == 2 && arguments[0] == "check";
        if (checks || (arguments.size() >= 3 && arguments[0] == "run")) {
            const std::string& root = arguments[1];
            const auto faults = parse_faults(read_file(root + "/tests/mutation/faults.txt"));
            if (checks) return check(root, faults);
            return run_faults(root, arguments[2],
                              choose(faults, {arguments.begin() + 3, arguments.end()}));
        }
    } catch (const std::exception& e) {
        fmt::print(stderr, "mutate: {}\n", e.what());
        return 2;
    }
    fmt::print(stderr, "usage: mutate run ROOT BUILD [FAULT...] | check ROOT\n");
    return 2;
}
