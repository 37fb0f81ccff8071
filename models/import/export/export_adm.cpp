// Writes the ADAMS statements of a scene: the inverse of adm/joints.cpp and adm/forces.cpp.
#include "models/import/export/export_adm.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "elastocheck/read_scene.hpp"
#include "models/import/curves.hpp"
#include "models/kinds.hpp"
#include "models/laws.hpp"

namespace elastocheck::importer {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double least_mass = 1e-9;    // [kg] ADAMS solves no part without mass
constexpr double at_hardpoint = 1e-9;  // [m]

std::string real(double x) { return fmt::format("{:.17g}", x == 0 ? 0.0 : x); }
std::string list(const Vector3d& v) {
    return fmt::format("{}, {}, {}", real(v.x()), real(v.y()), real(v.z()));
}

// Euler angles 3-1-3: body-fixed about z, the new x, the new z [rad].
Vector3d euler_313(const Matrix3d& A) {
    const double b = std::atan2(std::hypot(A(0, 2), A(1, 2)), A(2, 2));
    if (std::hypot(A(0, 2), A(1, 2)) < 1e-14)  // gimbal lock: a and c rotate about the same axis
        return {std::atan2(A(1, 0), A(0, 0)), A(2, 2) > 0 ? 0 : std::acos(-1.0), 0};
    return {std::atan2(A(0, 2), -A(1, 2)), b, std::atan2(A(2, 0), A(2, 1))};
}

// Axes with z along u.
Matrix3d along(const Vector3d& u) {
    Matrix3d A;
    A.col(2) = u.normalized();
    A.col(0) = A.col(2).unitOrthogonal();
    A.col(1) = Vector3d(A.col(2)).cross(Vector3d(A.col(0)));
    return A;
}
// With x along u and z across u and v.
Matrix3d with_x(const Vector3d& u, const Vector3d& v) {
    Matrix3d A;
    A.col(0) = u.normalized();
    A.col(1) = (v - v.dot(A.col(0)) * A.col(0)).normalized();
    A.col(2) = Vector3d(A.col(0)).cross(Vector3d(A.col(1)));
    return A;
}

// The weight of a body; null if it has none.
const DeadForce* weight_of(const Scene& scene, const std::string& body) {
    const auto load = std::ranges::find(scene.static_loads, "gravity." + body, &Load::name);
    return load == scene.static_loads.end() ? nullptr : std::get_if<DeadForce>(&load->kind);
}

// A scene has weights m g. Of g the file has the size; without one it is the standard's, so that only
// the masses depend on it.
Vector3d gravity_of(const Scene& scene) {
    Vector3d given = Vector3d::Zero(), g = Vector3d::Zero();
    for (const Number& number : scene.numbers)
        for (int k = 0; k < 3; ++k)
            if (number.path == fmt::format("gravity.{}", "xyz"[k])) given[k] = number.value;
    for (const Body& body : scene.bodies)
        if (const DeadForce* weight = weight_of(scene, body.name); weight && !weight->f.isZero(0))
            g = weight->f.normalized() * (given.isZero(0) ? 9.80665 : given.norm());
    return g;
}

class AdmWriter {
  public:
    AdmWriter(const Scene& scene, Exported& result)
        : scene_(scene), result_(result), gravity_(gravity_of(scene)) {}

    void whole() {
        std::string& t = result_.text;
        // A fixed form of title, with unprintable characters replaced.
        std::string title = scene_.name;
        for (char& c : title)
            if (c < 0x20 || c > 0x7E) c = '?';
        t = fmt::format(
            "Exported model name: {}\n!\nUNITS/\n, FORCE = NEWTON\n, MASS = KILOGRAM\n, LENGTH = "
            "METER\n, "
            "TIME = SECOND\n!\n",
            title);
        if (!gravity_.isZero(0))
            t += fmt::format("ACCGRAV/\n, IGRAV = {}\n, JGRAV = {}\n, KGRAV = {}\n!\n",
                             real(gravity_.x()), real(gravity_.y()), real(gravity_.z()));
        called("ground");
        t += "PART/1\n, GROUND\n!\n";
        for (std::size_t b = 0; b < scene_.bodies.size(); ++b) part(static_cast<BodyId>(b));
        for (const Joint& joint : scene_.joints) write(joint);
        for (const Elastic& elastic : scene_.elastics) write(elastic);
        for (const Load& load : scene_.static_loads)
            if (!is_weight(load)) write(load);
        for (const Wheel& wheel : scene_.wheels) {
            const std::string axis = wheel.name.empty() ? "wheel_axis" : "wheel_axis_" + wheel.name;
            marker(wheel.body, wheel.centre_local, along(wheel.spin_axis_local), axis);
            result_.notes.leave_out(
                "without a statement",
                {0, fmt::format("wheel {} (import --wheel {}, the marker at its centre)",
                                wheel.name, axis)});
        }
        for (const Branch& branch : scene_.branches)
            result_.notes.leave_out("without a statement", {0, "branch '" + branch.name + "'"});
        for (const Damper& damper : scene_.dampers)
            result_.notes.leave_out("exerting nothing", {0, "damper '" + damper.name + "'"});
        for (const auto& line : described(result_.notes)) t += fmt::format("! {}\n", line);
        t += "END\n";
    }

