#include "reports/document/against.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "compare/comparison/changes.hpp"
#include "compare/comparison/points.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/gate/gate.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "reports/json/json_cursor.hpp"
#include "reports/text/words.hpp"

namespace elastocheck::reports {
namespace {

using compare::nan;
using json = nlohmann::ordered_json;

struct Output {
    std::string name, unit;
    bool main = false, kinematic = false, characteristic = false, reciprocal = false;
};

struct Line {
    std::vector<double> a, y;
};

struct BranchCurve {
    std::string name, unit;
    JsonCursor curve;  // of the equilibrium leg

    Line of(const std::string& output) const {
        const auto values = curve["values"].find(output);
        Line line{curve["a"].numbers(), values ? values->numbers() : std::vector<double>{}};
        if (line.y.size() != line.a.size()) line.y.assign(line.a.size(), nan);
        return line;
    }
};

std::vector<Output> outputs_of(const JsonCursor& scene) {
    std::vector<Output> all;
    for (const auto& c : scene["channels"].items())
        all.push_back({c["name"].text(), c["unit"].text(), c["main"].truth(),
                       c["kinematic"].truth(), c["kind"].text() == "characteristic",
                       c.find("reciprocal").has_value()});
    return all;
}

std::vector<BranchCurve> branches_of(const JsonCursor& scene) {
    std::vector<BranchCurve> all;
    for (const auto& branch : scene["branches"].items())
        for (const auto& leg : branch["legs"].items())
            if (leg["leg"].text() == name(compare::Leg::equilibrium))
                all.push_back({branch["name"].text(), branch["unit"].text(), leg["curve"]});
    return all;
}

std::vector<Number> numbers_of(const JsonCursor& scene) {
    std::vector<Number> all;
    for (const auto& n : scene["numbers"].items())
        all.push_back({n["path"].text(), n["value"].number(), n["unit"].text()});
    return all;
}

// The branch of this name and unit, or null.
const BranchCurve* find(const std::vector<BranchCurve>& branches, const BranchCurve& like) {
    const auto found = std::ranges::find_if(branches, [&](const BranchCurve& branch) {
        return branch.name == like.name && branch.unit == like.unit;
    });
    return found == branches.end() ? nullptr : &*found;
}

double at_design(const Line& line) {
    const auto zero = std::ranges::find(line.a, 0.0);
    return zero == line.a.end() ? nan : line.y[static_cast<std::size_t>(zero - line.a.begin())];
}

// Beyond the rounding of a solution.
bool differs(double was, double is) {
    return std::isfinite(was) != std::isfinite(is) ||
           std::abs(is - was) > 1e-9 + 1e-9 * std::max(std::abs(was), std::abs(is));
}

// Ratio of a difference to what an engineer notices.
double noticed(const Output& output, double was, double is) {
    static const auto physical = compare::default_tolerances(compare::ToleranceClass::physical);
    const auto own = physical.find(output.unit);
    const auto& t = own == physical.end() ? physical.at("characteristic") : own->second;
    return std::abs(is - was) / (t.atol + t.rtol * std::max(std::abs(was), std::abs(is)));
}

json thinned(const Line& line) {
    constexpr std::size_t most = 41;
    json a = json::array(), y = json::array();
    const std::size_t count = std::min(line.a.size(), most);
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t at = count == 1 ? 0 : k * (line.a.size() - 1) / (count - 1);
        a.push_back(line.a[at]), y.push_back(line.y[at]);
    }
    return {{"a", a}, {"y", y}};
}

json number_or_null(double x) { return std::isfinite(x) ? json(x) : json(nullptr); }

json figures_json(const std::vector<Output>& outputs, const std::vector<BranchCurve>& was,
                  const std::vector<BranchCurve>& is) {
    std::vector<json> figures;
    for (const auto& output : outputs) {
        if (!output.kinematic && !output.characteristic) continue;
        for (const auto& branch : is) {
            const BranchCurve* same = find(was, branch);
            if (same == nullptr) continue;
            const double a = at_design(same->of(output.name)),
                         b = at_design(branch.of(output.name));
            if (std::isnan(a) && std::isnan(b)) continue;  // no figure of this branch
            if (!differs(a, b)) break;
            const auto compared = [&](double x) {
                return output.reciprocal ? (std::isfinite(x) ? 1e3 / x : 0) : x;
            };
            figures.push_back(
                {{"output", output.name},
                 {"unit", output.unit},
                 {"base", number_or_null(a)},
                 {"variant", number_or_null(b)},
                 {"difference", number_or_null(compared(b) - compared(a))},
                 {"unit_of_difference", output.reciprocal ? compare::per_metre : output.unit},
                 {"noticed", number_or_null(noticed(output, compared(a), compared(b)))}});
            break;
        }
    }
    // what an engineer notices first; what is undefined on one side before all
    std::ranges::stable_sort(figures, std::greater{}, [](const json& figure) {
        return figure["noticed"].is_null() ? INFINITY : figure["noticed"].get<double>();
    });
    return figures;
}

json curves_json(const std::vector<Output>& outputs, const BranchCurve& was,
                 const BranchCurve& is) {
    json curves = json::array();
    for (const auto& output : outputs) {
        if (!output.main || !output.kinematic) continue;
        const Line a = was.of(output.name), b = is.of(output.name);
        double largest = 0, at = nan;
        for (std::size_t k = 0; k < b.a.size(); ++k) {
            if (!compare::reaches(a.a, b.a[k])) continue;
            const double difference = b.y[k] - compare::interpolate(a.a, a.y, b.a[k], 6);
            if (std::abs(difference) > std::abs(largest)) largest = difference, at = b.a[k];
        }
        if (!(std::abs(largest) > 1e-9)) continue;
        curves.push_back({{"output", output.name},
                          {"unit", output.unit},
                          {"largest", largest},
                          {"at", at},
                          {"noticed", noticed(output, 0, largest)},
                          {"base", thinned(a)},
                          {"variant", thinned(b)}});
    }
    return curves;
}

}  // namespace

