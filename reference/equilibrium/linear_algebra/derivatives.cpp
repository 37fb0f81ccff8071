#include "reference/equilibrium/linear_algebra/derivatives.hpp"

#include <ceres/jet.h>

#include <algorithm>
#include <limits>

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::VectorXd;

// A term of the system depends on two bodies, at most three reactions and the parameter:
// 6 + 6 + 3 + 1 derivatives. An element between a body and the ground depends on the body and the
// parameter: 6 + 1, and one more for an even number.
constexpr int of_two = 16, of_one = 8, first_reaction = 12;
template <int N>
using JetOf = ceres::Jet<double, N>;
using Jet = JetOf<of_two>;

// The parameter is the last.
template <int N>
auto& by_parameter(JetOf<N>& term) {
    return term.v[N - 1];
}
template <int N>
double by_parameter(const JetOf<N>& term) {
    return term.v[N - 1];
}
// The n-th of the derivatives of a term of two bodies.
template <int N>
double derivative(const JetOf<N>& term, int n) {
    return term.v[N == of_two ? n : n % 6];
}

// A u with its derivatives by the step (δr / L, δπ) of the body (`Seeds`): δ(A u) = δπ × A u.
template <int N>
Vec3<JetOf<N>> turning(const Frame<JetOf<N>>& body, const Eigen::Vector3d& u_local) {
    const auto& p = body.p;
    const Eigen::Vector3d u =
        turned(Eigen::Quaterniond(p.w().a, p.x().a, p.y().a, p.z().a), u_local);
    Vec3<JetOf<N>> result = u.cast<JetOf<N>>();
    const auto& moved = body.r[0].v;  // zero but for L where the body has its step
    const int r = moved[0] != 0 ? 0 : N == of_two && moved[6] != 0 ? 6 : -1;
    if (r < 0) return result;
    for (int k = 0; k < 3; ++k) {
        result[k].v[r + 3 + (k + 1) % 3] = u[(k + 2) % 3];
        result[k].v[r + 3 + (k + 2) % 3] = -u[(k + 1) % 3];
    }
    return result;
}

}  // namespace

// Points and directions of a body with derivatives in closed form, which is faster than Jets
// through the quaternion.
template <>
Vec3<JetOf<of_two>> direction(const Frame<JetOf<of_two>>& body, const Eigen::Vector3d& u_local) {
    return turning(body, u_local);
}
template <>
Vec3<JetOf<of_one>> direction(const Frame<JetOf<of_one>>& body, const Eigen::Vector3d& u_local) {
    return turning(body, u_local);
}
template <>
Vec3<JetOf<of_two>> position(const Frame<JetOf<of_two>>& body, const Eigen::Vector3d& s_local) {
    return body.r + turning(body, s_local);
}
template <>
Vec3<JetOf<of_one>> position(const Frame<JetOf<of_one>>& body, const Eigen::Vector3d& s_local) {
    return body.r + turning(body, s_local);
}

namespace {

// Frame of a body after a step (δr / L, δπ). A rotation by δπ changes the quaternion by ½ (δπ, 0)
// p: δ(x, y, z) = ½ (w δπ + δπ × v),  δw = -½ v · δπ.
template <int N>
Frame<JetOf<N>> stepping(const System& system, const VectorXd& x, BodyId body, int r) {
    const Frame<double> pose = frame_of(system, x, body);
    Frame<JetOf<N>> frame{pose.r.cast<JetOf<N>>(), pose.p.cast<JetOf<N>>()};
    if (body == ground) return frame;
    const double hx = pose.p.x() / 2, hy = pose.p.y() / 2, hz = pose.p.z() / 2, hw = pose.p.w() / 2;
    const int pi = r + 3;
    for (int k = 0; k < 3; ++k) frame.r[k].v[r + k] = system.length;
    frame.p.x().v.template segment<3>(pi) << hw, hz, -hy;
    frame.p.y().v.template segment<3>(pi) << -hz, hw, hx;
    frame.p.z().v.template segment<3>(pi) << hy, -hx, hw;
    frame.p.w().v.template segment<3>(pi) << -hx, -hy, -hz;
    return frame;
}

struct SeedsOfOne {
    const System& system;
    const VectorXd& x;

