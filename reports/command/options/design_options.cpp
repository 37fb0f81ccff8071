#include "reports/command/options/design_options.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "compare/candidate/candidate.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/comparison/points.hpp"
#include "compare/definitions/figure_words.hpp"
#include "models/reader/document/cursor.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/yaml.hpp"
#include "reports/document/measurement.hpp"
#include "reports/files/files.hpp"

namespace elastocheck::reports {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr FileKind changed_scene{"scene changed by elastocheck", "# Changed by elastocheck "};

double number_of(std::string_view text, const std::string& option, const std::string& word) {
    double value = 0;
    const char *first = text.data(), *last = first + text.size();
    if (text.starts_with('+')) ++first;  // from_chars rejects a plus
    const auto [end, error] = std::from_chars(first, last, value);
    if (error != std::errc() || end != last || !std::isfinite(value))
        throw std::invalid_argument(
            fmt::format("{} '{}': '{}' is not a number", option, word, text));
    return value;
}

void add(Settings& settings, const Number& number, double value) {
    for (const std::string& path : compare::paths_in(number.path))
        settings.push_back(elastocheck::setting(path, value));
}

Settings without(Settings settings, const std::vector<Number>& numbers) {
    for (const Number& number : numbers)
        for (const std::string& path : compare::paths_in(number.path))
            std::erase_if(settings, [&](const Setting& one) { return one.path == path; });
    return settings;
}

// The number of a name; of several joined by commas, which have the same value.
Number number_of_path(const std::string& joined, const Scene& scene) {
    Number number;
    for (const std::string& path : compare::paths_in(joined)) {
        const auto found = find_number(scene, path);
        if (!found) {
            std::vector<std::string> names;
            for (const Number& other : scene.numbers) names.push_back(other.path);
            throw std::invalid_argument(fmt::format("--vary: the scene has no number {}{}",
                                                    reader::quote(path),
                                                    reader::did_you_mean(path, names, "numbers")));
        }
        const Number& one = *found;
        if (number.path.empty()) number = one;
        if (one.value != number.value || one.unit != number.unit)
            throw std::invalid_argument(fmt::format(
                "--vary '{}': {} and {} are not the same, so that they cannot change together",
                joined, number.path, path));
    }
    number.path = joined;
    return number;
}

}  // namespace

Varied parse_varied(const std::vector<std::string>& words, const Scene& scene) {
    constexpr double none = std::numeric_limits<double>::infinity();
    struct Limits {
        double low = -none, high = none;
    };
    Varied varied;
    std::vector<Limits> limits;
    for (const std::string& word : words) {
        const auto equals = word.find('=');
        const std::string path = word.substr(0, equals);
        Limits of;
        if (equals != word.npos) {
            const std::string range = word.substr(equals + 1);
            const auto colon = range.find(':');
            if (colon == range.npos)
                throw std::invalid_argument(
                    fmt::format("--vary '{}': allowed: NAME=LOW:HIGH, such as "
                                "points.tie_rod_inner.z=260:340",
                                word));
            of = {number_of(range.substr(0, colon), "--vary", word),
                  number_of(range.substr(colon + 1), "--vary", word)};
            if (!(of.low < of.high))
                throw std::invalid_argument(
                    fmt::format("--vary '{}': the lower limit is not below the upper one", word));
        }
        std::vector<Number> matching;
        if (path.find('*') != path.npos)
            std::ranges::copy_if(scene.numbers, std::back_inserter(matching),
                                 [&](const Number& number) {
                                     return ::fnmatch(path.c_str(), number.path.c_str(), 0) == 0;
                                 });
        if (matching.empty()) matching.push_back(number_of_path(path, scene));
        for (const Number& number : matching) {
            if (std::ranges::find(varied.numbers, number.path, &Number::path) !=
                varied.numbers.end())
                throw std::invalid_argument(fmt::format("--vary: {} is given twice", number.path));
            varied.numbers.push_back(number);
            limits.push_back(of);
        }
    }
    const auto n = static_cast<Index>(limits.size());
    varied.start.resize(n), varied.low.resize(n), varied.high.resize(n);
    for (Index k = 0; k < n; ++k) {
        const auto i = static_cast<std::size_t>(k);
        varied.start[k] = varied.numbers[i].value;
        varied.low[k] = limits[i].low, varied.high[k] = limits[i].high;
    }
    return varied;
}

