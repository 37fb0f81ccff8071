// Trims of scenes with unloaded or balanced bushings (Trim::Bushings; elastocheck/trim.hpp).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <vector>

#include "compare/comparison/trim_once.hpp"
#include "compare/outputs/deformation.hpp"
#include "elastocheck/trim.hpp"
#include "models/eigen/dense.hpp"
#include "models/kinds.hpp"

namespace elastocheck::compare {
namespace {

// Largest displacement of a body from its drawn position in a balanced scene [m, rad].
constexpr double drawn_tolerance = 1e-12;
constexpr int max_corrections = 30;  // corrections of the preloads

bool is_balanced(const Elastic& element) {
    return preload(element.kind) != nullptr && element.written_as == WrittenAs::itself &&
           !element.active_only_where_driven;
}

// Largest displacement [m] or rotation [rad] of a body from its drawn position.
double largest_displacement(const SettledTrim& settled) {
    double largest = 0;
    for (std::size_t b = 0; b < settled.state.poses.size(); ++b) {
        const Pose &drawn = settled.side.model.bodies[b].design,
                   &settled_pose = settled.state.poses[b];
        largest = std::max(
            {largest, (settled_pose.r - drawn.r).norm(), settled_pose.p.angularDistance(drawn.p)});
    }
    return largest;
}

// Force that each balanced bushing gains while the model settles from the drawn position to x,
// u'(e(x)) - u'(e(drawn)) [N, N·m], by name, in the axes in which the scene states the bushing.
std::map<std::string, Vector6> loads_of_bushings(const SettledTrim& settled) {
    std::map<std::string, Vector6> loads;
    const Model& model = settled.side.model;
    const Equilibrium drawn = design_state(model);
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const Elastic& element = model.elastics[k];
        if (!is_balanced(element)) continue;
        const auto force_in = [&](const Equilibrium& state) {
            return force(element.kind, deformation(element.kind, k, settled.side.branch, state));
        };
        loads[element.name] =
            (element.markers_swapped ? -1 : 1) * (force_in(settled.state) - force_in(drawn));
    }
    return loads;
}

// Anderson's method (1965) for r(P) = 0, P the preloads [N, N·m] and r the loads that the bushings
// gain while the model settles. The columns of dP and dr are the changes of P and r from one
// correction to the next:
//
//   P ← P + r - (dP + dr) γ,   γ minimises |r - dr γ|
//
// P ← P + r alone takes hundreds of corrections where springs take over much of the load of the
// bushings, as in the soft motion of a subframe.
struct Corrections {
    Eigen::VectorXd P, r;    // of the last correction, six rows per bushing
    Eigen::MatrixXd dP, dr;  // a column per correction but the first
};

// Adds the next correction of Anderson's method to the preloads of the scene.
void correct_preloads(Scene& scene, const std::map<std::string, Vector6>& loads,
                      Corrections& history) {
    std::vector<Vector6*> preloads;
    for (Elastic& element : scene.elastics)
        if (loads.contains(element.name))
            preloads.push_back(&std::get<Bushing>(element.kind).preload);
    Eigen::VectorXd P(6 * std::ssize(preloads)), r(P.size());
    Eigen::Index row = 0;
    for (const Elastic& element : scene.elastics)
        if (const auto load = loads.find(element.name); load != loads.end()) {
            P.segment<6>(row) = std::get<Bushing>(element.kind).preload;
            r.segment<6>(row) = load->second;
            row += 6;
        }
    Eigen::VectorXd next = P + r;
    if (history.P.size() == P.size()) {
        const Eigen::Index k = history.dP.cols();
        history.dP.conservativeResize(P.size(), k + 1);
        history.dP.col(k) = P - history.P;
        history.dr.conservativeResize(P.size(), k + 1);
        history.dr.col(k) = r - history.r;
        next -= (history.dP + history.dr) * solve_by_qr(history.dr, r);
    }
    history.P = P;
    history.r = r;
    for (std::size_t k = 0; k < preloads.size(); ++k)
        *preloads[k] = next.segment<6>(6 * static_cast<Eigen::Index>(k));
}

// Throws std::invalid_argument if a condition requests another value than that of the drawn position.
void require_drawn_values(const Scene& scene) {
    const Eigen::VectorXd differences = requested_from_drawn(scene);
    for (Eigen::Index k = 0; k < differences.size(); ++k)
        if (!(std::abs(differences[k]) <= accepted_residual))
            throw std::invalid_argument(
                fmt::format("'{}' differs from its value as drawn, and with balanced bushings the "
                            "drawn position "
                            "is the equilibrium; give its name alone, or `bushings: unloaded`",
                            scene.trim->until[static_cast<std::size_t>(k)].name));
}

// Records the preload of each balanced bushing, and by how much its force changed.
void record_preloads(const Scene& scene, const Scene& balanced, TrimRecord& record) {
    for (std::size_t k = 0; k < scene.elastics.size(); ++k) {
        if (!is_balanced(scene.elastics[k])) continue;
        const auto preload_in = [&](const Scene& source) {
            return std::get<Bushing>(source.elastics[k].kind).preload;
        };
        const Vector6 P = preload_in(balanced);
        const double force = (P - preload_in(scene)).head<3>().norm();
        record.adjusted.push_back(
            {"bushings." + scene.elastics[k].name + ".preload", Unit::newton, force,
             fmt::format("force ({:.5g}, {:.5g}, {:.5g}) N, moment ({:.4g}, {:.4g}, {:.4g}) N·m "
                         "along its axes",
                         P[0], P[1], P[2], P[3], P[4], P[5])});
    }
}

Trimmed trim_by(const Scene& scene, Leg solver, bool confirm, TrimStart* start) {
    if (!scene.trim) return {scene, std::nullopt};
    if (scene.trim->bushings == Trim::Bushings::unloaded)
        return trim_once(scene, solver, confirm, start, nullptr);
    require_drawn_values(scene);
    Scene loaded = scene;
    TrimStart last;
    if (start != nullptr) last = *start;
    double distance = 0;
    Corrections corrections;
    for (int k = 0; k < max_corrections; ++k) {
        SettledTrim settled;
        Trimmed trimmed = trim_once(loaded, solver, false, &last, &settled);
        if (!trimmed.record->reached()) return {scene, trimmed.record};
        distance = largest_displacement(settled);
        if (distance <= drawn_tolerance) {
            if (start != nullptr) *start = last;
            if (confirm) trimmed = trim_once(loaded, solver, true, &last, nullptr);
            if (!trimmed.record->reached()) return {scene, trimmed.record};
            trimmed.record->bushings = Trim::Bushings::balanced;
            record_preloads(scene, trimmed.scene, *trimmed.record);
            return trimmed;
        }
        correct_preloads(loaded, loads_of_bushings(settled), corrections);
    }
    TrimRecord record;
    record.outcome = Outcome::iteration_limit;
    record.detail = fmt::format(
        "the bushings are not balanced after {} corrections: a body still settles {:.3g} mm from "
        "where it is drawn",
        max_corrections, 1e3 * distance);
    return {scene, record};
}

}  // namespace

const char* name(Trim::Bushings bushings) {
    return bushings == Trim::Bushings::balanced ? "balanced" : "unloaded";
}

Trimmed trim(const Scene& scene) { return trim_by(scene, Leg::equilibrium, true, nullptr); }
Trimmed trim_by_series(const Scene& scene, TrimStart* start) {
    return trim_by(scene, Leg::series, false, start);
}
Trimmed trim_not_confirmed(const Scene& scene, TrimStart* start) {
    return trim_by(scene, Leg::equilibrium, false, start);
}

}  // namespace elastocheck::compare
