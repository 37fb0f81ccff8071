#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/comparison/legs.hpp"
#include "compare/deviation/deviation.hpp"
#include "compare/loads/loads.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/positions.hpp"
#include "models/branch.hpp"
#include "models/kinds.hpp"
#include "recursive/formula/elastic.hpp"
#include "recursive/formula/loads.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

constexpr const char* applied_loads = "applied";

// A joint or element on one of its bodies, several joints together, or the loads on a body.
struct Source {
    enum class Kind { joint, sum, element, applied } kind = Kind::joint;
    std::vector<int> parts = {};  // positions in the model: of the joints, or of the element
    BodyId body = ground;
    Point at = {};           // on the body
    bool is_second = false;  // the body is the second of the joint or element
};
struct Sources {
    std::vector<Source> list;
    std::vector<Pickup> pickups;
};

void add(const Model& model, Source source, std::string connection, Sources& sources) {
    const Vector3d drawn_point = position(design_state(model).poses, source.at);
    sources.pickups.push_back({body_name(model, source.body), std::move(connection), drawn_point});
    sources.list.push_back(std::move(source));
}

// The point of a joint on one of its bodies: that of its first constraint, which of a link is its end
// there; of a joint without points the joint's own.
Point on_body(const Model& model, int k, BodyId body) {
    const ModelJoint& joint = model.joints[static_cast<std::size_t>(k)];
    if (body == joint.i) return joint.at;
    for (const Constraint& constraint : model.constraints)
        if (constraint.joint == k)
            for (const Point& point : points_of(constraint.kind))
                if (point.body == body) return point;
    const auto drawn = design_state(model).poses;
    const Vector3d p = position(drawn, joint.at);
    return {body, pose(drawn, body).p.conjugate() * (p - pose(drawn, body).r)};
}

// Joints that are active in some case.
std::vector<bool> active_joints(const Model& model) {
    std::vector<bool> active(model.joints.size(), false);
    for (const Branch& branch : model.branches) {
        const Model standing = on_branch(model, branch);
        for (const auto& constraint : standing.constraints)
            active[static_cast<std::size_t>(constraint.joint)] = true;
    }
    return active;
}

Sources sources_of(const Model& model) {
    Sources sources;
    const auto active = active_joints(model);
    for (int k = 0; k < static_cast<int>(model.joints.size()); ++k) {
        const ModelJoint& joint = model.joints[static_cast<std::size_t>(k)];
        for (const bool is_second : {false, true}) {
            const BodyId body = is_second ? joint.j : joint.i;
            if (active[static_cast<std::size_t>(k)])
                add(model, {Source::Kind::joint, {k}, body, on_body(model, k, body), is_second},
                    joint.name, sources);
        }
    }
    for (const Channel& sum : sums(model)) {
        const Total& total = std::get<Total>(sum.reads);
        if (total.component != 0) continue;
        add(model,
            {Source::Kind::sum, total.joints, total.on,
             on_body(model, total.joints.front(), total.on)},
            element_of(sum), sources);
    }
    for (int k = 0; k < static_cast<int>(model.elastics.size()); ++k) {
        const Elastic& elastic = model.elastics[static_cast<std::size_t>(k)];
        if (elastic.active_only_where_driven) continue;
        for (const bool is_second : {false, true}) {
            const Point end = std::visit(
                [&](const auto& e) {
                    return is_second ? Point{e.j.body, e.j.s_local} : Point{e.i.body, e.i.s_local};
                },
                elastic.kind);
            add(model, {Source::Kind::element, {k}, end.body, end, is_second}, elastic.name,
                sources);
        }
    }
    for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b)
        add(model, {Source::Kind::applied, {}, b, {b, Vector3d::Zero()}}, applied_loads, sources);
    return sources;
}

// A state, with the inputs of the recursion's formulas for element forces.
struct Solved {
    const Model& model;
    const BranchSide& side;
    const Equilibrium& state;
    recursive::State<double> q;
    recursive::Inputs<double> inputs;
    Eigen::VectorXd external;  // at the bodies' origins [6nb]
};

