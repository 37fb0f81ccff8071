// Settings: the named numbers of a scene can be listed and varied.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "elastocheck/read_scene.hpp"
#include "tests/models/fixtures.hpp"
#include "tests/models/scene_numbers.hpp"

namespace elastocheck {
namespace {

Scene with(const std::vector<Setting>& settings, const std::string& text = bench_scene) {
    return parse_scene(text, "bench.yaml", settings);
}

std::string complaint_about(const std::vector<Setting>& settings) {
    try {
        with(settings);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "none";
}

void expect_equal(const Scene& a, const Scene& b) { EXPECT_EQ(numbers(a), numbers(b)); }

TEST(Settings, EqualTheSameValuesWrittenInTheFile) {
    const std::tuple<const char*, const char*, const char*, const char*> cases[] = {
        {"points.front.x", "90.5", "front: [100,", "front: [90.5,"},
        {"points.front.y", "1", "front: [100, 0,", "front: [100, 1,"},
        {"springs.coil.rate", "28", "rate: 30,", "rate: 28,"},
        {"bushings.block.stiffness.2.2", "70", "[0, 100, 0, 0, 0, 0]", "[0, 70, 0, 0, 0, 0]"},
        {"bushings.mount.rates.x", "7", "rates: [1, 2, 2], rot", "rates: [7, 2, 2], rot"},
        {"branches.up.to", "-50", "to: 1000", "to: -50"},
        {"branches.up.steps", "7", "steps: 10", "steps: 7"},
        {"springs.coil.to", "side", "to: top, rate", "to: side, rate"},
        {"units.length", "m", "length: mm", "length: m"},
    };
    for (const auto& [path, value, from, to] : cases) {
        SCOPED_TRACE(path);
        expect_equal(with({{path, value}}), with({}, replaced(bench_scene, from, to)));
    }
}

// Each listed number can be set to its own value, and to another value that then appears
// in the scene.
TEST(Settings, EveryListedNumberCanBeSet) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(ELASTOCHECK_SCENES))
        if (entry.path().extension() == ".yaml") files.push_back(entry.path());
    for (const auto& file : files) {
        const Scene scene = read_scene(file);
        EXPECT_GT(scene.numbers.size(), 5U);
        for (const Number& number : scene.numbers) {
            SCOPED_TRACE(file.string() + " " + number.path);
            const Setting same = setting(number.path, number.value);
            expect_equal(read_scene(file, {&same, 1}), scene);
        }
        const Setting half =
            setting(scene.numbers.front().path, 0.5 * scene.numbers.front().value + 1e-3);
        EXPECT_EQ(read_scene(file, {&half, 1}).numbers.front().value,
                  0.5 * scene.numbers.front().value + 1e-3);
    }
}

TEST(Settings, ValueIsOneLineOfPlainText) {
    for (const std::string& text :
         {std::string(), std::string("1\n2"), std::string("\xFF"), std::string(300, '1')})
        EXPECT_NE(complaint_about({{"springs.coil.rate", text}})
                      .find("cannot be set; allowed: one line of plain text"),
                  std::string::npos);
}

TEST(Settings, AssignmentInOneWordIsParsed) {
    const Setting parsed = parse_setting("points.tie_rod_inner.z=-0.055");
    EXPECT_EQ(parsed.path, "points.tie_rod_inner.z");
    EXPECT_EQ(parsed.value, "-0.055");
    for (const char* wrong : {"", "=", "a", "a=", "=1"})
        EXPECT_THROW(parse_setting(wrong), SceneError) << wrong;
    EXPECT_EQ(setting("a", 0.1).value, "0.1");
    EXPECT_EQ(setting("a", -28e3).value, "-28000");
}

// ---- rewrite_scene

constexpr const char* written = R"(# a comment
elastocheck: 1   # the version
name: "two points"
points:
  a: [0.1, -0.2, 30e-2]  # first: "a"
  'b': {at: [1, 2,
             3]}
springs: {coil: {rate: "30e3", law: 'x # y', free: 4}}
last: 7)";

