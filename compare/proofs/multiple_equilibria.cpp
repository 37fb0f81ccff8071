#include "compare/proofs/multiple_equilibria.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <random>
#include <span>
#include <utility>

#include "compare/comparison/legs.hpp"
#include "compare/deviation/agreement.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "reference/equilibrium/continuation/from_start.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using reference::certificate::ProofState;

// Two states are the same within this share of the scene's size, or of a radian.
constexpr double same_state = 1e-6;

// Distances of the starts along a soft motion, as shares of the scene's size, or of a radian.
constexpr std::array shares_along{0.03, 0.3, 1.0};

// Larger models are not searched: beside() computes no motions of them, and the many starts take long.
constexpr std::size_t max_bodies = 100;

// Attempts from one start, each with the newly found states deflated.
constexpr int max_attempts = 4;

constexpr int softest_motions = 3;  // motions along which starts are made beside every equilibrium
constexpr unsigned seed = 1;        // seed of the random poses

// Uniform in [-1, 1], reproducible with any standard library.
double draw(std::minstd_rand& random) { return 2 * static_cast<double>(random()) / 2147483647 - 1; }

// Mirrors every body's displacement about its design position.
std::vector<Pose> mirror_image(const Model& model, const std::vector<Pose>& poses) {
    std::vector<Pose> other;
    for (std::size_t b = 0; b < poses.size(); ++b) {
        const Pose& design = model.bodies[b].design;
        const Quaterniond turn = poses[b].p * design.p.conjugate();
        other.push_back({2 * design.r - poses[b].r, turn.conjugate() * design.p});
    }
    return other;
}

// Poses displaced at random by up to a share of `size` [m], and rotated by up to that share of about 1 rad per
// axis; the share is drawn once.
std::vector<Pose> random_poses(std::vector<Pose> poses, double size, std::minstd_rand& random) {
    const double share = 0.5 * (1 + draw(random));  // of the size, and of a radian
    for (Pose& pose : poses) {
        const double x = draw(random), y = draw(random), z = draw(random);
        const double u = draw(random), v = draw(random), w = draw(random);
        pose.r += share * size * Vector3d(x, y, z);
        pose.p = (Quaterniond(1, share * u, share * v, share * w) * pose.p).normalized();
    }
    return poses;
}

// Sets the largest displacement and rotation of a body of `found` from the poses `from`.
void set_distance(const Model& model, const std::vector<Pose>& from, FoundEquilibrium& found) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        const double length = (found.state.poses[b].r - from[b].r).norm(),
                     angle = found.state.poses[b].p.angularDistance(from[b].p);
        if (length > found.length || found.body.empty()) {
            found.length = length;
            found.body = model.bodies[b].name;
        }
        found.angle = std::max(found.angle, angle);
    }
}

// Whether the boxes of two proofs are disjoint: some body's poses are separated by more
// than both bounds.
bool are_distinct(const FoundEquilibrium& a, const FoundEquilibrium& b) {
    for (std::size_t k = 0; k < a.state.poses.size(); ++k) {
        const Pose &p = a.state.poses[k], &q = b.state.poses[k];
        if ((p.r - q.r).norm() > a.proof.error.length + b.proof.error.length) return true;
        if (p.p.angularDistance(q.p) > a.proof.error.angle + b.proof.error.angle) return true;
    }
    return false;
}

// Whether a joint is assembled in reverse. Two perpendicular directions u_i ⟂ v_j, w_j keep the
// axis u_i along ±v_j × w_j, and three fix the rotation up to half turns; the design position
// selects the sign.
bool has_reversed_joint(const Model& model, const Equilibrium& state) {
    const auto axes = [&](BodyId body, bool drawn) {
        if (body == ground) return Quaterniond::Identity();
        const auto b = static_cast<std::size_t>(body);
        return drawn ? model.bodies[b].design.p : state.poses[b].p;
    };
    std::vector<std::vector<const PerpendicularDirections*>> rows_of_joint(model.joints.size());
    for (const auto& constraint : model.constraints)
        if (const auto* row = std::get_if<PerpendicularDirections>(&constraint.kind))
            rows_of_joint[static_cast<std::size_t>(constraint.joint)].push_back(row);
    for (const auto& rows : rows_of_joint) {
        if (rows.size() < 2) continue;
        const BodyId i = rows[0]->i.body, j = rows[0]->j.body;
        const Quaterniond drawn = axes(j, true).conjugate() * axes(i, true),
                          now = axes(j, false).conjugate() * axes(i, false);
        if (rows.size() > 2 ? now.angularDistance(drawn) > 1.5 : [&] {
                const Vector3d across = rows[0]->j.u_local.cross(rows[1]->j.u_local),
                               &u = rows[0]->i.u_local;
                return (drawn * u).dot(across) * (now * u).dot(across) < 0;
            }())
            return true;
    }
    return false;
}

