#include "reference/certificate/state.hpp"
#include "models/eigen/dense.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <numbers>
#include <stdexcept>

namespace elastocheck::reference::certificate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// A wrench as six forces: moments divided by the model's length.
template <class S>
std::array<S, 6> stacked(const System& system, const JointWrench<S>& wrench) {
    std::array<S, 6> w;
    const S length = constant<S>(system.length);
    for (std::size_t k = 0; k < 3; ++k) {
        w[k] = wrench.force[k];
        w[3 + k] = wrench.moment[k] / length;
    }
    return w;
}
JointWrench<Interval> stored_wrench(const Equilibrium& state, std::size_t joint) {
    const Wrench& wrench = state.reactions[joint];
    return {constant<Interval>(wrench.force), constant<Interval>(wrench.moment)};
}

// Upper bound of √(Σ xₖ²).
template <std::size_t n>
double size_above(const std::array<Interval, n>& x) {
    Interval sum;
    for (const Interval& part : x) sum += sqr(part);
    return sqrt(sum).hi;
}

// Upper bound of the angle between two orientations, q = p* p': with s = |q⃗| / |q|, asin s ≤ s
// (1 + s²) for s ≤ ½.
double angle_above(const Quat<Interval>& p, const Quat<Interval>& other) {
    const Quat<Interval> q = product(conjugate(p), other);
    const Interval sine = sqrt(squared(q.v)) / sqrt(squared(q.v) + sqr(q.w));
    if (!(sine.hi <= 0.5)) return std::numbers::pi;
    const Interval s = sine.hi;
    return (Interval(2) * s * (Interval(1) + sqr(s))).hi;
}

Quat<Interval> quaternion(const System& system, const std::vector<Interval>& z, BodyId body) {
    const auto component = [&](int k) {
        return z[static_cast<std::size_t>(system.pose(body) + 3 + k)];
    };
    return {component(0), {{component(1), component(2), component(3)}}};
}

// Stored r - c as an enclosure.
Vec<Interval> stored_origin(const StateAt& mapped, BodyId body) {
    Vec<Interval> r;
    for (std::size_t k = 0; k < 3; ++k) {
        const auto i = static_cast<Index>(k);
        r[k] = Interval(mapped.state.poses[static_cast<std::size_t>(body)].r[i]) -
               Interval(mapped.system.c[i]);
    }
    return r;
}

MatrixXd unit_wrench_columns(const System& system, int joint, const VectorXd& z, double a) {
    const auto units = unit_wrenches(system, joint, doubles(z), a);
    MatrixXd C(6, static_cast<Index>(units.size()));
    for (Index k = 0; k < C.cols(); ++k) {
        const auto w = stacked(system, units[static_cast<std::size_t>(k)]);
        for (Index i = 0; i < 6; ++i) C(i, k) = w[static_cast<std::size_t>(i)];
    }
    return C;
}

}  // namespace

StateAt state_at(const System& system, const Equilibrium& state) {
    if (state.poses.size() != static_cast<std::size_t>(system.bodies) ||
        state.reactions.size() != system.model->joints.size())
        throw std::invalid_argument(
            "the state does not have one pose per body and one reaction per joint of the model");
    StateAt mapped{system, state, VectorXd::Zero(system.n()), {}};
    for (BodyId body = 0; body < system.bodies; ++body) {
        const Pose& pose = state.poses[static_cast<std::size_t>(body)];
        const Eigen::Quaterniond p = pose.p.normalized();
        mapped.z.segment<3>(system.pose(body)) = pose.r - system.c;
        mapped.z.segment<4>(system.pose(body) + 3) << p.w(), p.x(), p.y(), p.z();
    }
    for (int joint = 0; joint < static_cast<int>(state.reactions.size()); ++joint) {
        const MatrixXd C = unit_wrench_columns(system, joint, mapped.z, state.load);
        const auto rows = rows_of_joint(system, joint);
        MatrixXd P(C.cols(), 6);
        if (C.cols() > 0 && C.allFinite()) P = pseudo_inverse(C);
        const Wrench& wrench = state.reactions[static_cast<std::size_t>(joint)];
        Vector6 w;
        w << wrench.force, wrench.moment / system.length;
        const VectorXd R = P * w;
        for (std::size_t k = 0; k < rows.size(); ++k)
            mapped.z[7 * system.bodies + rows[k]] = R[static_cast<Index>(k)];
        mapped.from_wrench.push_back(P);
    }
    set_separated(system, mapped.z, state.load);
    return mapped;
}

