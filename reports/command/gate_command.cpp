// `elastocheck gate`: judges scenes by baselines, or accepts measurements as new baselines.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>

#include "compare/comparison/changes.hpp"
#include "compare/jobs/jobs.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/options/limits.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/options/running.hpp"
#include "reports/command/program/command.hpp"
#include "reports/files/files.hpp"
#include "reports/files/terminal.hpp"
#include "reports/gate/baseline.hpp"
#include "reports/gate/gate_report.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;
using compare::ToleranceClass;

struct GateOptions {
    std::vector<std::string> scenes;
    Settings settings;
    std::string folder, junit, summary, kind, reason;
    bool accept = false, as_json = false;
    Running running;
    compare::Progress progress;  // of the scene that is measured
};

bool is_set(const char* variable) {
    const char* value = std::getenv(variable);
    const std::string_view word = value == nullptr ? "" : value;
    return !word.empty() && word != "false" && word != "0";
}

bool blank(const std::string& text) {
    return text.find_first_not_of(" \t\r\n") == std::string::npos;
}

// A scene and its baseline.
struct Task {
    fs::path scene, baseline;
    std::string no_scene;  // reason why no scene is known for this baseline
};

fs::path baseline_of(const fs::path& scene, const std::string& folder) {
    return (folder.empty() ? scene.parent_path() / "baselines" : fs::path(folder)) /
           (scene.stem().string() + ".json");
}

std::vector<Task> tasks(const GateOptions& options) {
    std::vector<Task> tasks;
    for (const auto& scene : options.scenes)
        tasks.push_back({scene, baseline_of(scene, options.folder), ""});
    if (!tasks.empty()) return tasks;
    const fs::path folder = options.folder.empty() ? "baselines" : options.folder;
    std::error_code unreadable;
    const auto entries = fs::directory_iterator(folder, unreadable);
    if (unreadable && unreadable != std::errc::no_such_file_or_directory)
        throw FileError(
            fmt::format("{}: cannot be read: {}", folder.string(), unreadable.message()));
    for (const auto& entry : entries) {
        if (entry.path().extension() != ".json") continue;
        if (const std::string wrong = flaw(entry.path().filename().string()); !wrong.empty())
            throw FileError(fmt::format(
                "{}: {}; names are one line of UTF-8 text",
                (folder / for_terminal(entry.path().filename().string())).string(), wrong));
        try {
            const BaselineFile file = read_baseline(entry.path());
            tasks.push_back({(folder / file.scene_file).lexically_normal(), entry.path(), ""});
        } catch (const std::runtime_error& error) {  // BaselineError, FileError
            tasks.push_back({entry.path(), entry.path(), error.what()});
        }
    }
    std::ranges::sort(tasks, {}, &Task::baseline);
    if (tasks.empty())
        print_error(
            "elastocheck: there is no baseline in {}; name a SCENE, or the folder with "
            "--baseline\n",
            folder.string());
    return tasks;
}

// Relative path from the folder of the baseline to the scene. Throws FileError unless it is one line of UTF-8.
std::string name_beside(const Task& task) {
    // Absolute, since relative() fails for a folder that does not exist yet.
    const fs::path folder = fs::absolute(task.baseline).parent_path();
    std::string name = fs::relative(fs::absolute(task.scene), folder).generic_string();
    if (const std::string wrong = flaw(name); !wrong.empty())
        throw FileError(fmt::format("{}: {}; names are one line of UTF-8 text", name, wrong));
    return name;
}

// Measurement of a scene by this build.
BaselineFile measured(const Task& task, const GateOptions& options) {
    const LoadedScene loaded = load_scene(task.scene, options.settings);
    const Model& model = loaded.model;
    check_memory(model, {.legs = static_cast<int>(compare::legs.size())});
    compare::Options compare_options;
    compare_options.times = false;
    compare_options.threads = threads_of(options.running);
    compare_options.progress = [&](std::string_view what, double done) {
        options.progress(fmt::format("{}: {}", task.scene.filename().string(), what), done);
    };
    BaselineFile file;
    file.scene_file = name_beside(task);
    file.baseline.accepted = compare::measure(model, compare::compare(model, compare_options));
    file.input_hash = input_hash(read_whole(task.scene));
    file.numbers = loaded.scene.numbers;
    file.provenance = provenance();
    for (const auto kind : compare::tolerance_classes)
        file.baseline.tolerances[kind] = compare::default_tolerances(kind);
    return file;
}

GatedScene unjudged(const Task& task) {
    GatedScene scene;
    scene.file = task.scene.string();
    scene.baseline_file = task.baseline.string();
    return scene;
}

// Whether its folder has an entry of this name, also a dangling link.
bool has_entry(const fs::path& file) {
    std::error_code failed;
    return fs::symlink_status(file, failed).type() != fs::file_type::not_found;
}

