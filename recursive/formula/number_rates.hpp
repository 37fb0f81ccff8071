// Derivatives of balance and Φ by the numbers of the model: hardpoints, axes, laws, loads.
//
// A number changes the model by `rate`, a Model of the same shape (models/state_rate.hpp). A vector
// that is fixed in a body, u = A u', and a marker's axes A_i = A A_i' change by
//
//   δu = δπ × u + A δu',      δA_i = ω̃ A_i,  ω = δπ + A ω',  ω' = 2 (δA_i' A_i'⁻¹) as quaternions
//
// The functions of this file follow these changes through the formulas of constraints.hpp,
// elastic.hpp and loads.hpp, step by step.
#pragma once

#include "recursive/formula/constraints.hpp"
#include "recursive/formula/elastic.hpp"
#include "recursive/formula/loads.hpp"
#include "recursive/formula/tangent.hpp"

namespace elastocheck::recursive {

// ---- Rates of the inputs (inputs.hpp) at the parameter a, after settling.

inline Inputs<double> input_rates(const Model& model, const Branch& branch, const Model& rate,
                                  const Branch& branch_rate, double a) {
    Inputs<double> rates = inputs_as_drawn<double>(rate);
    rates.load_factor.assign(branch.drivers.size(), 0);
    for (std::size_t k = 0; k < branch.drivers.size(); ++k) {
        const Driver &driver = branch.drivers[k], &change = branch_rate.drivers[k];
        const double by = driver.start + a * driver.rate, dby = change.start + a * change.rate;
        std::visit(
            overloaded{[&](const Load&) { rates.load_factor[k] = dby; },
                       [&](const Motion& m) { rates.offset[constraint_of(model, m)] += dby; },
                       [&](const FreeLength& f) {
                           rates.rest[static_cast<std::size_t>(f.elastic)].free_length += dby;
                       },
                       [&](const Preload& p) {
                           rates.rest[static_cast<std::size_t>(p.elastic)].preload +=
                               dby * p.direction + by * std::get<Preload>(change.what).direction;
                       }},
            driver.what);
    }
    return rates;
}

// ---- Rates of what bodies carry. `dq` [6nb] is a motion of the bodies, zero for ∂/∂m alone.

struct Carrier {
    const State<double>& q;
    const Vector<double>& dq;

    Vector3<double> dr(BodyId b) const { return b == ground ? none() : part(b, 0); }
    Vector3<double> dpi(BodyId b) const { return b == ground ? none() : part(b, 3); }
    Vector3<double> lever(BodyId b, const Eigen::Vector3d& s, const Eigen::Vector3d& ds) const {
        return dpi(b).cross(q[b].lever(s)) + q[b].lever(ds);
    }
    Vector3<double> lever(const Point& p, const Point& d) const {
        return lever(p.body, p.s_local, d.s_local);
    }
    Vector3<double> direction(const Direction& u, const Direction& d) const {
        return lever(u.body, u.u_local, d.u_local);
    }
    // ω of a marker's axes.
    Vector3<double> turn(const Marker& marker, const Marker& d) const {
        const Eigen::Quaterniond by = d.A_local * marker.A_local.conjugate();
        return dpi(marker.body) + q[marker.body].lever(2 * by.vec());
    }

