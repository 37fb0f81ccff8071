#include "reports/page/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <set>
#include <sstream>

#include "reports/document/curves.hpp"
#include "reports/document/document.hpp"
#include "reports/files/files.hpp"
#include "reports/files/folder.hpp"
#include "reports/files/templates.hpp"
#include "reports/page/answer.hpp"
#include "reports/page/common.hpp"
#include "reports/page/plot.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/svg.hpp"
#include "reports/text/escape.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

// ---- Page

// Sentences of a section, one paragraph each.
json paragraphs(const Section& section) {
    json list = json::array();
    std::istringstream lines(render("text/" + section.id, section.words, Escape::nothing));
    for (std::string line; std::getline(lines, line);) {
        while (!line.empty() && line.front() == ' ') line.erase(0, 1);
        if (!line.empty()) list.push_back(line);
    }
    return list;
}

// A scene with its sections and figures; `id` begins the names of its files and HTML ids.
struct ScenePart {
    const SceneAnalyses& scene;
    std::string id;
    std::vector<Section> sections;
    std::vector<Plot> plots{};
};

struct Page {
    std::set<std::string> names{};
    std::vector<Illustration> pictures{};
    std::size_t next = 0;

    std::string unique(const std::string& wanted) {
        std::string name = wanted;
        for (int n = 2; !names.insert(name).second; ++n) name = fmt::format("{}-{}", wanted, n);
        return name;
    }

    ScenePart part(const SceneAnalyses& scene) {
        ScenePart part{scene, unique(slug(fs::path(scene.scene.source).stem().string())),
                       sections_of(scene)};
        for (const auto& section : part.sections)
            for (const auto& group : section.figures)
                for (const auto& figure : group.figures)
                    part.plots.push_back(
                        {&figure, unique(fmt::format("{}-{}", part.id, figure.id))});
        return part;
    }

    json figure(const Plot& plot) {
        return {{"name", plot.name},
                {"title", plot.figure->title},
                {"description", plot.figure->description},
                {"svg", pictures.at(next++).inlined}};
    }

    json section(const Section& section, const ScenePart& part, std::size_t& plot) {
        json single = json::array(), several = json::array(), tables = json::array();
        for (const auto& group : section.figures) {
            json figures = json::array();
            for (std::size_t k = 0; k < group.figures.size(); ++k)
                figures.push_back(figure(part.plots.at(plot++)));
            json entry = {{"caption", group.caption},
                          {"figures", figures},
                          {"table", page_table(group.table)}};
            entry["wide"] = group.figures.size() > 1;
            entry["broad"] = group.figures.size() > 1 && group.figures.front().sheet &&
                             group.figures.front().sheet->width > 400;
            (group.figures.size() > 1 ? several : single).push_back(entry);
        }
        for (const auto& table : section.tables) tables.push_back(page_table(table));
        json groups = single;
        for (const auto& entry : several) groups.push_back(entry);
        const json texts = paragraphs(section);
        return {{"id", unique(fmt::format("{}-{}", part.id, section.id))},
                {"title", section.title},
                {"first", section.part == Part::first && section.id != "conditions"},
                {"glance", section.id == "first"},
                {"mark", section.mark == Mark::none   ? json(nullptr)
                         : section.mark == Mark::pass ? json{{"class", "pass"}, {"text", "pass"}}
                         : section.mark == Mark::fail
                             ? json{{"class", "fail"}, {"text", "fail"}}
                             : json{{"class", "open"}, {"text", "not judged"}}},
                {"paragraphs", texts},
                {"lead", texts.empty() ? json("") : texts[0]},
                {"rest", texts.size() > 1 ? json(std::vector<json>(texts.begin() + 1, texts.end()))
                                          : json::array()},
                {"has_figures", !groups.empty()},
                {"groups", groups},
                {"has_tables", !tables.empty()},
                {"tables", tables},
                {"motion", section.motion.is_null() ? json(nullptr)
                                                    : json(for_script(section.motion.dump()))}};
    }

