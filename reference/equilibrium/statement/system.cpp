#include "reference/equilibrium/statement/system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "models/branch.hpp"
#include "models/parameter_unit.hpp"

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

struct Values {
    const System& system;
    const VectorXd& x;
    Frame<double> frame(const Part& part, int which) const {
        return frame_of(system, x, which == 0 ? part.i : part.j);
    }
    double reaction(const Part& part, int k) const { return x[7 * system.bodies + part.row + k]; }
};

struct Sum {
    const System& system;
    VectorXd E;
    void balance(const Part&, BodyId body, const Vector3d& force, const Vector3d& moment) {
        E.segment<3>(6 * body) += force;
        E.segment<3>(6 * body + 3) += moment;
    }
    void constraint(const Part& part, int k, double Phi) {
        E[6 * system.bodies + part.row + k] += Phi;
    }
};

VectorXd sum(const System& system, double a, double held, const Pieces& pieces, const VectorXd& x) {
    Sum total{system, VectorXd::Zero(system.equations())};
    assemble<double>(system, a, held, pieces, Values{system, x}, total);
    return std::move(total.E);
}

// ---- Driven quantities

void set_paths(System& system) {
    const Model& model = *system.model;
    DrivenInputs<Affine> inputs = driven_inputs<Affine>(model, *system.branch);
    system.values = std::move(inputs.values);
    system.loads = std::move(inputs.loads);
    for (std::size_t e = 0; e < model.elastics.size(); ++e) {
        ElementPath& path = system.elements.emplace_back(ElementPath{inputs.elements[e]});
        const auto* law = member<SpatialLaw>(model.elastics[e].kind);
        if (law == nullptr) continue;
        path.rotational = resists_rotation(*law);
        for (std::size_t k = 3; k < 6; ++k)
            path.rotational |= path.preload[k].start != 0 || path.preload[k].rate != 0;
    }
}

void set_formulations(System& system) {
    for (const auto& load : system.loads)
        if (body_of(load.kind) != ground && !has_potential(load.kind)) system.conservative = false;
    for (const auto& elastic : system.model->elastics) {
        const auto* formulation = member<Formulation>(elastic.kind);
        if (formulation == nullptr) continue;
        const Formulation& f = *formulation;
        if (f.frame == Formulation::Frame::on_j ||
            (f.frame == Formulation::Frame::middle && !f.conjugate))
            throw std::invalid_argument("bushing '" + elastic.name +
                                        "' has a frame for which this leg has no law");
        if (!elastocheck::has_energy(f)) system.conservative = false;
    }
}

// Sets System::turns: from the value at a = 0 to the design angle of u_i between x_j and y_j.
void set_turns(System& system) {
    const VectorXd x = design_unknowns(system);
    for (std::size_t c = 0; c < system.values.size(); ++c) {
        system.angle_gaps.push_back(0);
        const auto* angle = std::get_if<DirectionAtAngle>(&system.model->constraints[c].kind);
        if (angle == nullptr) continue;
        const auto drawn = [&](const Direction& d) {
            return direction(frame_of(system, x, d.body), d.u_local);
        };
        const Vector3d u_i = drawn(angle->i);
        system.angle_gaps[c] = std::atan2(u_i.dot(drawn(angle->y_j)), u_i.dot(drawn(angle->j))) -
                               system.values[c].at(0.0);
    }
}

// ---- Scales

// Every attachment point and load point in the design pose.
std::vector<Vector3d> hardpoints(const System& system) {
    std::vector<Vector3d> points;
    const auto add = [&](BodyId body, const Vector3d& s_local) {
        if (body == ground) return points.push_back(s_local);
        const Pose& pose = system.model->bodies[static_cast<std::size_t>(body)].design;
        points.push_back(pose.r + turned(pose.p, s_local));
    };
    const auto add_point = [&](const auto& at) { add(at.body, at.s_local); };
    for (const auto& body : system.model->bodies) points.push_back(body.design.r);
    for (const auto& constraint : system.model->constraints) each_point(constraint.kind, add_point);
    for (const auto& elastic : system.model->elastics) each_point(elastic.kind, add_point);
    for (const auto& load : system.loads) each_point(load.kind, add_point);
    return points;
}

