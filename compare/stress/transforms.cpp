#include "compare/stress/transforms.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "models/kinds.hpp"
#include "models/laws.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Calls visit for the members of the joints, elements, probes, dampers and steering axes that it
// takes (models/kinds.hpp).
template <class F>
void each_part(Scene& scene, const F& visit) {
    for (auto& joint : scene.joints) each_member(joint.kind, visit);
    for (auto& elastic : scene.elastics) each_member(elastic.kind, visit);
    if constexpr (std::is_invocable_v<const F&, Point&>) {
        for (auto& probe : scene.probes) visit(probe.at);
        for (auto& damper : scene.dampers) visit(damper.i), visit(damper.j);
        for (auto& wheel : scene.wheels) {
            visit(wheel.contact);
            if (auto& axis = wheel.steering_axis) visit(axis->lower), visit(axis->upper);
        }
    }
}
// The same, and the members of the loads.
template <class F>
void each_part_and_load(Scene& scene, const F& visit) {
    each_part(scene, visit);
    each_load(scene, [&](LoadKind& load) { each_member(load, visit); });
}

// Of a law of e = (d, θ): d times length, θ unchanged, its stress (F, M) times (force, moment).
SpatialLaw scaled(const SpatialLaw& law, double length, double force, double moment) {
    Vector6 stretch, stress;
    stretch << length, length, length, 1, 1, 1;
    stress << force, force, force, moment, moment, moment;
    return elastocheck::scaled(law, stretch, stress);
}

double factor_of(ParameterUnit unit, double length, double force) {
    switch (unit) {
        case ParameterUnit::newton: return force;
        case ParameterUnit::newton_metre: return force * length;
        case ParameterUnit::metre: return length;
        case ParameterUnit::radian:
        case ParameterUnit::none: return 1;
    }
    return 1;
}

}  // namespace

Scene moved(const Scene& original, const Quaterniond& R, const Vector3d& t) {
    Scene scene = original;
    for (auto& point : scene.hardpoints) point.position = R * point.position + t;
    for (auto& body : scene.bodies) body.design = {R * body.design.r + t, R * body.design.p};
    each_part_and_load(scene, overloaded{[&](Point& p) {
                                             if (p.body == ground) p.s_local = R * p.s_local + t;
                                         },
                                         [&](Direction& u) {
                                             if (u.body == ground) u.u_local = R * u.u_local;
                                         },
                                         [&](Marker& m) {
                                             if (m.body == ground)
                                                 m.s_local = R * m.s_local + t,
                                                 m.A_local = R * m.A_local;
                                         },
                                         [&](LoadVector<Vector3d> v) {
                                             if (v.axes == ground) v.value = R * v.value;
                                         }});
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
    each_part_and_load(scene,
                       overloaded{[&](Point& p) { p.s_local = turn(p.body) * p.s_local; },
                                  [&](Direction& u) { u.u_local = turn(u.body) * u.u_local; },
                                  [&](Marker& m) {
                                      m.s_local = turn(m.body) * m.s_local;
                                      m.A_local = turn(m.body) * m.A_local;
                                  },
                                  [&](LoadVector<Vector3d> v) {
                                      if (v.axes != ground) v.value = turn(v.axes) * v.value;
                                  }});
    for (auto& wheel : scene.wheels)
        for (auto* v : {&wheel.centre_local, &wheel.spin_axis_local}) *v = turn(wheel.body) * *v;
    return scene;
}

