// `elastocheck solve`: solves one scene by one leg or method and writes its curves as CSV.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>

#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/outputs/rates.hpp"
#include "compare/tables/compare_result.hpp"
#include "compare/warnings/lift_off.hpp"
#include "elastocheck/channels.hpp"
#include "recursive/series/path.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/options/limits.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/options/recursion_options.hpp"
#include "reports/command/options/solving.hpp"
#include "reports/command/program/command.hpp"
#include "reports/document/document.hpp"
#include "reports/files/files.hpp"
#include "reports/files/terminal.hpp"
#include "reports/given/state_file.hpp"
#include "reports/render/render.hpp"
#include "reports/tables/csv.hpp"

namespace elastocheck::reports {
namespace {

using compare::Channel;

// `folder` is the CSV file.
struct SolveRequest : SceneRequest {
    SolverRequest solver;
    bool keep_all = false;
    std::vector<std::string> channels;  // names, or patterns with *; none: all
    std::string rates;                  // CSV of the derivatives, by the series; empty: none
    std::string states;                 // JSON lines of poses, in the candidate format; empty: none
};

compare::SolverSettings checked_solver_of(const SolveRequest& request) {
    const compare::SolverSettings solver = solver_of(request.solver);
    if (!request.rates.empty() &&
        !std::holds_alternative<recursive::Series>(solver.recursion.method.kind))
        throw std::invalid_argument("--rates: only with --method series");
    return solver;
}

// Writes the derivatives in a separate file: positions and angles per unit of the parameter.
void write_rates(const Model& model, const std::vector<Channel>& requested,
                 const SolveRequest& request, const compare::SolverSettings& solver) {
    std::vector<Channel> channels;
    std::ranges::copy_if(requested, std::back_inserter(channels), &Channel::kinematic);
    if (channels.empty())
        throw std::invalid_argument("--rates: needs a position or an angle in --channels");
    AtomicFile csv(request.rates, rates_file);
    csv.add(rates_header(channels));
    for (const auto& branch : model.branches)
        for (const auto& side : compare::sides_of(model, branch, solver.recursion.steps)) {
            const auto path = recursive::series::follow(
                side.model, side.branch, std::get<recursive::Series>(solver.recursion.method.kind));
            for (const double a : compare::requested_parameters({side}, solver.every)) {
                const auto place = recursive::series::find(path, a);
                if (!place) break;
                csv.add(rates_row(
                    side.name, compare::unit_of(branch.unit), a,
                    compare::channel_rates(side.model, channels, side.branch, path, *place)));
            }
        }
    csv.finish();
}

// Writes each row when its point is found; the points of a branch side that is solved in reverse are
// stored first. The CSV goes to the file of `delivery` or to standard output; for the document all points
// are stored. Of a branch that does not converge, the rows reach to its last point. Returns the exit code.
int solve(const SolveRequest& request, const Delivery& delivery) {
    const compare::SolverSettings solver = checked_solver_of(request);
    const auto leg = solver.leg;
    const recursive::Options& recursion_options = solver.recursion;
    if (!delivery.folder.empty()) check_may_write(delivery.folder, curves_file);
    if (!request.rates.empty()) check_may_write(request.rates, rates_file);
    if (!request.states.empty()) check_may_write(request.states, states_file);
    const LoadedScene loaded = load_scene(request.scene, request.settings,
                                          request.keep_all ? Detail::everything : Detail::required);
    const Model& model = loaded.model;
    const auto channels = requested_channels(loaded, request.channels);
    check_every(model, recursion_options.steps, request.solver.every);
    if (delivery.as_json)
        check_memory(
            model,
            {.steps = recursion_options.steps, .every = request.solver.every, .written = true});
    else
        check_memory_of_rows(model,
                             {.steps = recursion_options.steps, .every = request.solver.every},
                             channels.size());
    if (!request.rates.empty()) write_rates(model, channels, request, solver);

    std::optional<AtomicFile> csv;
    if (!delivery.folder.empty()) csv.emplace(delivery.folder, curves_file);
    std::optional<AtomicFile> states;
    bool has_states = false;
    if (!request.states.empty()) states.emplace(request.states, states_file);
    const auto write = [&](const std::string& lines) {
        csv ? csv->add(lines) : delivery.print_text(lines);
    };
    std::vector<compare::BranchComparison> kept;  // of this leg alone, for the document
    compare::Result result{.analysis = "solve",
                           .verdict = {.grade = compare::Grade::pass, .requested = false}};
    write(curves_header(channels));
    std::vector<bool> is_undefined(channels.size(), false);
    compare::LegRun run;
    run.leg = leg;
    if (leg == compare::Leg::recursive) run.method = recursion_options.method.name;
    const std::string solver_name = run.method.empty() ? name(leg) : run.method;
    for (const auto& branch : model.branches) {
        if (csv) progress(branch.name);
        run.curve = {};
        run.constraint_error = {};
        run.curve.unit = compare::unit_of(branch.unit);
        const SolvedBranch solved = solve_branch(
            model, branch, channels, solver,
            [&](const Equilibrium& state, const compare::Row&) {
                if (states) {
                    states->add(state_line(model, branch.name, state));
                    has_states = true;
                }
            },
            [&](const compare::Row& row) {
                for (std::size_t c = 0; c < channels.size(); ++c)
                    is_undefined[c] = is_undefined[c] || row.values[c] == compare::undefined;
                if (delivery.as_json) {
                    append(run.curve, row.load, row.values);
                    run.constraint_error.push_back(row.constraint_error);
                }
                write(curves_row(branch.name, leg, compare::unit_of(branch.unit), row));
            });
        const EquilibriumPath& path = solved.path;
        if (csv) progress("");
        if (delivery.as_json) {
            run.outcome = path.outcome;
            run.detail = path.detail;
            run.counts = path.counts;
            compare::BranchComparison& alone = kept.emplace_back();
            alone.branch = branch.name;
            alone.runs = {run};
        }
        for (const auto& event : compare::lift_offs(
                 model, branch, leg == compare::Leg::recursive ? compare::Leg::series : leg))
            print_error("{}: {}\n", branch.name, event.text());
        for (const auto& [side, state] : solved.ends)
            print_error("{}: {}: {}\n", solver_name, branch.name, error_at_end(model, side, state));
        if (path.outcome == Outcome::converged) continue;
        result.verdict.grade = compare::Grade::not_judged;
        result.verdict.reasons.push_back(
            fmt::format("{}: {}: {}", branch.name, name(path.outcome), path.detail));
        const std::string& motion = solved.softest_motion;
        print_error("{}: {}: {}{}\n", solver_name, name(path.outcome), path.detail,
                    motion.empty() ? "" : "; the softest motion before it is " + motion);
    }
    if (const auto why =
            compare::not_determined(channels, [&](std::size_t c) { return bool(is_undefined[c]); });
        !why.empty())
        print_error("{}\n", why);
    if (csv) csv->finish();
    if (has_states)
        states->finish();
    else if (states)
        print_error("{}: not written: no state was reached\n", request.states);
    if (delivery.as_json) {
        nlohmann::ordered_json part = document_of(loaded, request.scene);
        add_curves(part, model, channels, kept);
        result.tables = {with_columns(compare::leg_table(kept),
                                      {"branch", "leg", "outcome", "detail", "points",
                                       "factorisations", "iterations", "evaluations"})};
        part["results"] = nlohmann::ordered_json::array({json_of(result)});
        deliver({.as_json = true, .command = delivery.command}, std::move(part), {});
    }
    return exit_code_of(result.verdict.grade);
}

}  // namespace

const Command solve_command{
    Group::solve, "solve", "Solve a scene with one method and print the curves as CSV",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<SolveRequest>();
        add_scene(command, *request);
        add_keep_all(command, request->keep_all);
        add_recursion(command, request->solver.recursion);
        as_word(command.add_option(
                    "--method", request->solver.method,
                    "equilibrium (default) or energy; a fast method: published (or recursive), "
                    "closed, balanced, tangent, chord, midpoint, adaptive or series"),
                solvers());
        command.add_flag("--arc-length", request->solver.recursion.arc_length,
                         "series: continuation by arc length, through limit points");
        as_file(
            command.add_option("--rates", request->rates,
                               "series: write derivatives of travel and outputs to this CSV file"));
        as_file(command.add_option("--states", request->states,
                                   "write the poses of the bodies to this file (JSON lines)"));
        command
            .add_option("--channels", request->channels,
                        "outputs to write, in this order: NAME,... as in the CSV's head; * matches "
                        "any letters")
            ->delimiter(',');
        add_every(command, request->solver.every);
        as_file(command.add_option("-o,--output", request->folder, "write the CSV to this file"));
        return
            [request](const std::string& line) { return solve(*request, request->delivery(line)); };
    }};

}  // namespace elastocheck::reports
