// Fuzz test: for any damaged scene text the reader returns a finite scene or throws SceneError.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <random>
#include <regex>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/models/axle_scene.hpp"
#include "tests/models/bench_scene.hpp"
#include "tests/models/laws_scene.hpp"
#include "tests/models/scene_numbers.hpp"
#include "tests/support/folder.hpp"

namespace elastocheck {
namespace {

// Parts missing in the other scenes: beams, tyres, trim, gravity, torsion springs with a mirror.
const std::string car_scene = R"(elastocheck: 1
name: car
units: {length: mm, angle: deg, force: kN}
mirror: left -> right
gravity: [0, 0, -9.81]
points: {hub_left: [0, 700, 0], road_left: [0, 700, -300], end_left: [90, 500, 9], mid: [200, 0, 9], top_left: [0, 500, 400]}
bodies:
  hub_left: {origin: hub_left, mass: 40, centre_of_gravity: road_left}
joints:
  hub_left: {type: translational, bodies: [hub_left, ground], at: hub_left, axis: [1, 0, 5]}
springs:
  coil_left: {bodies: [hub_left, ground], from: hub_left, to: top_left, rate: 0.03, preload: 3}
torsion_springs:
  bar_left: {bodies: [hub_left, ground], at: hub_left, axis: y, rate: 2}
beams:
  bar: {bodies: [hub_left, hub_right], through: [end_left, mid, end_right], segments: 4, E: 206, G: 79, diameter: 22, wall: 3}
  rod_left: {bodies: [hub_left, bar.mid], through: [top_left, mid], segments: 2, up: z,
             E: 206, G: 79, A: 90, I_y: 50, I_z: 70, J: 80, shear_y: 60, shear_z: 60}
tyres:
  tyre_left: {wheel: left, rate: 0.2, preload: 3}
loads:
  push_left: {on: hub_left, at: road_left, force: [0, 0, 1]}
trim: {adjust: [springs.coil_left.preload, springs.coil_right.preload], until: {left.travel: 0, right.travel: 1}, under: {push_left: 3}}
branches:
  bumps: {drive: {tyres.tyre_left.road: 1, tyres.tyre_right.road: -1}, from: -9, to: 50, steps: 6}
wheels:
  left: {body: hub_left, centre: hub_left, contact_patch: road_left, spin_axis: y, side: left}
)";

// These texts contain every field; the scenes in models/scenes/ would only add run time.
std::vector<std::string> sound_texts() {
    std::vector<std::string> texts{bench_scene, axle_scene, laws_scene(every_law), car_scene};
    for (const char* name : {"arch_driven", "pendulum"})
        texts.push_back(support::text_of(std::filesystem::path(ELASTOCHECK_SCENES) /
                                         (std::string(name) + ".yaml")));
    return texts;
}

struct Tally {
    int scenes = 0, errors = 0;
    double slowest = 0;  // [s]
};

// Reads and compiles a damaged text; records the slowest read.
void read_damaged(const std::string& text, Tally& tally) {
    const auto begin = std::chrono::steady_clock::now();
    try {
        const Scene scene = parse_scene(text, "damaged.yaml");
        ++tally.scenes;
        for (const auto& [what, x] : numbers(scene))
            ASSERT_TRUE(std::isfinite(x)) << what << " of\n" << text;
        compile(scene);
    } catch (const SceneError& error) {
        ++tally.errors;
        ASSERT_TRUE(std::string(error.what()).starts_with("damaged.yaml:")) << error.what();
    } catch (const std::exception& error) {
        FAIL() << "not a SceneError: " << error.what() << "\n" << text;
    }
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    tally.slowest = std::max(tally.slowest, time.count());
}

void report(const Tally& tally) {
    EXPECT_GT(tally.errors, 0);
    EXPECT_LT(tally.slowest, 1.0) << "the slowest text took " << tally.slowest << " s";
    testing::Test::RecordProperty("scenes", tally.scenes);
    testing::Test::RecordProperty("errors", tally.errors);
}

TEST(DamagedScene, IsSoundToBeginWith) {
    Tally tally;
    for (const std::string& text : sound_texts()) read_damaged(text, tally);
    EXPECT_EQ(tally.errors, 0);
}

TEST(DamagedScene, WithoutAnyOneLine) {
    Tally tally;
    for (const std::string& text : sound_texts())
        for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end + 1) {
            end = std::min(text.find('\n', begin), text.size());
            read_damaged(text.substr(0, begin) + text.substr(std::min(end + 1, text.size())),
                         tally);
        }
    report(tally);
}

TEST(DamagedScene, WithAnyOneLineTwice) {
    Tally tally;
    for (const std::string& text : sound_texts())
        for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end + 1) {
            end = std::min(text.find('\n', begin), text.size());
            read_damaged(text.substr(0, end) + "\n" + text.substr(begin), tally);
        }
    report(tally);
}

TEST(DamagedScene, CutAtAnyByte) {
    Tally tally;
    for (const std::string& text : sound_texts())
        for (std::size_t end = 0; end < text.size(); ++end)
            read_damaged(text.substr(0, end), tally);
    report(tally);
}

TEST(DamagedScene, WithoutAnyOneByte) {
    Tally tally;
    for (const std::string& text : sound_texts())
        for (std::size_t at = 0; at < text.size(); ++at)
            read_damaged(text.substr(0, at) + text.substr(at + 1), tally);
    report(tally);
}

