// What texts are read as: edits of a valid text, and facts about the scene that comes of it.
//
//   # a claim
//   - text, + text, ! text   edits, as in files of mistakes (tests/support/mistakes.hpp)
//   $ path=value             a setting
//   : key = values           a fact, exactly; `~`: each number within 1e-15 of it, or of 0 (`~1e-13`:
//                            within that); `is`: the values are those of another key
//   = accepted, ~ part       instead: it is read, or refused with this part of the message
//   = the same scene         instead: it is read as the text without the edits
//
// A key is that of a number (scene_numbers.hpp), or of all that begin with it and a dot: "branch up.to",
// "joint jack.i", a point: its body and place. Units count from newton, newton_metre, metre, radian.
// Others: the names in "bodies", "joints", "elements", "branches", "wheels", "dampers", "loads" (static);
// "adjusted" and "conditions" of a trim; "number PATH", its value and unit; "omissions", and the reason in
// "omitted WHAT". "kept KEY" is of the model by compile(), "whole KEY" of that with Detail::everything.
// Every claim of tests/models sets each number of its scene to its own value as well, which must change nothing.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/models/scene_numbers.hpp"
#include "tests/support/mistakes.hpp"

namespace elastocheck {

struct ReadClaim {
    std::string file, name;
    int line = 0;
    std::vector<std::pair<std::string, std::string>> edits;  // an empty first part: the whole text
    std::vector<Setting> settings = {};
    std::vector<std::string> facts = {};
};
inline void PrintTo(const ReadClaim& claim, std::ostream* out) {
    *out << claim.file << ":" << claim.line;
}

inline std::vector<ReadClaim> claims_in(const std::filesystem::path& file) {
    std::vector<ReadClaim> all;
    std::ifstream lines(file);
    std::string line, right;
    for (int n = 1; std::getline(lines, line); ++n) {
        const char mark = line.empty() ? '\0' : line.front();
        const std::string rest =
            line.size() < 2 ? "" : support::unescaped(std::string_view(line).substr(2));
        if (mark == '#') {
            std::string name;
            bool begins = true;
            for (const char c : rest) {
                const bool letter = std::isalnum(static_cast<unsigned char>(c)) != 0;
                if (letter) name += static_cast<char>(begins ? std::toupper(c) : c);
                begins = !letter;
            }
            all.push_back({file.stem(), name, n, {}});
        }
        if (mark == '-') right = rest;
        if (mark == '+') all.back().edits.emplace_back(right, rest);
        if (mark == '!') all.back().edits.emplace_back("", rest);
        if (mark == '$') all.back().settings.push_back(parse_setting(rest));
        if (mark == ':') all.back().facts.push_back(rest);
        if (mark == '=' || mark == '~') all.back().facts.push_back(line);
    }
    EXPECT_FALSE(all.empty()) << file;
    return all;
}

// Of all files of facts in a folder.
inline std::vector<ReadClaim> claims_beside(const std::filesystem::path& folder) {
    std::vector<ReadClaim> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".facts")
            for (auto& claim : claims_in(entry.path())) all.push_back(std::move(claim));
    return all;
}
// As a suite of tests names it.
inline std::string name_of(const testing::TestParamInfo<ReadClaim>& claim) {
    return claim.param.file + "_" + claim.param.name;
}

inline std::string edited(std::string text, const ReadClaim& claim) {
    for (const auto& [from, to] : claim.edits)
        text = from.empty() ? to : support::replaced(text, from, to);
    return text;
}

struct Facts {
    std::vector<std::pair<std::string, std::string>> all;

