#include "tests/support/transforms.hpp"

#include <algorithm>

#include "models/kinds.hpp"

namespace elastocheck::support {

using Eigen::Quaterniond;

Scene with_body_axes(const Scene& original, const std::vector<Quaterniond>& turns) {
    Scene scene = original;
    const auto turn = [&](BodyId body) {
        return body == ground ? Quaterniond::Identity()
                              : turns[static_cast<std::size_t>(body) % turns.size()].conjugate();
    };
    for (BodyId b = 0; b < static_cast<BodyId>(scene.bodies.size()); ++b) {
        auto& p = scene.bodies[static_cast<std::size_t>(b)].design.p;
        p = p * turn(b).conjugate();
    }
    const auto turned = overloaded{[&](Point& p) { p.s_local = turn(p.body) * p.s_local; },
                                   [&](Direction& u) { u.u_local = turn(u.body) * u.u_local; },
                                   [&](Marker& m) {
                                       m.s_local = turn(m.body) * m.s_local;
                                       m.A_local = turn(m.body) * m.A_local;
                                   },
                                   [&](LoadVector<Eigen::Vector3d> v) {
                                       if (v.axes != ground) v.value = turn(v.axes) * v.value;
                                   }};
    for (auto& joint : scene.joints) each_member(joint.kind, turned);
    for (auto& elastic : scene.elastics) each_member(elastic.kind, turned);
    each_load(scene, [&](LoadKind& load) { each_member(load, turned); });
    for (auto& probe : scene.probes) turned(probe.at);
    for (auto& damper : scene.dampers) turned(damper.i), turned(damper.j);
    for (auto& wheel : scene.wheels) {
        turned(wheel.contact);
        if (auto& axis = wheel.steering_axis) turned(axis->lower), turned(axis->upper);
        for (auto* v : {&wheel.centre_local, &wheel.spin_axis_local}) *v = turn(wheel.body) * *v;
    }
    return scene;
}

Scene reversed(const Scene& original) {
    Scene scene = original;
    const BodyId last = static_cast<BodyId>(scene.bodies.size()) - 1;
    const auto renumber = [&](BodyId& body) {
        if (body != ground) body = last - body;
    };
    for (auto& joint : scene.joints) each_body(joint.kind, renumber);
    for (auto& elastic : scene.elastics) each_body(elastic.kind, renumber);
    each_load(scene, [&](LoadKind& load) { each_body(load, renumber); });
    for (auto& probe : scene.probes) renumber(probe.at.body);
    for (auto& damper : scene.dampers) renumber(damper.i.body), renumber(damper.j.body);
    for (auto& wheel : scene.wheels) {
        renumber(wheel.body), renumber(wheel.contact.body);
        if (auto& axis = wheel.steering_axis)
            renumber(axis->lower.body), renumber(axis->upper.body);
    }
    const auto from_the_end = [](int& k, std::size_t count) {
        k = static_cast<int>(count) - 1 - k;
    };
    for (auto& branch : scene.branches)
        for (auto& driver : branch.drivers)
            each_member(
                driver.what,
                overloaded{
                    [&](JointIndex<int> k) { from_the_end(k.value, scene.joints.size()); },
                    [&](ElasticIndex<int> k) { from_the_end(k.value, scene.elastics.size()); }});
    std::ranges::reverse(scene.bodies);
    std::ranges::reverse(scene.joints);
    std::ranges::reverse(scene.elastics);
    return scene;
}

}  // namespace elastocheck::support