TEST(DamagedScene, WithBytesOverwritten) {
    Tally tally;
    std::mt19937 random(20040301);
    for (const std::string& text : sound_texts())
        for (int n = 0; n < 1500; ++n) {
            std::string damaged = text;
            for (unsigned k = 0; k <= random() % 3; ++k)
                damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
            read_damaged(damaged, tally);
        }
    report(tally);
}

// Characters with a meaning in YAML or in a scene are the most damaging ones.
// Lines of prose, whose numbers are not numbers of the scene.
bool contains_comment_or_name(const std::string& line) {
    return line.find('#') != std::string::npos || line.starts_with("name:");
}

// Positions of numbers: not adjacent to a letter, digit, point or sign.
std::vector<std::pair<std::size_t, std::size_t>> numbers_in(const std::string& text) {
    static const std::regex number(R"([-+]?\d+\.?\d*(e[-+]?\d+)?(?![\w.]))");
    std::vector<std::pair<std::size_t, std::size_t>> places;
    for (std::sregex_iterator at(text.begin(), text.end(), number), end; at != end; ++at) {
        const auto first = static_cast<std::size_t>(at->position()),
                   length = static_cast<std::size_t>(at->length());
        const char before = first > 0 ? text[first - 1] : '\n';
        const std::string line =
            text.substr(text.rfind('\n', first) + 1, first - text.rfind('\n', first) - 1);
        if (contains_comment_or_name(line)) continue;
        if (before == ' ' || before == '[' || before == ',') places.emplace_back(first, length);
    }
    return places;
}

TEST(DamagedScene, WithAnyOneNumberThatIsNoneOrBeyondRangeIsRefusedAtItsLine) {
    int refused = 0;
    for (const std::string& text : sound_texts())
        for (const auto& [first, length] : numbers_in(text))
            for (const char* bad : {".nan", ".inf", "-.inf", "nan", "inf", "1e308", "-1e308",
                                    "1e999", "5e-324", "-1e-310"}) {
                const auto line = 1 + std::ranges::count(text.substr(0, first), '\n');
                try {
                    parse_scene(text.substr(0, first) + bad + text.substr(first + length),
                                "damaged.yaml");
                    ADD_FAILURE() << bad << " in line " << line << " is taken:\n" << text;
                } catch (const SceneError& error) {
                    EXPECT_TRUE(std::string(error.what())
                                    .starts_with("damaged.yaml:" + std::to_string(line) + ": "))
                        << bad << " in line " << line << ": " << error.what();
                    ++refused;
                }
            }
    EXPECT_GT(refused, 3000);
}

TEST(DamagedScene, WithAnyOneNumberAtTheEndOfItsRange) {
    Tally tally;
    for (const std::string& text : sound_texts())
        for (const auto& [first, length] : numbers_in(text))
            for (const char* extreme : {"0", "1e30", "-1e30", "1e-30", "-1e-30"})
                read_damaged(text.substr(0, first) + extreme + text.substr(first + length), tally);
    report(tally);
}

TEST(DamagedScene, WithTokensPutAnywhere) {
    const char* const tokens[] = {
        "{",    "}",   "[",     "]",        ",",           ":",      ": ", "- ",   "? ",
        "#",    "&a ", "*a",    "!!x ",     "|",           ">",      "\"", "'",    "\n",
        "\n  ", "\t",  "---\n", "...\n",    "<<: ",        "nan",    "-",  "1e30", "e30",
        "e-30", "0",   "999",   "~",        "null",        "ground", "x",  "\\",   "%YAML",
        "\r",   "@",   "`",     "\xC3\xA4", "\xEF\xBB\xBF"};
    Tally tally;
    std::mt19937 random(31415);
    for (const std::string& text : sound_texts())
        for (int n = 0; n < 1500; ++n) {
            std::string damaged = text;
            for (unsigned k = 0; k <= random() % 3; ++k)
                damaged.insert(random() % damaged.size(), tokens[random() % std::size(tokens)]);
            read_damaged(damaged, tally);
        }
    report(tally);
}

TEST(DamagedScene, OfNothingButOneToken) {
    Tally tally;
    for (const char* token : {"[",       "{",   "- ",    "? ", "a: ", "[a, ", "{a: ",  "&a [*a, ",
                              "\"",      "'",   "|",     "!",  "*",   "&",    "%",     "x: [",
                              "- {a: [", "a\n", "- a\n", "\n", "#",   "\r",   "---\n", ": "}) {
        std::string text;
        while (text.size() < 100'000) text += token;
        read_damaged(text, tally);
    }
    report(tally);
}

// Nested aliases ("billion laughs"): two gigabytes if they were expanded.
TEST(DamagedScene, WithABillionLaughs) {
    std::string text = "a0: &a0 ha\n";
    for (int n = 1; n < 10; ++n) {
        text += fmt::format("a{}: &a{} [", n, n);
        for (int k = 0; k < 10; ++k) text += fmt::format("{}*a{}", k ? ", " : "", n - 1);
        text += "]\n";
    }
    Tally tally;
    read_damaged(text, tally);
    report(tally);
}

}  // namespace
}  // namespace elastocheck
