#include "recursive/formula/load_growth.hpp"

#include "recursive/formula/elastic.hpp"
#include "recursive/formula/inputs.hpp"

namespace elastocheck::recursive {
namespace {

// Splits a spring with the force u'(x) into one with u'(x) - k x, which replaces it, and a linear
// spring k x, whose free length can be driven. Returns the linear spring, with a free length F / k
// longer: its force at the design position is less by F.
AxialSpring split(AxialSpring& spring, double k, double F) {
    AxialSpring linear = spring;
    linear.law = LinearRate{k};
    linear.free_length += F / k;
    Curve& curve = std::get<Curve>(spring.law);
    for (std::size_t p = 0; p < curve.pieces.size(); ++p) {
        curve.pieces[p][0] -= k * curve.knots[p == 0 ? 0 : p - 1];
        curve.pieces[p][1] -= k;
    }
    return linear;
}

bool is_driven(const Branch& branch, int element) {
    return std::ranges::any_of(branch.drivers, [&](const Driver& driver) {
        return driven_element(driver.what) == element;
    });
}

}  // namespace

std::optional<GrowingForces> with_growing_forces(const Model& model, const Branch& branch) {
    GrowingForces result{model, branch};
    auto& drivers = result.branch.drivers;
    for (const Load& load : model.static_loads) drivers.push_back({load, 1, 0});
    result.model.static_loads.clear();
    const State<double> q = design_state<double>(model);
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const int element = static_cast<int>(k);
        ElasticKind& kind = result.model.elastics[k].kind;
        if (double* free_length = driven_number(kind)) {
            // with ℓ₀ = 0 the deflection is ℓ
            const double length = deflections<double>(kind, Rest<double>{}, q)[0];
            if (!(length > 0) || length == *free_length) continue;
            if (curve_of(kind, 0) == nullptr) {
                drivers.push_back({FreeLength{element}, *free_length - length, 0});
                *free_length = length;
            } else if (!is_driven(branch, element)) {
                auto& spring = std::get<AxialSpring>(kind);
                const double x = length - *free_length, force = gradient<double>(spring.law, x),
                             rate = hessian<double>(spring.law, [&] { return x; });
                if (force == 0 || !std::isfinite(force)) continue;
                const double k_linear = std::max(std::abs(rate), std::abs(force) / length);
                auto linear = model.elastics[k];
                linear.kind = split(spring, k_linear, force);
                drivers.push_back({FreeLength{static_cast<int>(result.model.elastics.size())},
                                   -force / k_linear, 0});
                result.model.elastics.push_back(linear);
            }
            continue;
        }
        if (Vector6<double>* wrench = preload(kind)) {
            const Vector6<double> stress =
                gradient<double>(*member<SpatialLaw>(kind),
                                 deflections<double>(kind, Rest<double>{}, q), everywhere) +
                *wrench;
            if (stress.isZero(0) || !stress.allFinite()) continue;
            drivers.push_back({Preload{element, stress}, 1, 0});
            *wrench -= stress;
        }
    }
    if (drivers.size() == branch.drivers.size()) return std::nullopt;
    result.model.branches = {result.branch};
    return result;
}

}  // namespace elastocheck::recursive
