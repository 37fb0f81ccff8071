// The HTML page without network, for screen readers, on a phone, in a browser.
#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "reports/page/report/report.hpp"
#include "tests/reports/command.hpp"
#include "tests/reports/result.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;

const std::vector<SceneAnalyses>& two_scenes() {
    static const std::vector<SceneAnalyses> both{sample_scene(), sample_scene("pinned_bar")};
    return both;
}

std::string page(const std::vector<SceneAnalyses>& scenes = two_scenes()) {
    const Folder folder;
    write_report(report_of(scenes), folder.path / "r");
    return text_of(folder.path / "r" / "report.html");
}

std::vector<std::string> all(const std::string& text, const std::string& pattern, int group = 1) {
    const std::regex expression(pattern);
    std::vector<std::string> found;
    for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at)
        found.push_back((*at)[static_cast<std::size_t>(group)]);
    return found;
}

// From each `open` to the next `close`.
std::vector<std::string> parts(const std::string& text, const std::string& open,
                               const std::string& close) {
    std::vector<std::string> found;
    for (auto at = text.find(open); at != text.npos; at = text.find(open, at + 1))
        found.push_back(text.substr(at, text.find(close, at) - at + close.size()));
    return found;
}

TEST(Report, PageRequestsNothingFromTheNetwork) {
    const std::string html = page();
    // the page's own three scripts, by their hashes, and no other; data of the drawings are inert
    EXPECT_TRUE(std::regex_search(
        html, std::regex("Content-Security-Policy\" content=\"default-src 'none'; style-src "
                         "'unsafe-inline'; script-src( 'sha256-[A-Za-z0-9+/]{43}='){3}\"")));
    const std::string inert = "<script type=\"application/json\" class=\"motion\">";
    EXPECT_EQ(parts(html, "<script", ">"),
              (std::vector<std::string>{inert, inert, "<script>", "<script>", "<script>"}));
    for (const auto& target : all(html, "(?:href|src)=\"([^\"]*)\""))
        EXPECT_TRUE(target.starts_with("#")) << target;
    for (const char* fetching :
         {"<img", "<link", "<iframe", "<object", "url(", "@import", "@font-face"})
        EXPECT_EQ(html.find(fetching), html.npos) << fetching;
    for (const auto& address : all(html, "(https?://[^\" <]*)"))
        EXPECT_TRUE(address == "http://www.w3.org/2000/svg" ||
                    address == "http://www.w3.org/1999/xlink")
            << address;
}

TEST(Report, PageHeadingsAreInOrderAndIdsAreUnique) {
    const std::string html = page();
    EXPECT_NE(html.find("<html lang=\"en\">"), html.npos);
    int before = 0, first = 0;
    for (const auto& level : all(html, "<h([1-6])[ >]")) {
        const int now = std::stoi(level);
        EXPECT_LE(now, before + 1);
        first += now == 1;
        before = now;
    }
    EXPECT_EQ(first, 1);
    std::set<std::string> ids;
    for (const auto& id : all(html, " id=\"([^\"]*)\"")) EXPECT_TRUE(ids.insert(id).second) << id;
    for (const auto& reference : all(html, "(?:href|xlink:href)=\"#([^\"]*)\""))
        EXPECT_TRUE(ids.contains(reference)) << reference;
    for (const auto& list : all(html, "aria-labelledby=\"([^\"]*)\""))
        for (const auto& reference : all(list, "([^ ]+)"))
            EXPECT_TRUE(ids.contains(reference)) << reference;
}

TEST(Report, EveryFigureOfThePageHasASizeADescriptionAndATable) {
    const std::string html = page();
    const auto figures = parts(html, "<figure", "</figure>");
    EXPECT_GE(figures.size(), 15u);
    for (const auto& figure : figures) {
        EXPECT_NE(figure.find("<figcaption>"), figure.npos);
        EXPECT_NE(figure.find("<table>"), figure.npos);
        EXPECT_NE(figure.find("<th scope=\"row\""), figure.npos);
        const auto drawings = parts(figure, "<svg", "</svg>");
        EXPECT_GE(drawings.size(), 1u);
        for (const auto& svg : drawings) {
            EXPECT_TRUE(std::regex_search(
                svg, std::regex("^<svg width=\"\\d+\" height=\"\\d+\" viewBox=")));
            EXPECT_NE(svg.find("role=\"img\" aria-labelledby="), svg.npos);
            const auto title = all(svg, "<title[^>]*>([^<]*)</title>"),
                       words = all(svg, "<desc[^>]*>([^<]*)</desc>");
            ASSERT_EQ(title.size(), 1u);
            ASSERT_EQ(words.size(), 1u);
            EXPECT_GT(words[0].size(), 40u) << title[0];
        }
    }
    for (const auto& table : parts(html, "<table>", "</table>")) {
        EXPECT_NE(table.find("<caption>"), table.npos);
        EXPECT_NE(table.find("scope=\"col\""), table.npos);
    }
}