  private:
    void called(const std::string& name) {
        result_.text += fmt::format("! adams_view_name='{}'\n", name);
    }
    static int id_of(BodyId body) { return body + 2; }  // ground is 1
    void miss(const std::string& what, const std::string& why) {
        result_.notes.miss({0, what}, why);
    }

    // Weights are written as ACCGRAV and masses of the parts.
    bool is_weight(const Load& load) const {
        return std::ranges::any_of(
            scene_.bodies, [&](const Body& body) { return load.name == "gravity." + body.name; });
    }
    void part(BodyId body) {
        const auto& [name, pose] = scene_.bodies[static_cast<std::size_t>(body)];
        const DeadForce* weight = weight_of(scene_, name);
        const double mass = weight && !weight->f.isZero(0) ? weight->f.norm() / gravity_.norm() : 0;
        const Vector3d cm = weight ? Vector3d(weight->at.s_local) : Vector3d(Vector3d::Zero());
        called(name);
        result_.text += fmt::format("PART/{}\n, MASS = {}\n, CM = {}\n, QG = {}\n", id_of(body),
                                    real(std::max(mass, least_mass)), next_marker_, list(pose.r));
        marker(body, cm, Matrix3d::Identity(), name + ".cm");
    }

    // With the name of the hardpoint at its place, else the given one.
    int marker(BodyId body, const Vector3d& s, const Matrix3d& A = Matrix3d::Identity(),
               std::string name = {}) {
        const int id = next_marker_++;
        const Vector3d at =
            s + (body == ground ? Vector3d(Vector3d::Zero())
                                : Vector3d(scene_.bodies[static_cast<std::size_t>(body)].design.r));
        const auto hardpoint = std::ranges::find_if(scene_.hardpoints, [&](const Hardpoint& point) {
            return (point.position - at).norm() < at_hardpoint;
        });
        if (hardpoint != scene_.hardpoints.end() && !name.starts_with("wheel_axis"))
            name = hardpoint->name;
        if (!name.empty()) called(name);
        result_.text +=
            fmt::format("MARKER/{}\n, PART = {}\n, QP = {}\n", id, id_of(body), list(s));
        if (!A.isIdentity(0)) result_.text += fmt::format(", REULER = {}\n", list(euler_313(A)));
        return id;
    }
    int floating(BodyId body) {
        const int id = next_marker_++;
        result_.text += fmt::format("MARKER/{}\n, PART = {}\n, FLOATING\n", id, id_of(body));
        return id;
    }

    void statement(const char* keyword, int id, const std::string& name, const std::string& kind,
                   int i, int j) {
        called(name);
        result_.text += fmt::format("{}/{}\n", keyword, id);
        if (!kind.empty()) result_.text += fmt::format(", {}\n", kind);
        result_.text += fmt::format(", I = {}\n, J = {}\n", i, j);
    }

    // ---- Joints. Bodies start parallel to ground: a direction has the same components on both.

    void on_axis(const Joint& joint, const char* kind, const Point& i, const Point& j,
                 const Direction& axis_i, const Direction& axis_j) {
        const int I = marker(i.body, i.s_local, along(axis_i.u_local)),
                  J = marker(j.body, j.s_local, along(axis_j.u_local));
        joints_[joint.name] = next_joint_;
        statement("JOINT", next_joint_++, joint.name, kind, I, J);
    }
    void primitive(const Joint& joint, const char* kind, int I, int J) {
        statement("JPRIM", next_primitive_++, joint.name, kind, I, J);
    }

