// Stress-test sweeps that apply to any scene. Few points each: both ends and one in between.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compare/stress/stress.hpp"
#include "compare/stress/transforms.hpp"
#include "models/kinds.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Scene first_branch(const Scene& scene) {
    Scene one = scene;
    if (one.branches.size() > 1) one.branches.resize(1);
    return one;
}

// The first branch with `to` and `from` times a factor.
Scene driven(const Scene& scene, double factor) {
    Scene farther = first_branch(scene);
    for (auto& branch : farther.branches) branch.from *= factor, branch.to *= factor;
    return farther;
}

std::vector<Variant> itself(const Scene& scene) { return {{"as it is", scene}}; }

double drawn_length(const Scene& scene, const std::vector<Point>& ends) {
    const auto drawn = [&](const Point& at) -> Vector3d {
        if (at.body == ground) return at.s_local;
        const Pose& body = scene.bodies[static_cast<std::size_t>(at.body)].design;
        return body.r + body.p * at.s_local;
    };
    return (drawn(ends[1]) - drawn(ends[0])).norm();
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

// Lengths and loads scaled together, translational rates unchanged, so that the relative movement
// is the same; rotational rates unchanged, so that the lever arms become negligible or dominant.
std::vector<Variant> levers(const Scene& scene) {
    std::vector<Variant> variants;
    for (const double factor : {1e-6, 1e-3, 1e3})
        variants.push_back({fmt::format("lever arms times {:g}", factor),
                            with_rotational_rates(scaled(first_branch(scene), factor, factor),
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

// One step, and as many as make round-off visible within some seconds, for one method of each kind.
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

// The same numbers read in other units.
std::vector<Variant> units(const Scene& scene) {
    std::vector<Variant> variants;
    for (const auto& [label, factor] : {std::pair{"its millimetres read as metres", 1e3},
                                        {"its metres read as millimetres", 1e-3}})
        variants.push_back({.label = label,
                            .scene = scaled(first_branch(scene), factor, factor * factor),
                            .transforms = Transform{.length = factor}});
    return variants;
}

std::vector<Variant> far_away(const Scene& scene) {
    const Vector3d t(10e3, 0, 0);
    return {{.label = "10 km from the origin",
             .scene = moved(first_branch(scene), Quaterniond::Identity(), t),
             .transforms = Transform{.t = t}}};
}

std::vector<Variant> invariances(const Scene& original) {
    const Scene scene = first_branch(original);
    const Quaterniond R(Eigen::AngleAxisd(2, Vector3d(1, -2, 0.5).normalized()));
    const Eigen::Matrix3d S = Vector3d(1, -1, 1).asDiagonal();
    return {{.label = "rotated",
             .scene = moved(scene, R, Vector3d::Zero()),
             .transforms = Transform{.M = R.toRotationMatrix()}},
            {.label = "mirrored", .scene = mirrored(scene), .transforms = Transform{.M = S}},
            {.label = "in reverse order", .scene = reversed(scene), .transforms = Transform{}},
            {.label = "in other body axes",
             .scene = with_body_axes(scene, {R, R.conjugate()}),
             .transforms = Transform{}}};
}

// The unchanged scene under other arithmetic; and every number of it changed by one ulp.
std::vector<Variant> arithmetic(const Scene& original) {
    const Scene scene = first_branch(original);
    std::vector<Variant> variants;
    for (const auto how :
         {Arithmetic::up, Arithmetic::down, Arithmetic::towards_zero, Arithmetic::flushed})
        variants.push_back({.label = name(how),
                            .scene = scene,
                            .transforms = Transform{},
                            .skipped = exists(how) ? "" : "not available on this processor",
                            .arithmetic = how});
    variants.push_back(
        {.label = "an ulp off", .scene = an_ulp_off(scene), .transforms = Transform{}});
    return variants;
}

}  // namespace

const std::vector<Sweep>& sweeps() {
    static const std::vector<Sweep> all{{std::string(as_it_is), itself},
                                        {"transforms", invariances},
                                        {"units", units},
                                        {"far away", far_away},
                                        {"stiffness", stiffness},
                                        {"levers", levers},
                                        {"load", loads},
                                        {"beyond", beyond},
                                        {"steps", steps},
                                        {"arithmetic", arithmetic}};
    return all;
}

}  // namespace elastocheck::compare
