#include "reports/study/study_file.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/definitions/figure_words.hpp"
#include "compare/design/figures.hpp"
#include "compare/variants/openturns.hpp"
#include "compare/variants/sampler.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"
#include "models/kinds.hpp"
#include "models/overloaded.hpp"
#include "models/reader/document/cursor.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/elements/vanishing.hpp"
#include "reports/files/csv_table.hpp"
#include "reports/files/files.hpp"
#include "reports/files/provenance.hpp"

namespace elastocheck::reports {
namespace {

using namespace compare::variants;
using Eigen::Index;
using Eigen::MatrixXd;
using reader::Cursor;

const std::vector<std::string> distribution_words{"normal", "uniform", "triangular",
                                                  "truncated_normal", "list"};
const std::vector<std::string> design_words{"grid", "list", "monte_carlo", "latin_hypercube",
                                            "sobol"};

double positive(const Cursor& at) {
    const double value = at.number();
    if (!(value > 0)) at.fail(fmt::format("{:g}; allowed: more than zero", value));
    return value;
}

double number_or(const Cursor& map, const char* key, double otherwise) {
    const auto field = map.optional(key);
    return field ? double(field->number()) : otherwise;
}

// low and high, or half_width about the nominal value.
std::pair<double, double> range_of(const Cursor& at, double nominal) {
    const auto half = at.optional("half_width");
    if (half) {
        if (at.optional("low") || at.optional("high"))
            half->fail("given together with low or high; allowed: one of the two forms");
        const double width = positive(*half);
        return {nominal - width, nominal + width};
    }
    const double low = at.require("low").number(), high = at.require("high").number();
    if (!(low < high)) at.fail(fmt::format("low {:g} is not below high {:g}", low, high));
    return {low, high};
}

Distribution read_distribution(const std::string& word, const Cursor& at, double nominal) {
    if (word == "normal") {
        at.only_keys({"mean", "sd"});
        return Normal{number_or(at, "mean", nominal), positive(at.require("sd"))};
    }
    if (word == "uniform") {
        at.only_keys({"half_width", "low", "high"});
        const auto [low, high] = range_of(at, nominal);
        return Uniform{low, high};
    }
    if (word == "triangular") {
        at.only_keys({"half_width", "low", "mode", "high"});
        const auto [low, high] = range_of(at, nominal);
        const double mode = number_or(at, "mode", nominal);
        if (!(mode >= low && mode <= high))
            at.fail(
                fmt::format("mode {:g} is not between low {:g} and high {:g}", mode, low, high));
        return Triangular{low, mode, high};
    }
    if (word == "truncated_normal") {
        at.only_keys({"mean", "sd", "half_width", "low", "high"});
        const auto [low, high] = range_of(at, nominal);
        const TruncatedNormal d{number_or(at, "mean", nominal), positive(at.require("sd")), low,
                                high};
        if (!(low < d.mean + 8 * d.sd && high > d.mean - 8 * d.sd))
            at.fail("the ends lie more than eight standard deviations beside the mean");
        return d;
    }
    if (!at.is_list()) at.fail("expected a list of values, found " + at.found());
    Levels levels;
    for (const Cursor& value : at.items()) levels.values.push_back(value.number());
    if (levels.values.empty()) at.fail("no value in it");
    return levels;
}

// The file while it is read.
struct Reading {
    Cursor whole;
    const Scene& scene;
    const Model& model;
    Study study = {};
    std::map<std::string, std::string> varied_by = {};  // number of the scene: its variable

    void claim(const Cursor& at, const std::string& path, const std::string& variable) {
        if (path.starts_with("branches."))
            at.fail(path + ": branches are the same for all variants; allowed: other numbers");
        const std::string both = path.substr(0, path.find('@'));
        for (const auto& [other, by] : varied_by)  // of both sides, and of one of them: once
            if (other == path ||
                (other.substr(0, other.find('@')) == both && (other == both || path == both)))
                at.fail(fmt::format("{} is varied by '{}' too", path, by));
        varied_by.emplace(path, variable);
    }

