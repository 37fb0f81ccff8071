// The square system of this leg: balance of every body and all constraints, scaled to numbers of order one.
//
// Unknowns x [7 nb + m]: per body (r - centre) / L and the quaternion (x, y, z, w), then the reactions R of
// the constraint rows over F, or F L where a row holds a direction. A step dx [n], n = 6 nb + m, has per body
// (δr / L, δπ) instead. Residuals E [n], in this order:
//
//   per body   Σ forces / F,  Σ moments about its origin / (F L)
//   per row    Φ / L, or Φ where it is a cosine
//
// L is the radius of the model about `centre`, F the largest of what is applied, of what is stored at the
// design pose and of what the stiffest element makes of a hundredth of L: then the round-off of stiff
// elements stays well below the tolerance, whatever moves the branch, whatever the units and wherever the
// ground frame sits.
//
// All that a driver may move, static or not, stands as start + rate·a. So E is a function of (x, a) like any
// other, and ∂E/∂a comes out of the same automatic differentiation as ∂E/∂x.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "models/equilibrium_path.hpp"
#include "reference/equilibrium/equations.hpp"

namespace elastocheck::reference::equilibrium {

struct Affine {
    double start = 0, rate = 0;
    template <class T>
    T at(const T& a) const {
        return start + rate * a;
    }
};

// What an element is along the branch; an element uses the one that its kind has.
struct ElementPath {
    Affine free_length;             // of a spring [m]
    std::array<Affine, 6> preload;  // of a bushing [N, N·m]
    bool rotational = false;        // whether the bushing cares how its markers are turned against each other
};

// A load, and what multiplies it: 1 for static ones.
struct LoadPath {
    LoadKind kind;
    Affine factor;
};

struct Pattern;  // of J (derivatives.hpp)

struct System {
    const Model* model = nullptr;
    const Branch* branch = nullptr;
    std::vector<Affine>
        values;                 // per Model::constraints: its offset, length or angle [m, rad], if it has one
    std::vector<double> turns;  // per Model::constraints: from such an angle to the drawn one [rad], or 0
    std::vector<ElementPath> elements;                 // per Model::elastics
    std::vector<LoadPath> loads;                       // static and driven
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // [m], ground axes
    double length = 1;                                 // L [m]
    double force = 1;                                  // F [N]
    int bodies = 0;                                    // nb
    int constraint_rows = 0;                           // m
    bool conservative = true;                          // no follower, no formulation without energy
    Eigen::VectorXd carried;                           // what the joints carry at the design pose [m]
    Eigen::VectorXd at_design;                         // E there, at a = 0 [n]
    mutable std::shared_ptr<const Pattern> pattern;  // found when J is first asked for; a system has one user

