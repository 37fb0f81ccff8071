#include "tests/support/random_scenes.hpp"

#include "elastocheck/read_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <vector>

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

// SplitMix64 (Steele, Lea & Flood 2014): the distributions of the standard library
// differ between platforms.
struct Random {
    std::uint64_t state = 0;

    std::uint64_t bits() {
        std::uint64_t z = state += 0x9E3779B97F4A7C15u;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
        return z ^ (z >> 31);
    }
    double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }  // [0, 1)
    double between(double low, double high) { return low + (high - low) * unit(); }
    int below(int n) { return static_cast<int>(unit() * n); }
    bool chance(double share) { return unit() < share; }
    // Number of successful draws.
    int count(std::initializer_list<double> chances) {
        int true_ones = 0;
        for (const double share : chances) true_ones += chance(share);
        return true_ones;
    }
    template <class T>
    const T& one_of(const std::vector<T>& list) {
        return list[static_cast<std::size_t>(below(static_cast<int>(list.size())))];
    }
};

// Draw order: no call below draws twice among its arguments, since compilers evaluate arguments in
// different orders.

// Something that a branch may drive or hold, and its sensible range.
struct Drivable {
    std::string name;
    double range;  // SI
};

// A wheel of the scene, and a hardpoint.
struct At {
    std::string name;
    Vector3d position;
};

struct Builder {
    Random random;
    bool in_one_plane = false;
    double decade = 4;  // of the rates, about which most lie
    double force = 0;   // moves most parts by about a centimetre [N]
    // Probabilities: a law is a curve, a spring has a bump stop, a branch moves a load.
    double curves = 0.25, stopped = 0.2, loads = 0.5;
    std::vector<At> points;
    std::vector<std::string> bodies;  // their names
    std::vector<Drivable> drivables;
    struct {
        std::string points, bodies, joints, bushings, springs, stops, torsion_springs, beams, tyres,
            static_loads, loads, branches, wheels, probes;
    } text;
    int count = 0;  // number of names given

    // ---- Numbers, as text

    // Three digits of `std::pow`, whose last bit depends on the library.
    std::string decades(double low, double high) {
        return fmt::format("{:.2e}", std::pow(10, random.between(low, high)));
    }
    std::string rate(double lever = 0) {
        const double exponent =
            random.chance(0.8) ? random.between(decade - 1, decade + 1) : random.between(-1, 11);
        return fmt::format("{:.2e}", std::pow(10, exponent - lever));
    }
    std::string signed_number(double size) {
        return fmt::format("{:.3g}", random.between(-size, size));
    }
    std::string three_numbers(double size) {
        const std::array<std::string, 3> xyz{signed_number(size), signed_number(size),
                                             signed_number(size)};
        return fmt::format("[{}]", fmt::join(xyz, ", "));
    }
    std::string millimetres(int mm) { return fmt::format("{}", mm / 1e3); }

    // ---- Places

    std::string name(const char* kind) { return fmt::format("{}{}", kind, ++count); }

    // In a cube of 0.8 m on integer millimetres; sometimes at an existing point.
    At point() {
        if (!points.empty() && random.chance(0.1)) return random.one_of(points);
        const auto coordinate = [&] { return random.below(801) - 400; };
        const int x = coordinate(), y = in_one_plane ? 0 : coordinate(), z = coordinate();
        At at{name("p"), Vector3d(x, y, z) / 1e3};
        text.points += fmt::format("  {}: [{}, {}, {}]\n", at.name, millimetres(x), millimetres(y),
                                   millimetres(z));
        points.push_back(at);
        return at;
    }
    At other_than(const At& p) {
        for (;;)
            if (const At q = point(); q.position != p.position) return q;
    }
    Vector3d direction() {
        for (;;) {
            const double x = random.between(-1, 1), y = in_one_plane ? 0 : random.between(-1, 1),
                         z = random.between(-1, 1);
            const Vector3d u(x, y, z);
            if (const double length = u.norm(); length > 0.1 && length < 1) return u / length;
        }
    }
    static std::string list(const Vector3d& u) {
        return fmt::format("[{:.12g}, {:.12g}, {:.12g}]", u.x(), u.y(), u.z());
    }
    // A direction, through two hardpoints or as numbers.
    std::string axis(const At& through) {
        if (in_one_plane && random.chance(0.7)) return "y";
        if (random.chance(0.5))
            return fmt::format("[{}, {}]", through.name, other_than(through).name);
        return list(direction());
    }