    Frame<JetOf<of_one>> frame(const Part& part, int which) const {
        return stepping<of_one>(system, x, which == 0 ? part.i : part.j, 0);
    }
    JetOf<of_one> narrowed(const Jet& a) const {
        JetOf<of_one> narrow(a.a);
        by_parameter(narrow) = by_parameter(a);
        return narrow;
    }
};

struct Seeds {
    const System& system;
    const VectorXd& x;

    Frame<Jet> frame(const Part& part, int which) const {
        return stepping<of_two>(system, x, which == 0 ? part.i : part.j, 6 * which);
    }
    Jet reaction(const Part& part, int k) const {
        return Jet(x[7 * system.bodies + part.row + k], first_reaction + k);
    }
    SeedsOfOne of_one_body() const { return {system, x}; }
};

// Entries of J to which a term adds, in a fixed order: `entry(row, column, n)` receives the n-th
// derivative. A direction does not depend on positions, nor a constraint on its own reactions.
template <class Entry>
void for_each_entry(const System& system, const Part& part, int row, bool balance,
                    const Entry& entry) {
    const int first = part.directions ? 3 : 0;
    if (part.i != ground)
        for (int k = first; k < 6; ++k) entry(row, 6 * part.i + k, k);
    if (part.j != ground)
        for (int k = first; k < 6; ++k) entry(row, 6 * part.j + k, 6 + k);
    if (balance)
        for (int k = 0; k < part.rows; ++k)
            entry(row, 6 * system.bodies + part.row + k, first_reaction + k);
}

// Rows of the terms in assembly order: balance of a body, without forces for a direction
// constraint, then the constraint.
template <class Row>
struct Rows {
    const System& system;
    const Row& row;
    template <class T>
    void balance(const Part& part, BodyId body, const Vec3<T>& force, const Vec3<T>& moment) {
        if (!part.directions)
            for (int k = 0; k < 3; ++k) row(part, 6 * body + k, true, force[k]);
        for (int k = 0; k < 3; ++k) row(part, 6 * body + 3 + k, true, moment[k]);
    }
    template <class T>
    void constraint(const Part& part, int k, const T& Phi) {
        row(part, 6 * system.bodies + part.row + k, false, Phi);
    }
};

// Source of the constraints' terms alone, with the reactions R.
struct Reacting : Seeds {
    const VectorXd& R;

    bool wants(Term term, std::size_t) const { return term == Term::constraint; }
    Jet reaction(const Part& part, int k) const { return Jet(R[part.row + k], first_reaction + k); }
};

template <class Source, class Row>
void for_each_row(const System& system, const Loading& loading, const Source& source, Row row) {
    Jet a(loading.a), held(loading.held);
    by_parameter(a) = loading.a_rate;
    by_parameter(held) = loading.held_rate;
    Rows<Row> rows{system, row};
    assemble<Jet>(system, a, held, loading.pieces, source, rows);
}

}  // namespace

// Positions of the derivatives of each term in J, in assembly order.
struct Pattern {
    Sparse J;                     // zeros
    std::vector<int> places;      // among its values
    std::size_t constraints = 0;  // the first of theirs
};

namespace {

// The terms in the same order, without their derivatives.
struct Plain {
    const System& system;
    const VectorXd& x;

