#include "reference/equilibrium/system.hpp"

#include <algorithm>

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

Frame<double> frame_of(const System& system, const VectorXd& x, BodyId body) {
    if (body == ground) return ground_frame(system);
    return {system.length * x.segment<3>(7 * body), Eigen::Quaterniond(x.segment<4>(7 * body + 3))};
}

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
    void constraint(const Part& part, int k, double Phi) { E[6 * system.bodies + part.row + k] += Phi; }
};

VectorXd sum(const System& system, double factor, const VectorXd& x) {
    Sum total{system, VectorXd::Zero(system.equations())};
    assemble<double>(system, factor, Values{system, x}, total);
    return std::move(total.E);
}

// Every point at which something is attached or acts, at the design pose.
std::vector<Vector3d> hardpoints(const Model& model, const Branch& branch) {
    std::vector<Vector3d> points;
    const auto add = [&](BodyId body, const Vector3d& s_local) {
        if (body == ground) return points.push_back(s_local);
        const Pose& pose = model.bodies[static_cast<std::size_t>(body)].design;
        points.push_back(pose.r + turned(pose.p, s_local));
    };
    const auto add_ends = [&](const auto& kind) {
        if constexpr (requires { kind.i.s_local; }) {
            add(kind.i.body, kind.i.s_local);
            add(kind.j.body, kind.j.s_local);
        }
    };
    const auto add_load = [&](const Load& load) {
        if (const auto* f = std::get_if<DeadForce>(&load.kind)) add(f->at.body, f->at.s_local);
    };
    for (const auto& body : model.bodies) points.push_back(body.design.r);
    for (const auto& constraint : model.constraints) std::visit(add_ends, constraint.kind);
    for (const auto& elastic : model.elastics) std::visit(add_ends, elastic.kind);
    std::for_each(model.static_loads.begin(), model.static_loads.end(), add_load);
    std::for_each(branch.loads.begin(), branch.loads.end(), add_load);
    return points;
}

double force_of(const Load& load, double length) {
    if (const auto* f = std::get_if<DeadForce>(&load.kind)) return f->f.norm();
    return std::get<DeadMoment>(load.kind).m.norm() / length;
}

// The forces to be reckoned with: stiffness times a hundredth of the length, and preload.
double force_of(const AxialSpring& spring, double length) { return 0.01 * spring.k * length; }
double force_of(const Bushing& b, double length) {
    const double k = std::max({b.K.topLeftCorner<3, 3>().norm(), b.K.topRightCorner<3, 3>().norm() / length,
                               b.K.bottomRightCorner<3, 3>().norm() / (length * length)});
    return std::max({0.01 * k * length, b.preload.head<3>().norm(), b.preload.tail<3>().norm() / length});
}

}  // namespace

System make_system(const Model& model, const Branch& branch, std::span<const double> loads) {
    System system;
    system.model = &model;
    system.branch = &branch;
    system.bodies = static_cast<int>(model.bodies.size());
    system.constraint_rows = constraint_rows(model);

    const auto points = hardpoints(model, branch);
    for (const auto& p : points) system.centre += p / static_cast<double>(points.size());
    double radius = 0;
    for (const auto& p : points) radius = std::max(radius, (p - system.centre).norm());
    if (std::isfinite(radius) && radius > 0) system.length = radius;

    double a = 0, force = 0;
    for (const double load : loads) a = std::max(a, std::abs(load));
    for (const auto& load : branch.loads) force = std::max(force, a * force_of(load, system.length));
    for (const auto& load : model.static_loads) force = std::max(force, force_of(load, system.length));
    for (const auto& elastic : model.elastics)
        force = std::max(force,
                         std::visit([&](const auto& k) { return force_of(k, system.length); }, elastic.kind));
    if (std::isfinite(force) && force > 0) system.force = force;

    system.at_design = sum(system, 0, design_unknowns(system));
    return system;
}

