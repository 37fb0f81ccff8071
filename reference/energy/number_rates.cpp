#include "reference/energy/number_rates.hpp"

#include <limits>
#include <stdexcept>

#include "models/kinds.hpp"
#include "reference/energy/potential/rotation.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double last_digits = 64 * std::numeric_limits<double>::epsilon();

// ---- A part alone, its ends as bodies 0 and 1.

Model alone(const std::vector<Pose>& poses, BodyId i, BodyId j) {
    const auto pose = [&](BodyId body) {
        return body == ground ? Pose{} : poses[static_cast<std::size_t>(body)];
    };
    Model model;
    model.bodies = {{"", pose(i)}, {"", pose(j)}};
    return model;
}
template <class Kind>
Kind renumbered(Kind kind, BodyId i) {
    each_body(kind, [i](BodyId& body) { body = body == i ? 0 : 1; });
    return kind;
}

struct ElementAlone {
    Model model;
    Prescribed prescribed;
    Chart chart;
};
ElementAlone alone(const Model& model, const StateTangent& at, std::size_t k) {
    const auto [i, j] = ends(model.elastics[k].kind);
    ElementAlone one{alone(at.state.poses, i, j), {}, {}};
    one.model.elastics = {{"", renumbered(model.elastics[k].kind, i)}};
    one.prescribed = nothing_prescribed(one.model);
    const auto n = static_cast<Eigen::Index>(k);
    one.prescribed.free_length[0] = at.prescribed.free_length[n];
    one.prescribed.preload.col(0) = at.prescribed.preload.col(n);
    one.prescribed.strength[0] = at.prescribed.strength[n];
    one.chart = chart_about(design_poses(one.model));
    return one;
}

struct ConstraintAlone {
    Model model;
    Prescribed prescribed;
    Chart chart;
};
ConstraintAlone constraint_alone(const Model& model, const StateTangent& at, std::size_t k) {
    const auto [i, j] = ends(model.constraints[k].kind);
    ConstraintAlone one{alone(at.state.poses, i, j), {}, {}};
    one.model.constraints = {{0, renumbered(model.constraints[k].kind, i)}};
    one.prescribed = nothing_prescribed(one.model);
    one.prescribed.offset[0] = at.prescribed.offset[static_cast<Eigen::Index>(k)];
    one.chart = chart_about(design_poses(one.model));
    return one;
}

// ---- Rigid motion (v, ω) of the features of an end, in body axes.

using Vector6d = Eigen::Matrix<double, 6, 1>;
Vector6d rigid(const Vector3d& ds, const Vector3d& s, const Vector3d& omega) {
    Vector6d y;
    y << ds - omega.cross(s), omega;
    return y;
}
// A unit vector u turns by the smallest ω with ω × u = δu.
Vector3d turning(const Direction& u, const Direction& d) { return u.u_local.cross(d.u_local); }

Vector6d motion_of(const Point& p, const Point& d) {
    return rigid(d.s_local, p.s_local, Vector3d::Zero());
}
Vector6d motion_of(const Direction& u, const Direction& d) {
    return rigid(Vector3d::Zero(), Vector3d::Zero(), turning(u, d));
}
// exp(ω) A = A + δA:  ω = 2 δp p⁻¹
Vector6d motion_of(const Marker& m, const Marker& d) {
    return rigid(d.s_local, m.s_local, (d.A_local * m.A_local.conjugate()).vec() * 2);
}

struct BothMotions {
    Vector6d i, j;
};
template <class Kind>
BothMotions motions(const Kind& kind, const Kind& d) {
    return {motion_of(kind.i, d.i), motion_of(kind.j, d.j)};
}
BothMotions motions(const PointInPlane& c, const PointInPlane& d) {
    return {motion_of(c.i, d.i), rigid(d.j.s_local, c.j.s_local, turning(c.normal_j, d.normal_j))};
}
// ω turns x, and about x what is left of the turn of y.
BothMotions motions(const DirectionAtAngle& c, const DirectionAtAngle& d) {
    const Vector3d across = turning(c.j, d.j);
    const Vector3d &x = c.j.u_local, &y = c.y_j.u_local;
    const double about = x.cross(y).dot(d.y_j.u_local - across.cross(y));
    return {motion_of(c.i, d.i), rigid(Vector3d::Zero(), Vector3d::Zero(), across + about * x)};
}