    Frame<double> frame(const Part& part, int which) const {
        return frame_of(system, x, which == 0 ? part.i : part.j);
    }
    double reaction(const Part&, int) const { return 0; }
};

Pattern pattern_of(const System& system, const Loading& loading, const VectorXd& x) {
    std::vector<Eigen::Triplet<double>> entries;
    std::size_t of_others = 0;
    const auto add = [&](const Part& part, int row, bool balance, double) {
        for_each_entry(system, part, row, balance,
                       [&](int i, int j, int) { entries.emplace_back(i, j, 0.); });
        if (part.rows == 0) of_others = entries.size();
    };
    Rows<decltype(add)> rows{system, add};
    assemble<double>(system, loading.a, loading.held, loading.pieces, Plain{system, x}, rows);
    Pattern pattern{Sparse(system.equations(), system.equations()), {}, of_others};
    pattern.J.setFromTriplets(entries.begin(), entries.end());
    const int *start = pattern.J.outerIndexPtr(), *row = pattern.J.innerIndexPtr();
    for (const auto& entry : entries)
        pattern.places.push_back(static_cast<int>(
            std::lower_bound(row + start[entry.col()], row + start[entry.col() + 1], entry.row()) -
            row));
    return pattern;
}

// Frame of a body that moves along dx; the quaternion as above.
using Dual = ceres::Jet<double, 1>;
Frame<Dual> at_rest(const Frame<double>& pose) {
    return {pose.r.cast<Dual>(), pose.p.cast<Dual>()};
}
Frame<Dual> moving_frame(const System& system, const VectorXd& x, const VectorXd& dx, BodyId body) {
    const Frame<double> pose = frame_of(system, x, body);
    Frame<Dual> frame = at_rest(pose);
    if (body == ground) return frame;
    const Eigen::Vector3d v = pose.p.vec(), turn = dx.segment<3>(6 * body + 3);
    const Eigen::Vector3d dv = (pose.p.w() * turn + cross(turn, v)) / 2;
    for (int k = 0; k < 3; ++k) frame.r[k].v[0] = system.length * dx[6 * body + k];
    frame.p.x().v[0] = dv[0];
    frame.p.y().v[0] = dv[1];
    frame.p.z().v[0] = dv[2];
    frame.p.w().v[0] = -v.dot(turn) / 2;
    return frame;
}

}  // namespace

Derivatives derivatives(const System& system, const Loading& loading, const VectorXd& x,
                        Counts& counts) {
    ++counts.evaluations;
    if (!system.pattern)
        system.pattern = std::make_shared<const Pattern>(pattern_of(system, loading, x));
    Derivatives result{system.pattern->J, VectorXd::Zero(system.equations()),
                       VectorXd::Zero(system.equations())};
    double* values = result.J.valuePtr();
    const int* place = system.pattern->places.data();
    for_each_row(system, loading, Seeds{system, x},
                 [&](const Part& part, int row, bool balance, const auto& term) {
                     result.E[row] += term.a;
                     result.E_rate[row] += by_parameter(term);
                     for_each_entry(system, part, row, balance, [&](int, int, int n) {
                         values[*place++] += derivative(term, n);
                     });
                 });
    result.E -= loading.held * system.at_design;
    result.E_rate -= loading.held_rate * system.at_design;
    return result;
}

void add_reactions(const System& system, const Loading& loading, const VectorXd& x,
                   const VectorXd& R, Derivatives& result, Counts& counts) {
    ++counts.evaluations;
    double* values = result.J.valuePtr();
    const int* place = system.pattern->places.data() + system.pattern->constraints;
    for_each_row(system, loading, Reacting{{system, x}, R},
                 [&](const Part& part, int row, bool balance, const auto& term) {
                     if (balance) {
                         result.E[row] += term.a;
                         result.E_rate[row] += by_parameter(term);
                     }
                     // neither Φ nor the directions of the reactions change
                     for_each_entry(system, part, row, balance, [&](int, int, int n) {
                         if (balance && n < first_reaction) values[*place] += derivative(term, n);
                         ++place;
                     });
                 });
}

