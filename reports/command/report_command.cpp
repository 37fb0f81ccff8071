// `elastocheck report`: the results of all other commands as an HTML page.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

#include "compare/comparison/compare.hpp"
#include "compare/design/figures.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/loads/loads.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/studies/formulations.hpp"
#include "compare/studies/solves.hpp"
#include "compare/studies/study.hpp"
#include "compare/studies/work_precision.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/live/live_page.hpp"
#include "reports/command/options/candidate_options.hpp"
#include "reports/command/options/gradients_of.hpp"
#include "reports/command/options/limits.hpp"
#include "reports/command/options/load_cases.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/options/running.hpp"
#include "reports/command/program/command.hpp"
#include "reports/document/document.hpp"
#include "reports/document/inspection.hpp"
#include "reports/files/files.hpp"
#include "reports/files/folder.hpp"
#include "reports/files/terminal.hpp"
#include "reports/given/candidate_file.hpp"
#include "reports/page/common.hpp"
#include "reports/page/report/report.hpp"
#include "reports/tables/candidate_tables.hpp"
#include "reports/tables/judgement.hpp"
#include "reports/text/escape.hpp"
#include "reports/text/words.hpp"

namespace elastocheck::reports {
namespace {

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

bool succeeds(const std::string& line) { return std::system(line.c_str()) == 0; }

bool exists(const std::string& command) {
    const std::string program = command.substr(0, command.find(' '));
    return !program.empty() && succeeds("command -v " + for_shell(program) + " >/dev/null 2>&1");
}

// Command of a browser: the first of the colon-separated list $BROWSER whose program exists, else
// xdg-open. Throws std::invalid_argument without a browser, and where CI is set.
std::string browser() {
    if (const std::string ci = environment("CI"); !ci.empty() && ci != "false" && ci != "0")
        throw std::invalid_argument("--open: not in CI (variable CI is set)");
    std::istringstream list(environment("BROWSER"));
    for (std::string command; std::getline(list, command, ':');)
        if (exists(command)) return command;
    if (exists("xdg-open")) return "xdg-open";
    throw std::invalid_argument(
        "--open: there is nothing to open a page with: $BROWSER names no program, and xdg-open (of "
        "xdg-utils) is not there");
}

// Runs the browser's command in a shell with the page in place of %s, or at the end, and waits for it.
// Throws std::invalid_argument where it fails.
void open_in(const std::string& browser, const std::string& page) {
    const std::string address = for_shell(std::filesystem::absolute(page).string());
    std::string line = browser;
    if (const auto at = line.find("%s"); at != line.npos)
        line.replace(at, 2, address);
    else
        line += " " + address;
    // Its output goes to standard error: standard output may be a document.
    if (!succeeds(line + " >&2"))
        throw std::invalid_argument(
            fmt::format("--open: {} failed; the page is {}", browser, page));
}

using json = nlohmann::ordered_json;

constexpr const char* report_schema = "elastocheck/report/1";

struct ReportRequest {
    std::vector<std::string> scenes;
    Settings settings;
    std::string folder;
    std::string measured;        // CSV
    std::string loads;           // CSV of load cases
    CandidateRequest candidate;  // external solver, for one scene
    std::string tolerance = "0.01mm,0.001deg,1%";
    std::vector<std::string> branches;  // the others are left out
    std::string only;                   // kc, evidence; empty: both
    bool quick = false;
    Running running;
    bool against = false;  // compare the second of two scenes with the first
    bool as_json = false;  // write the answers as a document to standard output
    bool live = false;     // live.html beside the page
    bool open = false;     // open the finished page in a browser

