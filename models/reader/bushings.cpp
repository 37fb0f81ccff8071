#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "models/reader/sections.hpp"

namespace elastocheck::reader {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double round_off = 1e-12;  // relative, of numbers that should be equal
constexpr double parallel = 1e-6;    // sine of the angle between axes that are taken for one

Vector3d rates(const Cursor& at, const Unit& unit) {
    const auto items = at.list(3, "rates");
    return {rate(items[0], unit), rate(items[1], unit), rate(items[2], unit)};
}

// ---- The frame of a bushing.

using Frame = Matrix3d;  // columns: the frame's axes in ground axes

struct FrameField {
    Frame axes = Frame::Identity();
    std::optional<int> only_axis;  // if only this one was given, the other two are any perpendicular pair
};

// The right-handed frame with the axes a and b (0 x, 1 y, 2 z) along e_a and e_b.
Frame completed(int a, const Vector3d& e_a, int b, const Vector3d& e_b) {
    const double sign = b == (a + 1) % 3 ? 1 : -1;  // e_x × e_y = e_z, but e_y × e_x = -e_z
    Frame frame;
    frame.col(a) = e_a;
    frame.col(b) = e_b;
    frame.col(3 - a - b) = sign * e_a.cross(e_b);
    return frame;
}

// The axis written first is kept, the second is made perpendicular to it.
FrameField read_frame(const Cursor& at, const Definitions& defs) {
    at.only_keys({"x", "y", "z"});
    const auto& keys = at.value->keys;
    if (keys.size() != 1 && keys.size() != 2)
        at.fail(fmt::format("{} axes given; allowed: one or two", keys.size()));
    const int a = keys[0][0] - 'x';
    const Vector3d e_a = direction(at.require(keys[0]), defs);
    if (keys.size() == 1) return {completed(a, e_a, (a + 1) % 3, e_a.unitOrthogonal()), a};

    const int b = keys[1][0] - 'x';
    const Vector3d d_b = direction(at.require(keys[1]), defs);
    const Vector3d across = d_b - d_b.dot(e_a) * e_a;
    if (!(across.norm() > parallel))
        at.fail(fmt::format("axes {} and {} are parallel; two different ones are needed", keys[0], keys[1]));
    return {completed(a, e_a, b, across.normalized()), std::nullopt};
}

// ---- The stiffness of a bushing.

// S = D⁻¹ K D⁻¹ with D = diag(√|K_ii|): its eigenvalues have the signs of K's (Sylvester) and do not mix
// units. Where K_ii = 0, D_ii makes the largest entry of the row 1, so that a row that is not zero makes S
// clearly indefinite.
Matrix6 scaled_to_unit_diagonal(const Matrix6& K) {
    const auto one_if_zero = [](double x) { return x == 0 ? 1 : x; };
    Vector6 d = K.diagonal().cwiseAbs().cwiseSqrt();
    const Vector6 known = d.unaryExpr(one_if_zero);
    for (int i = 0; i < 6; ++i)
        if (d[i] == 0) d[i] = one_if_zero((K.col(i).array().abs() / known.array()).maxCoeff());
    return (K.array() / (d * d.transpose()).array()).matrix();
}

void require_semidefinite(const Cursor& at, const Matrix6& K) {
    const Matrix6 S = scaled_to_unit_diagonal(K);
    const double lowest = Eigen::SelfAdjointEigenSolver<Matrix6>(S, Eigen::EigenvaluesOnly).eigenvalues()[0];
    if (!(lowest >= -round_off))
        at.fail(
            fmt::format("indefinite, its lowest eigenvalue is {:g} when scaled to a unit diagonal; "
                        "a stiffness must be positive semidefinite",
                        lowest));
}

void require_symmetric(const Cursor& at, const Matrix6& K) {
    for (int i = 0; i < 6; ++i)
        for (int j = i + 1; j < 6; ++j)
            if (!(std::abs(K(i, j) - K(j, i)) <= round_off * std::max(std::abs(K(i, j)), std::abs(K(j, i)))))
                at.fail(fmt::format("not symmetric: row {}, column {} is {}, row {}, column {} is {}", i + 1,
                                    j + 1, K(i, j), j + 1, i + 1, K(j, i)));
}

// The unit of each of the four blocks; both off-diagonal ones are force/angle, so that the 6×6 is symmetric as
// written in any units. That is no congruence (√(force/length · moment/angle) is another unit than
// force/angle), so what is judged is the matrix in SI units, never the one that was written.
const Unit& unit_of_entry(int i, int j, const Units& units) {
    if ((i < 3) != (j < 3)) return units.coupling;
    return i < 3 ? units.rate : units.rotational_rate;
}

Matrix6 read_stiffness(const Cursor& at, const Units& units) {
    const auto rows = at.list(6, "rows");
    Matrix6 written, K;
    for (int i = 0; i < 6; ++i) {
        const auto row = rows[static_cast<std::size_t>(i)].list(6, fmt::format("numbers (row {})", i + 1));
        for (int j = 0; j < 6; ++j) {
            const Unit& unit = unit_of_entry(i, j, units);
            written(i, j) = row[static_cast<std::size_t>(j)].number(unit.name);
            K(i, j) = unit.si(written(i, j));
        }
    }
    require_symmetric(at, written);
    K = (0.5 * (K + K.transpose())).eval();
    require_semidefinite(at, K);
    return K;
}

Matrix6 read_K(const Cursor& bushing, const Units& units) {
    const auto translational = bushing.optional("rates");
    const auto rotational = bushing.optional("rotational_rates");
    const auto full = bushing.optional("stiffness");
    if (full && (translational || rotational))
        full->fail("given together with rates; allowed: stiffness, or rates and/or rotational_rates");
    if (full) return read_stiffness(*full, units);
    if (!translational && !rotational)
        bushing.fail("no stiffness; allowed: rates and/or rotational_rates, or stiffness");
    Matrix6 K = Matrix6::Zero();
    if (translational) K.diagonal().head<3>() = rates(*translational, units.rate);
    if (rotational) K.diagonal().tail<3>() = rates(*rotational, units.rotational_rate);
    return K;
}

Vector6 read_preload(const Cursor& bushing, const Units& units) {
    Vector6 preload = Vector6::Zero();
    if (const auto force = bushing.optional("preload")) preload.head<3>() = vector(*force, units.force);
    if (const auto moment = bushing.optional("preload_moment"))
        preload.tail<3>() = vector(*moment, units.moment);
    return preload;
}

// Whether the bushing stays the same when its frame turns about `axis`. A quarter turn is enough to tell: a
// tensor of second order or a vector that survives it survives any turn. It only swaps entries, so nothing is
// rounded.
bool is_round_about(int axis, const Matrix6& K, const Vector6& preload) {
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    Matrix3d turn = Matrix3d::Zero();
    turn(axis, axis) = 1;
    turn(c, b) = 1;
    turn(b, c) = -1;
    Matrix6 turn_both = Matrix6::Zero();
    turn_both.topLeftCorner<3, 3>() = turn_both.bottomRightCorner<3, 3>() = turn;
    const auto is_same = [](const auto& x, const auto& y) {
        return ((x - y).array().abs() <= round_off * x.array().abs().max(y.array().abs())).all();
    };
    return is_same(K, turn_both * K * turn_both.transpose()) && is_same(preload, turn_both * preload);
}

}  // namespace

Elastic read_bushing(const std::string& name, const Cursor& at, const Definitions& defs) {
    at.only_keys(
        {"bodies", "at", "frame", "rates", "rotational_rates", "stiffness", "preload", "preload_moment"});
    const auto [i, j] = body_pair(at.require("bodies"), defs);
    const Vector3d p = hardpoint(at.require("at"), defs);
    const auto frame_field = at.optional("frame");
    const FrameField frame = frame_field ? read_frame(*frame_field, defs) : FrameField{};
    const Matrix6 K = read_K(at, defs.units);
    const Vector6 preload = read_preload(at, defs.units);
    if (frame.only_axis && !is_round_about(*frame.only_axis, K, preload))
        frame_field->fail(
            "one axis is not enough, as the rates or the preload across it are not the same all round; "
            "give a second one");
    const Eigen::Quaterniond A = Eigen::Quaterniond(frame.axes).normalized();
    const auto marker = [&](BodyId body) { return Marker{body, point_of(body, p, defs).s_local, A}; };
    return {name, Bushing{.i = marker(i), .j = marker(j), .law = LinearStiffness{K}, .preload = preload}};
}

}  // namespace elastocheck::reader
