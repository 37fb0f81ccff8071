#include "recursive/diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>

#include "models/eigen/dense.hpp"
#include "recursive/diagnosis/finite.hpp"
#include "recursive/diagnosis/self_stress.hpp"
#include "recursive/formula/reactions.hpp"
#include "recursive/linear_algebra/assembly.hpp"
#include "recursive/linear_algebra/rank.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// An eigenvalue of a 6×6 matrix with unit diagonal is zero below this; its rounding is some 1e-15.
constexpr double stiffness_threshold = 1e-13;
// A lever is a difference of coordinates: rounding bound for a zero lever, relative
// to the coordinates.
constexpr double lever_rounding = 1024 * std::numeric_limits<double>::epsilon();
constexpr double part_threshold = 1e-7;  // smaller entries of a unit vector count as zero

// Rows of the model during assembly, each on at most two bodies.
struct Stack {
    int count = 0;
    std::vector<Eigen::Triplet<double>> entries;

    void put(BodyId b, const Vector6<double>& block) {  // into the row that comes next
        for (int k = 0; b != ground && k < 6; ++k)
            if (block[k] != 0) entries.emplace_back(count, 6 * b + k, block[k]);
    }
    void next() { ++count; }
    Rows rows(Eigen::Index columns) const {
        Rows result(count, columns);
        result.setFromTriplets(entries.begin(), entries.end());
        return result;
    }
};

// Scales rows to unit length except zero rows; returns the divisors.
VectorXd normalise(Rows& rows) {
    VectorXd length = VectorXd::Ones(rows.rows());
    for (int k = 0; k < rows.outerSize(); ++k)
        if (const double norm = rows.row(k).norm(); norm > 0) {
            rows.row(k) /= norm;
            length[k] = norm;
        }
    return length;
}

// Concatenates rows.
Rows stacked(const std::vector<Rows>& parts, Eigen::Index columns) {
    Stack stack;
    for (const Rows& part : parts) {
        for (int k = 0; k < part.outerSize(); ++k)
            for (Rows::InnerIterator e(part, k); e; ++e)
                stack.entries.emplace_back(stack.count + k, e.col(), e.value());
        stack.count += static_cast<int>(part.rows());
    }
    return stack.rows(columns);
}
Rows without(const Rows& rows, const std::vector<int>& omitted) {
    Stack stack;
    for (int k = 0; k < rows.outerSize(); ++k) {
        if (std::ranges::binary_search(omitted, k)) continue;
        for (Rows::InnerIterator e(rows, k); e; ++e)
            stack.entries.emplace_back(stack.count, e.col(), e.value());
        stack.next();
    }
    return stack.rows(rows.cols());
}

// Factors of (Δr, L Δπ) that give Δq = (Δr, Δπ).
VectorXd coordinate_scales(Eigen::Index n, double length) {
    VectorXd scales = VectorXd::Ones(n);
    for (Eigen::Index k = 3; k < n; k += 6) scales.segment<3>(k).setConstant(1 / length);
    return scales;
}

// Φ_q with respect to (Δr, L Δπ), with rows of unit length.
struct ConstraintRows {
    VectorXd scales;
    Rows Phi_q;
    VectorXd length;  // of the rows before they were scaled
};
ConstraintRows constraint_rows_of(const Model& model, const Inputs<double>& inputs,
                                  const State<double>& q, double L) {
    Stack stack;
    for_each_row<double>(model, inputs, q, [&](int, const Row<double>& row) {
        stack.put(row.i, row.on_i());
        stack.put(row.j, row.on_j());
        stack.next();
    });
    ConstraintRows result{coordinate_scales(coordinates(model), L), {}, {}};
    result.Phi_q = stack.rows(coordinates(model)) * result.scales.asDiagonal();
    result.length = normalise(result.Phi_q);
    return result;
}

