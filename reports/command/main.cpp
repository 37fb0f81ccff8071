// The elastocheck command.
//
// Exit codes: 0 fine · 1 a gate's limit is broken · 2 bad input · 3 could not judge · 4 a bug in here.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "compare/compare.hpp"
#include "compare/order_study.hpp"
#include "compare/precision.hpp"
#include "compare/rates.hpp"
#include "compare/study.hpp"
#include "compare/trade.hpp"
#include "models/compile.hpp"
#include "models/scene_file.hpp"
#include "models/scene_words.hpp"
#include "recursive/diagnosis.hpp"
#include "reports/command/exit_code.hpp"
#include "reports/command/gate_command.hpp"
#include "reports/command/recursion_options.hpp"
#include "reports/command/report_command.hpp"
#include "reports/document/document.hpp"
#include "reports/document/field.hpp"
#include "reports/document/measurement.hpp"
#include "reports/files/files.hpp"
#include "reports/page/gnuplot.hpp"
#include "reports/tables/comparison_tables.hpp"
#include "reports/tables/csv.hpp"
#include "reports/tables/inspection.hpp"
#include "reports/tables/order_tables.hpp"
#include "reports/tables/study_tables.hpp"
#include "reports/tables/trade_tables.hpp"

namespace {

using namespace elastocheck;
using namespace elastocheck::reports;
using json = nlohmann::ordered_json;

// One line that is written over, on a terminal; nothing in a pipe.
void progress(std::string_view what) {
    if (isatty(STDERR_FILENO)) fmt::print(stderr, "\r\033[K{}", what);
}

// The command as it was given, for a shell.
std::string command_line;
std::string quoted_command(int argc, char** argv) {
    std::string line = "elastocheck";
    for (int k = 1; k < argc; ++k) {
        const std::string_view word = argv[k];
        const bool plain = !word.empty() && word.find_first_not_of(
                                                "abcdefghijklmnopqrstuvwxyz"
                                                "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                                "-_./=,:+@%") == word.npos;
        line += ' ';
        if (plain) {
            line += word;
            continue;
        }
        line += '\'';
        for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
        line += '\'';
    }
    return line;
}

void write_result(const std::filesystem::path& folder, json part) {
    json result = reports::document(command_line, reports::provenance());
    result["scenes"].push_back(std::move(part));
    reports::write_whole(folder / "result.json", result.dump(1) + "\n");
}

int inspect(const std::string& file) {
    const Model model = compile(read_scene(file));
    fmt::print("{}", reports::inspection(model, recursive::diagnose(model)));
    return fine;
}

// The rates of a polynomial branch beside its curve: travel and main channels per unit of the load factor.
std::string rates_csv(const Model& model, const recursive::Options& how) {
    std::string csv = "branch,load factor,travel [mm per unit]";
    for (const auto& channel : compare::channels(model))
        if (channel.main) csv += fmt::format(",{} [{} per unit]", channel.name, symbol(channel.unit));
    csv += "\n";
    for (const auto& branch : model.branches) {
        const auto path = recursive::series::follow(model, branch, how.series);
        const int steps = how.steps > 0 ? how.steps : branch.steps;
        for (int k = 0; k <= steps; ++k) {
            const double load = branch.to * k / steps;
            const auto place = recursive::series::find(path, load);
            if (!place) break;
            const auto rates = compare::channel_rates(model, branch, path, *place);
            csv += fmt::format("{},{:.17g},{:.17g}", branch.name, load, rates.travel);
            for (const double slope : rates.slope) csv += fmt::format(",{:.17g}", slope);
            csv += "\n";
        }
    }
    return csv;
}

int solve(const std::string& file, compare::Leg leg, const recursive::Options& how, const std::string& rates,
          const std::string& output) {
    const Model model = compile(read_scene(file));
    std::string csv = reports::curves_header(compare::channels(model));
    int code = fine;
    for (const auto& branch : model.branches) {
        progress(branch.name);
        const compare::LegRun run = compare::run(model, branch, leg, how);
        csv += reports::curves_rows(branch.name, run);
        if (run.path.outcome == Outcome::converged) continue;
        progress("");
        fmt::print(stderr, "{}: {}: {}\n", leg == compare::Leg::recursive ? how.method.name : name(leg),
                   name(run.path.outcome), run.path.detail);
        code = could_not_judge;
    }
    progress("");
    if (!rates.empty()) reports::write_whole(rates, rates_csv(model, how));
    if (output.empty())
        fmt::print("{}", csv);
    else
        reports::write_whole(output, csv);
    return code;
}

int compare_legs(const std::string& file, const recursive::Options& how, const std::string& folder) {
    const Scene scene = read_scene(file);
    const Model model = compile(scene);
    compare::Options options;
    options.recursion = how;
    options.progress = progress;
    const compare::Comparison comparison = compare::compare(model, options);
    progress("");
    fmt::print("{}", reports::tables(model, comparison));
    if (!folder.empty()) {
        json part = reports::scene_document(scene, read_whole(file), model, recursive::diagnose(model));
        reports::add_comparison(part, scene, model, comparison);
        reports::add_verdict(part, comparison.compared, reports::reasons_of(comparison));
        const std::filesystem::path base(folder);
        write_result(base, std::move(part));
        reports::write_whole(base / "curves.csv", reports::curves_csv(comparison));
        fmt::print("Written: {0}/result.json, {0}/curves.csv\n", folder);
    }
    return comparison.conclusive() ? fine : could_not_judge;
}

std::vector<recursive::Method> methods_named(const std::vector<std::string>& names) {
    std::vector<recursive::Method> methods;
    for (const auto& method : recursive::methods)
        if (recursive::has_steps(method) &&
            (names.front() == "all" || std::ranges::find(names, method.name) != names.end()))
            methods.push_back(method);
    return methods;
}

int converge(const std::string& file, const std::vector<std::string>& names, const std::vector<int>& steps,
             const std::string& folder) {
    const Scene scene = read_scene(file);
    const Model model = compile(scene);
    compare::StudyOptions options;
    options.methods = methods_named(names);
    if (!steps.empty()) options.steps = steps;
    options.progress = progress;
    compare::Study study;
    std::vector<compare::BranchAttribution> attribution;
    if (!options.methods.empty()) {
        study = compare::study(model, options);
        attribution = compare::attribute_gap(model, progress);
    }
    std::vector<compare::BranchOrders> orders;
    if (names.front() == "all" || std::ranges::find(names, "series") != names.end())
        orders = compare::order_study(model, {.progress = progress});
    progress("");
    if (!options.methods.empty()) fmt::print("{}", reports::study_tables(model, study, attribution));
    fmt::print("{}", reports::order_table(orders));
    const bool conclusive =
        (options.methods.empty() || study.conclusive()) && (orders.empty() || compare::conclusive(orders));
    if (!folder.empty()) {
        json part = reports::scene_document(scene, read_whole(file), model, recursive::diagnose(model));
        const std::filesystem::path base(folder);
        std::string written = "result.json";
        const auto keep = [&](const char* what, const std::string& csv) {
            reports::write_whole(base / what, csv);
            written += fmt::format(", {}/{}", folder, what);
        };
        if (!options.methods.empty()) {
            part["convergence"] = reports::study_json(study, attribution);
            keep("convergence.csv", reports::study_csv(study));
            keep("attribution.csv", reports::attribution_csv(study, attribution));
        }
        if (!orders.empty()) {
            part["orders"] = reports::orders_json(orders);
            keep("orders.csv", reports::orders_csv(orders));
        }
        auto reasons = study.inconclusive;
        if (!conclusive && reasons.empty()) reasons.emplace_back("no order of the series gave a number");
        reports::add_verdict(part, 0, reasons);
        write_result(base, std::move(part));
        fmt::print("Written: {}/{}\n", folder, written);
    }
    return conclusive ? fine : could_not_judge;
}

int trade(const std::string& file, const std::string& tolerance, const std::string& folder) {
    const Scene scene = read_scene(file);
    const Model model = compile(scene);
    compare::TradeOptions options;
    options.tolerance = compare::parse_tolerance(tolerance);
    options.progress = progress;
    const compare::Trade trade = compare::trade(model, options);
    const compare::PrecisionStudy precision = compare::precision_study(model, {.progress = progress});
    progress("");
    fmt::print("{}\n{}", reports::trade_table(model, trade), reports::precision_table(precision));
    if (!folder.empty()) {
        json part = reports::scene_document(scene, read_whole(file), model, recursive::diagnose(model));
        part["trade"] = reports::trade_json(trade);
        part["precision"] = reports::precision_json(precision);
        reports::add_verdict(part, trade.recommendation ? trade.recommendation->confirmed_numbers : 0,
                             trade.inconclusive);
        const std::filesystem::path base(folder);
        write_result(base, std::move(part));
        reports::write_whole(base / "trade.csv", reports::trade_csv(trade));
        reports::write_whole(base / "precision.csv", reports::precision_csv(precision));
        fmt::print("Written: {0}/result.json, {0}/trade.csv, {0}/precision.csv\n", folder);
    }
    return trade.recommendation ? fine : could_not_judge;
}

// Says what CLI11 says, and after a word it does not know, the nearest one it does.
int explain(const CLI::App& app, const CLI::ParseError& error, int argc, char** argv) {
    std::string message = error.what();
    const CLI::App* scope = &app;
    std::vector<std::string> known;
    if (!app.get_subcommands().empty()) scope = app.get_subcommands().front();
    const bool in_command = scope != &app;
    if (!in_command)
        for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; }))
            known.push_back(command->get_name());
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
    fmt::print(stderr, "elastocheck: {}\nelastocheck --help tells more.\n", message);
    return bad_input;
}

