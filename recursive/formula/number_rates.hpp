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

template <class Real>
struct Carrier {
    const State<Real>& q;
    const Vector<Real>& dq;

    Vector3<Real> dr(BodyId b) const { return b == ground ? none() : part(b, 0); }
    Vector3<Real> dpi(BodyId b) const { return b == ground ? none() : part(b, 3); }
    Vector3<Real> lever(BodyId b, const Eigen::Vector3d& s, const Eigen::Vector3d& ds) const {
        return dpi(b).cross(q[b].lever(s)) + q[b].lever(ds);
    }
    Vector3<Real> lever(const Point& p, const Point& d) const {
        return lever(p.body, p.s_local, d.s_local);
    }
    Vector3<Real> direction(const Direction& u, const Direction& d) const {
        return lever(u.body, u.u_local, d.u_local);
    }
    // ω of a marker's axes.
    Vector3<Real> turn(const Marker& marker, const Marker& d) const {
        const Eigen::Quaterniond by = d.A_local * marker.A_local.conjugate();
        return dpi(marker.body) + q[marker.body].lever(2 * by.vec());
    }

  private:
    static Vector3<Real> none() { return Vector3<Real>::Zero(); }
    Vector3<Real> part(BodyId b, int at) const { return dq.template segment<3>(6 * b + at); }
};

// ---- Rows of Φ: the rate of every entry of a Row.

namespace detail {

// p_i - p_j
template <class Real>
Vector3<Real> between(const Carrier<Real>& by, const Point& i, const Point& j, const Point& di,
                      const Point& dj) {
    return by.dr(i.body) + by.lever(i, di) - by.dr(j.body) - by.lever(j, dj);
}
template <class Real>
Vector3<Real> between(const State<Real>& q, const Point& i, const Point& j) {
    return q[i.body].r + q[i.body].lever(i.s_local) - q[j.body].r - q[j.body].lever(j.s_local);
}

template <class Real, class Sink>
void row_rates(const CoincidentPoints& c, const CoincidentPoints& d, Real, Real,
               const Carrier<Real>& by, Sink&& sink) {
    const Vector3<Real> gap = between(by, c.i, c.j, d.i, d.j);
    Row<Real> row = at_rest<Real>();
    row.s_i = by.lever(c.i, d.i), row.s_j = by.lever(c.j, d.j);
    for (int k = 0; k < 3; ++k) row.Phi = gap[k], sink(row);
}

// n · D - c; the lever on j ends at p_i:  s_j + D = p_i - r_j
template <class Real, class Sink>
void row_rates(const PointInPlane& c, const PointInPlane& d, Real, Real dc, const Carrier<Real>& by,
               Sink&& sink) {
    const Vector3<Real> n = by.q[c.normal_j.body].lever(c.normal_j.u_local);
    const Vector3<Real> D = between(by.q, c.i, c.j), dD = between(by, c.i, c.j, d.i, d.j);
    Row<Real> row = at_rest<Real>();
    row.n = by.direction(c.normal_j, d.normal_j);
    row.Phi = row.n.dot(D) + n.dot(dD) - dc;
    row.s_i = by.lever(c.i, d.i);
    row.s_j = by.lever(c.j, d.j) + dD;
    sink(row);
}

template <class Real, class Sink>
void couple_rates(const Vector3<Real>& u, const Vector3<Real>& w, const Vector3<Real>& du,
                  const Vector3<Real>& dw, Sink&& sink) {
    Row<Real> row = at_rest<Real>();
    row.Phi = du.dot(w) + u.dot(dw);
    row.u = du.cross(w) + u.cross(dw);
    sink(row);
}
template <class Real, class Sink>
void row_rates(const PerpendicularDirections& c, const PerpendicularDirections& d, Real, Real,
               const Carrier<Real>& by, Sink&& sink) {
    couple_rates(by.q[c.i.body].lever(c.i.u_local), by.q[c.j.body].lever(c.j.u_local),
                 by.direction(c.i, d.i), by.direction(c.j, d.j), sink);
}

// (D·D - c²) / 2c,  n = D / c
template <class Real, class Sink>
void row_rates(const DistanceBetween& c, const DistanceBetween& d, Real length, Real dlength,
               const Carrier<Real>& by, Sink&& sink) {
    const Vector3<Real> D = between(by.q, c.i, c.j), dD = between(by, c.i, c.j, d.i, d.j);
    Row<Real> row = at_rest<Real>();
    row.Phi = (D.dot(dD) - (D.dot(D) / length + length) / 2 * dlength) / length;
    row.n = (dD - D * (dlength / length)) / length;
    row.s_i = by.lever(c.i, d.i), row.s_j = by.lever(c.j, d.j);
    sink(row);
}

// u_i · w,  w = cos α y_j - sin α x_j
template <class Real, class Sink>
void row_rates(const DirectionAtAngle& c, const DirectionAtAngle& d, Real angle, Real dangle,
               const Carrier<Real>& by, Sink&& sink) {
    using std::cos;
    using std::sin;
    const Real cosine = cos(angle), sine = sin(angle);
    const Vector3<Real> x = by.q[c.j.body].lever(c.j.u_local),
                        y = by.q[c.y_j.body].lever(c.y_j.u_local);
    const Vector3<Real> dw = cosine * by.direction(c.y_j, d.y_j) - sine * by.direction(c.j, d.j) -
                             dangle * (sine * y + cosine * x);
    couple_rates(by.q[c.i.body].lever(c.i.u_local), across(c, angle, by.q), by.direction(c.i, d.i),
                 dw, sink);
}

}  // namespace detail