// Rows of √K_e in the element's own axes, each as (force, moment) on body j about the attachment
// point, turned to ground axes. Own axes are needed to distinguish a soft direction from a zero
// one: in other axes the rounding of the stiff directions hides it. K_e = S C S with a unit
// diagonal C, so that rates of any size have the same weight.
// A curve with negative slope counts as stiffness; an open stop (slope 0) does not.
template <class Element>
std::vector<Vector6<double>> root_rows(const Element& e, const Rest<double>& rest,
                                       const State<double>& q) {
    const Matrix3<double> A = own_axes<double>(e, q);
    const Vector6<double> x = deflections<double>(e, rest, q);
    Matrix6<double> K = Matrix6<double>::Zero();
    each_member(
        e, overloaded{
               [&](const ScalarLaw& law) { K(0, 0) = hessian<double>(law, [&] { return x[0]; }); },
               [&](const SpatialLaw& law) { K = hessian<double>(law, [&] { return x; }); }});
    const Vector6<double> S = K.diagonal().cwiseAbs().cwiseSqrt();
    const Vector6<double> inverse = S.unaryExpr([](double v) { return v > 0 ? 1 / v : 0; });
    const Matrix6<double> C = inverse.asDiagonal() * K * inverse.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Matrix6<double>> eigen(C);
    std::vector<Vector6<double>> rows;
    for (int k = 0; k < 6; ++k) {
        if (!(std::abs(eigen.eigenvalues()[k]) > stiffness_threshold)) continue;
        const Vector6<double> own = (S.asDiagonal() * eigen.eigenvectors().col(k)).normalized();
        Vector6<double> row;
        row << A * own.head<3>(), A * own.tail<3>();
        rows.push_back(row);
    }
    return rows;
}

// √K_e B_e of every element, stacked [? × 6nb].
Rows elastic_rows(const Model& model, const Inputs<double>& inputs, const State<double>& q) {
    Stack stack;
    for (std::size_t number = 0; number < model.elastics.size(); ++number)
        std::visit(
            [&](const auto& e) {
                const Vector3d s_i = q[e.i.body].lever(e.i.s_local),
                               s_j = q[e.j.body].lever(e.j.s_local);
                for (const Vector6<double>& g : root_rows(e, inputs.rest[number], q)) {
                    const auto add = [&](BodyId b, const Vector3d& lever, double sign) {
                        Vector6<double> block;
                        block << sign * g.head<3>(),
                            sign * (lever.cross(g.head<3>()) + g.tail<3>());
                        stack.put(b, block);
                    };
                    add(e.i.body, s_i, -1);
                    add(e.j.body, s_j, +1);
                    stack.next();
                }
            },
            model.elastics[number].kind);
    return stack.rows(coordinates(model));
}

// Idle modes of single bodies: the null space of all rows in the six columns of one body [6nb × ?],
// orthogonal to each other.
Columns modes_of_single_bodies(const Rows& rows, int bodies) {
    std::vector<std::vector<int>> on(static_cast<std::size_t>(bodies));
    for (int k = 0; k < rows.outerSize(); ++k)
        for (Rows::InnerIterator e(rows, k); e; ++e)
            if (auto& list = on[static_cast<std::size_t>(e.col() / 6)];
                list.empty() || list.back() != k)
                list.push_back(k);
    std::vector<Eigen::Triplet<double>> entries;
    int modes = 0;
    for (int b = 0; b < bodies; ++b) {
        const auto& rows_of_body = on[static_cast<std::size_t>(b)];
        MatrixXd own = MatrixXd::Zero(6, static_cast<Eigen::Index>(rows_of_body.size()));
        for (Eigen::Index c = 0; c < own.cols(); ++c)
            for (Rows::InnerIterator e(rows, rows_of_body[static_cast<std::size_t>(c)]); e; ++e)
                if (e.col() / 6 == b) own(e.col() % 6, c) = e.value();
        MatrixXd Q = MatrixXd::Identity(6, 6);
        Eigen::Index rank = 0;
        if (own.cols() > 0) {
            Eigen::ColPivHouseholderQR<MatrixXd> qr(own);
            qr.setThreshold(rank_threshold);
            Q = matrix_Q(qr);
            rank = qr.rank();
        }
        for (Eigen::Index c = rank; c < 6; ++c, ++modes)
            for (int k = 0; k < 6; ++k)
                if (Q(k, c) != 0) entries.emplace_back(6 * b + k, modes, Q(k, c));
    }
    Columns result(rows.cols(), modes);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
}

