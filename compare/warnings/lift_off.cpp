#include "compare/warnings/lift_off.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "compare/outputs/curve.hpp"
#include "compare/outputs/deformation.hpp"
#include "models/kinds.hpp"
#include "models/laws.hpp"

namespace elastocheck::compare {
namespace {

// Smaller deflections [m] are neither contact nor lift-off, as of a tyre without preload at the start.
constexpr double min_deflection = 1e-9;

// An element that only pushes: without force where its deformation exceeds `end`.
struct Pusher {
    std::size_t element = 0;
    Eigen::Index axis = 0;
    double end = 0;
    std::string leaves, returns;
};

std::vector<Pusher> pushers(const Model& model) {
    std::vector<Pusher> list;
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const Elastic& elastic = model.elastics[k];
        const bool is_tyre = elastic.written_as == WrittenAs::tyre;
        const std::size_t axis = is_tyre ? 2 : 0;
        const auto* law = curve_of(elastic.kind, axis);
        if (law == nullptr || (!is_tyre && elastic.written_as != WrittenAs::itself)) continue;
        std::size_t n = law->knots.size();  // the last pieces, without force
        while (n > 0 && law->pieces[n] == std::array<double, 4>{}) --n;
        if (n == law->knots.size() || is_zero(ScalarLaw(*law))) continue;
        const auto wheel = std::ranges::find_if(model.wheels, [&](const Wheel& w) {
            return is_tyre && w.contact.body == ends(elastic.kind).j;
        });
        const std::string who = wheel == model.wheels.end() ? "'" + elastic.name + "'"
                                : wheel->name.empty()       ? "the wheel"
                                                            : wheel->name + " wheel";
        const std::string what = is_tyre ? "the road" : "its seat";
        list.push_back({k, static_cast<Eigen::Index>(axis), law->knots[n], who + " leaves " + what,
                        who + " returns to " + what});
    }
    return list;
}

// Deflection [m] of the element, negative where it has lifted off.
double deflection(const Pusher& pusher, const BranchSide& side, const Equilibrium& state) {
    const ElasticKind& kind = side.model.elastics[pusher.element].kind;
    return pusher.end - deformation(kind, pusher.element, side.branch, state)[pusher.axis];
}

// A parameter of the branch [SI] and the deflection there [m].
struct DeflectionAt {
    double a = 0, deflection = 0;
};

// Zero of the deflection between two parameters by false position (Illinois); NaN where the leg fails.
double zero_between(const Pusher& pusher, const BranchSide& side, Leg leg, DeflectionAt from,
                    DeflectionAt to) {
    auto [a, f_a] = from;
    auto [b, f_b] = to;
    for (int k = 0; k < 60 && std::abs(b - a) > 1e-9 * std::abs(side.branch.to); ++k) {
        const double c = a + f_a / (f_a - f_b) * (b - a);
        double f_c = std::numeric_limits<double>::quiet_NaN();
        solve_at(side, leg, std::span(&c, 1),
                 [&](const Equilibrium& state) { f_c = deflection(pusher, side, state); });
        if (!std::isfinite(f_c)) return f_c;
        if (std::abs(f_c) <= 1e-3 * min_deflection) return c;
        if ((f_c > 0) != (f_b > 0)) {
            a = b;
            f_a = f_b;
        } else
            f_a /= 2;
        b = c;
        f_b = f_c;
    }
    return b;
}

}  // namespace

std::string LiftOff::text() const { return fmt::format("{} at {:.4g} {}", what, at, symbol(unit)); }

std::vector<LiftOff> lift_offs(const Model& model, const Branch& branch, Leg leg) {
    std::vector<LiftOff> list;
    if (pushers(model).empty()) return list;
    const auto sides = sides_of(model, branch);
    for (const BranchSide& side : sides) {
        const auto pushing = pushers(side.model);
        if (pushing.empty()) continue;
        std::vector<std::optional<DeflectionAt>> lasts(pushing.size());  // beyond min_deflection
        const auto note = [&](const std::string& what, double a) {
            const Unit unit = unit_of(branch.unit);
            list.push_back({what, parameter_in(unit, a), unit});
        };
        solve_at(side, leg, requested_parameters({side}, 1), [&](const Equilibrium& state) {
            for (std::size_t p = 0; p < pushing.size(); ++p) {
                const Pusher& pusher = pushing[p];
                const double now = deflection(pusher, side, state);
                if (std::abs(now) <= min_deflection) continue;
                auto& last = lasts[p];
                if (last && (last->deflection > 0) != (now > 0))
                    note(now > 0 ? pusher.returns : pusher.leaves,
                         zero_between(pusher, side, leg, *last, {state.load, now}));
                else if (!last && now < 0 && (state.load != 0 || &side == sides.data()))
                    note(pusher.leaves, 0);
                last = {state.load, now};
            }
        });
    }
    return list;
}

}  // namespace elastocheck::compare
