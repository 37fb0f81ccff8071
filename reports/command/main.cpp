// The elastocheck command.
//
// Exit codes: 0 fine · 1 a gate's limit is broken · 2 bad input · 3 could not judge · 4 a bug in here.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <exception>
#include <filesystem>
#include <new>

#include "models/reader/scene_file.hpp"
#include "models/reader/words.hpp"
#include "reports/command/arguments.hpp"
#include "reports/command/certify_command.hpp"
#include "reports/command/completion.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/documentation.hpp"
#include "reports/command/equilibria_command.hpp"
#include "reports/command/exit_code.hpp"
#include "reports/command/gate_command.hpp"
#include "reports/command/grammar.hpp"
#include "reports/command/import_command.hpp"
#include "reports/command/judge_command.hpp"
#include "reports/command/limits.hpp"
#include "reports/command/load_scene.hpp"
#include "reports/command/manual.hpp"
#include "reports/command/new_command.hpp"
#include "reports/command/recursion_options.hpp"
#include "reports/command/report_command.hpp"
#include "reports/command/solve_command.hpp"
#include "reports/command/stress_command.hpp"
#include "reports/command/study_commands.hpp"
#include "reports/document/field.hpp"
#include "reports/document/measurement.hpp"
#include "reports/document/provenance.hpp"
#include "reports/files/files.hpp"
#include "reports/page/gnuplot.hpp"
#include "reports/text/terminal.hpp"

namespace {

using namespace elastocheck;
using namespace elastocheck::reports;

std::string footer(const std::function<std::string(const std::string&)>& place) {
    return fmt::format(
        "Exit codes: 0 fine, 1 a gate's limit is broken, 2 bad input, 3 could not judge, 4 internal error.\n"
        "The scene files: {}\nWhat commands write: {}\n",
        place("models/scenes/README.md"), place("reports/README.md"));
}

int print_text(const std::string& text) {
    print(text);
    return fine;
}

// Says what CLI11 says, and after a word it does not know, the nearest one it does.
int explain(CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
    std::string message = error.what();
    const CLI::App* scope = &app;
    std::vector<std::string> known;
    if (!app.get_subcommands().empty()) scope = app.get_subcommands().front();
    const bool in_command = scope != &app;
    if (!in_command)
        for (const auto& command : grammar(app).commands) known.push_back(command.name);
    for (const auto* option : scope->get_options())
        if (!option->get_lnames().empty()) known.push_back("--" + option->get_lnames().front());
    if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr ||
        dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
        for (int k = 1; k < argc; ++k) {
            const std::string argument = argv[k], word = argument.substr(0, argument.find('='));
            const bool option = word.starts_with("--");
            if ((!in_command && k == 1 && !option) ||
                (option && std::ranges::find(known, word) == known.end())) {
                message = fmt::format("{} {}{}", option ? "unknown option" : "unknown command",
                                      reader::quote(word), reader::did_you_mean(word, known, "known"));
                break;
            }
        }
    }
    complain("elastocheck: {}\nelastocheck --help tells more.\n", message);
    return bad_input;
}