// Names of a body's constraints and elements, and their attachment points.
struct Attachment {
    const std::string* name;
    Vector3d s_local;
};
std::vector<std::vector<Attachment>> attachments(const Model& model) {
    std::vector<std::vector<Attachment>> on(model.bodies.size());
    const auto note = [&](const std::string& name, const auto& kind) {
        each_point(kind, [&](const auto& end) {
            if (end.body != ground)
                on[static_cast<std::size_t>(end.body)].push_back({&name, end.s_local});
        });
    };
    for (const auto& c : model.constraints)
        note(model.joints[static_cast<std::size_t>(c.joint)].name, c.kind);
    for (const auto& e : model.elastics) note(e.name, e.kind);
    return on;
}

// Removes the minus sign of rounded zeros.
Vector3d shown(const Vector3d& u) {
    return u.unaryExpr([](double v) { return std::abs(v) < 5e-4 ? 0.0 : v; });
}

// "rotation about ..." or "translation along ..." of the twist (v, w) of a body at r.
std::string describe(const std::string& name, const BodyState<double>& placed,
                     const std::vector<Attachment>& attached, const Vector3d& v, const Vector3d& w,
                     double length) {
    if (w.norm() * length < 1e-6 * v.norm()) {
        const Vector3d u = shown(v.normalized());
        return fmt::format("{}: translation along ({:.3f}, {:.3f}, {:.3f})", name, u.x(), u.y(),
                           u.z());
    }
    // nearest point of the axis to the origin
    const Vector3d foot = placed.r + w.cross(v) / w.squaredNorm();
    const Vector3d u = w.normalized();
    std::vector<std::string> on_axis;
    for (const auto& [what, s_local] : attached) {
        const Vector3d p = placed.r + placed.lever(s_local);
        if ((p - foot).cross(u).norm() < 1e-6 * length &&
            std::ranges::find(on_axis, *what) == on_axis.end())
            on_axis.push_back(*what);
    }
    const double pitch = v.dot(w) / w.squaredNorm();  // [m/rad]
    const char* motion = std::abs(pitch) < 1e-6 * length ? "rotation" : "screw motion";
    if (on_axis.size() >= 2)
        return fmt::format("{}: {} about the line through '{}' and '{}'", name, motion,
                           on_axis.front(), on_axis.back());
    return fmt::format(
        "{}: {} about the axis ({:.3f}, {:.3f}, {:.3f}) through ({:.4f}, {:.4f}, {:.4f}) m", name,
        motion, shown(u).x(), shown(u).y(), shown(u).z(), foot.x(), foot.y(), foot.z());
}

