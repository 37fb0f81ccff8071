// Table of the interval proofs.
#include <cmath>
#include <limits>
#include <numbers>

#include "compare/outputs/not_a_number.hpp"
#include "compare/proofs/certify.hpp"
#include "compare/tables/rows.hpp"

namespace elastocheck::compare {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

}  // namespace

Table certify_table(const CertifyStudy& study) {
    using enum Digits;
    const auto text = [](const char* name, const char* description, Digits digits = words) {
        return Column{name, "", description, true, digits};
    };
    Table table{
        {text("branch", "a side of a branch, from a = 0", hidden),
         text("solver", "whose points are tested"),
         text("outcome", "how the solver ended"),
         {"points", "", "looked at", false, whole},
         {"proved", "", "a true equilibrium is within the tolerance, and no other near it", false,
          whole},
         {"excluded", "", "there is provably none within the tolerance", false, whole},
         {"open", "", "neither could be shown", false, whole},
         {"stable", "", "of the proved points: all stiffnesses positive in the whole box", false,
          whole},
         {"error", "mm", "of the proved points: bound of the error of a body's origin", false, size,
          "off at most"},
         {"angle error", "deg", "likewise of its orientation", false, size, "at most"},
         {"force error", "N", "likewise of a joint's reaction force", false, size, "at most"},
         {"moment error", "N·m", "likewise of its moment, about the joint"},
         {"alone", "mm", "no other equilibrium is within this distance of a proved one", false,
          size, "alone within"},
         {"held", "N, N·m", "bound of the wrench that holds idle modes in the proved equilibria"},
         {"gap", "mm, rad", "bound of the gap of redundant constraints in them"},
         text("curve", "whether one connected curve of equilibria from start to end is proved"),
         {"curve pieces", "", "of the tube around the path", false, whole, "pieces"},
         {"tube", "mm", "the curve is within this of the path", false, size},
         text("limit", "whether the limit point that ends the path is proved"),
         {"limit from", "", "it lies between this value of the branch's parameter ..."},
         {"limit to", "", "... and this"},
         text("remark", "the first point that is not proved; further statements of the theorem",
              hidden)},
        {}};
    for (const CertifiedSide& side : study.sides) {
        const Tally& t = side.tally;
        const bool any = t.proved > 0;
        const auto where = [&](double value) { return any ? finite_or_nan(value) : nan; };
        std::string remark = side.detail;
        for (const std::string& also :
             {t.not_proved,
              side.curve && side.curve->answer != Answer::proved ? side.curve->detail : "",
              t.theorem})
            if (!also.empty()) remark += (remark.empty() ? "" : "; ") + also;
        table.rows.push_back(
            {side.branch,
             side.solver,
             std::string(name(side.outcome)),
             double(t.points),
             double(t.proved),
             double(t.excluded),
             double(t.open),
             double(t.stable),
             where(1e3 * t.error.length),
             where(degrees * t.error.angle),
             where(t.error.force),
             where(t.error.moment),
             where(1e3 * t.unique.length),
             where(t.held),
             where(1e3 * t.gap),
             std::string(side.curve ? name(side.curve->answer) : ""),
             side.curve ? double(side.curve->pieces) : nan,
             side.curve ? finite_or_nan(1e3 * side.curve->width.length) : nan,
             std::string(side.limit ? name(side.limit->answer) : ""),
             side.limit ? finite_or_nan(in_unit(side.unit) * side.limit->from) : nan,
             side.limit ? finite_or_nan(in_unit(side.unit) * side.limit->to) : nan,
             remark});
    }
    return table;
}

}  // namespace elastocheck::compare
