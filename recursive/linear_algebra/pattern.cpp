#include "recursive/linear_algebra/pattern.hpp"

#include <algorithm>
#include <array>

#include "models/kinds.hpp"

namespace elastocheck::recursive {
namespace {

using Mask = std::array<bool, 3>;  // components of a vector that are structural non-zeros
constexpr Mask none{false, false, false}, all{true, true, true};

Mask mask(BodyId body, const Eigen::Vector3d& fixed) {
    if (body != ground) return fixed.isZero(0) ? none : all;
    return {fixed.x() != 0, fixed.y() != 0, fixed.z() != 0};
}
// u × v for any direction u.
Mask cross(const Mask& v) { return {v[1] || v[2], v[2] || v[0], v[0] || v[1]}; }
Mask both(const Mask& u, const Mask& v) { return {u[0] || v[0], u[1] || v[1], u[2] || v[2]}; }
bool has_lever(const Point& point) { return point.body == ground || !point.s_local.isZero(0); }

// Structural entries of the full matrix, both halves.
struct Entries {
    int n;                                 // 6nb
    std::vector<std::vector<int>> column;  // rows of each column, unsorted [6nb + m]

    void entry(int i, int j) {
        column[static_cast<std::size_t>(j)].push_back(i);
        column[static_cast<std::size_t>(i)].push_back(j);
    }
    // The halves of a body: start of Δr and of Δπ, -1 for ground.
    static int r(BodyId b) { return b == ground ? -1 : 6 * b; }
    static int pi(BodyId b) { return b == ground ? -1 : 6 * b + 3; }
    void block(int a, int b) {
        if (a < 0 || b < 0) return;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) entry(a + i, b + j);
    }
    void row(int k, int half, const Mask& m) {
        if (half < 0) return;
        for (int c = 0; c < 3; ++c)
            if (m[static_cast<std::size_t>(c)]) entry(n + k, half + c);
    }
    // Entries of a force that depends on all of these halves and acts on all of them.
    void couple(const std::vector<int>& halves) {
        for (const int a : halves)
            for (const int b : halves) block(a, b);
    }
};

// A force between points depends on the positions and on the levers that are not zero. Between
// markers it rotates with the frame in i, and its lever reaches to p_j: it depends on all halves.
void add_entries(Entries& t, const ElasticKind& element) {
    std::vector<int> halves;
    each_member(element, overloaded{[&](const Point& p) {
                                        halves.push_back(t.r(p.body));
                                        if (has_lever(p)) halves.push_back(t.pi(p.body));
                                    },
                                    [&](const Marker& m) {
                                        halves.insert(halves.end(), {t.r(m.body), t.pi(m.body)});
                                    }});
    t.couple(halves);
}

// Sorts and removes duplicates.
void sort_once(std::vector<int>& numbers) {
    std::ranges::sort(numbers);
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

// Rows of Φ from k on, and the curvature of the constraint.
void add_entries(Entries& t, const CoincidentPoints& c, int k) {
    for (int row = 0; row < 3; ++row) {
        Mask n = none;
        n[static_cast<std::size_t>(row)] = true;
        for (const Point& point : {c.i, c.j}) {
            t.row(k + row, t.r(point.body), n);
            if (has_lever(point)) t.row(k + row, t.pi(point.body), cross(n));
        }
    }
    for (const Point& point : {c.i, c.j})
        if (has_lever(point)) t.block(t.pi(point.body), t.pi(point.body));
}
void add_entries(Entries& t, const PointInPlane& c, int k) {
    const Mask n = mask(c.normal_j.body, c.normal_j.u_local);
    const int r_i = t.r(c.i.body), pi_i = has_lever(c.i) ? t.pi(c.i.body) : -1, r_j = t.r(c.j.body),
              pi_j = t.pi(c.j.body);
    t.row(k, r_i, n);
    t.row(k, pi_i, cross(n));
    t.row(k, r_j, n);
    t.row(k, pi_j, cross(n));
    t.block(pi_i, pi_i);
    for (const int half : {r_i, pi_i, r_j, pi_j}) t.block(half, pi_j);
}
void add_couple(Entries& t, BodyId i, BodyId j, const Mask& u_i, const Mask& u_j, int k) {
    for (const BodyId b : {i, j}) {
        // u_i × u_j: one of them is fixed in a moving body and may have any direction.
        t.row(k, t.pi(b), i == ground ? cross(u_i) : j == ground ? cross(u_j) : all);
        t.block(t.pi(b), t.pi(i));
        t.block(t.pi(b), t.pi(j));
    }
}
void add_entries(Entries& t, const PerpendicularDirections& c, int k) {
    add_couple(t, c.i.body, c.j.body, mask(c.i.body, c.i.u_local), mask(c.j.body, c.j.u_local), k);
}
void add_entries(Entries& t, const DistanceBetween& c, int k) {
    for (const Point& point : {c.i, c.j}) {
        t.row(k, t.r(point.body), all);
        if (has_lever(point)) t.row(k, t.pi(point.body), all);
    }
    t.couple({t.r(c.i.body), has_lever(c.i) ? t.pi(c.i.body) : -1, t.r(c.j.body),
              has_lever(c.j) ? t.pi(c.j.body) : -1});
}
void add_entries(Entries& t, const DirectionAtAngle& c, int k) {
    add_couple(t, c.i.body, c.j.body, mask(c.i.body, c.i.u_local),
               both(mask(c.j.body, c.j.u_local), mask(c.y_j.body, c.y_j.u_local)), k);
}

}  // namespace

Pattern pattern(const Model& model) {
    const int n = coordinates(model), size = n + constraint_rows(model);
    Entries t{n, std::vector<std::vector<int>>(static_cast<std::size_t>(size))};
    for (BodyId b = 0; b < n / 6; ++b) t.block(t.pi(b), t.pi(b));  // a load on the body
    for (const auto& elastic : model.elastics) add_entries(t, elastic.kind);
    const auto add_load = [&](const LoadKind& load) {
        std::visit(
            overloaded{
                [](const DeadForce&) {},
                [](const DeadMoment&) {},
                // The force rotates with its body.
                [&](const FollowerForce& f) { t.block(t.r(f.at.body), t.pi(f.at.body)); },
                [](const FollowerMoment&) {},
                // The moment depends on the positions of the carrier and the patch.
                [&](const BrakeForce& f) {
                    for (const int half : {t.r(f.body), t.r(f.patch.body), t.pi(f.patch.body)})
                        t.block(t.pi(f.body), half);
                },
            },
            load);
    };
    for (const auto& load : model.static_loads) add_load(load.kind);
    for (const auto& branch : model.branches)
        for (const auto& driver : branch.drivers)
            if (const Load* load = driven_load(driver.what)) add_load(load->kind);
    int row = 0;
    for (const auto& constraint : model.constraints) {
        std::visit([&](const auto& c) { add_entries(t, c, row); }, constraint.kind);
        row += rows(constraint.kind);
    }
    Pattern result{size, {}, {}};
    for (auto& rows : t.column) {
        result.first.push_back(static_cast<int>(result.row.size()));
        sort_once(rows);
        result.row.insert(result.row.end(), rows.begin(), rows.end());
    }
    result.first.push_back(static_cast<int>(result.row.size()));
    return result;
}

SaddleMatrix<double> saddle_matrix(const Model& model) {
    SaddleMatrix<double> M{coordinates(model), constraint_rows(model), {}, {}, {}, {}};
    std::vector<std::vector<BodyId>> neighbours(model.bodies.size());
    const auto connect = [&](BodyId i, BodyId j) {
        if (i == ground || j == ground || i == j) return;
        neighbours[static_cast<std::size_t>(i)].push_back(j);
        neighbours[static_cast<std::size_t>(j)].push_back(i);
    };
    for (const auto& elastic : model.elastics) {
        const auto [i, j] = ends(elastic.kind);
        connect(i, j);
    }
    for (const auto& constraint : model.constraints) {
        const auto [i, j] = ends(constraint.kind);
        connect(i, j);
        M.ends.insert(M.ends.end(), static_cast<std::size_t>(rows(constraint.kind)), {i, j});
    }
    for (auto& bodies : neighbours) {
        M.first.push_back(static_cast<int>(M.neighbour.size()));
        sort_once(bodies);
        M.neighbour.insert(M.neighbour.end(), bodies.begin(), bodies.end());
    }
    M.first.push_back(static_cast<int>(M.neighbour.size()));
    M.values.assign(static_cast<std::size_t>(M.part_at(M.m, 0)), 0);
    return M;
}

}  // namespace elastocheck::recursive