    std::string earlier(int b) {
        const int k = random.below(b + 1) - 1;
        return k < 0 ? "ground" : bodies[static_cast<std::size_t>(k)];
    }
    std::string pair(const std::string& i, const std::string& j) {
        return fmt::format("bodies: [{}, {}]", i, j);
    }

    // ---- Laws

    // A force that rises over ±`reach`, with flat and steep pieces.
    std::string curve(double reach, double lever) {
        std::vector<std::string> rows;
        const int n = 2 + random.below(4);
        const bool symmetric = random.chance(0.3);
        double x = symmetric ? 0 : -reach,
               f = symmetric ? 0 : -force * std::pow(10, random.between(-1, 1) - lever);
        for (int k = 0; k <= n; ++k) {
            rows.push_back(symmetric && k == 0 ? "[0, 0]" : fmt::format("[{:.3g}, {:.4g}]", x, f));
            x += reach * random.between(0.1, 1);
            if (!random.chance(0.15)) f += force * std::pow(10, random.between(-1, 1) - lever);
        }
        const bool unknown = random.chance(0.15);
        const std::string scale = random.chance(0.2) ? ", scale: " + decades(-1, 1) : "";
        return fmt::format("{{table: [{}]{}{}{}}}", fmt::join(rows, ", "),
                           symmetric ? ", symmetric: true" : "",
                           unknown ? ", outside: unknown" : "", scale);
    }
    std::string rate_or_curve(double reach, double lever) {
        return random.chance(curves) ? "curve: " + curve(reach, lever) : "rate: " + rate(lever);
    }
    // Open, just touching or closed in the design position.
    std::string stop() {
        const double clearance = random.chance(0.2) ? 0 : random.between(-0.005, 0.04);
        const std::string k = rate();
        return fmt::format("{{clearance: {:.3g}, rate: {}}}", clearance, k);
    }

    // ---- Joints and elements between two bodies

    enum Kind { any = -1, distance = 7, in_plane = 8 };
    void joint(const std::string& i, const std::string& j, Kind kind = any) {
        const std::string joint = name("j"), both = pair(i, j);
        const At p = point();
        const auto write = [&](const std::string& type, const std::string& fields) {
            text.joints += fmt::format("  {}: {{type: {}, {}, {}}}\n", joint, type, both, fields);
        };
        const auto at = [&] { return "at: " + p.name; };
        // Joints with one axis that may be driven or held.
        const auto hinge = [&](const std::string& type, double range) {
            const std::string fields = fmt::format("{}, axis: {}", at(), axis(p));
            write(type, fields + (random.chance(0.1) ? ", held: true" : ""));
            drivables.push_back({"joints." + joint, range});
            // A duplicate beside it on the same axis, like the hinges of a door.
            if (random.chance(0.08)) {
                text.joints +=
                    fmt::format("  {}: {{type: {}, {}, {}}}\n", name("j"), type, both, fields);
            }
        };
        switch (kind == any ? random.below(12) : static_cast<int>(kind)) {
            case 0:
            case 1: write("spherical", at()); break;
            case 2: hinge("revolute", 0.6); break;
            case 3: hinge("cylindrical", 0.6); break;
            case 4: hinge("translational", 0.08); break;
            case 5: {
                const Vector3d u = direction(), v = direction();
                const Vector3d w =
                    u.cross(v).norm() > 0.1 ? u.cross(v).normalized() : u.unitOrthogonal();
                write("universal",
                      fmt::format("{}, axis_i: {}, axis_j: {}", at(), list(u), list(w)));
                break;
            }
            case 6: write("planar", fmt::format("{}, normal: {}", at(), axis(p))); break;
            case distance: {
                const At q = other_than(p);
                const double drawn = (q.position - p.position).norm();  // [m]
                // Sometimes of a length other than in the design position, so that the scene has to
                // be assembled first.
                const double off = random.chance(0.1) ? random.between(-0.02, 0.02) : 0;
                write("distance",
                      fmt::format(
                          "from: {}, to: {}{}", p.name, q.name,
                          off == 0 ? "" : fmt::format(", length: {:.6f}", drawn + off * drawn)));
                drivables.push_back({"joints." + joint, 0.2 * drawn});
                break;
            }
            case in_plane:
                write("in_plane", fmt::format("{}, normal: {}", at(), axis(p)));
                drivables.push_back({"joints." + joint, 0.05});
                break;
            case 9: write("in_line", fmt::format("{}, axis: {}", at(), axis(p))); break;
            case 10:
                if (random.chance(0.5))
                    write("parallel", "axis: " + axis(p));
                else if (const Vector3d u = direction(), w = u.unitOrthogonal(); true)
                    write("perpendicular", fmt::format("axis_i: {}, axis_j: {}", list(u), list(w)));
                break;
            default: write(random.chance(0.3) ? "fixed" : "spherical", at());
        }
    }

