// The elastocheck command.
//
// Exit codes: 0 fine, 1 a limit is broken, 2 bad input, 3 could not judge, 4 internal error.
#include <fmt/format.h>

#include <csignal>
#include <exception>
#include <filesystem>
#include <new>

#include "elastocheck/read_scene.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/program/exit_code.hpp"
#include "reports/command/program/parse.hpp"
#include "reports/files/csv_table.hpp"
#include "reports/files/files.hpp"
#include "reports/files/subprocess.hpp"
#include "reports/files/terminal.hpp"
#include "reports/json/json_cursor.hpp"

int main(int argc, char** argv) {
    using namespace elastocheck;
    using namespace elastocheck::reports;
    const auto fail = [](Exit code, std::string_view what) -> int {
        print_error("elastocheck: {}{}\n", code == bug ? "internal error: " : "", what);
        return code;
    };
    end_child_on_signals();
    // A write beyond the file size limit then fails like one on a full disk.
    std::signal(SIGXFSZ, SIG_IGN);
    // After a reader has closed its pipe, the write fails instead of the process, so that files are
    // cleaned up. A handler, unlike SIG_IGN, is not inherited by programs that are run.
    if (std::signal(SIGPIPE, [](int) {}) == SIG_IGN) std::signal(SIGPIPE, SIG_IGN);
    try {
        const int code = parse_and_run(argc, argv);
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
    } catch (const SheetError& error) {
        return fail(bad_input, error.what());
    } catch (const std::filesystem::filesystem_error& error) {  // loops of links, no access
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
