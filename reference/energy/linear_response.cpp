#include "reference/energy/linear_response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "models/overloaded.hpp"
#include "reference/energy/number_rates.hpp"
#include "reference/energy/state_tangent.hpp"

namespace elastocheck::reference::energy {
namespace {

using Eigen::VectorXd;

void check(const Model& model, std::span<const Disturbance> disturbances) {
    const auto require = [](bool met, const char* what) {
        if (!met) throw std::invalid_argument(what);
    };
    for (const auto& disturbance : disturbances)
        std::visit(
            overloaded{[&](const UnitWrench& wrench) {
                           require(static_cast<std::size_t>(wrench.at.body) < model.bodies.size(),
                                   "a disturbance acts on no body of the model");
                       },
                       [&](const Motion& motion) {
                           const auto joint = static_cast<std::size_t>(motion.joint);
                           require(joint < model.joints.size() && model.joints[joint].driven >= 0,
                                   "a disturbance drives a joint without offset");
                       }},
            disturbance);
}

// The prescribed quantities grow with s as along a branch that drives only this disturbance.
Prescribed rate_of(const Model& model, const Disturbance& disturbance) {
    Branch branch;
    const auto drive = [&](const Driven& what) { branch.drivers.push_back({what, 0, 1}); };
    std::visit(overloaded{[&](const UnitWrench& wrench) {
                              drive(Load{"", DeadForce{wrench.at, wrench.force}});
                              drive(Load{"", DeadMoment{wrench.at.body, wrench.moment}});
                          },
                          [&](const Motion& motion) { drive(motion); }},
               disturbance);
    return course_of(model, branch).rate;
}

std::string name_of(const Model& model, const Disturbance& disturbance) {
    return std::visit(
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
}

struct Responses {
    Response response;
    std::vector<Answer> answers;  // per disturbance
};
Responses responses(const Model& model, const Branch& branch, const StateTangent& tangent,
                    std::span<const Disturbance> disturbances) {
    Responses all;
    const auto fail = [&](Outcome outcome, const std::string& what) {
        all.response = {outcome, fmt::format("branch '{}': {}", branch.name, what), {}};
        return all;
    };
    if (tangent.failure) return fail(tangent.failure->outcome, tangent.failure->what);
    const Chart chart = chart_about(tangent.state.poses);
    const auto answered_to = [&](const Prescribed& rate) {
        VectorXd b = gradient_rate(model, tangent.prescribed, rate, chart);
        if (rate.offset.isZero(0)) return answer(tangent, b, {});
        const ConstraintRates rates = constraint_rates(model, tangent.prescribed, rate, chart);
        b += transposed_times(rates.Phi_qa, tangent.lambda);
        return answer(tangent, b, rates.Phi_a);
    };
    if (answered_to(tangent.course.rate).outcome == Outcome::loaded_idle_mode)
        return fail(Outcome::singular,
                    "the stiffness of a motion vanishes, the branch turns back here");
    for (const auto& disturbance : disturbances) {
        Answer answered = answered_to(rate_of(model, disturbance));
        if (answered.outcome != Outcome::converged)
            return fail(answered.outcome, name_of(model, disturbance) + ": " + answered.what);
        auto& increments = all.response.increments.emplace_back(model.bodies.size());
        for (std::size_t b = 0; b < increments.size(); ++b) {
            const auto at = static_cast<Eigen::Index>(6 * b);
            increments[b] = {answered.x.segment<3>(at), answered.x.segment<3>(at + 3)};
        }
        all.answers.push_back(std::move(answered));
    }
    return all;
}

// ---- Derivatives of the responses.

// h [m, rad]; the rounding of the Hessian, not h⁴, is what limits the differences
constexpr double difference = 1e-2;
constexpr double longest = 1e4;  // of a response that reactions alone carry [N, N·m]
constexpr int most_shorter = 3;  // steps of a thirtieth, where a knot of a law is within 2h
constexpr double rounding_of_terms = 64 * std::numeric_limits<double>::epsilon();
constexpr double alike = 1e-4;  // differences with h and 2h that no knot separates

// The state displaced by s of a response: the curvatures of its parts, and what number_rate() reads.
struct Displaced {
    StateTangent tangent;
    Parts parts;
};

// Change of the gradient, moments about the origins of the bodies, and of Φ.
struct Change {
    VectorXd b, Phi;
    VectorXd size = {};  // of the terms of b, which may cancel
    bool crosses_a_knot = false;
};

// By a motion (x, λ) and a number at one state. A gradient in the chart has the moment g_φ at its
// centre, whose change in ground axes has ½ π × g_φ besides (number_rates.hpp).
Change change_by(const Model& model, const Branch& branch, const Displaced& at, const Model& rate,
                 const VectorXd& x, const VectorXd& lambda) {
    const NumberRate number = number_rate(model, branch, rate, at.tangent, at.parts);
    Change change{number.b, number.Phi_rate, number.rounding / rounding_of_terms};
    const auto motion = [&](BodyId b) -> Vector6 {
        return b == ground ? Vector6(Vector6::Zero()) : Vector6(x.segment<6>(6 * b));
    };
    const auto add = [&](const PartCurvature& part, const Vector12& moved, Vector12 g) {
        const Vector12 size = part.H.cwiseAbs() * moved.cwiseAbs() + g.cwiseAbs();
        for (const int end : {0, 6})
            g.segment<3>(end + 3) +=
                0.5 * moved.segment<3>(end + 3).cross(part.g.segment<3>(end + 3));
        const auto add_end = [&](BodyId body, const auto& of_g, const auto& of_size) {
            if (body == ground) return;
            change.b.segment<6>(6 * body) += of_g;
            change.size.segment<6>(6 * body) += of_size;
        };
        add_end(part.i, g.head<6>(), size.head<6>());
        add_end(part.j, g.tail<6>(), size.tail<6>());
    };
    const auto moved = [&](const PartCurvature& part) {
        Vector12 both;
        both << motion(part.i), motion(part.j);
        return both;
    };
    for (const PartCurvature& part : at.parts.elements) {
        const Vector12 by = moved(part);
        add(part, by, part.H * by);
    }
    int row = 0;
    for (std::size_t k = 0; k < model.constraints.size(); ++k) {
        const PartCurvature& part = at.parts.constraints[k];
        const int count = rows(model.constraints[k].kind);
        const Vector12 by = moved(part);
        const auto Phi_x = part.Phi_x.topRows(count);
        add(part, by, part.H * by + Phi_x.transpose() * lambda.segment(row, count));
        change.Phi.segment(row, count) += Phi_x * by;
        row += count;
    }
    for (const DeadForce& force : at.tangent.prescribed.forces) {
        const BodyId b = force.at.body;
        const Eigen::Vector3d lever =
            at.tangent.state.poses[static_cast<std::size_t>(b)].p * force.at.s_local;
        change.b.segment<3>(6 * b + 3) -= x.segment<3>(6 * b + 3).cross(lever).cross(force.f);
    }
    return change;
}

Displaced displaced(const Model& model, const StateTangent& tangent, const Answer& along,
                    const Prescribed& rate, double s) {
    Displaced at{tangent, {}};
    Chart chart = chart_about(tangent.state.poses);
    move_to(chart, s * along.x);
    at.tangent.state.poses = poses(chart);
    at.tangent.lambda += s * multiplier_rates(tangent, along);
    at.tangent.prescribed = sum(tangent.prescribed, s, rate);
    at.parts = parts_of(model, at.tangent);
    return at;
}

// Per number: d/ds of its change along a response, by four states.
std::vector<Change> differences(const Model& model, const Branch& branch,
                                const StateTangent& tangent, const Answer& along,
                                const Prescribed& rate, std::span<const Model> rates,
                                std::span<const Answer> by_number, double h) {
    const auto at = [&](double s) { return displaced(model, tangent, along, rate, s); };
    const std::array states{at(h), at(-h), at(2 * h), at(-2 * h)};
    std::vector<Change> all;
    for (std::size_t p = 0; p < rates.size(); ++p) {
        Change& result = all.emplace_back();
        if (by_number[p].outcome != Outcome::converged) continue;
        const VectorXd lambda = multiplier_rates(tangent, by_number[p]);
        const auto change = [&](std::size_t k) {
            return change_by(model, branch, states[k], rates[p], by_number[p].x, lambda);
        };
        const Change up = change(0), down = change(1), far_up = change(2), far_down = change(3);
        const VectorXd near = (up.b - down.b) / (2 * h), far = (far_up.b - far_down.b) / (4 * h);
        result.b = (4 * near - far) / 3;
        result.Phi = (8 * (up.Phi - down.Phi) - (far_up.Phi - far_down.Phi)) / (12 * h);
        result.size = up.size;
        result.crosses_a_knot =
            largest(near - far) > alike * largest(near) + rounding_of_terms / h * largest(up.size);
    }
    return all;
}

}  // namespace

Response linear_response(const Model& model, const Branch& branch, const Equilibrium& state,
                         std::span<const Disturbance> disturbances) {
    check(model, disturbances);
    return responses(model, branch, tangent_at(model, branch, state), disturbances).response;
}

ResponseRates response_rates(const Model& model, const Branch& branch, const Equilibrium& state,
                             std::span<const Disturbance> disturbances,
                             std::span<const Model> rates) {
    check(model, disturbances);
    const StateTangent tangent = tangent_at(model, branch, state);
    Responses base = responses(model, branch, tangent, disturbances);
    ResponseRates all{std::move(base.response), {}};
    if (all.at.outcome != Outcome::converged) return all;
    all.by.resize(rates.size());

    // The motions by the numbers.
    const Parts parts = parts_of(model, tangent);
    std::vector<Answer> by_number;
    for (std::size_t p = 0; p < rates.size(); ++p) {
        const NumberRate number = number_rate(model, branch, rates[p], tangent, parts);
        by_number.push_back(answer(tangent, number.b,
                                   number.Phi_rate.isZero(0) ? VectorXd() : number.Phi_rate,
                                   number.rounding));
        if (by_number[p].outcome != Outcome::converged)
            all.by[p] = {by_number[p].outcome, by_number[p].what, {}};
    }
    for (std::size_t t = 0; t < disturbances.size(); ++t) {
        const Answer& along = base.answers[t];
        double size = 0;
        for (Eigen::Index b = 0; b < along.x.size(); b += 3)
            size = std::max(size, along.x.segment<3>(b).norm());
        const Prescribed rate = rate_of(model, disturbances[t]);
        std::vector<Change> changes;
        double h = size > 0 ? std::min(difference / size, longest) : longest;
        for (int shorter = 0; shorter <= most_shorter; ++shorter, h /= 30) {
            changes = differences(model, branch, tangent, along, rate, rates, by_number, h);
            if (std::ranges::none_of(changes, &Change::crosses_a_knot)) break;
        }
        for (std::size_t p = 0; p < rates.size(); ++p) {
            ResponseRate& result = all.by[p];
            if (result.outcome != Outcome::converged) continue;
            const Change& change = changes[p];
            const Answer answered =
                answer(tangent, change.b, change.Phi.isZero(0) ? VectorXd() : change.Phi,
                       rounding_of_terms / h * change.size);
            if (answered.outcome != Outcome::converged) {
                result = {answered.outcome, answered.what, {}};
                continue;
            }
            // The number turns a body after the response; in the other order, which the response is
            // measured in, its rotation has δπ × π_t besides.
            const VectorXd& x = by_number[p].x;
            auto& increments = result.increments.emplace_back(model.bodies.size());
            for (std::size_t b = 0; b < increments.size(); ++b) {
                const auto at = static_cast<Eigen::Index>(6 * b);
                const Eigen::Vector3d turn = x.segment<3>(at + 3),
                                      turn_t = along.x.segment<3>(at + 3);
                increments[b] = {answered.x.segment<3>(at),
                                 answered.x.segment<3>(at + 3) + turn.cross(turn_t)};
            }
        }
    }
    return all;
}

}  // namespace elastocheck::reference::energy
