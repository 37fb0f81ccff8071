// `elastocheck import`: converts a model of another program to a scene. `elastocheck export`: the
// reverse.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "compare/comparison/legs.hpp"
#include "compare/studies/formulations.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "models/import/export/export_adm.hpp"
#include "models/import/export/export_chrono.hpp"
#include "models/import/import.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/grammar/command.hpp"
#include "reports/command/grammar/exit_code.hpp"
#include "reports/files/files.hpp"
#include "reports/files/terminal.hpp"

namespace elastocheck::reports {
namespace {

constexpr const char* import_schema = "elastocheck/import/1";

struct ImportRequest {
    std::string file;
    std::string output;  // empty: standard output
    std::string wheel, axes;
    std::vector<std::string> drop;
    bool allow_missing = false;
    bool as_json = false;
};
struct ExportRequest {
    std::string scene, format = "adm";
    std::string output;       // empty: standard output
    std::string formulation;  // "adams", "chrono": bushings are converted; empty: as they are
    bool allow_missing = false;
    std::vector<Setting> settings;
};

constexpr FileKind scene_file{"scene made by import", "# Imported from "};
constexpr FileKind dataset_file{"dataset made by export", "Exported model name:"};
constexpr FileKind suspension_file{"suspension made by export", "// Exported by elastocheck"};

constexpr int steps_of_conversion = 20;  // of each branch, for the effect of a conversion
constexpr double least_told = 1e-9;      // [mm], [deg]: smaller differences are rounding

importer::Options options(const ImportRequest& request) {
    return {.wheel = request.wheel,
            .drop_dynamics = !request.drop.empty(),
            .allow_missing = request.allow_missing,
            .axes = request.axes};
}

// Largest distance of the outputs of two scenes, of each unit: "0.0123 mm ('wheel_y' on branch
// 'jounce' at 3000 N) and 0.004 deg (...)".
std::string apart(const compare::FormulationStudy& study) {
    struct Worst {
        compare::Unit unit;
        double by;
        std::string where;
    };
    std::vector<Worst> list;
    for (const auto& branch : study.branches)
        for (const auto& output : branch.outputs) {
            const auto& channel = study.channels[output.channel];
            auto same = std::ranges::find(list, channel.unit, &Worst::unit);
            if (same == list.end()) same = list.insert(list.end(), {channel.unit, -1, {}});
            if (output.spread > same->by) {
                same->by = output.spread;
                same->where = fmt::format("{} on branch '{}' at {:.6g} {}", channel.name,
                                          branch.branch, output.at, compare::symbol(branch.unit));
            }
        }
    std::string text;
    for (const auto& [unit, by, where] : list) {
        text += text.empty() ? "" : " and ";
        text += by < least_told
                    ? fmt::format("less than {:g} {}", least_told, compare::symbol(unit))
                    : fmt::format("{:.2g} {} ({})", by, compare::symbol(unit), where);
    }
    return text;
}

// Converts all bushings to the formulation of the other program, and adds a warning with the change
// of the outputs by the equilibrium leg. False where that change could not be computed.
bool convert(Scene& scene, const std::string& target, importer::Notes& notes) {
    const auto conversion = compare::converted(
        scene, target == "chrono" ? importer::chrono_bushing : importer::adams_bushing);
    if (conversion.bushings.empty()) return true;
    const auto study = compare::spread_among({{"as written", scene}, {target, conversion.scene}},
                                             steps_of_conversion, 1, 1, progress);
    progress("");
    scene = conversion.scene;
    std::string effect = apart(study);
    if (!effect.empty())
        effect = "the outputs change by up to " + effect + ", by the equilibrium leg";
    for (const auto& why : study.inconclusive)
        effect += fmt::format("{}the change of the outputs is unknown: {}",
                              effect.empty() ? "" : "; ", why);
    notes.warn({0, fmt::format("elements {}", fmt::join(conversion.bushings, ", "))},
               fmt::format("converted to the bushing formulation of {}: {}", target, effect));
    return study.conclusive();
}

constexpr std::size_t most_bodies_settled = 200;

// Message whether the first branch can begin: whether an equilibrium is found at a = 0, and its
// distance from the design position. Empty for a scene without a branch or with too many bodies.
std::string settling(const std::string& yaml) {
    try {
        const Model model = compile(parse_scene(yaml, "scene"));
        if (model.branches.empty() || model.bodies.size() > most_bodies_settled) return "";
        Branch branch = model.branches.front();
        branch.from = 0;
        branch.to *= 1e-6;
        branch.steps = 1;
        const auto path =
            compare::walk(compare::sides_of(model, branch, 1), {.leg = compare::Leg::equilibrium});
        if (path.points.empty())
            return fmt::format(
                "The drawn position does NOT settle, so that no branch starts: {}: {}.",
                name(path.outcome), path.detail);
        double moved = 0, turned = 0;
        for (std::size_t k = 0; k < model.bodies.size(); ++k) {
            const Pose &drawn = model.bodies[k].design, &rest = path.points.front().poses[k];
            moved = std::max(moved, (rest.r - drawn.r).norm());
            turned = std::max(turned, rest.p.angularDistance(drawn.p));
        }
        return fmt::format(
            "The drawn position settles: bodies move by up to {:.3g} mm and {:.3g} deg.",
            1e3 * moved, turned * 180 / std::numbers::pi);
    } catch (const SceneError&) {
        return "";  // a scene of hardpoints alone is incomplete
    }
}

int import(const ImportRequest& request) {
    if (!request.output.empty()) check_may_write(request.output, scene_file);
    importer::Imported result = importer::import_file(request.file, options(request));
    auto lines = importer::described(result.notes);
    if (const std::string line = settling(result.yaml); !line.empty()) {
        lines.push_back(line);
        result.yaml.insert(result.yaml.find("\nelastocheck: 1"), importer::commented(line));
    }
    if (!request.output.empty()) write_whole(request.output, result.yaml, scene_file);
    if (request.as_json) {
        print_document({{"schema", import_schema},
                        {"files",
                         {{{"file", request.file},
                           {"bodies", result.bodies},
                           {"joints", result.joints},
                           {"elements", result.elements},
                           {"notes", lines},
                           {"missing", result.notes.missing.size()},
                           {"text", result.yaml}}}}});
        return fine;
    }
    if (request.output.empty()) {
        print("{}", result.yaml);
        for (const auto& line : lines)
            if (line.starts_with("Warning") || line.starts_with("MISSING") ||
                line.find("NOT settle") != line.npos)
                print_error("elastocheck: {}\n", line);
        return fine;
    }
    for (const auto& line : lines) print("{}\n", line);
    print("{}: {} bodies, {} joints, {} elements\n", request.output, result.bodies, result.joints,
          result.elements);
    return fine;
}

int export_scene(const ExportRequest& request) {
    const bool chrono = request.format == "chrono";
    if (!request.formulation.empty() && (request.formulation == "chrono") != chrono)
        throw std::invalid_argument(fmt::format("--formulation {}: not of --format {}; allowed: {}",
                                                request.formulation, request.format,
                                                chrono ? "chrono" : "adams"));
    if (!request.output.empty())
        check_may_write(request.output, chrono ? suspension_file : dataset_file);
    Scene scene = compare::trim(read_scene(request.scene, request.settings)).scene;
    importer::Notes notes;
    const bool is_known = request.formulation.empty() || convert(scene, request.formulation, notes);
    const importer::Exported result =
        chrono ? importer::export_chrono(scene, request.allow_missing, notes)
               : importer::export_adm(scene, request.allow_missing, notes);
    if (request.output.empty())
        print("{}", result.text);
    else
        write_whole(request.output, result.text, chrono ? suspension_file : dataset_file);
    for (const auto& line : importer::described(result.notes))
        if (line.starts_with("Warning") || line.starts_with("MISSING"))
            print_error("elastocheck: {}\n", line);
    return is_known ? fine : could_not_judge;
}

}  // namespace

Command import_command() {
    const auto request = std::make_shared<ImportRequest>();
    return {
        "import",
        "Import a model of another program as a scene: ADAMS .adm, Chrono::Vehicle .json, "
        "hardpoints "
        ".sub",
        {{"FILE", Text{&request->file, a_file("*")}, "the model (.adm, .json, .sub)", true},
         {"-o,--output", Text{&request->output, a_file("*.yaml")}, "write the scene to this file"},
         {"--wheel", Text{&request->wheel},
          "name or id of the wheel carrier part, or of a marker at the wheel centre (.adm)"},
         {"--drop", TextList{&request->drop, TextList::Form::separate, one_of({"dynamics"})},
          "dynamics: leave out dampers and friction"},
         {"--axes",
          Text{&request->axes, one_of({importer::axes_of_tables[0], importer::axes_of_tables[1],
                                       importer::axes_of_tables[2], importer::axes_of_tables[3]})},
          "axes of a table of hardpoints (.sub), turned to ISO 8855: x-rearward,y-right (default)"},
         {"--allow-missing", Flag{&request->allow_missing},
          "warn about what a scene cannot represent instead of rejecting the file"},
         json_option(request->as_json)},
        [request](const std::string&) { return import(*request); }};
}

Command export_command() {
    const auto request = std::make_shared<ExportRequest>();
    return {"export",
            "Export the trimmed scene as a model of ADAMS or Chrono",
            {scene_option(request->scene),
             {"--format", Text{&request->format, one_of({"adm", "chrono"})},
              "adm (default): an ADAMS dataset; chrono: a suspension of Chrono::Vehicle (JSON)"},
             {"-o,--output", Text{&request->output, a_file("*.adm *.json")},
              "write the model to this file"},
             {"--formulation", Text{&request->formulation, one_of({"adams", "chrono"})},
              "adams or chrono, as the format: convert the bushings to that program's formulation "
              "and report the change of the outputs"},
             {"--allow-missing", Flag{&request->allow_missing},
              "warn about elements that the other program does not have instead of rejecting the "
              "scene"},
             set_option(request->settings)},
            [request](const std::string&) { return export_scene(*request); }};
}

}  // namespace elastocheck::reports