Vector6 stacked(const Vector3d& force, const Vector3d& moment) {
    Vector6 w;
    w << force, moment;
    return w;
}

// Wrench of a joint on its first or second body about a point.
Vector6 joint_wrench(const Solved& solved, int joint, bool is_second, const Vector3d& about) {
    const Wrench& on_i = solved.state.reactions[static_cast<std::size_t>(joint)];
    const Vector3d lever =
        position(solved.state.poses, solved.model.joints[static_cast<std::size_t>(joint)].at) -
        about;
    return (is_second ? -1. : 1.) * stacked(on_i.force, on_i.moment + lever.cross(on_i.force));
}

// An element pulls its body j back by (F, M); on body i acts the opposite.
Vector6 element_wrench(const Solved& solved, const Source& source, const Vector3d& about) {
    const auto k = static_cast<std::size_t>(source.parts.front());
    const auto pull = recursive::element_force<double>(solved.side.model.elastics[k].kind,
                                                       solved.inputs.rest[k], solved.q);
    const Vector3d lever = pose(solved.state.poses, source.body).r +
                           (source.is_second ? pull.lever_j : pull.lever_i) - about;
    return (source.is_second ? -1. : 1.) * stacked(pull.F, pull.M + lever.cross(pull.F));
}

Vector6 wrench_of(const Solved& solved, const Source& source) {
    const Vector3d about = position(solved.state.poses, source.at);
    switch (source.kind) {
        case Source::Kind::joint:
            return joint_wrench(solved, source.parts.front(), source.is_second, about);
        case Source::Kind::element: return element_wrench(solved, source, about);
        case Source::Kind::applied: return solved.external.segment<6>(6 * source.body);
        case Source::Kind::sum: break;
    }
    Vector6 sum = Vector6::Zero();
    for (const int joint : source.parts) {
        const ModelJoint& j = solved.model.joints[static_cast<std::size_t>(joint)];
        if (j.i == source.body || j.j == source.body)
            sum += joint_wrench(solved, joint, j.j == source.body, about);
    }
    return sum;
}

// Infinite for the components of a joint's wrench that redundant joints share in a way that no load
// determines; else zero.
Vector6 undetermined(const Model& model, const BranchSide& side, const Source& source,
                     const Equilibrium& state, Analyses& analyses) {
    Vector6 mask = Vector6::Zero();
    if (source.kind != Source::Kind::joint) return mask;
    std::vector<Channel> six;
    for (int c = 0; c < 6; ++c)
        six.push_back({.name = "",
                       .unit = c < 3 ? Unit::newton : Unit::newton_metre,
                       .reads = Reaction{source.parts.front(), c}});
    const auto values = evaluate(model, side, six, state, analyses);
    for (int c = 0; c < 6; ++c)
        if (values[static_cast<std::size_t>(c)] == undefined) mask[c] = undefined;
    return mask;
}

Vector6 turned(const Eigen::Quaterniond& to_body, const Vector6& w) {
    if (!w.allFinite()) return Vector6::Constant(undefined);
    return stacked(to_body * w.head<3>(), to_body * w.tail<3>());
}

// The largest remainder |Σ F| or |Σ ((p - r_b) × F + M)| of a body, divided by the largest of the
// forces [N] and moments [N·m, about the origin r_b] that act on any body.
double imbalance_of(const Equilibrium& state, const std::vector<Source>& sources,
                    const std::vector<Vector6>& wrenches) {
    std::vector<Vector6> sums(state.poses.size(), Vector6::Zero());
    double largest = 0, remainder = 0;
    for (std::size_t k = 0; k < sources.size(); ++k) {
        if (sources[k].body == ground || sources[k].kind == Source::Kind::sum) continue;
        const auto b = static_cast<std::size_t>(sources[k].body);
        const Vector3d lever = position(state.poses, sources[k].at) - state.poses[b].r,
                       force = wrenches[k].head<3>();
        const Vector6 w = stacked(force, wrenches[k].tail<3>() + lever.cross(force));
        sums[b] += w;
        largest = std::max({largest, w.head<3>().norm(), w.tail<3>().norm()});
    }
    for (const Vector6& sum : sums)
        remainder = worse(remainder, std::max(sum.head<3>().norm(), sum.tail<3>().norm()));
    return largest > 0 ? remainder / largest : remainder;
}