    template <class S>  // a scene or a model
    explicit Facts(const S& scene) {
        names("bodies", scene.bodies), names("joints", scene.joints);
        names("elements", scene.elastics), names("branches", scene.branches);
        names("wheels", scene.wheels), names("dampers", scene.dampers);
        names("loads", scene.static_loads);
        for (const auto& [name, x] : numbers(scene)) all.emplace_back(name, fmt::format("{}", x));
        all.emplace_back("omissions", "");
        for (const auto& [what, why] : scene.omitted) {
            all.emplace_back("omissions", what);
            all.emplace_back("omitted " + what, why);
        }
        if constexpr (requires { scene.numbers; })
            for (const Number& n : scene.numbers)
                all.emplace_back("number " + n.path, fmt::format("{} {}", n.value, n.unit));
        if constexpr (requires { scene.trim; })
            if (scene.trim) {
                names("adjusted", scene.trim->adjust), names("conditions", scene.trim->until);
                all.emplace_back("trim line", fmt::format("{}", scene.trim->line));
            }
    }
    template <class List>
    void names(const std::string& key, const List& list) {
        all.emplace_back(key, "");
        for (const auto& one : list) all.emplace_back(key, one.name);
    }
    // "none" where there is none.
    std::vector<std::string> of(const std::string& key) const {
        std::vector<std::string> words;
        bool there = false;
        for (const auto& [name, text] : all) {
            if (!name.starts_with(key)) continue;
            if (name.size() > key.size() && name[key.size()] != '.' && name[key.size()] != '(')
                continue;
            there = true;
            std::istringstream in(text);
            for (std::string word; in >> word;) words.push_back(word);
        }
        if (!there) words.emplace_back("none");
        return words;
    }
};

inline bool agree(const std::string& is, const std::string& expected, double tolerance) {
    char *end = nullptr, *other = nullptr;
    const double a = std::strtod(is.c_str(), &end), b = std::strtod(expected.c_str(), &other);
    if (end == is.c_str() || *end != '\0' || other == expected.c_str() || *other != '\0')
        return is == expected;
    return std::abs(a - b) <= tolerance * (b == 0 ? 1 : std::abs(b));
}

// `read` makes the scene of a text, or throws a SceneError.
inline void expect_facts(
    const ReadClaim& claim, const std::string& valid,
    const std::function<Scene(const std::string&, const std::vector<Setting>&)>& read,
    bool set_each_number = true) {
    std::string refusal = "accepted";
    Scene scene;
    try {
        scene = read(edited(valid, claim), claim.settings);
    } catch (const SceneError& error) {
        refusal = error.what();
    }
    const Facts as_read(scene);
    std::set<std::string> paths;
    for (const Number& number : scene.numbers)
        EXPECT_TRUE(paths.insert(number.path).second) << number.path << " is the name of two";
    if (set_each_number && claim.settings.empty())
        for (const Number& number : scene.numbers) {
            const auto again = read(edited(valid, claim), {setting(number.path, number.value)});
            EXPECT_EQ(numbers(again), numbers(scene)) << number.path << ", set to its value";
        }
    for (const std::string& fact : claim.facts) {
        SCOPED_TRACE(claim.file + ".facts: " + fact);
        if (fact == "= the same scene") {
            EXPECT_EQ(as_read.all, Facts(read(valid, {})).all) << refusal;
            continue;
        }
        if (fact.starts_with("~ ") || fact.starts_with("= ")) {
            EXPECT_NE(refusal.find(fact.substr(2)), refusal.npos) << refusal;
            continue;
        }
        ASSERT_EQ(refusal, "accepted");
        const auto at = std::min({fact.find(" ="), fact.find(" ~"), fact.find(" is ")});
        ASSERT_NE(at, fact.npos);
        const std::string key = fact.substr(0, at);
        const bool kept = key.starts_with("kept "), whole = key.starts_with("whole ");
        const Facts facts =
            kept || whole ? Facts(compile(scene, kept ? Detail::required : Detail::everything))
                          : as_read;
        const auto is = facts.of(kept ? key.substr(5) : whole ? key.substr(6) : key);
        std::istringstream words(fact.substr(at));
        std::string relation;
        std::vector<std::string> expected;
        words >> relation;
        for (std::string word; words >> word;) expected.push_back(word);
        if (relation == "is") expected = facts.of(fmt::format("{}", fmt::join(expected, " ")));
        const double tolerance = relation == "~"             ? 1e-15
                                 : relation.starts_with('~') ? std::stod(relation.substr(1))
                                                             : 0;
        bool same = is.size() == expected.size();
        for (std::size_t k = 0; same && k < is.size(); ++k)
            same = agree(is[k], expected[k], tolerance);
        EXPECT_TRUE(same) << "it is " << fmt::format("{}", fmt::join(is, " "));
    }
}

}  // namespace elastocheck
