#include "reports/live/compliance.hpp"

#include <fmt/format.h>

#include "compare/comparison/compliance.hpp"
#include "compare/comparison/legs.hpp"
#include "reports/live/prepared.hpp"

namespace elastocheck::live {
namespace {

using json = nlohmann::ordered_json;

json matrix_json(const Model& model, const std::string& point, const Eigen::MatrixXd& C) {
    json rows = json::array();
    for (Eigen::Index r = 0; r < C.rows(); ++r) {
        json values = json::array();
        for (Eigen::Index c = 0; c < C.cols(); ++c)
            values.push_back(compare::in_table_units(C, r, c));
        rows.push_back(
            {{"name", compare::compliance_row_name(model, point, r)}, {"values", values}});
    }
    return rows;
}

}  // namespace

json compliance(Session& session, const std::vector<Setting>& settings) {
    const Model& model = prepared(session, settings).model;
    if (model.wheels.empty() || model.branches.empty()) return {{"why_not", "there is no wheel"}};
    const compare::BranchSide side = compare::sides_of(model, model.branches.front()).front();
    const EquilibriumPath start = compare::settle_start(side, compare::Leg::series);
    if (start.points.empty())
        return {{"why_not", fmt::format("{}: {}", name(start.outcome), start.detail)}};
    const Equilibrium& state = start.points.front();
    const auto response = compare::wheel_response(side, {.leg = compare::Leg::series},
                                                  compare::steering_joint(model), state);
    if (!response.why_not_free.empty()) return {{"why_not", response.why_not_free}};
    json answer = {{"causes", json::array()}};
    for (const Wheel& wheel : model.wheels)
        for (const char* cause :
             {"force x", "force y", "force z", "moment x", "moment y", "moment z"})
            answer["causes"].push_back((wheel.name.empty() ? "" : wheel.name + " ") + cause);
    answer["centre"] =
        matrix_json(model, "wheel centre",
                    compare::compliance(side.model, compare::WheelPoint::centre, state, response));
    answer["patch"] =
        matrix_json(model, "contact patch",
                    compare::compliance(side.model, compare::WheelPoint::patch, state, response));
    return answer;
}

}  // namespace elastocheck::live
