#include <fmt/format.h>

#include <optional>
#include <stdexcept>

#include "compare/loads/loads.hpp"
#include "compare/outputs/fixed_bodies.hpp"
#include "compare/outputs/positions.hpp"
#include "elastocheck/compile.hpp"
#include "models/kinds.hpp"

namespace elastocheck::compare {
namespace {

using Kind = CaseInput::Kind;

constexpr const char* weight_prefix = "gravity.";  // of the names of static loads
constexpr double same_point = 1e-6;                // [m]

// Position of the joint that is the jack under a wheel centre; added if the scene has none.
int jack_under(const Wheel& wheel, Scene& scene) {
    const std::string name = (wheel.name.empty() ? "" : wheel.name + ".") + "jack";
    for (std::size_t k = 0; k < scene.joints.size(); ++k)
        if (scene.joints[k].name == name) return static_cast<int>(k);
    const Pose& carrier = scene.bodies[static_cast<std::size_t>(wheel.body)].design;
    scene.joints.push_back({name,
                            InPlane{.i = {wheel.body, wheel.centre_local},
                                    .j = {ground, carrier.r + carrier.p * wheel.centre_local},
                                    .normal_j = {ground, Vector3::UnitZ()},
                                    .offset = 0},
                            true});
    return static_cast<int>(scene.joints.size()) - 1;
}

std::optional<Load> weight_of(const Scene& scene, const std::string& body) {
    for (const Load& load : scene.static_loads)
        if (load.name == weight_prefix + body) return load;
    return std::nullopt;
}

// A unit force or moment of an input.
Load unit_load(const Scene& scene, const CaseInput& input) {
    const Vector3 along = Vector3::Unit(input.axis);
    if (input.kind == Kind::body_force) {
        const Body& body = scene.bodies[input.of];
        if (const auto weight = weight_of(scene, body.name))
            return {"force", DeadForce{*member<Point>(weight->kind), along}};
        return {"force", DeadForce{{static_cast<BodyId>(input.of), Vector3::Zero()}, along}};
    }
    const Wheel& wheel = scene.wheels[input.of];
    if (input.kind == Kind::wheel_moment) return {"moment", DeadMoment{wheel.body, along}};
    if (input.kind == Kind::centre_force)
        return {"force", DeadForce{{wheel.body, wheel.centre_local}, along}};
    if (wheel.rolls() && input.axis == 0)
        return {"force", BrakeForce{wheel.contact, wheel.body, along}};
    return {"force", DeadForce{wheel.contact, along}};
}

// Sum of the static forces of the scene at a patch along an axis [N].
double static_force(const Model& model, const Point& patch, int axis) {
    const FixedBodies fixed(model);
    double sum = 0;
    for (const Load& load : model.static_loads) {
        if (is_moment(load.kind) || is_follower(load.kind)) continue;
        const Point& at = *member<Point>(load.kind);
        if (fixed.are_one(at.body, patch.body) &&
            (drawn(model, at) - drawn(model, patch)).norm() < same_point)
            sum += load_vector(load.kind)[axis];
    }
    return sum;
}

void add_acceleration(const Scene& scene, const CaseInput& input, Branch& branch) {
    bool any = false;
    for (const Body& body : scene.bodies) {
        const auto weight = weight_of(scene, body.name);
        if (!weight) continue;
        const Vector3 inertia = -load_vector(weight->kind).norm() * Vector3::Unit(input.axis);
        branch.drivers.push_back(
            {Load{"inertia", DeadForce{*member<Point>(weight->kind), inertia}}, 0, input.value});
        any = true;
    }
    if (!any)
        throw std::invalid_argument(fmt::format(
            "case '{}' has an acceleration, and no body of the scene has a mass under gravity",
            branch.name));
}

Branch branch_of(const LoadCase& load_case, const Model& drawn, Scene& scene) {
    check_heights(load_case, scene);
    Branch branch;
    branch.name = load_case.name;
    branch.to = branch.steps = 1;
    branch.unit = ParameterUnit::none;
    for (const auto& input : load_case.inputs) {
        if (input.kind == Kind::travel) {
            const int jack = jack_under(scene.wheels[input.of], scene);
            branch.drivers.push_back({Motion{jack}, 0, input.value});
        } else if (input.kind == Kind::acceleration) {
            add_acceleration(scene, input, branch);
        } else {
            // Static loads stay: the case adds the difference.
            const double before =
                input.kind == Kind::patch_force
                    ? static_force(drawn, scene.wheels[input.of].contact, input.axis)
                    : 0;
            branch.drivers.push_back({unit_load(scene, input), 0, input.value - before});
        }
    }
    return branch;
}

}  // namespace

void check_heights(const LoadCase& load_case, const Scene& scene) {
    for (const auto& held : load_case.inputs)
        for (const auto& force : load_case.inputs)
            if (held.kind == Kind::travel && force.kind == Kind::patch_force && force.axis == 2 &&
                force.of == held.of) {
                const std::string& name = scene.wheels[held.of].name;
                throw std::invalid_argument(fmt::format(
                    "case '{}' has the travel and the vertical force of {}: one follows from the "
                    "other; leave one cell empty",
                    load_case.name, name.empty() ? "the wheel" : "wheel '" + name + "'"));
            }
}

Scene with_cases(Scene scene, const std::vector<LoadCase>& cases) {
    const Model drawn = compile(scene, Detail::everything);
    std::vector<Branch> branches;
    for (const auto& load_case : cases) branches.push_back(branch_of(load_case, drawn, scene));
    scene.branches = std::move(branches);
    return scene;
}

}  // namespace elastocheck::compare