    // Rate of a joint's drive: the first branch that drives it takes one second; 0 if it is held.
    double rate_of(const Joint& joint) const {
        for (const Branch& branch : scene_.branches)
            for (const Driver& driver : branch.drivers)
                if (const int k = driven_joint(driver.what);
                    k >= 0 && &scene_.joints[static_cast<std::size_t>(k)] == &joint)
                    return driver.rate * branch.to;
        return 0;
    }

    // Writes the drive of an exported joint, "crank.drive". Drives active on some branches only,
    // such as jacks, are left out.
    void drive(const Joint& joint, const char* kind, double offset) {
        if (joint.active_only_where_driven)
            return result_.notes.leave_out("active only where a branch drives it",
                                           {0, "drive '" + joint.name + "'"});
        const auto found = joints_.find(joint.name.substr(0, joint.name.rfind('.')));
        if (found == joints_.end())
            return miss("drive '" + joint.name + "'", "the joint that it drives has no statement");
        called(joint.name);
        const double rate = rate_of(joint);
        result_.text += fmt::format("MOTION/{}\n, {}\n, JOINT = {}\n, FUNCTION = {}{}\n",
                                    next_motion_++, kind, found->second, real(offset),
                                    rate == 0 ? "" : fmt::format(" + {} * TIME", real(rate)));
    }

    void write(const Joint& joint) {
        const auto z = [](const Direction& d) { return along(d.u_local); };
        std::visit(
            overloaded{
                [&](const Spherical& j) {
                    const int I = marker(j.i.body, j.i.s_local), J = marker(j.j.body, j.j.s_local);
                    statement("JOINT", next_joint_++, joint.name, "SPHERICAL", I, J);
                },
                [&](const Revolute& j) {
                    on_axis(joint, "REVOLUTE", j.i, j.j, j.axis_i, j.axis_j);
                },
                [&](const Universal& j) {
                    const int I = marker(j.i.body, j.i.s_local, z(j.axis_i)),
                              J = marker(j.j.body, j.j.s_local, z(j.axis_j));
                    statement("JOINT", next_joint_++, joint.name, "UNIVERSAL", I, J);
                },
                [&](const Cylindrical& j) {
                    on_axis(joint, "CYLINDRICAL", j.i, j.j, j.axis_i, j.axis_j);
                },
                [&](const Translational& j) {
                    on_axis(joint, "TRANSLATIONAL", j.i, j.j, j.axis_i, j.axis_j);
                },
                [&](const Planar& j) {
                    on_axis(joint, "PLANAR", j.i, j.j, j.normal_i, j.normal_j);
                },
                [&](const Fixed& j) {
                    const int I = marker(j.i.body, j.i.s_local,
                                         with_x(j.x_i.u_local, j.y_i.u_local)),
                              J = marker(j.j.body, j.j.s_local,
                                         with_x(j.x_j.u_local, j.y_j.u_local));
                    statement("JOINT", next_joint_++, joint.name, "FIXED", I, J);
                },
                [&](const Distance& j) {
                    if (joint.active_only_where_driven) return drive(joint, "", 0);
                    const int I = marker(j.i.body, j.i.s_local), J = marker(j.j.body, j.j.s_local);
                    called(joint.name);
                    result_.text += fmt::format("GCON/{}\n, FUNCTION = DM({}, {}) - {}\n",
                                                next_gcon_++, I, J, real(j.length));
                },
                [&](const InPlane& j) {
                    const bool is_drive =
                        joint.name.ends_with(".drive") &&
                        joints_.contains(joint.name.substr(0, joint.name.rfind('.')));
                    if (joint.active_only_where_driven || is_drive)
                        return drive(joint, "TRANSLATIONAL", j.offset);
                    const Matrix3d A = z(j.normal_j);
                    const int I = marker(j.i.body, j.i.s_local, A),
                              J = marker(j.j.body, j.j.s_local + j.offset * j.normal_j.u_local, A);
                    primitive(joint, "INPLANE", I, J);
                },
                [&](const InLine& j) {
                    const Matrix3d A = z(j.axis_j);
                    const int I = marker(j.i.body, j.i.s_local, A),
                              J = marker(j.j.body, j.j.s_local, A);
                    primitive(joint, "INLINE", I, J);
                },
                [&](const Perpendicular& j) {
                    const int I = marker(j.i.body, Vector3d::Zero(), z(j.i)),
                              J = marker(j.j.body, Vector3d::Zero(), z(j.j));
                    primitive(joint, "PERPENDICULAR", I, J);
                },
                [&](const Parallel& j) {
                    const int I = marker(j.i.body, Vector3d::Zero(), z(j.i)),
                              J = marker(j.j.body, Vector3d::Zero(), z(j.j));
                    primitive(joint, "PARALLEL_AXES", I, J);
                },
                [&](const Angle& j) { drive(joint, "ROTATIONAL", j.angle); }},
            joint.kind);
    }

