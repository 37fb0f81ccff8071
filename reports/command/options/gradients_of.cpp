#include "reports/command/options/gradients_of.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "compare/design/figure_words.hpp"
#include "compare/design/figures.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::reports {
namespace {

// Indices of the names that match one of the patterns, in the order of the names; of all without a
// pattern. Throws std::invalid_argument for a pattern without a match, with the nearest name.
std::vector<std::size_t> matching(const char* option, const char* label, const char* labels,
                                  const std::vector<std::string>& names,
                                  const std::vector<std::string>& patterns) {
    std::vector<bool> chosen(names.size(), patterns.empty());
    for (const auto& pattern : patterns) {
        bool fits = false;
        for (std::size_t k = 0; k < names.size(); ++k)
            if (names[k] == pattern || ::fnmatch(pattern.c_str(), names[k].c_str(), 0) == 0)
                chosen[k] = fits = true;
        if (!fits)
            throw std::invalid_argument(fmt::format("{}: there is no {} {}{}", option, label,
                                                    reader::quote(pattern),
                                                    reader::did_you_mean(pattern, names, labels)));
    }
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < names.size(); ++k)
        if (chosen[k]) places.push_back(k);
    return places;
}
template <class Item, class Name>
std::vector<Item> items_matching(const char* option, const char* label, const char* labels,
                                 const std::vector<Item>& all,
                                 const std::vector<std::string>& patterns, const Name& name) {
    std::vector<std::string> names;
    for (const Item& item : all) names.push_back(name(item));
    std::vector<Item> list;
    for (const std::size_t k : matching(option, label, labels, names, patterns))
        list.push_back(all[k]);
    return list;
}

// The stations "BRANCH:VALUE", values in the unit of the branch's parameter.
std::map<std::string, std::vector<double>> stations(const std::vector<std::string>& words,
                                                    const Model& model) {
    std::map<std::string, std::vector<double>> stations;
    for (const std::string& word : words) {
        compare::Station station;
        try {
            station = compare::parse_station(word, model);
        } catch (const std::invalid_argument& error) {
            throw std::invalid_argument(fmt::format("--at '{}': {}", word, error.what()));
        }
        if (!station.at)
            throw std::invalid_argument(fmt::format(
                "--at '{}': allowed: BRANCH:VALUE, such as {}:{:g}", word, word,
                compare::in_unit(compare::unit_of(station.branch->unit)) * station.branch->to));
        stations[station.branch->name].push_back(*station.at);
    }
    return stations;
}

}  // namespace

std::vector<compare::Gradients> gradients_of(const std::string& file, const Settings& settings,
                                             const LoadedScene& loaded,
                                             const compare::VaryingScene& varying,
                                             std::span<const compare::GradientGroup> groups) {
    return compare::gradients(read_scene(file, settings), {loaded.scene, loaded.trim}, loaded.model,
                              varying, groups);
}

compare::Gradients gradients_of(const std::string& file, const Settings& settings,
                                const LoadedScene& loaded, const GradientsRequest& request,
                                const std::function<void(const std::string&)>& progress) {
    const Model& model = loaded.model;
    auto outputs = compare::figure_outputs(model);
    if (request.of.empty())
        std::erase_if(outputs, [](const compare::Channel& c) { return !c.main; });
    outputs = items_matching("--of", "output", "outputs", outputs, request.of,
                             [](const compare::Channel& c) { return c.name; });
    std::vector<std::string> names;
    for (const Number& number : loaded.scene.numbers) {
        names.push_back(number.path);
        for (const auto& [side, value] : number.sides)  // of one side alone, where it is requested
            if (const std::string path = number.path + "@" + side;
                std::ranges::any_of(request.to, [&](const std::string& word) {
                    return word.find('@') != word.npos &&
                           ::fnmatch(word.c_str(), path.c_str(), 0) == 0;
                }))
                names.push_back(path);
    }
    std::set<std::string> wanted;
    for (const std::size_t k : matching("--to", "number", "numbers", names, request.to))
        wanted.insert(names[k]);
    std::function<bool(const std::string&)> is_wanted;  // empty: all numbers
    if (!request.to.empty())
        is_wanted = [&](const std::string& path) { return wanted.contains(path); };
    const auto varying = compare::varying(file, settings, is_wanted);
    const auto branches = items_matching("--branch", "branch", "branches", model.branches,
                                         request.branches, [](const Branch& b) { return b.name; });
    std::vector<std::string> branch_names;
    for (const Branch& branch : branches) branch_names.push_back(branch.name);
    const compare::GradientGroup group{std::move(outputs),
                                       {.points = request.points,
                                        .stations = stations(request.at, model),
                                        .branches = branch_names,
                                        .threads = request.threads,
                                        .progress = progress}};
    return std::move(gradients_of(file, settings, loaded, varying, std::span(&group, 1)).front());
}

}  // namespace elastocheck::reports
