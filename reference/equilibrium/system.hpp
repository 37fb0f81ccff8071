// The square system of this leg: balance of every body and all constraints, scaled to numbers of order one.
//
// Unknowns x [7 nb + m]: per body (r - centre) / L and the quaternion (x, y, z, w), then the reactions R of
// the constraint rows over F, or F L where a row holds a direction. A step dx [n], n = 6 nb + m, has per body
// (δr / L, δπ) instead. Residuals E [n], in this order:
//
//   per body   Σ forces / F,  Σ moments about its origin / (F L)
//   per row    Φ / L, or Φ where it is a cosine
//
// L is the radius of the model about `centre`, F the larger of what is applied and of what the stiffest
// element makes of a hundredth of L: then the round-off of stiff elements stays well below the tolerance,
// whatever the units and wherever the ground frame sits.
#pragma once

#include <span>

#include "models/equilibrium_path.hpp"
#include "reference/equilibrium/equations.hpp"

namespace elastocheck::reference::equilibrium {

struct System {
    const Model* model = nullptr;
    const Branch* branch = nullptr;
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // [m], ground axes
    double length = 1;                                 // L [m]
    double force = 1;                                  // F [N]
    int bodies = 0;                                    // nb
    int constraint_rows = 0;                           // m
    Eigen::VectorXd at_design;  // E at the design pose, no reactions, load factor 0 [n]

    int unknowns() const { return 7 * bodies + constraint_rows; }
    int equations() const { return 6 * bodies + constraint_rows; }
};

// What is asked of the system: E(x; factor) = held · at_design. With held = 1 the design pose is an
// equilibrium because somebody holds it; letting go, to held = 0, settles static loads and preloads.
struct Loading {
    double factor = 0;  // a
    double held = 0;    // [-]
};

System make_system(const Model& model, const Branch& branch, std::span<const double> loads);

Eigen::VectorXd design_unknowns(const System& system);
Eigen::VectorXd residual(const System& system, const Loading& loading, const Eigen::VectorXd& x);
Eigen::VectorXd load_rate(const System& system, const Eigen::VectorXd& x);  // ∂E/∂a [n]

Eigen::VectorXd moved(const System& system, const Eigen::VectorXd& x, const Eigen::VectorXd& dx);
Eigen::VectorXd step_between(const System& system, const Eigen::VectorXd& from, const Eigen::VectorXd& to);

// The largest |δr| / L or |δπ| of a body, infinite when anything is not finite.
double pose_size(const System& system, const Eigen::VectorXd& dx);
double largest(const Eigen::VectorXd& E);  // absolute entry, NaN when anything is not finite

// The name of a bushing whose rotation is within 0.05 rad of where the logarithm ends, or empty.
std::string bushing_at_half_turn(const System& system, const Eigen::VectorXd& x);

Equilibrium state_of(const System& system, const Loading& loading, const Eigen::VectorXd& x);

// The ground in the frame of the system, whose origin is `centre`.
inline Frame<double> ground_frame(const System& system) {
    return {-system.centre, Eigen::Quaterniond::Identity()};
}

// ---- Assembly, for double and for Jets

// One term of the system: the bodies it couples, and the constraint rows whose reactions enter.
struct Part {
    BodyId i = ground, j = ground;
    int row = 0, rows = 0;
};

// `source.frame(part, which)` gives the frames of the part's two bodies, `source.reaction(part, k)` its
// scaled reactions; `sink.balance(part, body, force, moment)` and `sink.constraint(part, k, Phi)` take the
// scaled terms, to be summed.
template <class T, class Source, class Sink>
void assemble(const System& system, double load_factor, const Source& source, Sink& sink) {
    const Model& model = *system.model;
    const double per_force = 1 / system.force, per_moment = per_force / system.length,
                 per_length = 1 / system.length;

    const auto apply = [&](const Part& part, BodyId body, const Frame<T>& frame, const Interaction<T>& on,
                           double sign) {
        if (body == ground) return;
        const Vec3<T> moment = on.moment + cross(Vec3<T>(on.at - frame.r), on.force);
        sink.balance(part, body, Vec3<T>(on.force * T(sign * per_force)),
                     Vec3<T>(moment * T(sign * per_moment)));
    };
    const auto load = [&](const Load& l, double factor) {
        const Part part{body_of(l.kind), ground};
        if (part.i == ground) return;
        const Frame<T> body = source.frame(part, 0);
        apply(part, part.i, body, std::visit([&](const auto& k) { return on_body(k, body); }, l.kind),
              factor);
    };

    for (const auto& elastic : model.elastics) {
        const auto [i, j] = bodies_of(elastic.kind);
        const Part part{i, j};
        const Frame<T> frame_i = source.frame(part, 0), frame_j = source.frame(part, 1);
        const auto on_i =
            std::visit([&](const auto& k) { return interaction(k, frame_i, frame_j); }, elastic.kind);
        apply(part, i, frame_i, on_i, +1);
        apply(part, j, frame_j, on_i, -1);
    }
    for (const auto& l : model.static_loads) load(l, 1);
    for (const auto& l : system.branch->loads) load(l, load_factor);

    int row = 0;
    for (const auto& constraint : model.constraints) {
        const auto [i, j] = bodies_of(constraint.kind);
        const Part part{i, j, row, rows(constraint.kind)};
        const bool directions = is_direction(constraint.kind);
        const Frame<T> frame_i = source.frame(part, 0), frame_j = source.frame(part, 1);
        T reaction[3];
        for (int k = 0; k < part.rows; ++k)
            reaction[k] =
                source.reaction(part, k) * (directions ? system.force * system.length : system.force);
        const auto h = std::visit([&](const auto& k) { return holding(k, frame_i, frame_j, reaction); },
                                  constraint.kind);
        apply(part, i, frame_i, h.reaction, +1);
        apply(part, j, frame_j, h.reaction, -1);
        for (int k = 0; k < part.rows; ++k)
            sink.constraint(part, k, T(h.Phi[k] * (directions ? 1.0 : per_length)));
        row += part.rows;
    }
}

}  // namespace elastocheck::reference::equilibrium
