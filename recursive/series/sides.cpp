#include "recursive/series/sides.hpp"

#include <algorithm>

#include "models/overloaded.hpp"

namespace elastocheck::recursive::series {
namespace {

bool same(const LoadKind& a, const LoadKind& b) {
    return std::visit(
        overloaded{
            [](const DeadForce& x, const DeadForce& y) {
                return x.at.body == y.at.body && x.at.s_local == y.at.s_local && x.f == y.f;
            },
            [](const DeadMoment& x, const DeadMoment& y) { return x.body == y.body && x.m == y.m; },
            [](const FollowerForce& x, const FollowerForce& y) {
                return x.at.body == y.at.body && x.at.s_local == y.at.s_local &&
                       x.f_local == y.f_local;
            },
            [](const FollowerMoment& x, const FollowerMoment& y) {
                return x.body == y.body && x.m_local == y.m_local;
            },
            [](const BrakeForce& x, const BrakeForce& y) {
                return x.body == y.body && x.patch.body == y.patch.body &&
                       x.patch.s_local == y.patch.s_local && x.f == y.f;
            },
            [](const auto&, const auto&) { return false; }},
        a, b);
}

bool is_same(const elastocheck::Driven& a, const elastocheck::Driven& b) {
    return std::visit(
        overloaded{[](const Load& l, const Load& m) { return same(l.kind, m.kind); },
                   [](const Motion& m, const Motion& n) { return m.joint == n.joint; },
                   [](const FreeLength& f, const FreeLength& g) { return f.elastic == g.elastic; },
                   [](const Preload& p, const Preload& r) {
                       return p.elastic == r.elastic && p.direction == r.direction;
                   },
                   [](const auto&, const auto&) { return false; }},
        a, b);
}

}  // namespace

bool same_drivers(const Branch& a, const Branch& b) {
    return std::ranges::equal(a.drivers, b.drivers, [](const Driver& x, const Driver& y) {
        return x.start == y.start && x.rate == y.rate && is_same(x.what, y.what);
    });
}

bool same_values(std::span<const Driver> a, std::span<const Driver> b) {
    return std::ranges::equal(a, b, [](const Driver& x, const Driver& y) {
        return x.start == y.start && is_same(x.what, y.what);
    });
}

}  // namespace elastocheck::recursive::series