// y of both ends in ground axes.
template <class Variant>
Vector12 end_motion(const Variant& kind, const Variant& d, const Chart& chart) {
    const BothMotions both = std::visit(
        [&]<class Kind>(const Kind& held) { return motions(held, std::get<Kind>(d)); }, kind);
    const auto [i, j] = ends(kind);
    Vector12 y;
    const auto turned_to_ground = [&](BodyId body, const Vector6d& local, int at) {
        const Matrix3d& A = chart[body].A_c;
        y.segment<3>(at) = A * local.head<3>();
        y.segment<3>(at + 3) = A * local.tail<3>();
    };
    turned_to_ground(i, both.i, 0);
    turned_to_ground(j, both.j, 6);
    return y;
}

// ∂²f/∂x∂y y of both ends.
Vector12 mixed(const PartCurvature& part, const Vector12& y) {
    Vector12 change = part.H * y;
    for (const int at : {0, 6}) {
        const Vector3d v = y.segment<3>(at), omega = y.segment<3>(at + 3);
        change.segment<3>(at + 3) +=
            v.cross(part.g.segment<3>(at)) + 0.5 * omega.cross(part.g.segment<3>(at + 3));
    }
    return change;
}

// ---- The change of a law u(x - x₀) by its numbers and x₀ is a law too. With
// u' = Σ c_n (x - x_k)ⁿ on a piece, the change of u' is Σ (δc_n - (n+1) c_{n+1} (δx_k + δx₀)) (x - x_k)ⁿ.

Curve changed(const Curve& u, const Curve& d, double origin) {
    Curve change = u;
    for (std::size_t k = 0; k < u.pieces.size(); ++k) {
        const double by = d.knots[k == 0 ? 0 : k - 1] + origin;
        for (std::size_t n = 0; n < 4; ++n) {
            const double slope = n < 3 ? static_cast<double>(n + 1) * u.pieces[k][n + 1] : 0;
            change.pieces[k][n] = d.pieces[k][n] - slope * by;
        }
    }
    return change;
}
// The law, and the part of the change that is a constant force.
template <class Law, class Force>
struct Changed {
    Law law;
    Force constant;
};
Changed<ScalarLaw, double> changed(const ScalarLaw& law, const ScalarLaw& d, double origin) {
    if (const double* k = rate_of(law)) return {d, -*k * origin};
    return {changed(std::get<Curve>(law), std::get<Curve>(d), origin), 0};
}
Changed<SpatialLaw, Vector6> changed(const SpatialLaw& law, const SpatialLaw& d,
                                     const Vector6& origin) {
    if (const Matrix6* K = matrix_of(law)) return {d, -*K * origin};
    Changed<SpatialLaw, Vector6> change{PerAxis{}, Vector6::Zero()};
    auto& axes = std::get<PerAxis>(change.law).axis;
    for (std::size_t k = 0; k < 6; ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        auto one = changed(axes_of(law)->axis[k], axes_of(d)->axis[k], origin[at]);
        axes[k] = one.law;
        change.constant[at] = one.constant;
    }
    return change;
}

// The element with the change of its stress for stress.
ElementAlone with_changed_stress(ElementAlone one, const ElasticKind& d, double dfree_length,
                                 const Vector6& dpreload) {
    one.prescribed.strength.setZero();
    one.prescribed.preload.col(0) = dpreload;
    std::visit(overloaded{[&](AxialSpring& spring) {
                              auto change =
                                  changed(spring.law, std::get<AxialSpring>(d).law, dfree_length);
                              spring.law = change.law;
                              one.prescribed.preload(0, 0) += change.constant;
                          },
                          [&](Bushing& bushing) {
                              const auto& by = std::get<Bushing>(d);
                              auto change = changed(bushing.law, by.law, by.undeformed);
                              bushing.law = change.law;
                              bushing.preload = by.preload;
                              one.prescribed.preload.col(0) += change.constant;
                          }},
               one.model.elastics[0].kind);
    return one;
}