    Variable variable(const std::string& name, const Cursor& at) {
        std::vector<std::string> keys = distribution_words;
        keys.emplace_back("scale");
        at.only_keys(keys);
        Variable result{.name = name, .unit = {}, .nominal = 1, .distribution = Given{}};
        if (const auto scale = at.optional("scale")) {
            std::vector<Cursor> patterns;
            if (scale->is_list())
                patterns = scale->items();
            else
                patterns.push_back(*scale);
            for (const Cursor& one : patterns) {
                const std::string& pattern = one.text("a number of the scene or a pattern with *");
                bool any = false;
                for (const Number& number : scene.numbers)
                    if (::fnmatch(pattern.c_str(), number.path.c_str(), 0) == 0) {
                        claim(one, number.path, name);
                        result.scaled.push_back({number.path, number.value});
                        any = true;
                    }
                if (!any)
                    one.fail(fmt::format("the scene has no number {}{}", reader::quote(pattern),
                                         reader::did_you_mean(pattern, paths(), "numbers")));
            }
        } else {
            const auto number = find_number(scene, name);
            if (!number)
                at.fail("the scene has no such number" +
                        reader::did_you_mean(name, paths(), "numbers") +
                        "; a factor of numbers needs `scale: NUMBERS`");
            claim(at, name, name);
            result.unit = number->unit, result.nominal = number->value;
        }
        int given = 0;
        for (const std::string& word : distribution_words)
            if (const auto field = at.optional(word)) {
                if (++given > 1) field->fail("a second distribution; allowed: one");
                result.distribution = read_distribution(word, *field, result.nominal);
            }
        return result;
    }
    std::vector<std::string> paths() const {
        std::vector<std::string> all;
        for (const Number& number : scene.numbers) all.push_back(number.path);
        return all;
    }

    void variables() {
        const Cursor section = whole.require("variables");
        for (const auto& [name, at] : section.entries(Cursor::Keys::numbers))
            study.variables.push_back(variable(name, at));
        if (study.variables.empty())
            section.fail("no variable; allowed: NUMBER: {normal: {sd: 0.5}}");
        if (study.variables.size() > most_variables)
            section.fail(fmt::format("{} variables; allowed: up to {}", study.variables.size(),
                                     most_variables));
    }

    std::vector<std::string> variable_names() const {
        std::vector<std::string> names;
        for (const Variable& variable : study.variables) names.push_back(variable.name);
        return names;
    }

    void groups() {
        const auto section = whole.optional("groups");
        if (!section) return;
        if (!section->is_list())
            section->fail("expected a list of groups, found " + section->found());
        const auto n = static_cast<Index>(study.variables.size());
        study.correlation = MatrixXd::Identity(n, n);
        std::vector<bool> grouped(study.variables.size(), false);
        for (const Cursor& group : section->items()) {
            group.only_keys({"variables", "correlation"});
            std::vector<Index> members;
            const Cursor names = group.require("variables"), rows = group.require("correlation");
            for (const Cursor& name : names.items()) {
                const std::size_t k = name.one_of("a variable", variable_names());
                if (!is_continuous(study.variables[k].distribution))
                    name.fail("has no continuous distribution, so that it cannot be correlated");
                if (grouped[k]) name.fail("is in a group already");
                grouped[k] = true;
                members.push_back(static_cast<Index>(k));
            }
            if (members.size() < 2) names.fail("a group needs two variables");
            MatrixXd R(members.size(), members.size());
            const auto matrix = rows.list(members.size(), "rows, one for each variable");
            for (std::size_t i = 0; i < matrix.size(); ++i) {
                const auto row = matrix[i].list(members.size(), "correlations, one per variable");
                for (std::size_t j = 0; j < row.size(); ++j) {
                    const double rho = row[j].number();
                    if (!(std::abs(rho) <= 1) || (i == j && rho != 1))
                        row[j].fail(
                            fmt::format("{:g}; allowed: -1 to 1, and 1 on the diagonal", rho));
                    R(static_cast<Index>(i), static_cast<Index>(j)) = rho;
                }
            }
            if (R != R.transpose()) rows.fail("is not symmetric");
            const Eigen::LLT<MatrixXd> factors(R);
            if (factors.info() != Eigen::Success ||
                !(factors.matrixLLT().diagonal().array() > 1e-6).all())
                rows.fail(
                    "is not positive definite: these correlations contradict each other, or "
                    "a variable is a function of others");
            study.correlation(members, members) = R;
        }
    }

