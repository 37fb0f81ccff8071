#include "reports/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "reports/document.hpp"
#include "reports/field.hpp"
#include "reports/files.hpp"
#include "reports/folder.hpp"
#include "reports/gnuplot.hpp"
#include "reports/numbers.hpp"
#include "reports/sections/common.hpp"
#include "reports/sections/sections.hpp"
#include "reports/svg.hpp"
#include "reports/templates.hpp"

namespace elastocheck::reports {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

// ---- figures

constexpr int width = 440, height = 290;  // [px] of a figure, for the type to keep its size on a phone

const char* style_of(Series::Style style) {
    switch (style) {
        case Series::Style::line: return "lines linewidth 1.8";
        case Series::Style::wide: return "lines linewidth 4";
        case Series::Style::dashed: return "lines linewidth 1.6 dashtype (6,4)";
        case Series::Style::thin: return "lines linewidth 1.2";
        case Series::Style::points: return "points linewidth 1.4 pointsize 0.75";
        case Series::Style::line_points: return "linespoints linewidth 1.4 pointsize 0.7";
        case Series::Style::rings: return "points linewidth 1.5 pointsize 1.3";
        case Series::Style::bars: return "boxxyerror fillstyle solid 1 noborder";
    }
    return "lines";
}

json range_of(double low, double high) {
    const auto end = [](double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : "*"; };
    return fmt::format("{}:{}", end(low), end(high));
}

json script_data(const Figure& figure, const std::string& name) {
    json series = json::array(), bands = json::array(), ticks = json::array();
    for (std::size_t k = 0; k < figure.series.size(); ++k) {
        const Series& s = figure.series[k];
        const bool points = s.style == Series::Style::points || s.style == Series::Style::rings ||
                            s.style == Series::Style::line_points;
        constexpr int symbols[] = {7, 5, 9, 11, 13, 6, 7, 4, 6, 8};
        series.push_back({{"index", k},
                          {"title", s.title},
                          {"style", style_of(s.style)},
                          {"symbol", points ? json(symbols[s.mark % 10]) : json(nullptr)},
                          {"colour", palette[s.colour].light},
                          {"bars", s.style == Series::Style::bars},
                          {"last", k + 1 == figure.series.size()}});
    }
    for (const auto& band : figure.bands)
        bands.push_back({{"low", fmt::format("{:.9g}", band.low)},
                         {"high", fmt::format("{:.9g}", band.high)},
                         {"label", band.label},
                         {"colour", palette[band.colour].light}});
    for (const auto& [at, text] : figure.y_ticks)
        ticks.push_back({{"at", fmt::format("{:g}", at)}, {"text", text}});
    return {{"name", name},
            {"title", figure.title},
            {"width", std::lround(width * figure.width)},
            {"height", std::lround(height * figure.height)},
            {"width_in", fmt::format("{:.2f}", width * figure.width / 96.0)},
            {"height_in", fmt::format("{:.2f}", height * figure.height / 96.0)},
            {"x", figure.x},
            {"y", figure.y},
            {"log_x", figure.log_x},
            {"log_y", figure.log_y},
            {"equal_axes", figure.equal_axes},
            {"reversed_x", figure.reversed_x},
            {"reversed_y", figure.reversed_y},
            {"y_range", range_of(figure.y_low, figure.y_high)},
            {"x_tick", figure.x_tick > 0 ? json(fmt::format("{:g}", figure.x_tick)) : json(nullptr)},
            {"y_tick", figure.y_tick > 0 ? json(fmt::format("{:g}", figure.y_tick)) : json(nullptr)},
            {"ticks", ticks},
            {"series", series},
            {"bands", bands},
            {"ink", palette[ink].light},
            {"slate", palette[slate].light},
            {"faint", palette[faint].light}};
}

// One block per series, two blank lines between them, one where a line is broken.
std::string figure_data(const Figure& figure) {
    const bool bars = !figure.series.empty() && figure.series.front().style == Series::Style::bars;
    std::string text = bars ? "series,x,y,x low,x high,y low,y high\n" : "series,x,y\n";
    for (std::size_t k = 0; k < figure.series.size(); ++k) {
        if (k > 0) text += "\n\n";
        std::string name = figure.series[k].title;
        std::ranges::replace(name, '"', '\'');
        bool broken = true;  // no blank line first, none twice
        for (const auto& row : figure.series[k].rows) {
            if (row.empty() && broken) continue;
            broken = row.empty();
            if (!row.empty()) text += fmt::format("\"{}\"", name);
            for (const double value : row) text += fmt::format(",{:.9g}", value);
            text += "\n";
        }
        while (text.ends_with("\n\n")) text.pop_back();
    }
    return text;
}

std::string read_text(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

// `id` begins every id in the figure, so it is short.
Illustration draw(const Figure& figure, const std::string& name, const std::string& id,
                  const fs::path& folder, const ReportOptions& options) {
    const fs::path figures = folder / "figures";
    write_whole(figures / (name + ".csv"), figure_data(figure));
    write_whole(figures / (name + ".gp"), render("figure.gp", script_data(figure, name), Escape::gnuplot));
    const std::string script = "figures/" + name + ".gp";
    run_gnuplot(folder, {script});
    if (options.pdf) run_gnuplot(folder, {"-e", "pdf=1", script});
    const fs::path svg = figures / (name + ".svg");
    const Illustration picture = illustrate(read_text(svg), id, figure.title, figure.description);
    write_whole(svg, picture.alone);
    if (options.archive)
        for (const char* other : {".csv", ".gp"}) fs::remove(figures / (name + other));
    return picture;
}

// ---- the page

json table_json(const Table& table) {
    json columns = json::array(), rows = json::array();
    for (const auto& column : table.columns)
        columns.push_back({{"name", column.name}, {"words", column.words}});
    for (const auto& row : table.rows) {
        json cells = json::array();
        for (std::size_t c = 0; c < row.size(); ++c)
            cells.push_back({{"text", row[c]},
                             {"words", c < table.columns.size() && table.columns[c].words},
                             {"head", c == 0}});
        rows.push_back({{"cells", cells}});
    }
    return {{"caption", table.caption}, {"columns", columns}, {"rows", rows}, {"folded", table.folded}};
}

// Sentences of a section, a paragraph each.
json paragraphs(const Section& section) {
    json list = json::array();
    std::istringstream lines(render("text/" + section.id, section.words, Escape::nothing));
    for (std::string line; std::getline(lines, line);) {
        while (!line.empty() && line.front() == ' ') line.erase(0, 1);
        if (!line.empty()) list.push_back(line);
    }
    return list;
}

struct Page {
    fs::path folder;
    ReportOptions options;
    std::set<std::string> names{};
    int drawn = 0;

    std::string unique(const std::string& wanted) {
        std::string name = wanted;
        for (int n = 2; !names.insert(name).second; ++n) name = fmt::format("{}-{}", wanted, n);
        return name;
    }

    json figure(const Figure& figure, const std::string& scene) {
        const std::string name = unique(fmt::format("{}-{}", scene, figure.id));
        if (options.progress) options.progress("figure " + name);
        const Illustration picture = draw(figure, name, fmt::format("f{}", ++drawn), folder, options);
        return {{"name", name},
                {"title", figure.title},
                {"description", figure.description},
                {"svg", picture.inlined}};
    }

    json section(const Section& section, const std::string& scene) {
        json single = json::array(), several = json::array(), tables = json::array();
        for (const auto& group : section.figures) {
            json figures = json::array();
            for (const auto& one : group.figures) figures.push_back(figure(one, scene));
            json entry = {
                {"caption", group.caption}, {"figures", figures}, {"table", table_json(group.table)}};
            entry["wide"] = group.figures.size() > 1;
            (group.figures.size() > 1 ? several : single).push_back(entry);
        }
        for (const auto& table : section.tables) tables.push_back(table_json(table));
        json groups = single;
        for (const auto& entry : several) groups.push_back(entry);
        json tiles = section.words.contains("tiles") ? section.words["tiles"] : json::array();
        json all = paragraphs(section);
        return {
            {"id", unique(fmt::format("{}-{}", scene, section.id))},
            {"title", section.title},
            {"verdict", section.id == "verdict"},
            {"paragraphs", all},
            {"lead", all.empty() ? json("") : all[0]},
            {"rest", all.size() > 1 ? json(std::vector<json>(all.begin() + 1, all.end())) : json::array()},
            {"has_tiles", !tiles.empty()},
            {"tiles", tiles},
            {"has_figures", !groups.empty()},
            {"groups", groups},
            {"tables", tables}};
    }

    json scene(const Field& scene) {
        const std::string id = unique(slug(fs::path(scene["source"].text()).stem().string()));
        json sections = json::array();
        for (const auto& one : sections_of(scene)) sections.push_back(section(one, id));
        return {{"id", id},
                {"name", scene["name"].text()},
                {"conclusive", scene["verdict"]["conclusive"].truth()},
                {"sections", sections}};
    }
};

json provenance(const Field& result) {
    const Field p = result["provenance"];
    Table table{.caption = "Made by", .columns = {{"what", true}, {"which", true}}};
    table.rows = {{"elastocheck", p["elastocheck"].text()},
                  {"commit", p["commit"].text() + (p["dirty"].truth() ? ", with uncommitted changes" : "")},
                  {"compiler", p["compiler"].text()},
                  {"flags", p["flags"].text()}};
    if (const auto cpu = p.find("cpu")) table.rows.push_back({"CPU", cpu->text()});
    for (const auto& [name, version] : p["libraries"].entries()) table.rows.push_back({name, version.text()});
    for (const auto& scene : result["scenes"].items())
        table.rows.push_back({scene["source"].text(), "hash " + scene["input_hash"].text()});
    return table_json(table);
}

// ---- beside the page

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == text.npos) return text;
    std::string doubled;
    for (const char c : text) doubled += c == '"' ? std::string("\"\"") : std::string(1, c);
    return fmt::format("\"{}\"", doubled);
}

