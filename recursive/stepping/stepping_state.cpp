#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive {

std::vector<std::vector<Moved>> moved_elements(const Model& model, const Held<double>& held) {
    std::vector<std::vector<std::size_t>> on_body(model.bodies.size());
    for (std::size_t k = 0; k < model.elastics.size(); ++k) {
        const auto [i, j] = bodies_of(model.elastics[k].kind);
        for (const BodyId b : {i, j})
            if (b != ground) on_body[static_cast<std::size_t>(b)].push_back(k);
    }
    std::vector<std::vector<Moved>> of_modes(static_cast<std::size_t>(held.idle));
    for (int c = 0; c < held.idle; ++c) {
        auto& moved = of_modes[static_cast<std::size_t>(c)];
        for (int e = held.begin(c); e < held.end(c); e += 6)
            for (const std::size_t k :
                 on_body[static_cast<std::size_t>(held.row[static_cast<std::size_t>(e)] / 6)]) {
                const auto [i, j] = bodies_of(model.elastics[k].kind);
                moved.push_back({k, held.at(c, i), held.at(c, j)});
            }
        std::ranges::sort(moved, {}, &Moved::element);
        const auto same = [](const Moved& a, const Moved& b) { return a.element == b.element; };
        moved.erase(std::unique(moved.begin(), moved.end(), same), moved.end());
    }
    return of_modes;
}

double load_on_idle_modes(const SteppingState& s, const Vector<double>& force, double whole) {
    const Held<double>& held = s.system.held;
    double worst = 0;
    for (int c = 0; c < held.idle; ++c) {
        double work = 0;
        for (int e = held.begin(c); e < held.end(c); e += 6) {
            const auto at = static_cast<std::size_t>(e);
            work += Eigen::Map<const Vector6<double>>(held.value.data() + e)
                        .dot(force.segment<6>(held.row[at]));
        }
        if (whole > 0) worst = std::max(worst, std::abs(work) / whole);
    }
    return worst;
}

double strain_of_held(SteppingState& s, const State<double>& q) {
    const Held<double>& held = s.system.held;
    double worst = 0;
    for (int c = 0; c < held.idle; ++c) {
        double energy = 0, single = 0;
        for (const auto& [k, at_i, at_j] : s.idle.moved[static_cast<std::size_t>(c)]) {
            const auto e = element_stiffness<double>(s.model.elastics[k].kind, s.inputs.rest[k], q);
            // a curve may have a negative slope
            const Vector6<double> rates = e.K.diagonal().cwiseAbs();
            const double k_T = rates.head<3>().sum(), k_R = rates.tail<3>().sum();
            Vector6<double> de = Vector6<double>::Zero();
            const auto end = [&](int at, const Vector3<double>& lever, double sign) {
                if (at < 0) return;
                const Eigen::Map<const Vector6<double>> z(held.value.data() + at);
                const Vector3<double> v = z.head<3>(), w = z.tail<3>();
                de.head<3>() += sign * (v - lever.cross(w));
                de.tail<3>() += sign * w;
                single +=
                    k_T * (v.squaredNorm() + s.setup.length * s.setup.length * w.squaredNorm()) +
                    k_R * w.squaredNorm();
            };
            end(at_i, e.s_i, -1);
            end(at_j, e.s_j, +1);
            energy += de.dot(e.K * de);
        }
        if (single > 0) worst = std::max(worst, std::sqrt(std::abs(energy) / single));
    }
    for (int c = held.idle; c < held.size(); ++c) {
        const SaddleMatrix<double>& M = s.system.M;
        // Adds the generalised forces of y on the bodies of its rows, each body once.
        const auto each_end = [&](auto&& visit) {
            for (int e = held.begin(c); e < held.end(c); ++e) {
                const int row = held.row[static_cast<std::size_t>(e)] - M.n;
                for (int end = 0; end < 2; ++end)
                    if (const BodyId b =
                            M.ends[static_cast<std::size_t>(row)][static_cast<std::size_t>(end)];
                        b != ground)
                        visit(row, end, s.work.force.segment<6>(6 * b),
                              held.value[static_cast<std::size_t>(e)]);
            }
        };
        double sum = 0, whole = 0;  // |Φ_qᵀ y|², Σ |y_k| |row k|
        each_end([](int, int, auto&& f, double) { f.setZero(); });
        each_end([&](int row, int end, auto&& f, double y) { f += y * M.part(row, end); });
        each_end([&](int, int, auto&& f, double) {
            sum += f.squaredNorm();
            f.setZero();
        });
        for (int e = held.begin(c); e < held.end(c); ++e) {
            const int row = held.row[static_cast<std::size_t>(e)] - M.n;
            whole += std::abs(held.value[static_cast<std::size_t>(e)]) *
                     std::sqrt(M.part(row, 0).squaredNorm() + M.part(row, 1).squaredNorm());
        }
        if (whole > 0) worst = std::max(worst, std::sqrt(sum) / whole);
    }
    return worst;
}

