// Stress-test sweeps that apply to any scene. Few points each: both ends and one in between.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/outputs/positions.hpp"
#include "compare/stress/stress.hpp"
#include "models/kinds.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

Scene first_branch(Scene scene) {
    if (scene.branches.size() > 1) scene.branches.resize(1);
    return scene;
}

// The first branch with `to` and `from` times a factor.
Scene driven(const Scene& scene, double factor) {
    Scene farther = first_branch(scene);
    for (auto& branch : farther.branches) {
        branch.from *= factor;
        branch.to *= factor;
    }
    return farther;
}

double drawn_length(const Scene& scene, const std::vector<Point>& ends) {
    std::vector<Pose> design;
    for (const auto& body : scene.bodies) design.push_back(body.design);
    return (position(design, ends[1]) - position(design, ends[0])).norm();
}

// First element much softer or stiffer than the others; a spring keeps its force in the design
// position, so that the equilibrium there is unchanged.
std::vector<Variant> stiffness(const Scene& scene) {
    std::vector<Variant> variants;
    if (scene.elastics.empty()) return variants;
    for (const double factor : {0.0, 1e-6, 1e6, 1e12, 1e18}) {
        Scene varied = first_branch(scene);
        Elastic& element = varied.elastics.front();
        element = stiffened(element, factor);
        double* free_length = driven_number(element.kind);
        if (free_length != nullptr && factor > 0 && curve_of(element.kind, 0) == nullptr) {
            const double length = drawn_length(varied, points_of(element.kind));
            *free_length = length + (*free_length - length) / factor;
        }
        variants.push_back({fmt::format("rates of '{}' times {:g}", element.name, factor), varied});
    }
    return variants;
}

// Lengths and loads are scaled together at unchanged translational rates, so that the relative movement
// is the same. Rotational rates stay unchanged too, so that levers become negligible or dominant.
std::vector<Variant> levers(const Scene& scene) {
    std::vector<Variant> variants;
    for (const double factor : {1e-6, 1e-3, 1e3})
        variants.push_back({fmt::format("lever arms times {:g}", factor),
                            with_rotational_rates(transformed(first_branch(scene),
                                                              {.length = factor, .force = factor}),
                                                  1 / (factor * factor))});
    return variants;
}

// Range of the parameter from almost zero to far too large. At 0 only the static loads act.
std::vector<Variant> loads(const Scene& scene) {
    std::vector<Variant> variants;
    Scene still = first_branch(scene);
    for (auto& branch : still.branches)
        for (auto& driver : branch.drivers) driver.rate = 0;
    variants.push_back({"nothing is driven", still});
    if (scene.branches.empty()) return variants;
    const double to =
        std::max(std::abs(scene.branches.front().to), std::abs(scene.branches.front().from));
    for (const double target : {1e-12, 1e6})
        variants.push_back({fmt::format("driven to {:g} instead of {:g}", target, to),
                            driven(scene, to > 0 ? target / to : 1)});
    return variants;
}

std::vector<Variant> beyond(const Scene& scene) {
    std::vector<Variant> variants;
    for (const double factor : {3.0, 10.0, 30.0})
        variants.push_back(
            {fmt::format("driven {:g} times as far", factor), driven(scene, factor)});
    return variants;
}

// One step, for all methods; and as many as make round-off visible within some seconds, for one method
// of each kind.
std::vector<Variant> steps(const Scene& scene) {
    std::vector<Variant> variants;
    const auto bodies = scene.bodies.size();
    const int many = bodies <= 1 ? 1'000'000 : bodies <= 4 ? 100'000 : 10'000;
    for (const int steps : {1, many}) {
        Scene varied = first_branch(scene);
        for (auto& branch : varied.branches) branch.steps = steps;
        Variant variant{.label = fmt::format("{} step{}", steps, steps == 1 ? "" : "s"),
                        .scene = varied};
        for (const auto& method : recursive::methods)
            if (has_steps(method) && (steps == 1 || method.name == "published" ||
                                      method.name == "balanced" || method.name == "chord"))
                variant.requested.emplace_back(method.name);
        variants.push_back(std::move(variant));
    }
    return variants;
}

Variant transform(const char* label, const Scene& scene, const Transform& how) {
    return {label, transformed(first_branch(scene), how), how};
}

// The same numbers read in other units.
std::vector<Variant> units(const Scene& scene) {
    return {transform("its millimetres read as metres", scene, {.length = 1e3, .force = 1e6}),
            transform("its metres read as millimetres", scene, {.length = 1e-3, .force = 1e-6})};
}

std::vector<Variant> far_away(const Scene& scene) {
    return {transform("10 km from the origin", scene, {.t = {10e3, 0, 0}})};
}

std::vector<Variant> invariances(const Scene& scene) {
    const Eigen::AngleAxisd R(2, Vector3d(1, -2, 0.5).normalized());
    return {transform("rotated", scene, {.M = R.toRotationMatrix()}),
            transform("mirrored", scene, {.M = Vector3d(1, -1, 1).asDiagonal().toDenseMatrix()})};
}

}  // namespace

std::vector<Trial> trials(const std::string& name, const Scene& scene) {
    std::vector<Trial> trials{{name, std::string(as_it_is), {"as it is", scene}}};
    using Sweep = std::pair<const char*, std::vector<Variant> (*)(const Scene&)>;
    for (const auto& [sweep, variants] : {Sweep{"transforms", invariances},
                                          {"units", units},
                                          {"far away", far_away},
                                          {"stiffness", stiffness},
                                          {"levers", levers},
                                          {"load", loads},
                                          {"beyond", beyond},
                                          {"steps", steps}})
        for (auto& variant : variants(scene)) trials.push_back({name, sweep, std::move(variant)});
    return trials;
}

}  // namespace elastocheck::compare