int run(int argc, char** argv) {
    CLI::App app{
        "Can I trust my suspension solver? One scene, solved three ways that share nothing but the scene:\n"
        "the linear recursive formula of Kang's paper, the full equilibrium equations, and an energy "
        "minimisation.",
        "elastocheck"};
    app.require_subcommand(1);
    app.set_version_flag("--version", version_text(provenance()),
                         "the version, the commit it was built from, and the libraries in it");
    app.set_help_flag("-h,--help", "this text; after a command, its options");
    app.footer(footer(documentation));

    std::string scene, output;
    // A leg, or a method of the recursion; its first one, the published, goes by the leg's name too.
    std::vector<std::string> methods, rungs_of_recursion;
    for (const auto leg : compare::legs) methods.emplace_back(name(leg));
    for (const auto& rung : recursive::methods) {
        methods.emplace_back(rung.name);
        rungs_of_recursion.emplace_back(rung.name);
    }
    RecursionRequest recursion_request;
    std::string method = "published";
    SolveRequest solve_request;

    auto* inspect_command = app.add_subcommand(
        "inspect", "Show how a scene is understood: bodies, coordinates, constraints, idle modes");
    auto* solve_command = app.add_subcommand("solve", "Solve a scene one way and print the curves as CSV");
    auto* compare_command =
        app.add_subcommand("compare", "Solve a scene all three ways and show how far apart they are");
    auto* converge_command =
        app.add_subcommand("converge", "Split the recursion's error into steps, formulation and reference");
    auto* trade_command = app.add_subcommand(
        "trade", "What accuracy costs: every method against both references, and a recommendation");
    auto* new_command =
        app.add_subcommand("new", "Print a scene to start from; without a name, which there are");
    std::string template_name;
    new_command->add_option("NAME", template_name, "of the scene to print")->check(such_as(templates()));
    ImportRequest import_request;
    const auto* import_command = add_import_command(app, import_request);
    ExportRequest export_request;
    const auto* export_command = add_export_command(app, export_request);
    const GateCommand gate_command = add_gate(app, progress);
    const CertifyCommand certify_command = add_certify(app);
    auto* completion_command =
        app.add_subcommand("completion", "Print the completion of this command for a shell")->group("");
    std::string shell;
    completion_command->add_option("SHELL", shell, "bash, zsh or fish")
        ->required()
        ->check(one_of({"bash", "zsh", "fish"}));
    auto* man_command = app.add_subcommand("man", "Print the page of the manual")->group("");
    Settings settings;
    for (auto* command : {inspect_command, solve_command, compare_command, converge_command, trade_command}) {
        command->add_option("SCENE", scene, "scene file (YAML)")->required()->check(a_file("*.yaml"));
        add_settings(*command, settings);
    }
    bool as_json = false;
    for (auto* command :
         {inspect_command, solve_command, compare_command, converge_command, trade_command, new_command})
        add_json(*command, as_json);
    bool keep_all = false, formulations = false, verbose = false;
    int every = 1;
    inspect_command->add_flag("--verbose", verbose,
                              "long lists whole, and the size of the matrix, its order and its fill-in");
    for (auto* command : {inspect_command, solve_command, compare_command})
        command->add_flag("--keep-all", keep_all, "solve the whole scene, also what no output depends on");
    compare_command->add_flag(
        "--formulations", formulations,
        "how much the outputs depend on the formulation of the bushings, in which tools differ");
    std::string within = CompareRequest{}.within;
    compare_command->add_option("--within", within,
                                "accuracy that the verdict asks for (default: 0.01mm,0.001deg)");
    for (auto* command : {solve_command, compare_command}) add_recursion_options(*command, recursion_request);
    solve_command
        ->add_option(
            "--method", method,
            "published (default, or recursive), closed, balanced, tangent, chord, midpoint, adaptive or "
            "series; equilibrium; energy")
        ->check(one_of(methods));
    compare_command
        ->add_option(
            "--method", method,
            "of the recursion: published (default), closed, balanced, tangent, chord, midpoint, adaptive "
            "or series")
        ->check(one_of(rungs_of_recursion));
    bool account = false;
    solve_command->add_flag(
        "--account", account,
        "say where the stiffness that is left will be gone, as the points announce it; adaptive and "
        "series always do, and whether they keep what they promise");
    solve_command->add_flag("--arc-length", recursion_request.arc_length,
                            "series: follow the path by arc length, through limit points");
    solve_command
        ->add_option("--rates", solve_request.rates,
                     "series: write the derivatives of travel and outputs to this CSV file")
        ->check(a_file("*.csv"));
    solve_command
        ->add_option("--states", solve_request.states,
                     "write the poses of the bodies as well, as JSON lines, to this file")
        ->check(a_file("*.jsonl"));
    solve_command
        ->add_option("--channels", solve_request.channels,
                     "only these outputs, in this order: NAME,... as in the CSV's head, * for any letters")
        ->delimiter(',');
    for (auto* command : {solve_command, compare_command})
        command
            ->add_option("--every", every,
                         "only every N-th step's point of each way from the start, and the last")
            ->check(CLI::Range(1, most_steps));
    solve_command->add_option("-o,--output", output, "write the CSV to this file instead")
        ->check(a_file("*.csv"));
    compare_command->add_option("-o,--output", output, "folder for result.json and curves.csv")
        ->check(a_folder());

    std::vector<std::string> rungs{"published"}, known_rungs{"all"};
    for (const auto& rung : recursive::methods)
        if (!std::holds_alternative<recursive::Adaptive>(rung.kind)) known_rungs.emplace_back(rung.name);
    std::vector<int> levels;
    converge_command
        ->add_option("--method", rungs,
                     "published (default), closed, balanced, tangent, chord, midpoint, series, or all")
        ->delimiter(',')
        ->check(one_of(known_rungs));
    converge_command
        ->add_option("--steps", levels,
                     "step counts per branch, at least five, increasing (default: 75,150,...,2400)")
        ->delimiter(',')
        ->check(CLI::Range(1, most_steps));
    converge_command
        ->add_option("-o,--output", output,
                     "folder for result.json, convergence.csv, step_errors.csv and attribution.csv")
        ->check(a_folder());

    std::string tolerance = "0.01mm,0.001deg";
    trade_command->add_option("--tolerance", tolerance, "accuracy asked for (default: 0.01mm,0.001deg)");
    trade_command->add_option("-o,--output", output, "folder for result.json, trade.csv and precision.csv")
        ->check(a_folder());

    CandidateRequest candidate;  // of compare, converge and trade
    for (auto* command : {compare_command, converge_command, trade_command})
        add_candidate_options(*command, candidate);

    JudgeRequest judge_request;
    auto* judge_command = add_judge_command(app, judge_request);
    judge_command->add_option("-o,--output", output, "folder for result.json and curves.csv")
        ->check(a_folder());
    add_json(*judge_command, as_json);

    ReportRequest request;
    const auto* report_command = add_report_command(app, request);

    StressRequest stress_request;
    auto* stress_command = add_stress_command(app, stress_request);
    stress_command->add_option("-o,--output", output, "folder for stress.json and cells.csv")
        ->check(a_folder());
    add_json(*stress_command, as_json);

    EquilibriaRequest equilibria_request;
    auto* equilibria_command = add_equilibria_command(app, equilibria_request);
    add_json(*equilibria_command, as_json);

    name_values(app);

    try {
        check_words(argc, argv);
        const std::string command = command_line(argc, argv);
        app.parse(argc, argv);
        if (*report_command) return report(request, command, progress);
        if (*new_command) return new_scene(template_name, as_json);
        if (*import_command) return import(import_request);
        if (*export_command) return export_scene(export_request);
        if (*completion_command) return print_text(completion(grammar(app), shell));
        if (*man_command) {  // it may be read far from where it was made
            app.footer(
                footer([](const std::string& name) { return "PREFIX/share/doc/elastocheck/" + name; }));
            return print_text(manual(grammar(app), provenance().version));
        }
        const Delivery delivery{.folder = output, .as_json = as_json, .command = command};
        const Detail detail = keep_all ? Detail::everything : Detail::required;
        if (*equilibria_command) return equilibria(equilibria_request, delivery, progress);
        if (*judge_command) return judge(judge_request, delivery);
        if (*stress_command) return stress(stress_request, delivery, progress);
        if (*inspect_command) return inspect(scene, settings, detail, verbose, delivery);
        if (*solve_command || *compare_command) {
            const auto leg =
                std::ranges::find(compare::legs, method, [](auto l) { return std::string(name(l)); });
            const bool reference = leg != compare::legs.end() && *leg != compare::Leg::recursive;
            if (leg == compare::legs.end()) recursion_request.method = method;
            const recursive::Options how = recursion(recursion_request);
            if (!solve_request.rates.empty() && !std::holds_alternative<recursive::Series>(how.method.kind))
                throw std::invalid_argument("--rates: only with --method series");
            if (*compare_command)
                return compare_legs(scene, settings, {how, every, detail, within, candidate, formulations},
                                    delivery);
            solve_request.gait = {.leg = reference ? *leg : compare::Leg::recursive,
                                  .recursion = how,
                                  .every = every,
                                  .account = account};
            solve_request.detail = detail;
            return solve(scene, settings, solve_request, delivery);
        }
        if (*gate_command.parsed) return gate_command.run();
        if (*certify_command.parsed) return certify_command.run(command);
        if (*converge_command) return converge(scene, settings, rungs, levels, candidate, delivery);
        return trade(scene, settings, tolerance, candidate, delivery);
    } catch (const CLI::Success& done) {
        return app.exit(done);
    } catch (const CLI::ParseError& error) {
        return explain(app, error, argc, argv);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const auto fail = [](Exit code, std::string_view what) -> int {
        complain("elastocheck: {}{}\n", code == bug ? "internal error: " : "", what);
        return code;
    };
    // A limit on the size of files is said like a full disk, not by a signal.
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        const int code = run(argc, argv);
        finish_printing();
        return code;
    } catch (const NobodyReads&) {
        // Where the signal that ends filters is ignored: as if it were not.
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
    } catch (const PlotError& error) {
        return fail(bad_input, error.what());
    } catch (const std::filesystem::filesystem_error& error) {  // loops of links, folders that are closed
        return fail(bad_input, fmt::format("{}: {}", error.path1().string(), error.code().message()));
    } catch (const std::invalid_argument& error) {
        return fail(bad_input, error.what());
    } catch (const std::bad_alloc&) {
        return fail(bad_input, "more memory was asked for than there is; take fewer steps");
    } catch (const std::exception& error) {
        return fail(bug, error.what());
    }
}
