// Writes the ADAMS statements of a scene: the inverse of adm/joints.cpp and adm/forces.cpp.
#include "models/import/export/export_adm.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "elastocheck/read_scene.hpp"
#include "models/import/adm/joint_kinds.hpp"
#include "models/import/curves.hpp"
#include "models/kinds.hpp"
#include "models/laws.hpp"

namespace elastocheck::importer {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double min_mass = 1e-9;      // of a part, since ADAMS solves none without mass [kg]
constexpr double at_hardpoint = 1e-9;  // from a hardpoint that names a marker, at most [m]

std::string real(double x) { return fmt::format("{:.17g}", x == 0 ? 0.0 : x); }
std::string list(const Vector3d& v) {
    return fmt::format("{}, {}, {}", real(v.x()), real(v.y()), real(v.z()));
}

// Angles (a, b, c) of A = R_z(a) R_x(b) R_z(c) [rad].
Vector3d euler_313(const Matrix3d& A) {
    const double b = std::atan2(std::hypot(A(0, 2), A(1, 2)), A(2, 2));
    if (std::hypot(A(0, 2), A(1, 2)) < 1e-14)  // b = 0 or π: a and c are about one axis
        return {std::atan2(A(1, 0), A(0, 0)), A(2, 2) > 0 ? 0 : std::acos(-1.0), 0};
    return {std::atan2(A(0, 2), -A(1, 2)), b, std::atan2(A(2, 0), A(2, 1))};
}

// Axes with z along u.
Matrix3d along(const Vector3d& u) {
    const Vector3d z = u.normalized(), x = z.unitOrthogonal();
    Matrix3d A;
    A << x, z.cross(x), z;
    return A;
}
// With x along u and z across u and v.
Matrix3d with_x(const Vector3d& u, const Vector3d& v) {
    const Vector3d x = u.normalized(), y = (v - v.dot(x) * x).normalized();
    Matrix3d A;
    A << x, y, x.cross(y);
    return A;
}

// The weight of a body; null if it has none.
const DeadForce* weight_of(const Scene& scene, const std::string& body) {
    const auto load = std::ranges::find(scene.static_loads, "gravity." + body, &Load::name);
    return load == scene.static_loads.end() ? nullptr : std::get_if<DeadForce>(&load->kind);
}

// A scene has weights m g only, as loads. The direction of g is that of the weights, its size that in the
// scene file; without one, standard gravity, which then determines the masses.
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

    void write_dataset() {
        put("Exported model name: {}\n!\nUNITS/\n, FORCE = NEWTON\n, MASS = KILOGRAM\n, LENGTH = "
            "METER\n, TIME = SECOND\n!\n",
            printable(scene_.name));
        if (!gravity_.isZero(0))
            put("ACCGRAV/\n, IGRAV = {}\n, JGRAV = {}\n, KGRAV = {}\n!\n", real(gravity_.x()),
                real(gravity_.y()), real(gravity_.z()));
        put_name("ground");
        put("PART/1\n, GROUND\n!\n");
        for (std::size_t b = 0; b < scene_.bodies.size(); ++b) part(static_cast<BodyId>(b));
        for (const Joint& joint : scene_.joints) write(joint);
        for (const Elastic& elastic : scene_.elastics) write(elastic);
        for (const Load& load : scene_.static_loads)
            if (!is_weight(load)) write(load);
        for (const Wheel& wheel : scene_.wheels) {
            const std::string axis = wheel.name.empty() ? "wheel_axis" : "wheel_axis_" + wheel.name;
            marker(wheel.body, wheel.centre_local, along(wheel.spin_axis_local), axis);
            leave_out("without a statement",
                      fmt::format("wheel {} (import --wheel {}, the marker at its centre)",
                                  wheel.name, axis));
        }
        leave_out_branches(scene_, "without a statement", result_.notes);
        for (const auto& line : described(result_.notes)) put("! {}\n", line);
        put("END\n");
    }

