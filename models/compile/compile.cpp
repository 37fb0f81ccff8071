#include "elastocheck/compile.hpp"

#include <algorithm>

#include "models/compile/parts.hpp"
#include "models/compile/passes.hpp"
#include "models/laws.hpp"
#include "models/lowering.hpp"

namespace elastocheck {
namespace {

// Point of a joint's end; the body's origin for an end that is a direction.
Point point_of_end(const Point& end) { return end; }
Point point_of_end(const Direction& end) { return {end.body, Vector3::Zero()}; }

ModelJoint summary(const Joint& joint) {
    const auto [i, j] = ends(joint.kind);
    const Point at = std::visit([](const auto& s) { return point_of_end(s.i); }, joint.kind);
    return {joint.name, i, j, at, -1, joint.active_only_where_driven};
}

bool is_framed_on_j(const ElasticKind& elastic) {
    const auto* formulation = member<Formulation>(elastic);
    return formulation != nullptr && formulation->frame == Formulation::Frame::on_j;
}

Size size_of(const Scene& scene) {
    int rows_of_joints = 0;
    for (const Joint& joint : scene.joints)
        for (const ConstraintKind& kind : lower(joint.kind, scene.bodies))
            rows_of_joints += rows(kind);
    const auto count = [](const auto& list) { return static_cast<int>(list.size()); };
    return {count(scene.bodies), count(scene.joints), count(scene.elastics), rows_of_joints};
}

void reduce_to_required(Scene& scene) {
    reduce::drop_zero_loads(scene);
    reduce::drop_never_active(scene);
    reduce::weld(scene);
    reduce::drop_within_one_body(scene);
    reduce::drop_unconnected_to_outputs(scene);
    reduce::drop_free_followers(scene);
    reduce::drop_duplicates(scene);
    reduce::replace_links(scene);
}

void lower_joints(const Scene& scene, Model& model) {
    for (const Joint& joint : scene.joints) {
        const int id = static_cast<int>(model.joints.size());
        ModelJoint& lowered = model.joints.emplace_back(summary(joint));
        const auto kinds = lower(joint.kind, scene.bodies);
        for (const ConstraintKind& kind : kinds) {
            if (kinds.size() == 1 && driven_number(kind) != nullptr)
                lowered.driven = static_cast<int>(model.constraints.size());
            model.constraints.push_back({id, kind});
        }
    }
}

// Swaps the markers of bushings with their frame on j, so that the legs need the frame on i only, and
// the sign of drivers of their preload.
void swap_markers_framed_on_j(Model& model) {
    const auto element = [&](int k) -> ElasticKind& {
        return model.elastics[static_cast<std::size_t>(k)].kind;
    };
    for (Branch& branch : model.branches)
        for (Driver& driver : branch.drivers)
            if (Vector6* direction = preload(driver.what);
                direction != nullptr && is_framed_on_j(element(driven_element(driver.what))))
                *direction = (-*direction).eval();
    for (Elastic& elastic : model.elastics)
        if (is_framed_on_j(elastic.kind)) {
            elastic.kind = markers_swapped(std::get<Bushing>(elastic.kind));
            elastic.markers_swapped = true;
        }
}

// Removes drivers of joints without a length, offset or angle, and lists branches that move nothing.
void drop_immovable_drivers(Model& model) {
    for (Branch& branch : model.branches) {
        std::erase_if(branch.drivers, [&](const Driver& driver) {
            const int moved = driven_joint(driver.what);
            if (moved < 0) return false;
            const ModelJoint& joint = model.joints[static_cast<std::size_t>(moved)];
            if (joint.driven >= 0) return false;
            model.omitted.push_back(
                {reduce::named("motion of joint", joint.name),
                 "the joint has no length, offset or angle (branch '" + branch.name + "')"});
            return true;
        });
        if (std::ranges::none_of(branch.drivers,
                                 [](const Driver& driver) { return driver.rate != 0; }))
            model.omitted.push_back(
                {reduce::named("branch", branch.name), "everything that it drives was removed"});
    }
}

}  // namespace

Model compile(const Scene& unreduced, Detail detail) {
    Scene scene = unreduced;
    if (detail == Detail::required) reduce_to_required(scene);
    Model model;
    model.name = scene.name;
    model.as_written = size_of(unreduced);
    model.as_solved = size_of(scene);
    model.bodies = scene.bodies;
    lower_joints(scene, model);
    model.elastics = scene.elastics;
    model.static_loads = scene.static_loads;
    model.branches = scene.branches;
    swap_markers_framed_on_j(model);
    model.wheels = scene.wheels;
    model.probes = scene.probes;
    model.dampers = scene.dampers;
    model.vehicle = scene.vehicle;
    model.omitted = scene.omitted;
    drop_immovable_drivers(model);
    return model;
}

}  // namespace elastocheck
