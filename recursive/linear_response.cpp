#include "recursive/linear_response.hpp"

#include <fmt/format.h>

#include "recursive/diagnosis/finite.hpp"
#include "recursive/formula/along.hpp"
#include "recursive/formula/number_rates.hpp"
#include "recursive/response_system.hpp"

namespace elastocheck::recursive {
namespace {

void check(const Model& model, const Equilibrium& state,
           std::span<const Disturbance> disturbances) {
    const auto require = [](bool met, const char* what) {
        if (!met) throw std::invalid_argument(what);
    };
    require(state.poses.size() == model.bodies.size(), "the state belongs to another model");
    for (const Disturbance& disturbance : disturbances)
        std::visit(overloaded{
                       [&](const UnitWrench& wrench) {
                           require(static_cast<std::size_t>(wrench.at.body) < model.bodies.size(),
                                   "a disturbance acts on no body of the model");
                       },
                       [&](const Motion& motion) {
                           const auto at = static_cast<std::size_t>(motion.joint);
                           require(at < model.joints.size() && model.joints[at].driven >= 0,
                                   "a disturbance drives a joint without offset, length or angle");
                       },
                   },
                   disturbance);
}

// Right-hand side of one disturbance. A wrench enters the upper rows. A motion of a joint enters
// the lower row as -∂Φ/∂c and the upper rows as the change of its reaction, -∂(Φ_qᵀ λ)/∂c.
void disturb(SteppingState& s, const Disturbance& disturbance) {
    s.upper.setZero();
    s.lower.setZero();
    std::visit(overloaded{
                   [&](const UnitWrench& wrench) {
                       add_load<double>(DeadForce{wrench.at, wrench.force}, 1, s.q, s.upper);
                       add_load<double>(DeadMoment{wrench.at.body, wrench.moment}, 1, s.q, s.upper);
                   },
                   [&](const Motion& motion) {
                       const std::size_t k = constraint_of(s.model, motion);
                       const int row = s.inputs.row[k];
                       const Row<double> d =
                           rate<double>(s.model.constraints[k].kind, s.inputs.offset[k], s.q);
                       s.lower[row] = -d.Phi;
                       if (d.i != ground) s.upper.segment<6>(6 * d.i) -= s.lambda[row] * d.on_i();
                       if (d.j != ground) s.upper.segment<6>(6 * d.j) -= s.lambda[row] * d.on_j();
                   },
               },
               disturbance);
}

std::string words(Outcome outcome, const Disturbance& disturbance, const Model& model,
                  const Diagnosis& diagnosis) {
    const std::string what = std::visit(
        overloaded{
            [&](const UnitWrench& wrench) {
                return fmt::format("a wrench on '{}'",
                                   model.bodies[static_cast<std::size_t>(wrench.at.body)].name);
            },
            [&](const Motion& motion) {
                return fmt::format("moving '{}'",
                                   model.joints[static_cast<std::size_t>(motion.joint)].name);
            }},
        disturbance);
    if (outcome == Outcome::loaded_idle_mode)
        return what +
               " acts on a motion that no joint or element resists at the design position: " +
               idle_modes(diagnosis);
    if (outcome == Outcome::inconsistent_constraints) return what + " would open redundant joints";
    return what;
}

// The responses [coordinates + rows of Φ × disturbances], with the matrix of `s`.
Response responses(SteppingState& s, const Branch& branch, const Analysis& analysis,
                   ResponseOrders& orders, bool consistent,
                   std::span<const Disturbance> disturbances, Matrix<double>* X) {
    const Model& model = s.model;
    Response response;
    const auto fail = [&](Outcome outcome, std::string detail) {
        response = {outcome, fmt::format("branch '{}': {}", branch.name, detail), {}};
        return response;
    };
    if (const Outcome outcome = factorise_response(s, consistent, orders);
        outcome != Outcome::converged)
        return fail(outcome, "the response to a small disturbance is not unique at the state");
    if (X != nullptr) X->resize(s.n() + s.m(), static_cast<Eigen::Index>(disturbances.size()));
    for (const Disturbance& disturbance : disturbances) {
        disturb(s, disturbance);
        // Redundant joints carry a wrench, in an undetermined distribution; they may not open.
        const Outcome outcome = answer_response(
            s, std::holds_alternative<Motion>(disturbance) ? Judged::all : Judged::idle_motions);
        if (outcome != Outcome::converged)
            return fail(outcome, words(outcome, disturbance, model, analysis.diagnosis));
        if (X != nullptr) X->col(static_cast<Eigen::Index>(response.increments.size())) = s.x;
        auto& increments = response.increments.emplace_back(model.bodies.size());
        for (std::size_t b = 0; b < increments.size(); ++b) {
            const auto at = static_cast<Eigen::Index>(6 * b);
            increments[b] = {s.x.segment<3>(at), s.x.segment<3>(at + 3)};
        }
    }
    return response;
}

// ---- The equations of a state that moves along several responses at once.

constexpr int at_once = 8;
using Moving = Along<at_once>;

struct MovingState {
    State<Moving> q;
    Vector<Moving> lambda;
    Inputs<Moving> inputs;
};

Inputs<Moving> constant(const Inputs<double>& inputs) {
    Inputs<Moving> all;
    all.row = inputs.row;
    all.offset.assign(inputs.offset.begin(), inputs.offset.end());
    all.load_factor.assign(inputs.load_factor.begin(), inputs.load_factor.end());
    for (const auto& rest : inputs.rest)
        all.rest.push_back({rest.free_length, rest.preload.cast<Moving>(), rest.piece});
    return all;
}

// Along the responses X [.. × at most at_once] to `disturbances`.
MovingState moving(const SteppingState& s, const Matrix<double>& X,
                   std::span<const Disturbance> disturbances) {
    const auto along = [&](Eigen::Index row) {
        Moving::Derivatives d = Moving::Derivatives::Zero();
        d.head(X.cols()) = X.row(row).transpose().array();
        return d;
    };
    const auto vector = [&](Eigen::Index row) {
        return Vector3<Moving>(Moving(0, along(row)), Moving(0, along(row + 1)),
                               Moving(0, along(row + 2)));
    };
    MovingState at{{}, s.lambda.cast<Moving>(), constant(s.inputs)};
    at.q.slots.resize(s.q.slots.size());
    for (BodyId b = 0; b < s.q.bodies(); ++b) {
        BodyState<Moving>& body = at.q[b];
        body.r = s.q[b].r.cast<Moving>() + vector(6 * b);
        const Matrix3<Moving> A = s.q[b].A.cast<Moving>();
        body.A = A + tilde(vector(6 * b + 3)) * A;
    }
    for (Eigen::Index k = 0; k < s.m(); ++k) at.lambda[k].d = along(s.n() + k);
    for (std::size_t t = 0; t < disturbances.size(); ++t)
        std::visit(overloaded{[](const UnitWrench&) {},
                              [&](const Motion& motion) {
                                  at.inputs.offset[constraint_of(s.model, motion)]
                                      .d[static_cast<Eigen::Index>(t)] = 1;
                              }},
                   disturbances[t]);
    return at;
}

// The derivative of the matrix of (24) along each response.
std::vector<Matrix<double>> tangent_rates(const Model& model, const Branch& branch,
                                          const MovingState& at, Eigen::Index responses) {
    const int n = coordinates(model), m = constraint_rows(model);
    Matrix<Moving> J = Matrix<Moving>::Zero(n + m, n + m);
    add_consistent_tangent<Moving>(model, branch, at.inputs, at.q, at.lambda, J);
    const Matrix<Moving> Phi_q = constraint_jacobian<Moving>(model, at.inputs, at.q);
    J.bottomLeftCorner(m, n) = Phi_q;
    J.topRightCorner(n, m) = Phi_q.transpose();
    std::vector<Matrix<double>> all;
    for (Eigen::Index t = 0; t < responses; ++t)
        all.push_back(J.unaryExpr([t](const Moving& entry) { return entry.d[t]; }));
    return all;
}

Eigen::Vector3d turn_of(BodyId b, const Eigen::Ref<const Vector<double>>& x) {
    return x.segment<3>(6 * b + 3);
}

}  // namespace

Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances, const Method& method,
                         ResponseAnalysis& of) {
    const Analysis& analysis = of.analysis;
    check(model, branch);
    check(model, state, disturbances);
    if (std::isnan(analysis.diagnosis.constraint_error))
        return {Outcome::not_finite,
                fmt::format("branch '{}': {}", branch.name, not_finite(model)),
                {}};
    SteppingState s(model, branch, analysis);
    s.q = state_of<double>(state.poses);
    go_to(s, {1, state.load});
    return responses(s, branch, analysis, of.orders, !std::holds_alternative<Linear>(method.kind),
                     disturbances, nullptr);
}

Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances, const Method& method) {
    check(model, branch);
    ResponseAnalysis analysis{analyse(model)};
    return linear_response(model, branch, state, disturbances, method, analysis);
}