    // Values by a table: columns are variables, rows are variants.
    MatrixXd table(const Cursor& at) const {
        const std::string name = at.text("a CSV file");
        const std::filesystem::path file = std::filesystem::path(*at.file).parent_path() / name;
        std::string content;
        try {
            content = reports::read_whole(file, largest_measurement);
        } catch (const FileError& error) {
            at.fail(error.what());
        }
        const auto names = variable_names();
        std::vector<std::size_t> column;
        std::vector<double> values;
        read_sheet(
            content, file.string(), 10'000'000,
            [&](const Cells& cells, int line) {
                for (const std::string_view cell : cells) {
                    const auto found = std::ranges::find(names, cell);
                    if (found == names.end())
                        fail_at(file.string(), line,
                                fmt::format("the study has no variable {}{}", reader::quote(cell),
                                            reader::did_you_mean(cell, names, "variables")));
                    const auto k = static_cast<std::size_t>(found - names.begin());
                    if (std::ranges::count(column, k) > 0)
                        fail_at(file.string(), line, std::string(cell) + ": a second column");
                    column.push_back(k);
                }
                if (column.size() != names.size())
                    fail_at(file.string(), line,
                            fmt::format("{} columns, but the study has {} variables", column.size(),
                                        names.size()));
            },
            [&](const Cells& cells, int line) {
                const std::size_t begin = values.size();
                values.resize(begin + cells.size());
                for (std::size_t c = 0; c < cells.size(); ++c) {
                    const double x = number_in(cells[c], file.string(), line, names[column[c]]);
                    if (!std::isfinite(x))
                        fail_at(file.string(), line, names[column[c]] + ": no value");
                    values[begin + column[c]] = x;
                }
            });
        const auto d = static_cast<Index>(names.size());
        return Eigen::Map<
            const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            values.data(), static_cast<Index>(values.size()) / d, d);
    }

    void design(std::optional<std::uint64_t> count) {
        const Cursor at = whole.require("design");
        at.only_keys({"kind", "count", "seed", "indices", "file"});
        const Cursor kind = at.require("kind");
        Design& design = study.design;
        bool draws = true;
        std::uint64_t has = 0;  // variants of a design of a given size
        switch (kind.one_of("a design", design_words)) {
            case 0:
                for (const Variable& variable : study.variables)
                    if (!std::visit(overloaded{[](const Levels&) { return true; },
                                               [](const auto&) { return false; }},
                                    variable.distribution))
                        kind.fail(
                            fmt::format("a grid needs a list of values for each variable, "
                                        "and '{}' has none",
                                        variable.name));
                try {
                    has = grid_size(study.variables);
                } catch (const std::invalid_argument& error) {
                    kind.fail(error.what());
                }
                design.kind = Grid{}, draws = false;
                break;
            case 1: {
                List list{table(at.require("file"))};
                has = static_cast<std::uint64_t>(list.values.rows());
                design.kind = std::move(list), draws = false;
                break;
            }
            case 2: design.kind = MonteCarlo{}; break;
            case 3: design.kind = LatinHypercube{}; break;
            case 4: design.kind = Sobol{}; break;
        }
        if (const auto file = at.optional("file"); file && design_words[1] != kind.value->text)
            file->fail("only of a list");
        if (!draws) {
            for (const char* key : {"count", "seed", "indices"})
                if (const auto field = at.optional(key))
                    field->fail("not of a grid or a list, which say how many variants there are");
            if (count && *count > has)
                kind.fail(fmt::format("{} variants are requested, and there are {}", *count, has));
            if (study.correlation.size() > 0)
                whole.require("groups").fail("not of a grid or a list, which draw nothing");
            design.count = count.value_or(has);
            return;
        }
        for (const Variable& variable : study.variables)
            if (std::visit(overloaded{[](const Given&) { return true; },
                                      [](const auto&) { return false; }},
                           variable.distribution))
                whole.require("variables")
                    .require(variable.name)
                    .fail(
                        "no distribution; allowed: normal, uniform, triangular, "
                        "truncated_normal, list");
        constexpr int most = static_cast<int>(most_variants);
        design.count = static_cast<std::uint64_t>(at.require("count").whole_number(1, most));
        if (count) {
            if (kind.value->text == design_words[3] && *count != design.count)
                at.require("count").fail(
                    "a Latin hypercube cannot be extended: all its variants depend on their "
                    "number; allowed: a sobol or monte_carlo design");
            design.count = *count;
        }
        design.seed = static_cast<std::uint64_t>(at.require("seed").whole_number(0, most));
        if (const auto indices = at.optional("indices")) design.indices = indices->yes_or_no();
        if (!design.indices) return;
        const Cursor field = at.require("indices");
        if (kind.value->text == design_words[3])
            field.fail("not of a Latin hypercube; allowed: sobol, monte_carlo");
        if (study.correlation.size() > 0)
            field.fail("Sobol indices need independent variables, and there are groups");
        if (design.count < study.variables.size() + 2)
            at.require("count").fail(
                fmt::format("{} variants are less than one block of {} for "
                            "Sobol indices",
                            design.count, study.variables.size() + 2));
    }