    void bushing(const std::string& i, const std::string& j) {
        const std::string bushing = name("b");
        const At p = point();
        std::string fields;
        // Any frame; a frame given by one axis would require a bushing symmetric about that axis.
        if (random.chance(0.5)) {
            const Vector3d z = direction();
            fields += fmt::format(", frame: {{z: {}, x: {}}}", list(z), list(z.unitOrthogonal()));
        }
        if (random.chance(0.1)) {
            // K = Σ r rᵀ over some rows: symmetric, positive semidefinite, with coupled axes.
            Eigen::Matrix<double, 6, 6> K = Eigen::Matrix<double, 6, 6>::Zero();
            const double size = std::pow(10, std::floor(decade));
            for (int k = 3 + random.below(4); k > 0; --k) {
                Eigen::Matrix<double, 6, 1> row;
                for (int a = 0; a < 6; ++a)
                    row[a] = std::floor(random.between(-8, 8)) / (a < 3 ? 8 : 64);
                K += size * row * row.transpose();
            }
            std::vector<std::string> rows;
            for (int a = 0; a < 6; ++a) {
                std::vector<double> row;
                for (int b = 0; b < 6; ++b) row.push_back(K(a, b));
                rows.push_back(fmt::format("[{}]", fmt::join(row, ", ")));
            }
            fields += fmt::format(", stiffness: [{}]", fmt::join(rows, ", "));
        } else {
            const auto three = [&](double lever) {
                const bool alike = random.chance(0.4);
                const std::string k = rate(lever);
                const auto one = [&] {
                    return random.chance(0.08) ? "0" : alike ? k : rate(lever);
                };
                const std::string x = one(), y = one(), z = one();
                return fmt::format("[{}, {}, {}]", x, y, z);
            };
            fields += ", rates: " + three(0);
            if (!random.chance(0.15)) fields += ", rotational_rates: " + three(2.5);
            if (random.chance(0.2)) {
                const bool turning = random.chance(0.5);
                const char axis = "xyz"[random.below(3)];
                const std::string law = turning ? curve(0.3, 1.5) : curve(0.01, 0);
                fields += fmt::format(", curves: {{{}{}: {}}}", turning ? "r" : "", axis, law);
            }
        }
        if (random.chance(0.25)) fields += ", preload: " + three_numbers(force / 3);
        if (random.chance(0.1)) fields += ", preload_moment: " + three_numbers(force / 100);
        if (random.chance(0.05)) fields += ", undeformed: " + three_numbers(1e-3);
        if (random.chance(0.05)) fields += ", undeformed_angles: " + three_numbers(0.02);
        if (random.chance(0.15)) {
            const std::string frame = random.one_of<std::string>({"i", "i", "j", "middle"}),
                              angles = random.one_of<std::string>(
                                  {"rotation_vector", "cardan", "projected"});
            const bool straight = frame != "middle" && random.chance(0.3),
                       without = random.chance(0.2);
            fields += fmt::format(", formulation: {{frame: {}, angles: {}{}{}}}", frame, angles,
                                  straight ? ", conjugate: false" : "",
                                  without ? ", offset_moment: false" : "");
        }
        text.bushings +=
            fmt::format("  {}: {{{}, at: {}{}}}\n", bushing, pair(i, j), p.name, fields);
        drivables.push_back(
            {fmt::format("bushings.{}.preload.{}", bushing, "xyz"[random.below(3)]), force});
        drivables.push_back(
            {fmt::format("bushings.{}.preload_moment.{}", bushing, "xyz"[random.below(3)]),
             force / 20});
    }

