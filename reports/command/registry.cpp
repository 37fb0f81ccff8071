#include "reports/command/registry.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "reports/command/grammar/exit_code.hpp"
#include "reports/command/grammar/manual.hpp"
#include "reports/files/provenance.hpp"
#include "reports/files/terminal.hpp"

namespace elastocheck::reports {

// Each is in NAME_command.cpp, live in live/; inspect, compare, converge and trade are in study_commands.cpp;
// solve-for, optimise, fit and tolerances in design/, study in variants/.
Command certify_command();
Command compare_command();
Command converge_command();
Command equilibria_command();
Command export_command();
Command fit_command();
Command gate_command();
Command import_command();
Command inspect_command();
Command judge_command();
Command live_command();
Command new_command();
Command optimise_command();
Command report_command();
Command sensitivity_command();
Command solve_command();
Command solve_for_command();
Command stress_command();
Command study_command();
Command tolerances_command();
Command trade_command();

namespace {

// Path of a document by its name in the source tree: PREFIX/share/doc/elastocheck/NAME of an
// installed program, or the one in the source tree; else only its name.
std::string documentation(const std::string& name) {
    namespace fs = std::filesystem;
    std::error_code failed;
    for (fs::path file = fs::read_symlink("/proc/self/exe", failed), folder = file.parent_path();
         !failed && folder != file; file = folder, folder = folder.parent_path())
        for (const fs::path& place : {folder / "share/doc/elastocheck" / name, folder / name})
            if (std::error_code unseen; fs::is_regular_file(place, unseen)) return place.string();
    return name;
}

std::string installed(const std::string& name) { return "PREFIX/share/doc/elastocheck/" + name; }

Program program_with(std::string (*place)(const std::string&)) {
    return {
        .name = "elastocheck",
        .description =
            "Verification of a suspension solver: one scene, solved by three independent methods:\n"
            "the linear recursive formula of Kang's paper, the full equilibrium equations, and "
            "an energy minimisation.",
        .version = version_text(provenance()),
        .footer = fmt::format(
            "Exit codes: 0 success, 1 failed judgement or gate, 2 bad input, 3 could not judge, 4 "
            "internal error.\n"
            "Scene files: {}\nOutput files: {}\n",
            place("models/scenes/README.md"), place("reports/README.md"))};
}

}  // namespace

Program program() { return program_with(documentation); }

std::vector<Command> commands() {
    std::vector<Command> all{inspect_command(),    solve_command(),      compare_command(),
                             converge_command(),   trade_command(),      new_command(),
                             import_command(),     export_command(),     gate_command(),
                             certify_command(),    judge_command(),      report_command(),
                             stress_command(),     equilibria_command(), sensitivity_command(),
                             solve_for_command(),  optimise_command(),   fit_command(),
                             tolerances_command(), study_command(),      live_command()};
    all.push_back({.name = "man",
                   .description = "Print the page of the manual",
                   .options = {},
                   .run =
                       [](const std::string&) {
                           print(manual(program_with(installed), commands(), provenance().version));
                           return fine;
                       },
                   .hidden = true});
    return all;
}

}  // namespace elastocheck::reports