double force_of(const LoadKind& load, double length) {
    return load_vector(load).norm() / (is_moment(load) ? length : 1);
}

// Reference deformation over L for the force scale: round-off of stiff elements is
// stiffness times length.
constexpr double usual_deformation = 0.01;

double force_of(const ScalarLaw& law, double length) {
    return steepest(law) * (usual_deformation * length);
}

double force_of(const LinearStiffness& law, double length) {
    double force = 0;
    for (int k = 0; k < 6; ++k) {
        const Vector6 g = usual_deformation * (k < 3 ? length : 1) * law.K.col(k);
        force = std::max({force, g.head<3>().norm(), g.tail<3>().norm() / length});
    }
    return force;
}

double force_of(const SpatialLaw& law, double length) {
    return std::visit(overloaded{[&](const LinearStiffness& u) { return force_of(u, length); },
                                 [&](const PerAxis& u) {
                                     double force = 0;
                                     for (std::size_t k = 0; k < 6; ++k)
                                         force = std::max(force,
                                                          k < 3 ? force_of(u.axis[k], length)
                                                                : force_of(u.axis[k], 1) / length);
                                     return force;
                                 }},
                      law);
}

// Largest absolute value between -a and a.
double size_of(const Affine& path, double a) {
    return std::abs(path.start) + std::abs(path.rate * a);
}

double force_scale(const System& system, double a) {
    double force = 0;
    for (const auto& load : system.loads)
        force = std::max(force, size_of(load.factor, a) * force_of(load.kind, system.length));
    for (std::size_t e = 0; e < system.elements.size(); ++e) {
        const ElementPath& path = system.elements[e];
        double preload = 0;
        for (std::size_t k = 0; k < 6; ++k)
            preload = std::max(preload, size_of(path.preload[k], a) / (k < 3 ? 1 : system.length));
        const double usual =
            std::visit([&](const auto& k) { return force_of(k.law, system.length); },
                       system.model->elastics[e].kind);
        force = std::max({force, preload, usual});
    }
    return force;
}

}  // namespace

System make_system(const Model& model, const Branch& branch, std::span<const double> points) {
    if (!fits_branch(model, branch))
        throw std::invalid_argument(
            "branch '" + branch.name +
            "' must be a single side from 0, with the model of that side (on_branch)");
    System system;
    system.model = &model;
    system.branch = &branch;
    system.bodies = static_cast<int>(model.bodies.size());
    system.constraint_rows = constraint_rows(model);
    set_paths(system);
    set_formulations(system);

    const auto places = hardpoints(system);
    for (const auto& p : places) system.centre += p / static_cast<double>(places.size());
    // Points that differ only by rounding give no length.
    constexpr double digits = 1024 * std::numeric_limits<double>::epsilon();
    double radius = 0, reach = 0;
    for (const auto& p : places) {
        radius = std::max(radius, (p - system.centre).norm());
        reach = std::max(reach, p.norm());
    }
    if (std::isfinite(radius) && radius > digits * reach) system.length = radius;

    system.carried = VectorXd::Zero(system.constraint_rows);
    set_turns(system);

    double a = 0;
    for (const double point : points) a = std::max(a, std::abs(point));
    const double force = force_scale(system, a);
    if (std::isfinite(force) && force > 0) system.force = force;

    // Elastic forces stored in the design pose, in the present scale.
    system.at_design = held_at_design(system);
    const double stored = system.at_design.head(6 * system.bodies).lpNorm<Eigen::Infinity>();
    if (std::isfinite(stored) && stored > 1) {
        system.force *= stored;
        system.at_design.head(6 * system.bodies) /= stored;
    }
    return system;
}

VectorXd held_at_design(const System& system) {
    return sum(system, 0, 1, {}, design_unknowns(system));
}