ResponseRates response_rates(const Model& model, const Branch& branch, const Equilibrium& state,
                             std::span<const Disturbance> disturbances,
                             std::span<const Model> rates, ResponseAnalysis& of) {
    const Analysis& analysis = of.analysis;
    check(model, branch);
    check(model, state, disturbances);
    ResponseRates all;
    if (std::isnan(analysis.diagnosis.constraint_error)) {
        all.at = {Outcome::not_finite, not_finite(model), {}};
        return all;
    }
    SteppingState s(model, branch, analysis);
    s.q = state_of<double>(state.poses);
    go_to(s, {1, state.load});
    Matrix<double> X;
    all.at = responses(s, branch, analysis, of.orders, true, disturbances, &X);
    if (all.at.outcome != Outcome::converged) return all;

    const Eigen::Index count = X.cols();
    std::vector<MovingState> passes;
    std::vector<Matrix<double>> dJ;
    for (Eigen::Index first = 0; first < count; first += at_once) {
        const Eigen::Index here = std::min<Eigen::Index>(at_once, count - first);
        passes.push_back(moving(
            s, X.middleCols(first, here),
            disturbances.subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(here))));
        std::ranges::move(tangent_rates(model, branch, passes.back(), here),
                          std::back_inserter(dJ));
    }
    for (const Model& rate : rates) {
        ResponseRate& result = all.by.emplace_back();
        const Branch& branch_rate = rate.branches.front();
        const Inputs<double> input_rate = input_rates(model, branch, rate, branch_rate, state.load);
        const auto solve = [&](Judged judged) {
            result.outcome = answer_response(s, judged);
            if (result.outcome != Outcome::converged)
                result.detail = "the tangent has no derivative by the number: " +
                                idle_modes(analysis.diagnosis);
            return result.outcome == Outcome::converged;
        };
        const NumberRates<double> by =
            number_rates(model, branch, s.inputs, rate, branch_rate, input_rate, s.q, s.lambda);
        s.upper = by.upper, s.lower = by.lower;
        if (!solve(Judged::all)) continue;
        const Vector<double> x_p = s.x;
        NumberRates<Moving> along;  // the terms of the number along the responses of a pass
        for (Eigen::Index t = 0; t < count; ++t) {
            const auto at = static_cast<std::size_t>(t);
            const Eigen::Index in_pass = t % at_once;
            if (in_pass == 0) {
                const MovingState& moved = passes[at / at_once];
                along = number_rates<Moving>(model, branch, moved.inputs, rate, branch_rate,
                                             constant(input_rate), moved.q, moved.lambda);
            }
            const Vector<double> turned = dJ[at] * x_p;
            for (Eigen::Index k = 0; k < s.n(); ++k)
                s.upper[k] = along.upper[k].d[in_pass] - turned[k];
            for (Eigen::Index k = 0; k < s.m(); ++k)
                s.lower[k] = along.lower[k].d[in_pass] - turned[s.n() + k];
            // A wrench keeps its point of the body: moment (δπ × s) × f.
            std::visit(overloaded{[&](const UnitWrench& wrench) {
                                      const BodyId b = wrench.at.body;
                                      const Eigen::Vector3d lever = s.q[b].lever(wrench.at.s_local);
                                      s.upper.segment<3>(6 * b + 3) +=
                                          turn_of(b, x_p).cross(lever).cross(wrench.force);
                                  },
                                  [](const Motion&) {}},
                       disturbances[at]);
            if (!solve(Judged::idle_motions)) break;
            // The derivatives above turn a body by the response first, then by the number: in the
            // other order, which x_t is measured in, its rotation has δπ × π_t besides.
            auto& increments = result.increments.emplace_back(model.bodies.size());
            for (std::size_t b = 0; b < increments.size(); ++b) {
                const auto body = static_cast<BodyId>(b);
                increments[b] = {
                    s.x.segment<3>(6 * body),
                    turn_of(body, s.x) + turn_of(body, x_p).cross(turn_of(body, X.col(t)))};
            }
        }
    }
    return all;
}

}  // namespace elastocheck::recursive
