// Merges bodies held together by Fixed joints.
//
// Points s, directions u and marker axes A_local of a body b that is fixed to body c are, as fixed in
// c, with r, A the design poses,
//
//   s_c = A_cᵀ (r_b + A_b s_b - r_c)      u_c = A_cᵀ A_b u_b      A_local,c = A_cᵀ A_b A_local,b
#include <numeric>

#include "models/compile/parts.hpp"
#include "models/compile/passes.hpp"
#include "models/near.hpp"

namespace elastocheck::reduce {
namespace {

bool is_as_drawn(const Fixed& s, const Scene& scene) {
    const auto same = [&](const Vector3& a, const Vector3& b) {
        return are_near(a, b, design_tolerance);
    };
    return same(position(scene, s.i), position(scene, s.j)) &&
           same(direction(scene, s.x_i), direction(scene, s.x_j)) &&
           same(direction(scene, s.y_i), direction(scene, s.y_j));
}

// Disjoint sets of merged bodies (union-find), represented by their first; ground is number 0, body b is b + 1.
// A body with a wheel or a probe is not merged into ground; an end of a damper or of a steering axis may be.
class Sets {
  public:
    explicit Sets(const Scene& scene)
        : first_(scene.bodies.size() + 1), has_output_(scene.bodies.size() + 1) {
        std::iota(first_.begin(), first_.end(), std::size_t{0});
        for (const Wheel& wheel : scene.wheels)
            has_output_[number(wheel.body)] = has_output_[number(wheel.contact.body)] = true;
        for (const Probe& probe : scene.probes) has_output_[number(probe.at.body)] = true;
    }
    BodyId first(BodyId body) { return static_cast<BodyId>(find(number(body))) - 1; }
    // False, and nothing is merged, where ground would take in a wheel or a probe.
    bool unite(BodyId a, BodyId b) {
        const std::size_t low = std::min(find(number(a)), find(number(b)));
        const std::size_t high = std::max(find(number(a)), find(number(b)));
        if (low == 0 && has_output_[high]) return false;
        first_[high] = low;
        has_output_[low] = has_output_[low] || has_output_[high];
        return true;
    }

  private:
    static std::size_t number(BodyId body) { return static_cast<std::size_t>(body + 1); }
    std::size_t find(std::size_t n) {
        while (first_[n] != n) n = first_[n] = first_[first_[n]];
        return n;
    }
    std::vector<std::size_t> first_;
    std::vector<bool> has_output_;
};

// Expresses members of kinds in the axes of the body that represents their own.
struct ToRepresentative {
    const Scene& scene;
    Sets& sets;

    void operator()(BodyId& body) const { body = sets.first(body); }
    void operator()(Point& p) const {
        const BodyId c = sets.first(p.body);
        if (c == p.body) return;
        const Pose to = design(scene, c);
        p = {c, to.p.conjugate() * (position(scene, p) - to.r)};
    }
    void operator()(Direction& u) const {
        const BodyId c = sets.first(u.body);
        if (c != u.body) u = {c, design(scene, c).p.conjugate() * direction(scene, u)};
    }
    void operator()(Marker& m) const {
        const BodyId c = sets.first(m.body);
        if (c == m.body) return;
        Point origin{m.body, m.s_local};
        (*this)(origin);
        m = {c, origin.s_local,
             (design(scene, c).p.conjugate() * design(scene, m.body).p * m.A_local).normalized()};
    }
    void operator()(LoadVector<Vector3> v) const {
        Direction u{v.axes, v.value};
        (*this)(u);
        v.value = u.u_local;
    }
    void operator()(Wheel& wheel) const {
        Point centre{wheel.body, wheel.centre_local};
        Direction spin{wheel.body, wheel.spin_axis_local};
        (*this)(centre);
        (*this)(wheel.contact);
        (*this)(spin);
        wheel.spin_axis_local = spin.u_local;
        wheel.centre_local = centre.s_local;
        wheel.body = centre.body;
        if (auto& axis = wheel.steering_axis)
            for (Point* point : {&axis->lower, &axis->upper}) (*this)(*point);
    }
};

// Lists a load on a body merged into ground, where it moves nothing, as omitted; returns whether it did.
bool leave_out_if_on_ground(Scene& scene, const Load& load, Sets& sets, const std::string& where) {
    const BodyId body = body_of(load.kind);
    if (body == ground || sets.first(body) != ground) return false;
    leave_out(scene, named("load", load.name), named(scene, body) + " is welded to ground" + where);
    return true;
}

}  // namespace

void weld(Scene& scene) {
    Sets sets(scene);
    Kept kept(scene);
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
        const auto* fixed = std::get_if<Fixed>(&scene.joints[k].kind);
        if (fixed == nullptr || scene.joints[k].active_only_where_driven ||
            !is_as_drawn(*fixed, scene))
            continue;
        if (!sets.unite(fixed->i.body, fixed->j.body)) continue;
        kept.joints[k] = false;
        leave_out(
            scene, named("joint", scene.joints[k].name),
            "the bodies that it fixes to each other become one; its reaction is not an output");
    }
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        const BodyId first = sets.first(static_cast<BodyId>(b));
        if (first == static_cast<BodyId>(b)) continue;
        kept.bodies[b] = false;
        leave_out(scene, named("body", scene.bodies[b].name),
                  "fixed to " + named(scene, first) +
                      (first == ground ? "" : ", with which it becomes one body"));
    }

    std::erase_if(scene.static_loads,
                  [&](const Load& load) { return leave_out_if_on_ground(scene, load, sets, ""); });
    for (Branch& branch : scene.branches)
        std::erase_if(branch.drivers, [&](const Driver& driver) {
            const Load* load = driven_load(driver.what);
            return load != nullptr &&
                   leave_out_if_on_ground(scene, *load, sets, " (branch '" + branch.name + "')");
        });
    const ToRepresentative express{scene, sets};
    for (Joint& joint : scene.joints) each_member(joint.kind, express);
    for (Elastic& elastic : scene.elastics) each_member(elastic.kind, express);
    each_load(scene, [&](LoadKind& load) { each_member(load, express); });
    for (Wheel& wheel : scene.wheels) express(wheel);
    for (Probe& probe : scene.probes) express(probe.at);
    for (Damper& damper : scene.dampers)
        for (Point* end : {&damper.i, &damper.j}) express(*end);
    keep_only(scene, kept);
}

}  // namespace elastocheck::reduce
