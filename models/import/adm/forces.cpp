// Converts ADAMS elastic elements and forces.
//
// A BUSHING, FIELD or BEAM exerts on the part of I, at I's origin and in the moving axes of J,
//
//   F = FORCE - K (x - x_0),   x = (δ; a, b, c),   δ = A_Jᵀ (p_I - p_J),   a, b, c projected angles
//                                                                          of I in J,
//
// and the opposite wrench at the same point on the part of J. In a scene this is a bushing from J's
// body to I's body at I's origin, with `angles: projected` and `conjugate: false`. Its d is
// δ - δ_drawn, so its undeformed position is x_0 - δ_drawn. If I is rotated relative to J at the
// design position, frame_j is that of I.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "models/import/adm/conversion.hpp"
#include "models/import/curves.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer::adm {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr double turned = 1e-9;  // larger: two frames are not parallel [rad]
// of the model's size: larger distances between markers are reported
constexpr double far = 0.05;

const char* const formulation = "{angles: projected, conjugate: false}";

const Shape bushing_shape{{}, {"I", "J", "K", "KT", "C", "CT", "FORCE", "TORQUE"}, {}};
const Shape field_shape{
    {}, {"I", "J", "KMATRIX", "CMATRIX", "CRATIO", "LENGTH", "FORCE", "FORMULATION"}, {"FUNCTION"}};
const Shape beam_shape{{"LINEAR", "STRING", "NONLINEAR"},
                       {"I", "J", "LENGTH", "AREA", "IXX", "IYY", "IZZ", "EMODULUS", "GMODULUS",
                        "ASY", "ASZ", "CRATIO", "CMATRIX", "FORMULATION"},
                       {}};
const Shape spring_shape{{"TRANSLATIONAL", "ROTATIONAL"},
                         {"I", "J", "K", "C", "KT", "CT", "LENGTH", "ANGLE", "FORCE", "TORQUE"},
                         {}};

// Laws of one element, in units of the scene.
struct SixLaws {
    Matrix6 K = Matrix6::Zero();
    Vector6 x_0 = Vector6::Zero();      // length, angles
    Vector6 preload = Vector6::Zero();  // on I at x_0
    // restoring force over x; empty: use K
    std::array<std::vector<std::pair<double, double>>, 6> curves = {};
    std::array<bool, 6> goes_on = {true, true, true, true, true, true};
};

struct Element {
    Conversion& c;
    const Statement& s;
    const Arguments& at;
    const Marker& I;
    int part_j;
    Frame J;  // δ is measured from its origin, in its axes

    SourceLocation place() const { return s.place(); }

    void put(const SixLaws& laws) const {
        const Vector3d drawn = J.A.transpose() * (I.pose.r - J.r);
        const Matrix3d B = J.A.transpose() * I.pose.A;
        Fields fields;
        fields.add("bodies", c.pair(part_j, I.part)).add("at", c.point(I));
        frame(fields, "frame", J.A);
        if (Eigen::AngleAxisd(B).angle() > turned) frame(fields, "frame_j", I.pose.A);
        const Matrix6& K = laws.K;
        const Matrix6 off = K - Matrix6(K.diagonal().asDiagonal());
        const auto three = [&](int first) {
            return fmt::format("[{}, {}, {}]", number(K(first, first)),
                               number(K(first + 1, first + 1)), number(K(first + 2, first + 2)));
        };
        if (off.isZero(0)) {
            fields.add("rates", three(0)).add("rotational_rates", three(3));
        } else {
            std::string rows;
            for (int i = 0; i < 6; ++i) {
                std::string row;
                for (int k = 0; k < 6; ++k) row += (k ? ", " : "") + number(K(i, k));
                rows += fmt::format("{}[{}]", i ? ", " : "", row);
            }
            fields.add("stiffness", "[" + rows + "]");
        }
        std::string curves;
        for (std::size_t k = 0; k < 6; ++k)
            if (!laws.curves[k].empty())
                curves +=
                    fmt::format("{}{}: {{table: {}{}}}", curves.empty() ? "" : ", ",
                                std::array{"x", "y", "z", "rx", "ry", "rz"}[k],
                                table(laws.curves[k]), laws.goes_on[k] ? "" : ", outside: unknown");
        if (!curves.empty()) fields.add("curves", "{" + curves + "}");
        const double size = c.geometry.size;
        const Vector3d undeformed = laws.x_0.head<3>() - drawn;
        if (undeformed.norm() > 1e-12 * size) fields.add("undeformed", triple(undeformed, size));
        if (!laws.x_0.tail<3>().isZero(0))
            fields.add("undeformed_angles", triple(laws.x_0.tail<3>()));
        if (!laws.preload.head<3>().isZero(0))
            fields.add("preload", triple(-laws.preload.head<3>()));
        if (!laws.preload.tail<3>().isZero(0))
            fields.add("preload_moment", triple(-laws.preload.tail<3>()));
        fields.add("formulation", formulation);
        c.draft.bushings.push_back(
            {c.name(c.element_names, s), "{" + fields.text() + "}", place()});
    }

