#include "tests/benchmark/families.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

namespace elastocheck::families {
namespace {

// A scene in the making: its sections, an entry a line.
struct Text {
    std::string points, bodies, joints, torsion_springs, bushings, beams, loads, load_names;

    // A section grows by `name: {what}`.
    template <class... T>
    static void add(std::string& section, fmt::format_string<T...> what, T&&... values) {
        section += "  ";
        fmt::format_to(std::back_inserter(section), what, std::forward<T>(values)...);
        section += '\n';
    }
    void point(const std::string& name, double x, double y, double z) {
        add(points, "{}: [{}, {}, {}]", name, x, y, z);
    }
    void body(const std::string& name, const std::string& origin) {
        add(bodies, "{}: {{origin: {}}}", name, origin);
    }
    // Between i and j, which turns about y against the load; as stiff in all directions where it is a bushing.
    void hinge(Hinge kind, const std::string& name, const std::string& i, const std::string& j,
               const std::string& at, double k_T, double k_R) {
        if (kind == Hinge::bushing) {
            bushing(name, i, j, at, k_T, k_R);
        } else {
            add(joints, "{}: {{type: revolute, bodies: [{}, {}], at: {}, axis: y}}", name, i, j,
                at);
            add(torsion_springs, "{}_spring: {{bodies: [{}, {}], at: {}, axis: y, rate: {}}}", name,
                i, j, at, k_R);
        }
    }
    void bushing(const std::string& name, const std::string& i, const std::string& j,
                 const std::string& at, double k_T, double k_R) {
        add(bushings,
            "{}: {{bodies: [{}, {}], at: {}, rates: [{}, {}, {}], rotational_rates: [{}, {}, {}]}}",
            name, i, j, at, k_T, k_T, k_T, k_R, k_R, k_R);
    }
    void force_up(const std::string& name, const std::string& body, const std::string& at,
                  double share) {
        add(loads, "{}: {{on: {}, at: {}, force: [0, 0, {}]}}", name, body, at, share);
        load_names += (load_names.empty() ? "" : ", ") + name;
    }
};

std::string whole(const Text& text, const Family& family, const std::string& known,
                  const std::string& probe_on, const std::string& probe_at, double to) {
    std::string out = fmt::format(
        "# A {0} of {1} bodies{2}, as written by:  families {0} --bodies {1}{3}\n# {4}\n\n"
        "elastocheck: 1\nname: {0} of {1} bodies{2}\nunits: {{length: m, angle: rad, force: N}}\n",
        name(family.kind), family.bodies,
        has_hinges(family.kind) ? fmt::format(" on {}s", name(family.hinge)) : "",
        has_hinges(family.kind) ? fmt::format(" --joints {}", name(family.hinge)) : "", known);
    for (const auto& [section, entries] : {std::pair{"points", &text.points},
                                           {"bodies", &text.bodies},
                                           {"joints", &text.joints},
                                           {"torsion_springs", &text.torsion_springs},
                                           {"bushings", &text.bushings},
                                           {"beams", &text.beams},
                                           {"loads", &text.loads}})
        if (!entries->empty()) out += fmt::format("\n{}:\n{}", section, *entries);
    return out + fmt::format(
                     "\nprobes: {{end: {{on: {}, at: {}}}}}\n"
                     "branches: {{push: {{load: [{}], to: {}, steps: 5}}}}\n",
                     probe_on, probe_at, text.load_names, to);
}

// ---- Chains.

// n links from (0, y, 0) to (length, y, 0), their names and points beginning with `row`, of one `share` of the rod.
void add_chain(Text& text, const Family& family, const std::string& row, double y, int n,
               double share) {
    for (int k = 0; k <= n; ++k) text.point(fmt::format("{}p{}", row, k), length * k / n, y, 0);
    for (int k = 1; k <= n; ++k) {
        const std::string at = fmt::format("{}p{}", row, k - 1);
        text.body(fmt::format("{}b{}", row, k), at);
        text.hinge(family.hinge, fmt::format("{}h{}", row, k),
                   k == 1 ? "ground" : fmt::format("{}b{}", row, k - 1),
                   fmt::format("{}b{}", row, k), at, share * n * EA / length,
                   share * n * EI / length);
    }
    text.force_up(fmt::format("{}push", row), fmt::format("{}b{}", row, n),
                  fmt::format("{}p{}", row, n), share);
}

std::string chain(const Family& family) {
    Text text;
    add_chain(text, family, "", 0, family.bodies, 1);
    return whole(text, family, "A recursion from the end back gives every angle.",
                 fmt::format("b{}", family.bodies), fmt::format("p{}", family.bodies), load);
}

// Bodies 1 to n, k on k/2, as in a heap. Level d of m holds 2^d to 2^(d+1) - 1, at the middles of 2^d parts of the width.
std::string tree(const Family& family) {
    const int n = family.bodies, m = levels(n);
    std::vector<int> leaves_on(static_cast<std::size_t>(n) + 1);
    for (int k = n; k >= 1; --k) {
        auto& own = leaves_on[static_cast<std::size_t>(k)];
        if (own == 0) own = 1;
        leaves_on[static_cast<std::size_t>(k / 2)] += own;
    }
    Text text;
    const double h = length / m;
    for (int k = 1; k <= n; ++k) {
        const int level = levels(k) - 1, across = 1 << level;
        const double y = width * ((k - across + 0.5) / across - 0.5);
        const double share =
            static_cast<double>(leaves_on[static_cast<std::size_t>(k)]) / leaves_on[0];
        const std::string body = fmt::format("b{}", k), at = fmt::format("p{}", k);
        text.point(at, level * h, y, 0);
        text.body(body, at);
        text.hinge(family.hinge, fmt::format("h{}", k),
                   k == 1 ? "ground" : fmt::format("b{}", k / 2), body, at, share * m * EA / length,
                   share * m * EI / length);
        if (2 * k > n) {
            text.point(fmt::format("e{}", k), (level + 1) * h, y, 0);
            text.force_up(fmt::format("push{}", k), body, fmt::format("e{}", k), share);
        }
    }
    return whole(text, family,
                 "Full, of 2^m - 1 bodies, each level moves as one link of a chain of m.",
                 fmt::format("b{}", n), fmt::format("e{}", n), load);
}

std::string grid(const Family& family) {
    const int R = rows(family.bodies), C = family.bodies / R;
    Text text;
    for (int r = 1; r <= R; ++r)
        add_chain(text, family, fmt::format("r{}", r),
                  R == 1 ? 0 : width * ((r - 1.) / (R - 1) - 0.5), C, 1. / R);
    for (int r = 1; r < R; ++r)
        for (int c = 1; c <= C; ++c) {
            const std::string at = fmt::format("t{}_{}", r, c);
            text.point(at, length * (c - 0.5) / C, width * ((r - 0.5) / (R - 1) - 0.5), 0);
            text.bushing(at, fmt::format("r{}b{}", r, c), fmt::format("r{}b{}", r + 1, c), at,
                         C * EA / length / R, C * EI / length / R);
        }
    return whole(text, family, fmt::format("{} rows, each of which moves as a chain of {}.", R, C),
                 fmt::format("r{}b{}", R, C), fmt::format("r{}p{}", R, C), load);
}

// ---- Beams.

// `segments` shared out over beams of these lengths, from as many as each needs at least: the next one always to the beam
// whose segments are longest.
std::vector<int> shared_out(int segments, const std::vector<double>& lengths,
                            std::vector<int> shares) {
    const auto longest = [&] {
        std::size_t found = 0;
        for (std::size_t k = 1; k < lengths.size(); ++k)
            if (lengths[k] * shares[found] > lengths[found] * shares[k]) found = k;
        return found;
    };
    for (int left = segments - std::accumulate(shares.begin(), shares.end(), 0); left > 0; --left)
        ++shares[longest()];
    return shares;
}

// Leaf k ends where it presses on the one before, k-1, through its pads; all run through the seat. Of its n nodes and
// segments all seats are one body, so n = 1 + all segments.
std::string leaf_spring(const Family& family) {
    const Leaves pack = leaves(family.bodies);
    const double w = pack.width, t = pack.thick;
    std::vector<double> lengths;
    std::vector<int> least;
    for (int k = 0; k < pack.count; ++k) {
        lengths.push_back(pack.half_of(k));
        least.push_back(k + 1 < pack.count ? 4 : 2);
    }
    const auto segments = shared_out(family.bodies - 1, lengths, least);
    Text text;
    for (int k = 0; k < pack.count; ++k) {
        std::string through = fmt::format("[front{}, ", k), back = fmt::format("rear{}]", k);
        for (const auto& [side, sign] : {std::pair{"front", 1}, {"rear", -1}}) {
            const std::string end = fmt::format("{}{}", side, k),
                              pad = fmt::format("{}_pad{}", side, k + 1);
            text.point(end, sign * pack.half_of(k), 0, -k * t);
            text.body(end, end);
            if (k + 1 < pack.count) text.point(pad, sign * pack.half_of(k + 1), 0, -k * t);
            if (k > 0)
                text.add(text.bushings,
                         "{0}_pad{1}: {{bodies: [leaf{2}.{0}_pad{1}, {3}], at: {3}, rates: [0, 0, "
                         "{4}]}}",
                         side, k, k - 1, end, pack.pad);
        }
        if (k + 1 < pack.count) {
            through += fmt::format("front_pad{}, ", k + 1);
            back = fmt::format("rear_pad{}, ", k + 1) + back;
        }
        text.point(fmt::format("seat{}", k), 0, 0, -k * t);
        text.add(text.beams,
                 "leaf{}: {{bodies: [front{}, rear{}], through: {}seat{}, {}, segments: {}, E: {}, "
                 "G: {}, up: z,\n"
                 "    A: {}, I_y: {}, I_z: {}, J: {}}}",
                 k, k, k, through, k, back, segments[static_cast<std::size_t>(k)], E, G, w * t,
                 w * t * t * t / 12, t * w * w * w / 12, w * t * t * t / 3);
        if (k > 0)
            text.add(
                text.joints,
                "clamp{0}: {{type: fixed, bodies: [leaf0.seat0, leaf{0}.seat{0}], at: seat{0}}}",
                k);
    }
    text.add(text.joints, "eye: {{type: revolute, bodies: [front0, ground], at: front0, axis: y}}");
    text.add(text.joints,
             "shackle: {{type: in_plane, bodies: [rear0, ground], at: rear0, normal: z}}");
    text.force_up("push", "leaf0.seat0", "seat0", 1);
    return whole(
        text, family,
        fmt::format("{} leaves; for small loads the pressure between them follows from beams.",
                    pack.count),
        "leaf0.seat0", "seat0", pack.load);
}

// Cross-members run from rail to rail at the nodes 0, 1, ... Of four corners and the nodes inside all beams there are
// n = 2 + all segments - cross-members.
std::string ladder_frame(const Family& family) {
    const Frame f = frame(family.bodies);
    const int c = f.cross_members;
    std::vector<double> lengths{f.length, f.length};
    std::vector<int> least{c - 1, c - 1};
    for (int k = 0; k < c; ++k) lengths.push_back(f.width), least.push_back(1);
    const auto segments = shared_out(family.bodies - 2 + c, lengths, least);
    Text text;
    const auto node = [&](const char* side, int k) {
        return k == 0 || k == c - 1 ? fmt::format("{}{}", side, k)
                                    : fmt::format("rail_{0}.{0}{1}", side, k);
    };
    for (const auto& [side, sign] : {std::pair{"left", 1}, {"right", -1}}) {
        std::string through;
        for (int k = 0; k < c; ++k) {
            const std::string at = fmt::format("{}{}", side, k);
            text.point(at, f.length * k / (c - 1), sign * f.width / 2, 0);
            if (k == 0 || k == c - 1) text.body(at, at);
            through += (k == 0 ? "" : ", ") + at;
        }
        text.add(
            text.beams,
            "rail_{0}: {{bodies: [{0}0, {0}{1}], through: [{2}], segments: {3}, E: {4}, G: {5}, "
            "diameter: {6}, wall: "
            "{7}}}",
            side, c - 1, through, segments[sign > 0 ? 0 : 1], E, G, f.rail.diameter, f.rail.wall);
    }
    for (int k = 0; k < c; ++k)
        text.add(text.beams,
                 "cross{0}: {{bodies: [{1}, {2}], through: [left{0}, right{0}], segments: {3}, E: "
                 "{4}, G: "
                 "{5}, diameter: "
                 "{6}, wall: {7}}}",
                 k, node("left", k), node("right", k), segments[static_cast<std::size_t>(k) + 2], E,
                 G, f.cross.diameter, f.cross.wall);
    text.add(text.joints, "rear_left: {{type: spherical, bodies: [left0, ground], at: left0}}");
    text.add(text.joints,
             "rear_right: {{type: in_line, bodies: [right0, ground], at: right0, axis: y}}");
    text.add(text.joints,
             "front_left: {{type: in_plane, bodies: [left{0}, ground], at: left{0}, normal: z}}",
             c - 1);
    const std::string corner = fmt::format("right{}", c - 1);
    text.force_up("push", corner, corner, 1);
    return whole(text, family, fmt::format("{} cross-members; for small loads a grillage.", c),
                 corner, corner, f.load);
}

// ---- Links.

std::string axle(const Family& family) {
    const int n = family.bodies - 1, pairs = (n + 1) / 2;
    Text text;
    text.point("middle", 0, 0, 0);
    text.body("housing", "middle");
    for (int k = 0; k < n; ++k) {
        const double y = pairs == 1 ? 0 : width * (static_cast<double>(k / 2) / (pairs - 1) - 0.5);
        const std::string body = fmt::format("l{}", k + 1), at = fmt::format("p{}", k + 1),
                          end = fmt::format("e{}", k + 1);
        text.point(at, k % 2 == 0 ? link : -link, y, 0);
        text.point(end, 0, y, 0);
        text.body(body, at);
        text.hinge(family.hinge, fmt::format("h{}", k + 1), "ground", body, at, K_T / n, K_R / n);
        text.bushing(fmt::format("b{}", k + 1), body, "housing", end, K_T / n, K_R / n);
    }
    text.force_up("push", "housing", "middle", 1);
    return whole(text, family,
                 fmt::format("{} links{}.", n,
                             n % 2 == 0 ? ", which all move as one"
                                        : ", one more to the front than to the rear"),
                 "housing", "middle", load);
}

}  // namespace

std::string_view name(Kind kind) {
    constexpr std::array names{"chain", "tree", "grid", "leaf_spring", "ladder_frame", "axle"};
    return names[static_cast<std::size_t>(kind)];
}
std::string_view name(Hinge hinge) { return hinge == Hinge::bushing ? "bushing" : "revolute"; }
bool has_hinges(Kind kind) { return kind != Kind::leaf_spring && kind != Kind::ladder_frame; }

int min_bodies(Kind kind) {
    switch (kind) {
        case Kind::leaf_spring: return 3;   // a leaf of two segments
        case Kind::ladder_frame: return 4;  // the corners
        case Kind::axle: return 2;
        default: return 1;
    }
}

int levels(int bodies) {
    int m = 0;
    for (; bodies > 0; bodies /= 2) ++m;
    return m;
}

int rows(int bodies) {
    int R = static_cast<int>(std::sqrt(bodies));
    while (bodies % R != 0) --R;
    return R;
}

Leaves leaves(int bodies) {
    Leaves pack;
    pack.count = std::clamp((bodies + 1) / 4, 1, 5);
    pack.load = 500. * (pack.count + 1);  // as the rate of the pack grows
    return pack;
}

Frame frame(int bodies) {
    Frame f;
    f.cross_members = std::clamp(bodies / 3, 2, 5);
    return f;
}

std::string scene(const Family& family) {
    if (family.bodies < min_bodies(family.kind) || family.bodies > max_bodies)
        throw std::out_of_range(fmt::format("a {} has {} to {} bodies, not {}", name(family.kind),
                                            min_bodies(family.kind), max_bodies, family.bodies));
    if (!has_hinges(family.kind) && family.hinge != Hinge::bushing)
        throw std::invalid_argument(
            fmt::format("a {} is made of beams and has no joints to choose", name(family.kind)));
    switch (family.kind) {
        case Kind::chain: return chain(family);
        case Kind::tree: return tree(family);
        case Kind::grid: return grid(family);
        case Kind::leaf_spring: return leaf_spring(family);
        case Kind::ladder_frame: return ladder_frame(family);
        case Kind::axle: break;
    }
    return axle(family);
}

}  // namespace elastocheck::families
