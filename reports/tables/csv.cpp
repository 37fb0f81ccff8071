#include "reports/tables/csv.hpp"

#include <fmt/format.h>

#include "reports/document/document.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
std::string load_units(const Model& model) {
    std::string units;
    for (const auto& branch : model.branches)
        if (const std::string unit = load_unit(branch); units.find(unit + ";") == units.npos)
            units += unit + ";";
    if (!units.empty()) units.pop_back();
    return units;
}

std::string curves_header(const Model& model) {
    std::string line = fmt::format("branch,leg,load factor [{}],travel [mm]", load_units(model));
    for (const auto& channel : compare::channels(model))
        line += fmt::format(",{}", for_csv(fmt::format("{} [{}]", channel.name, symbol(channel.unit))));
    return line + "\n";
}

std::string curves_rows(const std::string& branch, const compare::LegRun& run) {
    std::string rows;
    for (std::size_t k = 0; k < run.curve.load.size(); ++k) {
        rows += fmt::format("{},{},{:.17g},", for_csv(branch), name(run.leg), run.curve.load[k]);
        if (!run.curve.travel.empty()) rows += fmt::format("{:.17g}", run.curve.travel[k]);
        for (const double value : run.curve.values[k]) rows += fmt::format(",{:.17g}", value);
        rows += "\n";
    }
    return rows;
}

}  // namespace elastocheck::reports
