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

constexpr double min_sine = 1e-6;  // of the angle between directions; below, they count as parallel

// ---- Path of the beam.

struct BeamPath {
    std::vector<std::string> hardpoints;  // on the path
    std::vector<Vector3> nodes;           // from end to end [m]
    std::vector<std::size_t> corners;     // positions in `nodes` of the hardpoints
    BodyId first = ground, last = ground;

    std::size_t segments() const { return nodes.size() - 1; }
};

// Number of segments of each straight part: one each, the others one by one to the part whose segments
// are longest. Among equal parts the order is first, last, second, last but one, ..., which keeps a
// symmetric beam symmetric where possible.
std::vector<int> segments_of_parts(int segments, const std::vector<double>& lengths) {
    const std::size_t parts = lengths.size();
    std::vector<std::size_t> alternating;
    for (std::size_t k = 0; k < parts; ++k)
        alternating.push_back(k % 2 == 0 ? k / 2 : parts - 1 - k / 2);
    std::vector<int> share(parts, 1);
    for (int left = segments - static_cast<int>(parts); left > 0; --left) {
        std::size_t longest = alternating.front();
        for (const std::size_t k : alternating)
            if (lengths[k] / share[k] > (1 + 1e-9) * lengths[longest] / share[longest]) longest = k;
        ++share[longest];
    }
    return share;
}

BeamPath read_beam_path(const Cursor& field, const Definitions& defs) {
    BeamPath path;
    const auto ends = field.require("bodies").list(2, "bodies");
    path.first = body(ends[0], defs);
    path.last = body(ends[1], defs);

    const Cursor through = field.require("through");
    const auto points = through.items();
    if (!through.is_list() || points.size() < 2)
        through.fail(
            fmt::format("expected a list of two hardpoints or more, found {}", through.found()));
    std::vector<Vector3> places;
    std::vector<double> lengths;
    for (const Cursor& point : points) {
        places.push_back(hardpoint(point, defs));
        path.hardpoints.push_back(point.value->text);
        if (places.size() == 1) continue;
        lengths.push_back((places.back() - places[places.size() - 2]).norm());
        if (!(lengths.back() > coincident))
            point.fail(
                fmt::format("{} coincides with the hardpoint before it; each straight part of a "
                            "beam needs a length",
                            point.found()));
    }

    const int parts = static_cast<int>(lengths.size());
    const Cursor segments = field.require("segments");
    const int n = segments.whole_number(1, max_segments);
    if (n < parts)
        segments.fail(
            fmt::format("{} segments for {} straight parts; allowed: at least one per part",
                        segments.found(), parts));
    if (n == 1 && path.first == path.last)
        ends[1].fail(
            fmt::format("both ends are on {}; a beam of one segment needs two different bodies",
                        ends[1].found()));
    const auto share = segments_of_parts(n, lengths);
    path.nodes.push_back(places[0]);
    path.corners.push_back(0);
    for (std::size_t part = 0; part < share.size(); ++part) {
        for (int k = 1; k < share[part]; ++k)
            path.nodes.emplace_back(places[part] +
                                    (places[part + 1] - places[part]) * (double(k) / share[part]));
        path.corners.push_back(path.nodes.size());
        path.nodes.push_back(places[part + 1]);
    }
    return path;
}

// Whether the mirror image of the points is the points in reverse order.
bool is_own_image(const std::vector<Vector3>& points) {
    for (std::size_t k = 0; k < points.size(); ++k)
        if (!are_near(reflected(points[k]), points[points.size() - 1 - k], coincident))
            return false;
    return true;
}

