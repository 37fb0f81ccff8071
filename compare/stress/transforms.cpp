#include "compare/stress/transforms.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "models/curve.hpp"
#include "models/overloaded.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// All points, directions and markers of bodies or ground.
struct Features {
    std::vector<Point*> points;
    std::vector<Direction*> directions;
    std::vector<Marker*> markers;
};

void take(Features& features, JointKind& kind) {
    auto& points = features.points;
    auto& directions = features.directions;
    const auto take_points = [&](auto& joint) {
        points.insert(points.end(), {&joint.i, &joint.j});
    };
    const auto along_an_axis = [&](auto& joint) {
        take_points(joint);
        directions.insert(directions.end(), {&joint.axis_i, &joint.axis_j});
    };
    std::visit(
        overloaded{[&](Spherical& s) { take_points(s); }, [&](Revolute& s) { along_an_axis(s); },
                   [&](Universal& s) { along_an_axis(s); },
                   [&](Cylindrical& s) { along_an_axis(s); },
                   [&](Translational& s) { along_an_axis(s); },
                   [&](Planar& s) {
                       take_points(s);
                       directions.insert(directions.end(), {&s.normal_i, &s.normal_j});
                   },
                   [&](Fixed& s) {
                       take_points(s);
                       directions.insert(directions.end(), {&s.x_i, &s.y_i, &s.x_j, &s.y_j});
                   },
                   [&](Distance& s) { take_points(s); },
                   [&](InPlane& s) { take_points(s), directions.push_back(&s.normal_j); },
                   [&](InLine& s) { take_points(s), directions.push_back(&s.axis_j); },
                   [&](Perpendicular& s) {
                       directions.insert(directions.end(), {&s.i, &s.j});
                   },
                   [&](Parallel& s) {
                       directions.insert(directions.end(), {&s.i, &s.j});
                   },
                   [&](Angle& s) {
                       directions.insert(directions.end(), {&s.i, &s.j, &s.y_j});
                   }},
        kind);
}

Features features_of(Scene& scene) {
    Features features;
    auto& points = features.points;
    auto& markers = features.markers;
    for (auto& joint : scene.joints) take(features, joint.kind);
    for (auto& elastic : scene.elastics)
        std::visit(overloaded{[&](AxialSpring& e) {
                                  points.insert(points.end(), {&e.i, &e.j});
                              },
                              [&](Bushing& e) {
                                  markers.insert(markers.end(), {&e.i, &e.j});
                              }},
                   elastic.kind);
    for (auto& probe : scene.probes) points.push_back(&probe.at);
    for (auto& damper : scene.dampers) points.insert(points.end(), {&damper.i, &damper.j});
    for (auto& wheel : scene.wheels)
        if (auto& axis = wheel.steering_axis)
            points.insert(points.end(), {&axis->lower, &axis->upper});
    return features;
}

template <class F>
void for_each_load(Scene& scene, F&& f) {
    for (auto& load : scene.static_loads) f(load.kind);
    for (auto& branch : scene.branches)
        for (auto& driver : branch.drivers)
            if (auto* load = std::get_if<Load>(&driver.what)) f(load->kind);
}

// Law of a deformation `stretch` times as large and a force `force` times as large:
// f'(x) = force · f(x / stretch).
ScalarLaw scaled(const ScalarLaw& law, double stretch, double force) {
    return std::visit(overloaded{[&](LinearRate rate) -> ScalarLaw {
                                     rate.k *= force / stretch;
                                     return rate;
                                 },
                                 [&](Curve curve) -> ScalarLaw {
                                     for (double& knot : curve.knots) knot *= stretch;
                                     for (auto& piece : curve.pieces)
                                         for (int n = 0; n < 4; ++n)
                                             piece[static_cast<std::size_t>(n)] *=
                                                 force / std::pow(stretch, n);
                                     return curve;
                                 }},
                      law);
}