compare::SceneAt scene_at(const std::string& file, const Settings& settings,
                          const std::vector<Number>& numbers) {
    return [file, fixed = without(settings, numbers), numbers](const VectorXd& p) {
        Settings all = fixed;
        for (std::size_t k = 0; k < numbers.size(); ++k)
            add(all, numbers[k], p[static_cast<Index>(k)]);
        return read_scene(file, all);
    };
}

NamedFigure parse_figure(const std::string& word, const std::string& option, const Model& model) {
    const auto outputs = compare::figure_outputs(model);
    try {
        const auto [output, station, placed] = compare::parse_figure_words(word, model, outputs);
        const compare::Unit unit = compare::unit_of(station.branch->unit);
        const double at = station.at.value_or(0);
        return {{.name = output->name, .branch = station.branch->name, .at = at},
                *output,
                fmt::format("{} = {:g} {}", station.branch->name, at * compare::in_unit(unit),
                            symbol(unit))};
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(option + ": " + error.what());
    }
}

std::pair<NamedFigure, double> parse_wanted(const std::string& word, const Model& model) {
    const auto equals = word.rfind('=');
    if (equals == word.npos || equals == 0)
        throw std::invalid_argument(fmt::format(
            "--want '{}': allowed: OUTPUT=VALUE or OUTPUT@BRANCH:PARAMETER=VALUE, such as "
            "bump_steer=0 or toe@jounce:3000=-0.1",
            word));
    return {parse_figure(word.substr(0, equals), "--want", model),
            number_of(word.substr(equals + 1), "--want", word)};
}

std::vector<compare::Figure> figures_of(const std::vector<NamedFigure>& named_figures) {
    std::vector<compare::Figure> figures;
    for (const NamedFigure& one : named_figures) figures.push_back(one.figure);
    return figures;
}

Tolerances read_tolerances(std::string_view yaml, const std::string& file, const Scene& scene) {
    const reader::Value tree = reader::parse_yaml(yaml, file);
    std::vector<Number> ignored;
    const reader::Cursor whole{&tree, "", &file, &ignored};
    std::vector<std::string> names, known;
    for (const Number& number : scene.numbers) known.push_back(number.path);
    Tolerances all;
    const auto positive = [](const reader::Cursor& at) {
        const double value = at.number();
        if (!(value > 0)) at.fail(fmt::format("{:g}; allowed: more than zero", value));
        return value;
    };
    for (const auto& [name, at] : whole.entries(reader::Cursor::Keys::numbers)) {
        if (name == "correlations") continue;
        if (!find_number(scene, name))
            at.fail("the scene has no such number" + reader::did_you_mean(name, known, "numbers"));
        at.only_keys({"normal", "uniform"});
        const auto normal = at.optional("normal"), uniform = at.optional("uniform");
        if (normal.has_value() == uniform.has_value())
            at.fail("allowed: one of {normal: {sd: ...}} and {uniform: {half_width: ...}}");
        const char* size = normal ? "sd" : "half_width";
        const reader::Cursor of = normal ? *normal : *uniform;
        of.only_keys({size});
        const double value = positive(of.require(size));
        all.numbers.push_back(normal ? compare::normal(name, value)
                                     : compare::uniform(name, value));
        names.push_back(name);
    }
    if (names.empty()) whole.fail("no tolerance; allowed: NUMBER: {normal: {sd: 0.5}}");
    const auto correlations = whole.optional("correlations");
    if (!correlations) return all;
    const auto n = static_cast<Index>(names.size());
    all.correlation = Eigen::MatrixXd::Identity(n, n);
    for (const reader::Cursor& entry : correlations->items()) {
        const auto parts = entry.list(3, "two numbers of the file and their correlation");
        Index k[2];
        for (std::size_t i = 0; i < 2; ++i)
            k[i] = static_cast<Index>(parts[i].one_of("a number with a tolerance", names));
        const double rho = parts[2].number();
        if (k[0] == k[1]) entry.fail("a number with itself");
        if (!(std::abs(rho) <= 1)) parts[2].fail(fmt::format("{:g}; allowed: -1 to 1", rho));
        all.correlation(k[0], k[1]) = all.correlation(k[1], k[0]) = rho;
    }
    if (!compare::is_correlation(all.correlation))
        correlations->fail("contradict each other: their matrix has a negative eigenvalue");
    return all;
}

