// Square system of this leg: force and moment balance of every body and all constraints, scaled to
// order one.
//
// Unknowns x [7 nb + m]: per body (r - centre) / L and the quaternion (x, y, z, w), then the
// reactions R of the constraint rows over F, or F L where a row holds a direction. A step dx [n],
// n = 6 nb + m, has per body (δr / L, δπ) instead. Residuals E [n], in this order:
//
//   per body   Σ forces / F,  Σ moments about its origin / (F L)
//   per row    Φ / L, or Φ where it is a cosine
//
// L is the radius of the model about `centre`. F is the largest of the applied forces, the elastic
// forces in the design pose and the force of the stiffest element at a deformation of a hundredth
// of L. With this F the round-off of stiff elements stays well below the tolerance, for any driver,
// units and ground frame.
//
// Every quantity that a driver may move, static or not, is start + rate·a. So E is a function of
// (x, a), and ∂E/∂a comes from the same automatic differentiation as ∂E/∂x.
#pragma once

#include <memory>
#include <span>

#include "elastocheck/equilibrium_path.hpp"
#include "models/driven_inputs.hpp"
#include "reference/equilibrium/statement/equations.hpp"

namespace elastocheck::reference::equilibrium {

struct Affine {
    double start = 0, rate = 0;
    template <class T>
    T at(const T& a) const {
        return start + rate * a;
    }
};

// Driven quantities of an element along the branch, and what it stores.
struct ElementPath : DrivenElement<Affine> {
    // design force of the element, ∂u/∂x or ∂u/∂e + preload, of which held · stored is subtracted
    // while settling [N, N·m]
    Vector6 stored = Vector6::Zero();
    bool rotational = false;  // the bushing's forces depend on the relative rotation of its markers
};
using LoadPath = DrivenLoad<Affine>;

struct Pattern;  // of J (derivatives.hpp)

struct System {
    const Model* model = nullptr;
    const Branch* branch = nullptr;
    // per Model::constraints: its offset, length or angle [m, rad], if it has one
    std::vector<Affine> values;
    // per Model::constraints: from such an angle to its design value [rad], or 0
    std::vector<double> angle_gaps;
    std::vector<ElementPath> elements;                 // per Model::elastics
    std::vector<LoadPath> loads;                       // static and driven
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // [m], ground axes
    double length = 1;                                 // L [m]
    double force = 1;                                  // F [N]
    int bodies = 0;                                    // nb
    int constraint_rows = 0;                           // m
    bool conservative = true;                          // no follower, no formulation without energy
    bool grows = false;         // loads and element forces grow as `held` falls (settle.hpp)
    double hold = 0;            // ground springs have stiffness hold · held [F / L, F L]
    Eigen::VectorXd carried;    // reactions of the joints at the design pose [m]
    Eigen::VectorXd at_design;  // E there, at a = 0 [n]
    // computed with the first J; a system is not shared between threads
    mutable std::shared_ptr<const Pattern> pattern;

