// Reading a path: the configuration, the wrenches and the rates at a place.
#include <algorithm>
#include <limits>

#include "recursive/series/expand.hpp"
#include "recursive/series/path.hpp"
#include "recursive/series/polynomial.hpp"
#include "recursive/stepping/recording.hpp"

namespace elastocheck::recursive::series {
namespace {

// Tolerance on τ at a load where the load is the parameter: rounding of the reach and of the load
// itself, which is larger in τ for short expansions.
double tau_tolerance(const Expansion& x, double load) {
    constexpr double eps = std::numeric_limits<double>::epsilon();
    return 1e-12 * x.reach + 4 * eps * (std::abs(load) + std::abs(x.load[0])) / std::abs(x.load[1]);
}

}  // namespace

std::optional<Place> find(const Path& path, double load) {
    for (std::size_t k = 0; k < path.expansions.size(); ++k) {
        const Expansion& x = path.expansions[k];
        const double from = x.load[0], to = polynomial(x.load, x.reach);
        const bool linear = x.load.size() < 3 || x.load.tail(x.load.size() - 2).isZero(0);
        // The end is reached within rounding only.
        const double rounding = 1e-12 * std::abs(to - from);
        if (linear) {
            const double tau = (load - from) / x.load[1];
            if (tau >= -tau_tolerance(x, load) && tau <= x.reach + tau_tolerance(x, load))
                return Place{k, std::clamp(tau, 0.0, x.reach)};
        } else {
            if (std::abs(load - from) <= rounding) return Place{k, 0};
            if (const auto tau =
                    first_zero([&](double t) { return polynomial(x.load, t) - load; }, x.reach))
                return Place{k, *tau};
            if (k + 1 == path.expansions.size() && std::abs(load - to) <= rounding)
                return Place{k, x.reach};
        }
    }
    return std::nullopt;
}

Equilibrium evaluate(const Model& model, const Branch& branch, const Path& path, Place place) {
    const Expansion& expansion = path.expansions[place.expansion];
    Vector<double> x;
    horner(expansion.x, place.tau, x);
    const State<double> from = state_of<double>(expansion.start);
    State<double> q = from;
    displace(from, x, q);
    Equilibrium point{0, expansion.start, std::vector<Wrench>(model.joints.size()), 0};
    const double a = polynomial(expansion.load, place.tau);
    point.load = a;
    const Vector<double> lambda = x.tail(constraint_rows(model));
    record(model, inputs_at<double>(model, branch, a), q, {lambda, q}, point);
    return point;
}

EquilibriumPath sample(const Model& model, const Path& path, const Branch& branch, int points,
                       const PointVisitor& visit) {
    constexpr std::size_t max_batch = 64;  // points, so that memory does not grow with their number
    EquilibriumPath result;
    result.outcome = path.outcome;
    result.detail = path.detail;
    result.counts = path.counts;
    if (path.expansions.empty()) return result;
    Recording recording(model, points + 1, result, visit);
    double total_tau = 0, tau_before = 0;  // τ summed over all and over the previous expansions
    for (const auto& expansion : path.expansions) total_tau += expansion.reach;
    std::vector<double> loads, taus;
    Matrix<double> powers, x;
    Vector<double> lambda(constraint_rows(model));
    const Inputs<double> design_inputs = inputs_as_drawn<double>(model);
    Inputs<double> inputs;
    set_inputs<double>(model, branch, design_inputs, 1, 0, inputs);
    // Of the driven inputs, wrenches depend on joint offsets only.
    const bool drives_offset = std::ranges::any_of(
        branch.drivers, [](const Driver& driver) { return driven_joint(driver.what) >= 0; });
    for (std::size_t k = 0; k < path.expansions.size();) {
        const Expansion& expansion = path.expansions[k];
        const bool last = k + 1 == path.expansions.size();
        taus.clear();
        loads.clear();
        for (std::size_t next = recording.reached;
             next < recording.points && taus.size() < max_batch; ++next) {
            // Same expression as in the other methods, to the last bit: curves are compared at
            // equal loads only.
            const double load = branch.to * static_cast<double>(next) / points;
            double tau = path.arc_length
                             ? total_tau * static_cast<double>(next) / points - tau_before
                             : (load - expansion.load[0]) / expansion.load[1];
            const double rounding =
                path.arc_length ? 1e-12 * expansion.reach : tau_tolerance(expansion, load);
            const bool beyond = tau > expansion.reach + rounding;
            if (beyond && !(last && path.arc_length && next + 1 == recording.points)) break;
            tau = std::clamp(tau, 0.0, expansion.reach);
            taus.push_back(tau);
            loads.push_back(path.arc_length ? polynomial(expansion.load, tau) : load);
        }
        // Evaluates many points of the expansion at once: [x_0 ... x_p] [1 τ ... τ^p]ᵀ.
        powers.resize(expansion.x.cols(), static_cast<Eigen::Index>(taus.size()));
        for (Eigen::Index c = 0; c < powers.cols(); ++c) {
            double power = 1;
            for (Eigen::Index row = 0; row < powers.rows();
                 ++row, power *= taus[static_cast<std::size_t>(c)])
                powers(row, c) = power;
        }
        x.noalias() = expansion.x * powers;
        const State<double> from = state_of<double>(expansion.start);
        State<double> q = from;
        for (Eigen::Index c = 0; c < x.cols(); ++c) {
            const double load = loads[static_cast<std::size_t>(c)];
            displace(from, x.col(c), q);
            lambda = x.col(c).tail(lambda.size());
            if (drives_offset) set_inputs<double>(model, branch, design_inputs, 1, load, inputs);
            recording.keep(model, inputs, q, q, lambda, load);
        }
        if (taus.size() == max_batch) continue;  // the expansion may hold more points
        tau_before += expansion.reach;
        ++k;
    }
    recording.finish();
    return result;
}

Rates rates(const Path& path, Place place) {
    const Expansion& expansion = path.expansions[place.expansion];
    Vector<double> x;
    horner(expansion.x, place.tau, x);
    const Vector<double> dx = derivative(expansion.x, place.tau) / slope(expansion.load, place.tau);
    Rates result;
    for (std::size_t b = 0; b < expansion.start.size(); ++b) {
        const auto row = static_cast<Eigen::Index>(6 * b);
        const Eigen::Vector3d g = x.segment<3>(row + 3) / 2, dg = dx.segment<3>(row + 3) / 2;
        result.dr.push_back(dx.segment<3>(row));
        result.omega.push_back(2 / (1 + g.squaredNorm()) * (dg + g.cross(dg)));
    }
    return result;
}

}  // namespace elastocheck::recursive::series