// Every point of every leg, a number a row: scenes differ in their outputs.
std::string curves_csv(const Field& result) {
    std::string csv = "scene,branch,leg,load factor,travel [mm],output,unit,value\n";
    for (const auto& scene : result["scenes"].items()) {
        if (!scene.find("branches")) continue;
        for (const auto& branch : scene["branches"].items())
            for (const auto& leg : branch["legs"].items()) {
                const LegCurve curve = curve_of(branch, leg["leg"].text());
                for (const auto& channel : main_channels_of(scene)) {
                    const auto values = curve.channel(channel.name);
                    for (std::size_t k = 0; k < values.size(); ++k)
                        csv += fmt::format(
                            "{},{},{},{:.10g},{},{},{},{:.17g}\n", quoted(scene["name"].text()),
                            quoted(branch["name"].text()), curve.leg, curve.load[k],
                            k < curve.travel.size() ? fmt::format("{:.10g}", curve.travel[k]) : "",
                            quoted(channel.name), channel.unit, values[k]);
                }
            }
    }
    return csv;
}

}  // namespace

std::string numbers_csv(const json& result, const std::string& file) {
    std::string csv = "scene,branch,output,unit,quantity,value,tolerance\n";
    const Field root{&result, "", &file};
    const auto row = [&](const Field& scene, const Field& branch, const ChannelInfo& channel,
                         const char* quantity, double value, double tolerance) {
        csv += fmt::format(
            "{},{},{},{},{},{:.12g},{:.1g}\n", quoted(fs::path(scene["source"].text()).stem().string()),
            quoted(branch["name"].text()), channel.name, channel.unit, quantity, value, tolerance);
    };
    for (const auto& scene : root["scenes"].items())
        for (const auto& branch : scene["branches"].items()) {
            const LegCurve truth = curve_of(branch, "equilibrium");
            for (const auto& channel : main_channels_of(scene)) {
                const auto values = truth.channel(channel.name);
                const auto load = branch["deviation"]["at_equal_load"]["channels"].find(channel.name);
                if (values.empty() || !load) continue;
                // The references agree to far better; a deviation carries the rounding of its many steps.
                const double range = (*load)["range"].number(), fine = 1e-6, coarse = 1e-6 + 1e-6 * range;
                row(scene, branch, channel, "equilibrium at full load", values.back(), fine);
                row(scene, branch, channel, "published at equal load: deviation at full load",
                    (*load)["end"].number(), coarse);
                row(scene, branch, channel, "published at equal load: largest deviation",
                    (*load)["max"].number(), coarse);
                if (const auto travel = branch["deviation"]["at_equal_travel"]["channels"].find(channel.name))
                    row(scene, branch, channel, "published at equal travel: largest deviation",
                        (*travel)["max"].number(), coarse);
            }
        }
    return csv;
}