    // ---- Elements

    // The table points from which an interpolating curve was made; empty for any other curve.
    static Rows points(const Curve& curve) {
        Rows rows;
        for (std::size_t k = 0; k < curve.knots.size(); ++k)
            rows.emplace_back(curve.knots[k], curve.pieces[k + 1][0]);
        return rows;
    }
    int spline(const Rows& rows, const Curve& law, const std::string& name) {
        std::string x, y;
        for (const auto& [a, b] : rows) {
            x += (x.empty() ? "" : "\n, ") + real(a);
            y += (y.empty() ? "" : "\n, ") + real(b);
        }
        const bool straight = rows.size() > 2 && is_straight(law);
        const Apart apart = off_akima(rows, straight ? Between::straight : Between::monotone);
        if (apart.force > 1e-9 * apart.of)
            result_.notes.warn(
                {0, "element '" + name + "'"},
                fmt::format("ADAMS interpolates its points by Akima's curve, a scene by {}: the "
                            "difference is up to {:.3g} of {:.3g} N or Nm",
                            straight ? "straight lines" : "the monotone interpolant", apart.force,
                            apart.of));
        called(name + ".spline");
        result_.text += fmt::format("SPLINE/{}\n{}, X = {}\n, Y = {}\n", next_spline_,
                                    law.known_outside ? ", LINEAR_EXTRAPOLATE\n" : "", x, y);
        return next_spline_++;
    }

    void write(const Elastic& elastic) {
        if (elastic.active_only_where_driven)
            return result_.notes.leave_out("active only where a branch drives it",
                                           {0, "tyre '" + elastic.name + "'"});
        std::visit([&](const auto& kind) { write(elastic, kind); }, elastic.kind);
    }

    template <class OtherKind>
    void write(const Elastic& elastic, const OtherKind&) {
        miss("element '" + elastic.name + "'", "ADAMS has no element of this kind");
    }
    void write(const Elastic& elastic, const AxialSpring& spring) {
        const Curve* curve = curve_of(spring.law);
        const bool is_contact = curve && (elastic.written_as == WrittenAs::stop ||
                                          curve->pieces.back() == std::array<double, 4>{});
        const int I = marker(spring.i.body, spring.i.s_local),
                  J = marker(spring.j.body, spring.j.s_local);
        if (!curve) {
            statement("SPRINGDAMPER", next_force_++, elastic.name, "TRANSLATIONAL", I, J);
            result_.text +=
                fmt::format(", K = {}\n, LENGTH = {}\n", real(std::get<LinearRate>(spring.law).k),
                            real(spring.free_length));
            return;
        }
        if (is_contact && curve->knots.size() > 1)
            return write_contact(elastic.name, spring, *curve, I, J);
        if (is_contact) {  // one knot: a rate on one side of it, zero force on the other
            const double touches = spring.free_length + curve->knots[0];
            const double below = curve->pieces[0][1], above = curve->pieces[1][1];
            statement("SFORCE", next_sforce_++, elastic.name, "TRANSLATIONAL", I, J);
            if (above == 0)
                result_.text +=
                    fmt::format(", FUNCTION = IMPACT(DM({}, {}), VR({}, {}), {}, {}, 1, 0, 1)\n", I,
                                J, I, J, real(touches), real(below));
            else
                result_.text +=
                    fmt::format(", FUNCTION = -IMPACT(-DM({}, {}), -VR({}, {}), {}, {}, 1, 0, 1)\n",
                                I, J, I, J, real(-touches), real(above));
            return;
        }
        const int points_of = spline(points(*curve), *curve, elastic.name);
        statement("SFORCE", next_sforce_++, elastic.name, "TRANSLATIONAL", I, J);
        result_.text += fmt::format(", FUNCTION = -AKISPL(DM({}, {}) - {}, 0, {})\n", I, J,
                                    real(spring.free_length), points_of);
    }