namespace {

// Poses: a unit quaternion at a rotation φ from another is within 2 sin(φ/4) ≤ φ/2 of it.
void set_pose_radii(const StateAt& mapped, const Tolerance& near, VectorXd& r) {
    const System& system = mapped.system;
    for (BodyId body = 0; body < system.bodies; ++body) {
        const int k = system.pose(body);
        const Vec<Interval> origin = stored_origin(mapped, body);
        const Quat<Interval> p =
            unit_quaternion<Interval>(mapped.state.poses[static_cast<std::size_t>(body)].p);
        for (int i = 0; i < 3; ++i)
            r[k + i] =
                (Interval(near.length) +
                 Interval(mag(origin[static_cast<std::size_t>(i)] - Interval(mapped.z[k + i]))))
                    .hi;
        const std::array<Interval, 4> parts{p.w, p.v[0], p.v[1], p.v[2]};
        for (int i = 0; i < 4; ++i)
            r[k + 3 + i] =
                (Interval(near.angle) * Interval(0.5) +
                 Interval(mag(parts[static_cast<std::size_t>(i)] - Interval(mapped.z[k + 3 + i]))))
                    .hi;
    }
}

// Reactions of a joint: for z in the box of poses the wrench is w = C(z) R. With E = I - P C,
//
//   R - R₀ = P w - R₀ + E R   so   |R - R₀| ≤ |P w₀ - R₀| + |P| |w - w₀| + |E| |R₀| + |E| |R - R₀|
//
// and the largest is at most that of the first three over 1 - ‖E‖. Reactions that are moments are
// divided by L, as in w.
void set_reaction_radii(const StateAt& mapped, int joint, const std::vector<Interval>& poses,
                        const Tolerance& near, VectorXd& r) {
    const System& system = mapped.system;
    const Interval length = system.length;
    const MatrixXd& P = mapped.from_wrench[static_cast<std::size_t>(joint)];
    const auto units = unit_wrenches(system, joint, poses, Interval(mapped.state.load));
    const auto rows = rows_of_joint(system, joint);
    const auto w0 = stacked(system, stored_wrench(mapped.state, static_cast<std::size_t>(joint)));
    const std::size_t q = rows.size();
    std::vector<Interval> R0;
    for (const int row : rows) R0.push_back(mapped.z[7 * system.bodies + row]);
    // In newtons: a reaction moment is divided by L.
    double max_deviation = 0, max_E_norm = 0;
    std::vector<bool> is_moment;
    for (const auto& constraint : system.model->constraints)
        if (constraint.joint == joint)
            for (int n = 0; n < elastocheck::rows(constraint.kind); ++n)
                is_moment.push_back(is_direction(constraint.kind));
    const auto in_newtons = [&](const Interval& x, std::size_t i) {
        return is_moment[i] ? x / length : x;
    };
    for (std::size_t i = 0; i < q; ++i) {
        Interval sum = -R0[i], spread, E_norm;
        for (std::size_t k = 0; k < 6; ++k) {
            const Interval p = P(static_cast<Index>(i), static_cast<Index>(k));
            sum += p * w0[k];
            spread +=
                Interval(mag(p)) * (k < 3 ? Interval(near.force) : Interval(near.moment) / length);
        }
        for (std::size_t j = 0; j < q; ++j) {
            Interval E = i == j ? Interval(1) : Interval(0);
            const auto column = stacked(system, units[j]);
            for (std::size_t k = 0; k < 6; ++k)
                E -= Interval(P(static_cast<Index>(i), static_cast<Index>(k))) * column[k];
            spread += Interval(mag(E)) * Interval(mag(R0[j]));
            // of R_j in newtons
            const Interval scaled = is_moment[j] ? Interval(mag(E)) * length : Interval(mag(E));
            E_norm += in_newtons(scaled, i);
        }
        const Interval deviation = Interval(mag(sum)) + spread;
        max_deviation = std::max(max_deviation, mag(in_newtons(deviation, i)));
        max_E_norm = std::max(max_E_norm, mag(E_norm));
    }
    const double bound = max_E_norm < 1
                             ? (Interval(max_deviation) / (Interval(1) - Interval(max_E_norm))).hi
                             : std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < q; ++i)
        r[7 * system.bodies + rows[i]] = is_moment[i] ? (Interval(bound) * length).hi : bound;
}

