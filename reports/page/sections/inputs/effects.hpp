// Effects of the numbers of a scene on its key figures, for the section on what to change.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reports/document/scene_analyses.hpp"
#include "reports/page/page.hpp"

namespace elastocheck::reports {

inline constexpr double rounded_effect = 1e-9;  // of the largest effect on a figure

// An output at one place, and the effects of the numbers on it.
struct KeyFigure {
    std::string title, unit;
    std::vector<compare::EffectRow> effects{};  // finite, the largest first

    double largest() const { return effects.empty() ? 0 : std::abs(effects.front().effect); }
    // larger than rounding
    bool counts(double effect) const { return std::abs(effect) > rounded_effect * largest(); }
};
std::vector<KeyFigure> key_figures(const std::vector<compare::EffectRow>& rows);

// "tie rod inner z", "coil rate (1 %)" of a path in the scene file.
std::string number_label(const compare::EffectRow& row);

// A hardpoint, and the gradient of a figure by its position, per 1 mm.
using Gradient = std::pair<std::string, Position>;
// Gradients by all hardpoints that the rows have, in the order of the file.
std::vector<Gradient> gradients_of(const KeyFigure& figure,
                                   const std::vector<compare::EffectRow>& rows);
double size_of(const Gradient& gradient);

// The suspension with an arrow at each hardpoint in the direction in which the figure grows most.
std::optional<FigureGroup> effect_arrows(const SceneAnalyses& scene, const KeyFigure& figure,
                                         const std::vector<compare::EffectRow>& rows);

}  // namespace elastocheck::reports
