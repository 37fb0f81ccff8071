#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "compare/outputs/not_a_number.hpp"
#include "compare/sensitivity/sensitivity.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;

constexpr double rounding_of_effect = 1e-12;  // of the largest effect on an output

// Derivative of an output by a number at a station of a side.
struct Derivative {
    const Gradients& all;
    const SideGradients& side;
    std::size_t station, output, number;

    double at(const Eigen::MatrixXd& of) const {
        return of(static_cast<Index>(output), static_cast<Index>(number));
    }
    const Channel& of() const { return all.outputs[output]; }
    const VariedNumber& by() const { return all.numbers[number]; }
    double value() const { return at(side.legs.front().at[station]); }
    double defined() const { return missing().empty() ? value() : nan; }
    double effect() const { return value() * by().step; }
    // Reason why there is none; empty: there is one.
    std::string missing() const {
        if (!side.why_output[output].empty()) return side.why_output[output];
        if (!side.why_number[station][number].empty()) return side.why_number[station][number];
        return std::isnan(value()) ? "the output is undefined here" : "";
    }
    // One-sided; NaN where there is none.
    double beside(Eigen::MatrixXd OneSided::*which) const {
        const bool none = station >= side.one_sided.size() || side.one_sided[station].empty();
        return none ? nan : at(side.one_sided[station].*which);
    }
    double growing() const { return beside(&OneSided::growing); }
    double falling() const { return beside(&OneSided::falling); }
    double parameter() const { return in_unit(side.unit) * side.a[station]; }
    std::string per() const {
        return fmt::format("{} per {}", symbol(of().unit), by().unit.empty() ? "1" : by().unit);
    }
    // A sentence on `missing`.
    std::string reason() const {
        return fmt::format(
            "no derivative: {} by {} at {:g} {}: {}{}", of().name, by().path, parameter(),
            symbol(side.unit), missing(),
            std::isnan(growing()) || std::isnan(falling())
                ? ""
                : fmt::format("; {:.3g} {} where the number grows, {:.3g} where it falls",
                              growing(), per(), falling()));
    }
};

// For readers: a number at the start and the end of a side.
struct ShownNumber {
    std::string output;  // empty below the first of an output
    Derivative start, end;
    double least;  // effects up to it are rounding and shown as zero

    double shown(const Derivative& at) const {
        return std::abs(at.effect()) <= least ? 0 : at.value();
    }
    double effect(const Derivative& at) const { return shown(at) * at.by().step; }
    std::string number() const {
        const VariedNumber& by = start.by();
        return by.path + (by.side > 0 ? " (increase only)" : by.side < 0 ? " (decrease only)" : "");
    }
    static std::vector<ColumnOf<ShownNumber>> columns() {
        using enum Digits;
        using Row = ShownNumber;
        return {{"output", words, &Row::output},
                {"number", words, [](const Row& r) { return r.number(); }},
                {"at start", three, [](const Row& r) { return r.shown(r.start); }},
                {"at end", three, [](const Row& r) { return r.shown(r.end); }},
                {"in", words, [](const Row& r) { return r.start.per(); }},
                {"start", three, [](const Row& r) { return r.effect(r.start); }},
                {"end", three, [](const Row& r) { return r.effect(r.end); }},
                {"for", words, [](const Row& r) {
                     return fmt::format("{}, {}", r.start.by().step_name,
                                        symbol(r.start.of().unit));
                 }}};
    }
};

// The largest effect of each number on an output along a side.
std::vector<double> largest_effects(const Gradients& all, const SideGradients& side,
                                    std::size_t output) {
    std::vector<double> sizes(all.numbers.size(), 0);
    for (std::size_t k = 0; k < sizes.size(); ++k)
        for (std::size_t s = 0; s < side.a.size(); ++s)
            if (const double here = std::abs(Derivative{all, side, s, output, k}.effect());
                here > sizes[k])
                sizes[k] = here;
    return sizes;
}

Table shown_table(const Gradients& gradients, const SideGradients& side, int most) {
    if (side.a.empty())
        return {.caption = fmt::format("{}: {}", side.name, side.legs.front().failure)};
    const std::size_t last = side.a.size() - 1;
    std::vector<ShownNumber> rows;
    std::set<std::string> reasons;
    for (std::size_t c = 0; c < gradients.outputs.size(); ++c) {
        if (!side.why_output[c].empty()) {
            reasons.insert(fmt::format("no derivative: {}: {}", gradients.outputs[c].name,
                                       side.why_output[c]));
            continue;
        }
        const auto sizes = largest_effects(gradients, side, c);
        std::vector<std::size_t> order(sizes.size());
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::stable_sort(order, std::ranges::greater{},
                                 [&](std::size_t k) { return sizes[k]; });
        if (most > 0) order.resize(std::min(order.size(), static_cast<std::size_t>(most)));
        std::string output = gradients.outputs[c].name;
        for (const std::size_t k : order) {
            const Derivative start{gradients, side, 0, c, k}, end{gradients, side, last, c, k};
            for (const Derivative& at : {start, end})
                if (!at.missing().empty()) reasons.insert(at.reason());
            if (sizes[k] == 0 && !std::isnan(start.value()) && !std::isnan(end.value()) &&
                most > 0 && output.empty())
                continue;
            rows.push_back(
                {std::exchange(output, ""), start, end, rounding_of_effect * sizes[order.front()]});
        }
    }
    Table shown = table({.caption = fmt::format("{}: derivatives at {:g} and {:g} {}", side.name,
                                                Derivative{gradients, side, 0, 0, 0}.parameter(),
                                                Derivative{gradients, side, last, 0, 0}.parameter(),
                                                symbol(side.unit))},
                        ShownNumber::columns(), rows);
    shown.notes.assign(reasons.begin(), reasons.end());
    for (const auto& leg : side.legs)
        if (leg.not_applicable)
            shown.notes.push_back(fmt::format("{} leg: {}", name(leg.leg), leg.failure));
    shown.notes.push_back(
        fmt::format("{} entries compared between the legs, largest difference {:.1e} of the "
                    "largest of its row, {:.1e} beyond rounding",
                    side.worst.compared, side.worst.whole, side.worst.share));
    return shown;
}