bool has_diverged(SteppingState& s) {
    const auto weighted = s.step.dq.array() * s.system.weight.head(s.n()).array();
    const double size = weighted.matrix().squaredNorm(), size_before = s.step.last.squaredNorm();
    if (s.setup.consistent)
        s.step.equilibrium_distance = (weighted - s.step.last.array()).matrix().norm();
    const bool comparable = s.kinks.uncompared == 0;
    if (!comparable) --s.kinks.uncompared;
    const bool swung =
        comparable && (weighted * s.step.last.array()).sum() < 0 && size > size_before;
    const bool too_long =
        comparable && s.setup.consistent && size_before > 0 &&
        disagree(s, (weighted - s.step.last.array()).matrix().squaredNorm(), size, size_before);
    s.step.swings = swung ? s.step.swings + 1 : 0;
    s.step.last = weighted;
    double turn = 0;
    for (int b = 0; b < s.n() / 6; ++b)
        turn = std::max(turn, s.step.dq.segment<3>(6 * b + 3).norm());
    return s.step.swings >= guard::swings || too_long || !(turn <= guard::largest_turn);
}

Outcome check_factors(SteppingState& s, const State<double>& q, double pivot_ratio) {
    if (!std::isfinite(pivot_ratio)) return Outcome::not_finite;
    if (!is_regular(s, pivot_ratio)) return Outcome::singular;
    // A larger strain is a real stiffness; holding that mode would give a wrong result silently.
    const double rounding = guard::rounding * std::numeric_limits<double>::epsilon();
    const double uncertainty = s.work.Phi.norm() / std::min(1.0, s.setup.length);
    if (!(strain_of_held(s, q) <=
          rounding + guard::idle_strain + guard::strain_per_error * uncertainty))
        return Outcome::singular;
    return Outcome::converged;
}

Outcome check_idle_load(SteppingState& s, const State<double>& q, double equilibrium_distance) {
    if (s.system.held.idle == 0) return Outcome::converged;
    double uncertainty = s.work.Phi.norm(), whole = size_of_force(s, s.work.applied), share = 0;
    if (s.setup.consistent ? s.idle.elements.empty() : s.idle.pushing.empty()) {
        share = load_on_idle_modes(s, s.work.applied, whole);
    } else {
        s.work.force.setZero();
        for (const std::size_t k : s.setup.consistent ? s.idle.elements : s.idle.pushing) {
            const ElasticKind& element = s.model.elastics[k].kind;
            const auto [i, j] = bodies_of(element);
            add_element_force<double>(i, j, element_force<double>(element, s.inputs.rest[k], q),
                                      s.work.force);
        }
        whole += size_of_force(s, s.work.force);
        s.work.force = s.work.applied - s.work.force;
        share = load_on_idle_modes(s, s.work.force, whole);
        uncertainty += equilibrium_distance;
    }
    const double rounding = guard::rounding * std::numeric_limits<double>::epsilon();
    uncertainty /= std::min(1.0, s.setup.length);
    return share <= rounding + guard::share_per_error * uncertainty ? Outcome::converged
                                                                    : Outcome::loaded_idle_mode;
}