    // The parts of the page in order, each with its sections.
    json scene(const ScenePart& part) {
        struct Heading {
            Part part;
            const char* title;
        };
        constexpr Heading headings[] = {{Part::first, ""},
                                        {Part::behaviour, "Part 1: Kinematics and compliance"},
                                        {Part::change, "What should I change?"},
                                        {Part::evidence, "Part 2: Fast methods and evidence"}};
        json parts = json::array();
        std::size_t plot = 0;
        for (const auto& [which, title] : headings) {
            json sections = json::array();
            for (const auto& one : part.sections)
                if (one.part == which) {
                    sections.push_back(section(one, part, plot));
                    sections.back()["deep"] = *title != '\0';
                    sections.back()["depth"] = *title != '\0' ? "####" : "###";
                }
            if (sections.empty()) continue;
            const bool named = *title != '\0';
            parts.push_back({{"title", title},
                             {"named", named},
                             {"id", named ? unique(part.id + "-" + slug(title)) : std::string()},
                             {"folded", which == Part::change || which == Part::evidence},
                             {"sections", sections}});
        }
        return {{"id", part.id},
                {"name", part.scene.scene.name},
                {"conclusive", part.scene.conclusive()},
                {"parts", parts}};
    }
};

// Summary of several scenes: whether the references agree, the cheapest method that is good enough,
// and how far the published one is off.
Table summary(const std::list<ScenePart>& parts) {
    Table table = words_table(
        "Summary: how far the references agree, the cheapest fast method within the tolerance, and "
        "the largest errors of the published recursion",
        {"scene", "distance of the references [mm]", "cheapest method within the tolerance",
         "its work, of the full solution", "published: position, at equal load or drive",
         "position, at equal travel", "angle, at equal load or drive", "angle, at equal travel",
         "wheel rate", "force, moment or rate, of its extent"});
    for (std::size_t c = 1; c < table.columns.size(); ++c)
        table.columns[c].words = c == 2;  // numbers, some with their unit
    for (const auto& part : parts) {
        const auto disagreement =
            compare::worst_disagreement(part.scene.comparison, compare::Unit::mm);
        const auto rows = method_rows(part.scene);
        const auto chosen = std::ranges::find_if(rows, &MethodRow::chosen);
        const bool none = chosen == rows.end();
        const compare::Assessment judgement = part.scene.judgement.value_or(compare::Assessment{});
        const auto size = [](const std::optional<compare::Worst>& worst) {
            return worst ? quantity(worst->max, symbol(worst->unit)) : "–";
        };
        double other = -1;
        for (const auto& worst : {judgement.other, judgement.other_at_abscissa})
            if (worst && worst->extent > 0) other = std::max(other, worst->max / worst->extent);
        const auto& rate = judgement.wheel_rate;
        table.rows.push_back({part.scene.scene.name,
                              !part.scene.conclusive() ? "not judged"
                              : disagreement           ? number(disagreement->max, 2)
                                                       : "–",
                              none ? "–" : chosen->method + ", " + chosen->setting,
                              none ? "–" : percent(chosen->cost), size(judgement.position),
                              size(judgement.position_at_abscissa), size(judgement.angle),
                              size(judgement.angle_at_abscissa),
                              !rate ? "–"
                                    : fmt::format("{} too {}", percent(std::abs(rate->off)),
                                                  rate->off < 0 ? "soft" : "stiff"),
                              other < 0 ? "–" : percent(other)});
    }
    return table;
}

json made_by(const Report& report) {
    const Provenance& p = report.provenance;
    Table table = words_table("Made by", {"what", "which"});
    table.rows = {{"elastocheck", p.version},
                  {"commit", p.commit + (p.dirty ? ", with uncommitted changes" : "")},
                  {"compiler", p.compiler},
                  {"flags", p.flags}};
    for (const auto& [name, version] : p.libraries) table.rows.push_back({name, version});
    for (const auto& scene : report.scenes)
        table.rows.push_back({scene.scene.source, "hash " + scene.hash});
    return page_table(table);
}

}  // namespace

json report_json(const Report& report) {
    json result = document(report.reproduce, report.provenance);
    for (const auto& scene : report.scenes) result["scenes"].push_back(scene_json(scene));
    result["provenance"].erase("cpu");
    return result;
}

std::string numbers_csv(const std::vector<SceneAnalyses>& scenes) {
    std::string csv = "scene,branch,output,unit,quantity,value,tolerance\n";
    for (const auto& scene : scenes)
        for (const auto& branch : branches_of(scene)) {
            const Sweep sweep = sweep_of(scene, branch);
            const std::string by_parameter = "published " + sweep.at_equal_parameter(),
                              by_abscissa = "published " + sweep.at_equal_abscissa();
            const auto &load = branch.result->deviation.equal_parameter.channels,
                       &travel = branch.result->deviation.equal_abscissa.channels;
            for (std::size_t c = 0; c < load.size(); ++c) {
                const auto& channel = scene.comparison.channels[c];
                const auto values = values_of(branch.truth(), c);
                if (!channel.main || values.empty() || !branch.result->determined[c]) continue;
                const auto row = [&](const std::string& quantity, double value, double tolerance) {
                    csv += fmt::format("{},{},{},{},{},{:.12g},{:.1g}\n",
                                       for_csv(fs::path(scene.scene.source).stem().string()),
                                       for_csv(branch.name()), for_csv(channel.name),
                                       for_csv(symbol(channel.unit)), quantity, value, tolerance);
                };
                // The references agree far better; a deviation contains the rounding of many steps.
                const double fine = 1e-6, coarse = 1e-6 + 1e-6 * load[c].range;
                row("equilibrium at the end", values.back(), fine);
                row(by_parameter + ": deviation at the end", load[c].end, coarse);
                row(by_parameter + ": largest deviation", load[c].max, coarse);
                if (c < travel.size())
                    row(by_abscissa + ": largest deviation", travel[c].max, coarse);
            }
        }
    return csv;
}