// For e = (d, θ): d times length, θ unchanged; its stress (F, M) becomes (F · force, M · moment).
SpatialLaw scaled(const SpatialLaw& law, double length, double force, double moment) {
    Vector6 stretch, stress;
    stretch << length, length, length, 1, 1, 1;
    stress << force, force, force, moment, moment, moment;
    return std::visit(overloaded{[&](LinearStiffness linear) -> SpatialLaw {
                                     // remains symmetric, also where only moments are scaled
                                     const Vector6 root = stress.cwiseQuotient(stretch).cwiseSqrt();
                                     linear.K = root.asDiagonal() * linear.K * root.asDiagonal();
                                     return linear;
                                 },
                                 [&](PerAxis axes) -> SpatialLaw {
                                     for (int k = 0; k < 6; ++k) {
                                         auto& u = axes.axis[static_cast<std::size_t>(k)];
                                         u = scaled(u, stretch[k], stress[k]);
                                     }
                                     return axes;
                                 }},
                      law);
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
    const Features features = features_of(scene);
    for (Point* point : features.points)
        if (point->body == ground) point->s_local = R * point->s_local + t;
    for (Direction* direction : features.directions)
        if (direction->body == ground) direction->u_local = R * direction->u_local;
    for (Marker* marker : features.markers)
        if (marker->body == ground)
            marker->s_local = R * marker->s_local + t, marker->A_local = R * marker->A_local;
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
    const Features features = features_of(scene);
    for (Point* point : features.points) point->s_local = turn(point->body) * point->s_local;
    for (Direction* direction : features.directions)
        direction->u_local = turn(direction->body) * direction->u_local;
    for (Marker* marker : features.markers) {
        marker->s_local = turn(marker->body) * marker->s_local;
        marker->A_local = turn(marker->body) * marker->A_local;
    }
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
    // Positions and forces are reflected by S; rotation vectors and moments, being axial, by -S.
    // Axes A become S A S, so that a stiffness in local axes becomes diag(S, -S) K diag(S, -S).
    const Eigen::DiagonalMatrix<double, 3> S(1, -1, 1);
    const auto rotation = [&](const Quaterniond& p) {
        return Quaterniond(Eigen::Matrix3d(S * p.toRotationMatrix() * S));
    };
    Scene scene = original;
    for (auto& point : scene.hardpoints) point.position = S * point.position;
    for (auto& body : scene.bodies) body.design = {S * body.design.r, rotation(body.design.p)};
    const Features features = features_of(scene);
    for (Point* point : features.points) point->s_local = S * point->s_local;
    for (Direction* direction : features.directions) direction->u_local = S * direction->u_local;
    for (Marker* marker : features.markers)
        marker->s_local = S * marker->s_local, marker->A_local = rotation(marker->A_local);
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
        std::visit(overloaded{[&](DeadForce& l) { l.f = S * l.f, l.at.s_local = S * l.at.s_local; },
                              [&](DeadMoment& l) { l.m = -(S * l.m); },
                              [&](FollowerForce& l) {
                                  l.f_local = S * l.f_local, l.at.s_local = S * l.at.s_local;
                              },
                              [&](FollowerMoment& l) { l.m_local = -(S * l.m_local); }},
                   load);
    });
    for (auto& branch : scene.branches)
        for (auto& driver : branch.drivers)
            if (auto* preload = std::get_if<Preload>(&driver.what))
                preload->direction = axial.asDiagonal() * preload->direction;
    for (auto& wheel : scene.wheels) {
        for (auto* v : {&wheel.centre_local, &wheel.contact_local, &wheel.spin_axis_local})
            *v = S * *v;
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
    const Features features = features_of(scene);
    for (Point* point : features.points) renumber(point->body);
    for (Direction* direction : features.directions) renumber(direction->body);
    for (Marker* marker : features.markers) renumber(marker->body);
    for_each_load(scene, [&](LoadKind& load) {
        std::visit(overloaded{[&](DeadForce& l) { renumber(l.at.body); },
                              [&](DeadMoment& l) { renumber(l.body); },
                              [&](FollowerForce& l) { renumber(l.at.body); },
                              [&](FollowerMoment& l) { renumber(l.body); }},
                   load);
    });
    for (auto& wheel : scene.wheels) renumber(wheel.body);
    const auto other_end = [](int& k, std::size_t count) { k = static_cast<int>(count) - 1 - k; };
    for (auto& branch : scene.branches)
        for (auto& driver : branch.drivers)
            std::visit(
                overloaded{
                    [](Load&) {},
                    [&](Motion& motion) { other_end(motion.joint, scene.joints.size()); },
                    [&](FreeLength& length) { other_end(length.elastic, scene.elastics.size()); },
                    [&](Preload& preload) { other_end(preload.elastic, scene.elastics.size()); }},
                driver.what);
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
    const Features features = features_of(scene);
    for (Point* point : features.points) point->s_local *= length;
    for (Marker* marker : features.markers) marker->s_local *= length;
    for (auto& joint : scene.joints) {
        if (auto* distance = std::get_if<Distance>(&joint.kind)) distance->length *= length;
        if (auto* plane = std::get_if<InPlane>(&joint.kind)) plane->offset *= length;
    }
    for (auto& elastic : scene.elastics)
        std::visit(overloaded{[&](AxialSpring& e) {
                                  e.law = scaled(e.law, length, force);
                                  e.free_length *= length;
                              },
                              [&](Bushing& e) {
                                  e.law = scaled(e.law, length, force, moment);
                                  e.preload.head<3>() *= force;
                                  e.preload.tail<3>() *= moment;
                                  e.undeformed.head<3>() *= length;
                              }},
                   elastic.kind);
    const auto scale_place = [&](LoadKind& load) {
        if (auto* l = std::get_if<DeadForce>(&load)) l->at.s_local *= length;
        if (auto* l = std::get_if<FollowerForce>(&load)) l->at.s_local *= length;
    };
    for (auto& load : scene.static_loads) {
        scale_place(load.kind);
        std::visit(
            overloaded{[&](DeadForce& l) { l.f *= force; }, [&](DeadMoment& l) { l.m *= moment; },
                       [&](FollowerForce& l) { l.f_local *= force; },
                       [&](FollowerMoment& l) { l.m_local *= moment; }},
            load.kind);
    }
    // (start + rate a) times the driven quantity: start and rate take its change, and the rate also
    // that of a's unit.
    for (auto& branch : scene.branches) {
        const double parameter = factor_of(branch.unit, length, force);
        branch.from *= parameter, branch.to *= parameter;
        for (auto& driver : branch.drivers) {
            const double by = std::visit(
                overloaded{[&](Load& load) {
                               scale_place(load.kind);
                               return std::holds_alternative<DeadForce>(load.kind) ||
                                              std::holds_alternative<FollowerForce>(load.kind)
                                          ? force
                                          : moment;
                           },
                           [&](Motion& motion) {
                               const auto& kind =
                                   scene.joints[static_cast<std::size_t>(motion.joint)].kind;
                               return std::holds_alternative<Angle>(kind) ? 1.0 : length;
                           },
                           [&](FreeLength&) { return length; },
                           [&](Preload& preload) {
                               preload.direction.tail<3>() *= length;
                               return force;
                           }},
                driver.what);
            driver.start *= by;
            driver.rate *= by / parameter;
        }
    }
    for (auto& wheel : scene.wheels) {
        wheel.centre_local *= length, wheel.contact_local *= length;
        wheel.tyre_rate *= force / length;
    }
    if (scene.vehicle) scene.vehicle->wheelbase *= length, scene.vehicle->cg_height *= length;
    return scene;
}

