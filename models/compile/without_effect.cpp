// Removes parts without effect, parts that are never active, and parts within one body.
#include "models/compile/parts.hpp"
#include "models/compile/passes.hpp"

namespace elastocheck::reduce {
namespace {

// Reason why the driver has no effect; empty if it has one. At value zero, a Motion still holds its
// joint, and a FreeLength (the road of a tyre) activates an element that is active only where driven.
std::string no_effect(const Driver& driver, const Scene& scene) {
    const bool is_always_zero = driver.start == 0 && driver.rate == 0;
    return std::visit(
        overloaded{
            [&](const Load& l) { return is_always_zero || is_zero(l.kind) ? "it is zero" : ""; },
            [](const Motion&) { return ""; },
            [&](const FreeLength& f) {
                const Elastic& elastic = scene.elastics[static_cast<std::size_t>(f.elastic)];
                const bool acts = !is_always_zero || elastic.active_only_where_driven;
                return acts && !is_zero(elastic.kind) ? "" : "it moves nothing";
            },
            [&](const Preload& p) {
                return is_always_zero || p.direction.isZero(0) ? "it is zero" : "";
            }},
        driver.what);
}

std::string name_of(const Driven& what, const Scene& scene) {
    const auto element = [&](int k) { return scene.elastics[static_cast<std::size_t>(k)].name; };
    return std::visit(
        overloaded{[](const Load& l) { return named("load", l.name); },
                   [&](const Motion& m) {
                       return named("motion of joint",
                                    scene.joints[static_cast<std::size_t>(m.joint)].name);
                   },
                   [&](const FreeLength& f) { return named("free length of", element(f.elastic)); },
                   [&](const Preload& p) { return named("preload of", element(p.elastic)); }},
        what);
}

}  // namespace

void drop_zero_loads(Scene& scene) {
    std::erase_if(scene.static_loads, [&](const Load& load) {
        if (!is_zero(load.kind)) return false;
        leave_out(scene, named("load", load.name), "it is zero");
        return true;
    });
    for (Branch& branch : scene.branches)
        std::erase_if(branch.drivers, [&](const Driver& driver) {
            const std::string why = no_effect(driver, scene);
            if (why.empty()) return false;
            leave_out(scene, name_of(driver.what, scene), why + " (branch '" + branch.name + "')");
            return true;
        });
}

void drop_never_active(Scene& scene) {
    const DrivenParts driven = driven_parts(scene);
    drop_parts(
        scene,
        [&](std::size_t k) {
            const bool is_active = !scene.joints[k].active_only_where_driven || driven.joints[k];
            return is_active ? "" : "no branch drives it";
        },
        [&](std::size_t k) {
            const Elastic& elastic = scene.elastics[k];
            const bool has_no_force = is_zero(elastic.kind);
            if (driven.elastics[k] || (!elastic.active_only_where_driven && !has_no_force))
                return "";
            return has_no_force ? "its rates and preload are zero" : "no branch drives it";
        });
}

void drop_within_one_body(Scene& scene) {
    const DrivenParts driven = driven_parts(scene);
    const auto both_on = [&](BodyId body) { return "both its ends are on " + named(scene, body); };
    drop_parts(
        scene,
        [&](std::size_t k) {
            const JointKind& kind = scene.joints[k].kind;
            const auto [i, j] = ends(kind);
            const bool stays = i != j || driven.joints[k] || is_strained_at_design(kind, scene);
            return stays ? "" : both_on(i) + "; its reaction is not an output";
        },
        [&](std::size_t k) {
            const ElasticKind& kind = scene.elastics[k].kind;
            const auto [i, j] = ends(kind);
            // A bushing law without energy may exert a net moment on its one body if it is loaded.
            const auto* formulation = member<Formulation>(kind);
            const bool has_moment = i != ground && formulation != nullptr &&
                                    !has_energy(*formulation) &&
                                    (driven.elastics[k] || is_loaded_at_design(kind, scene));
            return i != j || has_moment ? "" : both_on(i);
        });
}

}  // namespace elastocheck::reduce