    // "toe@jounce:3000", "min toe@jounce", "bump_steer".
    StudyFigure figure(const std::string& name, const Cursor& at,
                       const std::vector<compare::Channel>& outputs) const {
        StudyFigure result{.name = name,
                           .output = {},
                           .branch = {},
                           .words = at.text("an output, such as toe@jounce:3000")};
        std::string words = result.words;
        for (const auto& [word, over] :
             {std::pair("min ", Over::least), std::pair("max ", Over::largest)})
            if (words.starts_with(word)) result.over = over, words.erase(0, 4);
        compare::FigureWords parsed;
        try {
            parsed = compare::parse_figure_words(words, model, outputs);
        } catch (const std::invalid_argument& error) {
            at.fail(error.what());
        }
        if (parsed.station.at && result.over != Over::station)
            at.fail("an extreme is that of the whole branch; allowed: min OUTPUT@BRANCH");
        result.output = parsed.output->name, result.unit = parsed.output->unit;
        result.branch = parsed.station.branch->name;
        result.at = parsed.station.at.value_or(0);
        return result;
    }

    // Whether redundant joints share this reaction at the design position.
    bool is_shared(const compare::Channel& output, const Branch& branch) const {
        compare::Analyses analyses;
        return !output.joints().empty() &&
               evaluate(model, compare::sides_of(model, branch).front(), std::span(&output, 1),
                        compare::design_state(model), analyses)
                       .front() == compare::undefined;
    }

    void figures() {
        const Cursor section = whole.require("figures");
        if (model.branches.empty())
            section.fail("the scene has no branch, so no output has a value");
        const auto outputs = compare::figure_outputs(model);
        for (const auto& [name, at] : section.entries()) {
            const auto& added = study.figures.emplace_back(figure(name, at, outputs));
            const auto& output = *std::ranges::find(outputs, added.output, &compare::Channel::name);
            if (is_shared(output, *std::ranges::find(model.branches, added.branch, &Branch::name)))
                at.fail(output.name + ": " + why_undefined(output));
        }
        if (study.figures.empty()) section.fail("no figure; allowed: NAME: toe@jounce:3000");
        if (study.figures.size() > 1000)
            section.fail("more figures than 1000, the most that a ledger has columns for");
    }

