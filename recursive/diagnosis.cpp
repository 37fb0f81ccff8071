#include "recursive/diagnosis.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <numeric>

#include "recursive/assembly.hpp"
#include "recursive/pattern.hpp"

namespace elastocheck::recursive {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double rank_threshold = 1e-9;  // on rows of unit length
// Eigenvalues of a 6×6 with a unit diagonal that are more than its rounding (some 1e-15).
constexpr double stiffness_threshold = 1e-13;
constexpr double part_threshold = 1e-7;  // of a unit combination of rows that a row has a part in

// Where on its body an end of a constraint or element is attached; a direction is attached nowhere.
const Vector3d* lever(const Point& end) { return &end.s_local; }
const Vector3d* lever(const Marker& end) { return &end.s_local; }
const Vector3d* lever(const Direction&) { return nullptr; }

// The root mean square lever of everything that is attached to a body:
// invariant under motions of the ground frame.
double characteristic_length(const Model& model) {
    double sum = 0;
    int count = 0;
    const auto take = [&](const auto& end) {
        const Vector3d* s = lever(end);
        if (!s || end.body == ground || s->isZero(0)) return;
        sum += s->squaredNorm();
        ++count;
    };
    const auto both = [&](const auto& e) { take(e.i), take(e.j); };
    for (const auto& c : model.constraints) std::visit(both, c.kind);
    for (const auto& e : model.elastics) std::visit(both, e.kind);
    return count > 0 ? std::sqrt(sum / count) : 1.0;
}

// Rows to unit length, zero rows left alone.
void normalise_rows(MatrixXd& rows) {
    for (Eigen::Index k = 0; k < rows.rows(); ++k)
        if (const double norm = rows.row(k).norm(); norm > 0) rows.row(k) /= norm;
}

int rank_of(const MatrixXd& rows) {
    if (rows.size() == 0) return 0;
    Eigen::ColPivHouseholderQR<MatrixXd> qr(rows.transpose());
    qr.setThreshold(rank_threshold);
    return static_cast<int>(qr.rank());
}

// Orthonormal null space of rows of unit length [columns × nullity].
MatrixXd null_space_of(const MatrixXd& rows, Eigen::Index columns) {
    if (rows.rows() == 0) return MatrixXd::Identity(columns, columns);
    Eigen::ColPivHouseholderQR<MatrixXd> qr(rows.transpose());
    qr.setThreshold(rank_threshold);
    const MatrixXd Q = qr.householderQ();
    return Q.rightCols(columns - qr.rank());
}

// The rows of √K_e in the element's own axes, each as (force, moment) on body j about the attachment point,
// turned to ground axes. What is soft in one of an element's own directions is told apart from what is nothing
// only there: in other axes the rounding of the stiff directions covers it. K_e = S C S with a unit diagonal C,
// so that rates of any size count alike.
std::vector<Vector6<double>> root_rows(const AxialSpring& e, const Rest<double>& rest,
                                       const State<double>& q) {
    const Axial<double> g = deformation<double>(e, q);
    // A curve may fall: that is noticed as well. An open stop is not.
    if (hessian<double>(e.law, [&] { return g.length - rest.free_length; }) == 0) return {};
    Vector6<double> row;
    row << g.D / g.length, Vector3d::Zero();
    return {row};
}
std::vector<Vector6<double>> root_rows(const Bushing& e, const Rest<double>&, const State<double>& q) {
    const Spatial<double> g = deformation<double>(e, q);
    const Matrix3<double> A = axes<double>(e, q);
    const Matrix6<double> K = hessian<double>(e.law, [&] { return strain<double>(e, g); });
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
MatrixXd elastic_rows(const Model& model, const Inputs<double>& inputs, const State<double>& q) {
    std::vector<VectorXd> rows;
    for (std::size_t at = 0; at < model.elastics.size(); ++at)
        std::visit(
            [&](const auto& e) {
                const Vector3d s_i = q[e.i.body].lever(e.i.s_local), s_j = q[e.j.body].lever(e.j.s_local);
                for (const Vector6<double>& g : root_rows(e, inputs.rest[at], q)) {
                    VectorXd row = VectorXd::Zero(coordinates(model));
                    const auto add = [&](BodyId b, const Vector3d& lever, double sign) {
                        if (b == ground) return;
                        row.segment<3>(6 * b) += sign * g.head<3>();
                        row.segment<3>(6 * b + 3) += sign * (lever.cross(g.head<3>()) + g.tail<3>());
                    };
                    add(e.i.body, s_i, -1);
                    add(e.j.body, s_j, +1);
                    rows.push_back(row);
                }
            },
            model.elastics[at].kind);
    MatrixXd stacked(static_cast<Eigen::Index>(rows.size()), coordinates(model));
    for (std::size_t k = 0; k < rows.size(); ++k) stacked.row(static_cast<Eigen::Index>(k)) = rows[k];
    return stacked;
}

// A basis of the idle modes in which each mode moves as few bodies as possible: modes of single bodies first.
MatrixXd sparse_basis(const MatrixXd& rows, const MatrixXd& all, int bodies) {
    MatrixXd basis(all.rows(), 0);
    const auto append = [&](const VectorXd& candidate) {
        VectorXd rest = candidate - basis * (basis.transpose() * candidate);
        rest -= basis * (basis.transpose() * rest);
        if (rest.norm() < 1e-6) return;
        basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
        basis.col(basis.cols() - 1) = rest.normalized();
    };
    for (int b = 0; b < bodies; ++b) {
        const MatrixXd own = null_space_of(rows.middleCols(6 * b, 6), 6);
        for (Eigen::Index c = 0; c < own.cols() && basis.cols() < all.cols(); ++c) {
            VectorXd mode = VectorXd::Zero(all.rows());
            mode.segment(6 * b, 6) = own.col(c);
            append(mode);
        }
    }
    for (Eigen::Index c = 0; c < all.cols() && basis.cols() < all.cols(); ++c) append(all.col(c));
    return basis;
}

// Without the minus that rounding leaves before a zero.
Vector3d shown(const Vector3d& u) {
    return u.unaryExpr([](double v) { return std::abs(v) < 5e-4 ? 0.0 : v; });
}

// "rotation about ..." or "translation along ..." of the twist (v, w) of a body at r.
std::string describe(const Model& model, const State<double>& q, BodyId body, const Vector3d& v,
                     const Vector3d& w, double length) {
    const std::string& name = model.bodies[static_cast<std::size_t>(body)].name;
    if (w.norm() * length < 1e-6 * v.norm()) {
        const Vector3d u = shown(v.normalized());
        return fmt::format("{}: translation along ({:.3f}, {:.3f}, {:.3f})", name, u.x(), u.y(), u.z());
    }
    const Vector3d foot =
        q[body].r + w.cross(v) / w.squaredNorm();  // nearest point of the axis to the origin
    const Vector3d u = w.normalized();
    std::vector<std::string> on_axis;
    const auto look = [&](const std::string& what, const auto& end) {
        const Vector3d* s = lever(end);
        if (!s || end.body != body) return;
        const Vector3d p = q[body].r + q[body].lever(*s);
        if ((p - foot).cross(u).norm() < 1e-6 * length && std::ranges::find(on_axis, what) == on_axis.end())
            on_axis.push_back(what);
    };
    for (const auto& c : model.constraints)
        std::visit(
            [&](const auto& e) {
                look(model.joints[static_cast<std::size_t>(c.joint)].name, e.i),
                    look(model.joints[static_cast<std::size_t>(c.joint)].name, e.j);
            },
            c.kind);
    for (const auto& e : model.elastics)
        std::visit([&](const auto& kind) { look(e.name, kind.i), look(e.name, kind.j); }, e.kind);
    const double pitch = v.dot(w) / w.squaredNorm();  // [m/rad]
    const char* motion = std::abs(pitch) < 1e-6 * length ? "rotation" : "screw motion";
    if (on_axis.size() >= 2)
        return fmt::format("{}: {} about the line through '{}' and '{}'", name, motion, on_axis.front(),
                           on_axis.back());
    return fmt::format("{}: {} about the axis ({:.3f}, {:.3f}, {:.3f}) through ({:.4f}, {:.4f}, {:.4f}) m",
                       name, motion, shown(u).x(), shown(u).y(), shown(u).z(), foot.x(), foot.y(), foot.z());
}

// Which joints share a dependency yᵀ Φ_q = 0. The projector Y Yᵀ on all of them couples two rows only where a
// dependency does, whichever basis Y [m × r] it is made from, so its blocks are the sets.
void find_undetermined(const Model& model, const MatrixXd& Y, Diagnosis& result) {
    const std::size_t joints = model.joints.size();
    result.determined.assign(joints, true);
    std::vector<int> joint_of_row;
    for (const auto& c : model.constraints) joint_of_row.insert(joint_of_row.end(), rows(c.kind), c.joint);
    std::vector<int> set(joints);  // the smallest joint of the set that a joint is in
    std::iota(set.begin(), set.end(), 0);
    const MatrixXd P = Y * Y.transpose();
    for (Eigen::Index k = 0; k < P.rows(); ++k)
        for (Eigen::Index l = 0; l < P.cols(); ++l) {
            if (!(std::abs(P(k, l)) > part_threshold)) continue;
            const int one = joint_of_row[static_cast<std::size_t>(k)],
                      other = joint_of_row[static_cast<std::size_t>(l)];
            result.determined[static_cast<std::size_t>(one)] = false;
            const auto [low, high] =
                std::minmax(set[static_cast<std::size_t>(one)], set[static_cast<std::size_t>(other)]);
            std::ranges::replace(set, int(high), int(low));
        }
    for (int first = 0; first < static_cast<int>(joints); ++first) {
        std::vector<int> members;
        for (int joint = first; joint < static_cast<int>(joints); ++joint)
            if (set[static_cast<std::size_t>(joint)] == first &&
                !result.determined[static_cast<std::size_t>(joint)])
                members.push_back(joint);
        if (!members.empty()) result.redundant_sets.push_back(members);
    }
}

// κ₂ without the `nullity` smallest singular values.
double condition_number(const MatrixXd& M, Eigen::Index nullity) {
    if (M.rows() <= nullity) return 1;
    const Eigen::JacobiSVD<MatrixXd> svd(M);
    const auto& s = svd.singularValues();
    return s[0] / s[s.size() - 1 - nullity];
}

}  // namespace

Diagnosis diagnose(const Model& model) {
    const State<double> q = design_state<double>(model);
    const Inputs<double> inputs = inputs_as_drawn<double>(model);
    Diagnosis result;
    const int n = result.coordinates = coordinates(model);
    const int m = result.rows = constraint_rows(model);
    const int nb = static_cast<int>(model.bodies.size());
    const double L = result.length = characteristic_length(model);

    VectorXd physical = VectorXd::Ones(n);  // Δq = physical · (Δr, L Δπ)
    for (int b = 0; b < nb; ++b) physical.segment<3>(6 * b + 3).setConstant(1 / L);

    const VectorXd Phi = constraint_values<double>(model, inputs, q);
    result.constraint_error = m > 0 ? Phi.cwiseAbs().maxCoeff() : 0;
    MatrixXd Phi_q = constraint_jacobian<double>(model, inputs, q) * physical.asDiagonal();
    VectorXd row_norm = Phi_q.rowwise().norm();
    normalise_rows(Phi_q);
    result.rank = rank_of(Phi_q);

    // Rows that are all independent leave nothing to ask of the joints one by one.
    int first = 0, rank_before = 0, k = 0;
    for (int joint = 0; result.rank < m && joint < static_cast<int>(model.joints.size()); ++joint) {
        first = k;
        for (const auto& c : model.constraints)
            if (c.joint == joint) k += rows(c.kind);
        const int rank = rank_of(Phi_q.topRows(k));
        const int repeated = (k - first) - (rank - rank_before);
        const bool contradicts =
            k > first && !(Phi.segment(first, k - first).cwiseAbs().maxCoeff() <= 1e-9 * std::max(1.0, L));
        if (repeated > 0) result.redundant.push_back({joint, repeated, contradicts});
        rank_before = rank;
    }

    const MatrixXd redundant = result.rank < m ? null_space_of(Phi_q.transpose(), m) : MatrixXd(m, 0);
    find_undetermined(model, redundant, result);

    MatrixXd elastic = elastic_rows(model, inputs, q) * physical.asDiagonal();
    normalise_rows(elastic);
    MatrixXd noticed(m + elastic.rows(), n);
    noticed << Phi_q, elastic;
    const MatrixXd idle = sparse_basis(noticed, null_space_of(noticed, n), nb);
    for (Eigen::Index c = 0; c < idle.cols(); ++c) {
        IdleMode mode;
        Eigen::Index largest = 0;  // the sign is free: the largest entry counts as positive
        (void)idle.col(c).cwiseAbs().maxCoeff(&largest);
        const VectorXd dq = (idle(largest, c) < 0 ? -1 : 1) * (physical.asDiagonal() * idle.col(c));
        mode.dq = dq.sparseView();
        (void)idle.col(c).reshaped(6, nb).colwise().norm().maxCoeff(&largest);
        mode.body = static_cast<BodyId>(largest);
        mode.description =
            describe(model, q, mode.body, dq.segment<3>(6 * largest), dq.segment<3>(6 * largest + 3), L);
        result.idle.push_back(mode);
    }

    MatrixXd null_space = MatrixXd::Zero(n + m, idle.cols() + redundant.cols());
    null_space.topLeftCorner(n, idle.cols()) = physical.asDiagonal() * idle;
    if (redundant.cols() > 0)  // λ of the unscaled rows
        null_space.bottomRightCorner(m, redundant.cols()) = row_norm.cwiseInverse().asDiagonal() * redundant;
    result.null_space = null_space.sparseView();

    // f_ext(0) - f_elast, projected on what the constraints leave free.
    VectorXd f(n);
    f.setZero();
    for (const auto& load : model.static_loads) add_load<double>(load.kind, 1.0, q, f);
    f -= elastic_force<double>(model, inputs, q);
    if (!f.isZero(0)) {
        const MatrixXd free = null_space_of(Phi_q, n);
        const VectorXd left = free * (free.transpose() * (physical.asDiagonal() * f));
        result.imbalance = left.cwiseAbs().maxCoeff();
    }
    return result;
}

std::string idle_modes(const Diagnosis& diagnosis) {
    std::string all;
    for (const auto& mode : diagnosis.idle) all += (all.empty() ? "" : "; ") + mode.description;
    return all;
}

Conditioning conditioning(const Model& model, const Diagnosis& diagnosis) {
    const State<double> q = design_state<double>(model);
    MatrixXd M(diagnosis.coordinates + diagnosis.rows, diagnosis.coordinates + diagnosis.rows);
    VectorXd unused(diagnosis.rows);
    SaddleMatrix<double> kept = saddle_matrix(model);
    assemble<double>(model, inputs_as_drawn<double>(model), q, kept, unused);
    M = sparse(kept);
    const VectorXd D = equilibration(kept);
    const auto nullity = diagnosis.null_space.cols();
    return {condition_number(M, nullity), condition_number(D.asDiagonal() * M * D.asDiagonal(), nullity)};
}

}  // namespace elastocheck::recursive
