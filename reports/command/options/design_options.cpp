#include "reports/command/options/design_options.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "compare/design/figure_words.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/parsed_scene.hpp"
#include "reports/files/files.hpp"
#include "reports/text/numbers.hpp"

namespace elastocheck::reports {
namespace {

using compare::Varied;
using Eigen::Index;
using Eigen::VectorXd;

constexpr FileKind changed_scene{"scene changed by elastocheck", "# Changed by elastocheck "};

void add(Settings& settings, const Number& number, double value) {
    for (const std::string& path : compare::paths_in(number.path))
        settings.push_back(elastocheck::setting(path, value));
}
Settings without(Settings settings, const std::vector<Number>& numbers) {
    for (const Number& number : numbers)
        for (const std::string& path : compare::paths_in(number.path))
            std::erase_if(settings, [&](const Setting& set) { return set.path == path; });
    return settings;
}

// The number of a name, or of several joined by commas, which must have the same value.
Number number_of_path(const std::string& joined, const Scene& scene) {
    Number number;
    for (const std::string& path : compare::paths_in(joined)) {
        const auto found = find_number(scene, path);
        if (!found) {
            std::vector<std::string> names;
            for (const Number& other : scene.numbers) names.push_back(other.path);
            throw std::invalid_argument(fmt::format("the scene has no number {}{}",
                                                    reader::quote(path),
                                                    reader::did_you_mean(path, names, "numbers")));
        }
        if (number.path.empty()) number = *found;
        if (found->value != number.value || found->unit != number.unit)
            throw std::invalid_argument(
                fmt::format("{} and {} are not the same, so that they cannot change together",
                            number.path, path));
    }
    number.path = joined;
    return number;
}

}  // namespace

void add_numbers(Varied& varied, const Scene& scene, const std::string& name, double low,
                 double high) {
    if (!(low < high)) throw std::invalid_argument("the lower limit is not below the upper one");
    std::vector<Number> matching;
    if (name.find('*') != name.npos)
        std::ranges::copy_if(scene.numbers, std::back_inserter(matching),
                             [&](const Number& number) {
                                 return ::fnmatch(name.c_str(), number.path.c_str(), 0) == 0;
                             });
    if (matching.empty()) matching.push_back(number_of_path(name, scene));
    for (const Number& number : matching) {
        if (std::ranges::find(varied.numbers, number.path, &Number::path) != varied.numbers.end())
            throw std::invalid_argument(number.path + " is given twice");
        varied.numbers.push_back(number);
        const auto n = std::ssize(varied.numbers);
        for (VectorXd* each : {&varied.start, &varied.low, &varied.high})
            each->conservativeResize(n);
        varied.start[n - 1] = number.value;
        varied.low[n - 1] = low;
        varied.high[n - 1] = high;
    }
}

Varied parse_varied(const std::vector<std::string>& words, const Scene& scene) {
    Varied varied;
    for (const std::string& word : words) try {
            const auto equals = word.find('='),
                       colon = word.find(':', std::min(equals, word.size()));
            if (equals == word.npos) {
                add_numbers(varied, scene, word, -INFINITY, INFINITY);
                continue;
            }
            if (colon == word.npos)
                throw std::invalid_argument(
                    "allowed: NAME=LOW:HIGH, such as points.tie_rod_inner.z=260:340");
            add_numbers(varied, scene, word.substr(0, equals),
                        parse_number(std::string_view(word).substr(equals + 1, colon - equals - 1)),
                        parse_number(std::string_view(word).substr(colon + 1)));
        } catch (const std::invalid_argument& error) {
            throw std::invalid_argument(fmt::format("--vary '{}': {}", word, error.what()));
        }
    return varied;
}

void set_scene(Varied& varied, const std::string& file, const Settings& settings) {
    const auto parsed = std::make_shared<const reader::ParsedScene>(file);
    varied.scene = [parsed, fixed = without(settings, varied.numbers),
                    numbers = varied.numbers](const VectorXd& p) {
        Settings all = fixed;
        for (std::size_t k = 0; k < numbers.size(); ++k)
            add(all, numbers[k], p[static_cast<Index>(k)]);
        return parsed->read(all);
    };
}

double parse_number(std::string_view word) {
    if (const auto value = finite_number(word)) return *value;
    throw std::invalid_argument(fmt::format("'{}' is not a number", word));
}

compare::Figure parse_figure(const std::string& word, const Model& model) {
    const auto outputs = compare::figure_outputs(model);
    const auto [output, station, placed] = compare::parse_figure_words(word, model, outputs);
    const compare::Unit unit = compare::unit_of(station.branch->unit);
    const double at = station.at.value_or(0);
    return {.name = output->name,
            .branch = station.branch->name,
            .station = at,
            .unit = symbol(output->unit),
            .station_text = fmt::format("{} = {:g} {}", station.branch->name,
                                        at * compare::in_unit(unit), symbol(unit))};
}

void check_may_write_scene(const std::string& scene, const std::string& output,
                           const Settings& settings) {
    if (output.empty()) return;
    check_may_write(output, changed_scene);
    const auto folder = std::filesystem::path(output).parent_path();
    if (folder == std::filesystem::path(scene).parent_path()) return;
    (void)read_scene(scene, settings);
    (void)reader::ParsedScene(read_whole(scene), output, folder).read(settings);
}

void write_changed_scene(const std::string& scene, const std::string& output,
                         const std::string& first_line, const Settings& settings,
                         const Varied& varied, const VectorXd& p) {
    Settings changes = without(settings, varied.numbers);
    for (std::size_t k = 0; k < varied.numbers.size(); ++k)
        if (const auto i = static_cast<Index>(k); p[i] != varied.start[i])
            add(changes, varied.numbers[k], p[i]);
    std::string text = rewrite_scene(read_whole(scene), scene, changes);
    // The line of an earlier change is replaced.
    if (text.starts_with(changed_scene.beginning)) text.erase(0, text.find('\n') + 1);
    write_whole(output, fmt::format("{}{}\n{}", changed_scene.beginning, first_line, text),
                changed_scene);
    (void)read_scene(output);
}

}  // namespace elastocheck::reports
