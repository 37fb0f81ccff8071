#include "compare/deviation/proof.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elastocheck::compare {
namespace {

using reference::certificate::Extent;

void keep_largest(ProvedBound& all, const Extent& one) {
    all = {std::max(all.length, one.length), std::max(all.angle, one.angle),
           std::max(all.force, one.force), std::max(all.moment, one.moment)};
}
void keep_smallest(ProvedBound& all, const Extent& one) {
    all = {std::min(all.length, one.length), std::min(all.angle, one.angle),
           std::min(all.force, one.force), std::min(all.moment, one.moment)};
}

}  // namespace

void add(Tally& tally, double load, Unit unit, const Certificate& certificate) {
    ++tally.points;
    if (certificate.state != ProofState::proved) {
        ++(certificate.state == ProofState::excluded ? tally.excluded : tally.open);
        if (tally.not_proved.empty())
            tally.not_proved = fmt::format(
                "{} at {:.6g} {}{}{}", name(certificate.state), in_unit(unit) * load, symbol(unit),
                certificate.detail.empty() ? "" : ": ", certificate.detail);
        return;
    }
    ++tally.proved;
    tally.stable += certificate.stable;
    keep_largest(tally.error, certificate.error);
    keep_smallest(tally.unique, certificate.unique);
    tally.held = std::max(tally.held, certificate.held);
    tally.gap = std::max(tally.gap, certificate.gap);
    tally.theorem = certificate.detail;
}

}  // namespace elastocheck::compare
