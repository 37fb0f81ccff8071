// Drawing of a suspension: every point is named, no words overlap, symbols match the scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "elastocheck/compile.hpp"
#include "reports/document/drawing.hpp"
#include "reports/page/views.hpp"
#include "reports/text/labels.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {
namespace {

Drawing drawing_of(const std::string& name) {
    const Scene scene = support::scene(name);
    return reports::drawing_of(scene, compile(scene), {});
}

Suspension drawn(const std::string& name) { return {drawing_of(name)}; }

std::vector<Figure> all_views(const Suspension& s) {
    auto figures = draw_views(s, {axonometric_view(false)}, large_frame(s));
    for (auto& figure : draw_views(s, {front_view, side_view, top_view}, small_frame(s)))
        figures.push_back(std::move(figure));
    return figures;
}

// [px] on its sheet, y up.
std::vector<Box> boxes(const Figure& figure) {
    std::vector<Box> list;
    for (const auto& word : figure.words) {
        const double x = (word.x - figure.sheet->x) * figure.sheet->scale,
                     y = (word.y - figure.sheet->y) * figure.sheet->scale;
        list.push_back({x, y - 5, x + text_width(word.text, 10), y + 5});
    }
    return list;
}

std::string shown(std::string name) {
    std::ranges::replace(name, '_', ' ');
    return name;
}

TEST(Drawing, LabelsDoNotOverlapAndStayOnTheSheet) {
    for (const auto& name : support::scene_names())
        for (const auto& figure : all_views(drawn(name))) {
            const auto list = boxes(figure);
            for (std::size_t a = 0; a < list.size(); ++a) {
                EXPECT_GE(list[a].left, -0.5)
                    << name << ' ' << figure.id << ": " << figure.words[a].text;
                EXPECT_LE(list[a].right, figure.sheet->width + 0.5)
                    << name << ' ' << figure.id << ": " << figure.words[a].text;
                EXPECT_GE(list[a].bottom, -0.5) << name << ' ' << figure.id;
                EXPECT_LE(list[a].top, figure.sheet->height + 0.5) << name << ' ' << figure.id;
                for (std::size_t b = 0; b < a; ++b)
                    EXPECT_FALSE(overlap(list[a], list[b]))
                        << name << ' ' << figure.id << ": " << figure.words[a].text << " on "
                        << figure.words[b].text;
            }
        }
}

TEST(Drawing, EveryHardpointIsNamedInAtLeastOneView) {
    for (const auto& name : support::scene_names()) {
        const Suspension s = drawn(name);
        std::set<std::string> seen;
        for (const auto& figure : all_views(s))
            for (const auto& word : figure.words) seen.insert(word.text);
        for (const auto& point : s.points)
            EXPECT_TRUE(!point.hardpoint || seen.contains(shown(point.name)))
                << name << ": " << point.name;
    }
}

TEST(Drawing, EveryLineStaysOnTheSheet) {
    for (const auto& name : support::scene_names())
        for (const auto& figure : all_views(drawn(name)))
            for (const auto& series : figure.series)
                for (const auto& row : series.rows) {
                    if (row.empty()) continue;
                    const double x = (row[0] - figure.sheet->x) * figure.sheet->scale,
                                 y = (row[1] - figure.sheet->y) * figure.sheet->scale;
                    ASSERT_TRUE(std::isfinite(x) && x >= -1 && x <= figure.sheet->width + 1 &&
                                std::isfinite(y) && y >= -1 && y <= figure.sheet->height + 1)
                        << name << ' ' << figure.id << ": " << x << ' ' << y;
                }
}

template <class Part>
long count(const std::vector<Part>& list, std::string Part::*field, const std::string& what) {
    return std::ranges::count(list, what, field);
}

TEST(Drawing, DoubleWishboneHasItsPlatesRodsSpringAndBushings) {
    const Drawing d = drawing_of("double_wishbone");
    ASSERT_EQ(d.faces.size(), 3u);
    for (const auto& face : d.faces) EXPECT_EQ(face.points.size(), 3u) << face.body;
    EXPECT_EQ(count(d.links, &Drawing::Link::kind, "spring"), 1) << "its stops are no springs";
    EXPECT_EQ(count(d.links, &Drawing::Link::kind, "rod"), 1);
    EXPECT_EQ(count(d.symbols, &Drawing::Symbol::kind, "bushing"), 4);
    EXPECT_EQ(count(d.symbols, &Drawing::Symbol::kind, "spherical"), 4)
        << "two ball joints, both ends of the tie rod";
    EXPECT_EQ(count(d.symbols, &Drawing::Symbol::kind, "drive"), 1)
        << "the rack; a jack is no part of the suspension";
    EXPECT_EQ(count(d.symbols, &Drawing::Symbol::name, "jack"), 0);
}

TEST(Drawing, BeamIsDrawnAsALineOfItsSegments) {
    const Drawing d = drawing_of("twist_beam");
    double left = -1e9, right = 1e9;
    std::map<std::string, int> lines;  // of the arms, which are mirror images
    for (const auto& link : d.links) {
        lines[link.name] += link.kind == "body";
        if (link.kind != "beam") continue;
        for (const auto k : {link.i, link.j}) {
            const Position& at = d.points[k].at;
            EXPECT_NEAR(at[0], 270, 1e-9);
            EXPECT_NEAR(at[2], -10, 1e-9);
            left = std::max(left, at[1]), right = std::min(right, at[1]);
        }
    }
    EXPECT_NEAR(left, 500, 1e-9);
    EXPECT_NEAR(right, -500, 1e-9);
    EXPECT_EQ(count(d.symbols, &Drawing::Symbol::kind, "bushing"), 2) << "a segment is none";
    EXPECT_EQ(lines["arm_left"], lines["arm_right"]);
}

// In the side view forward is to the left; in the top view it points down the page, below the front
// view, in which left is right.
TEST(Drawing, ViewsHaveTheDirectionsOfATechnicalDrawing) {
    Suspension s;
    s.points = {{"origin", "ground", true, {0, 0, 0}},
                {"forward", "ground", true, {500, 0, 0}},
                {"left", "ground", true, {0, 300, 0}},
                {"up", "ground", true, {0, 0, 400}}};
    const auto figures = draw_views(s, {front_view, side_view, top_view}, {.width = 330});
    const auto at = [&](std::size_t view, const std::string& name) {
        for (const auto& word : figures[view].words)
            if (word.text == name) return std::pair{word.x, word.y};
        ADD_FAILURE() << name << " is not named";
        return std::pair{0.0, 0.0};
    };
    EXPECT_GT(at(0, "left").first, at(0, "up").first + 100);
    EXPECT_GT(at(0, "up").second, at(0, "left").second + 100);
    EXPECT_LT(at(1, "forward").first, at(1, "up").first - 100);
    EXPECT_LT(at(2, "forward").second, at(2, "left").second - 100);
    EXPECT_GT(at(2, "left").first, at(2, "forward").first + 100);
    for (const auto& figure : figures) EXPECT_EQ(figure.sheet->scale, figures[0].sheet->scale);
}

TEST(Labels, LabelsAreSeparateAndOmittedWithoutRoom) {
    std::vector<Label> crowd(12, Label{{100, 100}, 60, 12});
    Paper paper{200, 200, {}, {}};
    const auto placed = place_labels(crowd, paper);
    int found = 0;
    for (std::size_t a = 0; a < placed.size(); ++a) {
        if (!placed[a]) continue;
        ++found;
        for (std::size_t b = 0; b < a; ++b)
            EXPECT_FALSE(placed[b] && overlap(*placed[a], *placed[b]));
    }
    EXPECT_GE(found, 4) << "they are led away from the point";
    paper.taken.push_back({0, 0, 200, 200});
    for (const auto& box : place_labels(crowd, paper)) EXPECT_FALSE(box);
}

TEST(Labels, LabelAvoidsALineIfThereIsRoom) {
    const std::vector<Label> one{{{100, 100}, 40, 12}};
    const Paper paper{200, 200, {{{{100, 100}, {200, 100}}}}, {}};
    const auto placed = place_labels(one, paper);
    ASSERT_TRUE(placed[0]);
    EXPECT_TRUE(placed[0]->bottom > 100 || placed[0]->top < 100 || placed[0]->right < 100);
}

}  // namespace
}  // namespace elastocheck::reports