    static void frame(Fields& fields, const char* name, const Matrix3d& A) {
        if ((A - Matrix3d::Identity()).norm() <= 1e-12 && std::string_view(name) == "frame") return;
        fields.add(name, fmt::format("{{x: {}, y: {}}}", direction(A.col(0)), direction(A.col(1))));
    }
};

// Converts a stiffness matrix to units of the scene, by blocks: force/length, force, force ·
// length.
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

// Reason why a scene cannot represent the stiffness: not symmetric, or negative; empty if it can.
std::string fault(Matrix6& K) {
    for (int i = 0; i < 6; ++i)
        for (int k = 0; k < i; ++k) {
            const double larger = std::max(std::abs(K(i, k)), std::abs(K(k, i)));
            const double rows = std::sqrt(std::abs(K(i, i) * K(k, k)));
            if (std::abs(K(i, k) - K(k, i)) > 1e-4 * std::max(larger, 1e-6 * rows))
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
    const Matrix6 S = d.asDiagonal() * K * d.asDiagonal();
    if (Eigen::LDLT<Matrix6> factors(S + 1e-10 * Matrix6::Identity());
        !(factors.vectorD().minCoeff() >= 0))
        return "its stiffness is indefinite";
    return {};
}

void warn_of_asymmetry(Conversion& c, const Statement& s, const Matrix6& written,
                       const Matrix6& K) {
    const double off = (written - K).cwiseAbs().maxCoeff();
    if (off > 0)
        c.warn(s, fmt::format(
                      "its stiffness is not exactly symmetric; the scene has the mean with its "
                      "transpose, which differs by {:.3g} of the largest entry",
                      off / K.cwiseAbs().maxCoeff()));
}

void convert_bushing(Conversion& c, const Statement& s) {
    const Arguments at(c.data.file, s, bushing_shape);
    const Marker &I = c.marker(at, "I"), &J = c.marker(at, "J");
    if (!is_between_two(c, s, I, J, at)) return;
    const Units& units = c.geometry.units;
    Matrix6 K = Matrix6::Zero();
    K.diagonal().head<3>() = vector(at.numbers("K", 3, 3));
    K.diagonal().tail<3>() = vector(at.numbers("KT", 3, 3));
    Vector6 F;
    F << vector(at.numbers("FORCE", 3, 3)), vector(at.numbers("TORQUE", 3, 3));
    if (K.diagonal().minCoeff() < 0)
        return c.miss(s, "a negative rate, which a scene does not allow");
    const double apart = (I.pose.r - J.pose.r).norm();
    if (apart > far * c.geometry.size)
        c.warn(
            s,
            fmt::format(
                "its markers are {:.4g} {} apart in the file: it is preloaded by that deformation",
                apart, units.length_name));
    c.count("BUSHING");
    Element{c, s, at, I, J.part, J.pose}.put(
        {.K = in_scene_units(K, units), .preload = wrench_in_scene_units(F, units)});
}

void convert_field(Conversion& c, const Statement& s) {
    const Arguments at(c.data.file, s, field_shape);
    const Marker &I = c.marker(at, "I"), &J = c.marker(at, "J");
    if (at.has("FUNCTION")) return c.miss(s, "its force is a user-written function");
    const std::string formulated = at.word("FORMULATION");
    if (!formulated.empty() && !std::string_view("LINEAR").starts_with(formulated))
        return c.miss(s, fmt::format("FORMULATION={}, an unsupported law", formulated));
    if (!is_between_two(c, s, I, J, at)) return;
    const Units& units = c.geometry.units;
    const auto k = at.numbers("KMATRIX", 36, 36);
    if (k.empty()) at.fail("KMATRIX is missing");
    // by columns
    const Matrix6 written = in_scene_units(Eigen::Map<const Matrix6>(k.data()), units);
    Matrix6 K = written;
    if (const std::string why = fault(K); !why.empty()) return c.miss(s, why);
    warn_of_asymmetry(c, s, written, K);
    SixLaws laws{.K = K};
    // The last three values are angles, and may have the suffix for degrees.
    if (at.has("LENGTH")) {
        const auto length = at.angles("LENGTH", 6);
        laws.x_0 = Eigen::Map<const Vector6>(length.data());
        laws.x_0.head<3>() *= units.length;
    }
    if (at.has("FORCE"))
        laws.preload = wrench_in_scene_units(
            Eigen::Map<const Vector6>(at.numbers("FORCE", 6, 6).data()), units);
    c.count("FIELD");
    Element{c, s, at, I, J.part, J.pose}.put(laws);
}

// From J along its x axis to I: Timoshenko beam, with the shear term P = 12 E I s / (G A L²).
void convert_beam(Conversion& c, const Statement& s) {
    const Arguments at(c.data.file, s, beam_shape);
    const Marker &I = c.marker(at, "I"), &J = c.marker(at, "J");
    const std::string formulated = at.word("FORMULATION");
    at.has("LINEAR");
    if (at.has("STRING") || at.has("NONLINEAR") ||
        (!formulated.empty() && !std::string_view("LINEAR").starts_with(formulated)))
        return c.draft.notes.miss(
            s.place(), "a beam with another formulation than LINEAR, an unsupported law");
    if (!is_between_two(c, s, I, J, at)) return;
    const auto positive = [&](const char* name) {
        const double x = at.number(name, 0);
        if (!(x > 0))
            at.fail(fmt::format("{} is {}; it must be above zero", name,
                                at.has(name) ? "not" : "missing"));
        return x;
    };
    const double L = positive("LENGTH"), A = positive("AREA"), Ix = positive("IXX"),
                 Iy = positive("IYY"), Iz = positive("IZZ"), E = positive("EMODULUS"),
                 G = positive("GMODULUS");
    const double Py = 12 * E * Iz * at.number("ASY", 0) / (G * A * L * L),
                 Pz = 12 * E * Iy * at.number("ASZ", 0) / (G * A * L * L);
    if (!(Py >= 0) || !(Pz >= 0)) at.fail("ASY or ASZ is negative");
    Matrix6 K = Matrix6::Zero();
    K(0, 0) = E * A / L;
    K(1, 1) = 12 * E * Iz / (L * L * L * (1 + Py));
    K(2, 2) = 12 * E * Iy / (L * L * L * (1 + Pz));
    K(3, 3) = G * Ix / L;
    K(4, 4) = (4 + Pz) * E * Iy / (L * (1 + Pz));
    K(5, 5) = (4 + Py) * E * Iz / (L * (1 + Py));
    K(1, 5) = K(5, 1) = -6 * E * Iz / (L * L * (1 + Py));
    K(2, 4) = K(4, 2) = 6 * E * Iy / (L * L * (1 + Pz));
    const Units& units = c.geometry.units;
    SixLaws laws{.K = in_scene_units(K, units)};
    laws.x_0[0] = L * units.length;
    const double apart = (J.pose.A.transpose() * (I.pose.r - J.pose.r) - laws.x_0.head<3>()).norm();
    if (apart > 1e-3 * laws.x_0[0])
        c.draft.notes.warn(
            s.place(), fmt::format("in the file its end is {:.3g} {} from the unloaded position",
                                   apart, units.length_name));
    c.draft.notes.count("BEAM");
    Element{c, s, at, I, J.part, J.pose}.put(laws);
}

// ---- Forces along a line, and torques about an axis.

// Laws of one deformation u = scale · x + offset in a Value, as the restoring force f(x) = -value.
struct OneLaw {
    double rate = 0;                               // of x
    double at_zero = 0;                            // f(0)
    std::vector<std::pair<double, double>> curve;  // replaces both
    bool goes_on = true;
    struct Stop {
        bool bump = true;
        double touches = 0;                            // x
        std::vector<std::pair<double, double>> curve;  // over the penetration
        double rate = 0;
        bool goes_on = true;
    };
    std::vector<Stop> stops;
};

constexpr int rows_of_power = 24;

// Warns if the scene's interpolant of a SPLINE deviates from that of ADAMS. `is_angle`: the law is
// torsional, and its force is a torque.
void warn_of_spline(Conversion& c, const Statement& s, const CurveTerm& term, const Rows& rows,
                    bool is_angle) {
    const Units& units = c.geometry.units;
    const bool is_akima =
        term.kind == CurveTerm::Kind::impact ? term.is_akima : term.kind == CurveTerm::Kind::akima;
    const Apart apart = is_akima ? off_akima(rows) : off_natural(rows);
    if (apart.force <= 1e-6 * apart.of) return;
    c.warn(s, fmt::format(
                  "differs by up to {:.3g} {} (of {:.4g}), at {:.4g} {}: between the points of "
                  "SPLINE/{} the file has {}, the scene the monotone interpolant",
                  apart.force,
                  is_angle ? units.force_name + " " + units.length_name : units.force_name,
                  apart.of, apart.at, is_angle ? "rad" : units.length_name, term.spline,
                  is_akima ? "Akima's curve" : "a cubic spline"));
}

// Converts all terms of `value`, which are in one measure, to `law`. Returns the reason if a scene
// cannot represent a term; empty if it can.
std::string one_law(Conversion& c, const Statement& s, const Value& value, double x_from,
                    double x_to, double unit, double force, bool is_angle, OneLaw& law) {
    const Units& units = c.geometry.units;
    const std::string unit_of_x = is_angle ? "rad" : units.length_name,
                      unit_of_force =
                          is_angle ? units.force_name + " " + units.length_name : units.force_name;
    for (const auto& [measure, k] : value.linear) law.rate += -k * force / unit;
    law.at_zero = -value.constant * force;
    bool has_table = false;
    for (const CurveTerm& term : value.curves) {
        if (term.kind == CurveTerm::Kind::impact) {
            if (!(term.factor > 0) == (term.scale > 0))
                return "a contact with a tensile force, which no stop of a scene has";
            OneLaw::Stop stop;
            stop.bump = term.scale > 0;
            stop.touches = (term.contact - term.offset) / term.scale * unit;
            if (term.spline != 0) {
                const auto found = c.splines.find(term.spline);
                if (found == c.splines.end())
                    return fmt::format("SPLINE/{} does not exist or has no points", term.spline);
                const Table& points = found->second;
                if (points.x.front() != 0 || points.y.front() != 0)
                    return fmt::format("SPLINE/{} of a penetration does not begin at 0, 0",
                                       term.spline);
                stop.goes_on = points.goes_on;
                for (std::size_t n = 0; n < points.x.size(); ++n)
                    stop.curve.emplace_back(points.x[n] / std::abs(term.scale) * unit,
                                            std::abs(term.factor) * points.y[n] * force);
                warn_of_spline(c, s, term, stop.curve, is_angle);
                law.stops.push_back(stop);
                continue;
            }
            // Over the penetration p of x: factor · rate · (|scale| p)^e.
            const double factor = std::abs(term.factor) * term.rate *
                                  std::pow(std::abs(term.scale) / unit, term.exponent) * force;
            if (term.exponent == 1) {
                stop.rate = factor;
            } else {
                const double depth =
                    std::max(std::abs(stop.bump ? stop.touches - x_from : x_to - stop.touches),
                             1e-3 * (x_to - x_from));
                for (int n = 0; n <= rows_of_power; ++n) {
                    const double p = depth * n * n / (rows_of_power * rows_of_power);
                    stop.curve.emplace_back(p, factor * std::pow(p, term.exponent));
                }
                const Apart apart = off_power(stop.curve, factor, term.exponent);
                c.warn(s, fmt::format(
                              "differs by up to {:.2g} {} (of {:.4g}): a contact with exponent "
                              "{:g} becomes a table of {} rows up to {:.4g} {}",
                              apart.force, unit_of_force, apart.of, term.exponent,
                              rows_of_power + 1, depth, unit_of_x));
            }
            law.stops.push_back(stop);
            continue;
        }
        if (has_table) return "a sum of two splines";
        has_table = true;
        const auto found = c.splines.find(term.spline);
        if (found == c.splines.end())
            return fmt::format("SPLINE/{} does not exist or has no points", term.spline);
        const Table& points = found->second;
        law.goes_on = points.goes_on;
        for (std::size_t n = 0; n < points.x.size(); ++n)
            law.curve.emplace_back((points.x[n] - term.offset) / term.scale * unit,
                                   -term.factor * points.y[n] * force);
        if (term.scale < 0) std::ranges::reverse(law.curve);
        warn_of_spline(c, s, term, law.curve, is_angle);
    }
    if (has_table)
        for (auto& [x, f] : law.curve) f += law.rate * x + law.at_zero;
    for (std::size_t n = 1; n < law.curve.size(); ++n)
        if (!(law.curve[n].second >= law.curve[n - 1].second))
            return fmt::format(
                "a force that decreases with the deformation (at {:.6g}), which a scene does not "
                "allow",
                law.curve[n].first);
    if (!has_table && law.rate < 0) return "a negative rate, which a scene does not allow";
    return {};
}

std::string curve_text(const Rows& rows, bool goes_on) {
    return fmt::format("{{table: {}{}}}", table(rows), goes_on ? "" : ", outside: unknown");
}

Fields stop_fields(const OneLaw::Stop& stop, double drawn) {
    Fields fields;
    fields.add("clearance", computed(stop.bump ? drawn - stop.touches : stop.touches - drawn,
                                     std::max(1.0, std::abs(drawn))));
    if (stop.curve.empty())
        fields.add("rate", stop.rate);
    else
        fields.add("curve", curve_text(stop.curve, stop.goes_on));
    return fields;
}

// A force along the line from I to J, positive if repulsive; `value` is a function of DM(I, J).
void put_spring(Conversion& c, const Statement& s, const Marker& I, const Marker& J,
                const Value& value, bool is_damper) {
    const Units& units = c.geometry.units;
    const double drawn = (I.pose.r - J.pose.r).norm();
    const std::string name = c.name(c.element_names, s);
    const auto ends = [&](const std::string& bodies) {
        return Fields{}.add("bodies", bodies).add("from", c.point(I)).add("to", c.point(J));
    };
    if (!(drawn > 1e-9 * c.geometry.size)) return c.miss(s, "its ends coincide in the file");
    OneLaw law;
    const std::string why =
        one_law(c, s, value, 0, 2 * drawn, units.length, units.force, false, law);
    if (!why.empty()) return c.miss(s, why);
    if (law.stops.size() > 2 || (law.stops.size() == 2 && law.stops[0].bump == law.stops[1].bump))
        return c.miss(s, "more than one stop per direction");
    const bool is_nothing =
        law.curve.empty() && law.rate == 0 && law.at_zero == 0 && law.stops.empty();
    if (is_nothing) {
        if (!is_damper || c.options.drop_dynamics) return c.leave_out(s, "without force at rest");
        // A damper does not hold a part: it is written if something else holds both its parts.
        const std::string bodies = fmt::format("[{}, {}]", c.body(I.part), c.body(J.part));
        c.draft.dampers.push_back({name, ends(bodies).braced(), s.place()});
        return;
    }
    Fields fields = ends(c.pair(I.part, J.part));
    // ℓ₀ where the law is zero; for a curve the file's reference length, if there is one.
    if (law.curve.empty() && law.rate > 0) {
        const double free = -law.at_zero / law.rate;
        if (!(free > 0)) {
            // A spring needs a positive length: write the same straight line as a table over the
            // drawn length.
            const double h = 0.5 * drawn, f = law.at_zero + law.rate * drawn;
            fields.add("curve", curve_text({{-h, f - law.rate * h}, {h, f + law.rate * h}}, true));
        } else {
            fields.add("rate", law.rate).add("free_length", computed(free));
            if (free < drawn * (1 - 1e-9))
                c.warn(s, "this spring is in tension at the position in the file");
        }
    } else if (!law.curve.empty()) {
        for (auto& [x, f] : law.curve) x -= drawn;
        fields.add("curve", curve_text(law.curve, law.goes_on));
    } else if (law.at_zero != 0) {
        fields.add("curve",
                   curve_text({{-0.5 * drawn, law.at_zero}, {0.5 * drawn, law.at_zero}}, true));
    } else {
        for (const auto& stop : law.stops)
            fields.add(stop.bump ? "bump" : "rebound", stop_fields(stop, drawn).braced());
        c.draft.stops.push_back({name, fields.braced(), s.place()});
        return;
    }
    for (const auto& stop : law.stops)
        fields.add(stop.bump ? "bump_stop" : "rebound_stop", stop_fields(stop, drawn).braced());
    c.draft.springs.push_back({name, fields.braced(), s.place()});
}

// A torque about z, positive on I; `value` is a function of AZ(I, J).
void put_torsion(Conversion& c, const Statement& s, const Arguments& at, const Marker& I,
                 const Marker& J, const Value& value) {
    const Units& units = c.geometry.units;
    const Vector3d z = J.pose.A.col(2);
    if (const double off = z.cross(Vector3d(I.pose.A.col(2))).norm(); off > 1e-2)
        at.fail(fmt::format("the axes z of I and J are {:.3g} deg apart; a torque needs one axis",
                            off * 180 / std::numbers::pi));
    const double drawn =
        std::atan2(I.pose.A.col(0).dot(J.pose.A.col(1)), I.pose.A.col(0).dot(J.pose.A.col(0)));
    OneLaw law;
    const std::string why =
        one_law(c, s, value, -3.14, 3.14, 1, units.force * units.length, true, law);
    if (!why.empty()) return c.miss(s, why);
    if (!law.stops.empty()) return c.miss(s, "a stop of a rotation, which a scene does not have");
    if (law.curve.empty() && law.rate == 0 && law.at_zero == 0)
        return c.leave_out(s, "without force at rest");
    Fields fields;
    fields.add("bodies", c.pair(J.part, I.part)).add("at", c.point(I)).add("axis", direction(z));
    if (!law.curve.empty()) {
        for (auto& [x, f] : law.curve) x -= drawn;
        fields.add("curve", curve_text(law.curve, law.goes_on));
    } else {
        fields.add("rate", law.rate);
        const double moment = law.at_zero + law.rate * drawn;
        if (std::abs(moment) > 1e-12 * (std::abs(law.at_zero) + std::abs(law.rate)))
            fields.add("preload_moment", computed(moment));
    }
    c.draft.torsion_springs.push_back({c.name(c.element_names, s), fields.braced(), s.place()});
}

Value linear_in(Measure::Kind kind, double k, double free, double force) {
    Value value;
    if (k != 0) value.linear[{.kind = kind}] = -k;
    value.constant = force + k * free;
    return value;
}

void convert_springdamper(Conversion& c, const Statement& s) {
    const Arguments at(c.data.file, s, spring_shape);
    const Marker &I = c.marker(at, "I"), &J = c.marker(at, "J");
    const bool rotates = at.has("ROTATIONAL");
    if (!rotates && !at.has("TRANSLATIONAL")) at.fail("neither TRANSLATIONAL nor ROTATIONAL");
    if (!is_between_two(c, s, I, J, at)) return;
    c.count("SPRINGDAMPER");
    const double k = at.number(rotates ? "KT" : "K", 0);
    const bool damps = at.number(rotates ? "CT" : "C", 0) != 0;
    if (damps && k != 0) c.leave_out(s, "damping", "without effect at rest");
    if (rotates)
        put_torsion(c, s, at, I, J,
                    linear_in(Measure::Kind::AZ, k, at.angle("ANGLE", 0), at.number("TORQUE", 0)));
    else
        put_spring(c, s, I, J,
                   linear_in(Measure::Kind::DM, k, at.number("LENGTH", 0), at.number("FORCE", 0)),
                   damps);
}

// ---- Forces given by expressions.

// One component of a force or torque on I that does not depend on displacements, along an axis
// fixed to the part (a follower) or to ground. Its value at time 0 is a static load; its change
// over time becomes a branch.
struct LoadComponent {
    Vector3d axis;
    bool is_moment = false;
    Programme value;  // [unit of the file]
};

void put_load(Conversion& c, const Statement& s, const Marker& I,
              const std::vector<LoadComponent>& components, bool follows) {
    const Units& units = c.geometry.units;
    const std::string name = c.name(c.load_names, s);
    const std::string ending = follows ? ", follows: true}" : "}";
    const auto load = [&](const Vector3d& v, bool is_moment) {
        return is_moment ? fmt::format("{{on: {}, moment: {}{}", c.body(I.part), triple(v), ending)
                         : fmt::format("{{on: {}, at: {}, force: {}{}", c.body(I.part), c.point(I),
                                       triple(v), ending);
    };
    Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
    for (const auto& [axis, is_moment, value] : components) {
        const double unit = units.force * (is_moment ? units.length : 1);
        (is_moment ? moment : force) += axis * value.first.constant * unit;
        if (!value.varies()) continue;
        Drive drive{.kind = is_moment ? Drive::Kind::moment : Drive::Kind::force,
                    .quantity = c.load_names.take(name + ".change"),
                    .from = s.place()};
        for (const double x : value.path) drive.path.push_back((x - value.path[0]) * unit);
        drive.least = (value.least - value.path[0]) * unit;
        drive.most = (value.most - value.path[0]) * unit;
        c.draft.loads.push_back({drive.quantity, load(axis, is_moment), s.place()});
        c.drives.push_back(std::move(drive));
    }
    if (!force.isZero(0)) c.draft.static_loads.push_back({name, load(force, false), s.place()});
    if (!moment.isZero(0))
        c.draft.static_loads.push_back(
            {c.load_names.take(name + ".moment"), load(moment, true), s.place()});
}

// A scene has no branch for a force between two parts that changes with time. If all its values lie
// between the first and the last, it is held at the last, with a warning. Returns the reason if
// that is not possible; else empty.
std::string held_at_its_end(Conversion& c, const Statement& s, const Programme& programme,
                            Value& value) {
    if (!programme.varies()) return {};
    const double first = programme.path.front(), last = programme.path.back();
    const double round_off = 1e-12 * (programme.most - programme.least);
    const bool goes_one_way = std::min(first, last) <= programme.least + round_off &&
                              std::max(first, last) >= programme.most - round_off;
    if (!goes_one_way || !value.is_constant())
        return fmt::format(
            "a force between two parts that changes with time, {:g} to {:g}, which a scene cannot "
            "represent",
            programme.least, programme.most);
    c.warn(s, fmt::format("a force between two parts that changes from {:g} to {:g} over "
                          "{:g} of time; the scene has its final value",
                          first, last, c.times.back()));
    value.constant = last;
    return {};
}

void convert_sforce(Conversion& c, const Statement& s) {
    const Arguments at(c.data.file, s, sforce_shape());
    const Marker &I = c.marker(at, "I"), &J = c.marker(at, "J");
    const bool rotates = at.has("ROTATIONAL");
    if (!rotates && !at.has("TRANSLATIONAL")) at.fail("neither TRANSLATIONAL nor ROTATIONAL");
    if (at.has("ROUTINE")) return c.miss(s, "its force is a user-written function");
    const std::string* text = at.expression("FUNCTION");
    if (!text) at.fail("FUNCTION is missing");
    const Programme programme = c.programme(*text);
    Value value = programme.first;
    if (!value.is_known()) return c.miss(s, value.unknown);
    if (value.is_constant() && value.constant == 0 && !programme.varies() && !value.of_velocity) {
        c.leave_out(s, "without force at rest");
        return;
    }
    if (at.has("ACTIONONLY")) {
        if (I.floats || c.is_flexible(I) || c.is_ground(I.part))
            return c.leave_out(s, "acting on ground only");
        if (!value.is_constant())
            return c.miss(s, "a force on a single part that depends on displacements");
        if (value.constant == 0 && !programme.varies())
            return c.leave_out(s, "without force at rest");
        const bool follows = J.part == I.part;
        if (!follows && !c.is_ground(J.part))
            return c.miss(s, "a force on a single part along an axis of another moving part");
        c.count("SFORCE");
        return put_load(c, s, I, {{J.pose.A.col(2), rotates, programme}}, follows);
    }
    if (const std::string why = held_at_its_end(c, s, programme, value); !why.empty())
        return c.miss(s, why);
    if (!is_between_two(c, s, I, J, at)) return;
    // Whichever marker is named first: DM is symmetric in the two, AZ changes its sign.
    Value own;
    own.constant = value.constant;
    const int i = I.statement->id, j = J.statement->id;
    const auto kind = rotates ? Measure::Kind::AZ : Measure::Kind::DM;
    const auto sign = [&](const Measure& m) {
        if (m.kind != kind) return 0;
        if (m.i == i && m.j == j) return 1;
        if (m.i == j && m.j == i) return rotates ? -1 : 1;
        return 0;
    };
    const char* const other = "a force that depends on a displacement between other markers";
    for (const auto& [measure, k] : value.linear) {
        if (!sign(measure)) return c.miss(s, other);
        own.linear[{.kind = kind}] += sign(measure) * k;
    }
    for (CurveTerm term : value.curves) {
        if (!sign(term.of)) return c.miss(s, other);
        term.scale *= sign(term.of);
        own.curves.push_back(term);
    }
    if (value.of_velocity && (!own.linear.empty() || !own.curves.empty()))
        c.leave_out(s, "damping", "without effect at rest");
    c.count("SFORCE");
    if (rotates)
        put_torsion(c, s, at, I, J, own);
    else
        put_spring(c, s, I, J, own, value.of_velocity);
}

// Three or six components in the axes of RM, acting at I, and the opposite on the part of JFLOAT.
void convert_vector(Conversion& c, const Statement& s) {
    const Arguments at(c.data.file, s, vector_shape());
    const auto miss = [&](const std::string& why) { c.miss(s, why); };
    if (at.has("FUNCTION") || at.has("ROUTINE"))
        return miss("its force is a user-written function");
    const Marker &I = c.marker(at, "I"), &floating = c.marker(at, "JFLOAT");
    if (!at.has("RM")) return miss("the axes of the force are unknown without RM");
    const Marker& RM = c.marker(at, "RM");
    if (RM.floats || I.floats) at.fail("I and RM must not be floating markers");
    if (c.is_flexible(I) || c.is_flexible(RM) || c.is_flexible(floating))
        return miss("it is on a flexible body, which a scene does not have");
    const Units& units = c.geometry.units;
    std::array<Value, 6> component;
    std::array<Programme, 6> programmes;
    bool is_constant = true, is_zero = true, damps = false;
    const char* const names[] = {"FX", "FY", "FZ", "TX", "TY", "TZ"};
    for (std::size_t k = 0; k < 6; ++k) {
        const std::string* text = at.expression(names[k]);
        if (!text) continue;
        programmes[k] = c.programme(*text);
        component[k] = programmes[k].first;
        if (!component[k].is_known())
            return miss(fmt::format("{}: {}", names[k], component[k].unknown));
        is_constant &= component[k].is_constant();
        is_zero &=
            component[k].is_constant() && component[k].constant == 0 && !programmes[k].varies();
        damps |= component[k].of_velocity;
    }
    if (is_zero) return c.leave_out(s, "without force at rest");
    if (I.part == floating.part) return c.leave_out(s, "since both ends are on one part");
    SixLaws laws;
    Vector6 F;
    const bool on_ground = c.is_ground(floating.part);
    if (is_constant && (on_ground || c.is_ground(I.part)) &&
        (c.is_ground(RM.part) || RM.part == I.part || RM.part == floating.part)) {
        // On one moving part: a dead or a follower load.
        const bool turns = !c.is_ground(RM.part);
        if (!on_ground) return miss("a constant force on a part at a marker of ground");
        c.count(s.keyword);
        std::vector<LoadComponent> components;
        for (std::size_t k = 0; k < 6; ++k)
            if (!programmes[k].path.empty())
                components.push_back(
                    {RM.pose.A.col(static_cast<int>(k % 3)), k >= 3, programmes[k]});
        return put_load(c, s, I, components, turns);
    }
    for (std::size_t k = 0; k < 6; ++k) {
        if (const std::string why = held_at_its_end(c, s, programmes[k], component[k]);
            !why.empty())
            return miss(fmt::format("{}: {}", names[k], why));
        F[static_cast<int>(k)] = component[k].constant;
    }
    F = wrench_in_scene_units(F, units);
    if (RM.part != floating.part)
        return miss(
            "a force between two parts in axes other than those of the part with the reaction");
    // Displacements of I from one marker on the other part, in the axes of RM, and angles about
    // axes of RM.
    const Marker* from = nullptr;
    const auto axis_of = [&](const Measure& m, double& sign) -> int {
        const auto at_rm = [&](int id) {
            const Marker& other = c.marker(at, id);
            return other.part == RM.part && (other.pose.A - RM.pose.A).norm() <= 1e-9;
        };
        const int k = static_cast<int>(m.kind) - static_cast<int>(Measure::Kind::DX);
        if (k < 0 || m.j == 0) return -1;
        const bool straight = m.i == I.statement->id, reversed = m.j == I.statement->id;
        const int other = straight ? m.j : m.i;
        if (straight == reversed || c.marker(at, other).part != RM.part) return -1;
        sign = straight ? 1 : -1;
        if (k >= 3) return straight && at_rm(other) ? k : -1;
        if (m.rm == 0 || !at_rm(m.rm)) return -1;
        const Marker& origin = c.marker(at, other);
        if (from && (from->pose.r - origin.pose.r).norm() > 1e-12 * c.geometry.size) return -1;
        from = &origin;
        return k;
    };
    const char* const other =
        "a force that depends on a displacement other than that of its own marker in the axes of "
        "the force";
    Matrix6 K = Matrix6::Zero();
    std::array<Value, 6> own;
    for (std::size_t r = 0; r < 6; ++r) {
        double sign = 1;
        for (const auto& [measure, k] : component[r].linear) {
            const int axis = axis_of(measure, sign);
            if (axis < 0) return miss(fmt::format("{}: {}", names[r], other));
            K(static_cast<int>(r), axis) += -sign * k;
        }
        for (CurveTerm term : component[r].curves) {
            if (axis_of(term.of, sign) != static_cast<int>(r))
                return miss(fmt::format("{}: {}", names[r], other));
            if (term.kind == CurveTerm::Kind::impact)
                return miss(fmt::format("{}: a contact in one direction of a vector", names[r]));
            term.scale *= sign;
            own[r].curves.push_back(term);
        }
    }
    const Matrix6 written = in_scene_units(K, units);
    laws.K = written;
    if (const std::string why = fault(laws.K); !why.empty()) return miss(why);
    warn_of_asymmetry(c, s, written, laws.K);
    laws.preload = F;
    for (std::size_t r = 0; r < 6; ++r) {
        if (own[r].curves.empty()) continue;
        const int row = static_cast<int>(r);
        OneLaw law;
        Value value = own[r];
        const double rate = laws.K(row, row);
        const bool angle = r >= 3;
        const std::string why =
            one_law(c, s, value, -1, 1, angle ? 1 : units.length,
                    angle ? units.force * units.length : units.force, angle, law);
        if (!why.empty()) return miss(fmt::format("{}: {}", names[r], why));
        for (auto& [x, f] : law.curve) f += rate * x;
        laws.K(row, row) = 0;
        if (!laws.K.row(row).isZero(0))
            return miss(
                fmt::format("{}: a spline in combination with a coupled stiffness", names[r]));
        laws.curves[r] = law.curve;
        laws.goes_on[r] = law.goes_on;
    }
    const bool has_curves =
        std::ranges::any_of(laws.curves, [](const auto& curve) { return !curve.empty(); });
    if (has_curves && !(laws.K - Matrix6(laws.K.diagonal().asDiagonal())).isZero(0))
        return miss("a spline in combination with a coupled stiffness");
    if (damps) c.leave_out(s, "damping", "without effect at rest");
    c.count(s.keyword);
    Element{c, s, at, I, floating.part, {from ? from->pose.r : I.pose.r, RM.pose.A}}.put(laws);
}

}  // namespace