// Whether both sides share the beam and its first half is the mirror image of its second.
bool is_shared_evenly(const Cursor& field, const BeamPath& path, const Definitions& defs) {
    const BodyId image =
        path.first == ground ? ground : defs.twin_of[static_cast<std::size_t>(path.first)];
    if (image != path.last) return false;
    std::vector<Vector3> corners;
    for (const std::size_t k : path.corners) corners.push_back(path.nodes[k]);
    if (!is_own_image(corners)) return false;
    if (!is_own_image(path.nodes)) {
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

// Adds bodies at the inner nodes: "NAME.1", ..., at a corner also "NAME.HARDPOINT".
void add_bodies(const Cursor& field, const std::string& name, const BeamPath& path,
                Definitions& defs) {
    const auto id = [&](std::size_t node) {
        return static_cast<BodyId>(defs.bodies.size() + node - 1);
    };
    for (std::size_t k = 1; k < path.segments(); ++k)
        if (!defs.body_ids.emplace(numbered(name, k), id(k)).second)
            field.fail(
                fmt::format("the body name {} is reserved for a node of this beam, but already in "
                            "use; rename the other body",
                            quote(numbered(name, k))));
    for (std::size_t corner = 1; corner + 1 < path.corners.size(); ++corner)
        defs.body_ids.emplace(name + "." + path.hardpoints[corner], id(path.corners[corner]));
    for (std::size_t k = 1; k < path.segments(); ++k) {
        defs.twin_of.push_back(static_cast<BodyId>(defs.bodies.size()));
        defs.bodies.push_back(
            {numbered(name, k), {.r = path.nodes[k], .p = Quaternion::Identity()}});
    }
    if (defs.bodies.size() > max_bodies)
        field.fail(fmt::format("{} bodies including its nodes; allowed: at most {}",
                               defs.bodies.size(), max_bodies));
}

BeamPath image(BeamPath path, const Mirror& mirror) {
    for (Vector3& node : path.nodes) node = reflected(node);
    for (std::string& point : path.hardpoints) point = mirrored_name(mirror, point).value_or(point);
    return path;
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

// Unit of E and G, force/length².
Unit modulus(const Units& u) {
    const double L = u.length.divide;
    return {.name = u.force.name + "/" + u.length.name + "²", .multiply = u.force.multiply * L * L};
}
// length² or length⁴
Unit power_of_length(const Units& u, int n) {
    return {.name = u.length.name + (n == 2 ? "²" : "⁴"), .divide = pow(u.length.divide, n)};
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

// K of one segment (beams.hpp).
Matrix6 stiffness(const CrossSection& s, double L) {
    const auto shear = [&](double EI, double GA) {
        const double phi = GA > 0 ? 12 * EI / (GA * L * L) : 0;
        return 12 * EI / (L * L * L * (1 + phi));
    };
    Vector6 k;
    k << s.EA / L, shear(s.EI_z, s.GA_y), shear(s.EI_y, s.GA_z), s.GJ / L, s.EI_y / L, s.EI_z / L;
    return k.asDiagonal();
}

// The direction to which z of the section is closest; none for a round section, which needs none.
std::optional<Vector3> read_up(const Cursor& field, const CrossSection& section,
                               const Definitions& defs) {
    if (const auto up = field.optional("up")) return direction(*up, defs);
    if (!section.is_round())
        field.fail(
            "up is missing: the cross-section differs in y and z, so the direction of z is needed");
    return std::nullopt;
}

// x along the segment, z perpendicular to it towards `up`.
Quaternion axes(const Cursor& field, const Vector3& segment, const std::optional<Vector3>& up) {
    const Vector3 x = segment.normalized();
    const Vector3 across = up ? Vector3(*up - up->dot(x) * x) : x.unitOrthogonal();
    if (!(across.norm() > min_sine))
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
    const BeamPath path = read_beam_path(field, defs);
    const CrossSection section = read_cross_section(field, defs.units);
    const auto up = read_up(field, section, defs);
    const auto body_at = [&](std::size_t node) {
        if (node == 0) return path.first;
        return node == path.segments() ? path.last : defs.body_ids.at(numbered(name, node));
    };
    std::vector<Elastic> list;
    for (std::size_t k = 1; k <= path.segments(); ++k) {
        const Vector3 from = path.nodes[k - 1], to = path.nodes[k];
        const Quaternion A = axes(field, to - from, up);
        const auto marker = [&](BodyId id) {
            return Marker{id, point_of(id, 0.5 * (from + to), defs).s_local, A};
        };
        Bushing bushing{.i = marker(body_at(k - 1)),
                        .j = marker(body_at(k)),
                        .law = LinearStiffness{stiffness(section, (to - from).norm())}};
        bushing.formulation.frame = Formulation::Frame::middle;
        list.push_back({.name = numbered(name, k), .kind = bushing, .written_as = WrittenAs::beam});
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
        const BeamPath path = read_beam_path(field, defs);
        const BodyId first = static_cast<BodyId>(defs.bodies.size());
        add_bodies(field, name, path, defs);
        if (!defs.mirror) continue;
        const BodyId end = static_cast<BodyId>(defs.bodies.size());
        const auto other = twin_name(*defs.mirror, name, *section);
        if (other) add_bodies(field, *other, image(path, *defs.mirror), defs);
        const bool evenly = !other && is_shared_evenly(field, path, defs);
        for (BodyId id = first; id < end; ++id) {
            BodyId& twin = defs.twin_of[static_cast<std::size_t>(id)];
            if (other) {
                twin = end + (id - first);
                defs.twin_of[static_cast<std::size_t>(twin)] = id;
            }
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
        const auto other = mirrored_name(*defs.mirror, name);
        if (!other) continue;
        for (std::size_t k = 0; k < list.size(); ++k)
            elastics.push_back({.name = numbered(*other, k + 1),
                                .kind = twin(list[k].kind, defs),
                                .written_as = WrittenAs::beam});
    }
}

}  // namespace elastocheck::reader