TEST(Report, FiguresOfThePageHaveColourClassesInsteadOfColours) {
    for (const auto& svg : parts(page(), "<svg", "</svg>"))
        for (const auto& colour : all(svg, "(?:stroke|fill|color)=['\"]((?:rgb|#)[^'\"]*)['\"]"))
            ADD_FAILURE() << "a colour of its own: " << colour;
}

TEST(Report, PageAndMarkdownHaveTheSameText) {
    const Folder folder;
    write_report(report_of(two_scenes()), folder.path / "r");
    const std::string html = text_of(folder.path / "r" / "report.html"),
                      md = text_of(folder.path / "r" / "report.md");
    EXPECT_EQ(all(html, "<h3[^>]*>([^<]*)</h3>"), all(md, "\n### ([^\n]*)"));
    EXPECT_EQ(all(html, "<h4[^>]*>([^<]*)</h4>"), all(md, "\n#### ([^\n]*)"));
    // except the summary of scenes, which Markdown does not fold
    EXPECT_EQ(parts(html, "<table>", "</table>").size(),
              1 + parts(md, "<details><summary>", "</summary>").size());
    for (const auto& file : all(md, "\\]\\((figures/[^)]*)\\)"))
        EXPECT_TRUE(std::filesystem::exists(folder.path / "r" / file)) << file;
    EXPECT_EQ(all(md, "\\]\\((figures/)").size(), parts(html, "<svg", "</svg>").size());
}

support::RunResult in_a_browser(const Folder& folder, const std::string& html,
                                const std::string& options) {
    return support::shell(
        "chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --enable-logging=stderr "
        "--user-data-dir=" +
        (folder.path / "profile").string() + " " + options + " file://" +
        folder.write("page.html", html));
}

std::string pdf_of(const std::string& html) {
    const Folder folder;
    const std::string pdf = (folder.path / "page.pdf").string();
    EXPECT_EQ(in_a_browser(folder, html, "--no-pdf-header-footer --print-to-pdf=" + pdf).code, 0);
    return text_of(pdf);
}

// In a browser: scripts of browser/ measure the page, and the last writes the result, `seen`, into the body.
json measured_in_a_browser(std::string html, const std::vector<std::string>& scripts,
                           const std::string& width, const std::string& scheme = "1") {
    const Folder folder;
    std::string script;
    for (const auto& name : scripts)
        script += text_of(ELASTOCHECK_CLAIMS "/../browser/" + name + ".js");
    const std::string policy = all(html, "(<meta http-equiv[^>]*>)").at(0);
    html.replace(html.find(policy), policy.size(), "");
    html.insert(
        html.find("</head>"),
        "<script>window.wrong=[];addEventListener('error',e=>wrong.push(e.message));</script>");
    html.insert(html.find("</body>"),
                "<script>" + script +
                    "document.body.innerHTML='<pre>'+JSON.stringify(seen)+'</pre>';</script>");
    const auto said =
        in_a_browser(folder, html,
                     "--window-size=" + width +
                         ",900 --blink-settings=preferredColorScheme=" + scheme + " --dump-dom");
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_EQ(said.err.find(":CONSOLE"), said.err.npos) << said.err;
    const auto found = all(said.out, "<pre>(\\{.*\\})</pre>");
    if (found.size() != 1) throw std::runtime_error(said.out.substr(0, 2000) + said.err);
    return json::parse(found[0]);
}

struct Browser : testing::Test {
    void SetUp() override {
        if (support::shell("command -v chromium").code != 0)
            GTEST_SKIP() << "chromium is not installed";
    }
};