const Shape& sforce_shape() {
    static const Shape shape{
        {"TRANSLATIONAL", "ROTATIONAL", "ACTIONONLY"}, {"I", "J", "ROUTINE"}, {"FUNCTION"}};
    return shape;
}
const Shape& vector_shape() {
    static const Shape shape{
        {}, {"I", "JFLOAT", "RM", "ROUTINE"}, {"FX", "FY", "FZ", "TX", "TY", "TZ", "FUNCTION"}};
    return shape;
}

void read_splines(Conversion& c) {
    static const Shape shape{
        {"LINEAR_EXTRAPOLATE"}, {"X", "Y", "Z", "FILE", "BLOCK", "CHANNEL"}, {}};
    for (const Statement& s : c.data.statements) {
        if (s.keyword != "SPLINE") continue;
        const Arguments at(c.data.file, s, shape);
        if (at.has("FILE") || at.has("Z")) {  // reported as missing by the statements that use it
            c.leave_out(s, "with points in another file, or of two variables");
            continue;
        }
        Table table{.x = at.numbers("X", 2, 10'000),
                    .y = at.numbers("Y", 2, 10'000),
                    .goes_on = at.has("LINEAR_EXTRAPOLATE"),
                    .statement = &s};
        if (table.x.empty() || table.x.size() != table.y.size())
            at.fail(fmt::format("{} X and {} Y; their numbers must be equal", table.x.size(),
                                table.y.size()));
        for (std::size_t n = 1; n < table.x.size(); ++n)
            if (!(table.x[n] > table.x[n - 1]))
                at.fail(fmt::format("X: {:g} is not larger than the value before", table.x[n]));
        if (!c.splines.emplace(s.id, table).second) at.fail("duplicate id");
        c.count("SPLINE");
    }
}

void convert_forces(Conversion& c) {
    for (const Statement& s : c.data.statements) {
        if (s.keyword == "BUSHING") convert_bushing(c, s);
        if (s.keyword == "FIELD") convert_field(c, s);
        if (s.keyword == "BEAM") convert_beam(c, s);
        if (s.keyword == "SPRINGDAMPER") convert_springdamper(c, s);
        if (s.keyword == "SFORCE") convert_sforce(c, s);
        if (s.keyword == "VFORCE" || s.keyword == "VTORQUE" || s.keyword == "GFORCE")
            convert_vector(c, s);
    }
}

}  // namespace elastocheck::importer::adm