// Rates of the prescribed quantities at the state, by the product rule.
Prescribed prescribed_rate(const Model& model, const Branch& branch, const Model& rate, double a) {
    Prescribed result = nothing_prescribed(model);
    const auto add_load = [&](const LoadKind& load, const LoadKind& d, double factor,
                              double dfactor) {
        if (body_of(load) == ground) return;
        const Vector3d change = dfactor * load_vector(load) + factor * load_vector(d);
        std::visit(overloaded{[&](const DeadForce& f) {
                                  result.forces.push_back({f.at, change});
                              },
                              [&](const DeadMoment& m) {
                                  result.moments.push_back({m.body, change});
                              },
                              [](const FollowerForce&) {}, [](const FollowerMoment&) {}},
                   load);
    };
    for (std::size_t k = 0; k < model.static_loads.size(); ++k)
        add_load(model.static_loads[k].kind, rate.static_loads[k].kind, 1, 0);
    for (std::size_t k = 0; k < branch.drivers.size(); ++k) {
        const Driver &driver = branch.drivers[k], &d = rate.branches.front().drivers[k];
        const double by = driver.start + a * driver.rate, dby = d.start + a * d.rate;
        std::visit(
            overloaded{
                [&](const Load& load) {
                    add_load(load.kind, std::get<Load>(d.what).kind, by, dby);
                },
                [&](const Motion& motion) {
                    result.offset[model.joints[static_cast<std::size_t>(motion.joint)].driven] +=
                        dby;
                },
                [&](const FreeLength& length) { result.free_length[length.elastic] += dby; },
                [&](const Preload& preload) {
                    result.preload.col(preload.elastic) +=
                        dby * preload.direction + by * std::get<Preload>(d.what).direction;
                }},
            driver.what);
    }
    return result;
}

// -f·p with f constant, p carried along by y = (v, 0):  ∂²/∂φ∂v = v × (-f)
void add_moved_loads(const Model& model, const Branch& branch, const Model& rate, double a,
                     const Chart& chart, VectorXd& b) {
    const auto add = [&](const LoadKind& load, const LoadKind& d, double factor) {
        if (body_of(load) == ground) return;
        std::visit(overloaded{[&](const DeadForce& force) {
                                  const BodyId body = force.at.body;
                                  const Vector3d v =
                                      chart[body].A_c * std::get<DeadForce>(d).at.s_local;
                                  b.segment<3>(6 * body + 3) -= v.cross(factor * force.f);
                              },
                              [](const DeadMoment&) {},
                              // not conservative: not solved
                              [](const FollowerForce&) {}, [](const FollowerMoment&) {}},
                   load);
    };
    for (std::size_t k = 0; k < model.static_loads.size(); ++k)
        add(model.static_loads[k].kind, rate.static_loads[k].kind, 1);
    for (std::size_t k = 0; k < branch.drivers.size(); ++k)
        if (const Load* load = driven_load(branch.drivers[k].what)) {
            const Driver& driver = branch.drivers[k];
            add(load->kind, driven_load(rate.branches.front().drivers[k].what)->kind,
                driver.start + a * driver.rate);
        }
}

void add_ends(const PartCurvature& part, const Vector12& change, VectorXd& b) {
    if (part.i != ground) b.segment<6>(6 * part.i) += change.head<6>();
    if (part.j != ground) b.segment<6>(6 * part.j) += change.tail<6>();
}

bool is_zero(const SpatialLaw& d) {
    if (const Matrix6* K = matrix_of(d)) return K->isZero(0);
    return false;
}
// Whether the law, the preload and the undeformed state stay.
bool keeps_stress(const ElasticKind& d) {
    bool keeps = true;
    each_member(
        d, overloaded{[&](const ScalarLaw& law) {
                          const double* k = rate_of(law);
                          keeps = keeps && k != nullptr && *k == 0;
                      },
                      [&](const SpatialLaw& law) { keeps = keeps && is_zero(law); },
                      [&](Length<const double> l) { keeps = keeps && l.value == 0; },
                      [&](ForceAndMoment<const Vector6> w) { keeps = keeps && w.value.isZero(0); },
                      [&](Deformation<const Vector6> e) { keeps = keeps && e.value.isZero(0); }});
    return keeps;
}

