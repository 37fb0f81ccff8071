#include "reports/live/proof.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compare/outputs/curve.hpp"
#include "reference/certificate/certificate.hpp"
#include "reports/live/prepared.hpp"

namespace elastocheck::live {
namespace {

namespace certificate = reference::certificate;
using json = nlohmann::ordered_json;

json millimetres(double length) {
    return std::isfinite(length) ? json(1e3 * length) : json(nullptr);
}

// The limit points in which sides of the branch end, each from its last station.
json limits_of(const Prepared& prepared_model, compare::Unit unit) {
    json list = json::array();
    for (std::size_t side = 0; side < prepared_model.sides.size(); ++side) {
        if (prepared_model.paths[side].outcome != Outcome::limit_point) continue;
        const Equilibrium* last = nullptr;
        for (const auto& station : prepared_model.stations)
            if (station.side == side &&
                (last == nullptr || std::abs(station.state.load) > std::abs(last->load)))
                last = &station.state;
        if (last == nullptr) continue;
        // The last station starts the search; it claims no accuracy.
        constexpr certificate::Tolerance anywhere{1, 1, 1e9, 1e9};
        const auto found = certificate::certify_limit_point(
            prepared_model.sides[side].model, prepared_model.sides[side].branch, *last, anywhere);
        list.push_back({{"answer", name(found.state)},
                        {"detail", found.detail},
                        {"from", in_unit(unit) * found.from},
                        {"to", in_unit(unit) * found.to}});
    }
    return list;
}

}  // namespace

json prove(Session& session, const Request& request, int first, int count) {
    const Prepared& prepared_model = prepared(session, request);
    const certificate::Tolerance claim;
    json answer = {
        {"claim", {{"mm", 1e3 * claim.length}, {"deg", claim.angle * 180 / std::numbers::pi}}},
        {"stations", json::array()}};
    const auto end = std::min<std::ptrdiff_t>(std::ptrdiff_t{first} + std::max(count, 0),
                                              std::ssize(prepared_model.stations));
    for (std::ptrdiff_t k = std::max(first, 0); k < end; ++k) {
        const auto& station = prepared_model.stations[static_cast<std::size_t>(k)];
        const compare::BranchSide& side = prepared_model.sides[station.side];
        const auto found = certificate::certify(side.model, side.branch, station.state, claim);
        answer["stations"].push_back(
            {{"a", compare::parameter_in(compare::unit_of(side.branch.unit), station.state.load)},
             {"answer", name(found.state)},
             {"detail", found.detail},
             {"error_mm", millimetres(found.error.length)},
             {"unique_mm", millimetres(found.unique.length)},
             {"stable", found.stable}});
    }
    if (end == std::ssize(prepared_model.stations) && !prepared_model.sides.empty())
        answer["limits"] =
            limits_of(prepared_model, compare::unit_of(prepared_model.sides.front().branch.unit));
    return answer;
}

}  // namespace elastocheck::live
