#include "compare/deviation/proof.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elastocheck::compare {
namespace {

using reference::certificate::Extent;

void keep_largest(Extent& all, const Extent& one) {
    all = {std::max(all.length, one.length), std::max(all.angle, one.angle),
           std::max(all.force, one.force), std::max(all.moment, one.moment)};
}
void keep_least(Extent& all, const Extent& one) {
    all = {std::min(all.length, one.length), std::min(all.angle, one.angle),
           std::min(all.force, one.force), std::min(all.moment, one.moment)};
}

}  // namespace

void Tally::add(double load, Unit unit, const Certificate& certificate) {
    ++points;
    if (certificate.answer != Answer::proved) {
        ++(certificate.answer == Answer::excluded ? excluded : open);
        if (not_proved.empty())
            not_proved = fmt::format("{} at {:.6g} {}{}{}", name(certificate.answer),
                                     in_unit(unit) * load, symbol(unit),
                                     certificate.detail.empty() ? "" : ": ", certificate.detail);
        return;
    }
    ++proved;
    stable += certificate.stable;
    keep_largest(error, certificate.error);
    keep_least(unique, certificate.unique);
    held = std::max(held, certificate.held);
    gap = std::max(gap, certificate.gap);
    theorem = certificate.detail;
}

}  // namespace elastocheck::compare