// Calls sink(row number, row, its rate) for all rows of the model.
template <class Real, class Sink>
void for_each_row_change(const Model& model, const Inputs<Real>& inputs, const Model& rate,
                         const Inputs<Real>& input_rate, const Carrier<Real>& by, Sink&& sink) {
    std::array<Row<Real>, 3> row;
    for (std::size_t c = 0; c < model.constraints.size(); ++c) {
        std::size_t count = 0;
        rows<Real>(model.constraints[c].kind, inputs.offset[c], by.q,
                   [&](const Row<Real>& at) { row[count++] = at; });
        std::size_t k = 0;
        std::visit(
            [&]<class Kind>(const Kind& kind) {
                detail::row_rates<Real>(
                    kind, std::get<Kind>(rate.constraints[c].kind), inputs.offset[c],
                    input_rate.offset[c], by, [&](const Row<Real>& change) {
                        sink(inputs.row[c] + static_cast<int>(k), c, row[k], change);
                        ++k;
                    });
            },
            model.constraints[c].kind);
    }
}

// ---- Laws: the change of the force at a constant deformation x.

template <class Real>
Real gradient_rate(const LinearRate&, const LinearRate& d, Real x, Piece) {
    return static_cast<Real>(d.k) * x;
}
// f = Σ c_n tⁿ, t = x - x_k: the coefficients and the knot change.
template <class Real>
Real gradient_rate(const Curve& f, const Curve& d, Real x, Piece piece) {
    const auto k = static_cast<std::size_t>(piece == wherever ? piece_at(f, x) : piece);
    const Cubic<Real> on = piece_of<Real>(f, x, static_cast<Piece>(k));
    return Cubic<Real>{d.pieces[k], on.t}.value() -
           on.slope() * static_cast<Real>(d.knots[k == 0 ? 0 : k - 1]);
}
template <class Real>
Real gradient_rate(const ScalarLaw& law, const ScalarLaw& d, Real x, Piece piece) {
    return std::visit(
        [&]<class Law>(const Law& kind) {
            return gradient_rate<Real>(kind, std::get<Law>(d), x, piece);
        },
        law);
}
template <class Real>
Vector6<Real> gradient_rate(const LinearStiffness&, const LinearStiffness& d,
                            const Vector6<Real>& e, const Pieces&) {
    return d.K.template cast<Real>() * e;
}
template <class Real>
Vector6<Real> gradient_rate(const PerAxis& law, const PerAxis& d, const Vector6<Real>& e,
                            const Pieces& pieces) {
    Vector6<Real> stress;
    for (std::size_t k = 0; k < 6; ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        stress[at] = gradient_rate<Real>(law.axis[k], d.axis[k], e[at], pieces[k]);
    }
    return stress;
}
template <class Real>
Vector6<Real> gradient_rate(const SpatialLaw& law, const SpatialLaw& d, const Vector6<Real>& e,
                            const Pieces& pieces) {
    return std::visit(
        [&]<class Law>(const Law& kind) {
            return gradient_rate<Real>(kind, std::get<Law>(d), e, pieces);
        },
        law);
}

// ---- Elements: (F, M) on body j and its levers, and the rates of the four.

template <class Real>
struct ElementChange {
    ElementForce<Real> force, rate;
};