// Separated curves: their deformation over the box of poses, and the law over that interval.
void set_curve_radii(const StateAt& mapped, const std::vector<Interval>& poses, VectorXd& r) {
    const System& system = mapped.system;
    const auto x = deformations(system, poses, Interval(mapped.state.load));
    for (std::size_t k = 0; k < system.separated.size(); ++k) {
        const SeparatedCurve& curve = system.separated[k];
        const Interval& x_of_curve = x[curve.element][curve.axis];
        const Index index = system.deformation(k);
        r[index] = mag(x_of_curve - Interval(mapped.z[index]));
        r[index + 1] =
            mag(force(law_of(system, curve), x_of_curve) - Interval(mapped.z[index + 1]));
    }
}

}  // namespace

VectorXd radii(const StateAt& mapped, const Tolerance& near) {
    VectorXd r = VectorXd::Zero(mapped.system.n());
    set_pose_radii(mapped, near, r);
    const auto poses = box(mapped.z, r);
    for (int joint = 0; joint < static_cast<int>(mapped.from_wrench.size()); ++joint)
        set_reaction_radii(mapped, joint, poses, near, r);
    if (!mapped.system.separated.empty()) set_curve_radii(mapped, poses, r);
    return r;
}

Extent distance(const StateAt& mapped, const std::vector<Interval>& z) {
    Extent largest{0, 0, 0, 0};
    for (BodyId body = 0; body < mapped.system.bodies; ++body) {
        const Vec<Interval> origin = stored_origin(mapped, body);
        const auto k = static_cast<std::size_t>(mapped.system.pose(body));
        largest.length = std::max(
            largest.length,
            size_above(std::array{z[k] - origin[0], z[k + 1] - origin[1], z[k + 2] - origin[2]}));
        largest.angle = std::max(
            largest.angle, angle_above(unit_quaternion<Interval>(
                                           mapped.state.poses[static_cast<std::size_t>(body)].p),
                                       quaternion(mapped.system, z, body)));
    }
    const auto joint_wrenches = wrenches(mapped.system, z, Interval(mapped.state.load));
    for (std::size_t joint = 0; joint < joint_wrenches.size(); ++joint) {
        const auto w = stored_wrench(mapped.state, joint);
        const auto df = joint_wrenches[joint].force - w.force,
                   dm = joint_wrenches[joint].moment - w.moment;
        largest.force = std::max(largest.force, size_above(df.x));
        largest.moment = std::max(largest.moment, size_above(dm.x));
    }
    return largest;
}

bool has_wrench_apart(const StateAt& mapped, const std::vector<Interval>& z,
                      const Tolerance& near) {
    const auto joint_wrenches = wrenches(mapped.system, z, Interval(mapped.state.load));
    for (std::size_t joint = 0; joint < joint_wrenches.size(); ++joint) {
        const auto w = stored_wrench(mapped.state, joint);
        for (std::size_t k = 0; k < 3; ++k)
            if (mig(joint_wrenches[joint].force[k] - w.force[k]) > near.force ||
                mig(joint_wrenches[joint].moment[k] - w.moment[k]) > near.moment)
                return true;
    }
    return false;
}

bool is_within(const Extent& extent, const Tolerance& tolerance) {
    return extent.length <= tolerance.length && extent.angle <= tolerance.angle &&
           extent.force <= tolerance.force && extent.moment <= tolerance.moment;
}

std::string as_text(const Extent& extent) {
    return fmt::format("{:.2g} mm, {:.2g} deg, {:.2g} N and {:.2g} N·m", 1e3 * extent.length,
                       extent.angle * 180 / std::numbers::pi, extent.force, extent.moment);
}

// μ acts in the balances as the wrench that holds idle motions, in the rows Φ as the gap.
Held held_by(const System& system, const Border& border, const VectorXd& mu) {
    const Index balances = 6 * system.bodies;
    const VectorXd bounds = border.U.cwiseAbs() * mu * (1 + 1e-12);
    if (bounds.size() == 0 || mu.size() == 0) return {};
    return {balances > 0 ? bounds.head(balances).maxCoeff() : 0,
            bounds.size() > balances ? bounds.tail(bounds.size() - balances).maxCoeff() : 0};
}

std::string statement(const System& system, const Border& border, const Held& held,
                      const char* as_in) {
    std::string text;
    if (border.count() > border.redundant)
        text = fmt::format("idle motion of {} as in the {}, held by at most {:.1e} N or N·m",
                           idle_bodies(system, border), as_in, held.held);
    if (border.redundant > 0)
        text += fmt::format(
            "{}joints {} are redundant: load sharing as in the {}, gap at most {:.1e} m or rad",
            text.empty() ? "" : "; ", redundant_joints(system, border), as_in, held.gap);
    return text;
}

}  // namespace elastocheck::reference::certificate
