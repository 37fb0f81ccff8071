// Energy balance along every branch of every scene: work done equals energy stored.
//
// Power is computed from forces: loads times velocities of their points, driver efforts times rates
// of their offsets. Energy is computed from deformations. No leg computes both: the recursion and
// the equilibrium leg use no energy, the energy leg no power. A wrong force, or a force in a wrong
// direction, of any leg leaves a gap
//
//   ∫ P da - (U(end) - U(start)),
//   P = Σ f·ṗ + Σ m·ω + Σ effort · d(offset)/da + Σ ∂U/∂a of driven laws.
//
// Where a bushing's formulation has no energy, the power of its forces is used instead. Where the
// energy leg does not apply, the other two legs are tested.
//
// The integral uses Gauss points, piece by piece of the branch as a power series, so that no piece
// contains a knot of a curve; states and efforts are those of the leg, velocities those of the
// series. At the same points the legs are compared with each other.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "compare/outputs/deformation.hpp"
#include "compare/outputs/positions.hpp"
#include "elastocheck/channels.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/trim.hpp"
#include "models/overloaded.hpp"
#include "recursive/series/path.hpp"
#include "tests/support/quadrature.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;
namespace series = recursive::series;

double value(const Driver& driver, double a) { return driver.start + driver.rate * a; }

// ---- Stored energy.

// u(x) = ∫₀ˣ f, from knot to knot: two Gauss points are exact for a cubic.
double energy(const LinearRate& law, double x) { return law.k * x * x / 2; }
double energy(const elastocheck::Curve& law, double x) {
    const double low = std::min(0.0, x), high = std::max(0.0, x);
    std::vector<double> ends{low};
    for (const double knot : law.knots)
        if (knot > low && knot < high) ends.push_back(knot);
    ends.push_back(high);
    double u = 0;
    for (std::size_t k = 1; k < ends.size(); ++k)
        for (const auto& [at, weight] : support::gauss(ends[k - 1], ends[k], 2))
            u += weight * force(ScalarLaw(law), at);
    return x < 0 ? -u : u;
}
double energy(const ScalarLaw& law, double x) {
    return std::visit([&](const auto& u) { return energy(u, x); }, law);
}
double energy(const LinearStiffness& law, const Vector6& x) { return x.dot(law.K * x) / 2; }
double energy(const PerAxis& law, const Vector6& x) {
    double u = 0;
    for (std::size_t k = 0; k < 6; ++k) u += energy(law.axis[k], x[static_cast<Eigen::Index>(k)]);
    return u;
}

// Driven part of the preload of element k.
Vector6 driven_preload(const Branch& branch, std::size_t k, double a) {
    Vector6 sum = Vector6::Zero();
    for (const auto& driver : branch.drivers)
        if (const auto* p = std::get_if<Preload>(&driver.what);
            p && p->elastic == static_cast<int>(k))
            sum += value(driver, a) * p->direction;
    return sum;
}

double stored(const Model& model, const Branch& branch, const Equilibrium& state) {
    double U = 0;
    for (std::size_t k = 0; k < model.elastics.size(); ++k)
        U += std::visit(
            overloaded{[&](const AxialSpring& e) {
                           return energy(e.law, deformation(e, k, branch, state)[0]);
                       },
                       [&](const Bushing& e) {
                           if (!has_energy(e.formulation)) return 0.0;
                           const Vector6 x = deformation(ElasticKind(e), k, branch, state),
                                         whole = deformation(e, state) + e.undeformed;
                           const Vector6 b = e.preload + driven_preload(branch, k, state.load);
                           return std::visit([&](const auto& u) { return energy(u, x); }, e.law) +
                                  b.dot(whole);
                       }},
            model.elastics[k].kind);
    return U;
}

// ---- Power.

struct Power {
    // Σ, Σ |.| of the power of each load and driver [J per unit of a]
    double sum = 0, turned_over = 0;
    void add(double p) {
        sum += p;
        turned_over += std::abs(p);
    }
};

double power(const LoadKind& load, const Equilibrium& state, const series::Rates& rates) {
    const auto force = [&](const Point& at, const Vector3d& f) {
        const auto b = static_cast<std::size_t>(at.body);
        const Vector3d lever = state.poses[b].p * at.s_local;
        return f.dot(rates.dr[b] + rates.omega[b].cross(lever));
    };
    const auto turned = [&](BodyId body, const Vector3d& v) -> Vector3d {
        return pose(state.poses, body).p * v;
    };
    const auto moment = [&](BodyId body, const Vector3d& m) {
        return m.dot(rates.omega[static_cast<std::size_t>(body)]);
    };
    return std::visit(
        overloaded{
            [&](const DeadForce& l) { return force(l.at, l.f); },
            [&](const DeadMoment& l) { return moment(l.body, l.m); },
            [&](const FollowerForce& l) { return force(l.at, turned(l.at.body, l.f_local)); },
            [&](const FollowerMoment& l) { return moment(l.body, turned(l.body, l.m_local)); },
            [&](const BrakeForce& l) {
                const Vector3d lever = position(state.poses, l.patch) - pose(state.poses, l.body).r;
                return l.f.dot(rates.dr[static_cast<std::size_t>(l.body)]) +
                       moment(l.body, lever.cross(l.f));
            }},
        load);
}