TEST(RewriteScene, ChangesOnlyTheValues) {
    const std::vector<Setting> settings{{"points.a.z", "0.25"},     {"points.a.x", "-1"},
                                        {"points.b.at.z", "3.5"},   {"points.b.at.y", "2.5"},
                                        {"springs.coil.rate", "1"}, {"last", "8"}};
    EXPECT_EQ(rewrite_scene(written, "a.yaml", settings), R"(# a comment
elastocheck: 1   # the version
name: "two points"
points:
  a: [-1, -0.2, 0.25]  # first: "a"  # points.a.x was 0.1, points.a.z was 30e-2
  'b': {at: [1, 2.5,  # points.b.at.y was 2
             3.5]}  # points.b.at.z was 3
springs: {coil: {rate: 1, law: 'x # y', free: 4}}  # springs.coil.rate was 30e3
last: 8  # last was 7)");
    EXPECT_EQ(rewrite_scene(written, "a.yaml", {}), written);
    const Setting last{"a", "2"};
    EXPECT_EQ(rewrite_scene("a: 1\r\nb: 3\r\n", "a.yaml", {&last, 1}),
              "a: 2  # a was 1\r\nb: 3\r\n");
}

TEST(RewriteScene, CommentOfAnEarlierRewriteIsReplacedAndOthersAreKept) {
    const Setting x{"p.x", "5"}, b{"b", "2"};
    EXPECT_EQ(rewrite_scene("p: {x: 4, y: 2}  # p.x was 3, p.y was 1\n", "a.yaml", {&x, 1}),
              "p: {x: 5, y: 2}  # p.x was 4, p.y was 1\n");
    EXPECT_EQ(rewrite_scene("b: 1  # it was 0, once\n", "a.yaml", {&b, 1}),
              "b: 2  # it was 0, once  # b was 1\n");
}

// Every number of every built-in scene is found at its place, and the rewritten scene is the one
// that read_scene() makes with the setting.
TEST(RewriteScene, FindsEveryNumberOfTheBuiltInScenes) {
    int compared = 0;
    for (const auto& entry : std::filesystem::directory_iterator(ELASTOCHECK_SCENES)) {
        if (entry.path().extension() != ".yaml") continue;
        const std::string file = entry.path();
        std::ifstream in(file);
        const std::string text{std::istreambuf_iterator<char>(in), {}};
        const Scene scene = read_scene(file);
        std::vector<Setting> settings;
        for (const Number& number : scene.numbers)
            settings.push_back(setting(number.path, number.value));
        const Scene again = parse_scene(rewrite_scene(text, file, settings), file);
        ASSERT_EQ(again.numbers.size(), scene.numbers.size()) << file;
        for (std::size_t k = 0; k < scene.numbers.size(); ++k) {
            EXPECT_EQ(again.numbers[k].path, scene.numbers[k].path);
            EXPECT_EQ(again.numbers[k].value, scene.numbers[k].value) << scene.numbers[k].path;
            ++compared;
        }
    }
    EXPECT_GT(compared, 500);
}

TEST(RewriteScene, NumbersNotWrittenAsOneWordAreRejected) {
    const auto complaint = [](const char* text, const Setting& setting) -> std::string {
        try {
            (void)rewrite_scene(text, "a.yaml", {&setting, 1});
        } catch (const SceneError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(complaint(written, {"points.c.x", "1"}),
              "a.yaml: points.c.x: points has no 'c'; there: a, b");
    EXPECT_EQ(complaint("a: \"1\\x32\"\n", {"a", "3"}),
              "a.yaml:1: a: cannot be replaced where it is written; write it on one line, without "
              "escapes");
    EXPECT_EQ(complaint("a: >-\n  12\n", {"a", "3"}),
              "a.yaml:1: a: cannot be replaced where it is written; write it on one line, without "
              "escapes");
}

}  // namespace
}  // namespace elastocheck
