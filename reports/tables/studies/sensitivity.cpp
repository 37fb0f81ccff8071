#include "reports/tables/studies/sensitivity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>

#include "reports/render/render.hpp"

namespace elastocheck::reports {
namespace {

using json = nlohmann::ordered_json;
using compare::Gradients;
using compare::SideGradients;
using Eigen::Index;

constexpr double rounding = 1e-12;  // of the largest effect on an output

double entry(const SideGradients& side, std::size_t station, std::size_t output,
             std::size_t number) {
    return side.legs.front().at[station](static_cast<Index>(output), static_cast<Index>(number));
}

// Why an entry is missing; empty if it is there.
std::string missing(const SideGradients& side, std::size_t station, std::size_t output,
                    std::size_t number, double value) {
    if (!side.why_output[output].empty()) return side.why_output[output];
    if (!side.why_number[station][number].empty()) return side.why_number[station][number];
    return std::isnan(value) ? "the output is undefined here" : "";
}

// One-sided derivative; NaN where there is none.
double beside(const SideGradients& side, std::size_t station, std::size_t output,
              std::size_t number, Eigen::MatrixXd compare::OneSided::*which) {
    if (station >= side.one_sided.size() || side.one_sided[station].empty()) return std::nan("");
    return (side.one_sided[station].*which)(static_cast<Index>(output), static_cast<Index>(number));
}

std::string named(const compare::VariedNumber& number) {
    return number.path + (number.side > 0   ? " (increase only)"
                          : number.side < 0 ? " (decrease only)"
                                            : "");
}

std::string per(const compare::Channel& output, const compare::VariedNumber& number) {
    return fmt::format("{} per {}", symbol(output.unit), number.unit.empty() ? "1" : number.unit);
}

// Size of the effect of a number along a side.
double effect(const SideGradients& side, std::size_t output, std::size_t number, double step) {
    double largest = 0;
    for (std::size_t s = 0; s < side.a.size(); ++s) {
        const double here = std::abs(entry(side, s, output, number) * step);
        if (here > largest) largest = here;
    }
    return largest;
}

}  // namespace

compare::Table sensitivity_table(const Gradients& all) {
    compare::Table table{{{"branch", "", "side of a branch", true},
                          {"parameter", "", "of the branch, in `unit`"},
                          {"unit", "", "", true},
                          {"output", "", "", true},
                          {"number", "", "path in the scene file", true},
                          {"derivative", "", "in `per`"},
                          {"per", "", "unit of the output per unit of the number", true},
                          {"effect", "", "derivative times `step`, in the unit of the output"},
                          {"step", "", "1 mm of a length, else 1 % of the value", true},
                          {"missing", "", "why there is no derivative", true},
                          {"growing", "", "where there is none: derivative where the number grows"},
                          {"falling", "", "and where it falls"}},
                         {}};
    for (const SideGradients& side : all.sides)
        for (std::size_t s = 0; s < side.a.size(); ++s)
            for (std::size_t c = 0; c < all.outputs.size(); ++c)
                for (std::size_t k = 0; k < all.numbers.size(); ++k) {
                    const auto& number = all.numbers[k];
                    double value = entry(side, s, c, k);
                    const std::string why = missing(side, s, c, k, value);
                    if (!why.empty()) value = std::nan("");
                    table.rows.push_back({side.name, in_unit(side.unit) * side.a[s],
                                          std::string(symbol(side.unit)), all.outputs[c].name,
                                          number.path, value, per(all.outputs[c], number),
                                          value * number.step, std::string(number.step_name), why,
                                          beside(side, s, c, k, &compare::OneSided::growing),
                                          beside(side, s, c, k, &compare::OneSided::falling)});
                }
    return table;
}

std::string sensitivity_text(const Gradients& all, int most) {
    using enum Digits;
    std::string text;
    const auto out = std::back_inserter(text);
    for (const SideGradients& side : all.sides) {
        if (side.a.empty()) {
            fmt::format_to(out, "{}: {}\n\n", side.name, side.legs.front().failure);
            continue;
        }
        const std::size_t last = side.a.size() - 1;
        fmt::format_to(out, "{}: derivatives at {:g} and {:g} {}\n", side.name,
                       in_unit(side.unit) * side.a.front(), in_unit(side.unit) * side.a.back(),
                       symbol(side.unit));
        compare::Table table{{{"output", "", "", true, words},
                              {"number", "", "", true, words},
                              {"at start", "", "", false, three},
                              {"at end", "", "", false, three},
                              {"in", "", "", true, words},
                              {"start ", "", "", false, three},
                              {"end ", "", "", false, three},
                              {"for", "", "", true, words}},
                             {}};
        std::set<std::string> reasons;
        for (std::size_t c = 0; c < all.outputs.size(); ++c) {
            if (!side.why_output[c].empty()) {
                reasons.insert(fmt::format("{}: {}", all.outputs[c].name, side.why_output[c]));
                continue;
            }
            std::vector<std::size_t> order(all.numbers.size());
            std::iota(order.begin(), order.end(), 0u);
            std::vector<double> size;
            for (const std::size_t k : order)
                size.push_back(effect(side, c, k, all.numbers[k].step));
            std::ranges::stable_sort(
                order, [&](std::size_t a, std::size_t b) { return size[a] > size[b]; });
            if (most > 0 && order.size() > static_cast<std::size_t>(most))
                order.resize(static_cast<std::size_t>(most));
            bool first = true;
            for (const std::size_t k : order) {
                const auto& number = all.numbers[k];
                const double start = entry(side, 0, c, k), end = entry(side, last, c, k);
                for (const std::size_t s : {std::size_t{0}, last})
                    if (const auto why = missing(side, s, c, k, entry(side, s, c, k));
                        !why.empty()) {
                        const double growing = beside(side, s, c, k, &compare::OneSided::growing),
                                     falling = beside(side, s, c, k, &compare::OneSided::falling);
                        reasons.insert(fmt::format(
                            "{} by {} at {:g} {}: {}{}", all.outputs[c].name, number.path,
                            in_unit(side.unit) * side.a[s], symbol(side.unit), why,
                            std::isnan(growing) || std::isnan(falling)
                                ? ""
                                : fmt::format("; {:.3g} {} where the number grows, {:.3g} where it "
                                              "falls",
                                              growing, per(all.outputs[c], number), falling)));
                    }
                if (size[k] == 0 && !std::isnan(start) && !std::isnan(end) && most > 0 && !first)
                    continue;
                // a remainder of rounding is shown as zero
                const double least = rounding * size[order.front()];
                const auto shown = [&](double value) {
                    return std::abs(value * number.step) <= least ? 0 : value;
                };
                table.rows.push_back(
                    {first ? all.outputs[c].name : "", named(number), shown(start), shown(end),
                     per(all.outputs[c], number), shown(start) * number.step,
                     shown(end) * number.step,
                     fmt::format("{}, {}", number.step_name, symbol(all.outputs[c].unit))});
                first = false;
            }
        }
        text += reports::text(table);
        for (const auto& reason : reasons) fmt::format_to(out, "no derivative: {}\n", reason);
        for (const auto& leg : side.legs)
            if (leg.not_applicable) fmt::format_to(out, "{} leg: {}\n", name(leg.leg), leg.failure);
        fmt::format_to(out,
                       "{} entries compared between the legs, largest difference {:.1e} of the "
                       "largest of its row, {:.1e} beyond rounding\n\n",
                       side.worst.compared, side.worst.whole, side.worst.share);
    }
    const auto reasons = all.not_confirmed();
    if (reasons.empty())
        fmt::format_to(out,
                       "the legs agree within {:g} of the largest of each row, beyond rounding\n",
                       compare::gradients_agree);
    else
        fmt::format_to(out, "NOT CONCLUSIVE\n  {}\n", fmt::join(reasons, "\n  "));
    return text;
}

json sensitivity_json(const Gradients& all) {
    json numbers = json::array(), sides = json::array();
    for (const auto& number : all.numbers)
        numbers.push_back({{"path", number.path},
                           {"value", number.value},
                           {"unit", number.unit},
                           {"step", number.step},
                           {"side", number.side},
                           {"undefined", number.undefined}});
    for (const auto& side : all.sides) {
        json by = json::array();
        for (const auto& leg : side.legs)
            by.push_back({{"leg", name(leg.leg)},
                          {"stations", leg.at.size()},
                          {"failure", leg.failure},
                          {"applies", !leg.not_applicable}});
        sides.push_back({{"name", side.name},
                         {"branch", side.branch},
                         {"compared", side.worst.compared},
                         {"worst", side.worst.share},
                         {"with_rounding", side.worst.whole},
                         {"where", side.worst.where},
                         {"legs", by}});
    }
    return {{"conclusive", all.conclusive()},
            {"reasons", all.not_confirmed()},
            {"agreement", compare::gradients_agree},
            {"numbers", numbers},
            {"sides", sides},
            {"derivatives", table_json(sensitivity_table(all))}};
}

}  // namespace elastocheck::reports