// Power of a bushing whose forces are not the gradient of an energy: F' = ∂u/∂e + preload along the
// axes of its frame, the force at its own marker on each body or, with the moment of the offset D,
// at p_j on both.
double taken_up(const Bushing& e, const Vector6& driven, const Equilibrium& state,
                const series::Rates& rates) {
    if (e.formulation.conjugate) return std::nan("");  // no scene has one
    const Vector6 x = deformation(e, state);
    Vector6 stress = e.preload + driven;
    if (const auto* law = std::get_if<LinearStiffness>(&e.law))
        stress += law->K * x;
    else
        for (std::size_t k = 0; k < 6; ++k)
            stress[static_cast<Eigen::Index>(k)] +=
                force(std::get<PerAxis>(e.law).axis[k], x[static_cast<Eigen::Index>(k)]);
    const auto turning = [&](BodyId b) -> Vector3d {
        return b == ground ? Vector3d::Zero() : rates.omega[static_cast<std::size_t>(b)];
    };
    const auto moving = [&](const Marker& m) -> Vector3d {
        if (m.body == ground) return Vector3d::Zero();
        const auto b = static_cast<std::size_t>(m.body);
        return rates.dr[b] + turning(m.body).cross(state.poses[b].p * m.s_local);
    };
    const Eigen::Quaterniond A = pose(state.poses, e.i.body).p * e.i.A_local;
    const Vector3d span =
        position(state.poses, e.j.body, e.j.s_local) - position(state.poses, e.i.body, e.i.s_local);
    Vector3d apart = moving(e.j) - moving(e.i);
    if (e.formulation.offset_moment) apart -= turning(e.i.body).cross(span);
    return (A * stress.head<3>()).dot(apart) +
           (A * stress.tail<3>()).dot(turning(e.j.body) - turning(e.i.body));
}

Power power(const Model& model, const std::vector<Channel>& channels, const Branch& branch,
            const Equilibrium& state, const series::Rates& rates) {
    Power all;
    for (const auto& load : model.static_loads) all.add(power(load.kind, state, rates));
    const auto effort = [&](int joint) {
        for (const auto& channel : channels)
            if (const auto* reads = std::get_if<Effort>(&channel.reads);
                reads && reads->joint == joint)
                return evaluate(model, std::span(&channel, 1), state).front();
        return std::nan("");
    };
    const auto element = [&](int k) -> const ElasticKind& {
        return model.elastics[static_cast<std::size_t>(k)].kind;
    };
    for (const auto& driver : branch.drivers)
        all.add(std::visit(
            overloaded{
                [&](const Load& l) {
                    return value(driver, state.load) * power(l.kind, state, rates);
                },
                [&](const Motion& m) {
                    return driver.rate == 0 ? 0 : driver.rate * effort(m.joint);
                },
                [&](const FreeLength& f) {
                    const ElasticKind& e = element(f.elastic);
                    const Vector6 x =
                        deformation(e, static_cast<std::size_t>(f.elastic), branch, state);
                    return -driver.rate * force(e, x)[std::holds_alternative<Bushing>(e) ? 2 : 0];
                },
                [&](const Preload& p) {
                    const auto& e = std::get<Bushing>(element(p.elastic));
                    return driver.rate * p.direction.dot(deformation(e, state) + e.undeformed);
                }},
            driver.what));
    return all;
}

// ---- A branch side, at Gauss points of its pieces.

struct Sampled {
    series::Path path;
    std::vector<double> a, weight;  // of ∫ da; both ends come first and last, with weight 0
    std::vector<series::Rates> rates;
    bool meets_knots = false;
};

Sampled sampled(const BranchSide& side, int points_a_piece = 12) {
    Sampled result;
    result.path = series::follow(side.model, side.branch);
    if (result.path.outcome != Outcome::converged) return result;
    const double to = side.branch.to;
    const auto add = [&](double a, double weight) {
        result.a.push_back(a);
        result.weight.push_back(weight);
        result.rates.push_back(series::rates(result.path, series::find(result.path, a).value()));
    };
    add(0, 0);
    for (const auto& piece : result.path.expansions) {
        const double from = piece.load[0], end = from + piece.load[1] * piece.reach;
        const double until = to > 0 ? std::min(to, end) : std::max(to, end);
        if (until != from)
            for (const auto& [a, weight] : support::gauss(from, until, points_a_piece))
                add(a, weight);
        if (piece.knots > 0 && until != to) result.meets_knots = true;
    }
    add(to, 0);
    return result;
}

struct Books {
    double work = 0, turned_over = 0, gained = 0;  // [J]
    double gap() const { return std::abs(work - gained) / turned_over; }
};

