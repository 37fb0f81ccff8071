#include "models/reader/definitions/beams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "models/near.hpp"
#include "models/reader/definitions/look_up.hpp"
#include "models/reader/document/limits.hpp"

namespace elastocheck::reader {
namespace {

using std::pow;

constexpr double parallel = 1e-6;  // sine of the angle below which directions count as parallel

// ---- Path of the beam.

struct Course {
    std::vector<std::string> hardpoints;  // on the path
    std::vector<Vector3> nodes;           // from end to end [m]
    std::vector<std::size_t> corners;     // positions in `nodes` of the hardpoints
    BodyId first = ground, last = ground;

    std::size_t segments() const { return nodes.size() - 1; }
};

// Segments of each leg: one each, and further ones where segments are longest. Among equal legs the
// first is served first, then the last, and so inwards, which keeps a symmetric beam symmetric
// where possible.
std::vector<int> shared_out(int segments, const std::vector<double>& lengths) {
    const std::size_t legs = lengths.size();
    std::vector<std::size_t> inwards;
    for (std::size_t k = 0; k < legs; ++k) inwards.push_back(k % 2 == 0 ? k / 2 : legs - 1 - k / 2);
    std::vector<int> share(legs, 1);
    for (int left = segments - static_cast<int>(legs); left > 0; --left) {
        std::size_t longest = inwards.front();
        for (const std::size_t k : inwards)
            if (lengths[k] / share[k] > (1 + 1e-9) * lengths[longest] / share[longest]) longest = k;
        ++share[longest];
    }
    return share;
}

Course read_course(const Cursor& field, const Definitions& defs) {
    Course course;
    const auto ends = field.require("bodies").list(2, "bodies");
    course.first = body(ends[0], defs);
    course.last = body(ends[1], defs);

    const Cursor through = field.require("through");
    const auto points = through.items();
    if (!through.is_list() || points.size() < 2)
        through.fail(
            fmt::format("expected a list of two hardpoints or more, found {}", through.found()));
    std::vector<Vector3> places;
    std::vector<double> lengths;
    for (const Cursor& point : points) {
        places.push_back(hardpoint(point, defs));
        course.hardpoints.push_back(point.value->text);
        if (places.size() == 1) continue;
        lengths.push_back((places.back() - places[places.size() - 2]).norm());
        if (!(lengths.back() > coincident))
            point.fail(
                fmt::format("{} coincides with the hardpoint before it; each straight part of a "
                            "beam needs a length",
                            point.found()));
    }

    const int legs = static_cast<int>(lengths.size());
    const Cursor segments = field.require("segments");
    const int n = segments.whole_number(1, max_segments);
    if (n < legs)
        segments.fail(
            fmt::format("{} segments for {} straight parts; allowed: at least one per part",
                        segments.found(), legs));
    if (n == 1 && course.first == course.last)
        ends[1].fail(
            fmt::format("both ends are on {}; a beam of one segment needs two different bodies",
                        ends[1].found()));
    const auto share = shared_out(n, lengths);
    course.nodes.push_back(places[0]);
    course.corners.push_back(0);
    for (std::size_t leg = 0; leg < share.size(); ++leg) {
        for (int k = 1; k < share[leg]; ++k)
            course.nodes.emplace_back(places[leg] +
                                      (places[leg + 1] - places[leg]) * (double(k) / share[leg]));
        course.corners.push_back(course.nodes.size());
        course.nodes.push_back(places[leg + 1]);
    }
    return course;
}

// Whether the points in reverse order are their own mirror image.
bool is_own_image(const std::vector<Vector3>& points) {
    for (std::size_t k = 0; k < points.size(); ++k)
        if (!are_near(reflected(points[k]), points[points.size() - 1 - k], coincident))
            return false;
    return true;
}

// Whether both sides share the beam and its first half is the mirror image of its second.
bool is_shared_evenly(const Cursor& field, const Course& course, const Definitions& defs) {
    const BodyId image =
        course.first == ground ? ground : defs.twin_of[static_cast<std::size_t>(course.first)];
    if (image != course.last) return false;
    std::vector<Vector3> corners;
    for (const std::size_t k : course.corners) corners.push_back(course.nodes[k]);
    if (!is_own_image(corners)) return false;
    if (!is_own_image(course.nodes)) {
        const Cursor segments = field.require("segments");
        segments.fail(fmt::format(
            "{} segments cannot be divided equally between the two sides; one more or one less can",
            segments.found()));
    }
    return true;
}

// ---- Bodies at the nodes.

std::string numbered(const std::string& name, std::size_t k) {
    return fmt::format("{}.{}", name, k);
}

// Adds the bodies 1, 2, ... of the beam `name` at its inner nodes, with all their names.
void add_bodies(const Cursor& field, const std::string& name, const Course& course,
                Definitions& defs) {
    const auto id = [&](std::size_t node) {
        return static_cast<BodyId>(defs.bodies.size() + node - 1);
    };
    for (std::size_t k = 1; k < course.segments(); ++k)
        if (!defs.body_ids.emplace(numbered(name, k), id(k)).second)
            field.fail(
                fmt::format("the body name {} is reserved for a node of this beam, but already in "
                            "use; rename the other body",
                            quote(numbered(name, k))));
    for (std::size_t corner = 1; corner + 1 < course.corners.size(); ++corner)
        defs.body_ids.emplace(name + "." + course.hardpoints[corner], id(course.corners[corner]));
    for (std::size_t k = 1; k < course.segments(); ++k) {
        defs.twin_of.push_back(static_cast<BodyId>(defs.bodies.size()));
        defs.bodies.push_back(
            {numbered(name, k), {.r = course.nodes[k], .p = Quaternion::Identity()}});
    }
    if (defs.bodies.size() > max_bodies)
        field.fail(fmt::format("{} bodies including its nodes; allowed: at most {}",
                               defs.bodies.size(), max_bodies));
}

Course image(Course course, const Mirror& mirror) {
    for (Vector3& node : course.nodes) node = reflected(node);
    for (std::string& point : course.hardpoints) point = turned(mirror, point).value_or(point);
    return course;
}

// ---- Cross-section, and stiffness of a segment.

struct CrossSection {
    double EA = 0;              // [N]
    double EI_y = 0, EI_z = 0;  // [N·m²]
    double GJ = 0;              // [N·m²]
    double GA_y = 0, GA_z = 0;  // [N]; 0: no shear deformation
    bool is_round() const { return EI_y == EI_z && GA_y == GA_z; }
};

double positive(const Cursor& field, const Unit& unit) {
    return above_zero(field, "too small", unit);
}

// force/length², length², length⁴
Unit modulus(const Units& u) {
    const double L = u.length.divide;
    return {u.force.name + "/" + u.length.name + "²", 1, u.force.multiply * L * L};
}
Unit power_of_length(const Units& u, int n) {
    return {u.length.name + (n == 2 ? "²" : "⁴"), pow(u.length.divide, n)};
}

// Rod or tube: A = π (D² - d²)/4,  I = π (D⁴ - d⁴)/64,  J = 2 I.
CrossSection read_round(const Cursor& beam, const Cursor& diameter, double E, double G,
                        const Units& units) {
    for (const char* field : {"A", "I_y", "I_z", "J", "shear_y", "shear_z", "up"})
        if (const auto given = beam.optional(field))
            given->fail(
                "given together with diameter; allowed: diameter and wall, or A, I_y, I_z and J");
    const double D = positive(diameter, units.length);
    double d = 0;
    if (const auto wall = beam.optional("wall")) {
        d = D - 2 * positive(*wall, units.length);
        if (!(d >= -1e-12 * D))
            wall->fail(fmt::format("{} is more than half the diameter", wall->found()));
        d = std::max(d, 0.0);
    }
    const auto power = [&](int n) { return pow(D, n) - pow(d, n); };
    const double A = std::numbers::pi / 4 * power(2), I = std::numbers::pi / 64 * power(4);
    return {.EA = E * A, .EI_y = E * I, .EI_z = E * I, .GJ = G * 2 * I};
}

CrossSection read_cross_section(const Cursor& beam, const Units& units) {
    const double E = positive(beam.require("E"), modulus(units)),
                 G = positive(beam.require("G"), modulus(units));
    if (const auto diameter = beam.optional("diameter"))
        return read_round(beam, *diameter, E, G, units);
    if (const auto wall = beam.optional("wall"))
        wall->fail("wall of a tube without a diameter; give the diameter");
    if (!beam.optional("A") && !beam.optional("I_y") && !beam.optional("I_z") &&
        !beam.optional("J"))
        beam.fail("no cross-section; allowed: diameter (and wall), or A, I_y, I_z and J");
    const Unit area = power_of_length(units, 2), fourth = power_of_length(units, 4);
    const auto shear = [&](const char* field) {
        const auto given = beam.optional(field);
        return given ? G * positive(*given, area) : 0;
    };
    return {.EA = E * positive(beam.require("A"), area),
            .EI_y = E * positive(beam.require("I_y"), fourth),
            .EI_z = E * positive(beam.require("I_z"), fourth),
            .GJ = G * positive(beam.require("J"), fourth),
            .GA_y = shear("shear_y"),
            .GA_z = shear("shear_z")};
}

Matrix6 stiffness(const CrossSection& s, double L) {
    const auto shear = [&](double EI, double GA) {
        const double phi = GA > 0 ? 12 * EI / (GA * L * L) : 0;
        return 12 * EI / (L * L * L * (1 + phi));
    };
    Vector6 k;
    k << s.EA / L, shear(s.EI_z, s.GA_y), shear(s.EI_y, s.GA_z), s.GJ / L, s.EI_y / L, s.EI_z / L;
    return k.asDiagonal();
}

// Direction closest to z; none for a round section, where any direction will do.
std::optional<Vector3> read_up(const Cursor& field, const CrossSection& section,
                               const Definitions& defs) {
    if (const auto up = field.optional("up")) return direction(*up, defs);
    if (!section.is_round())
        field.fail(
            "up is missing: the cross-section differs in y and z, so the direction of z is needed");
    return std::nullopt;
}

// x along the leg, z perpendicular to it towards `up`.
Quaternion axes(const Cursor& field, const Vector3& leg, const std::optional<Vector3>& up) {
    const Vector3 x = leg.normalized();
    const Vector3 across = up ? Vector3(*up - up->dot(x) * x) : x.unitOrthogonal();
    if (!(across.norm() > parallel))
        field.require("up").fail(
            "parallel to a straight part of the beam; z must be perpendicular to it");
    Matrix3 A;
    A.col(0) = x;
    A.col(2) = across.normalized();
    A.col(1) = A.col(2).cross(x);
    return quaternion_of(A);
}

std::vector<Elastic> segments(const std::string& name, const Cursor& field,
                              const Definitions& defs) {
    const Course course = read_course(field, defs);
    const CrossSection section = read_cross_section(field, defs.units);
    const auto up = read_up(field, section, defs);
    const auto body_at = [&](std::size_t node) {
        if (node == 0) return course.first;
        return node == course.segments() ? course.last : defs.body_ids.at(numbered(name, node));
    };
    std::vector<Elastic> list;
    for (std::size_t k = 1; k <= course.segments(); ++k) {
        const Vector3 from = course.nodes[k - 1], to = course.nodes[k];
        const Quaternion A = axes(field, to - from, up);
        const auto marker = [&](BodyId id) {
            return Marker{id, point_of(id, 0.5 * (from + to), defs).s_local, A};
        };
        Bushing bushing{.i = marker(body_at(k - 1)),
                        .j = marker(body_at(k)),
                        .law = LinearStiffness{stiffness(section, (to - from).norm())}};
        bushing.formulation.frame = Formulation::Frame::middle;
        list.push_back({numbered(name, k), bushing, false, WrittenAs::beam});
    }
    return list;
}

}  // namespace

void add_beam_bodies(const Cursor& scene, Definitions& defs) {
    const auto section = scene.optional("beams");
    if (!section) return;
    require_both_sides(*section, defs);
    for (const auto& [name, field] : section->entries()) {
        field.only_keys({"bodies", "through", "segments", "E", "G", "diameter", "wall", "A", "I_y",
                         "I_z", "J", "shear_y", "shear_z", "up"});
        const Course course = read_course(field, defs);
        const BodyId first = static_cast<BodyId>(defs.bodies.size());
        add_bodies(field, name, course, defs);
        if (!defs.mirror) continue;
        const BodyId end = static_cast<BodyId>(defs.bodies.size());
        const auto other = twin_name(*defs.mirror, name, *section);
        if (other) add_bodies(field, *other, image(course, *defs.mirror), defs);
        const bool evenly = !other && is_shared_evenly(field, course, defs);
        for (BodyId id = first; id < end; ++id) {
            BodyId& twin = defs.twin_of[static_cast<std::size_t>(id)];
            if (other) defs.twin_of[static_cast<std::size_t>(twin = id - first + end)] = id;
            if (evenly) twin = first + (end - 1 - id);
        }
    }
}

void read_beams(const Cursor& scene, const Definitions& defs, std::vector<Elastic>& elastics) {
    const auto section = scene.optional("beams");
    if (!section) return;
    for (const auto& [name, field] : section->entries()) {
        const auto list = segments(name, field, defs);
        elastics.insert(elastics.end(), list.begin(), list.end());
        if (!defs.mirror) continue;
        const auto other = turned(*defs.mirror, name);
        if (!other) continue;
        for (std::size_t k = 0; k < list.size(); ++k)
            elastics.push_back(
                {numbered(*other, k + 1), twin(list[k].kind, defs), false, WrittenAs::beam});
    }
}

}  // namespace elastocheck::reader