// Sets of joints that share a dependency yᵀ Φ_q = 0. One dependency per dependent row is enough:
// any other is a combination of these, and those without a common row are independent.
void find_undetermined(const std::vector<int>& joint_of_row, const Columns& dependencies,
                       Diagnosis& result) {
    std::vector<int> set(
        result.determined.size());  // union-find: parent of each joint; root = smallest of its set
    std::iota(set.begin(), set.end(), 0);
    const auto smallest = [&](int joint) {
        const auto parent = [&](int j) -> int& { return set[static_cast<std::size_t>(j)]; };
        while (parent(joint) != joint) joint = parent(joint) = parent(parent(joint));
        return joint;
    };
    for (int c = 0; c < dependencies.outerSize(); ++c) {
        int first_joint = -1;
        for (Columns::InnerIterator y(dependencies, c); y; ++y) {
            if (!(std::abs(y.value()) > part_threshold)) continue;
            const int joint = joint_of_row[static_cast<std::size_t>(y.row())];
            result.determined[static_cast<std::size_t>(joint)] = false;
            if (first_joint < 0) first_joint = joint;
            const auto [low, high] = std::minmax({smallest(first_joint), smallest(joint)});
            set[static_cast<std::size_t>(high)] = low;
        }
    }
    std::vector<int> place(set.size(), -1);  // index of a set in the list, by its smallest joint
    for (int joint = 0; joint < static_cast<int>(set.size()); ++joint) {
        if (result.determined[static_cast<std::size_t>(joint)]) continue;
        int& at = place[static_cast<std::size_t>(smallest(joint))];
        if (at < 0) {
            at = static_cast<int>(result.redundant_sets.size());
            result.redundant_sets.emplace_back();
        }
        result.redundant_sets[static_cast<std::size_t>(at)].push_back(joint);
    }
}

// Redundant joints, from the dependent rows.
void find_redundant(const std::vector<int>& joint_of_row, const DependentRows& dependent,
                    const VectorXd& Phi, double reach, Diagnosis& result) {
    std::vector<std::map<int, double>> share_of_joint;  // of each redundancy: Σ y² by joint
    for (std::size_t c = 0; c < dependent.rows.size(); ++c) {
        const int joint = joint_of_row[static_cast<std::size_t>(dependent.rows[c])];
        if (result.redundant.empty() || result.redundant.back().joint != joint) {
            result.redundant.emplace_back().joint = joint;
            share_of_joint.emplace_back();
        }
        Redundancy& redundancy = result.redundant.back();
        ++redundancy.rows;
        redundancy.remainder = std::max(redundancy.remainder, dependent.remainder[c]);
        for (Columns::InnerIterator y(dependent.dependencies, static_cast<Eigen::Index>(c)); y; ++y)
            if (std::abs(y.value()) > part_threshold)
                share_of_joint.back()[joint_of_row[static_cast<std::size_t>(y.row())]] +=
                    y.value() * y.value();
    }
    for (std::size_t k = 0; k < share_of_joint.size(); ++k) {
        auto& shares = result.redundant[k].shares;
        shares.assign(share_of_joint[k].begin(), share_of_joint[k].end());
        double sum = 0;
        for (const auto& [joint, share] : shares) sum += share;
        for (auto& [joint, share] : shares) share /= sum;
        std::ranges::stable_sort(shares, std::greater{}, &std::pair<int, double>::second);
    }
    for (Redundancy& r : result.redundant) {
        const auto [first, end] =
            std::equal_range(joint_of_row.begin(), joint_of_row.end(), r.joint);
        const auto own = Phi.segment(first - joint_of_row.begin(), end - first);
        r.contradicts = !(own.cwiseAbs().maxCoeff() <= 1e-9 * std::max(1.0, result.length));
        // Rows are computed from differences of coordinates, and their directions vary with the
        // constraint error.
        constexpr double digits = 1024 * std::numeric_limits<double>::epsilon();
        r.undecided = r.remainder > digits * (1 + reach / result.length) +
                                        10 * result.constraint_error / std::min(1.0, result.length);
    }
}

// Whether the twist rotates a body about a line that carries all its attachment points.
bool is_spin(const BodyState<double>& at, const std::vector<Attachment>& attached,
             const Vector3d& v, const Vector3d& w, double length) {
    if (attached.empty() || w.norm() * length < 1e-6 * v.norm()) return false;
    return std::ranges::all_of(attached, [&](const Attachment& a) {
        return (v + w.cross(at.lever(a.s_local))).norm() < 1e-6 * length * w.norm();
    });
}

