#include "reports/document/rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "compare/outputs/catalogue/catalogue.hpp"
#include "reports/document/wheels.hpp"

namespace elastocheck::reports {
namespace {

// Words in lower case; everything else than letters and digits separates them.
std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    bool open = false;
    for (const char c : text) {
        const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        const bool letter = (lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9');
        if (letter && !open) words.emplace_back();
        if (letter) words.back() += lower;
        open = letter;
    }
    return words;
}

bool has(const std::vector<std::string>& words, std::string_view word) {
    return std::ranges::find(words, word) != words.end();
}

struct Test {
    std::string_view word;
    std::array<std::string_view, 2> moves;  // load cases that it may be
};
constexpr std::array tests{Test{"bounce", {"heave", "travel"}},
                           Test{"ride", {"heave", "travel"}},
                           Test{"heave", {"heave", "travel"}},
                           Test{"bump", {"heave", "travel"}},
                           Test{"roll", {"roll", ""}},
                           Test{"steer", {"steering", ""}},
                           Test{"steering", {"steering", ""}},
                           Test{"aligning", {"moment", ""}},
                           Test{"braking", {"longitudinal force", ""}},
                           Test{"brake", {"longitudinal force", ""}},
                           Test{"traction", {"longitudinal force", ""}},
                           Test{"driving", {"longitudinal force", ""}},
                           Test{"lateral", {"lateral force", ""}}};

// Words of a heading that means a column other than an output, and which; the side is taken out before.
// Those of outputs are in the catalogue.
struct Heading {
    std::string_view words;
    std::string_view column;
    std::string_view moves = {};  // of a parameter
};
constexpr std::array headings{Heading{"lateral force", "parameter", "lateral force"},
                              Heading{"longitudinal force", "parameter", "longitudinal force"},
                              Heading{"vertical force", "parameter", "heave"},
                              Heading{"braking force", "parameter", "longitudinal force"},
                              Heading{"traction force", "parameter", "longitudinal force"},
                              Heading{"aligning torque", "parameter", "moment"},
                              Heading{"aligning moment", "parameter", "moment"},
                              Heading{"rack travel", "parameter", "steering"},
                              Heading{"rack displacement", "parameter", "steering"},
                              Heading{"steering wheel angle", "parameter", "steering"},
                              Heading{"test", "branch"},
                              Heading{"test name", "branch"},
                              Heading{"load case", "branch"}};

}  // namespace

std::vector<TestBranch> tests_of(const Model& model) {
    std::vector<TestBranch> tests;
    for (const Branch& branch : model.branches)
        tests.push_back({branch.name, load_case(model, branch),
                         compare::unit_of(branch.unit) == compare::Unit::mm});
    return tests;
}

std::vector<std::string> branches_of_test(std::string_view test,
                                          const std::vector<TestBranch>& branches) {
    const auto words = words_of(test);
    const auto known =
        std::ranges::find_if(tests, [&](const Test& t) { return has(words, t.word); });
    if (known == tests.end()) return {};
    std::vector<std::string> found;
    for (const auto& moves : known->moves)
        if (found.empty() && !moves.empty())
            for (const auto& one : branches)
                if (one.moves == moves) found.push_back(one.branch);
    if (found.size() < 2) return found;
    // the one that is called so: by all of the words that some of them have
    for (const auto& word : words) {
        std::vector<std::string> called;
        for (const auto& name : found)
            if (has(words_of(name), word)) called.push_back(name);
        if (!called.empty()) found = std::move(called);
    }
    if (found.size() > 1) {
        std::vector<std::string> by_travel;
        for (const auto& one : branches)
            if (one.by_travel && std::ranges::find(found, one.branch) != found.end())
                by_travel.push_back(one.branch);
        if (by_travel.size() == 1) found = std::move(by_travel);
    }
    return found;
}

std::optional<RigHeading> heading_of_rig(std::string_view heading,
                                         const compare::Comparison& comparison,
                                         const std::vector<TestBranch>& tests) {
    // the unit in brackets, or after the last _
    std::string_view rest = heading, unit;
    for (const auto& [open, close] : {std::pair{'[', ']'}, {'(', ')'}})
        if (const auto at = heading.find(open); at != heading.npos)
            if (const auto end = heading.find(close, at); end != heading.npos && unit.empty())
                unit = heading.substr(at + 1, end - at - 1), rest = heading.substr(0, at);
    auto words = words_of(rest);
    std::string side;
    std::erase_if(words, [&](const std::string& word) {
        const bool left = word == "left" || word == "lh" || word == "l",
                   right = word == "right" || word == "rh" || word == "r";
        if (left || right) side = left ? "left" : "right";
        return left || right;
    });
    std::string joined;
    for (const auto& word : words) joined += (joined.empty() ? "" : " ") + word;
    const auto known = std::ranges::find(headings, joined, &Heading::words);
    const compare::Entry* entry = compare::find_by_heading(joined);
    if (known == headings.end() && entry == nullptr) return std::nullopt;
    std::string name(entry != nullptr ? std::string_view(entry->name) : known->column);
    std::string_view moves = entry != nullptr ? "" : known->moves;
    if (moves == "heave" && std::ranges::none_of(tests, [&](const TestBranch& test) {
            return test.moves == moves && !test.by_travel;
        }))
        name = compare::figure::wheel_load, moves = "";
    if (name != "branch" && name != "parameter" && !side.empty()) {
        const auto is = [&](const std::string& output) {
            return compare::find_channel(comparison.channels, output) >= 0;
        };
        if (is(side + "." + name))
            name = side + "." + name;
        else if (!is(name) || side == "right")
            return std::nullopt;  // this scene has no such wheel; its only wheel is drawn left
    }
    // units as rigs write them
    constexpr std::array<std::pair<std::string_view, std::string_view>, 8> written{
        {{"degrees", "deg"},
         {"degree", "deg"},
         {"°", "deg"},
         {"min", "arcmin"},
         {"minutes", "arcmin"},
         {"arc-minutes", "arcmin"},
         {"arcminutes", "arcmin"},
         {"N.m", "Nm"}}};
    for (const auto& [theirs, ours] : written)
        if (unit == theirs) unit = ours;
    return RigHeading{unit.empty() ? name : fmt::format("{} [{}]", name, unit), std::string(moves)};
}

}  // namespace elastocheck::reports
