// For a scene text damaged at any one place the reader returns a finite scene or throws SceneError;
// random damages, and texts that once did harm, are in tests/fuzz.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <regex>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/models/fixtures.hpp"
#include "tests/models/scene_numbers.hpp"

namespace elastocheck {
namespace {

// These texts contain every field; the scenes in models/scenes/ would only add run time.
std::vector<std::string> sound_texts() {
    std::vector<std::string> texts{bench_scene, axle_scene, fixture("every_law"), fixture("car")};
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

TEST(DamagedScene, UndamagedSceneIsValid) {
    Tally tally;
    for (const std::string& text : sound_texts()) read_damaged(text, tally);
    EXPECT_EQ(tally.errors, 0);
}

// Every text with one line or byte missing or repeated, or cut at any byte.
TEST(DamagedScene, DamageAtAnyPlaceIsRejectedOrHarmless) {
    using Text = const std::string&;
    const auto end_of_line = [](Text text, std::size_t at) {
        return std::min(text.find('\n', at), text.size());
    };
    const auto begins_line = [](Text text, std::size_t at) {
        return at == 0 || text[at - 1] == '\n';
    };
    const std::function<std::string(Text, std::size_t)> damages[] = {
        [&](Text text, std::size_t at) {  // without a line
            const auto next = std::min(end_of_line(text, at) + 1, text.size());
            return begins_line(text, at) ? text.substr(0, at) + text.substr(next) : "";
        },
        [&](Text text, std::size_t at) {  // a line twice
            const auto end = end_of_line(text, at);
            return begins_line(text, at) ? text.substr(0, end) + "\n" + text.substr(at) : "";
        },
        [](Text text, std::size_t at) { return text.substr(0, at); },
        [](Text text, std::size_t at) { return text.substr(0, at) + text.substr(at + 1); },
    };
    for (const auto& damaged : damages) {
        Tally tally;
        for (const std::string& text : sound_texts())
            for (std::size_t at = 0; at < text.size(); ++at)
                if (const std::string damage = damaged(text, at); !damage.empty())
                    read_damaged(damage, tally);
        report(tally);
    }
}

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

TEST(DamagedScene, NonNumericOrOutOfRangeValueIsRejectedAtItsLine) {
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

TEST(DamagedScene, NumberAtTheEndOfItsRangeIsAcceptedOrRejectedWithAMessage) {
    Tally tally;
    for (const std::string& text : sound_texts())
        for (const auto& [first, length] : numbers_in(text))
            for (const char* extreme : {"0", "1e30", "-1e30", "1e-30", "-1e-30"})
                read_damaged(text.substr(0, first) + extreme + text.substr(first + length), tally);
    report(tally);
}

TEST(DamagedScene, TextOfOneRepeatedTokenIsRejected) {
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

}  // namespace
}  // namespace elastocheck