  private:
    static Vector3<double> none() { return Vector3<double>::Zero(); }
    Vector3<double> part(BodyId b, int at) const { return dq.segment<3>(6 * b + at); }
};

// ---- Rows of Φ: the rate of every entry of a Row.

namespace detail {

// p_i - p_j
inline Vector3<double> between(const Carrier& by, const Point& i, const Point& j, const Point& di,
                               const Point& dj) {
    return by.dr(i.body) + by.lever(i, di) - by.dr(j.body) - by.lever(j, dj);
}
inline Vector3<double> between(const State<double>& q, const Point& i, const Point& j) {
    return q[i.body].r + q[i.body].lever(i.s_local) - q[j.body].r - q[j.body].lever(j.s_local);
}

template <class Sink>
void row_rates(const CoincidentPoints& c, const CoincidentPoints& d, double, double,
               const Carrier& by, Sink&& sink) {
    const Vector3<double> gap = between(by, c.i, c.j, d.i, d.j);
    Row<double> row = at_rest<double>();
    row.s_i = by.lever(c.i, d.i), row.s_j = by.lever(c.j, d.j);
    for (int k = 0; k < 3; ++k) row.Phi = gap[k], sink(row);
}

// n · D - c; the lever on j ends at p_i:  s_j + D = p_i - r_j
template <class Sink>
void row_rates(const PointInPlane& c, const PointInPlane& d, double, double dc, const Carrier& by,
               Sink&& sink) {
    const Vector3<double> n = by.q[c.normal_j.body].lever(c.normal_j.u_local);
    const Vector3<double> D = between(by.q, c.i, c.j), dD = between(by, c.i, c.j, d.i, d.j);
    Row<double> row = at_rest<double>();
    row.n = by.direction(c.normal_j, d.normal_j);
    row.Phi = row.n.dot(D) + n.dot(dD) - dc;
    row.s_i = by.lever(c.i, d.i);
    row.s_j = by.lever(c.j, d.j) + dD;
    sink(row);
}

template <class Sink>
void couple_rates(const Vector3<double>& u, const Vector3<double>& w, const Vector3<double>& du,
                  const Vector3<double>& dw, Sink&& sink) {
    Row<double> row = at_rest<double>();
    row.Phi = du.dot(w) + u.dot(dw);
    row.u = du.cross(w) + u.cross(dw);
    sink(row);
}
template <class Sink>
void row_rates(const PerpendicularDirections& c, const PerpendicularDirections& d, double, double,
               const Carrier& by, Sink&& sink) {
    couple_rates(by.q[c.i.body].lever(c.i.u_local), by.q[c.j.body].lever(c.j.u_local),
                 by.direction(c.i, d.i), by.direction(c.j, d.j), sink);
}

// (D·D - c²) / 2c,  n = D / c
template <class Sink>
void row_rates(const DistanceBetween& c, const DistanceBetween& d, double length, double dlength,
               const Carrier& by, Sink&& sink) {
    const Vector3<double> D = between(by.q, c.i, c.j), dD = between(by, c.i, c.j, d.i, d.j);
    Row<double> row = at_rest<double>();
    row.Phi = (D.dot(dD) - (D.dot(D) / length + length) / 2 * dlength) / length;
    row.n = (dD - D * (dlength / length)) / length;
    row.s_i = by.lever(c.i, d.i), row.s_j = by.lever(c.j, d.j);
    sink(row);
}

// u_i · w,  w = cos α y_j - sin α x_j
template <class Sink>
void row_rates(const DirectionAtAngle& c, const DirectionAtAngle& d, double angle, double dangle,
               const Carrier& by, Sink&& sink) {
    const double cosine = std::cos(angle), sine = std::sin(angle);
    const Vector3<double> x = by.q[c.j.body].lever(c.j.u_local),
                          y = by.q[c.y_j.body].lever(c.y_j.u_local);
    const Vector3<double> dw = cosine * by.direction(c.y_j, d.y_j) - sine * by.direction(c.j, d.j) -
                               dangle * (sine * y + cosine * x);
    couple_rates(by.q[c.i.body].lever(c.i.u_local), across(c, angle, by.q), by.direction(c.i, d.i),
                 dw, sink);
}

}  // namespace detail

// Calls sink(row number, row, its rate) for all rows of the model.
template <class Sink>
void for_each_row_change(const Model& model, const Inputs<double>& inputs, const Model& rate,
                         const Inputs<double>& input_rate, const Carrier& by, Sink&& sink) {
    std::array<Row<double>, 3> row;
    for (std::size_t c = 0; c < model.constraints.size(); ++c) {
        std::size_t count = 0;
        rows<double>(model.constraints[c].kind, inputs.offset[c], by.q,
                     [&](const Row<double>& at) { row[count++] = at; });
        std::size_t k = 0;
        std::visit(
            [&]<class Kind>(const Kind& kind) {
                detail::row_rates(kind, std::get<Kind>(rate.constraints[c].kind), inputs.offset[c],
                                  input_rate.offset[c], by, [&](const Row<double>& change) {
                                      sink(inputs.row[c] + static_cast<int>(k), c, row[k], change);
                                      ++k;
                                  });
            },
            model.constraints[c].kind);
    }
}

// ---- Laws: the change of the force at a constant deformation x.

inline double gradient_rate(const LinearRate&, const LinearRate& d, double x, Piece) {
    return d.k * x;
}
// f = Σ c_n tⁿ, t = x - x_k: the coefficients and the knot change.
inline double gradient_rate(const Curve& f, const Curve& d, double x, Piece piece) {
    const auto k = static_cast<std::size_t>(piece == wherever ? piece_at(f, x) : piece);
    const Cubic<double> on = piece_of<double>(f, x, static_cast<Piece>(k));
    return Cubic<double>{d.pieces[k], on.t}.value() - on.slope() * d.knots[k == 0 ? 0 : k - 1];
}
inline double gradient_rate(const ScalarLaw& law, const ScalarLaw& d, double x, Piece piece) {
    return std::visit(
        [&]<class Law>(const Law& kind) { return gradient_rate(kind, std::get<Law>(d), x, piece); },
        law);
}
inline Vector6<double> gradient_rate(const LinearStiffness&, const LinearStiffness& d,
                                     const Vector6<double>& e, const Pieces&) {
    return d.K * e;
}
inline Vector6<double> gradient_rate(const PerAxis& law, const PerAxis& d, const Vector6<double>& e,
                                     const Pieces& pieces) {
    Vector6<double> stress;
    for (std::size_t k = 0; k < 6; ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        stress[at] = gradient_rate(law.axis[k], d.axis[k], e[at], pieces[k]);
    }
    return stress;
}
inline Vector6<double> gradient_rate(const SpatialLaw& law, const SpatialLaw& d,
                                     const Vector6<double>& e, const Pieces& pieces) {
    return std::visit(
        [&]<class Law>(const Law& kind) {
            return gradient_rate(kind, std::get<Law>(d), e, pieces);
        },
        law);
}

// ---- Elements: (F, M) on body j and its levers, and the rates of the four.

struct ElementChange {
    ElementForce<double> force, rate;
};

// F = t n, t = u'(ℓ - ℓ₀):  δF = (u'' n nᵀ + t/ℓ (I - n nᵀ)) δD + (δu' - u'' δℓ₀) n
inline ElementChange change_of(const AxialSpring& e, const AxialSpring& d, const Rest<double>& rest,
                               const Rest<double>& drest, const Carrier& by) {
    const auto [s_i, s_j, D, length] = deformation<double>(e, by.q);
    const Vector3<double> n = D / length, ds_i = by.lever(e.i, d.i), ds_j = by.lever(e.j, d.j),
                          dD = by.dr(e.j.body) + ds_j - by.dr(e.i.body) - ds_i;
    const double x = length - rest.free_length, t = gradient<double>(e.law, x, rest.piece[0]),
                 stiffness = hessian<double>(
                     e.law, [x] { return x; }, rest.piece[0]);
    const double dt =
        stiffness * (n.dot(dD) - drest.free_length) + gradient_rate(e.law, d.law, x, rest.piece[0]);
    const Vector3<double> none = Vector3<double>::Zero();
    return {{t * n, none, s_i, s_j},
            {dt * n + t / length * (dD - n * n.dot(dD)), none, ds_i, ds_j}};
}

// F = A_i F_x, M = A_i M_φ of (x, B) (tangent.hpp), here with
//   δx = A_iᵀ (δp_j - δp_i - ω_i × D),   δφ = A_iᵀ (ω_j - ω_i),   δF = A_i δF_x + ω_i × F
// and the stress σ = u'(e - e₀) + preload changing by δu' - u'' δe₀ + δpreload besides.
inline ElementChange change_of(const Bushing& e, const Bushing& d, const Rest<double>& rest,
                               const Rest<double>& drest, const Carrier& by) {
    const Spatial<double> g = deformation<double>(e, by.q);
    const Vector6<double> answered = strain<double>(e, g);
    const Matrix6<double> K = hessian<double>(
        e.law, [&] { return answered; }, rest.piece);
    const Vector6<double> stress = gradient<double>(e.law, answered, rest.piece) + rest.preload;
    const Matrix3<double> H = jacobian<double>(e.formulation.angles, g.B, g.theta());
    const Matrix6<double> E = detail::strain_rate<double>(e, g, H);
    Matrix6<double> through = E;
    if (!e.formulation.conjugate) through.setIdentity();
    if (!e.formulation.offset_moment) through.topRightCorner<3, 3>().setZero();

    const auto lever = [&](const Marker& m, const Marker& dm) {
        return by.lever(m.body, m.s_local, dm.s_local);
    };
    const Vector3<double> ds_i = lever(e.i, d.i), ds_j = lever(e.j, d.j),
                          dp_i = by.dr(e.i.body) + ds_i, dp_j = by.dr(e.j.body) + ds_j,
                          turn_i = by.turn(e.i, d.i), turn_j = by.turn(e.j, d.j);
    Vector6<double> moved;
    moved << g.A_i.transpose() * (dp_j - dp_i - turn_i.cross(g.D)),
        g.A_i.transpose() * (turn_j - turn_i);
    const Vector6<double> dstress =
        gradient_rate(e.law, d.law, answered, rest.piece) - K * d.undeformed + drest.preload;
    const Vector6<double> local = through.transpose() * stress,
                          dlocal = through.transpose() * (K * (E * moved) + dstress) +
                                   detail::turning_stress<double>(e, g, H, E, stress) * moved;
    ElementChange change;
    ElementForce<double>&force = change.force, &rate = change.rate;
    force = {g.A_i * local.head<3>(), g.A_i * local.tail<3>(), g.s_i, g.s_j};
    rate = {g.A_i * dlocal.head<3>() + turn_i.cross(force.F),
            g.A_i * dlocal.tail<3>() + turn_i.cross(force.M), ds_i, ds_j};
    if (e.formulation.offset_moment) force.lever_i += g.D, rate.lever_i += dp_j - dp_i;
    return change;
}

// ---- ∂/∂m of the right-hand side (-G, -Φ), G = f_elast + Φ_qᵀ λ - f_ext, at (q, λ) and a.

inline constexpr double last_digits = 64 * std::numeric_limits<double>::epsilon();

struct NumberRates {
    Vector<double> upper, lower;
};

namespace detail {

inline void add_load_change(const LoadKind& load, const LoadKind& d, double factor, double dfactor,
                            const State<double>& q, Vector<double>& f) {
    add_load<double>(load, dfactor, q, f);
    add_load<double>(d, factor, q, f);  // δf at the lever of the rate
    // δ(s × f) = δs × f + s × δf
    const auto at_levers = [&](const Point& at, const Point& by, const Vector3<double>& force,
                               const Vector3<double>& dforce) {
        const BodyState<double>& body = q[at.body];
        const Vector3<double> s = body.lever(at.s_local), ds = body.lever(by.s_local);
        f.segment<3>(6 * at.body + 3) +=
            factor * (ds.cross(force) + s.cross(dforce) - ds.cross(dforce));
    };
    std::visit(overloaded{[&](const DeadForce& l) {
                              const auto& change = std::get<DeadForce>(d);
                              at_levers(l.at, change.at, l.f, change.f);
                          },
                          [&](const FollowerForce& l) {
                              const auto& change = std::get<FollowerForce>(d);
                              at_levers(l.at, change.at, q[l.at.body].lever(l.f_local),
                                        q[l.at.body].lever(change.f_local));
                          },
                          [](const DeadMoment&) {}, [](const FollowerMoment&) {}},
               load);
}

}  // namespace detail

inline NumberRates number_rates(const Model& model, const Branch& branch,
                                const Inputs<double>& inputs, const Model& rate,
                                const Branch& branch_rate, const Inputs<double>& input_rate,
                                const State<double>& q, const Vector<double>& lambda) {
    const Vector<double> still = Vector<double>::Zero(coordinates(model));
    const Carrier by{q, still};
    NumberRates sum{still, Vector<double>::Zero(constraint_rows(model))};
    for (std::size_t k = 0; k < model.static_loads.size(); ++k)
        detail::add_load_change(model.static_loads[k].kind, rate.static_loads[k].kind, 1, 0, q,
                                sum.upper);
    for (std::size_t k = 0; k < branch.drivers.size(); ++k)
        if (const Load* load = driven_load(branch.drivers[k].what))
            detail::add_load_change(load->kind, driven_load(branch_rate.drivers[k].what)->kind,
                                    inputs.load_factor[k], input_rate.load_factor[k], q, sum.upper);

    const auto add = [&](BodyId b, double sign, const Vector3<double>& F,
                         const Vector3<double>& M) {
        if (b == ground) return;
        sum.upper.segment<3>(6 * b) += sign * F;
        sum.upper.segment<3>(6 * b + 3) += sign * M;
    };
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const auto [force, change] = std::visit(
            [&]<class Kind>(const Kind& kind) {
                return change_of(kind, std::get<Kind>(rate.elastics[k].kind), inputs.rest[k],
                                 input_rate.rest[k], by);
            },
            model.elastics[k].kind);
        const auto moment = [&](const Vector3<double>& s, const Vector3<double>& ds) {
            return Vector3<double>(ds.cross(force.F) + s.cross(change.F) + change.M);
        };
        const auto [i, j] = bodies_of(model.elastics[k].kind);
        add(j, -1, change.F, moment(force.lever_j, change.lever_j));
        add(i, +1, change.F, moment(force.lever_i, change.lever_i));
    }
    for_each_row_change(
        model, inputs, rate, input_rate, by,
        [&](int k, std::size_t c, const Row<double>& row, const Row<double>& change) {
            // Points and lengths that change together keep a row closed: what is left is rounding.
            const double size = change.s_i.norm() + change.s_j.norm() + change.u.norm() +
                                std::abs(input_rate.offset[c]);
            sum.lower[k] = std::abs(change.Phi) <= last_digits * size ? 0 : -change.Phi;
            const auto moment = [&](const Vector3<double>& s, const Vector3<double>& ds) {
                return Vector3<double>(ds.cross(row.n) + s.cross(change.n) + change.u);
            };
            add(row.i, -lambda[k], change.n, moment(row.s_i, change.s_i));
            add(row.j, +lambda[k], change.n, moment(row.s_j, change.s_j));
        });
    return sum;
}

