#include "reports/command/solve_command.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "compare/channels.hpp"
#include "compare/characteristics.hpp"
#include "compare/elements.hpp"
#include "compare/outlook.hpp"
#include "compare/rates.hpp"
#include "models/reader/words.hpp"
#include "recursive/diagnosis.hpp"
#include "recursive/series/path.hpp"
#include "reports/command/exit_code.hpp"
#include "reports/command/limits.hpp"
#include "reports/document/candidate_file.hpp"
#include "reports/document/document.hpp"
#include "reports/files/files.hpp"
#include "reports/tables/csv.hpp"
#include "reports/text/terminal.hpp"

namespace elastocheck::reports {
namespace {

using compare::Channel;

// The derivatives beside the curves: positions and angles per unit of the parameter.
void write_rates(const Model& model, const std::vector<Channel>& asked, const SolveRequest& request) {
    std::vector<Channel> channels;
    std::ranges::copy_if(asked, std::back_inserter(channels), &Channel::kinematic);
    if (channels.empty())
        throw std::invalid_argument("--rates: of positions and angles only, and --channels has none");
    FileToBe csv(request.rates, rates_file);
    csv.add(rates_header(channels));
    const auto& [leg, how, refine, every, account] = request.gait;
    for (const auto& branch : model.branches)
        for (const auto& way : compare::ways_of(model, branch, how.steps)) {
            const auto path = recursive::series::follow(way.model, way.branch,
                                                        std::get<recursive::Series>(how.method.kind));
            for (const double a : compare::asked_for({way}, every)) {
                const auto place = recursive::series::find(path, a);
                if (!place) break;
                csv.add(rates_row(way.name, compare::unit_of(branch.unit), a,
                                  compare::channel_rates(way.model, channels, way.branch, path, *place)));
            }
        }
    csv.finish();
}

// What bushings, springs and links bear, and what costs as much as a step of a leg, is written where it is asked for by
// name.
std::vector<Channel> asked_for(const Model& model, const std::vector<std::string>& patterns) {
    auto all = compare::channels(model);
    if (patterns.empty()) return all;
    std::ranges::move(compare::characteristics(model), std::back_inserter(all));
    std::ranges::move(compare::element_channels(model), std::back_inserter(all));
    return chosen(all, patterns);
}

}  // namespace

std::vector<Channel> chosen(const std::vector<Channel>& all, const std::vector<std::string>& patterns) {
    if (patterns.empty()) return all;
    std::vector<Channel> list;
    std::vector<std::string> names;
    for (const auto& channel : all) names.push_back(channel.name);
    for (const auto& pattern : patterns) {
        bool fits = false;
        for (const auto& channel : all) {
            if (channel.name != pattern && ::fnmatch(pattern.c_str(), channel.name.c_str(), 0) != 0) continue;
            fits = true;
            if (compare::find_channel(list, channel.name) < 0) list.push_back(channel);
        }
        if (!fits)
            throw std::invalid_argument(fmt::format("--channels: no output is called {}{}",
                                                    reader::quote(pattern),
                                                    reader::did_you_mean(pattern, names, "outputs")));
    }
    return list;
}

int solve(const std::string& file, const Settings& settings, const SolveRequest& request,
          const Delivery& delivery) {
    const auto& [leg, how, refine, every, account] = request.gait;
    if (!delivery.folder.empty()) check_may_write(delivery.folder, curves_file);
    if (!request.rates.empty()) check_may_write(request.rates, rates_file);
    if (!request.states.empty()) check_may_write(request.states, states_file);
    const LoadedScene loaded = load_scene(file, settings, request.detail);
    const Model& model = loaded.model;
    const auto channels = asked_for(model, request.channels);
    check_every(model, how.steps, every);
    if (delivery.as_json)
        check_memory(model, {.steps = how.steps, .every = every, .written = true});
    else
        check_memory_of_rows(model, {.steps = how.steps, .every = every}, channels.size());
    if (!request.rates.empty()) write_rates(model, channels, request);

    std::optional<FileToBe> csv;
    if (!delivery.folder.empty()) csv.emplace(delivery.folder, curves_file);
    std::optional<FileToBe> states;
    if (!request.states.empty()) states.emplace(request.states, states_file);
    const auto write = [&](const std::string& lines) { csv ? csv->add(lines) : delivery.say(lines); };
    std::vector<compare::Walked> kept;  // for the document alone
    write(curves_header(channels));
    int code = fine;
    const std::string who = leg == compare::Leg::recursive ? std::string(how.method.name) : name(leg);
    const auto promise = leg == compare::Leg::recursive
                             ? compare::promised(how.method, recursive::diagnose(model).length)
                             : std::nullopt;
    compare::Gait gait = request.gait;
    gait.account = account || promise;
    for (const auto& branch : model.branches) {
        compare::BranchAccount said{promise};
        if (csv) progress(branch.name);
        const auto ways = compare::ways_of(model, branch, how.steps);
        compare::Analyses analyses;
        compare::Walked whole;
        whole.curve.unit = compare::unit_of(branch.unit);
        const EquilibriumPath path = compare::walk(
            ways, gait,
            [&](const Equilibrium& state) {
                if (gait.account) add(said, state);
                if (states) states->add(state_line(model, branch.name, state));
                return compare::row_of(model, channels, ways.front(), request.gait, state, analyses);
            },
            [&](const compare::Row& row) {
                if (delivery.as_json) {
                    append(whole.curve, row.load, row.values);
                    whole.constraint_error.push_back(row.constraint_error);
                }
                write(curves_row(branch.name, leg, compare::unit_of(branch.unit), row));
            });
        if (csv) progress("");
        if (delivery.as_json) {
            whole.outcome = path.outcome, whole.detail = path.detail, whole.counts = path.counts;
            kept.push_back(std::move(whole));
        }
        for (const auto& line : told(said, branch.unit)) complain("{}: {}: {}\n", who, branch.name, line);
        if (path.outcome == Outcome::converged) continue;
        complain("{}: {}: {}\n", who, name(path.outcome), path.detail);
        code = could_not_judge;
    }
    if (csv) csv->finish();
    if (states) states->finish();
    if (delivery.as_json) {
        nlohmann::ordered_json part =
            scene_document(loaded.scene, read_whole(file), model, recursive::diagnose(model));
        if (loaded.trim) add_trim(part, *loaded.trim);
        add_curves(part, model, channels, leg,
                   leg == compare::Leg::recursive ? std::string(how.method.name) : "", kept);
        deliver({.as_json = true, .command = delivery.command}, std::move(part), {});
    }
    return code;
}

}  // namespace elastocheck::reports