Table derivatives_table(const Gradients& all) {
    using enum Digits;
    using Row = Derivative;
    std::vector<Derivative> rows;
    for (const SideGradients& side : all.sides)
        for (std::size_t s = 0; s < side.a.size(); ++s)
            for (std::size_t c = 0; c < all.outputs.size(); ++c)
                for (std::size_t k = 0; k < all.numbers.size(); ++k)
                    rows.push_back({all, side, s, c, k});
    return table(
        {.id = "derivatives"},
        std::vector<ColumnOf<Row>>{
            {"branch", words, [](const Row& r) { return r.side.name; }, "side of a branch"},
            {"parameter", given, [](const Row& r) { return r.parameter(); },
             "of the branch, in `unit`"},
            {"unit", words, [](const Row& r) { return std::string(symbol(r.side.unit)); }},
            {"output", words, [](const Row& r) { return r.of().name; }},
            {"number", words, [](const Row& r) { return r.by().path; }, "path in the scene file"},
            {"derivative", given, [](const Row& r) { return r.defined(); }, "in `per`"},
            {"per", words, [](const Row& r) { return r.per(); },
             "unit of the output per unit of the number"},
            {"effect", given, [](const Row& r) { return r.defined() * r.by().step; },
             "derivative times `step`, in the unit of the output"},
            {"step", words, [](const Row& r) { return r.by().step_name; },
             "1 mm of a length, else 1 % of the value"},
            {"missing", words, [](const Row& r) { return r.missing(); },
             "why there is no derivative"},
            {"growing", given, [](const Row& r) { return r.growing(); },
             "where there is none: derivative where the number grows"},
            {"falling", given, [](const Row& r) { return r.falling(); }, "and where it falls"}},
        rows);
}

Table varied_numbers_table(const Gradients& gradients) {
    using enum Digits;
    using Row = VariedNumber;
    return table(
        {.id = "numbers"},
        std::vector<ColumnOf<Row>>{
            {"number", words, &Row::path},
            {"value", given, &Row::value, "in the file"},
            {"unit", words, &Row::unit},
            {"step", given, &Row::step, "of its effect"},
            {"side", given, &Row::side, "1, -1: derivatives are those where it grows, falls"},
            {"undefined", words, &Row::undefined, "why there is no derivative by it"}},
        gradients.numbers);
}

// Agreement of the derivatives of every leg on every side with those of the others.
Table legs_agreement_table(const Gradients& all) {
    using enum Digits;
    struct Row {
        const SideGradients& side;
        const LegGradients& by;
    };
    std::vector<Row> rows;
    for (const SideGradients& side : all.sides)
        for (const LegGradients& by : side.legs) rows.push_back({side, by});
    return table(
        {.id = "agreement"},
        std::vector<ColumnOf<Row>>{
            {"side", words, [](const Row& r) { return r.side.name; }, "of a branch"},
            {"branch", words, [](const Row& r) { return r.side.branch; }},
            {"leg", words, [](const Row& r) { return std::string(name(r.by.leg)); }},
            {"stations", given, [](const Row& r) { return r.by.at.size(); }},
            {"failure", words, [](const Row& r) { return r.by.failure; },
             "why stations are missing"},
            {"applies", words, [](const Row& r) { return r.by.not_applicable ? "no" : "yes"; }},
            {"compared", given, [](const Row& r) { return r.side.worst.compared; },
             "entries of the side"},
            {"worst", size, [](const Row& r) { return r.side.worst.share; },
             "difference of two legs beyond rounding, of the largest of its row"},
            {"with rounding", size, [](const Row& r) { return r.side.worst.whole; },
             "likewise, with rounding"},
            {"where", words, [](const Row& r) { return r.side.worst.where; }}},
        rows);
}

}  // namespace

Result result_of(const Gradients& gradients, int most) {
    Result result{.analysis = "sensitivity"};
    for (const SideGradients& side : gradients.sides)
        result.tables.push_back(shown_table(gradients, side, most));
    for (Table programs : {derivatives_table(gradients), varied_numbers_table(gradients),
                           legs_agreement_table(gradients)}) {
        programs.detail = true;
        result.tables.push_back(std::move(programs));
    }
    result.verdict.reasons = gradients.not_confirmed();
    result.verdict.grade = gradients.conclusive() ? Grade::pass : Grade::not_judged;
    if (gradients.conclusive())
        result.verdict.sentence =
            fmt::format("the legs agree within {:g} of the largest of each row, beyond rounding",
                        gradients_agree);
    for (const SideGradients& side : gradients.sides)
        result.verdict.compared += static_cast<int>(side.worst.compared);
    return result;
}

}  // namespace elastocheck::compare