    void spring(const std::string& i, const std::string& j) {
        const std::string spring = name("s");
        const At p = point(), q = other_than(p);
        const std::string law = rate_or_curve(0.05, 0);
        const bool is_curve = law.starts_with("curve");
        // Preload that leaves a positive free length.
        const double length = (q.position - p.position).norm(),
                     most = is_curve ? 0 : std::min(force, 0.3 * length * std::stod(law.substr(6)));
        std::string fields = law;
        if (!is_curve && random.chance(0.4))
            fields += ", preload: " + signed_number(most);
        else if (random.chance(0.1))
            fields += fmt::format(", free_length: {:.4f}",
                                  (q.position - p.position).norm() * random.between(0.8, 1.2));
        if (random.chance(stopped)) fields += ", bump_stop: " + stop();
        if (random.chance(0.1)) fields += ", rebound_stop: " + stop();
        text.springs += fmt::format("  {}: {{{}, from: {}, to: {}, {}}}\n", spring, pair(i, j),
                                    p.name, q.name, fields);
        if (is_curve || random.chance(0.5))
            drivables.push_back({fmt::format("springs.{}.free_length", spring), 0.05});
        else
            drivables.push_back({fmt::format("springs.{}.preload", spring), most});
    }

    void torsion_spring(const std::string& i, const std::string& j) {
        const std::string torsion_spring = name("t");
        const At p = point();
        const std::string about = axis(p), law = rate_or_curve(0.5, 2),
                          preload = random.chance(0.3)
                                        ? ", preload_moment: " + signed_number(force / 50)
                                        : "";
        text.torsion_springs +=
            fmt::format("  {}: {{{}, at: {}, axis: {}, {}{}}}\n", torsion_spring, pair(i, j),
                        p.name, about, law, preload);
        drivables.push_back(
            {fmt::format("torsion_springs.{}.preload_moment", torsion_spring), force / 20});
    }

    void stops(const std::string& i, const std::string& j) {
        const At p = point(), q = other_than(p);
        const std::string side = random.chance(0.5) ? "bump" : "rebound", law = stop();
        text.stops += fmt::format("  {}: {{{}, from: {}, to: {}, {}: {}}}\n", name("x"), pair(i, j),
                                  p.name, q.name, side, law);
    }

    void beam(const std::string& i, const std::string& j) {
        const At p = point(), q = other_than(p);
        const int segments = 1 + random.below(4);
        text.beams += fmt::format(
            "  {}: {{{}, through: [{}, {}], segments: {}, E: 206e9, G: 79e9, diameter: {:.3f}}}\n",
            name("m"), pair(i, j), p.name, q.name, segments, random.between(0.008, 0.03));
    }

    void element(const std::string& i, const std::string& j) {
        const double kind = random.unit();
        if (kind < 0.5)
            bushing(i, j);
        else if (kind < 0.8)
            spring(i, j);
        else if (kind < 0.88)
            torsion_spring(i, j);
        else if (kind < 0.95)
            stops(i, j);
        else
            beam(i, j);
    }

    // ---- Loads, outputs, branches