    int unknowns() const { return 7 * bodies + constraint_rows; }
    int equations() const { return 6 * bodies + constraint_rows; }
};

// What is asked of the system: E(x; a, held) = held · at_design. With held = 1 the design pose is an
// equilibrium because somebody holds it; letting go, to held = 0, settles all that stands at a = 0: static
// loads and preloads, what the drivers hold, constraints that the design pose misses. An angle is let go of
// as an angle, value + held · turn: its row is a sine, which would let go to the nearer of two opposite
// directions.
//
// `pieces` names the piece of its curve that each deformation is on, per Model::elastics, so that E is smooth
// whatever the knots; empty: each by itself.
using Pieces = std::vector<ElementPieces>;
struct Loading {
    double a = 0;
    double held = 0;                   // [-]
    double a_rate = 0, held_rate = 0;  // along the way that is walked
    Pieces pieces = {};
};

// `points` are values of a. Throws std::invalid_argument where the model does not stand on the branch, or a
// driver moves what its joint or element does not have.
System make_system(const Model& model, const Branch& branch, std::span<const double> points);

Frame<double> frame_of(const System& system, const Eigen::VectorXd& x, BodyId body);

Eigen::VectorXd design_unknowns(const System& system);
// With the bodies at these poses and no reactions. Throws std::invalid_argument unless there is one a body.
Eigen::VectorXd unknowns_at(const System& system, const std::vector<Pose>& poses);
Eigen::VectorXd held_at_design(const System& system);  // E there at a = 0, what is held left out
Eigen::VectorXd residual(const System& system, const Loading& loading, const Eigen::VectorXd& x);

Eigen::VectorXd moved(const System& system, const Eigen::VectorXd& x, const Eigen::VectorXd& dx);
Eigen::VectorXd step_between(const System& system, const Eigen::VectorXd& from, const Eigen::VectorXd& to);

// The largest |δr| / L or |δπ| of a body, infinite when anything is not finite.
double pose_size(const System& system, const Eigen::VectorXd& dx);
double largest(const Eigen::VectorXd& E);  // absolute entry, NaN when anything is not finite

// A bushing that is turned nearly to where its angles, or its frame in the middle, end: "bushing 'x' is turned by
// half a turn, where its rotation has no value", or empty.
std::string bushing_without_angles(const System& system, const Eigen::VectorXd& x);

// "1500 N", "-40 mm": the branch's parameter as reports show it.
std::string parameter(const Branch& branch, double a);

Equilibrium state_of(const System& system, const Loading& loading, const Eigen::VectorXd& x);

// The ground in the frame of the system, whose origin is `centre`.
inline Frame<double> ground_frame(const System& system) {
    return {-system.centre, Eigen::Quaterniond::Identity()};
}

// The preload of a bushing at a.
template <class T>
Vec6<T> preload_at(const ElementPath& path, const T& a) {
    Vec6<T> preload;
    for (int k = 0; k < 6; ++k) preload[k] = path.preload[static_cast<std::size_t>(k)].at(a);
    return preload;
}

// What element e does to its two bodies.
template <class T>
OnBoth<T> interaction(const System& system, std::size_t e, const T& a, const Pieces& pieces,
                      const Frame<T>& i, const Frame<T>& j) {
    const ElementPath& path = system.elements[e];
    const ElementPieces& on = pieces.empty() ? all_by_themselves : pieces[e];
    return std::visit(overloaded{[&](const AxialSpring& spring) {
                                     return interaction(spring, path.free_length.at(a), on[0], i, j);
                                 },
                                 [&](const Bushing& bushing) {
                                     return interaction(bushing, preload_at(path, a), path.rotational, on, i,
                                                        j);
                                 }},
                      system.model->elastics[e].kind);
}

// What the law of element e sees: ℓ - ℓ₀ first, or e - e₀.
template <class T>
Vec6<T> deformations(const System& system, std::size_t e, const T& a, const Frame<T>& i, const Frame<T>& j) {
    const ElementPath& path = system.elements[e];
    return std::visit(overloaded{[&](const AxialSpring& spring) {
                                     Vec6<T> x = Vec6<T>::Constant(T(0.0));
                                     x[0] = deformation(spring, path.free_length.at(a), i, j);
                                     return x;
                                 },
                                 [&](const Bushing& bushing) {
                                     return Vec6<T>(measured(bushing, path.rotational, i, j).e -
                                                    bushing.undeformed.cast<T>());
                                 }},
                      system.model->elastics[e].kind);
}

// Constraint c with the reactions R of its rows [N, N·m].
template <class T>
Holding<T> holding(const System& system, std::size_t c, const T& a, const T& held, const Frame<T>& i,
                   const Frame<T>& j, const T* R) {
    const T value = system.values[c].at(a) + held * system.turns[c];
    return std::visit([&](const auto& kind) { return holding(kind, value, i, j, R); },
                      system.model->constraints[c].kind);
}

// ---- Assembly, for double and for Jets

// One term of the system: the bodies it couples, and the constraint rows whose reactions enter.
struct Part {
    BodyId i = ground, j = ground;
    int row = 0, rows = 0;
    bool directions = false;  // are what its rows hold: wherever the bodies are, and with moments only
};

// `source.frame(part, which)` gives the frames of the part's two bodies, `source.reaction(part, k)` its
// scaled reactions; `sink.balance(part, body, force, moment)` and `sink.constraint(part, k, Phi)` take the
// scaled terms, to be summed.
template <class T, class Source, class Sink>
void assemble(const System& system, const T& a, const T& held, const Pieces& pieces, const Source& source,
              Sink& sink) {
    const Model& model = *system.model;
    const double per_force = 1 / system.force, per_moment = per_force / system.length,
                 per_length = 1 / system.length;

    const auto apply = [&](const Part& part, BodyId body, const Frame<T>& frame, const Interaction<T>& on,
                           const T& factor) {
        if (body == ground) return;
        const Vec3<T> moment = on.moment + cross(Vec3<T>(on.at - frame.r), on.force);
        sink.balance(part, body, Vec3<T>(on.force * T(factor * per_force)),
                     Vec3<T>(moment * T(factor * per_moment)));
    };

    for (std::size_t e = 0; e < model.elastics.size(); ++e) {
        const auto [i, j] = bodies_of(model.elastics[e].kind);
        const Part part{i, j};
        const Frame<T> frame_i = source.frame(part, 0), frame_j = source.frame(part, 1);
        const auto on = interaction(system, e, a, pieces, frame_i, frame_j);
        apply(part, i, frame_i, on.i, T(+1.0));
        apply(part, j, frame_j, on.j, T(+1.0));
    }
    for (const auto& load : system.loads) {
        const Part part{body_of(load.kind), ground};
        if (part.i == ground) continue;
        const Frame<T> body = source.frame(part, 0);
        apply(part, part.i, body, std::visit([&](const auto& k) { return on_body(k, body); }, load.kind),
              load.factor.at(a));
    }

    int row = 0;
    for (std::size_t c = 0; c < model.constraints.size(); ++c) {
        const auto& kind = model.constraints[c].kind;
        const auto [i, j] = bodies_of(kind);
        const bool directions = is_direction(kind);
        const Part part{i, j, row, rows(kind), directions};
        const Frame<T> frame_i = source.frame(part, 0), frame_j = source.frame(part, 1);
        T R[3];
        for (int k = 0; k < part.rows; ++k)
            R[k] = source.reaction(part, k) * (directions ? system.force * system.length : system.force);
        const auto h = holding(system, c, a, held, frame_i, frame_j, R);
        apply(part, i, frame_i, h.reaction, T(+1.0));
        apply(part, j, frame_j, h.reaction, T(-1.0));
        for (int k = 0; k < part.rows; ++k)
            sink.constraint(part, k, T(h.Phi[k] * (directions ? 1.0 : per_length)));
        row += part.rows;
    }
}

}  // namespace elastocheck::reference::equilibrium