void add_against(json& base, const json& variant) {
    const std::string file = "result.json";
    const JsonCursor is{&variant, "", &file}, was{&base, "", &file};
    json numbers = json::array();
    const auto number = [](const std::optional<Number>& n) {
        return n ? json{{"value", n->value}, {"unit", n->unit}} : json(nullptr);
    };
    for (const auto& change : compare::changes(numbers_of(was), numbers_of(is)))
        numbers.push_back({{"path", (change.is ? change.is : change.was)->path},
                           {"base", number(change.was)},
                           {"variant", number(change.is)}});
    const auto outputs = outputs_of(is), before = outputs_of(was);
    std::vector<Output> common;
    json only_base = json::array(), only_variant = json::array();
    const auto has = [](const std::vector<Output>& all, const Output& o) {
        return std::ranges::any_of(
            all, [&](const Output& x) { return x.name == o.name && x.unit == o.unit; });
    };
    for (const auto& output : outputs)
        if (has(before, output))
            common.push_back(output);
        else
            only_variant.push_back("output " + output.name);
    for (const auto& output : before)
        if (!has(outputs, output)) only_base.push_back("output " + output.name);
    const auto branches = branches_of(is), branches_before = branches_of(was);
    json list = json::array();
    for (const auto& branch : branches)
        if (const BranchCurve* same = find(branches_before, branch))
            list.push_back({{"name", branch.name},
                            {"unit", branch.unit},
                            {"curves", curves_json(common, *same, branch)}});
        else
            only_variant.push_back("branch " + branch.name);
    for (const auto& branch : branches_before)
        if (find(branches, branch) == nullptr) only_base.push_back("branch " + branch.name);
    base["against"] = {{"name", is["name"].text()},
                       {"source", is["source"].text()},
                       {"input_hash", is["input_hash"].text()},
                       {"numbers", numbers},
                       {"figures", figures_json(common, branches_before, branches)},
                       {"branches", list},
                       {"only_base", only_base},
                       {"only_variant", only_variant}};
}

std::string against_sentence(const json& base) {
    const json& against = base.at("against");
    const json* most = nullptr;  // noticed most, of those that both have
    for (const auto& figure : against.at("figures"))
        if (most == nullptr && figure.at("base").is_number() && figure.at("variant").is_number())
            most = &figure;
    std::string text =
        fmt::format("{} against {}: {} of the scene and {} at the design position differ",
                    against.at("source").get<std::string>(), base.at("source").get<std::string>(),
                    counted(against.at("numbers").size(), "number"),
                    counted(against.at("figures").size(), "figure"));
    if (most != nullptr)
        text +=
            fmt::format(", most {} [{}] from {:.3g} to {:.3g}",
                        most->at("output").get<std::string>(), most->at("unit").get<std::string>(),
                        most->at("base").get<double>(), most->at("variant").get<double>());
    return text + ".";
}

}  // namespace elastocheck::reports