    // In newtons for a static load, else per newton of the branch; likewise a moment.
    std::string load(const std::string& on, bool held) {
        const bool moment = random.chance(0.25);
        const double scale =
            held     ? force * std::pow(10, random.between(-1.5, 0)) * (moment ? 0.1 : 1)
            : moment ? 0.2
                     : 1;
        const Vector3d u = direction() * scale;
        const std::string numbers = fmt::format("[{:.3g}, {:.3g}, {:.3g}]", u.x(), u.y(), u.z());
        const std::string what =
            moment ? "moment: " + numbers : fmt::format("at: {}, force: {}", point().name, numbers);
        return fmt::format("{{on: {}, {}{}}}", on, what,
                           random.chance(0.06) ? ", follows: true" : "");
    }

    void branch(const std::string& loaded) {
        const std::string branch = name("branch");
        std::string what, more;
        std::string to;
        const double sign = random.chance(0.5) ? 1 : -1;
        std::vector<std::size_t> order;
        for (std::size_t k = 0; k < drivables.size(); ++k) order.push_back(k);
        for (std::size_t k = order.size(); k > 1; --k)
            std::swap(order[k - 1],
                      order[static_cast<std::size_t>(random.below(static_cast<int>(k)))]);
        std::size_t used = 0;
        double size = 0;
        if (order.empty() || random.chance(loads)) {
            const std::string first = name("l");
            const At p = point();
            const Vector3d u = (direction() * 1000).array().round() / 1000;
            text.loads += fmt::format("  {}: {{on: {}, at: {}, force: {}}}\n", first, loaded,
                                      p.name, list(u));
            what = fmt::format("load: {}", first);
            if (random.chance(0.3)) {
                const std::string second = name("l");
                const std::string on = random.one_of(bodies);
                text.loads += fmt::format("  {}: {}\n", second, load(on, false));
                what = fmt::format("load: {{{}: 1, {}: {}}}", first, second, signed_number(2));
            }
            size = force * std::pow(10, random.between(-1.5, 1));
        } else {
            const auto& driven = drivables[order[used++]];
            size = driven.range * random.between(0.1, 1);
            what = fmt::format("drive: {{{}: 1", driven.name);
            if (used < order.size() && random.chance(0.15)) {
                const auto& second = drivables[order[used++]];
                what += fmt::format(", {}: {:.3g}", second.name,
                                    second.range * random.between(-1, 1) / size);
            }
            what += "}";
        }
        if (used < order.size() && random.chance(0.15)) {
            const auto& held = drivables[order[used++]];
            more += fmt::format(", hold: {{{}: {:.3g}}}", held.name,
                                held.range * random.between(-0.3, 0.3));
        }
        if (random.chance(0.2))
            more += fmt::format(", from: {:.3g}", -sign * size * random.between(0.2, 1));
        const int steps = random.one_of<int>({2, 4, 8, 20, 20, 40});
        text.branches += fmt::format("  {}: {{{}, to: {:.3g}, steps: {}{}}}\n", branch, what,
                                     sign * size, steps, more);
    }
};

// Mostly small scenes, which find more faults per time.
int bodies_of(Random& random) {
    const double u = random.unit();
    return u < 0.85 ? 1 + random.below(5) : u < 0.97 ? 6 + random.below(7) : 13 + random.below(28);
}

}  // namespace