json parse_result(std::string_view text, const std::string& file) {
    json result = json::parse(text, nullptr, false);
    const Field root{&result, "", &file};
    if (result.is_discarded()) root.fail("is no JSON, or was cut off");
    const Field schema = root["schema"];
    if (schema.text() != result_schema)
        schema.fail(
            fmt::format("'{}' is not a document this program reads; allowed: '{}'. Run the command "
                        "that made it again",
                        schema.text(), result_schema));
    if (root["scenes"].items().empty()) root["scenes"].fail("there is no scene in it");
    return result;
}

void write_report(const json& result, const std::string& file, const fs::path& folder,
                  const ReportOptions& options) {
    Staging staging(folder);
    const Field root{&result, "", &file};
    Page page{staging.path(), options};
    json scenes = json::array();
    for (const auto& scene : root["scenes"].items()) scenes.push_back(page.scene(scene));
    json tints = json::array();
    for (std::size_t k = 0; k < palette.size(); ++k)
        tints.push_back({{"k", k}, {"light", palette[k].light}, {"dark", palette[k].dark}});
    const json data = {
        {"title", scenes.size() == 1 ? scenes[0]["name"] : json(fmt::format("{} scenes", scenes.size()))},
        {"several", scenes.size() > 1},
        {"scenes", scenes},
        {"provenance", provenance(root)},
        {"reproduce", root["reproduce"].text()},
        {"tints", tints}};
    const std::string markdown = render("markdown/page", data, Escape::markdown);
    if (options.archive) {
        write_whole(staging.path() / "README.md", markdown);
        write_whole(staging.path() / "numbers.csv", numbers_csv(result, file));
    } else {
        write_whole(staging.path() / "report.html", render("html/page", data, Escape::html));
        write_whole(staging.path() / "report.md", markdown);
        write_whole(staging.path() / "result.json", result.dump(1) + "\n");
        write_whole(staging.path() / "curves.csv", curves_csv(root));
    }
    staging.publish();
}

}  // namespace elastocheck::reports
