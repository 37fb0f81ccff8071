#include "compare/stress/transforms.hpp"

#include "models/kinds.hpp"
#include "models/laws.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Matrix3d;
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
        for (auto& damper : scene.dampers)
            for (auto* end : {&damper.i, &damper.j}) visit(*end);
        for (auto& wheel : scene.wheels) {
            visit(wheel.contact);
            if (auto& axis = wheel.steering_axis)
                for (auto* point : {&axis->lower, &axis->upper}) visit(*point);
        }
    }
}

// Of a law of e = (d, θ): d times length, θ unchanged, its stress (F, M) times (force, moment).
SpatialLaw scaled(const SpatialLaw& law, double length, double force, double moment) {
    Vector6 stretch, stress;
    stretch << length, length, length, 1, 1, 1;
    stress << force, force, force, moment, moment, moment;
    return elastocheck::scaled(law, stretch, stress);
}

}  // namespace

// The axes A of a body become M A S with S = diag(1, ±1, 1) of the determinant of M, so that they
// stay a rotation. In body axes positions and forces are reflected by S; rotation vectors and
// moments, being axial, by ± S; hence a stiffness in local axes becomes diag(S, ± S) K diag(S, ± S).
Scene transformed(const Scene& original, const Transform& how) {
    const Matrix3d& M = how.M;
    const double length = how.length, force = how.force, moment = force * length,
                 sign = M.determinant() < 0 ? -1 : 1;
    const Matrix3d S = Vector3d(1, sign, 1).asDiagonal();
    Vector6 axial;
    axial << 1, sign, 1, sign, 1, sign;
    const auto turned = [&](BodyId body, const Vector3d& v) -> Vector3d {
        return (body == ground ? M : S) * v;
    };
    const auto rotated = [&](BodyId body, const Quaterniond& p) {
        return Quaterniond(Matrix3d((body == ground ? M : S) * p.toRotationMatrix() * S));
    };
    const auto place = [&](BodyId body, Vector3d& s) {
        s = length * turned(body, s);
        if (body == ground) s += how.t;
    };
    const auto point = [&](Point& p) { place(p.body, p.s_local); };
    const auto along = [&](Direction& u) { u.u_local = turned(u.body, u.u_local); };
    const auto frame = [&](Marker& m) {
        place(m.body, m.s_local);
        m.A_local = rotated(m.body, m.A_local);
    };
    Scene scene = original;
    for (auto& hardpoint : scene.hardpoints) place(ground, hardpoint.position);
    for (auto& body : scene.bodies) {
        place(ground, body.design.r);
        body.design.p = rotated(ground, body.design.p);
    }
    each_part(scene,
              overloaded{point, along, frame, [&](Length<double> l) { l.value *= length; },
                         [&](ScalarLaw& law) { law = elastocheck::scaled(law, length, force); },
                         [&](SpatialLaw& law) {
                             law = scaled(with_signs(law, axial), length, force, moment);
                         },
                         [&](ForceAndMoment<Vector6> w) {
                             w.value = axial.asDiagonal() * w.value;
                             w.value.head<3>() *= force;
                             w.value.tail<3>() *= moment;
                         },
                         [&](Deformation<Vector6> e) {
                             e.value = axial.asDiagonal() * e.value;
                             e.value.head<3>() *= length;
                         }});
    each_load(scene, [&](LoadKind& load) {
        each_member(load, overloaded{point, along, frame, [&](LoadVector<Vector3d> v) {
                                         v.value =
                                             (v.is_moment ? sign : 1) * turned(v.axes, v.value);
                                     }});
    });
    for (auto& load : scene.static_loads)
        each_member(load.kind,
                    [&](LoadVector<Vector3d> v) { v.value *= v.is_moment ? moment : force; });
    // (start + rate a) times the driven quantity: start and rate take its change, and the rate also
    // that of a's unit.
    for (auto& branch : scene.branches) {
        const double parameter = branch.unit == ParameterUnit::newton         ? force
                                 : branch.unit == ParameterUnit::newton_metre ? moment
                                 : branch.unit == ParameterUnit::metre        ? length
                                                                              : 1;
        branch.from *= parameter;
        branch.to *= parameter;
        for (auto& driver : branch.drivers) {
            double factor = length;  // of a free length
            each_member(driver.what,
                        overloaded{[&](Load& load) {
                                       each_member(load.kind, [&](LoadVector<Vector3d> v) {
                                           factor = v.is_moment ? moment : force;
                                       });
                                   },
                                   [&](JointIndex<int> k) {
                                       const auto& joint =
                                           scene.joints[static_cast<std::size_t>(k.value)];
                                       factor = is_angle(joint.kind) ? 1 : length;
                                   },
                                   [&](ForceAndMoment<Vector6> preload) {
                                       preload.value = axial.asDiagonal() * preload.value;
                                       preload.value.tail<3>() *= length;
                                       factor = force;
                                   }});
            driver.start *= factor;
            driver.rate *= factor / parameter;
        }
    }
    for (auto& wheel : scene.wheels) {
        place(wheel.body, wheel.centre_local);
        wheel.spin_axis_local = turned(wheel.body, wheel.spin_axis_local);
        wheel.side *= static_cast<int>(sign);
        wheel.tyre_rate *= force / length;
    }
    if (scene.vehicle) {
        scene.vehicle->wheelbase *= length;
        scene.vehicle->cg_height *= length;
    }
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
