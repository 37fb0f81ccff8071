#include "compare/studies/findings.hpp"

#include <algorithm>
#include <cmath>

#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/fixed_bodies.hpp"
#include "compare/outputs/positions.hpp"
#include "models/kinds.hpp"

namespace elastocheck::compare {
namespace {

// ---- Lift of a wheel by a branch.

bool is_vertical(const Eigen::Vector3d& v) { return v.head<2>().norm() <= 1e-9 * std::abs(v.z()); }

Eigen::Vector3d at_design(const Model& model, const Direction& u) {
    return u.body == ground ? u.u_local
                            : model.bodies[static_cast<std::size_t>(u.body)].design.p * u.u_local;
}

// The driver that lifts a wheel on a branch: a vertical force on its body, a jack under it, or the road
// under its tyre; `none` if anything else is driven too.
enum class Lift { none, load, jack, road };
struct Lifted {
    Lift by = Lift::none;
    int joint = -1;     // of the jack
    double force = 0;   // of the load, per unit of the parameter [N]
    double height = 0;  // of the road per unit of the parameter [m]
};

// Whether the element is the tyre under this wheel.
bool is_under(const Elastic& elastic, const Wheel& wheel) {
    if (elastic.written_as != WrittenAs::tyre) return false;
    const Marker& patch = std::get<Bushing>(elastic.kind).j;
    return patch.body == wheel.contact.body &&
           (patch.s_local - wheel.contact.s_local).norm() <= 1e-9;
}

bool carries(const Model& model, const Wheel& wheel, BodyId body) {
    const FixedBodies fixed(model);
    return fixed.are_one(body, wheel.body) || fixed.are_one(body, wheel.contact.body);
}

// The lift of this wheel by the branch, if it is the only motion that the branch drives.
Lifted lifted(const Model& model, const Branch& branch, const Wheel& wheel) {
    Lifted result;
    for (const auto& driver : branch.drivers) {
        const int element = driven_element(driver.what);
        const bool is_road =
            element >= 0 && is_under(model.elastics[static_cast<std::size_t>(element)], wheel);
        if (driver.rate == 0) {      // held
            if (is_road) return {};  // a wheel lifted off its tyre also carries the tyre force
            continue;
        }
        const Lifted by_driver = std::visit(
            overloaded{[&](const Load& load) {
                           const auto* force = std::get_if<DeadForce>(&load.kind);
                           const bool lifts = force != nullptr &&
                                              carries(model, wheel, force->at.body) &&
                                              is_vertical(force->f);
                           return Lifted{lifts ? Lift::load : Lift::none, -1,
                                         lifts ? driver.rate * force->f.z() : 0, 0};
                       },
                       [&](const Motion& motion) {
                           const ModelJoint& joint =
                               model.joints[static_cast<std::size_t>(motion.joint)];
                           if (joint.driven < 0 || !carries(model, wheel, joint.i)) return Lifted{};
                           const auto* plane = std::get_if<PointInPlane>(
                               &model.constraints[static_cast<std::size_t>(joint.driven)].kind);
                           const bool lifts =
                               plane != nullptr && is_vertical(at_design(model, plane->normal_j));
                           return Lifted{lifts ? Lift::jack : Lift::none, motion.joint, 0, 0};
                       },
                       [&](const FreeLength&) {
                           return is_road ? Lifted{Lift::road, -1, 0, driver.rate} : Lifted{};
                       },
                       [](const Preload&) { return Lifted{}; }},
            driver.what);
        if (by_driver.by == Lift::none || result.by != Lift::none) return {};
        result = by_driver;
    }
    return result;
}

}  // namespace

const Reading& reading_of(const Pair& pair, ReadingKind kind) {
    return kind == ReadingKind::equal_parameter ? pair.equal_parameter : pair.equal_abscissa;
}

bool is_readable(const Comparison& comparison, const BranchComparison& branch) {
    if (branch.abscissa < 0) return false;
    const auto c = static_cast<std::size_t>(branch.abscissa);
    // an output of a mechanism, whose range may be small; not a wheel's travel
    if (comparison.channels[c].main) return true;
    const Curve& truth = branch.run(Leg::equilibrium).curve;
    if (truth.values.empty()) return false;
    const auto x = truth.channel(c);
    const auto [low, high] = std::ranges::minmax(x);
    return high - low >= min_travel;
}

std::optional<Worst> worst_disagreement(const Comparison& comparison, Unit unit) {
    std::optional<Worst> worst;
    for (const auto& branch : comparison.branches) {
        const auto& found = branch.uncertainty.equal_parameter.channels;
        for (std::size_t c = 0; c < found.size(); ++c) {
            const Channel& channel = comparison.channels[c];
            if (!channel.main || channel.unit != unit || !branch.determined[c]) continue;
            const Deviation& d = found[c];
            if (worst && (std::isnan(worst->max) || d.max <= worst->max)) continue;
            worst = Worst{.branch = branch.branch,
                          .channel = channel.name,
                          .unit = unit,
                          .max = d.max,
                          .end = d.end,
                          .range = d.range};
        }
    }
    return worst;
}

std::vector<RateError> rate_errors(const Model& model, const Comparison& comparison) {
    std::vector<RateError> list;
    for (std::size_t b = 0; b < model.branches.size(); ++b) {
        const BranchComparison& branch = comparison.branches[b];
        const LegRun &reference = branch.run(Leg::equilibrium),
                     &recursion = branch.run(Leg::recursive);
        const Curve &truth = reference.curve, &fast = recursion.curve;
        if (truth.a.empty() || truth.a.size() != fast.a.size() || truth.start != fast.start)
            continue;
        for (std::size_t w = 0; w < model.wheels.size(); ++w) {
            const Wheel& wheel = model.wheels[w];
            const Lifted lift = lifted(model, model.branches[b], wheel);
            if (lift.by == Lift::none) continue;
            const auto channel = [&](auto&& wanted) {
                const auto found = std::ranges::find_if(comparison.channels, wanted);
                return static_cast<std::size_t>(found - comparison.channels.begin());
            };
            const std::string prefix = wheel.name.empty() ? "" : wheel.name + ".";
            const std::size_t travel = channel(
                [&](const Channel& c) { return c.name == prefix + std::string(figure::travel); });
            const std::size_t force = channel([&](const Channel& c) {
                const auto* effort = std::get_if<Effort>(&c.reads);
                return effort != nullptr && effort->joint == lift.joint;
            });
            const auto gained = [](const Curve& curve, std::size_t c, std::size_t end) {
                return curve.values[end][c] - curve.values[curve.start][c];
            };
            for (const std::size_t end : {std::size_t{0}, truth.a.size() - 1}) {
                if (end == truth.start) continue;
                RateError error{branch.branch, wheel.name, truth.a[end], branch.unit};
                error.over = gained(truth, travel, end);
                if (std::abs(error.over) < min_travel) continue;
                error.travel = fast.values[end][travel] - truth.values[end][travel];
                const double change = (truth.a[end] - truth.a[truth.start]) / in_unit(branch.unit);
                // Lifting force [N]: of the load; of the jack; of the tyre on the road, k_t
                // (Δh - Δz) with z of the patch
                const auto lifting = [&](const LegRun& run) {
                    if (lift.by == Lift::load) return lift.force * change;
                    if (lift.by == Lift::jack) return gained(run.curve, force, end);
                    const auto z = [&](const std::optional<Equilibrium>& at) {
                        return at ? position(at->poses, wheel.contact).z() : NAN;
                    };
                    const auto& [front, start, middle, back] = run.landmarks;
                    return wheel.tyre_rate *
                           (lift.height * change - (z(end == 0 ? front : back) - z(start)));
                };
                // [N/mm]: under a load, equal force over different travel; on a
                // jack, different forces
                const auto rate = [&](const LegRun& run) {
                    return lifting(run) / gained(run.curve, travel, end);
                };
                error.wheel_rate = rate(reference);
                error.off = rate(recursion) / error.wheel_rate - 1;
                if (lift.by == Lift::jack)
                    error.force = fast.values[end][force] - truth.values[end][force];
                if (wheel.tyre_rate > 0) {
                    const double tyre = 1e-3 * wheel.tyre_rate;
                    const auto ride = [&](const LegRun& run) {
                        return lift.by == Lift::road ? 1e-3 * lifting(run) / (lift.height * change)
                                                     : 1 / (1 / rate(run) + 1 / tyre);
                    };
                    error.ride_rate = ride(reference);
                    error.ride_off = ride(recursion) / error.ride_rate - 1;
                }
                constexpr double no_force = 1e-9;  // [N]: rounding of a mechanism without springs
                if (std::isfinite(error.off) && std::abs(lifting(reference)) > no_force)
                    list.push_back(error);
            }
        }
    }
    return list;
}

}  // namespace elastocheck::compare
