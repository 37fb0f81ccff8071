#include "tests/support/scenes.hpp"

#include <algorithm>
#include <filesystem>

#include "models/reader/scene_file.hpp"

namespace elastocheck::support {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

template <class T>
concept HasLocalPoint = requires(T& t) {
    t.s_local;
};
template <class T>
concept HasDirection = requires(T& t) {
    t.u_local;
};

// Calls f on every Point, Direction and Marker of the scene.
template <class F>
void for_each_feature(Scene& scene, F&& f) {
    for (auto& joint : scene.joints)
        std::visit(
            [&](auto& s) {
                f(s.i), f(s.j);
                if constexpr (requires { s.axis_i; }) f(s.axis_i);
                if constexpr (requires { s.axis_j; }) f(s.axis_j);
                if constexpr (requires { s.normal_i; }) f(s.normal_i);
                if constexpr (requires { s.normal_j; }) f(s.normal_j);
                if constexpr (requires { s.x_i; }) f(s.x_i), f(s.x_j), f(s.y_i);
                if constexpr (requires { s.y_j; }) f(s.y_j);
            },
            joint.kind);
    for (auto& elastic : scene.elastics) std::visit([&](auto& e) { f(e.i), f(e.j); }, elastic.kind);
    for (auto& probe : scene.probes) f(probe.at);
}

template <class F>
void for_each_load(Scene& scene, F&& f) {
    for (auto& load : scene.static_loads) f(load.kind);
    for (auto& branch : scene.branches)
        for (auto& driver : branch.drivers)
            if (auto* load = std::get_if<Load>(&driver.what)) f(load->kind);
}

}  // namespace

Scene scene(const std::string& name) {
    return read_scene(std::string(ELASTOCHECK_SCENES) + "/" + name + ".yaml");
}

std::vector<std::string> scene_names() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(ELASTOCHECK_SCENES))
        if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem());
    std::ranges::sort(names);
    return names;
}

Scene moved(const Scene& original, const Quaterniond& R, const Vector3d& t) {
    Scene scene = original;
    for (auto& point : scene.hardpoints) point.position = R * point.position + t;
    for (auto& body : scene.bodies) body.design = {R * body.design.r + t, R * body.design.p};
    for_each_feature(scene, [&](auto& feature) {
        if (feature.body != ground) return;
        if constexpr (HasLocalPoint<decltype(feature)>) feature.s_local = R * feature.s_local + t;
        if constexpr (HasDirection<decltype(feature)>) feature.u_local = R * feature.u_local;
        if constexpr (requires { feature.A_local; }) feature.A_local = R * feature.A_local;
    });
    for_each_load(scene, [&](LoadKind& load) {
        if (auto* force = std::get_if<DeadForce>(&load))
            force->f = R * force->f;
        else
            std::get<DeadMoment>(load).m = R * std::get<DeadMoment>(load).m;
    });
    return scene;
}

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
    for_each_feature(scene, [&](auto& feature) {
        if constexpr (HasLocalPoint<decltype(feature)>)
            feature.s_local = turn(feature.body) * feature.s_local;
        if constexpr (HasDirection<decltype(feature)>) feature.u_local = turn(feature.body) * feature.u_local;
        if constexpr (requires { feature.A_local; }) feature.A_local = turn(feature.body) * feature.A_local;
    });
    for_each_load(scene, [&](LoadKind& load) {
        if (auto* force = std::get_if<DeadForce>(&load))
            force->at.s_local = turn(force->at.body) * force->at.s_local;
    });
    for (auto& wheel : scene.wheels)
        for (auto* v : {&wheel.centre_local, &wheel.contact_local, &wheel.spin_axis_local})
            *v = turn(wheel.body) * *v;
    return scene;
}

Scene mirrored(const Scene& original) {
    // Positions and forces are reflected by S; rotation vectors and moments, being axial, by -S. Axes A
    // become S A S, so that a stiffness in local axes becomes diag(S, -S) K diag(S, -S).
    const Eigen::DiagonalMatrix<double, 3> S(1, -1, 1);
    const auto rotation = [&](const Quaterniond& p) {
        return Quaterniond(Eigen::Matrix3d(S * p.toRotationMatrix() * S));
    };
    Scene scene = original;
    for (auto& point : scene.hardpoints) point.position = S * point.position;
    for (auto& body : scene.bodies) body.design = {S * body.design.r, rotation(body.design.p)};
    for_each_feature(scene, [&](auto& feature) {
        if constexpr (HasLocalPoint<decltype(feature)>) feature.s_local = S * feature.s_local;
        if constexpr (HasDirection<decltype(feature)>) feature.u_local = S * feature.u_local;
        if constexpr (requires { feature.A_local; }) feature.A_local = rotation(feature.A_local);
    });
    Vector6 axial;
    axial << 1, -1, 1, -1, 1, -1;
    for (auto& elastic : scene.elastics)
        if (auto* bushing = std::get_if<Bushing>(&elastic.kind)) {
            auto& law = std::get<LinearStiffness>(bushing->law);
            law.K = axial.asDiagonal() * law.K * axial.asDiagonal();
            bushing->preload = axial.asDiagonal() * bushing->preload;
        }
    for_each_load(scene, [&](LoadKind& load) {
        if (auto* force = std::get_if<DeadForce>(&load)) {
            force->f = S * force->f;
            force->at.s_local = S * force->at.s_local;
        } else {
            auto& moment = std::get<DeadMoment>(load);
            moment.m = -(S * moment.m);
        }
    });
    for (auto& branch : scene.branches)
        for (auto& driver : branch.drivers)
            if (auto* preload = std::get_if<Preload>(&driver.what))
                preload->direction = axial.asDiagonal() * preload->direction;
    for (auto& wheel : scene.wheels) {
        for (auto* v : {&wheel.centre_local, &wheel.contact_local, &wheel.spin_axis_local}) *v = S * *v;
        wheel.side = -wheel.side;
    }
    return scene;
}

Scene reversed(const Scene& original) {
    Scene scene = original;
    const BodyId last = static_cast<BodyId>(scene.bodies.size()) - 1;
    const auto renumber = [&](BodyId& body) {
        if (body != ground) body = last - body;
    };
    for_each_feature(scene, [&](auto& feature) { renumber(feature.body); });
    for_each_load(scene, [&](LoadKind& load) {
        if (auto* force = std::get_if<DeadForce>(&load))
            renumber(force->at.body);
        else
            renumber(std::get<DeadMoment>(load).body);
    });
    for (auto& wheel : scene.wheels) renumber(wheel.body);
    const auto other_end = [](int& k, std::size_t count) { k = static_cast<int>(count) - 1 - k; };
    for (auto& branch : scene.branches)
        for (auto& driver : branch.drivers) {
            if (auto* motion = std::get_if<Motion>(&driver.what))
                other_end(motion->joint, scene.joints.size());
            if (auto* length = std::get_if<FreeLength>(&driver.what))
                other_end(length->elastic, scene.elastics.size());
            if (auto* preload = std::get_if<Preload>(&driver.what))
                other_end(preload->elastic, scene.elastics.size());
        }
    std::ranges::reverse(scene.bodies);
    std::ranges::reverse(scene.joints);
    std::ranges::reverse(scene.elastics);
    return scene;
}

}  // namespace elastocheck::support