// The state at the end of the case by a leg, or why there is none.
std::optional<Equilibrium> end_state(const BranchSide& side, Leg leg, SolvedCase& result) {
    std::optional<Equilibrium> state;
    const std::array end{side.branch.to};
    const EquilibriumPath path =
        solve_at(side, leg, end, [&](const Equilibrium& point) { state = point; });
    if (path.outcome == Outcome::converged && state) return state;
    result.outcome = path.outcome == Outcome::converged ? Outcome::branch_lost : path.outcome;
    result.detail = path.detail;
    return std::nullopt;
}

// Wrenches of all sources in a state.
std::vector<Vector6> wrenches_in(const Model& model, const BranchSide& side,
                                 const Equilibrium& state, const std::vector<Source>& sources) {
    Solved solved{model,
                  side,
                  state,
                  recursive::state_of<double>(state.poses),
                  recursive::inputs_at<double>(side.model, side.branch, side.branch.to),
                  {}};
    recursive::external_force<double>(side.model, side.branch, solved.inputs, solved.q,
                                      solved.external);
    std::vector<Vector6> wrenches;
    for (const Source& source : sources) wrenches.push_back(wrench_of(solved, source));
    return wrenches;
}

// Largest difference of the determined components of two solutions, as a share of the largest one.
double disagreement_of(const std::vector<PickupLoad>& ours, const std::vector<Vector6>& others) {
    double difference = 0, largest = 0;
    for (std::size_t k = 0; k < ours.size(); ++k)
        for (int c = 0; c < 6; ++c) {
            const double value = ours[k].in_ground_axes[c];
            if (value == undefined) continue;
            difference = worse(difference, std::abs(value - others[k][c]));
            largest = std::max(largest, std::abs(value));
        }
    return largest > 0 ? difference / largest : difference;
}

SolvedCase solve_case(const Model& model, const Branch& branch, const Sources& sources) {
    SolvedCase result;
    result.name = branch.name;
    const BranchSide side = sides_of(model, branch).front();
    const auto state = end_state(side, Leg::equilibrium, result);
    if (!state) return result;
    const auto wrenches = wrenches_in(model, side, *state, sources.list);
    Analyses analyses;
    for (std::size_t k = 0; k < wrenches.size(); ++k) {
        const Source& source = sources.list[k];
        const Vector6 w = wrenches[k] + undetermined(model, side, source, *state, analyses);
        result.loads.push_back({w, turned(pose(state->poses, source.body).p.conjugate(), w)});
    }
    result.imbalance = imbalance_of(*state, sources.list, wrenches);
    const auto second = end_state(side, Leg::series, result);
    result.disagreement =
        second ? disagreement_of(result.loads, wrenches_in(model, side, *second, sources.list))
               : nan;
    return result;
}

// Removes the pickups of applied loads on bodies that no case loads.
void drop_unloaded(PickupLoads& result) {
    for (std::size_t k = result.pickups.size(); k-- > 0;) {
        if (result.pickups[k].connection != applied_loads) continue;
        if (std::ranges::any_of(result.cases, [&](const SolvedCase& solved_case) {
                return !solved_case.loads.empty() && !solved_case.loads[k].in_ground_axes.isZero(0);
            }))
            continue;
        const auto offset = static_cast<std::ptrdiff_t>(k);
        result.pickups.erase(result.pickups.begin() + offset);
        for (auto& solved_case : result.cases)
            if (!solved_case.loads.empty())
                solved_case.loads.erase(solved_case.loads.begin() + offset);
    }
}

}  // namespace

PickupLoads pickup_loads(const Model& model) {
    Sources sources = sources_of(model);
    PickupLoads result{.pickups = sources.pickups, .cases = {}};
    for (const Branch& branch : model.branches)
        result.cases.push_back(solve_case(model, branch, sources));
    drop_unloaded(result);
    return result;
}

}  // namespace elastocheck::compare