    void limits() {
        const auto section = whole.optional("limits");
        if (!section) return;
        for (const auto& [name, at] : section->entries()) {
            std::vector<std::string> names;
            for (const StudyFigure& figure : study.figures) names.push_back(figure.name);
            const auto found = std::ranges::find(study.figures, name, &StudyFigure::name);
            if (found == study.figures.end())
                at.fail("the study has no such figure" +
                        reader::did_you_mean(name, names, "figures"));
            at.only_keys({"min", "max"});
            found->low = number_or(at, "min", found->low);
            found->high = number_or(at, "max", found->high);
            if (!found->has_limits()) at.fail("no limit; allowed: {min: ..., max: ...}");
            if (!(found->low <= found->high)) at.fail("min is above max");
        }
    }
};

// The ends of a bounded distribution, the mean of an unbounded one.
std::vector<double> ends_of(const Distribution& distribution) {
    return std::visit(overloaded{[](const Normal& d) { return std::vector{d.mean}; },
                                 [](const Levels& d) {
                                     const auto [least, largest] = std::ranges::minmax(d.values);
                                     return std::vector{least, largest};
                                 },
                                 [](const Given&) { return std::vector<double>{}; },
                                 [](const auto& d) {
                                     return std::vector{d.low, d.high};
                                 }},
                      distribution);
}

// That the scene is valid with each variable at its ends, the others as they are written. Tails and
// combinations are left to the variants that draw them.
void check_ends(const Study& study, const reader::ParsedScene& parsed, const Cursor& variables) {
    Variants variants(parsed, study);
    Eigen::VectorXd x(static_cast<Index>(study.variables.size()));
    for (std::size_t j = 0; j < study.variables.size(); ++j)
        x[static_cast<Index>(j)] = study.variables[j].nominal;
    for (std::size_t j = 0; j < study.variables.size(); ++j)
        for (const double end : ends_of(study.variables[j].distribution)) {
            Eigen::VectorXd at = x;
            at[static_cast<Index>(j)] = end;
            try {
                variants.scene(at);
            } catch (const reader::LengthVanishes&) {  // geometry, not a mistake: a row
            } catch (const SceneError& error) {
                variables.require(study.variables[j].name)
                    .fail(fmt::format("{:g} can be drawn, and with it the scene is invalid: {}",
                                      end, error.what()));
            }
        }
}

std::string bytes_of(const MatrixXd& matrix) {
    return {reinterpret_cast<const char*>(matrix.data()),
            static_cast<std::size_t>(matrix.size()) * sizeof(double)};
}

// All that a row of the ledger depends on, besides the scene. The number of variants and the limits
// are no part of it, so that they can be changed; of a Latin hypercube the number is.
std::string essence(const Study& study) {
    std::string text;
    for (const Variable& variable : study.variables) {
        text += fmt::format(
            "{};{}", variable.name,
            std::visit(
                overloaded{
                    [](const Normal& d) { return fmt::format("N {} {}", d.mean, d.sd); },
                    [](const Uniform& d) { return fmt::format("U {} {}", d.low, d.high); },
                    [](const Triangular& d) {
                        return fmt::format("T {} {} {}", d.low, d.mode, d.high);
                    },
                    [](const TruncatedNormal& d) {
                        return fmt::format("TN {} {} {} {}", d.mean, d.sd, d.low, d.high);
                    },
                    [](const Levels& d) { return fmt::format("L {}", fmt::join(d.values, " ")); },
                    [](const Given&) { return std::string("G"); }},
                variable.distribution));
        for (const Scaled& scaled : variable.scaled) text += ";" + scaled.path;
        text += '\n';
    }
    text += bytes_of(study.correlation);
    const Design& design = study.design;
    text += std::visit(overloaded{[](const Grid&) { return std::string("\ngrid"); },
                                  [](const List& list) { return "\nlist" + bytes_of(list.values); },
                                  [](const MonteCarlo&) { return std::string("\nmonte_carlo"); },
                                  [&](const LatinHypercube&) {
                                      return fmt::format("\nlatin_hypercube {}", design.count);
                                  },
                                  [](const Sobol&) { return std::string("\nsobol"); }},
                       design.kind);
    text += fmt::format("\n{} {} {}\n", design.seed, design.indices, study.witness);
    for (const StudyFigure& figure : study.figures)
        text += fmt::format("{};{};{};{};{}\n", figure.name, figure.output, figure.branch,
                            static_cast<int>(figure.over), figure.at);
    return text;
}

}  // namespace