Books books(const BranchSide& side, const std::vector<Channel>& channels, const Sampled& s,
            const std::vector<Equilibrium>& states) {
    Books b;
    for (std::size_t k = 0; k < states.size(); ++k) {
        const Power p = power(side.model, channels, side.branch, states[k], s.rates[k]);
        for (std::size_t e = 0; e < side.model.elastics.size(); ++e)
            if (const auto* bushing = std::get_if<Bushing>(&side.model.elastics[e].kind);
                bushing && !has_energy(bushing->formulation))
                b.gained +=
                    s.weight[k] * taken_up(*bushing, driven_preload(side.branch, e, states[k].load),
                                           states[k], s.rates[k]);
        b.work += s.weight[k] * p.sum;
        b.turned_over += std::abs(s.weight[k]) * p.turned_over;
    }
    b.gained += stored(side.model, side.branch, states.back()) -
                stored(side.model, side.branch, states.front());
    return b;
}

struct Difference {
    double mm = 0, deg = 0;
    std::string where_mm, where_deg;
};
// Distance of two legs over all positions and angles.
Difference difference(const BranchSide& side, const std::vector<Channel>& channels,
                      const std::vector<Equilibrium>& x, const std::vector<Equilibrium>& y) {
    Difference worst;
    for (std::size_t k = 0; k < x.size(); ++k) {
        const auto of_x = evaluate(side.model, channels, x[k]),
                   of_y = evaluate(side.model, channels, y[k]);
        for (std::size_t c = 0; c < channels.size(); ++c) {
            // magnifies errors
            if (!channels[c].kinematic() || channels[c].unit == Unit::percent) continue;
            const bool angle = channels[c].unit == Unit::deg;
            // undefined of both: a turning circle straight ahead
            const double off = of_x[c] == of_y[c] ? 0 : std::abs(of_x[c] - of_y[c]);
            double& most = angle ? worst.deg : worst.mm;
            if (std::isnan(most) || off <= most) continue;
            most = off;
            (angle ? worst.where_deg : worst.where_mm) =
                fmt::format("{} at {}", channels[c].name, x[k].load);
        }
    }
    return worst;
}

class EnergyBalance : public testing::TestWithParam<std::string> {};

TEST_P(EnergyBalance, StoredEnergyEqualsTheWorkOfLoadsAndDrivesInEveryLeg) {
    const auto trimmed = trim(support::scene(GetParam()));
    ASSERT_TRUE(!trimmed.record || trimmed.record->reached()) << trimmed.record->detail;
    const Model model = compile(trimmed.scene);
    const auto all = channels(model);
    ASSERT_FALSE(model.branches.empty());
    for (const auto& branch : model.branches)
        for (const auto& side : sides_of(model, branch)) {
            const Sampled s = sampled(side);
            ASSERT_EQ(s.path.outcome, Outcome::converged) << side.name << ": " << s.path.detail;
            const auto equilibrium = reference::equilibrium::solve(side.model, side.branch, s.a);
            const auto energy = reference::energy::solve(side.model, side.branch, s.a);
            ASSERT_EQ(equilibrium.outcome, Outcome::converged)
                << side.name << ": " << equilibrium.detail;
            const bool conservative = energy.outcome != Outcome::not_conservative;
            if (conservative) {
                ASSERT_EQ(energy.outcome, Outcome::converged) << side.name << ": " << energy.detail;
            }
            std::vector<Equilibrium> polynomial;
            for (const double a : s.a)
                polynomial.push_back(series::evaluate(side.model, side.branch, s.path,
                                                      series::find(s.path, a).value()));

            std::vector<std::pair<Leg, const std::vector<Equilibrium>*>> legs{
                {Leg::equilibrium, &equilibrium.points}, {Leg::series, &polynomial}};
            if (conservative) legs.emplace_back(Leg::energy, &energy.points);
            for (const auto& [leg, states] : legs) {
                const Books b = books(side, all, s, *states);
                EXPECT_TRUE(b.turned_over > 0 && b.gap() <= 1e-9) << fmt::format(
                    "{}, {} leg: work {:.12g} J, stored {:.12g} J, apart by {:.2g} of {:.4g} J",
                    side.name, name(leg), b.work, b.gained, b.gap(), b.turned_over);
            }
            const auto expect = [&](Leg leg, const std::vector<Equilibrium>& states, double bound) {
                const Difference off = difference(side, all, equilibrium.points, states);
                EXPECT_TRUE(off.mm <= bound)
                    << side.name << ", " << name(leg) << ": " << off.mm << " mm, " << off.where_mm;
                EXPECT_TRUE(off.deg <= bound) << side.name << ", " << name(leg) << ": " << off.deg
                                              << " deg, " << off.where_deg;
            };
            if (conservative) expect(Leg::energy, energy.points, s.meets_knots ? 1e-6 : 1e-8);
            expect(Leg::series, polynomial, 1e-9);
        }
}

// The small scenes, and a suspension with curves and stops.
std::vector<std::string> sample() {
    auto names = support::small_scene_names();
    names.emplace_back("mcpherson_strut");
    return names;
}
INSTANTIATE_TEST_SUITE_P(Sample, EnergyBalance, testing::ValuesIn(sample()),
                         [](const auto& scene) { return scene.param; });
INSTANTIATE_TEST_SUITE_P(Nightly, EnergyBalance, testing::ValuesIn(support::scene_names()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace elastocheck::compare