    // Writes a stop with a table over its penetration, DIM(a, b) = max(a - b, 0).
    void write_contact(const std::string& name, const AxialSpring& spring, const Curve& law, int I,
                       int J) {
        const Contact contact = contact_of(law);
        const double touches = spring.free_length + contact.touches;
        const int points_of = spline(contact.rows, law, name);
        statement("SFORCE", next_sforce_++, name, "TRANSLATIONAL", I, J);
        if (contact.is_bump)
            result_.text += fmt::format(", FUNCTION = AKISPL(DIM({}, DM({}, {})), 0, {})\n",
                                        real(touches), I, J, points_of);
        else
            result_.text += fmt::format(", FUNCTION = -AKISPL(DIM(DM({}, {}), {}), 0, {})\n", I, J,
                                        real(touches), points_of);
    }

    void write(const Elastic& elastic, const Bushing& bushing) {
        // ADAMS uses the axes of marker J, which is marker i of a scene. A bushing with its frame
        // on j is written with its markers swapped.
        const bool is_on_j = bushing.formulation.frame == Formulation::Frame::on_j;
        const Bushing b = is_on_j ? markers_swapped(bushing) : bushing;
        const Matrix3d A_i = b.i.A_local.toRotationMatrix(), A_j = b.j.A_local.toRotationMatrix();
        // One axis through one point: the angle is the same in every formulation.
        const Matrix6* stiffness = matrix_of(b.law);
        if (elastic.written_as == WrittenAs::torsion_spring) {
            const int J = marker(b.i.body, b.i.s_local, A_i),
                      I = marker(b.j.body, b.j.s_local, A_j);
            if (stiffness) {
                statement("SPRINGDAMPER", next_force_++, elastic.name, "ROTATIONAL", I, J);
                result_.text += fmt::format(", KT = {}\n, TORQUE = {}\n", real((*stiffness)(5, 5)),
                                            real(-b.preload[5]));
                return;
            }
            const auto& law = std::get<Curve>(std::get<PerAxis>(b.law).axis[5]);
            const int points_of = spline(points(law), law, elastic.name);
            statement("SFORCE", next_sforce_++, elastic.name, "ROTATIONAL", I, J);
            result_.text += fmt::format(", FUNCTION = {} - AKISPL(AZ({}, {}), 0, {})\n",
                                        real(-b.preload[5]), I, J, points_of);
            return;
        }
        if (!(b.formulation == adams_bushing)) {
            miss("element '" + elastic.name + "'",
                 "its formulation is not ADAMS' ({angles: projected, conjugate: false}), so the "
                 "same rates give another law there; --formulation adams converts it and reports "
                 "the change of the outputs");
            if (!b.formulation.offset_moment) return;
        }
        // δ is measured from J's origin, so that J is placed at the undeformed position. LENGTH
        // holds the undeformed angles.
        const int J = marker(b.i.body, b.i.s_local + A_i * b.undeformed.head<3>(), A_i),
                  I = marker(b.j.body, b.j.s_local, A_j);
        const Vector6 force = -b.preload;
        if (const PerAxis* axes = axes_of(b.law)) {
            if (!b.undeformed.tail<3>().isZero(0))
                return miss("element '" + elastic.name + "'",
                            "curves over angles with a nonzero undeformed position");
            const int float_j = floating(b.i.body);
            constexpr const char* components[] = {"FX", "FY", "FZ", "TX", "TY", "TZ"};
            constexpr const char* measures[] = {"DX", "DY", "DZ", "AX", "AY", "AZ"};
            std::string functions;
            for (std::size_t k = 0; k < 6; ++k) {
                const std::string x = k < 3 ? fmt::format("{}({}, {}, {})", measures[k], I, J, J)
                                            : fmt::format("{}({}, {})", measures[k], I, J);
                const auto at_zero = force[static_cast<Eigen::Index>(k)];
                if (const double* rate = elastocheck::rate_of(axes->axis[k]))
                    functions += fmt::format(", {} = {} - {} * {}\\\n", components[k],
                                             real(at_zero), real(*rate), x);
                else {
                    const auto& curve = std::get<Curve>(axes->axis[k]);
                    functions += fmt::format(
                        ", {} = {} - AKISPL({}, 0, {})\\\n", components[k], real(at_zero), x,
                        spline(points(curve), curve, elastic.name + "." + components[k]));
                }
            }
            called(elastic.name);
            result_.text += fmt::format("GFORCE/{}\n, I = {}\n, JFLOAT = {}\n, RM = {}\n{}",
                                        next_gforce_++, I, float_j, J, functions);
            return;
        }
        const Matrix6& K = *stiffness;
        if (K.isDiagonal(0) && b.undeformed.tail<3>().isZero(0)) {
            statement("BUSHING", next_force_++, elastic.name, "", I, J);
            result_.text += fmt::format(", K = {}\n, KT = {}\n, FORCE = {}\n, TORQUE = {}\n",
                                        list(K.diagonal().head<3>()), list(K.diagonal().tail<3>()),
                                        list(force.head<3>()), list(force.tail<3>()));
            return;
        }
        statement("FIELD", next_force_++, elastic.name, "", I, J);
        result_.text += ", KMATRIX =\n";
        for (int column = 0; column < 6; ++column)
            result_.text += fmt::format(", {}, {}\n", list(K.col(column).head<3>()),
                                        list(K.col(column).tail<3>()));
        result_.text +=
            fmt::format(", LENGTH = 0, 0, 0, {}\n, FORCE = {}, {}\n", list(b.undeformed.tail<3>()),
                        list(force.head<3>()), list(force.tail<3>()));
    }