    bool has_tolerance() const { return tolerance != ReportRequest{}.tolerance; }
};

// Error of the recommended configuration over each branch; empty without a recommendation.
std::optional<Recommended> recommended(compare::Solves& solves, const compare::Trade& trade) {
    if (!trade.recommendation) return std::nullopt;
    Recommended result{trade.points[trade.recommendation->point], {}};
    for (std::size_t b = 0; b < solves.sides.size(); ++b)
        result.branches.emplace_back(solves.model.branches[b].name,
                                     compare::profile(solves, b, result.configuration));
    return result;
}

void add_measured(SceneAnalyses& scene, const Measurement& measurement) {
    scene.measured =
        compare_measurement(scene.model, scene.comparison,
                            compare::defined_curves(scene.model, scene.comparison), measurement);
    for (const auto& what : scene.measured->left_out)
        print_error("{}: left out: {}\n", measurement.file, what);
    for (const auto& finding : scene.measured->found.explanations)
        print_error("{}: {}\n", measurement.file, finding);
    if (scene.measured->found.compared == 0)
        scene.reasons.push_back(
            fmt::format("no point of {} is within the range of the legs", measurement.file));
}

// Leaves only the branches of --branch, in the order of the scene.
void select_branches(Scene& scene, Model& model, const std::vector<std::string>& names) {
    if (names.empty()) return;
    const auto left_out = [&](const Branch& branch) {
        return std::ranges::find(names, branch.name) == names.end();
    };
    std::erase_if(scene.branches, left_out);
    std::erase_if(model.branches, left_out);
}

// Stride of the points at which the spread over formulations is computed.
int stride_of_spread(const Model& model) {
    constexpr int min_points = 10;  // of a branch
    int every = std::numeric_limits<int>::max();
    for (const auto& branch : model.branches) every = std::min(every, branch.steps / min_points);
    return std::max(1, every);
}

// Adds the studies of the recursion's error and cost. They share their solves: the numbers of steps are
// base · 2^k, k up to 6.
void add_studies(SceneAnalyses& scene, const compare::Tolerance& tolerance, int threads,
                 const compare::Progress& progress_of_scene) {
    constexpr int base = 10, finest = 4;
    compare::Solves solves(scene.model, base, finest);
    const auto part = [&](double from, double to) {
        return compare::part(progress_of_scene, from, to);
    };
    compare::StudyOptions study_options{.methods = {},
                                        .steps = {40, 80, 160, 320, 640},
                                        .threads = threads,
                                        .progress = part(0, 0.5)};
    for (const auto& method : recursive::methods)
        if (recursive::has_steps(method)) study_options.methods.push_back(method);
    scene.study = compare::study(solves, study_options);
    // The cost is counted, so that the report is the same in every run; `trade` also measures times.
    scene.trade = compare::trade(solves, {.tolerance = tolerance,
                                          .points = base,
                                          .rounds = 0,
                                          .threads = threads,
                                          .progress = part(0.5, 1)});
    scene.recommended = recommended(solves, *scene.trade);
}

// Figures of which the effects are shown: rates of the first wheel at the design position, its toe and
// camber at the ends of the leading branch; without a wheel the first main outputs there.
struct KeyOutputs {
    std::vector<compare::Channel> at_design, at_ends;
};
KeyOutputs key_outputs(const Model& model) {
    KeyOutputs key;
    const auto outputs = compare::figure_outputs(model);
    // of the first wheel, or of the axle
    const auto is_first = [&](const compare::Channel& channel) {
        const std::string_view figure = compare::without_owner(channel.name);
        return channel.name.size() == figure.size() ||
               channel.name == model.wheels.front().name + "." + std::string(figure);
    };
    for (const auto& channel : outputs) {
        if (model.wheels.empty() || !is_first(channel)) continue;
        const compare::Entry* entry = compare::find_entry(channel.name);
        if (entry != nullptr && entry->properties.explained) key.at_design.push_back(channel);
        if (entry != nullptr && entry->properties.is_main && entry->unit == compare::Unit::deg)
            key.at_ends.push_back(channel);
    }
    constexpr std::size_t without_wheel = 3;
    for (const auto& channel : outputs)
        if (model.wheels.empty() && channel.main && key.at_ends.size() < without_wheel)
            key.at_ends.push_back(channel);
    return key;
}

// Effects of the numbers of the scene on the key figures along the leading sweep. Where they are not
// confirmed, their section says so; the verdict is on the curves and rates.
void add_effects(SceneAnalyses& scene, const LoadedScene& loaded, const std::string& file,
                 const Settings& settings, int threads) {
    const auto sweep = leading_sweep(scene);
    if (!sweep) return;
    std::vector<std::string> branches;
    for (const auto& branch : sweep->branches) branches.push_back(branch.name());
    const KeyOutputs key = key_outputs(scene.model);
    // Numbers of the suspension alone, without those of loads, branches, trim and vehicle.
    const auto varying = compare::varying(file, settings, [](const std::string& path) {
        return std::ranges::none_of(std::array{"loads.", "branches.", "trim.", "vehicle."},
                                    [&](const char* group) { return path.starts_with(group); });
    });
    // A characteristic costs several times as much as an angle, and is shown at one station.
    std::vector<compare::GradientGroup> groups;
    const compare::GradientOptions options{.points = 1, .branches = branches, .threads = threads};
    if (!key.at_design.empty()) {
        groups.push_back({key.at_design, options});
        groups.back().options.branches = {branches.front()};
        groups.back().options.stations[branches.front()] = {0};
    }
    if (!key.at_ends.empty()) groups.push_back({key.at_ends, options});
    if (groups.empty()) return;
    Effects effects;
    const auto all = gradients_of(file, settings, loaded, varying, groups);
    for (std::size_t k = 0; k < all.size(); ++k) {
        const auto& group = all[k];
        const bool of_design = !groups[k].options.stations.empty();
        for (auto& row : compare::effect_rows(group))
            if ((row.at == 0) == of_design) effects.rows.push_back(std::move(row));
        for (const auto& side : group.sides) {
            effects.difference = std::max(effects.difference, side.worst.whole);
            effects.compared += side.worst.compared;
            std::ranges::move(side.not_confirmed(), std::back_inserter(effects.reasons));
        }
    }
    if (effects.rows.empty()) return;
    if (effects.compared == 0) effects.reasons.emplace_back("no derivative was compared");
    for (const auto& why : effects.reasons)
        print_error("{}: effects of the numbers are not confirmed: {}\n", file, why);
    scene.effects = std::move(effects);
}

void add_candidates(SceneAnalyses& scene, const LoadedScene& loaded,
                    const std::vector<CandidateOutput>& outputs, const ReportRequest& request,
                    const compare::Tolerance& tolerance) {
    for (const auto& output : outputs) {
        auto judgement = judged(output, request.candidate, loaded, scene.comparison, tolerance,
                                request.has_tolerance());
        std::string verdict = result_of(judgement, scene.comparison).verdict.sentence;
        scene.candidates.push_back({std::move(judgement), std::move(verdict)});
    }
}

SceneAnalyses solve_scene(const std::string& file, const ReportRequest& request, int threads,
                          const compare::Progress& progress_of_scene) {
    LoadedScene loaded = load_scene(file, request.settings);
    for (const auto& name : request.branches) (void)branch_named(loaded.model, name);
    Measurement measurement;  // read with the branches of all its tests
    if (!request.measured.empty())
        measurement =
            read_measurement(read_whole(request.measured, largest_measurement), request.measured,
                             loaded.model, map_of(request.candidate), request.branches);
    select_branches(loaded.scene, loaded.model, request.branches);
    const auto outputs = outputs_of(request.candidate, file, {steps_of(loaded.model)});
    check_tables(outputs, request.candidate, loaded);
    std::vector<compare::LoadCase> cases;
    if (!request.loads.empty())
        cases = read_load_cases(read_whole(request.loads), request.loads, loaded.scene);
    const Scene with_cases = compare::with_cases(loaded.scene, cases);
    SceneAnalyses scene = analyses_of(loaded, file);
    scene.only = request.only;
    scene.quick = request.quick;
    const Model& model = scene.model;
    scene.inspected = inspection({scene.scene, model, scene.trim});
    const bool studies = !request.quick && request.only != "kc";

    const double after_legs = studies ? 0.25 : 1;
    compare::Options options;
    options.times = false;
    options.threads = threads;
    options.prove_ends_only = request.quick;
    options.progress = compare::part(progress_of_scene, 0, after_legs);
    add_comparison(scene, compare::compare(model, options, loaded.definitions));
    if (!request.measured.empty()) add_measured(scene, measurement);
    if (!cases.empty())
        scene.loads = result_of(compare::pickup_loads(compile(with_cases, Detail::everything)));
    if (!request.quick && request.only != "evidence")
        add_effects(scene, loaded, file, request.settings, threads);
    const auto tolerance =
        compare::parse_tolerance(request.tolerance, compare::ToleranceParts::with_shares);
    if (studies) {
        if (std::ranges::any_of(scene.scene.elastics, compare::is_reformulated))
            scene.formulations =
                compare::formulation_study(scene.scene, 0, stride_of_spread(model), threads,
                                           compare::part(progress_of_scene, after_legs, 0.35));
        add_studies(scene, tolerance, threads, compare::part(progress_of_scene, 0.35, 1));
    }
    add_candidates(scene, loaded, outputs, request, tolerance);
    scene.judgement = compare::assess(model, scene.comparison, tolerance, request.has_tolerance());
    if (!scene.conclusive()) {
        scene.judgement->verdict = compare::Grade::not_judged;
        scene.judgement->reasons = scene.reasons;
    }
    return scene;
}

// Answer of each scene, and whether it passes.
json answer_document(const Report& report, const std::vector<Answer>& answers,
                     const std::string& page) {
    json scenes = json::array();
    for (const auto& answer : answers) {
        const SceneAnalyses& scene = report.scenes[scenes.size()];
        scenes.push_back({{"name", answer.name},
                          {"source", answer.source},
                          {"mark", answer.mark},
                          {"answer", answer.sentence}});
        add_verdict(scenes.back(), scene.comparison.compared, scene.reasons);
    }
    const json head = report_json({report.reproduce, report.provenance, {}});
    return {{"schema", report_schema},
            {"provenance", head["provenance"]},
            {"page", page},
            {"scenes", scenes}};
}

std::string answer_text(const std::vector<Answer>& answers, const std::string& page,
                        double seconds) {
    std::string text;
    for (const auto& answer : answers)
        if (!answer.sentence.empty())
            text += fmt::format("{}: {}\n\n", answer.name, answer.sentence);
    for (const auto& answer : answers) text += fmt::format("{}: {}\n", answer.source, answer.mark);
    return text + fmt::format("The page: {} ({}, {:.1f} s)\n", page,
                              counted(answers.size(), "scene"), seconds);
}

// Returns the exit code. `reproduce` is the command line as given.
int write(const ReportRequest& request, const std::string& reproduce) {
    if (request.scenes.empty()) throw std::invalid_argument("report: needs scene files");
    if (!request.measured.empty() && request.scenes.size() != 1)
        throw std::invalid_argument("report: --measured belongs to one scene; give one");
    if (!request.loads.empty() && request.scenes.size() != 1)
        throw std::invalid_argument("report: --loads belongs to one scene; give one");
    if (!request.measured.empty() && request.candidate.wanted() && !request.candidate.map.empty())
        throw std::invalid_argument(
            "report: --map: is of --candidate or of --measured; give one of them");
    if (request.candidate.wanted() && request.scenes.size() != 1)
        throw std::invalid_argument("report: --candidate belongs to one scene; give one");
    if (request.against && request.scenes.size() != 2)
        throw std::invalid_argument("report: --against: needs two scenes, the base first");
    CandidateRequest candidate = request.candidate;
    if (!request.measured.empty()) candidate.map.clear();  // it is of the measurement
    check(candidate, request.settings);
    const auto start = std::chrono::steady_clock::now();
    const int threads = threads_of(request.running);
    // Invalid requests are rejected before the work.
    if (request.live && request.scenes.size() != 1)
        throw std::invalid_argument("--live: allowed with one scene only");
    const std::string live =
        request.live ? live_page(request.scenes.front(), request.settings) : "";
    const std::string opener = request.open ? browser() : "";
    Staging::check(request.folder);
    (void)compare::parse_tolerance(request.tolerance, compare::ToleranceParts::with_shares);
    for (const auto& scene : request.scenes)
        check_memory(compile(read_scene(scene, request.settings)),
                     {.legs = static_cast<int>(compare::legs.size()), .written = true});
    (void)map_of(request.candidate);
    if (request.quick && request.only == "evidence")
        throw std::invalid_argument("report: --quick leaves out what --only evidence shows");
    Report report{reproduce, provenance(), {}};
    constexpr double solved = 0.95;  // the rest: the page
    for (std::size_t k = 0; k < request.scenes.size(); ++k) {
        const double each = solved / static_cast<double>(request.scenes.size());
        const auto of_scene = [&, at = static_cast<double>(k)](std::string_view what, double done) {
            progress(fmt::format("{}: {}", request.scenes[k], what), (at + done) * each);
        };
        report.scenes.push_back(solve_scene(request.scenes[k], request, threads, of_scene));
    }
    std::string difference;
    if (request.against) {
        report.scenes[0].against = differences(report.scenes[0], report.scenes[1]);
        difference = against_sentence(report.scenes[0].scene.source, *report.scenes[0].against);
        // Variants have no verdict on the fast method unless a tolerance is given.
        if (!request.has_tolerance())
            for (auto& scene : report.scenes) scene.judgement.reset();
    }
    const auto answers = write_report(
        report, request.folder,
        {.progress = [](std::string_view what) { progress(what, 0.95); }, .live = live});
    progress("");
    int code = fine;
    // The exit code follows the verdicts of candidates, as in `judge`, and of load cases.
    for (const auto& scene : report.scenes)
        for (const auto& [judgement, sentence] : scene.candidates) {
            print_error("{}\n", sentence);
            if (judgement.verdict == compare::Grade::fail) code = limit_broken;
            if (judgement.verdict == compare::Grade::not_judged && code == fine)
                code = could_not_judge;
        }
    for (const auto& scene : report.scenes)
        if (scene.loads && scene.loads->verdict.grade != compare::Grade::pass) {
            if (code == fine) code = could_not_judge;
            for (const auto& reason : scene.loads->verdict.reasons)
                print_error("{}: {}\n", request.loads, reason);
        }
    for (const auto& answer : answers)
        if (!answer.conclusive) {
            code = could_not_judge;
            for (const auto& reason : answer.reasons)
                print_error("{}: inconclusive: {}\n", answer.source, reason);
        }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    const std::string page = request.folder + "/report.html";
    if (request.as_json)
        print_document(answer_document(report, answers, page));
    else if (request.against)
        print("{}\nThe page: {}\n", difference, page);
    else
        print(answer_text(answers, page, elapsed.count()));
    if (request.open) open_in(opener, page);
    return code;
}

}  // namespace

const Command report_command{
    Group::pages, "report",
    "Write a report of one or more scenes as an HTML page: verdict, "
    "figures, tables",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<ReportRequest>();
        as_file(command.add_option("SCENE", request->scenes, "scene files (YAML)"));
        add_set(command, request->settings);
        as_folder(command.add_option("-o,--output", request->folder,
                                     "folder for report.html, report.md, result.json, curves.csv, "
                                     "numbers.csv, figures/"))
            ->required();
        command.add_option("--tolerance", request->tolerance,
                           "required accuracy (default: 0.01mm,0.001deg,1%)");
        as_file(command.add_option("--measured", request->measured,
                                   "CSV of measured curves, for comparison"));
        as_file(command.add_option("--loads", request->loads,
                                   "CSV of load cases, as for `loads`: the largest loads at every "
                                   "joint and element of every body, as a section"));
        command.add_option("--branch", request->branches, "only these branches of the scene");
        as_word(command.add_option("--only", request->only,
                                   "one part of the page: kinematics and compliance (without "
                                   "studies), or the evidence"),
                {"kc", "evidence"});
        command.add_flag("--quick", request->quick,
                         "without studies: the references, proved at the ends of the branches, "
                         "kinematics and compliance");
        add_running(command, request->running);
        add_candidate(command, request->candidate);
        command.add_flag("--against", request->against,
                         "of two scenes: what the second has otherwise than the first, as a "
                         "section");
        command.add_flag("--live", request->live,
                         "write live.html beside the page, which solves the scene again while its "
                         "hardpoints are moved");
        add_json(command, request->as_json);
        command.add_flag("--open", request->open, "open the page with $BROWSER or xdg-open");
        return [request](const std::string& line) { return write(*request, line); };
    }};

}  // namespace elastocheck::reports