// The accepted baseline; without one the verdict of the scene gives the reason.
std::optional<BaselineFile> accepted(const Task& task, GatedScene& scene) {
    if (!has_entry(task.baseline)) {
        scene.verdict.reasons.push_back(fmt::format(
            "there is no baseline {}; 'elastocheck gate {} --accept --reason ...' makes one",
            task.baseline.string(), task.scene.string()));
        return std::nullopt;
    }
    try {
        BaselineFile file = read_baseline(task.baseline);
        scene.accepted = file.baseline.accepted;
        scene.reason = file.baseline.reason;
        return file;
    } catch (const LimitError& error) {
        scene.bad_input = true;
        scene.verdict.reasons.emplace_back(error.what());
        return std::nullopt;
    } catch (const std::runtime_error& error) {  // BaselineError, FileError: only of this scene
        scene.verdict.reasons.emplace_back(error.what());
        return std::nullopt;
    }
}

void judge(const BaselineFile& was, const BaselineFile& is, const std::string& forced,
           GatedScene& scene) {
    const BuildDistance builds = distance(was.provenance, is.provenance);
    ToleranceClass kind = builds.kind;
    scene.class_reason = builds.differs;
    for (const auto wanted : compare::tolerance_classes)
        if (forced == name(wanted)) {
            kind = wanted;
            scene.class_reason = "--class";
        }
    scene.verdict = compare::judge(was.baseline, is.baseline.accepted, kind);
    scene.widened = compare::widened(was.baseline, kind);
    scene.changed = compare::changes(was.numbers, is.numbers);
    if (was.input_hash == is.input_hash) return;
    scene.notes.push_back(
        fmt::format("the scene file differs from the accepted one ({}, now {}){}", was.input_hash,
                    is.input_hash, scene.changed.empty() ? "; none of its numbers changed" : ""));
}

// The options for the k-th of several scenes.
GateOptions at_scene(GateOptions options, std::size_t k, std::size_t scenes) {
    const double each = 1 / static_cast<double>(scenes);
    options.progress =
        compare::part(progress, static_cast<double>(k) * each, static_cast<double>(k + 1) * each);
    return options;
}

GatedScene gate_scene(const Task& task, const GateOptions& options) {
    GatedScene scene = unjudged(task);
    if (!task.no_scene.empty()) {
        scene.verdict.reasons.push_back(task.no_scene);
        return scene;
    }
    try {
        if (const auto was = accepted(task, scene)) {
            judge(*was, measured(task, options), options.kind, scene);
            // In CI only a committed baseline counts: one made in the same run would always agree.
            for (const auto& part : {task.baseline, curves_of(task.baseline)})
                if (const std::string why = is_set("CI") ? not_committed(part) : ""; !why.empty())
                    scene.verdict.reasons.push_back(
                        fmt::format("the baseline {} is unreviewed: {}", part.string(), why));
        } else {
            // A scene that cannot be read is reported, too.
            compile(read_scene(task.scene, options.settings));
        }
    } catch (const NotTrimmed& error) {
        scene.verdict.reasons.emplace_back(error.what());
    } catch (const std::invalid_argument& error) {  // more memory than available
        scene.bad_input = true;
        scene.verdict.reasons.push_back(fmt::format("{}: {}", task.scene.string(), error.what()));
    } catch (const SceneError& error) {
        scene.bad_input = true;
        scene.verdict.reasons.emplace_back(error.what());
    }
    return scene;
}

// Prints the changes, then writes. An inconclusive result is not accepted, nor one that breaks an
// absolute limit: limits are edited by hand, where a review sees the change.
int accept_scene(const Task& task, const GateOptions& options) {
    if (!task.no_scene.empty()) {
        print_error("elastocheck: {}\n", task.no_scene);
        return could_not_judge;
    }
    GatedScene scene = unjudged(task);
    const bool there = has_entry(task.baseline);
    const auto was = accepted(task, scene);
    if (there && !was) {
        print_error(
            "elastocheck: {}\nRestore or delete it first: its tolerances and limits would be "
            "lost.\n",
            scene.verdict.reasons.front());
        return scene.bad_input ? bad_input : could_not_judge;
    }
    BaselineFile is = measured(task, options);
    const auto& now = is.baseline.accepted;
    std::vector<std::string> defects = now.inconclusive;
    for (const auto& s : now.series)
        if (!std::ranges::all_of(s.values, [](double v) { return std::isfinite(v); }))
            defects.push_back(fmt::format("branch '{}', {}: {} is not finite", s.branch,
                                          name(s.quantity), s.channel));
    if (now.series.empty()) defects.emplace_back("nothing was measured");
    if (!defects.empty()) {
        print_error("elastocheck: {}: not accepted: {}\n", scene.file, fmt::join(defects, "; "));
        return could_not_judge;
    }
    is.baseline.reason = options.reason;
    if (!was) {
        print("{}: new baseline, {} curves and counters\n", scene.file, now.series.size());
    } else {
        // The tolerances of the old baseline, and default ones for what it does not define.
        auto& tolerances = is.baseline.tolerances;
        for (auto& [kind, usual] : tolerances)
            if (const auto own = was->baseline.tolerances.find(kind);
                own != was->baseline.tolerances.end()) {
                auto kept = own->second;
                kept.insert(usual.begin(), usual.end());
                usual = std::move(kept);
            }
        is.baseline.limits = was->baseline.limits;
        judge(*was, is, name(ToleranceClass::same_build), scene);
        scene.class_reason = "every change beyond rounding";
        print(gate_table(scene));
        const bool over = std::ranges::any_of(scene.verdict.offences, &compare::Offence::of_limit);
        if (over) {
            print(
                "{}: not accepted: an absolute limit is broken; limits are changed by hand, in "
                "{}\n",
                scene.file, task.baseline.string());
            return limit_broken;
        }
        const auto text_without_reason = [](BaselineFile file) {
            file.baseline.reason.clear();
            file.provenance = {};
            return baseline_text(file).review;  // with the hash of the curves
        };
        if (text_without_reason(*was) == text_without_reason(is) && !blank(was->baseline.reason)) {
            print("{}: left as it is\n", task.baseline.string());
            return fine;
        }
    }
    write_baseline(task.baseline, is);
    print("{}: written\n", task.baseline.string());
    return fine;
}

