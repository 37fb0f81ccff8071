// Loads at pickup points for readers.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compare/deviation/deviation.hpp"
#include "compare/loads/loads.hpp"
#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare {
namespace {

constexpr double in_balance = 1e-9;  // of the largest force or moment on any body
constexpr double confirmed = 1e-7;   // difference of two solutions, of the largest force or moment

constexpr std::array<const char*, 6> components{"force_x",  "force_y",  "force_z",
                                                "moment_x", "moment_y", "moment_z"};

std::vector<ColumnOf<SolvedCase>> load_columns(const std::vector<Pickup>& pickups) {
    std::vector<ColumnOf<SolvedCase>> columns{
        {"case", Digits::hidden, &SolvedCase::name, "the load case"},
        {"imbalance", Digits::hidden, &SolvedCase::imbalance,
         "largest remainder of the balance of a body, of the largest force or moment on any"},
        {"disagreement", Digits::hidden, &SolvedCase::disagreement,
         "largest difference from the second solution, of the largest force or moment"}};
    for (const bool in_body_axes : {false, true})
        for (std::size_t k = 0; k < pickups.size(); ++k)
            for (int c = 0; c < 6; ++c)
                columns.push_back(
                    {fmt::format("{}.{}.{}{}", pickups[k].body, pickups[k].connection,
                                 in_body_axes ? "body_" : "",
                                 components[static_cast<std::size_t>(c)]),
                     Digits::hidden,
                     [k, c, in_body_axes](const SolvedCase& solved) {
                         if (solved.loads.empty()) return nan;
                         const PickupLoad& load = solved.loads[k];
                         return (in_body_axes ? load.in_body_axes : load.in_ground_axes)[c];
                     },
                     fmt::format("on {} at {}, {} axes", pickups[k].body, pickups[k].connection,
                                 in_body_axes ? "body" : "vehicle"),
                     c < 3 ? "N" : "N·m"});
    return columns;
}

// The largest force and moment at a pickup point over the cases.
struct Largest {
    Pickup pickup;
    double force = 0, moment = 0;
    std::string force_in{}, moment_in{};  // names of the cases
    bool shared = false, solved = true;
    double shown(double load) const { return shared || !solved ? nan : load; }
};

std::vector<Largest> largest(const PickupLoads& loads) {
    std::vector<Largest> list;
    for (std::size_t k = 0; k < loads.pickups.size(); ++k) {
        Largest& most = list.emplace_back(Largest{.pickup = loads.pickups[k]});
        most.solved =
            std::ranges::any_of(loads.cases, [](const SolvedCase& c) { return !c.loads.empty(); });
        for (const auto& solved : loads.cases) {
            if (solved.loads.empty()) continue;
            const Vector6& w = solved.loads[k].in_ground_axes;
            most.shared = most.shared || !w.allFinite();
            if (const double force = w.head<3>().norm(); force > most.force) {
                most.force = force;
                most.force_in = solved.name;
            }
            const double rounding = 1e-9 * w.head<3>().norm();  // of levers of a metre
            if (const double moment = w.tail<3>().norm();
                moment > std::max(most.moment, rounding)) {
                most.moment = moment;
                most.moment_in = solved.name;
            }
        }
    }
    return list;
}

std::vector<ColumnOf<Largest>> largest_columns() {
    using enum Digits;
    const auto coordinate = [](int axis) {
        return [axis](const Largest& l) { return 1e3 * l.pickup.at[axis]; };
    };
    return {
        {"body", words, [](const Largest& l) { return l.pickup.body; }, "what the load acts on"},
        {"connection", words, [](const Largest& l) { return l.pickup.connection; },
         "the joint or element that exerts it"},
        {"x", place, coordinate(0), "of the point as drawn, vehicle axes", "mm"},
        {"y", place, coordinate(1), "likewise", "mm"},
        {"z", place, coordinate(2), "likewise", "mm"},
        {"force", whole, [](const Largest& l) { return l.shown(l.force); },
         "largest over the cases", "N"},
        {"force in", words, &Largest::force_in, "its case"},
        {"moment", four, [](const Largest& l) { return l.shown(l.moment); },
         "largest over the cases, about the point", "N·m"},
        {"moment in", words, &Largest::moment_in, "its case"}};
}

// A case and a pickup point, for readers.
struct LoadInCase {
    const Pickup* pickup;
    const SolvedCase* solved;
    const Vector6* load;
};

std::vector<LoadInCase> by_case(const PickupLoads& loads) {
    std::vector<LoadInCase> list;
    for (const auto& solved : loads.cases)
        for (std::size_t k = 0; k < solved.loads.size(); ++k)
            list.push_back({&loads.pickups[k], &solved, &solved.loads[k].in_ground_axes});
    return list;
}

std::vector<ColumnOf<LoadInCase>> case_columns() {
    std::vector<ColumnOf<LoadInCase>> columns{
        {"case", Digits::words, [](const LoadInCase& l) { return l.solved->name; }},
        {"body", Digits::words, [](const LoadInCase& l) { return l.pickup->body; }},
        {"connection", Digits::words, [](const LoadInCase& l) { return l.pickup->connection; }}};
    for (int c = 0; c < 6; ++c)
        columns.push_back(
            {components[static_cast<std::size_t>(c)], c < 3 ? Digits::whole : Digits::four,
             [c](const LoadInCase& l) { return (*l.load)[c]; }, "", c < 3 ? "N" : "N·m"});
    return columns;
}

// Names of the joints whose shares of a load are not determined.
std::string shared_joints(const std::vector<Largest>& list) {
    std::vector<std::string> names;
    for (const auto& entry : list)
        if (const std::string name = "'" + entry.pickup.connection + "'";
            entry.shared && std::ranges::find(names, name) == names.end())
            names.push_back(name);
    return fmt::format("{}", fmt::join(names, ", "));
}

Verdict verdict_of(const PickupLoads& loads) {
    Verdict verdict{.grade = Grade::pass};
    double imbalance = 0, disagreement = 0;
    for (const auto& solved : loads.cases) {
        const auto refuse = [&](const std::string& why) {
            verdict.reasons.push_back(fmt::format("case '{}': {}", solved.name, why));
        };
        if (solved.loads.empty()) {
            refuse(fmt::format("{}: {}{}", name(solved.outcome), solved.detail,
                               solved.outcome == Outcome::loaded_idle_mode
                                   ? "; a spring or the travel of the wheel has to hold it"
                               : solved.outcome == Outcome::limit_point
                                   ? "; the loads as drawn: with rates of springs at which they "
                                     "hardly move"
                                   : ""));
            continue;
        }
        imbalance = worse(imbalance, solved.imbalance);
        disagreement = worse(disagreement, solved.disagreement);
        if (!(solved.imbalance <= in_balance))
            refuse(fmt::format("a body is out of balance by {:.2g} of the largest load",
                               solved.imbalance));
        if (std::isnan(solved.disagreement))
            refuse(fmt::format("no second solution: {}", solved.detail));
        else if (!(solved.disagreement <= confirmed))
            refuse(fmt::format("two solutions differ by {:.2g} of the largest load",
                               solved.disagreement));
        verdict.compared += static_cast<int>(6 * solved.loads.size());
    }
    if (verdict.compared == 0) verdict.reasons.emplace_back("nothing was compared");
    if (!verdict.reasons.empty()) {
        verdict.grade = Grade::not_judged;
        verdict.sentence = "Not every case is confirmed.";
        return verdict;
    }
    verdict.sentence = fmt::format(
        "Confirmed: in {} every body is in balance to {:.1g} of the largest load, and two "
        "solutions "
        "agree to {:.1g}.",
        loads.cases.size() == 1 ? "the one case" : fmt::format("all {} cases", loads.cases.size()),
        imbalance, disagreement);
    return verdict;
}

}  // namespace

