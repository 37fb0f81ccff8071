#include "reports/command/program.hpp"

#include <fmt/format.h>

#include <memory>

#include "reports/command/grammar/completion.hpp"
#include "reports/command/grammar/documentation.hpp"
#include "reports/command/grammar/exit_code.hpp"
#include "reports/command/grammar/grammar.hpp"
#include "reports/command/grammar/manual.hpp"
#include "reports/command/grammar/registry.hpp"
#include "reports/files/provenance.hpp"
#include "reports/files/terminal.hpp"

namespace elastocheck::reports {
namespace {

std::string footer(const std::function<std::string(const std::string&)>& place) {
    return fmt::format(
        "Exit codes: 0 success, 1 failed judgement or gate, 2 bad input, 3 could not judge, 4 "
        "internal error.\n"
        "Scene files: {}\nOutput files: {}\n",
        place("models/scenes/README.md"), place("reports/README.md"));
}

int print_text(const std::string& text) {
    print(text);
    return fine;
}

}  // namespace

Program program(const std::function<std::string(const std::string&)>& place) {
    return {
        .name = "elastocheck",
        .description =
            "Verification of a suspension solver: one scene, solved by three independent methods:\n"
            "the linear recursive formula of Kang's paper, the full equilibrium equations, and "
            "an energy "
            "minimisation.",
        .version = version_text(provenance()),
        .footer = footer(place)};
}

std::vector<Command> commands() {
    std::vector<Command> all = registry();
    const auto shell = std::make_shared<std::string>();
    all.push_back({.name = "completion",
                   .description = "Print the completion of this command for a shell",
                   .options = {{"SHELL", Text{shell.get(), one_of({"bash", "zsh", "fish"})},
                                "bash, zsh or fish", true}},
                   .run =
                       [shell](const std::string&) {
                           return print_text(
                               completion(grammar(program(documentation), registry()), *shell));
                       },
                   .hidden = true});
    const auto installed = [](const std::string& name) {
        return "PREFIX/share/doc/elastocheck/" + name;
    };
    all.push_back({.name = "man",
                   .description = "Print the page of the manual",
                   .options = {},
                   .run =
                       [installed](const std::string&) {
                           return print_text(manual(grammar(program(installed), registry()),
                                                    provenance().version));
                       },
                   .hidden = true});
    return all;
}

}  // namespace elastocheck::reports