namespace {

using Number = std::function<void(double&)>;

template <class Dense>
void visit_all(Dense&& numbers, const Number& visit) {
    for (auto& x : numbers.reshaped()) visit(x);
}
void visit_law(ScalarLaw& law, const Number& visit) {
    std::visit(overloaded{[&](LinearRate& rate) { visit(rate.k); },
                          [&](Curve& curve) {
                              for (double& knot : curve.knots) visit(knot);
                              for (auto& piece : curve.pieces)
                                  for (double& c : piece) visit(c);
                          }},
               law);
}
void visit_law(SpatialLaw& law, const Number& visit) {
    std::visit(overloaded{[&](LinearStiffness& linear) {
                              for (int i = 0; i < 6; ++i)
                                  for (int j = 0; j <= i; ++j) {
                                      visit(linear.K(i, j));
                                      linear.K(j, i) = linear.K(i, j);
                                  }
                          },
                          [&](PerAxis& axes) {
                              for (auto& u : axes.axis) visit_law(u, visit);
                          }},
               law);
}

}  // namespace

void for_each_number(Scene& scene, const Number& visit) {
    const auto all = [&](auto&& numbers) { visit_all(numbers, visit); };
    for (auto& point : scene.hardpoints) all(point.position);
    for (auto& body : scene.bodies) all(body.design.r), all(body.design.p.coeffs());
    const Features features = features_of(scene);
    for (Point* point : features.points) all(point->s_local);
    for (Direction* direction : features.directions) all(direction->u_local);
    for (Marker* marker : features.markers) all(marker->s_local), all(marker->A_local.coeffs());
    for (auto& joint : scene.joints) {
        if (auto* distance = std::get_if<Distance>(&joint.kind)) visit(distance->length);
        if (auto* plane = std::get_if<InPlane>(&joint.kind)) visit(plane->offset);
        if (auto* angle = std::get_if<Angle>(&joint.kind)) visit(angle->angle);
    }
    for (auto& elastic : scene.elastics)
        std::visit(
            overloaded{[&](AxialSpring& e) { visit_law(e.law, visit), visit(e.free_length); },
                       [&](Bushing& e) {
                           visit_law(e.law, visit);
                           all(e.preload), all(e.undeformed);
                       }},
            elastic.kind);
    for_each_load(scene, [&](LoadKind& load) {
        std::visit(overloaded{[&](DeadForce& l) { all(l.at.s_local), all(l.f); },
                              [&](DeadMoment& l) { all(l.m); },
                              [&](FollowerForce& l) { all(l.at.s_local), all(l.f_local); },
                              [&](FollowerMoment& l) { all(l.m_local); }},
                   load);
    });
    for (auto& branch : scene.branches) {
        visit(branch.from), visit(branch.to);
        for (auto& driver : branch.drivers) {
            visit(driver.start), visit(driver.rate);
            if (auto* preload = std::get_if<Preload>(&driver.what)) all(preload->direction);
        }
    }
    for (auto& wheel : scene.wheels) {
        for (auto* v : {&wheel.centre_local, &wheel.contact_local, &wheel.spin_axis_local}) all(*v);
        visit(wheel.tyre_rate);
    }
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
    std::visit(overloaded{[&](AxialSpring& e) { e.law = scaled(e.law, 1, factor); },
                          [&](Bushing& e) { e.law = scaled(e.law, 1, factor, factor); }},
               element.kind);
    return element;
}

Scene with_rotational_rates(const Scene& original, double factor) {
    Scene scene = original;
    for (auto& elastic : scene.elastics)
        if (auto* bushing = std::get_if<Bushing>(&elastic.kind))
            bushing->law = scaled(bushing->law, 1, 1, factor);
    return scene;
}

}  // namespace elastocheck::compare