TEST_F(Browser, OpensThePageWithoutAnErrorOrARequest) {
    for (const auto& [width, scheme] : {std::pair{"1280", "1"}, std::pair{"390", "0"}}) {
        const json seen = measured_in_a_browser(page(), {"layout"}, width, scheme);
        EXPECT_TRUE(seen["wrong"].empty()) << seen["wrong"];
        EXPECT_EQ(seen["requests"], 0);
        EXPECT_GE(seen["boxes"].size(), 20u);
        for (const auto& box : seen["boxes"]) {
            EXPECT_GT(box[0], 100) << box;
            EXPECT_GT(box[1], 100) << box;
        }
        EXPECT_TRUE(seen["clashes"].empty())
            << "words on words at " << width << ": " << seen["clashes"];
        EXPECT_TRUE(seen["outside"].empty()) << seen["outside"];
        EXPECT_LE(seen["page"], seen["window"]) << "it has to be scrolled sideways at " << width;
        EXPECT_EQ(seen["dark"], scheme == std::string("0"));
        EXPECT_GE(seen["contrast"], 4.5) << "of text to paper";
        EXPECT_GT(seen["words"], 500);
    }
}

// The content security policy of the page names the hash of this script, so that it runs.
TEST_F(Browser, ShowsTheValueUnderThePointerAndSwitchesCurves) {
    const std::string html = page({compared_scene("front_axle")});
    const json seen = measured_in_a_browser(html, {"values"}, "1280");
    EXPECT_TRUE(seen["before"].get<std::string>().starts_with("wheel travel [mm]: 0\ntoe [deg]\n"))
        << seen;
    for (const char* name : {"\nparallel: ", "\nopposite: ", "\nvertical: ", "\nroll: "})
        EXPECT_NE(seen["before"].get<std::string>().find(name), std::string::npos) << seen;
    EXPECT_EQ(seen["hidden"].get<std::string>().find("vertical"), std::string::npos) << seen;
    EXPECT_EQ(seen["again"], seen["before"]);
    EXPECT_GT(seen["plots"], 10);
    EXPECT_EQ(seen["silent"], 0);
    const Folder folder;
    const auto said = in_a_browser(folder, html, "--dump-dom");
    EXPECT_NE(said.out.find("<html lang=\"en\" class=\"js\">"), std::string::npos) << said.err;
}

TEST_F(Browser, TurnsTheDrawingByPointerAndKeys) {
    const json seen = measured_in_a_browser(page({compared_scene("front_axle")}),
                                            {"drawing", "turn"}, "390", "0");
    EXPECT_TRUE(seen["wrong"].empty()) << seen["wrong"];
    EXPECT_EQ(seen["requests"], 0);
    EXPECT_EQ(seen["hidden"], "none");
    EXPECT_EQ(seen["focus"], 0);
    EXPECT_EQ(seen["buttons"].size(), 6u);
    const auto across = [&](const char* view, int axis) {
        return std::abs(seen[view][1][axis].get<double>() - seen[view][0][axis].get<double>());
    };
    // from the front, both centres are a track apart, and turned by 60 px / 2 about z as far as cos 30°
    EXPECT_GT(across("front", 0), 200);
    EXPECT_NEAR(across("dragged", 0) / across("front", 0), std::cos(M_PI / 6), 2e-3);
    EXPECT_EQ(seen["back"], seen["front"]);
    EXPECT_NEAR(across("key", 0) / across("front", 0), std::cos(M_PI / 36), 2e-3);
    EXPECT_NEAR(across("near", 0) / across("top", 0), 1.25, 2e-3);
}

TEST_F(Browser, MovesTheDrawingByTheDisplacementsOfTheBranch) {
    const SceneAnalyses& scene = compared_scene("front_axle");
    const json seen = measured_in_a_browser(page({scene}), {"drawing", "move"}, "1280");
    EXPECT_TRUE(seen["wrong"].empty()) << seen["wrong"];
    EXPECT_EQ(seen["branch"], "parallel");
    EXPECT_GT(seen["marks"], 5) << "the present position on the figures over travel";
    ASSERT_EQ(scene.comparison.branches[0].branch, "parallel");
    const auto& curve = scene.comparison.branches[0].run(compare::Leg::equilibrium).curve;
    const double px = seen["px_per_mm"];
    const auto index = [&](double a) {
        return static_cast<std::size_t>(std::ranges::find(curve.a, a) - curve.a.begin());
    };
    const std::size_t first = index(seen["a"][0]);
    ASSERT_EQ(seen["at"].size(), 17u);
    for (std::size_t k = 0; k < seen["at"].size(); ++k) {
        const double a = seen["a"][k];
        const json& at = seen["at"][k];
        std::string words = at[0];
        if (words.starts_with("−")) words.replace(0, 3, "-");
        EXPECT_NEAR(std::stod(words), a, 1e-3 * std::abs(a)) << words;
        EXPECT_TRUE(words.ends_with("&nbsp;mm")) << words;
        ASSERT_LT(index(a), curve.a.size());
        for (int w = 0; w < 2; ++w) {
            const std::size_t z =
                channel_of(scene, w == 0 ? "left.wheel_centre_z" : "right.wheel_centre_z");
            const double moved = curve.values[index(a)][z] - curve.values[first][z],
                         drawn = -(at[1 + w].get<double>() -
                                   seen["at"][0][static_cast<std::size_t>(1 + w)].get<double>()) /
                                 px;
            EXPECT_NEAR(drawn, moved, 0.11 / px) << "two roundings to 0.1 px, at " << a;
        }
    }
}

