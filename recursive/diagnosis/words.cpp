// Messages of a diagnosis: idle modes, undecided redundancy, why a path ended.
#include <fmt/format.h>

#include <algorithm>

#include "models/parameter_unit.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "recursive/linear_algebra/rank.hpp"

namespace elastocheck::recursive {
namespace {

std::string moving(const std::vector<std::string>& outputs) {
    return outputs.empty() ? "moves no output" : "moves " + listed(outputs);
}
// The body of "strut: rotation about ...".
std::string body_of(const IdleMode& mode) {
    return mode.description.substr(0, mode.description.find(": "));
}

}  // namespace

std::string listed(const std::vector<std::string>& names) {
    std::string all;
    for (std::size_t k = 0; k < names.size(); ++k)
        all += (k == 0 ? "" : k + 1 < names.size() ? ", " : " and ") + ("'" + names[k] + "'");
    return all;
}

std::string undecided(const Model& model, const Diagnosis& diagnosis) {
    const auto in_doubt = std::ranges::find_if(diagnosis.redundant, &Redundancy::undecided);
    if (in_doubt == diagnosis.redundant.end()) return {};
    return fmt::format(
        "whether joint '{}' is redundant is undecidable: the independent part of one of its "
        "equations is {:.1e}, more than rounding and less than {:.0e}; make it exactly redundant "
        "or clearly independent",
        model.joints[static_cast<std::size_t>(in_doubt->joint)].name, in_doubt->remainder,
        rank_threshold);
}

std::vector<std::string> describe_idle_modes(const Diagnosis& diagnosis) {
    std::vector<std::string> lines, spinning;
    for (const IdleMode& mode : diagnosis.idle)
        if (mode.spins && mode.outputs.empty()) spinning.push_back(body_of(mode));
    const bool together = spinning.size() > 1;
    for (const IdleMode& mode : diagnosis.idle)
        if (!(together && mode.spins && mode.outputs.empty()))
            lines.push_back(mode.description + ", " + moving(mode.outputs));
    if (together)
        lines.push_back((spinning.size() == 2 ? "both " : "") + listed(spinning) +
                        " rotate about their own axis, which " + moving({}));
    return lines;
}

std::string idle_modes(const Diagnosis& diagnosis) {
    std::string all;
    for (const auto& line : describe_idle_modes(diagnosis)) all += (all.empty() ? "" : "; ") + line;
    return all;
}

std::string no_length(const Model& model, const Branch& branch, const Vanishing& vanishing) {
    return fmt::format("joint '{}' would have no length from {} on",
                       model.joints[static_cast<std::size_t>(vanishing.joint)].name,
                       parameter_text(branch.unit, vanishing.parameter));
}

std::string end_by_diagnosis(Outcome outcome, const Diagnosis& diagnosis) {
    switch (outcome) {
        case Outcome::loaded_idle_mode:
            return ": the load acts on a motion that no joint or element resists at the design "
                   "position: " +
                   idle_modes(diagnosis);
        case Outcome::inconsistent_constraints: return ": redundant joints are inconsistent";
        case Outcome::bifurcation_point:
            return ": another curve of equilibria crosses the branch, which is unstable past this "
                   "point";
        case Outcome::singular:
            return diagnosis.null_space.cols() > 0
                       ? ", or an idle mode or redundant constraint of the design position no "
                         "longer is one"
                       : "";
        default: return {};
    }
}

}  // namespace elastocheck::recursive
