#include "compare/design/figure_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "models/reader/document/suggestions.hpp"

namespace elastocheck::compare {
namespace {

template <class Item>
const Item& named(std::span<const Item> items, std::string_view name, const char* one,
                  const char* many) {
    const auto found = std::ranges::find(items, name, &Item::name);
    if (found != items.end()) return *found;
    std::vector<std::string> names;
    for (const Item& item : items) names.push_back(item.name);
    throw std::invalid_argument(fmt::format("the scene has no {} {}{}", one, reader::quote(name),
                                            reader::did_you_mean(name, names, many)));
}

}  // namespace

Station parse_station(std::string_view words, const Model& model) {
    const auto colon = std::min(words.rfind(':'), words.size());
    const Branch& branch = named(std::span<const Branch>(model.branches), words.substr(0, colon),
                                 "branch", "branches");
    if (colon == words.size()) return {&branch, {}};
    std::string_view text = words.substr(colon + 1);
    if (text.starts_with('+')) text.remove_prefix(1);  // from_chars rejects a plus
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw std::invalid_argument(reader::quote(words.substr(colon + 1)) + " is not a number");
    const double factor = in_unit(unit_of(branch.unit)),
                 low = factor * std::min(branch.from, branch.to),
                 high = factor * std::max(branch.from, branch.to), within = 1e-9 * (high - low);
    if (!(value >= low - within && value <= high + within))
        throw std::invalid_argument(fmt::format("branch '{}' goes from {:g} to {:g} {}",
                                                branch.name, low, high,
                                                symbol(unit_of(branch.unit))));
    return {&branch, value / factor};
}

FigureWords parse_figure_words(std::string_view words, const Model& model,
                               std::span<const Channel> outputs) {
    if (model.branches.empty())
        throw std::invalid_argument("the scene has no branch, so no output has a value");
    // An output may have an "@" of its own, "left.lateral_force_steer@parallel".
    const auto first = std::min(words.find('@'), words.size()),
               second = std::min(words.find('@', first + 1), words.size()),
               end = find_channel(outputs, words.substr(0, second)) >= 0 ? second : first;
    const Channel& output = named(outputs, words.substr(0, end), "output", "outputs");
    if (end == words.size()) return {&output, {&model.branches.front(), {}}, false};
    return {&output, parse_station(words.substr(end + 1), model), true};
}

}  // namespace elastocheck::compare