// Names of the probes that the mode moves, the wheels whose centre it moves or whose spin axis it
// rotates, and the dampers whose length it changes.
std::vector<std::string> outputs_moved(const Model& model, const State<double>& q,
                                       const Eigen::SparseVector<double>& dq, double length) {
    constexpr double rounding = 1e-6;
    std::vector<std::string> moved;
    const auto twist = [&](BodyId b) {
        Vector6<double> t = Vector6<double>::Zero();
        for (int k = 0; b != ground && k < 6; ++k) t[k] = dq.coeff(6 * b + k);
        return t;
    };
    const auto of_point = [&](const Point& at) -> Vector3d {
        const Vector6<double> t = twist(at.body);
        return t.head<3>() + t.tail<3>().cross(q[at.body].lever(at.s_local));
    };
    for (const auto& probe : model.probes)
        if (of_point(probe.at).norm() > rounding) moved.push_back(probe.name);
    for (const auto& wheel : model.wheels) {
        const Vector3d turned =
            twist(wheel.body).tail<3>().cross(q[wheel.body].lever(wheel.spin_axis_local));
        if (of_point({wheel.body, wheel.centre_local}).norm() > rounding ||
            turned.norm() * length > rounding)
            moved.push_back(wheel.name.empty() ? "wheel" : wheel.name);
    }
    for (const auto& damper : model.dampers) {
        const auto place = [&](const Point& p) -> Vector3d {
            return q[p.body].r + q[p.body].lever(p.s_local);
        };
        const Vector3d along = (place(damper.j) - place(damper.i)).normalized();
        if (std::abs(along.dot(of_point(damper.j) - of_point(damper.i))) > rounding)
            moved.push_back(damper.name);
    }
    return moved;
}

// An idle mode from its column in (Δr, L Δπ), with the sign that makes the largest entry positive.
IdleMode idle_mode(const Columns& modes, int column, const VectorXd& scales) {
    double largest = 0;
    Columns::InnerIterator z(modes, column);
    for (; z; ++z)
        if (std::abs(z.value()) > std::abs(largest)) largest = z.value();
    IdleMode mode;
    mode.dq.resize(modes.rows());
    double largest_motion = 0;
    for (z = Columns::InnerIterator(modes, column); z;) {
        const auto body = static_cast<BodyId>(z.row() / 6);
        double moved = 0;
        for (; z && z.row() / 6 == body; ++z) {
            moved += z.value() * z.value();
            mode.dq.insertBack(z.row()) = (largest < 0 ? -1 : 1) * (scales[z.row()] * z.value());
        }
        if (moved > largest_motion || mode.body == ground) {  // also if NaN
            largest_motion = moved;
            mode.body = body;
        }
    }
    return mode;
}

// Describes the motion mode.dq of mode.body.
void name_motion(const Model& model, const State<double>& q,
                 const std::vector<std::vector<Attachment>>& attached, double length,
                 IdleMode& mode) {
    Vector6<double> twist;
    for (int k = 0; k < 6; ++k) twist[k] = mode.dq.coeff(6 * mode.body + k);
    const auto at = static_cast<std::size_t>(mode.body);
    mode.description = describe(model.bodies[at].name, q[mode.body], attached[at], twist.head<3>(),
                                twist.tail<3>(), length);
    mode.spins = is_spin(q[mode.body], attached[at], twist.head<3>(), twist.tail<3>(), length);
    mode.outputs = outputs_moved(model, q, mode.dq, length);
}

}  // namespace

IdleMode motion_of(const Model& model, const std::vector<Pose>& poses, const VectorXd& dq,
                   double length) {
    const VectorXd scales = coordinate_scales(dq.size(), length);
    const Columns scaled = VectorXd(dq.cwiseQuotient(scales)).sparseView();
    IdleMode mode = idle_mode(scaled, 0, scales);
    name_motion(model, state_of<double>(poses), attachments(model), length, mode);
    return mode;
}