namespace {

// The comparison with the range of each branch as the curve of the equilibrium leg; solved where a
// point lies by its travel, or names no branch.
void add_ranges(compare::Comparison& outline, const Model& model, const compare::Points& points) {
    const auto is_given = [](double x) { return std::isfinite(x); };
    const bool solved =
        points.branch.empty() || points.a.empty() || !std::ranges::all_of(points.a, is_given);
    for (std::size_t b = 0; b < model.branches.size(); ++b) {
        const Branch& branch = model.branches[b];
        compare::BranchComparison& of = outline.branches[b];
        of.runs.resize(compare::legs.size());
        compare::PathCurve& run = of.runs[static_cast<std::size_t>(compare::Leg::equilibrium)];
        if (solved && (points.branch.empty() ||
                       std::ranges::find(points.branch, branch.name) != points.branch.end()))
            run =
                compare::walk(model, compare::channels(model), branch,
                              compare::sides_of(model, branch), {.leg = compare::Leg::equilibrium});
        else
            for (const double end :
                 {std::min(branch.from, branch.to), std::max(branch.from, branch.to)})
                run.curve.a.push_back(compare::in_unit(of.unit) * end),
                    run.curve.values.emplace_back(outline.channels.size(), 0);
    }
}

// Reason why a point has no figure; empty if it has one.
std::string why_no_figure(const compare::Place& place, const Measurement& data,
                          const compare::Comparison& outline, std::size_t k) {
    const compare::Points& points = data.table.points;
    const bool none = std::ranges::none_of(points.columns, [&](const auto& column) {
        return !is_travel(data.channels[column.channel]) && std::isfinite(column.values[k]);
    });
    if (none) return "without a measured value";
    if (!std::isfinite(place.x)) return "without a parameter or travel";
    if (place.branch < 0) return "that no branch reaches";
    const auto& branch = outline.branches[static_cast<std::size_t>(place.branch)];
    const auto over = compare::placed_by(branch.run(compare::Leg::equilibrium).curve,
                                         place.by_parameter ? std::nullopt : points.abscissa);
    if (over.empty())
        return fmt::format("whose travel does not place them on branch '{}'", branch.branch);
    return compare::reaches(over, place.x)
               ? ""
               : fmt::format("beyond the range of branch '{}'", branch.branch);
}

}  // namespace

MeasuredFigures read_measured(std::string_view csv, const std::string& file, const ColumnMap& map,
                              const Model& model) {
    Measurement data = read_measurement(csv, file, model, map);
    compare::Comparison outline = compare::outline(model);
    compare::Points& points = data.table.points;
    add_ranges(outline, model, points);
    std::vector<compare::Place> places;
    try {
        places = compare::places_of(model, outline, points);
    } catch (const std::invalid_argument& error) {
        fail_at(file, 1, error.what());
    }
    std::vector<compare::Place> kept;
    keep_rows(data.table, [&](std::size_t k) {
        std::string why = why_no_figure(places[k], data, outline, k);
        if (why.empty()) kept.push_back(places[k]);
        return why;
    });
    MeasuredFigures measured;
    std::vector<double> values;
    for (const auto& column : points.columns) {
        const compare::Channel& channel = data.channels[column.channel];
        if (is_travel(channel)) continue;
        bool is_used = false;
        for (std::size_t k = 0; k < kept.size(); ++k) {
            if (!std::isfinite(column.values[k])) continue;
            const auto& [b, by_parameter, x] = kept[k];
            const Branch& of = model.branches[static_cast<std::size_t>(b)];
            measured.figures.push_back(
                {.name = channel.name,
                 .branch = of.name,
                 .at = by_parameter ? x / compare::in_unit(compare::unit_of(of.unit)) : x,
                 .over = by_parameter ? "" : data.channels[*points.abscissa].name,
                 .change = column.change});
            measured.column.push_back(static_cast<int>(measured.columns.size()));
            values.push_back(column.values[k]);
            is_used = true;
        }
        if (is_used) measured.columns.push_back(channel);
    }
    measured.left_out = data.table.left_out;
    if (values.empty())
        fail_at(file, 0,
                "no point lies on a branch of the scene: " + reader::listed(measured.left_out));
    measured.value = Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
    return measured;
}

void check_may_write_scene(const std::string& output) { check_may_write(output, changed_scene); }

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