Vector6 stored_at_design(const System& system, std::size_t e) {
    const VectorXd x = design_unknowns(system);
    const auto [i, j] = bodies_of(system.model->elastics[e].kind);
    const Vector6 d = deformations(system, e, 0., frame_of(system, x, i), frame_of(system, x, j));
    return forces<double>(system.model->elastics[e].kind, d) + preload_at(system.elements[e], 0.);
}

Frame<double> frame_of(const System& system, const VectorXd& x, BodyId body) {
    if (body == ground) return ground_frame(system);
    return {system.length * x.segment<3>(7 * body), Eigen::Quaterniond(x.segment<4>(7 * body + 3))};
}

VectorXd unknowns_at(const System& system, const std::vector<Pose>& poses) {
    if (poses.size() != static_cast<std::size_t>(system.bodies))
        throw std::invalid_argument("the start state does not have one pose per body");
    VectorXd x = VectorXd::Zero(system.unknowns());
    for (int body = 0; body < system.bodies; ++body) {
        const Pose& pose = poses[static_cast<std::size_t>(body)];
        x.segment<3>(7 * body) = (pose.r - system.centre) / system.length;
        x.segment<4>(7 * body + 3) = pose.p.normalized().coeffs();
    }
    return x;
}

VectorXd design_unknowns(const System& system) {
    std::vector<Pose> poses;
    for (const Body& body : system.model->bodies) poses.push_back(body.design);
    VectorXd x = unknowns_at(system, poses);
    x.tail(system.constraint_rows) = system.carried;
    return x;
}

VectorXd residual(const System& system, const Loading& loading, const VectorXd& x) {
    VectorXd E = sum(system, loading.a, loading.held, loading.pieces, x);
    if (loading.held != 0) E -= loading.held * system.at_design;
    return E;
}

VectorXd moved(const System& system, const VectorXd& x, const VectorXd& dx) {
    VectorXd to = x;
    for (int body = 0; body < system.bodies; ++body) {
        to.segment<3>(7 * body) += dx.segment<3>(6 * body);
        const Vector3d half = dx.segment<3>(6 * body + 3) / 2;
        const double angle = half.norm(),
                     by_angle = angle > 1e-4 ? std::sin(angle) / angle : 1 - angle * angle / 6;
        const Eigen::Quaterniond turn(std::cos(angle), by_angle * half[0], by_angle * half[1],
                                      by_angle * half[2]);
        const Eigen::Quaterniond p(x.segment<4>(7 * body + 3));
        to.segment<4>(7 * body + 3) = product(turn, p).normalized().coeffs();
    }
    to.tail(system.constraint_rows) += dx.tail(system.constraint_rows);
    return to;
}

VectorXd step_between(const System& system, const VectorXd& from, const VectorXd& to) {
    VectorXd dx(system.equations());
    for (int body = 0; body < system.bodies; ++body) {
        dx.segment<3>(6 * body) = to.segment<3>(7 * body) - from.segment<3>(7 * body);
        const Eigen::Quaterniond p(from.segment<4>(7 * body + 3)), q(to.segment<4>(7 * body + 3));
        dx.segment<3>(6 * body + 3) = logarithm(product(q, conjugate(p))).theta;
    }
    dx.tail(system.constraint_rows) =
        to.tail(system.constraint_rows) - from.tail(system.constraint_rows);
    return dx;
}

double pose_size(const System& system, const VectorXd& dx) {
    if (!dx.allFinite()) return std::numeric_limits<double>::infinity();
    double size = 0;
    for (int k = 0; k < 2 * system.bodies; ++k) size = std::max(size, dx.segment<3>(3 * k).norm());
    return size;
}

double largest(const VectorXd& E) {
    if (!E.allFinite()) return std::numeric_limits<double>::quiet_NaN();
    return E.size() == 0 ? 0 : E.cwiseAbs().maxCoeff();
}