Scene mirrored(const Scene& original) {
    // Positions and forces are reflected by S; rotation vectors and moments, being axial, by -S.
    // Axes A become S A S, so that a stiffness in local axes becomes diag(S, -S) K diag(S, -S).
    const Eigen::DiagonalMatrix<double, 3> S(1, -1, 1);
    const auto rotation = [&](const Quaterniond& p) {
        return Quaterniond(Eigen::Matrix3d(S * p.toRotationMatrix() * S));
    };
    Scene scene = original;
    for (auto& point : scene.hardpoints) point.position = S * point.position;
    for (auto& body : scene.bodies) body.design = {S * body.design.r, rotation(body.design.p)};
    Vector6 axial;
    axial << 1, -1, 1, -1, 1, -1;
    const auto mirror_wrench = [&](ForceAndMoment<Vector6> w) {
        w.value = axial.asDiagonal() * w.value;
    };
    each_part_and_load(
        scene,
        overloaded{[&](Point& p) { p.s_local = S * p.s_local; },
                   [&](Direction& u) { u.u_local = S * u.u_local; },
                   [&](Marker& m) { m.s_local = S * m.s_local, m.A_local = rotation(m.A_local); },
                   [&](SpatialLaw& law) { law = with_signs(law, axial); }, mirror_wrench,
                   [&](Deformation<Vector6> e) { e.value = axial.asDiagonal() * e.value; },
                   [&](LoadVector<Vector3d> v) {
                       v.value = S * v.value;
                       if (v.is_moment) v.value = -v.value;
                   }});
    for (auto& branch : scene.branches)
        for (auto& driver : branch.drivers) each_member(driver.what, mirror_wrench);
    for (auto& wheel : scene.wheels) {
        for (auto* v : {&wheel.centre_local, &wheel.spin_axis_local}) *v = S * *v;
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

Scene scaled(const Scene& original, double length, double force) {
    Scene scene = original;
    const double moment = force * length;
    for (auto& point : scene.hardpoints) point.position *= length;
    for (auto& body : scene.bodies) body.design.r *= length;
    const auto scale_point = [&](Point& p) { p.s_local *= length; };
    const auto scale_load = [&](LoadVector<Vector3d> v) {
        v.value *= v.is_moment ? moment : force;
    };
    each_part(scene,
              overloaded{scale_point, [&](Marker& m) { m.s_local *= length; },
                         [&](Length<double> l) { l.value *= length; },
                         [&](ScalarLaw& law) { law = elastocheck::scaled(law, length, force); },
                         [&](SpatialLaw& law) { law = scaled(law, length, force, moment); },
                         [&](ForceAndMoment<Vector6> w) {
                             w.value.head<3>() *= force;
                             w.value.tail<3>() *= moment;
                         },
                         [&](Deformation<Vector6> e) { e.value.head<3>() *= length; }});
    for (auto& load : scene.static_loads)
        each_member(load.kind, overloaded{scale_point, scale_load});
    // (start + rate a) times the driven quantity: start and rate take its change, and the rate also
    // that of a's unit.
    for (auto& branch : scene.branches) {
        const double parameter = factor_of(branch.unit, length, force);
        branch.from *= parameter, branch.to *= parameter;
        for (auto& driver : branch.drivers) {
            double by = length;  // of a free length
            each_member(
                driver.what,
                overloaded{
                    [&](Load& load) {
                        each_member(load.kind, overloaded{scale_point, [&](LoadVector<Vector3d> v) {
                                                              by = v.is_moment ? moment : force;
                                                          }});
                    },
                    [&](JointIndex<int> k) {
                        const auto& kind = scene.joints[static_cast<std::size_t>(k.value)].kind;
                        by = is_angle(kind) ? 1 : length;
                    },
                    [&](ForceAndMoment<Vector6> preload) {
                        preload.value.tail<3>() *= length;
                        by = force;
                    }});
            driver.start *= by;
            driver.rate *= by / parameter;
        }
    }
    for (auto& wheel : scene.wheels) {
        wheel.centre_local *= length;
        wheel.tyre_rate *= force / length;
    }
    if (scene.vehicle) scene.vehicle->wheelbase *= length, scene.vehicle->cg_height *= length;
    return scene;
}

namespace {

// The numbers of the members of kinds.
struct Numbers {
    const std::function<void(double&)>& visit;

    void all(std::span<double> numbers) const {
        for (double& x : numbers) visit(x);
    }
    void operator()(Vector3d& v) const { all({v.data(), 3}); }
    void operator()(Point& p) const { (*this)(p.s_local); }
    void operator()(Direction& u) const { (*this)(u.u_local); }
    void operator()(Quaterniond& q) const { all({q.coeffs().data(), 4}); }
    void operator()(Marker& m) const { (*this)(m.s_local), (*this)(m.A_local); }
    void operator()(Length<double> x) const { visit(x.value); }
    void operator()(PlaneAngle<double> x) const { visit(x.value); }
    void operator()(ForceAndMoment<Vector6> x) const { all({x.value.data(), 6}); }
    void operator()(Deformation<Vector6> x) const { all({x.value.data(), 6}); }
    void operator()(LoadVector<Vector3d> x) const { (*this)(x.value); }
    void operator()(ScalarLaw& law) const {
        std::visit(overloaded{[&](LinearRate& u) { visit(u.k); },
                              [&](elastocheck::Curve& u) {
                                  all(u.knots);
                                  for (auto& piece : u.pieces) all(piece);
                              }},
                   law);
    }
    void operator()(SpatialLaw& law) const {
        std::visit(overloaded{[&](LinearStiffness& u) {
                                  all({u.K.data(), 36});
                              },
                              [&](PerAxis& u) {
                                  for (ScalarLaw& axis : u.axis) (*this)(axis);
                              }},
                   law);
    }
    void driven(Driven& what) const {
        each_member(what, overloaded{[&](Load& load) { each_member(load.kind, *this); },
                                     [&](ForceAndMoment<Vector6> x) { (*this)(x); }});
    }
};

}  // namespace

void for_each_number(Scene& scene, const std::function<void(double&)>& visit) {
    const Numbers numbers{visit};
    for (auto& point : scene.hardpoints) numbers(point.position);
    for (auto& body : scene.bodies) numbers(body.design.r), numbers(body.design.p);
    for (auto& joint : scene.joints) each_member(joint.kind, numbers);
    for (auto& elastic : scene.elastics) each_member(elastic.kind, numbers);
    for (auto& load : scene.static_loads) each_member(load.kind, numbers);
    for (auto& branch : scene.branches) {
        visit(branch.from), visit(branch.to);
        for (auto& driver : branch.drivers)
            numbers.driven(driver.what), visit(driver.start), visit(driver.rate);
    }
    for (auto& wheel : scene.wheels) {
        numbers(wheel.centre_local), numbers(wheel.contact);
        numbers(wheel.spin_axis_local), visit(wheel.tyre_rate);
        if (auto& axis = wheel.steering_axis) numbers(axis->lower), numbers(axis->upper);
    }
    for (auto& probe : scene.probes) numbers(probe.at);
    for (auto& damper : scene.dampers) numbers(damper.i), numbers(damper.j);
    if (auto& car = scene.vehicle)
        for (double* x : {&car->wheelbase, &car->cg_height, &car->brake_share, &car->drive_share})
            visit(*x);
    if (scene.trim) {
        for (auto& adjustment : scene.trim->adjust)
            numbers.driven(adjustment.what), visit(adjustment.per_unit);
        for (auto& condition : scene.trim->until)
            if (condition.value) visit(*condition.value);
    }
    each_part(scene, [](SpatialLaw& law) {  // one number for both entries of a symmetric matrix
        std::visit(overloaded{[](LinearStiffness& u) {
                                  u.K = Matrix6(u.K.selfadjointView<Eigen::Lower>());
                              },
                              [](PerAxis&) {}},
                   law);
    });
}

Scene an_ulp_off(const Scene& original) {
    constexpr double end = std::numeric_limits<double>::infinity();
    Scene scene = original;
    for_each_number(scene, [bits = std::uint32_t{12345}](double& x) mutable {
        bits = 1664525 * bits + 1013904223;
        if (x != 0) x = std::nextafter(x, (bits >> 16) % 2 == 0 ? end : -end);
    });
    return scene;
}

Elastic stiffened(Elastic element, double factor) {
    each_member(element.kind,
                overloaded{[&](ScalarLaw& law) { law = elastocheck::scaled(law, 1, factor); },
                           [&](SpatialLaw& law) { law = scaled(law, 1, factor, factor); }});
    return element;
}

Scene with_rotational_rates(const Scene& original, double factor) {
    Scene scene = original;
    for (auto& elastic : scene.elastics)
        each_member(elastic.kind, [&](SpatialLaw& law) { law = scaled(law, 1, 1, factor); });
    return scene;
}

}  // namespace elastocheck::compare
