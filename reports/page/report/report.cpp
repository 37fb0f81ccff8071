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
#include "reports/json/json_cursor.hpp"
#include "reports/page/answer.hpp"
#include "reports/page/common.hpp"
#include "reports/page/plot.hpp"
#include "reports/page/sections.hpp"
#include "reports/page/svg.hpp"
#include "reports/page/template_data.hpp"
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

// A scene with its sections and its prefix for files and ids.
struct ScenePart {
    JsonCursor scene;
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

    ScenePart part(const JsonCursor& scene) {
        ScenePart part{scene, unique(slug(fs::path(scene["source"].text()).stem().string())),
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
                          {"table", table_data(group.table)}};
            entry["wide"] = group.figures.size() > 1;
            entry["broad"] = group.figures.size() > 1 && group.figures.front().sheet &&
                             group.figures.front().sheet->width > 400;
            (group.figures.size() > 1 ? several : single).push_back(entry);
        }
        for (const auto& table : section.tables) tables.push_back(table_data(table));
        json groups = single;
        for (const auto& entry : several) groups.push_back(entry);
        const json all = paragraphs(section);
        return {{"id", unique(fmt::format("{}-{}", part.id, section.id))},
                {"title", section.title},
                {"first", section.part == Part::first},
                {"glance", section.id == "first"},
                {"mark", section.mark == Mark::none   ? json(nullptr)
                         : section.mark == Mark::pass ? json{{"class", "pass"}, {"text", "pass"}}
                         : section.mark == Mark::fail
                             ? json{{"class", "fail"}, {"text", "fail"}}
                             : json{{"class", "open"}, {"text", "not judged"}}},
                {"paragraphs", all},
                {"lead", all.empty() ? json("") : all[0]},
                {"rest", all.size() > 1 ? json(std::vector<json>(all.begin() + 1, all.end()))
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
                                        {Part::methods, ""},
                                        {Part::change, "What should I change?"},
                                        {Part::evidence, "Part 2: Evidence"}};
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
                {"name", part.scene["name"].text()},
                {"conclusive", part.scene["verdict"]["conclusive"].truth()},
                {"parts", parts}};
    }
};

// Summary of several scenes: whether the references agree, the cheapest method that is good enough,
// and how far the published one is off.
Table summary(const std::list<ScenePart>& parts) {
    Table table{.caption =
                    "Summary: how far the references agree, the cheapest fast method within "
                    "the tolerance, and the largest errors of the published recursion",
                .columns = {{"scene", true},
                            {"references apart [mm]"},
                            {"cheapest method within the tolerance", true},
                            {"its work, of the full solution"},
                            {"published: position, at equal load or drive"},
                            {"position, at equal travel"},
                            {"angle, at equal load or drive"},
                            {"angle, at equal travel"},
                            {"wheel rate"},
                            {"force, moment or rate, of its extent"}}};
    for (const auto& part : parts) {
        std::vector<std::string> row{part.scene["name"].text()};
        const auto findings = part.scene.find("findings");
        const auto apart = findings ? findings->find("references_apart") : std::nullopt;
        const auto mm = apart ? apart->find("mm") : std::nullopt;
        row.push_back(!part.scene["verdict"]["conclusive"].truth() ? "not judged"
                      : mm ? number((*mm)["max"].number(), 2)
                           : "–");
        const auto rows = method_rows(part.scene);
        const auto chosen = std::ranges::find_if(rows, &MethodRow::chosen);
        row.push_back(chosen == rows.end() ? "–" : chosen->method + ", " + chosen->setting);
        row.push_back(chosen == rows.end() ? "–" : percent(chosen->cost));
        const auto judgement = part.scene.find("judgement");
        for (const char* key : {"position", "position_across", "angle", "angle_across"}) {
            const auto worst = judgement ? judgement->find(key) : std::nullopt;
            row.push_back(!worst ? "–"
                                 : quantity((*worst)["max"].number(), (*worst)["unit"].text()));
        }
        const auto rate = judgement ? judgement->find("wheel_rate") : std::nullopt;
        const double off = rate ? (*rate)["off"].number() : NAN;
        row.push_back(
            !rate ? "–"
                  : fmt::format("{} too {}", percent(std::abs(off)), off < 0 ? "soft" : "stiff"));
        double other = -1;
        for (const char* key : {"other", "other_across"})
            if (const auto worst = judgement ? judgement->find(key) : std::nullopt)
                other = std::max(other, (*worst)["share"].number());
        row.push_back(other < 0 ? "–" : percent(other));
        table.rows.push_back(row);
    }
    return table;
}

json provenance(const JsonCursor& result) {
    const JsonCursor p = result["provenance"];
    Table table{.caption = "Made by", .columns = {{"what", true}, {"which", true}}};
    table.rows = {
        {"elastocheck", p["elastocheck"].text()},
        {"commit", p["commit"].text() + (p["dirty"].truth() ? ", with uncommitted changes" : "")},
        {"compiler", p["compiler"].text()},
        {"flags", p["flags"].text()}};
    if (const auto cpu = p.find("cpu")) table.rows.push_back({"CPU", cpu->text()});
    for (const auto& [name, version] : p["libraries"].entries())
        table.rows.push_back({name, version.text()});
    for (const auto& scene : result["scenes"].items())
        table.rows.push_back({scene["source"].text(), "hash " + scene["input_hash"].text()});
    return table_data(table);
}

}  // namespace