    int unknowns() const { return 7 * bodies + constraint_rows; }
    int equations() const { return 6 * bodies + constraint_rows; }
};

// Equation to be solved: E(x; a, held) = held · at_design. With held = 1 the design pose is an
// equilibrium. Towards held = 0 everything that is present at a = 0 is applied: static loads,
// preloads, held values of drivers, and constraints that the design pose does not satisfy
// (settle.hpp). A driven angle changes as value + held · turn: its row is a sine, and scaling the
// row instead would lead to the nearer of two opposite directions.
//
// `pieces`: piece of its curve for each deformation, per Model::elastics, so that E is smooth
// across knots; empty: the piece that contains the deformation.
using Pieces = std::vector<ElementPieces>;
struct Loading {
    double a = 0;
    double held = 0;                   // [-]
    double a_rate = 0, held_rate = 0;  // d/dt along the current stage
    Pieces pieces = {};
};

// `points` are values of a. Throws std::invalid_argument where model and branch do not fit, or a
// driver moves a quantity that its joint or element does not have.
System make_system(const Model& model, const Branch& branch, std::span<const double> points);

// E at the design pose, a = 0 and held = 1, without the term held · at_design.
Eigen::VectorXd held_at_design(const System& system);
// Design force of element e: ElementPath::stored.
Vector6 stored_at_design(const System& system, std::size_t e);

Frame<double> frame_of(const System& system, const Eigen::VectorXd& x, BodyId body);

Eigen::VectorXd design_unknowns(const System& system);
// Unknowns for these poses and zero reactions. Throws std::invalid_argument unless there is one
// pose per body.
Eigen::VectorXd unknowns_at(const System& system, const std::vector<Pose>& poses);
Eigen::VectorXd residual(const System& system, const Loading& loading, const Eigen::VectorXd& x);

Eigen::VectorXd moved(const System& system, const Eigen::VectorXd& x, const Eigen::VectorXd& dx);
Eigen::VectorXd step_between(const System& system, const Eigen::VectorXd& from,
                             const Eigen::VectorXd& to);

// The largest |δr| / L or |δπ| of a body, infinite when any entry is not finite.
double pose_size(const System& system, const Eigen::VectorXd& dx);
// largest absolute entry, NaN when any entry is not finite
double largest(const Eigen::VectorXd& E);

// Message about a bushing close to the singularity of its angles or of its middle frame: "bushing
// 'x' is rotated by half a turn, where its angles are undefined", or empty.
std::string bushing_without_angles(const System& system, const Eigen::VectorXd& x);

// "1500 N", "-40 mm": the branch's parameter in display units.
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

// e - e₀ of a bushing at a.
template <class T>
Vec6<T> deformed(const Bushing& bushing, const ElementPath& path, const T& a,
                 const RelativePose<T>& at) {
    Vec6<T> e = at.e - bushing.undeformed.cast<T>();
    e[2] -= path.free_length.at(a);
    return e;
}

// The frames of the two bodies of an element or constraint.
template <class T>
struct FramePair {
    const Frame<T>& i;
    const Frame<T>& j;
};

// Actions of element e on its two bodies.
template <class T>
InteractionPair<T> interaction(const System& system, std::size_t e, const T& a, const T& held,
                               const Pieces& pieces, const FramePair<T>& frames) {
    const ElementPath& path = system.elements[e];
    const ElementPieces& on = pieces.empty() ? all_by_themselves : pieces[e];
    return std::visit(
        overloaded{[&](const AxialSpring& spring) {
                       const T preload = system.grows ? T(-held * path.stored[0]) : T(0.0);
                       return interaction(spring, path.free_length.at(a), preload, on[0], frames.i,
                                          frames.j);
                   },
                   [&](const Bushing& bushing) {
                       Vec6<T> preload = preload_at(path, a);
                       if (system.grows)
                           for (int k = 0; k < 6; ++k) preload[k] -= held * path.stored[k];
                       const RelativePose<T> at =
                           relative_pose(bushing, path.rotational, frames.i, frames.j);
                       const Vec6<T> law =
                           gradient(bushing.law, deformed(bushing, path, a, at), on);
                       return interaction(bushing, at, Vec6<T>(law + preload), path.rotational);
                   }},
        system.model->elastics[e].kind);
}

// Deformation that enters the law of element e: ℓ - ℓ₀ as first entry, or e - e₀.
template <class T>
Vec6<T> deformations(const System& system, std::size_t e, const T& a, const Frame<T>& i,
                     const Frame<T>& j) {
    const ElementPath& path = system.elements[e];
    return std::visit(overloaded{[&](const AxialSpring& spring) {
                                     Vec6<T> x = Vec6<T>::Constant(T(0.0));
                                     x[0] = deformation(spring, path.free_length.at(a), i, j);
                                     return x;
                                 },
                                 [&](const Bushing& bushing) {
                                     return deformed(bushing, path, a,
                                                     relative_pose(bushing, path.rotational, i, j));
                                 }},
                      system.model->elastics[e].kind);
}

// Constraint c with the reactions R of its rows [N, N·m].
template <class T>
Holding<T> holding(const System& system, std::size_t c, const T& a, const T& held,
                   const FramePair<T>& frames, const T* R) {
    const T value = system.values[c].at(a) + held * system.angle_gaps[c];
    return std::visit([&](const auto& kind) { return holding(kind, value, frames.i, frames.j, R); },
                      system.model->constraints[c].kind);
}

// ---- Assembly, for double and for Jets

enum class Term { element, load, ground_spring, constraint };

// One term of the system: the bodies it couples, and its constraint rows, whose reactions enter.
struct Part {
    BodyId i = ground, j = ground;
    int row = 0, rows = 0;
    // whether its rows constrain directions: independent of the positions, with moments only
    bool directions = false;
    Term term = Term::element;
    std::size_t number = 0;  // its position among the terms of this kind
};

// Assembles the terms of all parts. `source.frame(part, which)` gives the frames of the part's two
// bodies, `source.reaction(part, k)` its scaled reactions; `sink.balance(part, body, force,
// moment)` and `sink.constraint(part, k, Phi)` take the scaled terms, to be summed. A source may
// leave out terms: `source.wants(term, k)`, k the position among its kind. It may have another
// source for elements between a body and the ground, in Jets of fewer derivatives:
// `source.of_one_body()`, with `narrowed` for the parameters.
template <class Source>
concept LeavesOut = requires(const Source& source) {
    source.wants(Term::element, std::size_t{});
};
template <class Source>
bool wants(const Source&, Term, std::size_t) {
    return true;
}
template <LeavesOut Source>
bool wants(const Source& source, Term term, std::size_t k) {
    return source.wants(term, k);
}
template <class Source>
concept HasOneOfOneBody = requires(const Source& source) {
    source.of_one_body();
};
template <class T, class Source, class Sink>
void assemble(const System& system, const T& a, const T& held, const Pieces& pieces,
              const Source& source, Sink& sink) {
    const Model& model = *system.model;
    const double per_force = 1 / system.force, per_moment = per_force / system.length,
                 per_length = 1 / system.length;

    const auto apply = [&]<class S>(const Part& part, BodyId body, const Frame<S>& frame,
                                    const Interaction<S>& on, const S& factor) {
        if (body == ground) return;
        const Vec3<S> moment = on.moment + cross(Vec3<S>(on.at - frame.r), on.force);
        sink.balance(part, body, Vec3<S>(on.force * S(factor * per_force)),
                     Vec3<S>(moment * S(factor * per_moment)));
    };
    const auto add_element = [&]<class S>(const Part& part, const auto& frames, const S& at,
                                          const S& at_held) {
        const Frame<S> frame_i = frames.frame(part, 0), frame_j = frames.frame(part, 1);
        const auto on = interaction(system, part.number, at, at_held, pieces, {frame_i, frame_j});
        apply(part, part.i, frame_i, on.i, S(+1.0));
        apply(part, part.j, frame_j, on.j, S(+1.0));
    };

    for (std::size_t e = 0; e < model.elastics.size(); ++e) {
        if (!wants(source, Term::element, e)) continue;
        const auto [i, j] = bodies_of(model.elastics[e].kind);
        const Part part{.i = i, .j = j, .term = Term::element, .number = e};
        if constexpr (HasOneOfOneBody<Source>)
            if (i == ground || j == ground) {
                const auto narrow = source.of_one_body();
                add_element(part, narrow, narrow.narrowed(a), narrow.narrowed(held));
                continue;
            }
        add_element(part, source, a, held);
    }
    for (std::size_t k = 0; k < system.loads.size(); ++k) {
        const auto& load = system.loads[k];
        const BodyId body = body_of(load.kind), with = acts_with(load.kind);
        const Part part{
            .i = body, .j = with == body ? ground : with, .term = Term::load, .number = k};
        if (body == ground || !wants(source, Term::load, k)) continue;
        const Frame<T> frame = source.frame(part, 0);
        const auto on = [&](const Frame<T>& at) {
            return std::visit([&](const auto& kind) { return on_body(kind, at); }, load.kind);
        };
        apply(part, body, frame, with == body ? on(frame) : on(source.frame(part, 1)),
              system.grows ? T(load.factor.at(a) * (1.0 - held)) : load.factor.at(a));
    }

    if (system.hold != 0)
        for (int body = 0; body < system.bodies; ++body) {
            if (!wants(source, Term::ground_spring, static_cast<std::size_t>(body))) continue;
            const Part part{
                .i = body, .term = Term::ground_spring, .number = static_cast<std::size_t>(body)};
            const Frame<T> frame = source.frame(part, 0);
            const Pose& drawn = model.bodies[static_cast<std::size_t>(body)].design;
            apply(
                part, body, frame,
                drawn_back(frame, Eigen::Vector3d(drawn.r - system.centre), drawn.p, system.length),
                T(held * (system.hold * system.force)));
        }

    for (std::size_t c = 0, row = 0; c < model.constraints.size(); ++c) {
        const auto& kind = model.constraints[c].kind;
        const int first = static_cast<int>(row);
        row += static_cast<std::size_t>(rows(kind));
        if (!wants(source, Term::constraint, c)) continue;
        const auto [i, j] = bodies_of(kind);
        const bool directions = is_direction(kind);
        const Part part{i, j, first, rows(kind), directions, Term::constraint, c};
        const Frame<T> frame_i = source.frame(part, 0), frame_j = source.frame(part, 1);
        T R[3];
        for (int k = 0; k < part.rows; ++k)
            R[k] = source.reaction(part, k) *
                   (directions ? system.force * system.length : system.force);
        const Holding<T> h = holding(system, c, a, held, {frame_i, frame_j}, R);
        apply(part, i, frame_i, h.reaction, T(+1.0));
        apply(part, j, frame_j, h.reaction, T(-1.0));
        for (int k = 0; k < part.rows; ++k)
            sink.constraint(part, k, T(h.Phi[k] * (directions ? 1.0 : per_length)));
    }
}

}  // namespace elastocheck::reference::equilibrium