// F = t n, t = u'(ℓ - ℓ₀):  δF = (u'' n nᵀ + t/ℓ (I - n nᵀ)) δD + (δu' - u'' δℓ₀) n
template <class Real>
ElementChange<Real> change_of(const AxialSpring& e, const AxialSpring& d, const Rest<Real>& rest,
                              const Rest<Real>& drest, const Carrier<Real>& by) {
    const auto [s_i, s_j, D, length] = deformation<Real>(e, by.q);
    const Vector3<Real> n = D / length, ds_i = by.lever(e.i, d.i), ds_j = by.lever(e.j, d.j),
                        dD = by.dr(e.j.body) + ds_j - by.dr(e.i.body) - ds_i;
    const Real x = length - rest.free_length, t = gradient<Real>(e.law, x, rest.piece[0]),
               stiffness = hessian<Real>(
                   e.law, [x = x] { return x; }, rest.piece[0]);
    const Real dt = stiffness * (n.dot(dD) - drest.free_length) +
                    gradient_rate<Real>(e.law, d.law, x, rest.piece[0]);
    const Vector3<Real> none = Vector3<Real>::Zero();
    return {{t * n, none, s_i, s_j},
            {dt * n + t / length * (dD - n * n.dot(dD)), none, ds_i, ds_j}};
}

// F = A_i F_x, M = A_i M_φ of (x, B) (tangent.hpp), here with
//   δx = A_iᵀ (δp_j - δp_i - ω_i × D),   δφ = A_iᵀ (ω_j - ω_i),   δF = A_i δF_x + ω_i × F
// and the stress σ = u'(e - e₀) + preload changing by δu' - u'' δe₀ + δpreload besides.
template <class Real>
ElementChange<Real> change_of(const Bushing& e, const Bushing& d, const Rest<Real>& rest,
                              const Rest<Real>& drest, const Carrier<Real>& by) {
    const Spatial<Real> g = deformation<Real>(e, by.q);
    const Vector6<Real> answered = strain<Real>(e, g);
    const Matrix6<Real> K = hessian<Real>(
        e.law, [&] { return answered; }, rest.piece);
    const Vector6<Real> stress = gradient<Real>(e.law, answered, rest.piece) + rest.preload;
    const Matrix3<Real> H = jacobian<Real>(e.formulation.angles, g.B, g.theta());
    const Matrix6<Real> E = detail::strain_rate<Real>(e, g, H);
    Matrix6<Real> through = E;
    if (!e.formulation.conjugate) through.setIdentity();
    if (!e.formulation.offset_moment) through.template topRightCorner<3, 3>().setZero();

    const auto lever = [&](const Marker& m, const Marker& dm) {
        return by.lever(m.body, m.s_local, dm.s_local);
    };
    const Vector3<Real> ds_i = lever(e.i, d.i), ds_j = lever(e.j, d.j),
                        dp_i = by.dr(e.i.body) + ds_i, dp_j = by.dr(e.j.body) + ds_j,
                        turn_i = by.turn(e.i, d.i), turn_j = by.turn(e.j, d.j);
    Vector6<Real> moved;
    moved << g.A_i.transpose() * (dp_j - dp_i - turn_i.cross(g.D)),
        g.A_i.transpose() * (turn_j - turn_i);
    const Vector6<Real> dstress = gradient_rate<Real>(e.law, d.law, answered, rest.piece) -
                                  K * d.undeformed.template cast<Real>() + drest.preload;
    const Vector6<Real> local = through.transpose() * stress,
                        dlocal = through.transpose() * (K * (E * moved) + dstress) +
                                 detail::turning_stress<Real>(e, g, H, E, stress) * moved;
    ElementChange<Real> change;
    ElementForce<Real>&force = change.force, &rate = change.rate;
    force = {g.A_i * local.template head<3>(), g.A_i * local.template tail<3>(), g.s_i, g.s_j};
    rate = {g.A_i * dlocal.template head<3>() + turn_i.cross(force.F),
            g.A_i * dlocal.template tail<3>() + turn_i.cross(force.M), ds_i, ds_j};
    if (e.formulation.offset_moment) force.lever_i += g.D, rate.lever_i += dp_j - dp_i;
    return change;
}

// ---- ∂/∂m of the right-hand side (-G, -Φ), G = f_elast + Φ_qᵀ λ - f_ext, at (q, λ) and a.

inline constexpr double last_digits = 64 * std::numeric_limits<double>::epsilon();

template <class Real>
struct NumberRates {
    Vector<Real> upper, lower;
};

