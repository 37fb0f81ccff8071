// `elastocheck import` converts a model of another program to a scene; `export` is the reverse.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
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
#include "models/kinds.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/program/command.hpp"
#include "reports/files/files.hpp"
#include "reports/files/terminal.hpp"
#include "reports/tables/blocks.hpp"
#include "reports/tables/maps.hpp"

namespace elastocheck::reports {
namespace {

constexpr const char* import_schema = "elastocheck/import/1";

struct ImportRequest {
    std::string file;
    std::string output;  // empty: standard output
    importer::Options options;
    std::vector<std::string> drop;
    bool as_json = false;
};
struct ExportRequest {
    std::string scene, format = "adm";
    std::string output;       // empty: standard output
    std::string formulation;  // "adams", "chrono": bushings are converted; empty: as they are
    bool allow_missing = false;
    std::vector<Setting> settings;
    // of a map
    std::string over;                   // branch
    std::string rows;                   // "joints.rack=-50:50:11"; empty: one variable
    std::vector<std::string> channels;  // none: the main positions and angles
    std::string axes;                   // of blocks: "iso", "sae"; empty: iso
};

constexpr FileKind scene_file{"scene made by import", "# Imported from "};
constexpr FileKind dataset_file{"dataset made by export", "Exported model name:"};
constexpr FileKind lookup_file{"lookup table made by export", lookup_head};
constexpr FileKind blocks_file{"K&C blocks made by export", blocks_head};
constexpr FileKind suspension_file{"suspension made by export", "// Exported by elastocheck"};

constexpr int steps_of_conversion = 20;  // of each branch, for the effect of a conversion
constexpr double min_difference = 1e-9;  // [mm], [deg]: smaller differences are rounding

// Largest change of the outputs, for each unit: "0.0123 mm (wheel_y on branch 'jounce' at 3000 N) and
// 0.004 deg (...)".
std::string largest_changes(const compare::FormulationStudy& study) {
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
        text += by < min_difference
                    ? fmt::format("less than {:g} {}", min_difference, compare::symbol(unit))
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
    std::string effect = largest_changes(study);
    if (!effect.empty())
        effect = "the outputs change by up to " + effect + ", by the equilibrium leg";
    for (const auto& why : study.inconclusive)
        effect += fmt::format("{}the change of the outputs is unknown: {}",
                              effect.empty() ? "" : "; ", why);
    notes.warn({0, fmt::format("elements {}", fmt::join(conversion.bushings, ", "))},
               fmt::format("converted to the bushing formulation of {}: {}", target, effect));
    return study.conclusive();
}

constexpr std::size_t max_bodies_settled = 200;  // a larger scene is not settled after its import

// Message whether an equilibrium at the start of the first branch is found, and how far the bodies move
// to it from the design position. Empty for a scene without a branch or with too many bodies.
std::string settling(const std::string& yaml) {
    try {
        const Model model = compile(parse_scene(yaml, "scene"));
        if (model.branches.empty() || model.bodies.size() > max_bodies_settled) return "";
        Branch branch = model.branches.front();
        branch.from = 0;
        branch.to *= 1e-6;
        branch.steps = 1;
        const auto path = compare::solve_branch(compare::sides_of(model, branch, 1),
                                                {.leg = compare::Leg::equilibrium});
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
    importer::Options options = request.options;
    options.drop_dynamics = !request.drop.empty();
    importer::Imported result = importer::import_file(request.file, options);
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
    print("{}: {}, {}, {}\n", request.output, importer::counted(result.bodies, "body"),
          importer::counted(result.joints, "joint"), importer::counted(result.elements, "element"));
    return fine;
}

// ---- Maps.

// The second variable of a map (--rows).
struct Rows {
    std::vector<std::string> held;  // "joints.rack"; several have the same value
    std::vector<double> values;     // in the unit of the scene
};
Rows rows_of(const std::string& text) {
    const auto sides = importer::split(text, "=");
    const auto numbers = importer::split(sides.back(), ":");
    double values[3] = {NAN, NAN, NAN};
    for (std::size_t k = 0; sides.size() == 2 && numbers.size() == 3 && k < 3; ++k) {
        const char* const end = numbers[k].data() + numbers[k].size();
        if (std::from_chars(numbers[k].data(), end, values[k]).ptr != end) values[k] = NAN;
    }
    const auto [from, to, count] = values;
    Rows rows{importer::split(sides.front(), ","), {}};
    if (!std::isfinite(from) || !std::isfinite(to) || !(from < to) || !(count >= 3) ||
        !(count <= 1001) || std::fmod(count, 2) != 1 ||
        std::ranges::count(rows.held, std::string()) > 0)
        throw std::invalid_argument(fmt::format(
            "--rows {}: expected HELD=FROM:TO:COUNT, what the branch holds (names with commas are "
            "held alike), FROM below TO, an odd count from 3 to 1001",
            text));
    for (double k = 0; k < count; ++k)
        rows.values.push_back((from * (count - 1 - k) + to * k) / (count - 1));
    return rows;
}

// Unit in SI of what a driver moves.
const char* si_of(const Scene& scene, const Driver& driver) {
    const int joint = driven_joint(driver.what);
    if (joint >= 0)
        return is_angle(scene.joints[static_cast<std::size_t>(joint)].kind) ? "rad" : "m";
    const bool is_length = driven_element(driver.what) >= 0 && preload(driver.what) == nullptr;
    return is_length ? "m" : "1";
}

// The second variable in SI units; `first` and `last` are the branch with its first and its last value.
Breakpoints held_breakpoints(const Rows& rows, const Scene& scene, const Branch& first,
                             const Branch& last) {
    Breakpoints points{fmt::format("{}", fmt::join(rows.held, " ")), "", rows.values};
    points.is_travel = std::ranges::all_of(rows.held, [](const std::string& name) {
        return name == "travel" || name.ends_with(".travel");
    });
    for (std::size_t k = 0; k < first.drivers.size(); ++k) {
        const double change = last.drivers[k].start - first.drivers[k].start;
        if (change == 0) continue;
        points.unit = si_of(scene, first.drivers[k]);
        const double factor =  // from the scene's unit
            std::abs(change) / (rows.values.back() - rows.values.front());
        for (double& value : points.values) value *= factor;
        return points;
    }
    throw std::invalid_argument("--rows: no quantity held on the branch differs between its rows");
}

// The parameter of the branch, `values` in its display unit. It is a travel where it moves jacks of
// wheel centres alone, all alike.
Breakpoints branch_breakpoints(const Scene& scene, const Branch& branch,
                               std::vector<double> values) {
    const double unit = compare::in_unit(compare::unit_of(branch.unit));
    for (double& value : values) value /= unit;
    Breakpoints points{branch.name, "1", std::move(values), true};
    for (const Driver& driver : branch.drivers) {
        if (driver.rate == 0) continue;
        const int driven = driven_joint(driver.what);
        const std::string joint =
            driven < 0 ? "" : scene.joints[static_cast<std::size_t>(driven)].name;
        points.is_travel &= driver.rate == 1 && (joint == "jack" || joint.ends_with(".jack"));
    }
    points.unit = branch.unit == ParameterUnit::metre          ? "m"
                  : branch.unit == ParameterUnit::radian       ? "rad"
                  : branch.unit == ParameterUnit::newton       ? "N"
                  : branch.unit == ParameterUnit::newton_metre ? "N·m"
                                                               : "1";
    return points;
}

// Compliance at the design position, where the branch of the unchanged scene starts.
int add_compliance(const ExportRequest& request, KCBlocks& blocks) {
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const Branch& branch = branch_named(loaded.model, request.over, "--over");
    const auto sides = compare::sides_of(loaded.model, branch, 1);
    const auto path = compare::settle_start(sides.front(), compare::Leg::equilibrium);
    if (path.points.empty()) {
        print_error("no coefficients: {}: {}: {}\n", request.over, name(path.outcome), path.detail);
        return could_not_judge;
    }
    blocks.compliance = compliance_outputs(loaded.model);
    std::vector<compare::Channel> channels;
    for (const auto& output : blocks.compliance) channels.push_back(output.channel);
    blocks.coefficients = compare::row_of(loaded.model, channels, sides.front(),
                                          {.leg = compare::Leg::equilibrium}, path.points.front())
                              .values;
    return fine;
}

// Solves the branch once for each row; an output that is not defined at a point is NaN.
int export_map(const ExportRequest& request) {
    const bool blocks = request.format == "blocks";
    const FileKind& kind = blocks ? blocks_file : lookup_file;
    if (!request.output.empty()) check_may_write(request.output, kind);
    if (request.over.empty())
        throw std::invalid_argument(
            fmt::format("--format {} needs --over BRANCH, the branch whose parameter is the first "
                        "variable",
                        request.format));
    if (blocks && !request.channels.empty())
        throw std::invalid_argument("--channels: blocks have their own outputs");
    Rows rows{{}, {0}};
    if (!request.rows.empty()) rows = rows_of(request.rows);
    MapTable table;
    table.y = rows.values;
    MapAxes axes;
    KCBlocks kc;
    std::optional<Scene> first;
    const auto branch_in = [&](const Scene& scene) -> const Branch& {
        return *std::ranges::find(scene.branches, request.over, &Branch::name);
    };
    int missing = 0;
    for (const double held : rows.values) {
        auto settings = request.settings;
        for (const auto& name : rows.held)
            settings.push_back(
                setting(fmt::format("branches.{}.hold.{}", request.over, name), held));
        const LoadedScene loaded = load_scene(request.scene, settings);
        const Branch& branch = branch_named(loaded.model, request.over, "--over");
        if (blocks && !first)
            first = loaded.scene;
        else if (blocks)
            kc.y = held_breakpoints(rows, *first, branch_in(*first), branch_in(loaded.scene));
        if (table.channels.empty()) {
            table.channels = requested_channels(loaded, request.channels);
            if (blocks) {
                table.channels.clear();
                kc.outputs = block_outputs(loaded.model);
                for (const auto& output : kc.outputs) table.channels.push_back(output.channel);
                if (table.channels.empty())
                    throw std::invalid_argument("--format blocks: the scene has no wheel");
            } else if (request.channels.empty())
                std::erase_if(table.channels,
                              [](const compare::Channel& c) { return !c.main || !c.kinematic(); });
            const compare::Unit unit = compare::unit_of(branch.unit);
            axes = {loaded.model.name, fmt::format("{} [{}]", request.over, symbol(unit)),
                    rows.held.empty()
                        ? ""
                        : fmt::format("{} [as in the scene]", fmt::join(rows.held, " "))};
        }
        const auto path = compare::solve_branch(loaded.model, table.channels, branch,
                                                compare::sides_of(loaded.model, branch),
                                                {.leg = compare::Leg::equilibrium});
        if (path.outcome != Outcome::converged) {
            print_error("{}: {}: {}\n",
                        rows.held.empty()
                            ? request.over
                            : fmt::format("{} = {:g}", fmt::join(rows.held, ", "), held),
                        name(path.outcome), path.detail);
            ++missing;
        }
        auto a = path.curve.a;
        auto values = path.curve.values;
        if (a.size() > 1 && a.front() > a.back()) {
            std::ranges::reverse(a);
            std::ranges::reverse(values);
        }
        for (auto& point : values)
            for (double& value : point)
                if (!std::isfinite(value)) value = std::numeric_limits<double>::quiet_NaN();
        if (missing == 0) table.x = a;
        table.values.push_back(std::move(values));
    }
    if (missing > 0) {
        print_error("no map: {} of {} rows do not reach the end of the branch\n", missing,
                    rows.values.size());
        return could_not_judge;
    }
    std::string text;
    if (blocks) {
        if (const int failed = add_compliance(request, kc); failed != fine) return failed;
        kc.values = table.values;
        kc.scene = axes.scene;
        kc.x = branch_breakpoints(*first, branch_in(*first), table.x);
        text = blocks_csv(kc, request.axes == "sae" ? BlockAxes::sae : BlockAxes::iso);
    } else {
        text = lookup_csv(table, axes);
    }
    if (request.output.empty())
        print("{}", text);
    else
        write_whole(request.output, text, kind);
    return fine;
}

int export_scene(const ExportRequest& request) {
    const bool map = request.format == "lookup" || request.format == "blocks";
    for (const auto& [given, option] : {std::pair{!request.over.empty(), "--over"},
                                        {!request.rows.empty(), "--rows"},
                                        {!request.channels.empty(), "--channels"}})
        if (given && !map)
            throw std::invalid_argument(
                fmt::format("{}: only with --format lookup or blocks", option));
    if (!request.axes.empty() && request.format != "blocks")
        throw std::invalid_argument("--axes: only with --format blocks");
    if (map && (request.allow_missing || !request.formulation.empty()))
        throw std::invalid_argument("--allow-missing and --formulation: not of a map");
    if (map) return export_map(request);
    const bool chrono = request.format == "chrono";
    if (!request.formulation.empty() && (request.formulation == "chrono") != chrono)
        throw std::invalid_argument(fmt::format("--formulation {}: not of --format {}; allowed: {}",
                                                request.formulation, request.format,
                                                chrono ? "chrono" : "adams"));
    const FileKind& kind = chrono ? suspension_file : dataset_file;
    if (!request.output.empty()) check_may_write(request.output, kind);
    Scene scene = compare::trim(read_scene(request.scene, request.settings)).scene;
    importer::Notes notes;
    const bool is_known = request.formulation.empty() || convert(scene, request.formulation, notes);
    const importer::Exported result =
        chrono ? importer::export_chrono(scene, request.allow_missing, notes)
               : importer::export_adm(scene, request.allow_missing, notes);
    if (request.output.empty())
        print("{}", result.text);
    else
        write_whole(request.output, result.text, kind);
    for (const auto& line : importer::described(result.notes))
        if (line.starts_with("Warning") || line.starts_with("MISSING"))
            print_error("elastocheck: {}\n", line);
    return is_known ? fine : could_not_judge;
}

}  // namespace

const Command import_command{
    Group::models, "import",
    "Import a model of another program as a scene: ADAMS .adm, Chrono::Vehicle .json, "
    "hardpoints .sub, tables of points .csv and .xlsx, points of Lotus SHARK .shk and "
    "ADAMS/View .cmd, "
    "suspensions.ini of Assetto Corsa",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<ImportRequest>();
        as_file(command.add_option("FILE", request->file,
                                   "the model (.adm, .json, .sub, .csv, .xlsx, .shk, .cmd, .ini)"))
            ->required();
        as_file(command.add_option("-o,--output", request->output, "write the scene to this file"));
        command.add_option("--wheel", request->options.wheel,
                           "name or id of the wheel carrier part, or of a marker at the wheel "
                           "centre (.adm)");
        as_word(
            command.add_option("--drop", request->drop, "dynamics: leave out dampers and friction"),
            {"dynamics"});
        command.add_option("--axes", request->options.axes,
                           "axes of a table of hardpoints, turned to ISO 8855: "
                           "x-rearward,y-right (default of .sub), x-forward,y-right,z-down, ...");
        command.add_option("--columns", request->options.columns,
                           "columns of a table of points by heading, number or letters: "
                           "name=Punkt,x=X_mm,y=3,z=D; for sides side=COLUMN, or left.x ... "
                           "right.z (.csv, .xlsx)");
        as_word(command.add_option(
                    "--unit", request->options.unit,
                    "unit of a table of points whose headings do not say it (.csv, .xlsx)"),
                {"mm", "cm", "m", "in"});
        command.add_option("--sheet", request->options.sheet,
                           "sheet of a workbook in which several have numbers (.xlsx)");
        command.add_option(
            "--axle", request->options.axle,
            "axle of a vehicle of Chrono: front (its first), rear (its last), 1, 2, ...; of points "
            "with --as: front, rear");
        command.add_option(
            "--as", request->options.as,
            "mechanism to make of points: double_wishbone, strut, five_link, "
            "trailing_arm, live_axle; rigid without --rates (.csv, .xlsx, .shk, .cmd, .sub, .ini)");
        command.add_option("--pushrod", request->options.pushrod,
                           "with --as: part on which a pushrod or pullrod to a rocker stands: "
                           "upright, lower, upper");
        command.add_flag("--rocker", request->options.rocker,
                         "with --as: a rocker, and a pushrod to it from the part on which the "
                         "damper would stand");
        command.add_option("--damper", request->options.damper,
                           "with --as: part on which the damper stands: upright, lower, upper");
        command.add_option("--role", request->options.roles,
                           "with --as: the point of a role: tie_rod_inner=NAME");
        command.add_flag("--both-wheels", request->options.both_wheels,
                         "with --as: the other wheel too, as the mirror image, with roll");
        as_file(command.add_option("--rates", request->options.rates,
                                   "with --as: table of rates by role (.csv: role, x, y, z, rx, "
                                   "ry, rz): bushings there, and springs beside the dampers"));
        command.add_flag("--allow-missing", request->options.allow_missing,
                         "warn about what a scene cannot represent instead of rejecting the file");
        add_json(command, request->as_json);
        return [request](const std::string&) { return import(*request); };
    }};

const Command export_command{
    Group::models, "export",
    "Export the trimmed scene as a model of ADAMS or Chrono, or its outputs as a map",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<ExportRequest>();
        add_scene(command, request->scene);
        as_word(command.add_option(
                    "--format", request->format,
                    "adm (default): an ADAMS dataset; chrono: a suspension of Chrono::Vehicle "
                    "(JSON); lookup: a table of outputs over a branch (CSV); blocks: K&C blocks in "
                    "SI units (CSV)"),
                {"adm", "chrono", "lookup", "blocks"});
        as_file(command.add_option("-o,--output", request->output, "write the model to this file"));
        command.add_option("--over", request->over, "lookup, blocks: the branch");
        command.add_option("--rows", request->rows,
                           "lookup, blocks: a second variable, which the branch holds: "
                           "travel=-0.08:0.08:9");
        as_word(command.add_option("--axes", request->axes,
                                   "blocks: x forward, y left, z up (iso, default), or x forward, "
                                   "y right, z down (sae)"),
                {"iso", "sae"});
        command
            .add_option("--channels", request->channels,
                        "lookup: outputs, as for solve (default: the main positions and angles)")
            ->delimiter(',');
        as_word(command.add_option(
                    "--formulation", request->formulation,
                    "adams or chrono, as the format: convert the bushings to that program's "
                    "formulation and report the change of the outputs"),
                {"adams", "chrono"});
        command.add_flag("--allow-missing", request->allow_missing,
                         "warn about elements that the other program does not have instead of "
                         "rejecting the scene");
        add_set(command, request->settings);
        return [request](const std::string&) { return export_scene(*request); };
    }};

}  // namespace elastocheck::reports