  private:
    template <class... A>
    void put(fmt::format_string<A...> text, A&&... a) {
        result_.text += fmt::format(text, std::forward<A>(a)...);
    }
    void put_name(const std::string& name) { put("! adams_view_name='{}'\n", name); }
    static int id_of(BodyId body) { return body + 2; }  // ground is 1
    void miss(const std::string& what, const std::string& why) {
        result_.notes.miss({0, what}, why);
    }
    void leave_out(const char* why, const std::string& what) {
        result_.notes.leave_out(why, {0, what});
    }
    // Ids count from 1 in each kind, or group of kinds.
    int next_id(const std::string& kind) { return ++ids_[kind]; }

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
        put_name(name);
        put("PART/{}\n, MASS = {}\n, CM = {}\n, QG = {}\n", id_of(body),
            real(std::max(mass, min_mass)), ids_["MARKER"] + 1, list(pose.r));
        marker(body, cm, Matrix3d::Identity(), name + ".cm");
    }

    // Writes a marker named after the hardpoint at its place, else `name`. Returns its id.
    int marker(BodyId body, const Vector3d& s, const Matrix3d& A = Matrix3d::Identity(),
               std::string name = {}) {
        const int id = next_id("MARKER");
        const Vector3d at =
            s + (body == ground ? Vector3d(Vector3d::Zero())
                                : Vector3d(scene_.bodies[static_cast<std::size_t>(body)].design.r));
        const auto hardpoint = std::ranges::find_if(scene_.hardpoints, [&](const Hardpoint& point) {
            return (point.position - at).norm() < at_hardpoint;
        });
        if (hardpoint != scene_.hardpoints.end() && !name.starts_with("wheel_axis"))
            name = hardpoint->name;
        if (!name.empty()) put_name(name);
        put("MARKER/{}\n, PART = {}\n, QP = {}\n", id, id_of(body), list(s));
        if (!A.isIdentity(0)) put(", REULER = {}\n", list(euler_313(A)));
        return id;
    }
    int floating(BodyId body) {
        const int id = next_id("MARKER");
        put("MARKER/{}\n, PART = {}\n, FLOATING\n", id, id_of(body));
        return id;
    }

    void statement(std::string_view keyword, int id, const std::string& name, std::string_view type,
                   int i, int j) {
        put_name(name);
        put("{}/{}\n", keyword, id);
        if (!type.empty()) put(", {}\n", type);
        put(", I = {}\n, J = {}\n", i, j);
    }
    // Springs and bushings are counted together.
    void elastic_statement(const char* keyword, const std::string& name, const char* type, int i,
                           int j) {
        statement(keyword, next_id("SPRINGDAMPER"), name, type, i, j);
    }
    void force_statement(const std::string& name, const char* type, int i, int j) {
        statement("SFORCE", next_id("SFORCE"), name, type, i, j);
    }

    // ---- Joints. Bodies start parallel to ground: a direction has the same components on both.

    // A joint of two markers. z of each is along the joint's direction on its body, or, with one direction,
    // along that; with two directions on each body they are x and y.
    template <class K>
    void write_pair(const Joint& joint, const K& kind) {
        std::vector<Point> points;
        std::vector<Direction> axes;
        each_member(kind, overloaded{[&](const Point& p) { points.push_back(p); },
                                     [&](const Direction& d) { axes.push_back(d); }});
        if (points.empty())
            for (const Direction& d : axes) points.push_back({d.body, Vector3d::Zero()});
        if constexpr (std::is_same_v<K, InPlane>)
            points[1].s_local += kind.offset * kind.normal_j.u_local;
        int ids[2];
        for (const std::size_t end : {0, 1}) {
            Matrix3d A = Matrix3d::Identity();
            if (axes.size() == 4)
                A = with_x(axes[2 * end].u_local, axes[2 * end + 1].u_local);
            else if (!axes.empty())
                A = along(axes[axes.size() == 2 ? end : 0].u_local);
            ids[end] = marker(points[end].body, points[end].s_local, A);
        }
        using KindOf = elastocheck::Kind<K>;
        const auto& equivalent =
            *std::ranges::find(adm::joints_of_adams, KindOf::name, &adm::JointOfAdams::type);
        const int id = next_id(std::string(equivalent.keyword));
        if (KindOf::drive != JointDrive::none) joints_[joint.name] = id;
        statement(equivalent.keyword, id, joint.name, equivalent.flag, ids[0], ids[1]);
    }

    // Rate of a joint's drive, such that the first branch that drives it takes one second; 0 if it is held.
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
            return leave_out("active only where a branch drives it", "drive '" + joint.name + "'");
        const auto found = joints_.find(driven_by(joint));
        if (found == joints_.end())
            return miss("drive '" + joint.name + "'", "the joint that it drives has no statement");
        put_name(joint.name);
        const double rate = rate_of(joint);
        put("MOTION/{}\n, {}\n, JOINT = {}\n, FUNCTION = {}{}\n", next_id("MOTION"), kind,
            found->second, real(offset), rate == 0 ? "" : fmt::format(" + {} * TIME", real(rate)));
    }
    static std::string driven_by(const Joint& drive) {
        return drive.name.substr(0, drive.name.rfind('.'));
    }

    void write(const Joint& joint) {
        std::visit(overloaded{[&](const Angle& j) { drive(joint, "ROTATIONAL", j.angle); },
                              [&](const Distance& j) {
                                  if (joint.active_only_where_driven) return drive(joint, "", 0);
                                  const int I = marker(j.i.body, j.i.s_local),
                                            J = marker(j.j.body, j.j.s_local);
                                  put_name(joint.name);
                                  put("GCON/{}\n, FUNCTION = DM({}, {}) - {}\n", next_id("GCON"), I,
                                      J, real(j.length));
                              },
                              [&](const InPlane& j) {
                                  const bool is_drive = joint.name.ends_with(".drive") &&
                                                        joints_.contains(driven_by(joint));
                                  if (joint.active_only_where_driven || is_drive)
                                      return drive(joint, "TRANSLATIONAL", j.offset);
                                  write_pair(joint, j);
                              },
                              [&](const auto& j) { write_pair(joint, j); }},
                   joint.kind);
    }

    // ---- Elements

    // Knots and forces of a curve, the points of its table.
    static Rows points(const Curve& curve) {
        Rows rows;
        for (std::size_t k = 0; k < curve.knots.size(); ++k)
            rows.emplace_back(curve.knots[k], curve.pieces[k + 1][0]);
        return rows;
    }
    // Writes a SPLINE and returns its id; warns where ADAMS' interpolant deviates from the scene's.
    int spline(const Rows& rows, const Curve& law, const std::string& name) {
        std::string x, y;
        for (const auto& [a, b] : rows) {
            x += (x.empty() ? "" : "\n, ") + real(a);
            y += (y.empty() ? "" : "\n, ") + real(b);
        }
        const bool straight = rows.size() > 2 && is_straight(law);
        const InterpolantDeviation deviation =
            deviation_from_akima(rows, straight ? Interpolation::linear : Interpolation::monotone);
        if (deviation.force > 1e-9 * deviation.largest_force)
            result_.notes.warn(
                {0, "element '" + name + "'"},
                fmt::format("ADAMS interpolates its points by Akima's curve, a scene by {}: the "
                            "difference is up to {:.3g} of {:.3g} N or Nm",
                            straight ? "straight lines" : "the monotone interpolant",
                            deviation.force, deviation.largest_force));
        put_name(name + ".spline");
        const int id = next_id("SPLINE");
        put("SPLINE/{}\n{}, X = {}\n, Y = {}\n", id,
            law.known_outside ? ", LINEAR_EXTRAPOLATE\n" : "", x, y);
        return id;
    }

    void write(const Elastic& elastic) {
        if (elastic.active_only_where_driven)
            return leave_out("active only where a branch drives it", "tyre '" + elastic.name + "'");
        std::visit([&](const auto& kind) { write(elastic, kind); }, elastic.kind);
    }

    template <class OtherKind>
    void write(const Elastic& elastic, const OtherKind&) {
        miss("element '" + elastic.name + "'", "ADAMS has no element of this kind");
    }
    void write(const Elastic& elastic, const AxialSpring& spring) {
        const Curve* curve = curve_of(spring.law);
        // a stop, or a spring with loose seats, which has no force behind its last knot
        const bool is_contact = curve && (elastic.written_as == WrittenAs::stop ||
                                          curve->pieces.back() == std::array<double, 4>{});
        const int I = marker(spring.i.body, spring.i.s_local),
                  J = marker(spring.j.body, spring.j.s_local);
        if (!curve) {
            elastic_statement("SPRINGDAMPER", elastic.name, "TRANSLATIONAL", I, J);
            put(", K = {}\n, LENGTH = {}\n", real(std::get<LinearRate>(spring.law).k),
                real(spring.free_length));
            return;
        }
        if (is_contact && curve->knots.size() > 1)
            return write_contact(elastic.name, spring, *curve, I, J);
        if (is_contact) {  // one knot: a rate on one side of it, zero force on the other
            const double touches = spring.free_length + curve->knots[0];
            const double below = curve->pieces[0][1], above = curve->pieces[1][1];
            const bool is_bump = above == 0;
            const char* const minus = is_bump ? "" : "-";
            force_statement(elastic.name, "TRANSLATIONAL", I, J);
            put(", FUNCTION = {0}IMPACT({0}DM({1}, {2}), {0}VR({1}, {2}), {3}, {4}, 1, 0, 1)\n",
                minus, I, J, real(is_bump ? touches : -touches), real(is_bump ? below : above));
            return;
        }
        const int spline_id = spline(points(*curve), *curve, elastic.name);
        force_statement(elastic.name, "TRANSLATIONAL", I, J);
        put(", FUNCTION = -AKISPL(DM({}, {}) - {}, 0, {})\n", I, J, real(spring.free_length),
            spline_id);
    }

    // Writes a stop with a table over its penetration, DIM(a, b) = max(a - b, 0).
    void write_contact(const std::string& name, const AxialSpring& spring, const Curve& law, int I,
                       int J) {
        const Contact contact = contact_of(law);
        const std::string touches = real(spring.free_length + contact.touches),
                          length = fmt::format("DM({}, {})", I, J);
        const int spline_id = spline(contact.rows, law, name);
        force_statement(name, "TRANSLATIONAL", I, J);
        put(", FUNCTION = {}AKISPL(DIM({}, {}), 0, {})\n", contact.is_bump ? "" : "-",
            contact.is_bump ? touches : length, contact.is_bump ? length : touches, spline_id);
    }

    // A torsion spring; its angle about its one axis is the same in every formulation.
    void write_torsion(const std::string& name, const Bushing& b, const Matrix6* stiffness, int I,
                       int J) {
        if (stiffness) {
            elastic_statement("SPRINGDAMPER", name, "ROTATIONAL", I, J);
            put(", KT = {}\n, TORQUE = {}\n", real((*stiffness)(5, 5)), real(-b.preload[5]));
            return;
        }
        const auto& law = std::get<Curve>(std::get<PerAxis>(b.law).axis[5]);
        const int spline_id = spline(points(law), law, name);
        force_statement(name, "ROTATIONAL", I, J);
        put(", FUNCTION = {} - AKISPL(AZ({}, {}), 0, {})\n", real(-b.preload[5]), I, J, spline_id);
    }

    // A rate or a curve along each axis.
    void write_per_axis(const std::string& name, const PerAxis& axes, const Bushing& b, int I,
                        int J) {
        if (!b.undeformed.tail<3>().isZero(0))
            return miss("element '" + name + "'",
                        "curves over angles with a nonzero undeformed position");
        const int float_j = floating(b.i.body);
        constexpr const char* components[] = {"FX", "FY", "FZ", "TX", "TY", "TZ"};
        constexpr const char* measures[] = {"DX", "DY", "DZ", "AX", "AY", "AZ"};
        std::string functions;
        for (std::size_t k = 0; k < 6; ++k) {
            const std::string x = k < 3 ? fmt::format("{}({}, {}, {})", measures[k], I, J, J)
                                        : fmt::format("{}({}, {})", measures[k], I, J),
                              at_zero = real(-b.preload[static_cast<Eigen::Index>(k)]);
            std::string law;
            if (const double* rate = elastocheck::rate_of(axes.axis[k])) {
                law = fmt::format("{} * {}", real(*rate), x);
            } else {
                const auto& curve = std::get<Curve>(axes.axis[k]);
                law = fmt::format("AKISPL({}, 0, {})", x,
                                  spline(points(curve), curve, name + "." + components[k]));
            }
            functions += fmt::format(", {} = {} - {}\\\n", components[k], at_zero, law);
        }
        put_name(name);
        put("GFORCE/{}\n, I = {}\n, JFLOAT = {}\n, RM = {}\n{}", next_id("GFORCE"), I, float_j, J,
            functions);
    }

    void write(const Elastic& elastic, const Bushing& bushing) {
        // ADAMS uses the axes of marker J, which is marker i of a scene. A bushing with its frame
        // on j is written with its markers swapped.
        const bool is_on_j = bushing.formulation.frame == Formulation::Frame::on_j;
        const Bushing b = is_on_j ? markers_swapped(bushing) : bushing;
        const Matrix3d A_i = b.i.A_local.toRotationMatrix(), A_j = b.j.A_local.toRotationMatrix();
        const Matrix6* stiffness = matrix_of(b.law);
        if (elastic.written_as == WrittenAs::torsion_spring) {
            const int J = marker(b.i.body, b.i.s_local, A_i),
                      I = marker(b.j.body, b.j.s_local, A_j);
            return write_torsion(elastic.name, b, stiffness, I, J);
        }
        if (!(b.formulation == adams_bushing)) {
            miss("element '" + elastic.name + "'",
                 "its formulation is not ADAMS' ({angles: projected, conjugate: false}), so the "
                 "same rates give another law there; --formulation adams converts it and reports "
                 "the change of the outputs");
            if (!b.formulation.offset_moment) return;
        }
        // ADAMS measures the displacement from J's origin: J is placed at the undeformed position. LENGTH
        // of a FIELD has the undeformed angles.
        const int J = marker(b.i.body, b.i.s_local + A_i * b.undeformed.head<3>(), A_i),
                  I = marker(b.j.body, b.j.s_local, A_j);
        if (const PerAxis* axes = axes_of(b.law))
            return write_per_axis(elastic.name, *axes, b, I, J);
        const Vector6 force = -b.preload;
        const Matrix6& K = *stiffness;
        const Vector6 rates = K.diagonal();
        const std::string force_text = list(force.head<3>()), torque_text = list(force.tail<3>());
        if (K.isDiagonal(0) && b.undeformed.tail<3>().isZero(0)) {
            elastic_statement("BUSHING", elastic.name, "", I, J);
            put(", K = {}\n, KT = {}\n, FORCE = {}\n, TORQUE = {}\n", list(rates.head<3>()),
                list(rates.tail<3>()), force_text, torque_text);
            return;
        }
        elastic_statement("FIELD", elastic.name, "", I, J);
        put(", KMATRIX =\n");
        for (int column = 0; column < 6; ++column)
            put(", {}, {}\n", list(K.col(column).head<3>()), list(K.col(column).tail<3>()));
        put(", LENGTH = 0, 0, 0, {}\n, FORCE = {}, {}\n", list(b.undeformed.tail<3>()), force_text,
            torque_text);
    }

    // ---- Loads; their reactions act on ground and are not used.

    void write(const Load& load) {
        if (std::holds_alternative<BrakeForce>(load.kind))
            return miss("load '" + load.name + "'", "acts through a point of another body");
        Vector3d at = Vector3d::Zero(), force = Vector3d::Zero(), moment = Vector3d::Zero();
        each_member(load.kind, [&](const Point& point) { at = point.s_local; });
        (is_moment(load.kind) ? moment : force) = load_vector(load.kind);
        const int I = marker(body_of(load.kind), at), J = floating(ground),
                  RM = is_follower(load.kind) ? I : marker(ground, Vector3d::Zero());
        put_name(load.name);
        put("GFORCE/{}\n, I = {}\n, JFLOAT = {}\n, RM = {}\n", next_id("GFORCE"), I, J, RM);
        put(", FX = {}\\\n, FY = {}\\\n, FZ = {}\\\n", real(force.x()), real(force.y()),
            real(force.z()));
        put(", TX = {}\\\n, TY = {}\\\n, TZ = {}\n", real(moment.x()), real(moment.y()),
            real(moment.z()));
    }

    const Scene& scene_;
    Exported& result_;
    Vector3d gravity_;                   // [m/s²]
    std::map<std::string, int> joints_;  // ids of those that may be driven
    std::map<std::string, int> ids_;     // the last of each kind
};

}  // namespace

Contact contact_of(const Curve& law) {
    Contact contact{
        .is_bump = law.pieces.back() == std::array<double, 4>{}, .touches = 0, .rows = {}};
    const double inward = contact.is_bump ? -1 : 1;
    std::vector<double> knots = law.knots;
    if (contact.is_bump) std::ranges::reverse(knots);
    // with `outside: unknown` the first knot lies beyond any motion (models/reader/tables/curves.cpp)
    if (!law.known_outside) knots.erase(knots.begin());
    contact.touches = knots.front();
    for (const double x : knots)
        contact.rows.emplace_back(inward * (x - contact.touches), inward * force(law, x));
    return contact;
}

void leave_out_branches(const Scene& scene, const char* why, Notes& notes) {
    for (const Branch& branch : scene.branches)
        notes.leave_out(why, {0, "branch '" + branch.name + "'"});
    for (const Damper& damper : scene.dampers)
        notes.leave_out("exerting nothing", {0, "damper '" + damper.name + "'"});
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
    AdmWriter(scene, result).write_dataset();
    require_whole(result, scene, allow_missing);
    return result;
}

}  // namespace elastocheck::importer
