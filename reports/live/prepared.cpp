#include "reports/live/prepared.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include "compare/comparison/trim.hpp"
#include "elastocheck/compile.hpp"

namespace elastocheck::live {
namespace {

bool same(const std::vector<Setting>& a, const std::vector<Setting>& b) {
    return std::ranges::equal(a, b, [](const Setting& x, const Setting& y) {
        return x.path == y.path && x.value == y.value;
    });
}

}  // namespace

Prepared& prepared(Session& session, const std::vector<Setting>& settings) {
    if (!session.parsed) throw std::logic_error("no scene is open");
    if (session.prepared && same(session.prepared->settings, settings)) return *session.prepared;
    auto prepared_model = std::make_shared<Prepared>();
    prepared_model->settings = settings;
    prepared_model->trimmed =
        compare::trim_by_series(session.parsed->read(settings), &session.trim);
    if (const auto& record = prepared_model->trimmed.record; record && !record->reached())
        throw std::invalid_argument("trim: " + record->detail);
    prepared_model->model = compile(prepared_model->trimmed.scene);
    session.prepared = std::move(prepared_model);
    return *session.prepared;
}

Prepared& prepared(Session& session, const Request& request) {
    Prepared& prepared_model = prepared(session, request.settings);
    if (prepared_model.branch == request.only && prepared_model.points == request.points)
        return prepared_model;
    const auto branch =
        std::ranges::find(prepared_model.model.branches, request.only, &Branch::name);
    if (branch == prepared_model.model.branches.end())
        throw std::invalid_argument(fmt::format("there is no branch '{}'", request.only));
    prepared_model.stations.clear(), prepared_model.paths.clear();
    prepared_model.sides = compare::sides_of(prepared_model.model, *branch, request.points);
    for (std::size_t side = 0; side < prepared_model.sides.size(); ++side)
        prepared_model.paths.push_back(
            compare::solve_branch(prepared_model.sides[side], {.leg = compare::Leg::series},
                                  [&](const Equilibrium& state) {
                                      if (side == 0 || state.load != 0)
                                          prepared_model.stations.push_back({side, state});
                                  }));
    std::ranges::sort(prepared_model.stations, {},
                      [](const auto& station) { return station.state.load; });
    prepared_model.branch = request.only;
    prepared_model.points = request.points;
    return prepared_model;
}

}  // namespace elastocheck::live