Result result_of(const PickupLoads& loads) {
    Result result{.analysis = "loads", .verdict = verdict_of(loads)};
    const auto list = largest(loads);
    result.tables.push_back(table({.id = "pickups"}, largest_columns(), list));
    result.tables.back().caption = "largest loads on each body, in vehicle axes";
    constexpr std::size_t max_rows = 1000;  // for readers
    if (const auto rows = by_case(loads); rows.size() <= max_rows) {
        result.tables.push_back(table({}, case_columns(), rows));
        result.tables.back().caption = "loads by cases, in vehicle axes";
        result.tables.back().detail = true;
    }
    result.tables.push_back(table({.id = "loads"}, load_columns(loads.pickups), loads.cases));
    if (const std::string names = shared_joints(list); !names.empty())
        result.notes.push_back(fmt::format(
            "statically indeterminate: the joints {} share loads in a way that no load determines. "
            "Their sum is given as A+B; bushings or fewer constraints determine the shares.",
            names));
    result.notes.emplace_back(
        "A load acts on its body, at the point where the joint or element holds it; that of a "
        "case as a whole (\"applied\") at the body's origin. Vehicle axes: x forward, y left, z "
        "up; columns body_force_x and so on turn with the body, whose axes are parallel to these "
        "as drawn.");
    return result;
}

}  // namespace elastocheck::compare
