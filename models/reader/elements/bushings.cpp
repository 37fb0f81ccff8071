// Reads bushings: frames, stiffness or curves, preload, formulation.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "models/kinds.hpp"
#include "models/near.hpp"
#include "models/reader/elements/sections.hpp"
#include "models/reader/tables/curves.hpp"

namespace elastocheck::reader {
namespace {

constexpr double round_off = 1e-12;  // relative, of numbers that should be equal
constexpr double min_sine = 1e-6;    // of the angle between axes; below, they count as parallel

Vector3 rates(const Cursor& field, const Unit& unit) {
    const auto items = field.list(3, "rates");
    return {rate(items[0], unit), rate(items[1], unit), rate(items[2], unit)};
}

double larger_magnitude(double a, double b) { return std::max(std::abs(a), std::abs(b)); }

// ---- The frame of a bushing.

using Axes = Matrix3;  // columns: the frame's axes in ground axes

struct FrameField {
    Axes axes = Axes::Identity();
    // set if one axis was given: the other two are any perpendicular pair
    std::optional<int> only_axis;
};

// The right-handed frame with the axes a and b (0 x, 1 y, 2 z) along e_a and e_b.
Axes completed(int a, const Vector3& e_a, int b, const Vector3& e_b) {
    const double sign = b == (a + 1) % 3 ? 1 : -1;  // e_x × e_y = e_z, but e_y × e_x = -e_z
    Axes frame;
    frame.col(a) = e_a;
    frame.col(b) = e_b;
    frame.col(3 - a - b) = sign * e_a.cross(e_b);
    return frame;
}

// The axis written first is kept, the second is made perpendicular to it.
FrameField read_frame(const Cursor& field, const Definitions& defs) {
    field.only_keys({"x", "y", "z"});
    const auto& keys = field.value->keys;
    if (keys.size() != 1 && keys.size() != 2)
        field.fail(fmt::format("{} axes given; allowed: one or two", keys.size()));
    const int a = keys[0][0] - 'x';
    const Vector3 e_a = direction(field.require(keys[0]), defs);
    if (keys.size() == 1) return {completed(a, e_a, (a + 1) % 3, e_a.unitOrthogonal()), a};

    const int b = keys[1][0] - 'x';
    const Vector3 d_b = direction(field.require(keys[1]), defs);
    const Vector3 across = d_b - d_b.dot(e_a) * e_a;
    if (!(across.norm() > min_sine))
        field.fail(fmt::format("axes {} and {} are parallel; two different directions are needed",
                               keys[0], keys[1]));
    return {completed(a, e_a, b, across.normalized()), std::nullopt};
}

// Axes on the second body, if the bodies are rotated relative to each other at the design position.
Axes read_frame_j(const Cursor& field, const FrameField& frame, const Definitions& defs) {
    const FrameField other = read_frame(field, defs);
    if (frame.only_axis || other.only_axis)
        field.fail(
            "needs two axes, as does frame: both frames must be fully defined if they are not "
            "parallel");
    return other.axes;
}

// ---- The stiffness of a bushing.

// S = D⁻¹ K D⁻¹ with D = diag(√|K_ii|): by Sylvester's law of inertia its eigenvalues have the signs of
// those of K, and they do not mix units. Where K_ii = 0, D_ii scales the largest entry of the row to 1,
// so that S is clearly indefinite unless the row is zero.
Matrix6 scaled_to_unit_diagonal(const Matrix6& K) {
    const auto one_if_zero = [](double x) { return x == 0 ? 1 : x; };
    Vector6 d = K.diagonal().cwiseAbs().cwiseSqrt();
    const Vector6 nonzero = d.unaryExpr(one_if_zero);
    for (int i = 0; i < 6; ++i)
        if (d[i] == 0) d[i] = one_if_zero((K.col(i).array().abs() / nonzero.array()).maxCoeff());
    return (K.array() / (d * d.transpose()).array()).matrix();
}

void require_semidefinite(const Cursor& field, const Matrix6& K) {
    const Matrix6 S = scaled_to_unit_diagonal(K);
    const double lowest =
        Eigen::SelfAdjointEigenSolver<Matrix6>(S, Eigen::EigenvaluesOnly).eigenvalues()[0];
    if (!(lowest >= -round_off))
        field.fail(
            fmt::format("indefinite, its lowest eigenvalue is {:g} when scaled to a unit diagonal; "
                        "a stiffness must be positive semidefinite",
                        lowest));
}

void require_symmetric(const Cursor& field, const Matrix6& K) {
    for (int i = 0; i < 6; ++i)
        for (int j = i + 1; j < 6; ++j)
            if (!are_near(K(i, j), K(j, i), round_off * larger_magnitude(K(i, j), K(j, i))))
                field.fail(
                    fmt::format("not symmetric: row {}, column {} is {}, row {}, column {} is {}",
                                i + 1, j + 1, K(i, j), j + 1, i + 1, K(j, i)));
}

// Units of the four blocks. Both off-diagonal blocks are in force/angle, so that the matrix as written is
// symmetric in any units. Its definiteness is tested in SI units, since this conversion is not a
// congruence: √(force/length · moment/angle) differs from force/angle.
const Unit& unit_of_entry(int i, int j, const Units& units) {
    if ((i < 3) != (j < 3)) return units.coupling;
    return i < 3 ? units.rate : units.rotational_rate;
}

Matrix6 read_stiffness(const Cursor& field, const Units& units) {
    const auto rows = field.list(6, "rows");
    Matrix6 written, K;
    for (int i = 0; i < 6; ++i) {
        const auto row =
            rows[static_cast<std::size_t>(i)].list(6, fmt::format("numbers (row {})", i + 1));
        for (int j = 0; j < 6; ++j) {
            const Unit& unit = unit_of_entry(i, j, units);
            written(i, j) = row[static_cast<std::size_t>(j)].number(unit.name);
            K(i, j) = unit.si(written(i, j));
        }
    }
    require_symmetric(field, written);
    K = (0.5 * (K + K.transpose())).eval();
    require_semidefinite(field, K);
    return K;
}

// ---- The law: a stiffness matrix, or one law per axis if any axis has a curve.

constexpr const char* axis_names[] = {"x", "y", "z", "rx", "ry", "rz"};

Matrix6 read_rates(const Cursor& bushing, const Units& units) {
    Matrix6 K = Matrix6::Zero();
    if (const auto k = bushing.optional("rates")) K.diagonal().head<3>() = rates(*k, units.rate);
    if (const auto k = bushing.optional("rotational_rates"))
        K.diagonal().tail<3>() = rates(*k, units.rotational_rate);
    return K;
}

// A curve replaces the rate of its axis.
PerAxis read_curves(const Cursor& field, const Matrix6& K, const Definitions& defs) {
    field.only_keys(std::vector<std::string>(std::begin(axis_names), std::end(axis_names)));
    if (field.value->keys.empty()) field.fail("empty; a curve for at least one axis is needed");
    PerAxis law;
    for (std::size_t k = 0; k < 6; ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        law.axis[k] = LinearRate{K(i, i)};
        if (const auto curve = field.optional(axis_names[k]))
            law.axis[k] =
                read_curve(*curve, k < 3 ? of_lengths(defs.units) : of_angles(defs.units), defs);
    }
    return law;
}

SpatialLaw read_spatial_law(const Cursor& bushing, const Definitions& defs) {
    const bool has_rates = bushing.optional("rates") || bushing.optional("rotational_rates");
    const auto full = bushing.optional("stiffness"), curves = bushing.optional("curves");
    if (full && has_rates)
        full->fail(
            "given together with rates; allowed: stiffness, or rates and/or rotational_rates");
    if (full && curves)
        curves->fail(
            "given together with stiffness; allowed: curves, with or without rates, or stiffness");
    if (full) return LinearStiffness{read_stiffness(*full, defs.units)};
    if (const auto file = bushing.optional("rates");
        file && file->value->kind == Value::Kind::scalar) {
        if (!file->value->text.ends_with(".bus"))
            file->fail(fmt::format(
                "expected a list of 3 rates, or the name of a property file (.bus), found {}",
                file->found()));
        for (const char* field : {"rotational_rates", "curves"})
            if (const auto other = bushing.optional(field))
                other->fail("given together with rates from a file; the file has all six curves");
        PerAxis law;
        const auto tables = read_bushing_file(*file, defs);
        for (std::size_t k = 0; k < 6; ++k) law.axis[k] = interpolant(tables[k]);
        return law;
    }
    if (!has_rates && !curves)
        bushing.fail("no stiffness; allowed: rates, rotational_rates and/or curves, or stiffness");
    const Matrix6 K = read_rates(bushing, defs.units);
    if (curves) return read_curves(*curves, K, defs);
    return LinearStiffness{K};
}

// A translational and a rotational vector of the bushing; zero where not given.
Vector6 read_both(const Cursor& bushing, const char* translation, const Unit& unit,
                  const char* rotation, const Unit& rotational_unit) {
    Vector6 both = Vector6::Zero();
    if (const auto given = bushing.optional(translation)) both.head<3>() = vector(*given, unit);
    if (const auto given = bushing.optional(rotation))
        both.tail<3>() = vector(*given, rotational_unit);
    return both;
}

// Defaults: the first choice of each field.
Formulation read_formulation(const Cursor& field) {
    field.only_keys({"frame", "angles", "conjugate", "offset_moment"});
    using Frame = Formulation::Frame;
    using Angles = Formulation::Angles;
    Formulation result;
    if (const auto frame = field.optional("frame"))
        result.frame = std::array{Frame::on_i, Frame::on_j,
                                  Frame::middle}[frame->one_of("a frame", {"i", "j", "middle"})];
    if (const auto angles = field.optional("angles"))
        result.angles =
            std::array{Angles::rotation_vector, Angles::cardan, Angles::projected}[angles->one_of(
                "a definition of the angles", {"rotation_vector", "cardan", "projected"})];
    if (const auto conjugate = field.optional("conjugate"))
        result.conjugate = conjugate->yes_or_no();
    if (const auto moment = field.optional("offset_moment"))
        result.offset_moment = moment->yes_or_no();
    if (!result.conjugate && result.frame == Frame::middle)
        field.require("conjugate")
            .fail("false is not defined with the frame in the middle; allowed there: true");
    return result;
}

// ---- One axis defines the frame of an axisymmetric bushing.

// Rotation by 90 deg about an axis, of both vectors of a 6-vector. A vector or second-order tensor that
// it leaves unchanged is unchanged by any rotation about the axis; and it swaps entries without rounding.
Matrix6 quarter_turn(int axis) {
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    Matrix3 turn = Matrix3::Zero();
    turn(axis, axis) = 1;
    turn(c, b) = 1;
    turn(b, c) = -1;
    Matrix6 turn_both = Matrix6::Zero();
    turn_both.topLeftCorner<3, 3>() = turn_both.bottomRightCorner<3, 3>() = turn;
    return turn_both;
}

// The rates of the law; none if an axis across has a curve: u(d_x) + u(d_y) is axisymmetric only for the
// same quadratic u of both.
std::optional<Matrix6> rates_across(int axis, const SpatialLaw& law) {
    const auto of_axes = [&](const PerAxis& u) -> std::optional<Matrix6> {
        Matrix6 K = Matrix6::Zero();
        for (int k = 0; k < 6; ++k) {
            const double* rate = rate_of(u.axis[static_cast<std::size_t>(k)]);
            if (!rate && k % 3 != axis) return std::nullopt;
            K(k, k) = rate ? *rate : 0;
        }
        return K;
    };
    return std::visit(
        overloaded{[](const LinearStiffness& u) { return std::optional<Matrix6>(u.K); }, of_axes},
        law);
}

// Rejects a frame with only this axis unless the bushing is axisymmetric about it.
void require_axisymmetric(const Cursor& frame, int axis, const Bushing& bushing) {
    const auto refuse = [&](const char* why) {
        frame.fail(fmt::format("one axis is not enough, because {}; give a second one", why));
    };
    const Matrix6 turn = quarter_turn(axis);
    const auto are_equal = [](const auto& x, const auto& y) {
        for (Eigen::Index j = 0; j < x.cols(); ++j)
            for (Eigen::Index i = 0; i < x.rows(); ++i)
                if (!are_near(x(i, j), y(i, j), round_off * larger_magnitude(x(i, j), y(i, j))))
                    return false;
        return true;
    };
    const auto is_axisymmetric = [&](const Vector6& v) { return are_equal(v, Vector6(turn * v)); };
    const auto K = rates_across(axis, bushing.law);
    if (!K) refuse("a curve across it is not axisymmetric");
    if (!are_equal(*K, Matrix6(turn * *K * turn.transpose())) || !is_axisymmetric(bushing.preload))
        refuse("the rates or the preload across it are not axisymmetric");
    if (!is_axisymmetric(bushing.undeformed)) refuse("the undeformed position is not on it");
    if (bushing.formulation.angles != Formulation::Angles::rotation_vector)
        refuse("cardan and projected angles need all three");
}

}  // namespace

Elastic read_bushing(const std::string& name, const Cursor& field, const Definitions& defs) {
    field.only_keys({"bodies", "at", "frame", "frame_j", "rates", "rotational_rates", "stiffness",
                     "curves", "preload", "preload_moment", "undeformed", "undeformed_angles",
                     "formulation"});
    const auto [i, j] = body_pair(field.require("bodies"), defs);
    const Vector3 p = hardpoint(field.require("at"), defs);
    const auto frame_field = field.optional("frame");
    const FrameField frame = frame_field ? read_frame(*frame_field, defs) : FrameField{};
    const auto frame_j = field.optional("frame_j");
    const Axes axes_j = frame_j ? read_frame_j(*frame_j, frame, defs) : frame.axes;
    const Units& units = defs.units;
    Bushing bushing{.i = marker_of(i, p, frame.axes, defs),
                    .j = marker_of(j, p, axes_j, defs),
                    .law = read_spatial_law(field, defs)};
    bushing.preload = read_both(field, "preload", units.force, "preload_moment", units.moment);
    bushing.undeformed =
        read_both(field, "undeformed", units.length, "undeformed_angles", units.angle);
    if (const auto formulation = field.optional("formulation"))
        bushing.formulation = read_formulation(*formulation);
    if (frame.only_axis) require_axisymmetric(*frame_field, *frame.only_axis, bushing);
    return {name, bushing};
}

}  // namespace elastocheck::reader