std::string numbers_csv(const json& result, const std::string& file) {
    std::string csv = "scene,branch,output,unit,quantity,value,tolerance\n";
    const JsonCursor root{&result, "", &file};
    const auto row = [&](const JsonCursor& scene, const JsonCursor& branch,
                         const ChannelInfo& channel, const std::string& quantity, double value,
                         double tolerance) {
        csv += fmt::format("{},{},{},{},{},{:.12g},{:.1g}\n",
                           for_csv(fs::path(scene["source"].text()).stem().string()),
                           for_csv(branch["name"].text()), for_csv(channel.name),
                           for_csv(channel.unit), quantity, value, tolerance);
    };
    for (const auto& scene : root["scenes"].items())
        for (const auto& branch : scene["branches"].items()) {
            const LegCurve truth = curve_of(branch, "equilibrium");
            const Sweep sweep = sweep_of(scene, branch);
            const std::string by_parameter = "published " + sweep.at_equal_parameter(),
                              by_abscissa = "published " + sweep.at_equal_abscissa();
            for (const auto& channel : main_channels_of(scene)) {
                const auto values = truth.channel(channel.name);
                const auto load =
                    branch["deviation"]["at_equal_parameter"]["channels"].find(channel.name);
                if (values.empty() || !load) continue;
                // The references agree far better; a deviation contains the rounding of many steps.
                const double range = (*load)["range"].number(), fine = 1e-6,
                             coarse = 1e-6 + 1e-6 * range;
                row(scene, branch, channel, "equilibrium at the end", values.back(), fine);
                row(scene, branch, channel, by_parameter + ": deviation at the end",
                    (*load)["end"].number(), coarse);
                row(scene, branch, channel, by_parameter + ": largest deviation",
                    (*load)["max"].number(), coarse);
                if (const auto travel =
                        branch["deviation"]["at_equal_abscissa"]["channels"].find(channel.name))
                    row(scene, branch, channel, by_abscissa + ": largest deviation",
                        (*travel)["max"].number(), coarse);
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

Draft draft(const JsonCursor& root) {
    Draft made;
    for (const auto& scene : root["scenes"].items()) {
        made.parts.push_back(made.page.part(scene));
        const auto& plots = made.parts.back().plots;
        made.plots.insert(made.plots.end(), plots.begin(), plots.end());
    }
    return made;
}

// Pages and tables with their figures, and the answer of each scene.
struct Texts {
    std::vector<NamedContent> files{};
    std::vector<Answer> answers{};
};

Answer answer(const JsonCursor& scene) {
    const JsonCursor verdict = scene["verdict"];
    Answer made{.name = scene["name"].text(),
                .source = scene["source"].text(),
                .sentence = trust_sentence(scene),
                .mark = {},
                .conclusive = verdict["conclusive"].truth(),
                .reasons = verdict["reasons"].texts()};
    if (const std::string methods = method_sentence(scene); !methods.empty())
        made.sentence += " " + methods;
    made.mark = made.conclusive ? "judged" : "not judged";
    if (const auto candidates = scene.find("candidates"))
        for (const auto& candidate : candidates->items())
            if (made.mark != "fail") made.mark = candidate["verdict"].text();
    return made;
}

std::string title_of(const JsonCursor& root) {
    const auto scenes = root["scenes"].items();
    const std::string first = scenes[0]["name"].text();
    if (scenes.size() == 1) return first;
    if (!scenes[0].find("against")) return fmt::format("{} scenes", scenes.size());
    const std::string variant = scenes[1]["name"].text();
    // variants often share their name, and differ by their file
    const auto file = [](const JsonCursor& scene) {
        return fs::path(scene["source"].text()).filename().string();
    };
    return variant != first
               ? fmt::format("{} against {}", variant, first)
               : fmt::format("{}: {} against {}", first, file(scenes[1]), file(scenes[0]));
}

Texts texts(Draft draft, const json& result, const std::string& file, const std::string& live) {
    const JsonCursor root{&result, "", &file};
    json scenes = json::array();
    for (const auto& part : draft.parts) scenes.push_back(draft.page.scene(part));
    const json data = {{"title", title_of(root)},
                       {"several", scenes.size() > 1},
                       {"scenes", scenes},
                       {"summary", table_data(summary(draft.parts))},
                       {"provenance", provenance(root)},
                       {"reproduce", for_terminal(root["reproduce"].text())},
                       {"tints", tints()},
                       {"live", !live.empty()}};
    Texts made;
    made.files = {{"report.html", render("html/page", data, Escape::html)},
                  {"report.md", render("markdown/page", data, Escape::markdown)},
                  {"result.json", result.dump(1) + "\n"},
                  {"curves.csv", curves_csv(result, file)},
                  {"forces.csv", forces_csv(result, file)},
                  {"numbers.csv", numbers_csv(result, file)}};
    if (!live.empty()) made.files.push_back({"live.html", live});
    for (const auto& part : draft.parts) made.answers.push_back(answer(part.scene));
    return made;
}

}  // namespace

std::vector<Answer> write_report(const json& result, const std::string& file,
                                 const fs::path& folder, const ReportOptions& options) {
    Staging staging(folder);
    Draft report = draft({&result, "", &file});
    if (options.progress) options.progress(fmt::format("{} figures", report.plots.size()));
    report.page.pictures = draw(report.plots, staging.path());
    const Texts made = texts(std::move(report), result, file, options.live);
    for (const auto& [name, content] : made.files) fill(staging.path() / name, content);
    staging.publish();
    return made.answers;
}

}  // namespace elastocheck::reports