// Rates of the joint wrenches (reactions.hpp) where the state changes by (dq, dλ) too.
inline std::vector<Wrench> wrench_rates(const Model& model, const Inputs<double>& inputs,
                                        const Model& rate, const Inputs<double>& input_rate,
                                        const Carrier& by, const Vector<double>& lambda,
                                        const Vector<double>& dlambda) {
    std::vector<Wrench> rates(model.joints.size());
    for_each_row_change(
        model, inputs, rate, input_rate, by,
        [&](int k, std::size_t c, const Row<double>& row, const Row<double>& change) {
            const auto at = static_cast<std::size_t>(model.constraints[c].joint);
            const ModelJoint& joint = model.joints[at];
            const Vector3<double> s = by.q[joint.i].lever(joint.at.s_local),
                                  ds = by.lever(joint.i, joint.at.s_local,
                                                rate.joints[at].at.s_local);
            const bool on_i = row.i == joint.i;
            const double pull = on_i ? -lambda[k] : lambda[k],
                         dpull = on_i ? -dlambda[k] : dlambda[k];
            const Vector3<double> F = pull * row.n, dF = dpull * row.n + pull * change.n,
                                  arm = (on_i ? row.s_i : row.s_j) - s,
                                  darm = (on_i ? change.s_i : change.s_j) - ds;
            rates[at].force += dF;
            rates[at].moment += darm.cross(F) + arm.cross(dF) + dpull * row.u + pull * change.u;
        });
    return rates;
}

}  // namespace elastocheck::recursive