namespace {

// Distance of B from the nearest singularity of the angles [rad].
double distance_to_singularity(const Formulation& formulation, bool rotational,
                               const Eigen::Quaterniond& B) {
    using Kind = Formulation::Angles;
    constexpr double pi = EIGEN_PI;
    const auto plane = [](double y, double x) {
        return std::min(pi - std::abs(std::atan2(y, x)), std::hypot(x, y));
    };
    const Eigen::Matrix3d A = B.toRotationMatrix();
    double distance = pi;
    if (formulation.frame == Formulation::Frame::middle) distance = 2 * std::abs(B.w());
    if (!rotational) return distance;
    if (formulation.angles == Kind::rotation_vector) distance = 2 * std::abs(B.w());
    if (formulation.angles == Kind::cardan)
        distance = std::min({distance, plane(A(1, 2), A(2, 2)), plane(A(0, 1), A(0, 0))});
    if (formulation.angles == Kind::projected)
        distance = std::min(
            {distance, plane(A(1, 2), A(2, 2)), plane(A(0, 2), A(2, 2)), plane(A(1, 0), A(0, 0))});
    return distance;
}

}  // namespace

std::string bushing_without_angles(const System& system, const VectorXd& x) {
    constexpr double near = 0.05;  // [rad]
    for (std::size_t e = 0; e < system.elements.size(); ++e) {
        const auto& elastic = system.model->elastics[e];
        const auto* bushing = std::get_if<Bushing>(&elastic.kind);
        if (bushing == nullptr) continue;
        const auto axes_i = product(frame_of(system, x, bushing->i.body).p, bushing->i.A_local);
        const auto axes_j = product(frame_of(system, x, bushing->j.body).p, bushing->j.A_local);
        const Eigen::Quaterniond B = product(conjugate(axes_i), axes_j);
        if (distance_to_singularity(bushing->formulation, system.elements[e].rotational, B) < near)
            return fmt::format(
                "bushing '{}' is rotated {}, where its angles are undefined", elastic.name,
                2 * std::abs(B.w()) < near ? "by half a turn"
                                           : "to the end of the range of its angles");
    }
    return {};
}

std::string parameter(const Branch& branch, double a) { return parameter_text(branch.unit, a, 8); }

Equilibrium state_of(const System& system, const Loading& loading, const VectorXd& x) {
    const Model& model = *system.model;
    Equilibrium state;
    state.load = loading.a;
    for (int body = 0; body < system.bodies; ++body) {
        const auto frame = frame_of(system, x, body);
        state.poses.push_back({frame.r + system.centre, frame.p});
    }
    state.reactions.resize(model.joints.size());
    double Phi2 = 0;
    int row = 0;
    for (std::size_t c = 0; c < model.constraints.size(); ++c) {
        const auto& constraint = model.constraints[c];
        const auto [i, j] = bodies_of(constraint.kind);
        const double unit =
            is_direction(constraint.kind) ? system.force * system.length : system.force;
        Vector3d R = Vector3d::Zero();
        R.head(rows(constraint.kind)) =
            unit * x.segment(7 * system.bodies + row, rows(constraint.kind));
        const auto h = holding(system, c, loading.a, loading.held,
                               {frame_of(system, x, i), frame_of(system, x, j)}, R.data());
        Phi2 += h.Phi.head(rows(constraint.kind)).squaredNorm();

        const auto& joint = model.joints[static_cast<std::size_t>(constraint.joint)];
        auto& wrench = state.reactions[static_cast<std::size_t>(constraint.joint)];
        const Vector3d at = position(frame_of(system, x, joint.at.body), joint.at.s_local);
        // the first body of the joint may be the second of the constraint
        const double sign = i == joint.i ? +1 : -1;
        wrench.force += sign * h.reaction.force;
        wrench.moment +=
            sign * (h.reaction.moment + cross(Vector3d(h.reaction.at - at), h.reaction.force));
        row += rows(constraint.kind);
    }
    state.constraint_error = std::sqrt(Phi2);
    return state;
}

}  // namespace elastocheck::reference::equilibrium
