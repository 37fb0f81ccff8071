// `elastocheck sensitivity`: derivatives of the outputs by the numbers of a scene, by all legs.
#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>

#include "compare/design/figures.hpp"
#include "compare/sensitivity/sensitivity.hpp"
#include "models/reader/document/suggestions.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/grammar/command.hpp"
#include "reports/command/grammar/exit_code.hpp"
#include "reports/command/options/gradients_of.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/document/document.hpp"
#include "reports/files/files.hpp"
#include "reports/files/terminal.hpp"
#include "reports/tables/render.hpp"
#include "reports/tables/studies/sensitivity.hpp"

namespace elastocheck::reports {
namespace {

struct SensitivityRequest {
    std::string scene;
    Settings settings;
    std::vector<std::string> of, to, branches, at;
    std::string csv;  // file of all derivatives; empty: none
    int points = 4;
    int most = 5;
    bool as_json = false;
};

// Numbers that the file accepts only together are one entry, their names joined by commas.
bool matches(const std::string& pattern, const std::string& names) {
    if (names == pattern) return true;
    for (std::size_t from = 0; from <= names.size();) {
        const std::size_t end = std::min(names.find(',', from), names.size());
        if (::fnmatch(pattern.c_str(), names.substr(from, end - from).c_str(), 0) == 0) return true;
        from = end + 1;
    }
    return false;
}

// The positions of the names that match one of the patterns, in the order of the names. Throws
// std::invalid_argument for a pattern without a match, with the nearest name.
std::vector<std::size_t> matching(const char* option, const char* label, const char* labels,
                                  const std::vector<std::string>& names,
                                  const std::vector<std::string>& patterns) {
    std::vector<bool> chosen(names.size(), patterns.empty());
    for (const auto& pattern : patterns) {
        bool fits = false;
        for (std::size_t k = 0; k < names.size(); ++k)
            if (matches(pattern, names[k])) chosen[k] = fits = true;
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
std::vector<Item> chosen(const char* option, const char* label, const char* labels,
                         const std::vector<Item>& all, const std::vector<std::string>& patterns,
                         const Name& name) {
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
    std::map<std::string, std::vector<double>> all;
    std::vector<std::string> names;
    for (const Branch& branch : model.branches) names.push_back(branch.name);
    for (const std::string& word : words) {
        const auto colon = word.rfind(':');
        const std::string name = word.substr(0, colon);
        const auto branch = std::ranges::find(model.branches, name, &Branch::name);
        if (branch == model.branches.end())
            throw std::invalid_argument(fmt::format("--at '{}': the scene has no branch {}{}", word,
                                                    reader::quote(name),
                                                    reader::did_you_mean(name, names, "branches")));
        const std::string text = colon == word.npos ? "" : word.substr(colon + 1);
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
            throw std::invalid_argument(
                fmt::format("--at '{}': allowed: BRANCH:VALUE, such as {}:{:g}", word, name,
                            compare::in_unit(compare::unit_of(branch->unit)) * branch->to));
        const double a = value / compare::in_unit(compare::unit_of(branch->unit)),
                     low = std::min(branch->from, branch->to),
                     high = std::max(branch->from, branch->to), within = 1e-9 * (high - low);
        if (!(a >= low - within && a <= high + within))
            throw std::invalid_argument(
                fmt::format("--at '{}': branch '{}' goes from {:g} to {:g} {}", word, name,
                            compare::in_unit(compare::unit_of(branch->unit)) * low,
                            compare::in_unit(compare::unit_of(branch->unit)) * high,
                            symbol(compare::unit_of(branch->unit))));
        all[name].push_back(a);
    }
    return all;
}

// Exit code 0: every leg that applies follows every branch and they agree; else 3.
int sensitivity(const SensitivityRequest& request, const Delivery& delivery) {
    if (!request.csv.empty()) check_may_write(request.csv, gradients_file);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const Model& model = loaded.model;

    auto outputs = compare::figure_outputs(model);
    if (request.of.empty())
        std::erase_if(outputs, [](const compare::Channel& c) { return !c.main; });
    outputs = chosen("--of", "output", "outputs", outputs, request.of,
                     [](const compare::Channel& c) { return c.name; });
    std::vector<ModelRate> rates = all_model_rates(request.scene, request.settings);
    rates = chosen("--to", "number", "numbers", std::move(rates), request.to,
                   [](const ModelRate& rate) { return rate.path; });
    const auto branches = chosen("--branch", "branch", "branches", model.branches, request.branches,
                                 [](const Branch& b) { return b.name; });
    std::vector<std::string> of_branches;
    for (const Branch& branch : branches) of_branches.push_back(branch.name);
    const compare::Gradients all =
        gradients_of(request.scene, request.settings, loaded, outputs, std::move(rates),
                     {.points = request.points,
                      .stations = stations(request.at, model),
                      .branches = of_branches,
                      .progress = [](const std::string& what) { progress(what); }});
    progress("");
    if (!request.csv.empty()) write_whole(request.csv, csv(sensitivity_table(all)), gradients_file);
    delivery.print_text(sensitivity_text(all, request.most));
    if (delivery.as_json) {
        nlohmann::ordered_json document = {{"schema", sensitivity_schema},
                                           {"reproduce", delivery.command},
                                           {"provenance", provenance_json(provenance())}};
        document.update(sensitivity_json(all));
        print_document(document);
    }
    return all.conclusive() ? fine : could_not_judge;
}

}  // namespace

Command sensitivity_command() {
    const auto request = std::make_shared<SensitivityRequest>();
    using enum TextList::Form;
    return {
        "sensitivity",
        "Derivatives of the outputs by the numbers of the scene, by all legs: what should I "
        "change?",
        {scene_option(request->scene),
         {"--of", TextList{&request->of, commas},
          "outputs, names or patterns with *: channels, characteristics such as bump_steer, forces "
          "of elements (default: positions and angles of wheels and probes)"},
         {"--to", TextList{&request->to, commas},
          "numbers of the scene, names as for --set or patterns with * (default: all)"},
         {"--branch", TextList{&request->branches, commas},
          "names of branches, or patterns (default: all)"},
         {"--points", Integer{&request->points, 1, 1000},
          "stations per branch after its start (default: 4)"},
         {"--at", TextList{&request->at, commas},
          "stations BRANCH:VALUE in place of --points for that branch, such as jounce:1500"},
         {"--most", Integer{&request->most, 0, 100000},
          "numbers shown per output, those with the largest effect (default: 5; 0: all)"},
         {"--csv", Text{&request->csv, a_file("*.csv")}, "file of all derivatives at all stations"},
         set_option(request->settings),
         json_option(request->as_json)},
        [request](const std::string& line) {
            return sensitivity(*request, {.as_json = request->as_json, .command = line});
        }};
}

}  // namespace elastocheck::reports