TEST_F(Browser, ShowsTheFixedViewsWithoutScripts) {
    std::string html = page({compared_scene("front_axle")});
    const std::string whole = html;
    for (auto at = html.find("<script>"); at != html.npos; at = html.find("<script>"))
        html.erase(at, html.find("</script>", at) + 9 - at);
    const json seen = measured_in_a_browser(html, {"fixed_views"}, "1280");
    ASSERT_EQ(seen["views"].size(), 4u);
    for (const double height : seen["views"]) EXPECT_GT(height, 100);
    EXPECT_EQ(seen["controls"], 0);
    // In print they are the same, with scripts too.
    const auto printed = [](const std::string& text) {
        return static_cast<double>(pdf_of(text).size());
    };
    std::string without = whole;
    without.replace(without.find("@media screen{.plot svg.still"), 13, "@media print ");
    const double with_scripts = printed(whole), no_scripts = printed(html);
    EXPECT_NEAR(with_scripts / no_scripts, 1, 2e-3);
    EXPECT_GT(std::abs(printed(without) / no_scripts - 1), 2e-3) << "a page without them differs";
}

TEST_F(Browser, ContentSecurityPolicyAllowsTheScriptsOfThePage) {
    const Folder folder;
    const auto said = in_a_browser(folder, page({compared_scene("front_axle")}), "--dump-dom");
    EXPECT_NE(said.out.find("<div class=\"turn\"><svg"), std::string::npos) << said.err;
    EXPECT_EQ(said.err.find("Content Security Policy"), std::string::npos) << said.err;
}

TEST_F(Browser, RowsOfRatesFitTheWidthOfAPhone) {
    const json seen = measured_in_a_browser(page({compared_scene("front_axle")}), {"rates"}, "390");
    EXPECT_GT(seen["rows"], 30);
    EXPECT_LE(seen["tallest"], 100) << "px";
    EXPECT_LE(seen["right"], seen["window"]) << "unit and definition are on the screen";
}

// Pages of A4, by the objects of the PDF.
int printed_pages(const std::string& html) {
    return static_cast<int>(all(pdf_of(html), "(/Type /Page)[^s]").size());
}

TEST_F(Browser, FirstPartOfTheReportOfAnAxlePrintsOnThreeToFivePages) {
    std::string html = page({compared_scene("front_axle")});
    EXPECT_LE(html.size(), 950'000u);
    const int whole = printed_pages(html);
    const auto evidence = html.find("<details class=\"evidence\"");
    ASSERT_NE(evidence, html.npos);
    html.erase(evidence, html.find("</main>") - evidence);
    const int first = printed_pages(html);
    EXPECT_GE(first, 3);
    EXPECT_LE(first, 5);
    EXPECT_GT(whole, first) << "the evidence is an appendix in print, though folded on the screen";
    EXPECT_LE(whole, first + 15);
}

TEST_F(Browser, PrintsTheFirstScreenBelowTheTitleAndPartOneOnANewPage) {
    std::string html = page({compared_scene("mcpherson_strut")});  // without studies
    const auto evidence = html.find("<details class=\"evidence\"");
    ASSERT_NE(evidence, html.npos);
    html.erase(evidence, html.find("</main>") - evidence);
    EXPECT_LE(printed_pages(html), 6) << "the title has a page of its own";
    const auto part_one = html.find("<h3 id=\"mcpherson-strut-part-1");
    ASSERT_NE(part_one, html.npos);
    html.erase(part_one, html.find("</main>") - part_one);
    EXPECT_EQ(printed_pages(html), 1);
}

}  // namespace
}  // namespace elastocheck::reports
