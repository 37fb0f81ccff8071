// Derivative of the compiled model by the numbers of its scene file.
//
// Exact: the reader and compile() run with dual numbers (models/rates/README.md), so that
// normalised axes, free lengths from preloads, mirrored twins, interpolants, beams and merged
// bodies are differentiated as they are computed.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "elastocheck/compile.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck {

// Derivatives are models and scenes as well: every real number is replaced by its derivative, and
// everything else (names, bodies, alternatives, sizes, formulations) is that of the model. So
// quaternions are not of unit length, and rates may be negative. Scene::numbers is that of the
// scene.
struct ModelRate {
    std::string path;  // of Scene::numbers, "springs.coil.rate"; or several
    Model rate;        // of compile(scene, detail), SI per unit of the number as written
    // The reason where there is no derivative: a whole number, a number that decides which parts
    // the model has, a kink. All derivatives are then NaN.
    std::string undefined = {};
    Scene scene_rate = {};  // of the scene itself
    // 1 or -1: at the end of its range, where it can only increase (decrease); then `undefined` is
    // empty, and the derivatives are those to that side.
    int side = 0;
    // At a kink: the derivatives of the model to both sides.
    std::optional<Model> below = {}, above = {};
};

// One for each path, in their order; settings apply before. A path may be several joined by commas,
// "bushings.mount.rates.y,bushings.mount.rates.z": all of these change by the same amount. Throws
// SceneError for a file that read_scene() does not accept, and for a path that is not in
// Scene::numbers.
std::vector<ModelRate> model_rates(const std::filesystem::path& file,
                                   std::span<const Setting> settings,
                                   std::span<const std::string> paths,
                                   Detail detail = Detail::required);

// The same from text, as parse_scene().
std::vector<ModelRate> model_rates(std::string_view text, const std::string& name,
                                   std::span<const Setting> settings,
                                   std::span<const std::string> paths,
                                   Detail detail = Detail::required);

// By all numbers of the file, in their order. Numbers that the file accepts only together, such as
// the rates across the only axis of a bushing's frame, or the entries (1, 2) and (2, 1) of a
// stiffness matrix, are joined by a comma in `path`, at the place of the first.
std::vector<ModelRate> all_model_rates(const std::filesystem::path& file,
                                       std::span<const Setting> settings = {},
                                       Detail detail = Detail::required);

// The derivative of compile(scene, detail) along a change of the scene: `rate` has the structure of
// the scene, with derivatives for numbers. For a scene that is changed after reading, as by a trim.
// `path` is empty and `scene_rate` is `rate`.
ModelRate model_rate(const Scene& scene, const Scene& rate, Detail detail = Detail::required);

}  // namespace elastocheck