int accept(const GateOptions& options) {
    if (is_set("CI"))
        throw std::invalid_argument(
            "--accept: not in CI (variable CI is set): a person accepts a baseline");
    if (blank(options.reason))
        throw std::invalid_argument("--accept: needs --reason, a text for the reviewer");
    if (options.as_json) throw std::invalid_argument("--accept: not with --json");
    if (!options.settings.empty()) throw std::invalid_argument("--accept: not with --set");
    int code = fine;
    const auto all = tasks(options);
    for (std::size_t k = 0; k < all.size(); ++k) {
        const int of_scene = accept_scene(all[k], at_scene(options, k, all.size()));
        if (code == fine || of_scene == limit_broken) code = of_scene;
    }
    return all.empty() ? could_not_judge : code;
}

int gate(const GateOptions& options) {
    if (options.accept) return accept(options);
    const Delivery delivery{.as_json = options.as_json};
    if (!options.reason.empty()) throw std::invalid_argument("--reason: only with --accept");
    // GitHub's file exists already, and other steps write to it too.
    const char* given = std::getenv("GITHUB_STEP_SUMMARY");
    const bool to_append = given != nullptr && !options.summary.empty() && options.summary == given;
    if (!options.junit.empty()) check_may_write(options.junit, junit_file);
    if (!options.summary.empty() && !to_append) check_may_write(options.summary, summary_file);
    std::vector<GatedScene> scenes;
    const auto all = tasks(options);
    for (std::size_t k = 0; k < all.size(); ++k) {
        scenes.push_back(gate_scene(all[k], at_scene(options, k, all.size())));
        delivery.print_text(gate_table(scenes.back()));
    }
    delivery.print_text(gate_conclusion(scenes) + "\n");
    if (options.as_json) print_document(gate_document(scenes, provenance()));
    // GitHub reads them from either stream.
    if (is_set("GITHUB_ACTIONS"))
        options.as_json ? print_error(annotations(scenes)) : print(annotations(scenes));
    if (!options.junit.empty()) write_whole(options.junit, junit(scenes), junit_file);
    if (to_append)
        append(options.summary, step_summary(scenes));
    else if (!options.summary.empty())
        write_whole(options.summary, step_summary(scenes), summary_file);
    return exit_code(scenes);
}

}  // namespace

const Command gate_command{
    Group::compare, "gate", "Regression test of scenes against their accepted baselines, for CI",
    [](CLI::App& command) -> Run {
        const auto options = std::make_shared<GateOptions>();
        std::vector<std::string> kinds;
        for (const auto kind : compare::tolerance_classes) kinds.emplace_back(name(kind));
        as_file(command.add_option("SCENE", options->scenes,
                                   "scene files (default: every scene of the baselines)"));
        add_set(command, options->settings);
        as_folder(command.add_option(
            "--baseline", options->folder,
            "folder of the baselines (default: baselines/ beside each SCENE, or here)"));
        as_file(command.add_option("--junit", options->junit, "write JUnit XML to this file"));
        as_file(command.add_option(
            "--summary", options->summary,
            "write a Markdown summary to this file; added to $GITHUB_STEP_SUMMARY"));
        as_word(command.add_option("--class", options->kind,
                                   "tolerances: same-build, cross-build or physical (default: by "
                                   "how the builds differ)"),
                kinds);
        add_json(command, options->as_json);
        add_running(command, options->running);
        command.add_flag("--accept", options->accept,
                         "print the changes and write the new baseline");
        command.add_option("--reason", options->reason,
                           "reason of the change, required with --accept");
        return [options](const std::string&) { return gate(*options); };
    }};

}  // namespace elastocheck::reports