VectorXd design_unknowns(const System& system) {
    VectorXd x = VectorXd::Zero(system.unknowns());
    for (int body = 0; body < system.bodies; ++body) {
        const Pose& pose = system.model->bodies[static_cast<std::size_t>(body)].design;
        x.segment<3>(7 * body) = (pose.r - system.centre) / system.length;
        x.segment<4>(7 * body + 3) = pose.p.normalized().coeffs();
    }
    return x;
}

VectorXd residual(const System& system, const Loading& loading, const VectorXd& x) {
    VectorXd E = sum(system, loading.factor, x);
    if (loading.held != 0) E -= loading.held * system.at_design;
    return E;
}

VectorXd load_rate(const System& system, const VectorXd& x) {
    VectorXd rate = VectorXd::Zero(system.equations());
    for (const auto& load : system.branch->loads) {
        const BodyId body = body_of(load.kind);
        if (body == ground) continue;
        const auto frame = frame_of(system, x, body);
        const auto on = std::visit([&](const auto& k) { return on_body(k, frame); }, load.kind);
        rate.segment<3>(6 * body) += on.force / system.force;
        rate.segment<3>(6 * body + 3) +=
            (on.moment + cross(Vector3d(on.at - frame.r), on.force)) / (system.force * system.length);
    }
    return rate;
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
    dx.tail(system.constraint_rows) = to.tail(system.constraint_rows) - from.tail(system.constraint_rows);
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

std::string bushing_at_half_turn(const System& system, const VectorXd& x) {
    for (const auto& elastic : system.model->elastics) {
        const auto* bushing = std::get_if<Bushing>(&elastic.kind);
        if (bushing == nullptr || !resists_rotation(*bushing)) continue;
        const auto axes_i = product(frame_of(system, x, bushing->i.body).p, bushing->i.A_local);
        const auto axes_j = product(frame_of(system, x, bushing->j.body).p, bushing->j.A_local);
        if (std::abs(product(conjugate(axes_i), axes_j).w()) < 0.025) return elastic.name;  // cos(θ/2)
    }
    return {};
}

Equilibrium state_of(const System& system, const Loading& loading, const VectorXd& x) {
    const Model& model = *system.model;
    Equilibrium state;
    state.load = loading.factor;
    for (int body = 0; body < system.bodies; ++body) {
        const auto frame = frame_of(system, x, body);
        state.poses.push_back({frame.r + system.centre, frame.p});
    }
    state.reactions.resize(model.joints.size());
    double Phi2 = 0;
    int row = 0;
    for (const auto& constraint : model.constraints) {
        const auto [i, j] = bodies_of(constraint.kind);
        const double unit = is_direction(constraint.kind) ? system.force * system.length : system.force;
        const Vector3d R = [&] {
            Vector3d padded = Vector3d::Zero();
            padded.head(rows(constraint.kind)) =
                unit * x.segment(7 * system.bodies + row, rows(constraint.kind));
            return padded;
        }();
        const auto frame_i = frame_of(system, x, i), frame_j = frame_of(system, x, j);
        const auto h = std::visit([&](const auto& k) { return holding(k, frame_i, frame_j, R.data()); },
                                  constraint.kind);
        Phi2 += h.Phi.head(rows(constraint.kind)).squaredNorm();

        const auto& joint = model.joints[static_cast<std::size_t>(constraint.joint)];
        auto& wrench = state.reactions[static_cast<std::size_t>(constraint.joint)];
        const Vector3d at = position(frame_of(system, x, joint.at.body), joint.at.s_local);
        const double sign = i == joint.i ? +1 : -1;  // the joint's first body may be the constraint's second
        wrench.force += sign * h.reaction.force;
        wrench.moment += sign * (h.reaction.moment + cross(Vector3d(h.reaction.at - at), h.reaction.force));
        row += rows(constraint.kind);
    }
    state.constraint_error = std::sqrt(Phi2);
    return state;
}

}  // namespace elastocheck::reference::equilibrium