VectorXd rate_of(const System& system, const Loading& loading, const VectorXd& x) {
    struct Source {
        const System& system;
        const VectorXd& x;
        bool settling;
        bool wants(Term term, std::size_t k) const {
            if (settling) return true;
            switch (term) {
                case Term::element: {
                    const ElementPath& path = system.elements[k];
                    return path.free_length.rate != 0 ||
                           std::ranges::any_of(path.preload,
                                               [](const Affine& b) { return b.rate != 0; });
                }
                case Term::load: return system.loads[k].factor.rate != 0;
                case Term::ground_spring: return false;
                case Term::constraint: return system.values[k].rate != 0;
            }
            return true;
        }
        Frame<Dual> frame(const Part& part, int which) const {
            return at_rest(frame_of(system, x, which == 0 ? part.i : part.j));
        }
        Dual reaction(const Part& part, int k) const {
            return Dual(x[7 * system.bodies + part.row + k]);
        }
    };
    struct Sum {
        const System& system;
        VectorXd E_rate;
        void balance(const Part&, BodyId body, const Vec3<Dual>& force, const Vec3<Dual>& moment) {
            for (int k = 0; k < 3; ++k) {
                E_rate[6 * body + k] += force[k].v[0];
                E_rate[6 * body + 3 + k] += moment[k].v[0];
            }
        }
        void constraint(const Part& part, int k, const Dual& Phi) {
            E_rate[6 * system.bodies + part.row + k] += Phi.v[0];
        }
    };
    Dual a(loading.a), held(loading.held);
    a.v[0] = loading.a_rate;
    held.v[0] = loading.held_rate;
    Sum sum{system, -loading.held_rate * system.at_design};
    assemble<Dual>(system, a, held, loading.pieces, Source{system, x, loading.held_rate != 0}, sum);
    return std::move(sum.E_rate);
}

DeformationRates deformation_rates(const System& system, const Loading& loading, const VectorXd& x,
                                   const VectorXd& dx) {
    constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
    const auto& elastics = system.model->elastics;
    const auto rows = 6 * static_cast<Eigen::Index>(elastics.size());
    DeformationRates rates{VectorXd::Zero(rows), VectorXd::Zero(rows)};
    for (std::size_t e = 0; e < elastics.size(); ++e) {
        const auto [i, j] = bodies_of(elastics[e].kind);
        const ElementPieces& on = loading.pieces.empty() ? all_by_themselves : loading.pieces[e];
        const Vec6<Dual> d =
            deformations(system, e, Dual(loading.a), moving_frame(system, x, dx, i),
                         moving_frame(system, x, dx, j));
        const Vec6<Dual> force = forces(elastics[e].kind, d, on);
        const auto row = 6 * static_cast<Eigen::Index>(e);
        for (int k = 0; k < 6; ++k) {
            rates.rate[row + k] = d[k].v[0];
            rates.force_rate[row + k] = force[k].v[0] / (system.force * system.length);
        }
        const auto* law = member<SpatialLaw>(elastics[e].kind);
        const Matrix6* coupled = law != nullptr ? matrix_of(*law) : nullptr;
        if (coupled == nullptr) continue;
        const Vector6 sizes = coupled->cwiseAbs() * rates.rate.segment<6>(row).cwiseAbs();
        for (int k = 0; k < 6; ++k)
            if (std::abs(force[k].v[0]) <= rounding * sizes[k]) rates.force_rate[row + k] = 0;
    }
    return rates;
}

std::vector<CurveDeformation> curve_deformations(const System& system, const Loading& loading,
                                                 const VectorXd& x, const VectorXd& dx) {
    std::vector<CurveDeformation> components;
    Dual a(loading.a);
    a.v[0] = loading.a_rate;
    const auto& elastics = system.model->elastics;
    for (std::size_t e = 0; e < elastics.size(); ++e) {
        std::array<const Curve*, 6> curves{};
        for (std::size_t k = 0; k < 6; ++k) curves[k] = curve_of(elastics[e].kind, k);
        if (std::ranges::count(curves, nullptr) == 6) continue;
        const auto [i, j] = bodies_of(elastics[e].kind);
        const Vec6<Dual> now = deformations(system, e, a, moving_frame(system, x, dx, i),
                                            moving_frame(system, x, dx, j));
        for (std::size_t k = 0; k < 6; ++k)
            if (curves[k] != nullptr) {
                const Dual& value = now[static_cast<int>(k)];
                components.push_back(
                    {e, k, curves[k], k < 3 ? system.length : 1, value.a, value.v[0]});
            }
    }
    return components;
}

}  // namespace elastocheck::reference::equilibrium