namespace detail {

// The change of factor · load: of its vector f, which a follower turns, and of its lever.
template <class Real>
void add_load_change(const LoadKind& load, const LoadKind& d, Real factor, Real dfactor,
                     const Carrier<Real>& by, Vector<Real>& upper) {
    const auto vector = [&](const Eigen::Vector3d& f, const Eigen::Vector3d& df) {
        return std::pair<Vector3<Real>, Vector3<Real>>(
            factor * f.cast<Real>(), dfactor * f.cast<Real>() + factor * df.cast<Real>());
    };
    const auto follower = [&](BodyId b, const Eigen::Vector3d& f, const Eigen::Vector3d& df) {
        const Vector3<Real> turned = by.q[b].lever(f);
        return std::pair<Vector3<Real>, Vector3<Real>>(
            factor * turned, dfactor * turned + factor * by.lever(b, f, df));
    };
    const auto add_force = [&](const Point& at, const Point& dat, const auto& force) {
        const auto& [F, dF] = force;
        const Vector3<Real> s = by.q[at.body].lever(at.s_local), ds = by.lever(at, dat);
        upper.template segment<3>(6 * at.body) += dF;
        upper.template segment<3>(6 * at.body + 3) += ds.cross(F) + s.cross(dF);
    };
    const auto add_moment = [&](BodyId b, const auto& moment) {
        upper.template segment<3>(6 * b + 3) += moment.second;
    };
    std::visit(
        overloaded{[&](const DeadForce& l) {
                       const auto& change = std::get<DeadForce>(d);
                       add_force(l.at, change.at, vector(l.f, change.f));
                   },
                   [&](const FollowerForce& l) {
                       const auto& change = std::get<FollowerForce>(d);
                       add_force(l.at, change.at, follower(l.at.body, l.f_local, change.f_local));
                   },
                   [&](const DeadMoment& l) {
                       add_moment(l.body, vector(l.m, std::get<DeadMoment>(d).m));
                   },
                   [&](const FollowerMoment& l) {
                       add_moment(l.body,
                                  follower(l.body, l.m_local, std::get<FollowerMoment>(d).m_local));
                   }},
        load);
}

}  // namespace detail

template <class Real>
NumberRates<Real> number_rates(const Model& model, const Branch& branch, const Inputs<Real>& inputs,
                               const Model& rate, const Branch& branch_rate,
                               const Inputs<Real>& input_rate, const State<Real>& q,
                               const Vector<Real>& lambda) {
    const Vector<Real> still = Vector<Real>::Zero(coordinates(model));
    const Carrier<Real> by{q, still};
    NumberRates<Real> sum{still, Vector<Real>::Zero(constraint_rows(model))};
    for (std::size_t k = 0; k < model.static_loads.size(); ++k)
        detail::add_load_change<Real>(model.static_loads[k].kind, rate.static_loads[k].kind,
                                      Real(1), Real(0), by, sum.upper);
    for (std::size_t k = 0; k < branch.drivers.size(); ++k)
        if (const Load* load = driven_load(branch.drivers[k].what))
            detail::add_load_change<Real>(
                load->kind, driven_load(branch_rate.drivers[k].what)->kind, inputs.load_factor[k],
                input_rate.load_factor[k], by, sum.upper);

    const auto add = [&](BodyId b, Real sign, const Vector3<Real>& F, const Vector3<Real>& M) {
        if (b == ground) return;
        sum.upper.template segment<3>(6 * b) += sign * F;
        sum.upper.template segment<3>(6 * b + 3) += sign * M;
    };
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const auto [force, change] = std::visit(
            [&]<class Kind>(const Kind& kind) {
                return change_of<Real>(kind, std::get<Kind>(rate.elastics[k].kind), inputs.rest[k],
                                       input_rate.rest[k], by);
            },
            model.elastics[k].kind);
        const auto moment = [&](const Vector3<Real>& s, const Vector3<Real>& ds) {
            return Vector3<Real>(ds.cross(force.F) + s.cross(change.F) + change.M);
        };
        const auto [i, j] = bodies_of(model.elastics[k].kind);
        add(j, -1, change.F, moment(force.lever_j, change.lever_j));
        add(i, +1, change.F, moment(force.lever_i, change.lever_i));
    }
    for_each_row_change(
        model, inputs, rate, input_rate, by,
        [&](int k, std::size_t c, const Row<Real>& row, const Row<Real>& change) {
            // Points and lengths that change together keep a row closed: what is left is rounding.
            sum.lower[k] = -change.Phi;
            if constexpr (std::is_same_v<Real, double>) {
                const double size = change.s_i.norm() + change.s_j.norm() + change.u.norm() +
                                    std::abs(input_rate.offset[c]);
                if (std::abs(change.Phi) <= last_digits * size) sum.lower[k] = 0;
            }
            const auto moment = [&](const Vector3<Real>& s, const Vector3<Real>& ds) {
                return Vector3<Real>(ds.cross(row.n) + s.cross(change.n) + change.u);
            };
            add(row.i, -lambda[k], change.n, moment(row.s_i, change.s_i));
            add(row.j, lambda[k], change.n, moment(row.s_j, change.s_j));
        });
    return sum;
}

// Rates of the joint wrenches (reactions.hpp) where the state changes by (dq, dλ) too.
inline std::vector<Wrench> wrench_rates(const Model& model, const Inputs<double>& inputs,
                                        const Model& rate, const Inputs<double>& input_rate,
                                        const Carrier<double>& by, const Vector<double>& lambda,
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
