#include <fmt/format.h>

#include "models/reader/sections.hpp"

namespace elastocheck::reader {
namespace {

// ℓ₀ [m]. The force at the design length ℓ is k (ℓ - ℓ₀), so a preload P, compression positive, means ℓ₀ = ℓ
// + P / k.
double free_length(const Cursor& spring, double length, double k, const Units& units) {
    const auto given = spring.optional("free_length");
    const auto preload = spring.optional("preload");
    if (given && preload) preload->fail("given together with free_length; allowed: one of the two");
    if (given) {
        const double l0 = units.length.si(given->number(units.length.name));
        if (!(l0 > 0)) given->fail(fmt::format("{} is not a length; allowed: above zero", given->found()));
        return l0;
    }
    if (!preload) return length;
    const double p = units.force.si(preload->number(units.force.name));
    if (k == 0) preload->fail("a spring of zero rate has no preload; leave it out or give a rate");
    const double l0 = length + p / k;
    if (!(l0 > 0))
        preload->fail(fmt::format("needs a free length of {:g} {}; a free length must be above zero",
                                  l0 * units.length.divide, units.length.name));
    return l0;
}

}  // namespace

Elastic read_spring(const std::string& name, const Cursor& at, const Definitions& defs) {
    at.only_keys({"bodies", "from", "to", "rate", "free_length", "preload"});
    const auto [i, j] = body_pair(at.require("bodies"), defs);
    const Eigen::Vector3d from = hardpoint(at.require("from"), defs), to = hardpoint(at.require("to"), defs);
    const double length = (to - from).norm();
    if (!(length > coincident)) at.require("to").fail("the same position as `from`; a spring needs a length");
    const double k = rate(at.require("rate"), defs.units.rate);
    return {name, AxialSpring{.i = point_of(i, from, defs),
                              .j = point_of(j, to, defs),
                              .law = LinearRate{k},
                              .free_length = free_length(at, length, k, defs.units)}};
}

}  // namespace elastocheck::reader
