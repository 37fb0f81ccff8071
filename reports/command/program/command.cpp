#include "reports/command/program/command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "reports/command/options/limits.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

std::vector<const Command*>& registered() {
    static std::vector<const Command*> list;
    return list;
}

std::string flaw_of_a_name(const std::string& word) {
    if (word.empty()) return "'' is not a name";
    if (word == "-") return "'-' is not a file name; standard output is the default or --json";
    return {};
}

// CLI11 reads numbers by the locale's decimal sign.
double number_of(const std::string& option, const std::string& word,
                 std::pair<double, double> range) {
    const auto [low, high] = range;
    if (const auto number = finite_number(word); number && *number >= low && *number <= high)
        return *number;
    const bool bounded = std::isfinite(low) || std::isfinite(high);
    throw CLI::ValidationError(
        option, fmt::format("'{}' is not a number{}", word,
                            bounded ? fmt::format(" from {} to {}", low, high) : ""));
}

}  // namespace

Command::Command(Group in, const char* called, const char* does, Run (*options)(CLI::App&))
    : group(in), name(called), description(does), set_up(options) {
    registered().push_back(this);
}

std::vector<const Command*> commands() {
    auto list = registered();
    std::ranges::sort(list, [](const Command* a, const Command* b) {
        return a->group != b->group ? a->group < b->group : std::strcmp(a->name, b->name) < 0;
    });
    return list;
}

CLI::Option* as_file(CLI::Option* option) {
    return option->check(CLI::Validator(flaw_of_a_name, ""))->type_name("FILE");
}

CLI::Option* as_folder(CLI::Option* option) { return as_file(option)->type_name("FOLDER"); }

CLI::Option* as_word(CLI::Option* option, const std::vector<std::string>& words) {
    return option->check(CLI::IsMember(words).description(""))->type_name("WORD");
}

CLI::Option* repeated(CLI::Option* option) { return option->take_all()->expected(1); }

CLI::Option* add_number(CLI::App& command, const std::string& name, double& variable,
                        std::pair<double, double> range, const std::string& description) {
    const auto read = [name, range, &variable](const std::string& word) {
        variable = number_of(name, word, range);
    };
    return command.add_option_function<std::string>(name, read, description)->type_name("FLOAT");
}

void add_scene(CLI::App& command, std::string& file) {
    as_file(command.add_option("SCENE", file, "scene file (YAML)"))->required();
}

void add_set(CLI::App& command, Settings& settings) {
    const auto read = [&settings](const std::vector<std::string>& texts) {
        for (const auto& text : texts) settings.push_back(parse_setting(text));
    };
    repeated(command.add_option_function<std::vector<std::string>>(
                 "--set", read,
                 "change a value of the scene, in the file's units: "
                 "--set points.tie_rod_inner.z=-0.055"))
        ->type_name("PATH=VALUE");
}

void add_json(CLI::App& command, bool& wanted) {
    command.add_flag("--json", wanted,
                     "one JSON document on standard output, and nothing else there");
}

void add_running(CLI::App& command, Running& running) {
    constexpr int max_threads = 1024;
    command
        .add_option("--jobs", running.jobs,
                    "threads (default: one for each core); the results are the same")
        ->check(CLI::Range(1, max_threads));
    command.add_flag("--quiet", running.quiet, "no progress on standard error");
}

void add_keep_all(CLI::App& command, bool& wanted) {
    command.add_flag("--keep-all", wanted, "solve the whole scene, also what no output depends on");
}

void add_every(CLI::App& command, int& every) {
    command
        .add_option("--every", every,
                    "only every N-th step's point of each side from the start, and the last")
        ->check(CLI::Range(1, max_steps));
}

void add_output(CLI::App& command, std::string& folder, const char* description) {
    as_folder(command.add_option("-o,--output", folder, description));
}

void add_recursion(CLI::App& command, RecursionRequest& request) {
    command.add_option("--steps", request.steps, "load steps per branch (default: of the scene)")
        ->check(CLI::Range(1, max_steps));
    command.add_option(
        "--tolerance", request.tolerance,
        "error tolerance of adaptive (default: 0.01mm,0.001deg) and series (default: 1e-9mm)");
    command
        .add_option(
            "--order", request.order,
            "of the series (default: 16; up to 24 where that reaches the end of the branch)")
        ->check(CLI::Range(1, 60));
    command
        .add_option("--expansions", request.expansions,
                    "largest number of expansions of the series; as many more for each knot "
                    "passed (default: 200)")
        ->check(CLI::Range(1, 1'000'000));
}

void add_candidate(CLI::App& command, CandidateRequest& request) {
    as_file(repeated(
        command.add_option("--candidate", request.files,
                           "results of another solver: outputs (CSV) or states (JSON lines, CSV); "
                           "STEPS=FILE where it has steps")));
    command.add_option("--candidate-command", request.command,
                       "solver to run, without a shell: './mysolver {scene} {steps} {output}'");
    add_number(command, "--candidate-timeout", request.timeout, {0.001, 86400},
               "seconds after which the command is killed (default: 60)");
    as_file(command.add_option(
        "--map", request.map, "YAML file with the table's column names, units, signs and offsets"));
    command.add_flag("--partial", request.partial,
                     "let a candidate pass that leaves out branches or parts of them");
}

}  // namespace elastocheck::reports