std::string random_scene(std::uint64_t seed, Family family) {
    const bool driven = family == Family::driven;
    Builder at;
    Random& random = at.random;
    random.state = seed;
    const int nb = driven ? 1 + random.below(4) : bodies_of(random);
    if (driven) at.curves = 0.5, at.stopped = 0.5, at.loads = 0;
    at.in_one_plane = random.chance(0.07);
    at.decade = random.between(3, 6);
    at.force = std::pow(10, at.decade - 2);
    const bool has_gravity = random.chance(0.15);
    for (int b = 0; b < nb; ++b) {
        const At origin = at.point();
        at.text.bodies +=
            fmt::format("  body{}: {{origin: {}{}}}\n", b, origin.name,
                        has_gravity ? fmt::format(", mass: {:.3g}", random.between(1, 50)) : "");
        const std::string body = fmt::format("body{}", b);
        const int before = at.count;
        for (int k = driven ? random.count({0.3}) : random.count({0.65, 0.3}); k > 0; --k)
            at.joint(body, at.earlier(b));
        if (driven && (b == 0 || random.chance(0.5)))
            at.joint(body, at.earlier(b), Builder::distance);
        if (driven && random.chance(0.3)) at.joint(body, at.earlier(b), Builder::in_plane);
        if (random.chance(driven ? 0.9 : 0.75)) at.bushing(body, at.earlier(b));
        if (driven && random.chance(0.6)) at.spring(body, at.earlier(b));
        for (int k = random.count({0.5, 0.3}); k > 0; --k) at.element(body, at.earlier(b));
        if (at.count == before) at.bushing(body, at.earlier(b));
        at.bodies.push_back(body);
    }
    // Across the tree: closed loops, some of them redundant.
    for (int k = random.chance(0.3) + nb / 8; k > 0 && nb > 1; --k) {
        const int b = 1 + random.below(nb - 1);
        const std::string body = at.bodies[static_cast<std::size_t>(b)];
        random.chance(0.5) ? at.joint(body, at.earlier(b)) : at.element(body, at.earlier(b));
    }
    if (random.chance(0.25)) {
        const std::string body = random.one_of(at.bodies);
        const At centre = at.point(), patch = at.other_than(centre);
        at.text.wheels = fmt::format(
            "  wheel: {{body: {}, centre: {}, contact_patch: {}, spin_axis: {}, side: {}}}\n", body,
            centre.name, patch.name, centre.position.y() < 0 ? "-y" : "y",
            centre.position.y() < 0 ? "right" : "left");
        at.drivables.push_back({"wheel.travel", 0.05});
        at.drivables.push_back({"wheel.patch_travel", 0.05});
        if (random.chance(0.4)) {
            at.text.tyres = fmt::format("  tyre: {{wheel: wheel, rate: {}, preload: {:.4g}}}\n",
                                        at.rate(), random.between(0, at.force));
            at.drivables.push_back({"tyres.tyre.road", 0.05});
        }
    }
    for (int k = random.count({0.3, 0.1}); k > 0; --k) {
        const std::string on = random.one_of(at.bodies);
        at.text.static_loads += fmt::format("  {}: {}\n", at.name("w"), at.load(on, true));
    }
    if (driven)
        std::erase_if(at.drivables, [](const Drivable& one) {
            return !one.name.starts_with("joints.") && !one.name.starts_with("wheel.");
        });
    const std::string last = at.bodies.back();
    for (int k = 1 + random.count({0.15}); k > 0; --k) at.branch(last);
    for (const auto& body : at.bodies)
        if (body == last || random.chance(0.5))
            at.text.probes +=
                fmt::format("  at_{}: {{on: {}, at: {}}}\n", body, body, at.point().name);

    std::string text = fmt::format(
        "elastocheck: 1\nname: random {}{}\nunits: {{length: m, angle: rad, force: N}}\n",
        driven ? "driven " : "", seed);
    if (has_gravity) text += "gravity: [0, 0, -9.81]\n";
    const auto section = [&](const char* name, const std::string& lines) {
        if (!lines.empty()) text += fmt::format("{}:\n{}", name, lines);
    };
    section("points", at.text.points);
    section("bodies", at.text.bodies);
    section("joints", at.text.joints);
    section("bushings", at.text.bushings);
    section("springs", at.text.springs);
    section("stops", at.text.stops);
    section("torsion_springs", at.text.torsion_springs);
    section("beams", at.text.beams);
    section("tyres", at.text.tyres);
    section("static_loads", at.text.static_loads);
    section("loads", at.text.loads);
    section("branches", at.text.branches);
    section("wheels", at.text.wheels);
    section("probes", at.text.probes);
    return text;
}

std::optional<Scene> small_random_scene(std::uint64_t seed) {
    const std::string text = random_scene(seed);
    if (text.find("body3:") != text.npos || text.find("beams:") != text.npos) return {};
    try {
        return parse_scene(text, "random.yaml");
    } catch (const SceneError&) {
        return {};
    }
}

}  // namespace elastocheck::compare