int run(int argc, char** argv) {
    CLI::App app{
        "Can I trust my suspension solver? One scene, solved three ways that share nothing but the scene:\n"
        "the linear recursive formula of Kang's paper, the full equilibrium equations, and an energy "
        "minimisation.",
        "elastocheck"};
    app.require_subcommand(1);
    app.set_version_flag("--version", reports::provenance().version);
    app.footer(
        "Exit codes: 0 fine, 1 a gate's limit is broken, 2 bad input, 3 could not judge, 4 internal error.\n"
        "Scene files are described in models/scenes/README.md.");

    std::string scene, output;
    // A leg, or a method of the recursion; its first one, the published, goes by the leg's name too.
    std::vector<std::string> methods, rungs_of_recursion;
    for (const auto leg : compare::legs) methods.emplace_back(name(leg));
    for (const auto& rung : recursive::methods) {
        methods.emplace_back(rung.name);
        rungs_of_recursion.emplace_back(rung.name);
    }
    RecursionRequest recursion_request;
    std::string method = "published", rates;

    auto* inspect_command = app.add_subcommand(
        "inspect", "Show how a scene is understood: bodies, coordinates, constraints, idle modes");
    auto* solve_command = app.add_subcommand("solve", "Solve a scene one way and print the curves as CSV");
    auto* compare_command =
        app.add_subcommand("compare", "Solve a scene all three ways and show how far apart they are");
    auto* converge_command =
        app.add_subcommand("converge", "Split the recursion's error into steps, formulation and reference");
    auto* trade_command = app.add_subcommand(
        "trade", "What accuracy costs: every method against both references, and a recommendation");
    const GateCommand gate_command = add_gate(app, progress);
    for (auto* command : {inspect_command, solve_command, compare_command, converge_command, trade_command})
        command->add_option("SCENE", scene, "scene file (YAML)")->required();
    for (auto* command : {solve_command, compare_command}) add_recursion_options(*command, recursion_request);
    solve_command
        ->add_option(
            "--method", method,
            "published (default, or recursive), closed, balanced, tangent, chord, midpoint, adaptive or "
            "series; equilibrium; energy")
        ->check(CLI::IsMember(methods).description(""));
    compare_command
        ->add_option(
            "--method", method,
            "of the recursion: published (default), closed, balanced, tangent, chord, midpoint, adaptive "
            "or series")
        ->check(CLI::IsMember(rungs_of_recursion).description(""));
    solve_command->add_flag("--arc-length", recursion_request.arc_length,
                            "series: follow the path by arc length, through limit points");
    solve_command->add_option("--rates", rates,
                              "series: write the derivatives of travel and outputs to this CSV file");
    solve_command->add_option("-o,--output", output, "write the CSV to this file instead");
    compare_command->add_option("-o,--output", output, "folder for result.json and curves.csv");

    std::vector<std::string> rungs{"published"}, known_rungs{"all"};
    for (const auto& rung : recursive::methods)
        if (!rung.adaptive) known_rungs.emplace_back(rung.name);
    std::vector<int> levels;
    converge_command
        ->add_option("--method", rungs,
                     "published (default), closed, balanced, tangent, chord, midpoint, series, or all")
        ->delimiter(',')
        ->check(CLI::IsMember(known_rungs).description(""));
    converge_command
        ->add_option("--steps", levels,
                     "step counts per branch, at least five, increasing (default: 75,150,...,2400)")
        ->delimiter(',');
    converge_command->add_option("-o,--output", output,
                                 "folder for result.json, convergence.csv and attribution.csv");

    std::string tolerance = "0.01mm,0.001deg";
    trade_command->add_option("--tolerance", tolerance, "accuracy asked for (default: 0.01mm,0.001deg)");
    trade_command->add_option("-o,--output", output, "folder for result.json, trade.csv and precision.csv");

    ReportRequest request;
    const auto* report_command = add_report_command(app, request);

    try {
        command_line = quoted_command(argc, argv);
        app.parse(argc, argv);
        if (*report_command) return report(request, command_line, progress);
        if (*inspect_command) return inspect(scene);
        if (*solve_command || *compare_command) {
            const auto leg =
                std::ranges::find(compare::legs, method, [](auto l) { return std::string(name(l)); });
            const bool reference = leg != compare::legs.end() && *leg != compare::Leg::recursive;
            if (leg == compare::legs.end()) recursion_request.method = method;
            const recursive::Options how = recursion(recursion_request);
            if (!rates.empty() && !how.method.series)
                throw std::invalid_argument("--rates: only with --method series");
            if (*compare_command) return compare_legs(scene, how, output);
            return solve(scene, reference ? *leg : compare::Leg::recursive, how, rates, output);
        }
        if (*gate_command.parsed) return gate_command.run();
        if (*converge_command) return converge(scene, rungs, levels, output);
        return trade(scene, tolerance, output);
    } catch (const CLI::Success& done) {
        return app.exit(done);
    } catch (const CLI::ParseError& error) {
        return explain(app, error, argc, argv);
    }
}

}  // namespace

int main(int argc, char** argv) {
    const auto fail = [](Exit code, const char* what) {
        std::fprintf(stderr, "elastocheck: %s%s\n", code == bug ? "internal error: " : "", what);
        return code;
    };
    try {
        return run(argc, argv);
    } catch (const SceneError& error) {
        return fail(bad_input, error.what());
    } catch (const reports::FileError& error) {
        return fail(bad_input, error.what());
    } catch (const reports::ResultError& error) {
        return fail(bad_input, error.what());
    } catch (const reports::MeasurementError& error) {
        return fail(bad_input, error.what());
    } catch (const reports::PlotError& error) {
        return fail(bad_input, error.what());
    } catch (const std::invalid_argument& error) {
        return fail(bad_input, error.what());
    } catch (const std::exception& error) {
        return fail(bug, error.what());
    }
}