double characteristic_length(const Model& model) {
    double sum = 0;
    int count = 0;
    const auto distance = [&](BodyId b) {
        return model.bodies[static_cast<std::size_t>(b)].design.r.norm();
    };
    const auto add_lever = [&](const auto& end) {
        if (end.body == ground || end.s_local.norm() <= lever_rounding * distance(end.body)) return;
        sum += end.s_local.squaredNorm();
        ++count;
    };
    for (const auto& c : model.constraints) each_point(c.kind, add_lever);
    for (const auto& e : model.elastics) each_point(e.kind, add_lever);
    return count > 0 ? std::sqrt(sum / count) : 1.0;
}

std::vector<int> dependent_rows(const Model& model) {
    if (!not_finite(model).empty()) return {};
    return find_dependent_rows(constraint_rows_of(model, inputs_as_drawn<double>(model),
                                                  design_state<double>(model),
                                                  characteristic_length(model))
                                   .Phi_q)
        .rows;
}

std::vector<SelfStress> self_stresses(const Model& model, const Branch& branch,
                                      std::span<const int> dependent, const Equilibrium& state) {
    // A row counts as dependent up to this remainder, in constraint errors, and at most.
    constexpr double per_error = 100, max_remainder = 0.05;
    const auto is_finite = [](const Pose& at) {
        return at.r.allFinite() && at.p.coeffs().allFinite();
    };
    if (dependent.empty() || !std::ranges::all_of(state.poses, is_finite)) return {};
    const double L = characteristic_length(model);
    const State<double> q = state_of<double>(state.poses);
    const Inputs<double> inputs = inputs_at<double>(model, branch, state.load);
    const ConstraintRows rows = constraint_rows_of(model, inputs, q, L);
    const double error = state.constraint_error / std::min(1.0, L);
    const DependentRows found = find_dependent_rows(
        rows.Phi_q, dependent, std::clamp(per_error * error, rank_threshold, max_remainder));
    std::vector<SelfStress> list;
    for (std::size_t c = 0; c < found.rows.size(); ++c) {
        const VectorXd y = found.dependencies.col(static_cast<Eigen::Index>(c));
        SelfStress& stress = list.emplace_back(
            SelfStress{std::vector<Wrench>(model.joints.size()), found.remainder[c]});
        joint_wrenches<double>(model, inputs, q, y.cwiseQuotient(rows.length), stress.wrenches);
        double largest = 0;
        for (const Wrench& w : stress.wrenches)
            largest = std::max({largest, w.force.norm(), w.moment.norm() / L});
        for (Wrench& w : stress.wrenches) {
            w.force /= largest;
            w.moment /= largest;
        }
    }
    return list;
}

