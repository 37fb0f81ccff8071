#include "reports/tables/studies/study_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "reports/tables/select.hpp"

namespace elastocheck::reports {

const std::vector<ShownColumn> study_columns{{"method"},
                                             {"output"},
                                             {"unit"},
                                             {"behaviour"},
                                             {"order", Digits::three},
                                             {"order error", Digits::size, "±"},
                                             {"finest step error", Digits::size},
                                             {"gap", Digits::three, "gap at end"},
                                             {"band", Digits::size, "± band"},
                                             {"gap share", Digits::three, "of the range"},
                                             {"gap exponent", Digits::three, "growth a^"},
                                             {"references apart", Digits::size},
                                             {"not studied"}};

const std::vector<ShownColumn> gap_columns{{"output"},
                                           {"unit"},
                                           {"whole", Digits::three},
                                           {"lever", Digits::three, "stored force's lever"},
                                           {"lever share", Digits::three, "share"},
                                           {"axis", Digits::three, "its axis and law"},
                                           {"axis share", Digits::three, "share"},
                                           {"load", Digits::three, "load's lever"},
                                           {"load share", Digits::three, "share"},
                                           {"rest", Digits::size},
                                           {"band", Digits::size, "± band"},
                                           {"not attributed"}};

namespace {

// Levels side by side: one row per combination of `keys`, one column per step count.
std::string over_steps(const compare::Table& levels, std::vector<std::string> keys,
                       const std::string& value) {
    std::vector<ShownColumn> shown;
    for (const auto& key : keys) shown.push_back({key});
    const std::size_t count = keys.size();
    keys.insert(keys.end(), {"steps", value});
    const auto wide = spread(only(levels, keys), "steps", {value});
    for (std::size_t c = count; c < wide.columns.size(); ++c) {
        const std::string& name = wide.columns[c].name;
        shown.push_back({name, Digits::size, name.substr(0, name.find(':'))});
    }
    return text(wide, shown);
}

}  // namespace

std::string study_text(const Model& model, const compare::Study& study,
                       const std::vector<compare::BranchAttribution>& attribution) {
    std::string all = fmt::format(
        "{}\nvalue - truth = step error (to the method's own limit) + formulation gap (own limit - "
        "reference) + reference uncertainty\nStudied are positions and angles; forces, moments and "
        "rates are "
        "compared by `elastocheck compare`.\n",
        model.name);
    const auto out = std::back_inserter(all);
    const auto outputs = study_table(study), steps = step_table(study),
               gaps = gap_table(study.channels, attribution);
    for (const auto& branch : distinct(outputs, "branch")) {
        const auto levels = where(steps, "branch", branch);
        for (const auto& reading : distinct(levels, "reading"))
            fmt::format_to(
                out,
                "\nbranch '{0}' {1}: order at which the largest step error over the branch falls, "
                "and what no step count removes\n{2}"
                "\nbranch '{0}' {1}: step errors, largest over the branch, over the steps\n{3}",
                branch, reading,
                text(where(where(outputs, "branch", branch), "reading", reading), study_columns),
                over_steps(where(levels, "reading", reading), {"method", "output", "unit"},
                           "largest"));
        // A candidate does not give |Φ|.
        if (const std::size_t c = column(levels, "constraint error");
            std::ranges::any_of(levels.rows, [&](const auto& row) {
                return std::isfinite(std::get<double>(row[c]));
            }))
            fmt::format_to(out, "\nbranch '{}': |Φ| at its end, eq. (31), over the steps\n{}",
                           branch, over_steps(levels, {"method"}, "constraint error"));
        const auto made = where(gaps, "branch", branch);
        for (const auto& reading : distinct(made, "reading"))
            fmt::format_to(
                out,
                "\nbranch '{}' {}: what the gap of the recursion is made of, whole = lever + axis "
                "+ load + rest\n{}",
                branch, reading, text(where(made, "reading", reading), gap_columns));
    }
    for (const auto& reason : study.inconclusive) fmt::format_to(out, "\ninconclusive: {}", reason);
    all += study.conclusive() ? "\nconclusive\n" : "\nINCONCLUSIVE\n";
    return all;
}

nlohmann::ordered_json study_json(const compare::Study& study,
                                  const std::vector<compare::BranchAttribution>& attribution) {
    return {{"conclusive", study.conclusive()},
            {"reasons", study.inconclusive},
            {"steps", study.steps},
            {"outputs", table_json(study_table(study))},
            {"step_errors", table_json(step_table(study))},
            {"gap", table_json(gap_table(study.channels, attribution))}};
}

}  // namespace elastocheck::reports