void check_shape(const Model& model, const Branch& branch, const Model& rate) {
    if (rate.bodies.size() != model.bodies.size() ||
        rate.constraints.size() != model.constraints.size() ||
        rate.elastics.size() != model.elastics.size() || rate.branches.empty() ||
        rate.branches.front().drivers.size() != branch.drivers.size())
        throw std::invalid_argument("the rate belongs to another model or branch");
}

}  // namespace

Parts parts_of(const Model& model, const StateTangent& at) {
    Parts parts;
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const auto [i, j] = ends(model.elastics[k].kind);
        PartCurvature& part = parts.elements.emplace_back();
        part.i = i, part.j = j;
        const ElementAlone one = alone(model, at, k);
        MatrixXd H = stiffness(one.model, one.prescribed, one.chart);
        const Vector6 stress = stresses(one.model, one.prescribed, one.chart).col(0);
        if (!stress.isZero(0)) add_curvature(one.model.elastics[0].kind, stress, one.chart, H);
        part.H = 0.5 * (H + H.transpose());
        part.g = potential(one.model, one.prescribed, one.chart).gradient;
    }
    int row = 0;
    for (std::size_t k = 0; k < model.constraints.size(); ++k) {
        const ConstraintKind& kind = model.constraints[k].kind;
        const auto [i, j] = ends(kind);
        PartCurvature& part = parts.constraints.emplace_back();
        part.i = i, part.j = j;
        const ConstraintAlone one = constraint_alone(model, at, k);
        const ConstraintKind& kind_alone = one.model.constraints[0].kind;
        MatrixXd H = MatrixXd::Zero(12, 12);
        add_curvature(kind_alone, one.prescribed.offset[0], one.chart, at.lambda.data() + row, H);
        part.H = 0.5 * (H + H.transpose());
        const MatrixXd Phi_x =
            transposed(constraints(one.model, one.prescribed, one.chart).Phi_q).transpose();
        part.Phi_x.topRows(rows(kind)) = Phi_x;
        part.g = Phi_x.transpose() * at.lambda.segment(row, rows(kind));
        row += rows(kind);
    }
    return parts;
}

NumberRate number_rate(const Model& model, const Branch& branch, const Model& rate,
                       const StateTangent& at, const Parts& parts) {
    check_shape(model, branch, rate);
    const Chart chart = chart_about(at.state.poses);
    const double a = at.state.a;
    const Prescribed change = prescribed_rate(model, branch, rate, a);
    const VectorXd none = VectorXd::Zero(coordinates(model));
    NumberRate number{none, none, VectorXd::Zero(constraint_rows(model)), {}, {}};
    {
        // loads alone: the elements follow
        Prescribed loads = nothing_prescribed(model);
        loads.forces = change.forces, loads.moments = change.moments;
        number.b = gradient_rate(model, at.prescribed, loads, chart);
    }
    add_moved_loads(model, branch, rate, a, chart, number.b);

    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const auto n = static_cast<Eigen::Index>(k);
        const ElasticKind &kind = model.elastics[k].kind, &d = rate.elastics[k].kind;
        const PartCurvature& part = parts.elements[k];
        const Vector12 y = end_motion(kind, d, chart);
        if (!y.isZero(0)) {
            add_ends(part, mixed(part, y), number.b);
            add_ends(part, last_digits * (part.H.cwiseAbs() * y.cwiseAbs()), number.rounding);
        }
        const double* length = driven_number(d);
        const double dfree_length = (length != nullptr ? *length : 0) + change.free_length[n];
        if (keeps_stress(d) && dfree_length == 0 && change.preload.col(n).isZero(0)) continue;
        add_ends(part, last_digits * std::abs(dfree_length) * part.H.cwiseAbs().rowwise().sum(),
                 number.rounding);
        const ElementAlone one =
            with_changed_stress(alone(model, at, k), d, dfree_length, change.preload.col(n));
        add_ends(part, potential(one.model, one.prescribed, one.chart).gradient, number.b);
    }
    int row = 0;
    for (std::size_t k = 0; k < model.constraints.size(); ++k) {
        const ConstraintKind &kind = model.constraints[k].kind, &d = rate.constraints[k].kind;
        const PartCurvature& part = parts.constraints[k];
        const Vector12 y = end_motion(kind, d, chart);
        number.motion.push_back(y);
        Vector12& turned = number.turned.emplace_back(Vector12::Zero());
        VectorXd size = VectorXd::Zero(rows(kind));
        if (!y.isZero(0)) {
            add_ends(part, mixed(part, y), number.b);
            add_ends(part, last_digits * (part.H.cwiseAbs() * y.cwiseAbs()), number.rounding);
            number.Phi_rate.segment(row, rows(kind)) += part.Phi_x.topRows(rows(kind)) * y;
            size = part.Phi_x.topRows(rows(kind)).rowwise().norm() * y.norm();
        }
        const double* value = driven_number(d);
        const double dvalue =
            (value != nullptr ? *value : 0) + change.offset[static_cast<Eigen::Index>(k)];
        if (dvalue != 0) {
            const ConstraintAlone one = constraint_alone(model, at, k);
            Prescribed moved = nothing_prescribed(one.model);
            moved.offset[0] = dvalue;
            const ConstraintRates rates =
                constraint_rates(one.model, one.prescribed, moved, one.chart);
            turned = transposed_times(rates.Phi_qa, at.lambda.segment(row, rows(kind)));
            add_ends(part, turned, number.b);
            number.Phi_rate.segment(row, rows(kind)) += rates.Phi_a;
            size += rates.Phi_a.cwiseAbs();
        }
        // Points and lengths that change together keep a row closed: what is left is rounding.
        for (int n = 0; n < rows(kind); ++n)
            if (std::abs(number.Phi_rate[row + n]) <= last_digits * size[n])
                number.Phi_rate[row + n] = 0;
        row += rows(kind);
    }
    return number;
}