Diagnosis diagnose(const Model& model) {
    const State<double> q = design_state<double>(model);
    const Inputs<double> inputs = inputs_as_drawn<double>(model);
    Diagnosis result;
    const int n = result.coordinates = coordinates(model);
    const int m = result.rows = constraint_rows(model);
    const int nb = static_cast<int>(model.bodies.size());
    if (nb == 0) throw std::invalid_argument("the model has no bodies");
    const double L = result.length = characteristic_length(model);

    if (!not_finite(model).empty()) {
        result.constraint_error = result.imbalance = std::numeric_limits<double>::quiet_NaN();
        result.determined.assign(model.joints.size(), false);
        result.null_space.resize(n + m, 0);
        return result;
    }

    const VectorXd Phi = constraint_values<double>(model, inputs, q);
    result.constraint_error = m > 0 ? Phi.cwiseAbs().maxCoeff() : 0;
    auto [scales, Phi_q, row_length] = constraint_rows_of(model, inputs, q, L);
    const DependentRows dependent = find_dependent_rows(Phi_q);
    result.rank = m - static_cast<int>(dependent.rows.size());
    std::vector<int> joint_of_row;  // ascending
    for (const auto& c : model.constraints)
        joint_of_row.insert(joint_of_row.end(), rows(c.kind), c.joint);
    double reach = 0;
    for (const auto& body : model.bodies) reach = std::max(reach, body.design.r.norm());
    find_redundant(joint_of_row, dependent, Phi, reach, result);
    result.determined.assign(model.joints.size(), true);
    find_undetermined(joint_of_row, dependent.dependencies, result);

    // Modes of single bodies first; appended as rows they make the other modes orthogonal to them.
    Rows elastic = elastic_rows(model, inputs, q) * scales.asDiagonal();
    normalise(elastic);
    Phi_q = without(Phi_q, dependent.rows);
    const Rows straining = stacked({Phi_q, elastic}, n);
    const Columns single = modes_of_single_bodies(straining, nb);
    const Columns several = null_space(stacked({straining, Rows(single.transpose())}, n));
    const auto attached = attachments(model);
    for (const Columns* modes : {&single, &several})
        for (int c = 0; c < modes->outerSize(); ++c) {
            IdleMode& mode = result.idle.emplace_back(idle_mode(*modes, c, scales));
            name_motion(model, q, attached, L, mode);
            mode.spins = mode.spins && modes == &single;
        }

    std::vector<Eigen::Triplet<double>> entries;
    int column = 0;
    for (const IdleMode& mode : result.idle) {
        for (Eigen::SparseVector<double>::InnerIterator z(mode.dq); z; ++z)
            entries.emplace_back(z.index(), column, z.value());
        ++column;
    }
    for (int c = 0; c < dependent.dependencies.outerSize(); ++c, ++column)
        for (Columns::InnerIterator y(dependent.dependencies, c); y; ++y)  // λ of the unscaled rows
            entries.emplace_back(n + y.row(), column, y.value() / row_length[y.row()]);
    result.null_space.resize(n + m, column);
    result.null_space.setFromTriplets(entries.begin(), entries.end());

    // f_ext(0) - f_elast, projected on the motions that the constraints allow.
    VectorXd f = VectorXd::Zero(n);
    for (const auto& load : model.static_loads) add_load<double>(load.kind, 1.0, q, f);
    f -= elastic_force<double>(model, inputs, q);
    if (!f.isZero(0))
        result.imbalance =
            orthogonal_component(Phi_q, scales.asDiagonal() * f).cwiseAbs().maxCoeff();
    return result;
}

std::vector<std::string> locked_bodies(const Model& model, const Diagnosis& diagnosis) {
    std::vector<std::string> lines;
    if (diagnosis.redundant.empty()) return lines;
    const Inputs<double> inputs = inputs_as_drawn<double>(model);
    std::vector<int> drives;  // rows of joints that are active only where driven: they hold no body
    for (const ModelJoint& joint : model.joints)
        if (joint.active_only_where_driven)
            drives.push_back(inputs.row[static_cast<std::size_t>(joint.driven)]);
    std::ranges::sort(drives);
    const Rows Phi_q = without(
        constraint_rows_of(model, inputs, design_state<double>(model), diagnosis.length).Phi_q,
        drives);
    const Rows free = Rows(null_space(without(Phi_q, find_dependent_rows(Phi_q).rows)).transpose());
    std::vector<bool> moves(model.bodies.size());
    for (int k = 0; k < free.outerSize(); ++k)
        for (Rows::InnerIterator e(free, k); e; ++e)
            if (std::abs(e.value()) > part_threshold)
                moves[static_cast<std::size_t>(e.col() / 6)] = true;
    for (const auto& set : diagnosis.redundant_sets)
        for (BodyId b = 0; b < static_cast<BodyId>(moves.size()); ++b) {
            std::vector<std::string> joints;
            for (const int joint : set) {
                const ModelJoint& member = model.joints[static_cast<std::size_t>(joint)];
                if (member.i == b || member.j == b) joints.push_back(member.name);
            }
            if (!moves[static_cast<std::size_t>(b)] && joints.size() > 1)
                lines.push_back(fmt::format("body '{}' cannot move: the joints {} lock it",
                                            model.bodies[static_cast<std::size_t>(b)].name,
                                            listed(joints)));
        }
    return lines;
}

}  // namespace elastocheck::recursive
