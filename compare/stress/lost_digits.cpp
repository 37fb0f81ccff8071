#include "compare/stress/lost_digits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace elastocheck::compare {
namespace {

std::string group_of(const std::string& solver) {
    const auto method = recursive::find_method(solver);
    return method && has_steps(*method) ? "steps" : solver;
}

std::size_t place_of(std::vector<std::string>& list, const std::string& word) {
    const auto found = std::ranges::find(list, word);
    const auto place = static_cast<std::size_t>(found - list.begin());
    if (found == list.end()) list.push_back(word);
    return place;
}

// GroupWorst result over all cells of one group.
struct GroupWorst {
    bool wrong = false, reported_failure = false, unknown = false;
    std::optional<double> digits;

    void add(const StressCell& cell) {
        wrong |= cell.verdict == Verdict::wrong;
        if (const double lost = digits_lost(cell); std::isfinite(lost))
            digits = std::max(digits.value_or(0), lost);
        else
            (cell.outcome == Outcome::converged ? unknown : reported_failure) = true;
    }
    Loss text() const {
        if (wrong) return "X";
        if (digits) return fmt::format("{:.1f}", *digits);
        return unknown ? "?" : reported_failure ? "!" : ".";
    }
};

}  // namespace

double digits_lost(const StressCell& cell) {
    constexpr double all = 16;
    return cell.apart == 0 ? 0 : std::clamp(all + std::log10(cell.apart / cell.range), 0.0, all);
}

LostDigits lost_digits(const Survival& survival) {
    LostDigits result;
    std::vector<std::string> scenes;
    for (const auto& solver : survival.solvers) place_of(result.groups, group_of(solver));
    for (const auto& cell : survival.cells)
        if (cell.sweep == other_arithmetic)
            place_of(scenes, cell.scene), place_of(result.variants, cell.variant);

    for (const auto& scene : scenes) {
        std::vector<const StressCell*> drawn;
        for (const auto& cell : survival.cells)
            if (cell.scene == scene && cell.sweep == as_it_is) drawn.push_back(&cell);
        std::vector worst(result.variants.size(), std::vector<GroupWorst>(result.groups.size()));
        for (const auto& cell : survival.cells) {
            if (cell.scene != scene || cell.sweep != other_arithmetic) continue;
            worst[place_of(result.variants, cell.variant)]
                 [place_of(result.groups, group_of(cell.solver))]
                     .add(cell);
            if (digits_lost(cell) > (result.worst == nullptr ? 0 : digits_lost(*result.worst)))
                result.worst = &cell;
            if (cell.lost > (result.worst_right == nullptr ? 0 : result.worst_right->lost))
                result.worst_right = &cell;
            const bool stood = std::ranges::any_of(drawn, [&](const StressCell* one) {
                return one->side == cell.side && one->solver == cell.solver &&
                       one->outcome == Outcome::converged;
            });
            if (stood && cell.outcome != Outcome::converged) result.gave_up.push_back(&cell);
        }
        LostDigits::Row& row = result.rows.emplace_back();
        row.scene = scene;
        for (const auto& variant : worst) {
            auto& text = row.lost.emplace_back();
            for (const auto& group : variant) text.push_back(group.text());
        }
    }
    return result;
}

}  // namespace elastocheck::compare