    // ---- Loads; their reactions act on ground and are not used.

    void load(const std::string& name, BodyId body, const Vector3d& s, const Vector3d& force,
              const Vector3d& moment, bool follows) {
        const int I = marker(body, s), J = floating(ground),
                  RM = follows ? I : marker(ground, Vector3d::Zero());
        called(name);
        result_.text += fmt::format(
            "GFORCE/{}\n, I = {}\n, JFLOAT = {}\n, RM = {}\n, FX = {}\\\n, FY = {}\\\n, FZ = "
            "{}\\\n, TX = "
            "{}\\\n, TY = {}\\\n, TZ = {}\n",
            next_gforce_++, I, J, RM, real(force.x()), real(force.y()), real(force.z()),
            real(moment.x()), real(moment.y()), real(moment.z()));
    }
    void write(const Load& l) {
        const Vector3d none = Vector3d::Zero();
        std::visit(
            overloaded{
                [&](const DeadForce& f) {
                    load(l.name, f.at.body, f.at.s_local, f.f, none, false);
                },
                [&](const DeadMoment& m) { load(l.name, m.body, none, none, m.m, false); },
                [&](const FollowerForce& f) {
                    load(l.name, f.at.body, f.at.s_local, f.f_local, none, true);
                },
                [&](const FollowerMoment& m) { load(l.name, m.body, none, none, m.m_local, true); },
                [&](const BrakeForce&) {
                    result_.notes.miss({0, "load '" + l.name + "'"},
                                       "acts through a point of another body");
                }},
            l.kind);
    }

    const Scene& scene_;
    Exported& result_;
    Vector3d gravity_;  // [m/s²]
    std::map<std::string, int> joints_;
    int next_marker_ = 1, next_joint_ = 1, next_primitive_ = 1, next_gcon_ = 1, next_motion_ = 1,
        next_force_ = 1, next_sforce_ = 1, next_gforce_ = 1, next_spline_ = 1;
};

}  // namespace

Contact contact_of(const Curve& law) {
    Contact contact{
        .is_bump = law.pieces.back() == std::array<double, 4>{}, .touches = 0, .rows = {}};
    const double inward = contact.is_bump ? -1 : 1;
    std::vector<double> knots = law.knots;
    if (contact.is_bump) std::ranges::reverse(knots);
    // the first knot of an open side lies beyond any motion (reader/curves.cpp)
    if (!law.known_outside) knots.erase(knots.begin());
    contact.touches = knots.front();
    for (const double x : knots)
        contact.rows.emplace_back(inward * (x - contact.touches), inward * force(law, x));
    return contact;
}

void require_whole(const Exported& exported, const Scene& scene, bool allow_missing) {
    if (exported.notes.missing.empty() || allow_missing) return;
    std::string message;
    for (const auto& [place, what] : exported.notes.missing)
        message += fmt::format("{}: {}: {}\n", scene.source, place.what, what);
    throw SceneError(message +
                     "--allow-missing exports the rest and lists the missing entries in the file");
}

Exported export_adm(const Scene& scene, bool allow_missing, Notes notes) {
    Exported result{.text = {}, .notes = std::move(notes)};
    AdmWriter(scene, result).whole();
    require_whole(result, scene, allow_missing);
    return result;
}

}  // namespace elastocheck::importer