namespace {

// A report before its figures are drawn.
struct Draft {
    Page page{};
    std::list<ScenePart> parts{};  // pointers in `plots` refer to these
    std::vector<Plot> plots{};
};

Draft draft(const Report& report) {
    Draft made;
    for (const auto& scene : report.scenes) {
        made.parts.push_back(made.page.part(scene));
        const auto& plots = made.parts.back().plots;
        made.plots.insert(made.plots.end(), plots.begin(), plots.end());
    }
    return made;
}

Answer answer(const SceneAnalyses& scene) {
    Answer made{.name = scene.scene.name,
                .source = scene.scene.source,
                .sentence = trust_sentence(scene),
                .mark = scene.conclusive() ? "judged" : "not judged",
                .conclusive = scene.conclusive(),
                .reasons = scene.reasons};
    if (scene.loads) made.sentence += " Load cases: " + scene.loads->verdict.sentence;
    if (const std::string methods = method_sentence(scene); !methods.empty())
        made.sentence += " " + methods;
    for (const auto& [candidate, sentence] : scene.candidates)
        if (made.mark != "fail") made.mark = name(candidate.verdict);
    return made;
}

std::string title_of(const std::vector<SceneAnalyses>& scenes) {
    const std::string& first = scenes[0].scene.name;
    if (scenes.size() == 1) return first;
    if (!scenes[0].against) return fmt::format("{} scenes", scenes.size());
    const std::string& variant = scenes[1].scene.name;
    // Variants of the same name are told apart by their files.
    const auto file = [](const SceneAnalyses& scene) {
        return fs::path(scene.scene.source).filename().string();
    };
    return variant != first
               ? fmt::format("{} against {}", variant, first)
               : fmt::format("{}: {} against {}", first, file(scenes[1]), file(scenes[0]));
}

// Pages and tables with their figures.
std::vector<NamedContent> texts(Draft draft, const Report& report, const std::string& live) {
    json scenes = json::array();
    for (const auto& part : draft.parts) scenes.push_back(draft.page.scene(part));
    const json data = {{"title", title_of(report.scenes)},
                       {"several", scenes.size() > 1},
                       {"scenes", scenes},
                       {"summary", page_table(summary(draft.parts))},
                       {"provenance", made_by(report)},
                       {"reproduce", for_terminal(report.reproduce)},
                       {"tints", tints()},
                       {"live", !live.empty()}};
    std::vector<std::pair<std::string, const compare::Comparison*>> comparisons;
    for (const auto& scene : report.scenes)
        comparisons.emplace_back(scene.scene.name, &scene.comparison);
    std::vector<NamedContent> files{{"report.html", render("html/page", data, Escape::html)},
                                    {"report.md", render("markdown/page", data, Escape::markdown)},
                                    {"result.json", report_json(report).dump(1) + "\n"},
                                    {"curves.csv", curves_csv(comparisons)},
                                    {"forces.csv", forces_csv(report.scenes)},
                                    {"numbers.csv", numbers_csv(report.scenes)}};
    if (!live.empty()) files.push_back({"live.html", live});
    return files;
}

}  // namespace

std::vector<Answer> write_report(const Report& report, const fs::path& folder,
                                 const ReportOptions& options) {
    Staging staging(folder);
    Draft drafted = draft(report);
    if (options.progress) options.progress(fmt::format("{} figures", drafted.plots.size()));
    drafted.page.pictures = draw(drafted.plots, staging.path());
    for (const auto& [name, content] : texts(std::move(drafted), report, options.live))
        write_staged(staging.path() / name, content);
    staging.publish();
    std::vector<Answer> answers;
    for (const auto& scene : report.scenes) answers.push_back(answer(scene));
    return answers;
}

}  // namespace elastocheck::reports
