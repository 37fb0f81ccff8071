// Converts ADAMS elastic elements with six components.
//
// A BUSHING, FIELD or BEAM exerts on the part of marker I, at its origin and in the axes of marker J,
//
//   F = FORCE - K (x - x_0),   x = (δ; a, b, c),   δ = A_Jᵀ (p_I - p_J),
//
// a, b, c the projected angles of I in J, and the opposite wrench at the same point on the part of J.
// In a scene this is a bushing from J's body (i) to I's body (j), both markers at I's origin, with
// `angles: projected` and `conjugate: false`. Its displacement is d = δ - δ_drawn, δ_drawn the value at
// the design position, so that its undeformed position is x_0 - δ_drawn. If I is rotated relative to J at
// the design position, frame_j has the axes of I.
#include "models/import/adm/bushings.hpp"

#include <algorithm>
#include <cmath>

namespace elastocheck::importer::adm {

using Eigen::Matrix3d, Eigen::Vector3d;

namespace {

constexpr double parallel = 1e-9;   // largest angle between parallel frames [rad]
constexpr double far_apart = 0.05;  // markers are reported from this share of the model's size on

std::string stiffness_text(const Matrix6& K) {
    std::string rows;
    for (int i = 0; i < 6; ++i) {
        std::string row;
        for (int k = 0; k < 6; ++k) row += (k ? ", " : "") + number(K(i, k));
        rows += fmt::format("{}[{}]", i ? ", " : "", row);
    }
    return "[" + rows + "]";
}

}  // namespace

void put_bushing(Conversion& c, const Statement& s, const Marker& I, int part_j, const Frame& J,
                 const SixLaws& laws) {
    Fields fields;
    fields.add("bodies", c.pair(part_j, I.part)).add("at", c.point(I));
    const auto add_frame = [&](const char* name, const Matrix3d& A) {
        fields.add(name, fmt::format("{{x: {}, y: {}}}", direction(A.col(0)), direction(A.col(1))));
    };
    if (!((J.A - Matrix3d::Identity()).norm() <= 1e-12)) add_frame("frame", J.A);
    if (Eigen::AngleAxisd(Matrix3d(J.A.transpose() * I.pose.A)).angle() > parallel)
        add_frame("frame_j", I.pose.A);
    const Vector6 rates = laws.K.diagonal();
    if (laws.is_coupled())
        fields.add("stiffness", stiffness_text(laws.K));
    else
        for (const auto& [name, k] : {std::pair{"rates", 0}, {"rotational_rates", 3}})
            fields.add(name, fmt::format("[{}, {}, {}]", number(rates[k]), number(rates[k + 1]),
                                         number(rates[k + 2])));
    std::string curves;
    for (std::size_t k = 0; k < 6; ++k)
        if (!laws.curves[k].empty())
            curves += fmt::format("{}{}: {}", curves.empty() ? "" : ", ",
                                  std::array{"x", "y", "z", "rx", "ry", "rz"}[k],
                                  curve_of_rows(laws.curves[k], laws.extrapolates[k]));
    if (!curves.empty()) fields.add("curves", "{" + curves + "}");
    const auto add = [&](const char* name, const Vector3d& v, double threshold, double scale) {
        if (v.norm() > threshold) fields.add(name, triple(v, scale));
    };
    const double size = c.geometry.size;
    add("undeformed", laws.x_0.head<3>() - J.A.transpose() * (I.pose.r - J.r), 1e-12 * size, size);
    add("undeformed_angles", laws.x_0.tail<3>(), 0, 1);
    add("preload", -laws.preload.head<3>(), 0, 1);
    add("preload_moment", -laws.preload.tail<3>(), 0, 1);
    fields.add("formulation", "{angles: projected, conjugate: false}");
    c.draft.bushings.push_back({c.name(c.element_names, s), fields.braced(), s.place()});
}

Matrix6 in_scene_units(Matrix6 K, const Units& units) {
    K.topLeftCorner<3, 3>() *= units.force / units.length;
    K.topRightCorner<3, 3>() *= units.force;
    K.bottomLeftCorner<3, 3>() *= units.force;
    K.bottomRightCorner<3, 3>() *= units.force * units.length;
    return K;
}
Vector6 wrench_in_scene_units(Vector6 F, const Units& units) {
    F.head<3>() *= units.force;
    F.tail<3>() *= units.force * units.length;
    return F;
}

namespace {

// Makes K symmetric. Returns the reason why a scene cannot represent it: asymmetric beyond the printed
// digits, or indefinite; empty if it can.
std::string symmetrise(Matrix6& K) {
    for (int i = 0; i < 6; ++i)
        for (int k = 0; k < i; ++k) {
            const double larger = std::max(std::abs(K(i, k)), std::abs(K(k, i)));
            const double diagonal = std::sqrt(std::abs(K(i, i) * K(k, k)));
            if (std::abs(K(i, k) - K(k, i)) > 1e-4 * std::max(larger, 1e-6 * diagonal))
                return fmt::format(
                    "its stiffness is not symmetric: {:g} in row {} and column {}, {:g} in the "
                    "transposed entry",
                    K(i, k), i + 1, k + 1, K(k, i));
        }
    K = (0.5 * (K + K.transpose())).eval();
    Vector6 d = K.diagonal();
    for (int i = 0; i < 6; ++i) {
        if (d[i] < 0) return fmt::format("its stiffness is negative: {:g} in row {}", d[i], i + 1);
        if (d[i] == 0 && !K.row(i).isZero(0))
            return fmt::format(
                "its stiffness is indefinite: row {} has a zero diagonal and other entries", i + 1);
        d[i] = d[i] > 0 ? 1 / std::sqrt(d[i]) : 1;
    }
    const Matrix6 S = d.asDiagonal() * K * d.asDiagonal();  // unit diagonal
    if (Eigen::LDLT<Matrix6> factors(S + 1e-10 * Matrix6::Identity());
        !(factors.vectorD().minCoeff() >= 0))
        return "its stiffness is indefinite";
    return {};
}

}  // namespace

bool make_symmetric(Conversion& c, const Statement& s, Matrix6& K) {
    const Matrix6 written = K;
    const std::string why = symmetrise(K);
    if (!why.empty()) c.miss(s, why);
    const double off = (written - K).cwiseAbs().maxCoeff();
    if (why.empty() && off > 0)
        c.warn(s,
               "its stiffness is not exactly symmetric; the scene has the mean with its transpose, "
               "which differs by {:.3g} of the largest entry",
               off / K.cwiseAbs().maxCoeff());
    return why.empty();
}

void convert_bushing(Conversion& c, const Statement& s) {
    const Marker &I = c.marker(s, "I"), &J = c.marker(s, "J");
    if (!c.is_between_two(s, I, J)) return;
    Vector6 rates, F;
    rates << vector(s, "K"), vector(s, "KT");
    F << vector(s, "FORCE"), vector(s, "TORQUE");
    if (rates.minCoeff() < 0) return c.miss(s, "a negative rate, which a scene does not allow");
    const double apart = (I.pose.r - J.pose.r).norm();
    if (apart > far_apart * c.geometry.size)
        c.warn(s,
               "its markers are {:.4g} {} apart in the file: it is preloaded by that deformation",
               apart, c.geometry.units.length_name);
    c.count("BUSHING");
    put_bushing(c, s, I, J.part, J.pose,
                {.K = in_scene_units(rates.asDiagonal(), c.geometry.units),
                 .preload = wrench_in_scene_units(F, c.geometry.units)});
}

void convert_field(Conversion& c, const Statement& s) {
    const Marker &I = c.marker(s, "I"), &J = c.marker(s, "J");
    if (s.has("FUNCTION")) return c.miss(s, "its force is a user-written function");
    const std::string formulated = s.word("FORMULATION");
    if (!std::string_view("LINEAR").starts_with(formulated))
        return c.miss(s, "FORMULATION={}, an unsupported law", formulated);
    if (!c.is_between_two(s, I, J)) return;
    const Units& units = c.geometry.units;
    const auto k = s.numbers("KMATRIX", 36, 36);
    if (k.empty()) s.fail("KMATRIX is missing");
    SixLaws laws{.K = in_scene_units(Eigen::Map<const Matrix6>(k.data()), units)};  // by columns
    if (!make_symmetric(c, s, laws.K)) return;
    // The last three values are angles, and may have the suffix for degrees.
    if (const auto x = s.numbers("LENGTH", 6, 6, Statement::Unit::angle); !x.empty()) {
        laws.x_0 = Eigen::Map<const Vector6>(x.data());
        laws.x_0.head<3>() *= units.length;
    }
    if (const auto F = s.numbers("FORCE", 6, 6); !F.empty())
        laws.preload = wrench_in_scene_units(Eigen::Map<const Vector6>(F.data()), units);
    c.count("FIELD");
    put_bushing(c, s, I, J.part, J.pose, laws);
}

// A Timoshenko beam from J along x of J to I, with the shear terms P = 12 E I s / (G A L²), s = ASY or ASZ.
void convert_beam(Conversion& c, const Statement& s) {
    const Marker &I = c.marker(s, "I"), &J = c.marker(s, "J");
    s.has("LINEAR");  // marks it as read
    if (s.has("STRING") || s.has("NONLINEAR") ||
        !std::string_view("LINEAR").starts_with(s.word("FORMULATION")))
        return c.miss(s, "a beam with another formulation than LINEAR, an unsupported law");
    if (!c.is_between_two(s, I, J)) return;
    const auto positive = [&](const char* name) {
        const double x = s.number(name, 0);
        if (!(x > 0))
            s.fail("{} is {}; it must be above zero", name, s.has(name) ? "not" : "missing");
        return x;
    };
    const double L = positive("LENGTH"), A = positive("AREA"), Ix = positive("IXX"),
                 Iy = positive("IYY"), Iz = positive("IZZ"), E = positive("EMODULUS"),
                 G = positive("GMODULUS");
    const double Py = 12 * E * Iz * s.number("ASY", 0) / (G * A * L * L),
                 Pz = 12 * E * Iy * s.number("ASZ", 0) / (G * A * L * L);
    if (!(Py >= 0) || !(Pz >= 0)) s.fail("ASY or ASZ is negative");
    Vector6 d;
    d << E * A / L, 12 * E * Iz / (L * L * L * (1 + Py)), 12 * E * Iy / (L * L * L * (1 + Pz)),
        G * Ix / L, (4 + Pz) * E * Iy / (L * (1 + Pz)), (4 + Py) * E * Iz / (L * (1 + Py));
    Matrix6 K = d.asDiagonal();
    K(1, 5) = K(5, 1) = -6 * E * Iz / (L * L * (1 + Py));
    K(2, 4) = K(4, 2) = 6 * E * Iy / (L * L * (1 + Pz));
    const Units& units = c.geometry.units;
    SixLaws laws{.K = in_scene_units(K, units)};
    laws.x_0[0] = L * units.length;
    const double apart = (J.pose.A.transpose() * (I.pose.r - J.pose.r) - laws.x_0.head<3>()).norm();
    if (apart > 1e-3 * laws.x_0[0])
        c.warn(s, "in the file its end is {:.3g} {} from the unloaded position", apart,
               units.length_name);
    c.count("BEAM");
    put_bushing(c, s, I, J.part, J.pose, laws);
}

}  // namespace elastocheck::importer::adm
