// The elastocheck command.
//
// Exit codes: 0 fine · 1 a gate's limit is broken · 2 bad input · 3 could not judge · 4 internal
// error.
#include <fmt/format.h>

#include <csignal>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <new>

#include "elastocheck/read_scene.hpp"
#include "reports/command/grammar/completion.hpp"
#include "reports/command/grammar/documentation.hpp"
#include "reports/command/grammar/exit_code.hpp"
#include "reports/command/grammar/grammar.hpp"
#include "reports/command/grammar/manual.hpp"
#include "reports/command/grammar/parse.hpp"
#include "reports/command/grammar/registry.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/document/measurement.hpp"
#include "reports/files/cleanup.hpp"
#include "reports/files/files.hpp"
#include "reports/files/provenance.hpp"
#include "reports/files/terminal.hpp"
#include "reports/json/json_cursor.hpp"

namespace {

using namespace elastocheck;
using namespace elastocheck::reports;

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

// The commands of the registry, and the two that print their description.
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

}  // namespace

int main(int argc, char** argv) {
    const auto fail = [](Exit code, std::string_view what) -> int {
        print_error("elastocheck: {}{}\n", code == bug ? "internal error: " : "", what);
        return code;
    };
    clean_up_on_signals();
    // A write beyond the file size limit then fails like one on a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
    // After a reader has closed its pipe, the write fails instead of the process, so that files are
    // cleaned up. A handler, unlike SIG_IGN, is not inherited by programs that are run.
    if (std::signal(SIGPIPE, [](int) {}) == SIG_IGN) std::signal(SIGPIPE, SIG_IGN);
    try {
        const int code = parse_and_run(program(documentation), commands(), argc, argv);
        finish_printing();
        return code;
    } catch (const OutputClosed&) {
        // Ends the program by SIGPIPE.
        std::signal(SIGPIPE, SIG_DFL);
        std::raise(SIGPIPE);
        return fine;
    } catch (const SceneError& error) {
        return fail(bad_input, error.what());
    } catch (const NotTrimmed& error) {
        return fail(could_not_judge, error.what());
    } catch (const FileError& error) {
        return fail(bad_input, error.what());
    } catch (const ResultError& error) {
        return fail(bad_input, error.what());
    } catch (const MeasurementError& error) {
        return fail(bad_input, error.what());
        // loops of links, inaccessible folders
    } catch (const std::filesystem::filesystem_error& error) {
        return fail(bad_input,
                    fmt::format("{}: {}", error.path1().string(), error.code().message()));
    } catch (const std::invalid_argument& error) {
        return fail(bad_input, error.what());
    } catch (const std::bad_alloc&) {
        return fail(bad_input, "not enough memory; use fewer steps");
    } catch (const std::exception& error) {
        return fail(bug, error.what());
    }
}
