#include "tests/support/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "models/curve.hpp"
#include "models/overloaded.hpp"
#include "models/reader/scene_file.hpp"
#include "tests/support/folder.hpp"

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
    for (auto& damper : scene.dampers) f(damper.i), f(damper.j);
    for (auto& wheel : scene.wheels)
        if (auto& axis = wheel.steering_axis) f(axis->lower), f(axis->upper);
}

template <class F>
void for_each_load(Scene& scene, F&& f) {
    for (auto& load : scene.static_loads) f(load.kind);
    for (auto& branch : scene.branches)
        for (auto& driver : branch.drivers)
            if (auto* load = std::get_if<Load>(&driver.what)) f(load->kind);
}

// What is written in metres and newtons, in millimetres and kilonewtons: "N·m/deg" is a thousand times a thousandth.
double in_mm_and_kN(const std::string& unit) {
    if (unit == "m/s²") return 1;  // gravity is, whatever the units
    const auto power = [&](std::string_view part) {
        double factor = 1;
        while (!part.empty()) {
            const auto dot = part.find("·");
            std::string_view one = part.substr(0, dot);
            part = dot == part.npos ? "" : part.substr(dot + std::string_view("·").size());
            const double base = one.starts_with('m') ? 1e3 : one.starts_with('N') ? 1e-3 : 1;
            const int n = one.ends_with("²") ? 2 : one.ends_with("³") ? 3 : one.ends_with("⁴") ? 4 : 1;
            factor *= std::pow(base, n);
        }
        return factor;
    };
    const auto slash = unit.find('/');
    const std::string_view whole = unit;
    return power(whole.substr(0, slash)) / (slash == unit.npos ? 1 : power(whole.substr(slash + 1)));
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

std::vector<std::string> small_scene_names() {
    std::vector<std::string> names = scene_names();
    std::erase_if(names, [](const std::string& name) { return scene(name).trim.has_value(); });
    return names;
}

std::vector<std::string> family_names() {
    std::vector<std::string> names = scene_names();
    std::erase_if(names, [](const std::string& name) { return !scene(name).trim.has_value(); });
    return names;
}

bool has_potential(const Scene& original) {
    Scene scene = original;
    bool has = true;
    for_each_load(scene, [&](LoadKind& load) {
        has &= std::holds_alternative<DeadForce>(load) || std::holds_alternative<DeadMoment>(load);
    });
    for (const auto& elastic : scene.elastics)
        if (const auto* bushing = std::get_if<Bushing>(&elastic.kind))
            has &= has_energy(bushing->formulation);
    return has;
}

Scene in_millimetres_and_kilonewtons(const std::string& name) {
    const std::filesystem::path file = std::string(ELASTOCHECK_SCENES) + "/" + name + ".yaml";
    const std::string units = "units: {length: m, angle: deg, force: N}";
    std::string text = text_of(file);
    const auto at = text.find(units);
    if (at == text.npos) throw std::logic_error(name + " is not in m, deg and N");
    text.replace(at, units.size(), "units: {length: mm, angle: deg, force: kN}");
    std::vector<Setting> settings;
    for (const auto& number : read_scene(file).numbers) {
        const bool is_ratio = number.path.find(".drive.") != std::string::npos;  // of one length to another
        const double factor = is_ratio ? 1 : in_mm_and_kN(number.unit);
        if (factor != 1) settings.push_back(setting(number.path, factor * number.value));
    }
    return parse_scene(text, file, settings);
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
        if (auto* force = std::get_if<DeadForce>(&load)) force->f = R * force->f;
        if (auto* moment = std::get_if<DeadMoment>(&load)) moment->m = R * moment->m;
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
        std::visit(overloaded{[&](DeadForce& l) { l.at.s_local = turn(l.at.body) * l.at.s_local; },
                              [](DeadMoment&) {},
                              [&](FollowerForce& l) {
                                  l.at.s_local = turn(l.at.body) * l.at.s_local;
                                  l.f_local = turn(l.at.body) * l.f_local;
                              },
                              [&](FollowerMoment& l) { l.m_local = turn(l.body) * l.m_local; }},
                   load);
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
            std::visit(overloaded{[&](LinearStiffness& law) {
                                      law.K = axial.asDiagonal() * law.K * axial.asDiagonal();
                                  },
                                  [&](PerAxis& law) {
                                      for (int k = 0; k < 6; ++k) {
                                          auto& u = law.axis[static_cast<std::size_t>(k)];
                                          if (axial[k] < 0) u = elastocheck::reversed(u);
                                      }
                                  }},
                       bushing->law);
            bushing->preload = axial.asDiagonal() * bushing->preload;
            bushing->undeformed = axial.asDiagonal() * bushing->undeformed;
        }
    for_each_load(scene, [&](LoadKind& load) {
        std::visit(
            overloaded{[&](DeadForce& l) { l.f = S * l.f, l.at.s_local = S * l.at.s_local; },
                       [&](DeadMoment& l) { l.m = -(S * l.m); },
                       [&](FollowerForce& l) { l.f_local = S * l.f_local, l.at.s_local = S * l.at.s_local; },
                       [&](FollowerMoment& l) { l.m_local = -(S * l.m_local); }},
            load);
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
        std::visit(
            [&](auto& l) {
                if constexpr (requires { l.at; })
                    renumber(l.at.body);
                else
                    renumber(l.body);
            },
            load);
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