Outcome check_idle_load_here(SteppingState& s, double equilibrium_distance) {
    if (s.system.held.idle == 0) return Outcome::converged;
    external_force<double>(s.model, s.branch, s.inputs, s.q, s.work.applied);
    s.work.applied -= (1 - s.parameters.t) * s.start.R_d;
    return check_idle_load(s, s.q, equilibrium_distance);
}

Outcome factorise_at(SteppingState& s, const State<double>& q, const Vector<double>& lambda) {
    assemble_constraints<double>(s.model, s.inputs, q, s.system.M, s.work.Phi);
    if (s.setup.consistent)
        add_consistent_tangent<double>(s.model, s.branch, s.inputs, q, lambda, s.system.M);
    else
        add_stiffness<double>(s.model, s.inputs, q, s.system.M);
    double pivot_ratio = factorise(s.system);
    ++s.counts.factorisations;
    if (pivot_ratio >= 0 && !is_regular(s, pivot_ratio)) {
        rescale(s.system);
        pivot_ratio = factorise(s.system);
        ++s.counts.factorisations;
    }
    return check_factors(s, q, pivot_ratio);
}

void residual_at(SteppingState& s, const State<double>& q, const Vector<double>& lambda) {
    external_force<double>(s.model, s.branch, s.inputs, q, s.work.upper);
    elastic_force<double>(s.model, s.inputs, q, s.work.force);
    s.work.upper -= s.work.force;
    constraint_force<double>(s.model, s.inputs, q, lambda, s.work.force, s.work.lower);
    s.work.upper -= s.work.force;
    s.work.lower = -s.work.lower;
    if (const double held = 1 - s.parameters.t; held != 0) {
        s.work.upper -= held * s.start.R_d;
        s.work.lower += held * s.start.Phi_d;
    }
    ++s.counts.evaluations;
}

double largest_gap(const SteppingState& s, const Vector<double>& Phi) {
    double worst = 0;
    for (std::size_t c = 0; c < s.model.constraints.size(); ++c) {
        const ConstraintKind& kind = s.model.constraints[c].kind;
        const bool direction = member<Point>(kind) == nullptr;
        const double open =
            Phi.segment(s.inputs.row[c], static_cast<Eigen::Index>(rows(kind))).norm();
        const double share = direction ? open : open / s.setup.length;
        if (!(share <= worst)) worst = share;
    }
    return worst;
}

void drive_at(SteppingState& s, Drive drive, double amount, const State<double>& q,
              const Vector<double>& lambda) {
    s.work.upper.setZero();
    s.work.force.setZero();
    s.work.lower.setZero();
    add_load_rate<double>(s.branch, drive, amount, q, s.work.upper);
    add_stored_rate<double>({s.model, s.branch, s.inputs, drive, amount, q}, s.work.force);
    add_reaction_rate<double>({s.model, s.branch, s.inputs, drive, amount, q}, lambda,
                              s.work.force);
    s.work.upper -= s.work.force;
    add_constraint_rate<double>({s.model, s.branch, s.inputs, drive, -amount, q}, s.work.lower);
    if (drive == Drive::start) {
        s.work.upper += amount * s.start.R_d;
        s.work.lower -= amount * s.start.Phi_d;
    }
}

void record(const Model& model, const Inputs<double>& inputs, const State<double>& q,
            const Acting& reactions, Equilibrium& point) {
    const auto& [lambda, where_lambda_acts] = reactions;
    for (std::size_t b = 0; b < point.poses.size(); ++b) {
        point.poses[b].r = q[static_cast<BodyId>(b)].r;
        point.poses[b].p = q[static_cast<BodyId>(b)].p;
    }
    double sum = joint_wrenches<double>(model, inputs, where_lambda_acts, lambda, point.reactions);
    if (&q != &where_lambda_acts) {
        sum = 0;
        for_each_row<double>(model, inputs, q,
                             [&](int, const Row<double>& row) { sum += row.Phi * row.Phi; });
    }
    point.constraint_error = std::sqrt(sum);  // (31)
}

}  // namespace elastocheck::recursive
