#include "reports/command/options/gradients_of.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "compare/design/figures.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::reports {
namespace {

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
std::vector<Item> of_names(const char* option, const char* label, const char* labels,
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

}  // namespace

compare::Gradients gradients_of(const std::string& file, const Settings& settings,
                                const LoadedScene& loaded,
                                std::span<const compare::Channel> outputs,
                                std::vector<ModelRate> rates, compare::GradientOptions options) {
    std::vector<compare::VariedNumber> numbers;
    for (const ModelRate& rate : rates)
        numbers.push_back(compare::varied_number(rate, loaded.scene.numbers));
    std::optional<compare::TrimRates> trim;
    if (loaded.trim) {
        trim = compare::trim_rates(read_scene(file, settings), {loaded.scene, loaded.trim}, rates);
        rates = trim->numbers;
        options.trim = &*trim;
    }
    return compare::gradients(loaded.model, outputs, numbers, rates, options);
}

compare::Gradients gradients_of(const std::string& file, const Settings& settings,
                                const LoadedScene& loaded, const GradientsRequest& request,
                                const std::function<void(const std::string&)>& progress) {
    const Model& model = loaded.model;
    auto outputs = compare::figure_outputs(model);
    if (request.of.empty())
        std::erase_if(outputs, [](const compare::Channel& c) { return !c.main; });
    outputs = of_names("--of", "output", "outputs", outputs, request.of,
                       [](const compare::Channel& c) { return c.name; });
    std::vector<ModelRate> rates = all_model_rates(file, settings);
    rates = of_names("--to", "number", "numbers", std::move(rates), request.to,
                     [](const ModelRate& rate) { return rate.path; });
    const auto branches = of_names("--branch", "branch", "branches", model.branches,
                                   request.branches, [](const Branch& b) { return b.name; });
    std::vector<std::string> of_branches;
    for (const Branch& branch : branches) of_branches.push_back(branch.name);
    return gradients_of(file, settings, loaded, outputs, std::move(rates),
                        {.points = request.points,
                         .stations = stations(request.at, model),
                         .branches = of_branches,
                         .progress = progress});
}

}  // namespace elastocheck::reports