// Sentence on what an equilibrium means for the suspension.
std::string meaning_of(const AllEquilibria& equilibria, const FoundEquilibrium& equilibrium) {
    const std::string away =
        fmt::format("{:.4g} mm away ('{}')", 1e3 * equilibrium.length, equilibrium.body);
    if (equilibrium.on_branch)
        return equilibrium.stable ? "on the branch" : "on the branch, and unstable";
    if (!equilibria.has_start)
        return fmt::format("{}, {} from the design position, from which no branch begins",
                           equilibrium.stable ? "stable" : "unstable", away);
    if (!equilibrium.stable)
        return fmt::format("unstable, {}: a motion past it does not return", away);
    if (equilibria.outcome == Outcome::converged)
        return fmt::format("another stable equilibrium, {}: it can snap over to it", away);
    return fmt::format("stable, {} from the end of the branch: it may {} it there", away,
                       equilibria.outcome == Outcome::limit_point ? "snap over to" : "go over to");
}

}  // namespace

int AllEquilibria::stable() const {
    return static_cast<int>(std::ranges::count(list, true, &FoundEquilibrium::stable));
}

AllEquilibria find_equilibria(const Model& model, const Branch& branch, double a,
                              const FindOptions& options) {
    namespace leg = reference::equilibrium;
    const auto sides = sides_of(model, branch);
    const BranchSide& side = side_at(sides, a);
    AllEquilibria equilibria{branch.name, unit_of(branch.unit), a};
    const auto report = [&](const std::string& what) {
        if (options.progress) options.progress(fmt::format("{}: {}", branch.name, what), nan);
    };

    if (model.bodies.size() > max_bodies) {
        equilibria.outcome = Outcome::too_large;
        equilibria.detail = fmt::format("{} bodies, equilibria are searched for up to {}",
                                        model.bodies.size(), max_bodies);
        return equilibria;
    }

    // The equilibria on the branch as it is traced.
    report("the branch");
    std::vector<double> parameters;
    constexpr int intervals = 8;
    for (int k = 0; k <= intervals; ++k) parameters.push_back(a * k / intervals);
    EquilibriumPath path = leg::solve(side.model, side.branch, parameters);
    equilibria.outcome = path.outcome;
    equilibria.detail = path.detail;
    const bool reaches_a = path.outcome == Outcome::converged;
    std::vector<Equilibrium> known;

    const auto is_known = [&](const Equilibrium& state) {
        return std::ranges::any_of(known, [&](const Equilibrium& other) {
            return leg::distance(side.model, side.branch, other, state) <= same_state;
        });
    };
    const std::vector<Pose> drawn = design_state(side.model).poses;
    const std::vector<Pose> reached = path.points.empty() ? drawn : path.points.back().poses;
    std::deque<std::vector<Pose>> starts;
    const auto add = [&](const leg::FromStart& attempt, bool on_branch) {
        if (attempt.outcome != Outcome::converged || is_known(attempt.state)) return;
        known.push_back(attempt.state);
        if (has_reversed_joint(side.model, attempt.state)) {
            ++equilibria.with_reversed_joint;
            return;
        }
        bool is_turned_over = false;
        for (std::size_t b = 0; b < reached.size(); ++b)
            is_turned_over = is_turned_over || attempt.state.poses[b].p.angularDistance(
                                                   reached[b].p) > options.max_rotation;
        if (is_turned_over && !on_branch) {
            ++equilibria.with_overturned_body;
            return;
        }
        FoundEquilibrium entry{attempt.state, {}, attempt.stable, attempt.stiffness, on_branch};
        equilibria.list.push_back(std::move(entry));
        for (auto& start :
             leg::beside(side.model, side.branch, attempt.state, softest_motions, shares_along))
            starts.push_back(std::move(start));
        report(fmt::format("{} found", known.size()));
    };
    if (reaches_a) add(leg::solve_from(side.model, side.branch, a, path.points.back().poses), true);
    for (auto point = path.points.rbegin(); point != path.points.rend(); ++point) {
        starts.push_back(point->poses);
        starts.push_back(mirror_image(side.model, point->poses));
    }
    starts.push_back(drawn);
    const double size = scale_of(side.model, side.branch, path.points).length;
    std::minstd_rand random(seed);
    for (int k = 0; k < options.random_starts; ++k)
        starts.push_back(random_poses(reached, size, random));
    for (; !starts.empty(); starts.pop_front()) {
        const auto start = starts.front();
        // The first attempt is without deflation, whose longer steps may cross the knot of a stop and
        // diverge.
        for (int k = 0; k < max_attempts; ++k) {
            const std::size_t known_before = known.size();
            ++equilibria.starts;
            const std::span<const Equilibrium> away_from(known.data(), k == 0 ? 0 : known.size());
            add(leg::solve_from(side.model, side.branch, a, start, away_from), false);
            if (k > 0 && known.size() == known_before) break;
        }
    }

    equilibria.has_start = !path.points.empty();
    equilibria.proved = !equilibria.list.empty();
    for (auto& entry : equilibria.list) {
        report("proof");
        entry.proof = reference::certificate::certify(side.model, side.branch, entry.state);
        equilibria.proved &= entry.proof.state == ProofState::proved;
        set_distance(side.model, reached, entry);
        entry.meaning = meaning_of(equilibria, entry);
    }
    for (std::size_t i = 0; i < equilibria.list.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            equilibria.proved &= are_distinct(equilibria.list[i], equilibria.list[j]);
    std::ranges::stable_sort(equilibria.list, [](const auto& entry, const auto& other) {
        return std::pair(!entry.on_branch, entry.length) <
               std::pair(!other.on_branch, other.length);
    });
    return equilibria;
}

}  // namespace elastocheck::compare