StudyFile read_study(const std::string& file, std::optional<std::uint64_t> count) {
    const reader::Value tree = reader::parse_yaml(read_whole(file, largest_baseline), file);
    std::vector<Number> ignored;
    const Cursor whole{&tree, "", &file, &ignored};
    whole.only_keys({"elastocheck_study", "scene", "variables", "groups", "design", "figures",
                     "limits", "witness"});
    if (const Cursor version = whole.require("elastocheck_study"); version.whole_number(1, 1) != 1)
        version.fail("allowed: 1");

    const Cursor scene_field = whole.require("scene");
    const std::string& scene_name = scene_field.text("the file of a scene");
    const auto scene_file = std::filesystem::path(file).parent_path() / scene_name;
    std::string text;
    try {
        text = read_whole(scene_file, largest_baseline);
    } catch (const FileError& error) {
        scene_field.fail(error.what());
    }
    // Its name as it is written here: reasons of failed variants do not depend on where they were
    // computed.
    reader::ParsedScene parsed(text, scene_name, scene_file.parent_path());
    std::vector<std::string> warnings;
    const Scene scene = parsed.read({}, &warnings);
    const compare::Trimmed trimmed = compare::trim(scene);
    if (trimmed.record && !trimmed.record->reached())
        scene_field.fail("trim: " + trimmed.record->detail);
    Model design = compile(trimmed.scene);

    Reading reading{whole, scene, design};
    reading.variables();
    check_ends(reading.study, parsed, whole.require("variables"));
    reading.groups();
    reading.design(count);
    reading.figures();
    reading.limits();
    if (const auto witness = whole.optional("witness"))
        reading.study.witness = witness->whole_number(0, 1'000'000'000);

    if (!openturns::available()) openturns::sobol_directions(1, 1);  // throws the reason
    auto solver = [&] {
        try {
            return VariantSolver(design, reading.study.figures);
        } catch (const std::invalid_argument& error) {
            whole.require("figures").fail(error.what());
        }
    }();
    std::vector<double> numbers;  // of curves, whose tables may be in other files
    for (const Elastic& elastic : design.elastics)
        each_curve(elastic.kind, [&](std::size_t, const elastocheck::Curve& curve) {
            std::ranges::copy(curve.knots, std::back_inserter(numbers));
            for (const auto& piece : curve.pieces)
                std::ranges::copy(piece, std::back_inserter(numbers));
        });
    const Provenance made = provenance();
    StudyIdentity identity{
        .scene = input_hash(text + std::string(reinterpret_cast<const char*>(numbers.data()),
                                               numbers.size() * sizeof(double))),
        .study = input_hash(essence(reading.study)),
        .version = made.version + " " + made.commit.substr(0, 12) + (made.dirty ? " changed" : "")};
    return {file,
            std::move(reading.study),
            scene_file.string(),
            std::move(parsed),
            std::move(design),
            std::move(solver),
            std::move(identity),
            std::move(warnings)};
}

namespace {
std::vector<std::string> numbers_of(const Study& study) {
    std::vector<std::string> paths;
    for (const Variable& variable : study.variables) {
        if (variable.scaled.empty()) paths.push_back(variable.name);
        for (const Scaled& scaled : variable.scaled) paths.push_back(scaled.path);
    }
    return paths;
}
}  // namespace

Variants::Variants(const reader::ParsedScene& scene, const Study& study)
    : study_(study), scene_(scene, numbers_of(study)) {}

Scene Variants::scene(const Eigen::VectorXd& values) {
    numbers_.clear();
    for (std::size_t j = 0; j < study_.variables.size(); ++j) {
        const Variable& variable = study_.variables[j];
        const double x = values[static_cast<Index>(j)];
        if (variable.scaled.empty()) numbers_.push_back(x);
        for (const Scaled& scaled : variable.scaled) numbers_.push_back(x * scaled.nominal);
    }
    return scene_.read(numbers_);
}

}  // namespace elastocheck::reports