// The wrench of a constraint on its body is -g, g = ∂(λᵀΦ_k)/∂(δr, δπ). It changes by that of the
// gradient in the chart, and since δπ = (1 + ½ φ̃) δφ, of the moment by ½ φ × g_φ besides.
std::vector<Wrench> wrench_rates(const Model& model, const Model& rate, const StateTangent& at,
                                 const Parts& parts, const NumberRate& number, const VectorXd& dx,
                                 const VectorXd& dlambda) {
    std::vector<Wrench> wrenches(model.joints.size());
    const Chart chart = chart_about(at.state.poses);
    int row = 0;
    for (std::size_t k = 0; k < model.constraints.size(); ++k) {
        const auto joint_at = static_cast<std::size_t>(model.constraints[k].joint);
        const ModelJoint& joint = model.joints[joint_at];
        const PartCurvature& part = parts.constraints[k];
        const int count = rows(model.constraints[k].kind);
        const BodyId body = joint.i != ground ? joint.i : joint.j;
        if (body != ground) {
            const auto motion = [&](BodyId b) -> Vector6d {
                return b == ground ? Vector6d(Vector6d::Zero()) : Vector6d(dx.segment<6>(6 * b));
            };
            Vector12 moved;
            moved << motion(part.i), motion(part.j);
            Vector12 dg = part.H * moved + mixed(part, number.motion[k]) + number.turned[k] +
                          part.Phi_x.topRows(count).transpose() * dlambda.segment(row, count);
            const int end = part.i == body ? 0 : 6;
            const Vector3d g_r = part.g.segment<3>(end), g_pi = part.g.segment<3>(end + 3);
            const Vector3d turn = motion(body).tail<3>();
            const Vector3d dforce = dg.segment<3>(end),
                           dmoment = dg.segment<3>(end + 3) + 0.5 * turn.cross(g_pi);
            // The lever from the body's origin to the joint's point, and its change.
            const Placement& on = chart[joint.at.body];
            const Vector6d by = motion(joint.at.body);
            const Vector3d lever = on.A_c * joint.at.s_local;
            const Vector3d dp = by.head<3>() + by.tail<3>().cross(lever) +
                                on.A_c * rate.joints[joint_at].at.s_local;
            const Vector3d arm = on.centre.r + lever - chart[body].centre.r,
                           darm = dp - motion(body).head<3>();
            const double sign = joint.i != ground ? -1 : 1;
            wrenches[joint_at].force += sign * dforce;
            wrenches[joint_at].moment += sign * (dmoment - darm.cross(g_r) - arm.cross(dforce));
        }
        row += count;
    }
    return wrenches;
}

}  // namespace elastocheck::reference::energy
