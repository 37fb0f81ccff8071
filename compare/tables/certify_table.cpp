// Table of the interval proofs.
#include <cmath>
#include <limits>
#include <numbers>

#include "compare/outputs/not_a_number.hpp"
#include "compare/proofs/certify.hpp"
#include "compare/tables/table.hpp"

namespace elastocheck::compare {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

}  // namespace

Table certify_table(const CertifyStudy& study) {
    Table table{
        "certify",
        {{"branch", "", "a way of a branch, from a = 0", true},
         {"solver", "", "whose points are proved", true},
         {"outcome", "", "how the solver ended", true},
         {"points", "", "looked at"},
         {"proved", "", "a true equilibrium is within the tolerance, and no other near it"},
         {"excluded", "", "there is provably none within the tolerance"},
         {"open", "", "neither could be shown"},
         {"stable", "", "of the proved: all stiffnesses positive in the whole box"},
         {"error", "mm", "of the proved: a body's origin is at most this far off"},
         {"angle error", "deg", "likewise its orientation"},
         {"force error", "N", "likewise a joint's reaction"},
         {"moment error", "N·m", "likewise, about the joint"},
         {"alone", "mm", "no other equilibrium is as near as this to a proved one"},
         {"held", "N, N·m", "what holds idle modes in the equilibria that are proved, at most"},
         {"gap", "mm, rad", "what redundant constraints stay open by in them, at most"},
         {"curve", "", "whether one connected curve of equilibria from start to end is proved",
          true},
         {"curve pieces", "", "of the tube around the path"},
         {"tube", "mm", "the curve is within this of the path"},
         {"limit", "", "whether the limit point that ends the path is proved", true},
         {"limit from", "", "it lies between this value of the branch's parameter ..."},
         {"limit to", "", "... and this"},
         {"remark", "", "the first point that is not proved; what the theorem says beyond", true}},
        {}};
    for (const CertifiedWay& way : study.ways) {
        const Tally& t = way.tally;
        const bool any = t.proved > 0;
        const auto where = [&](double value) { return any ? finite_or_nan(value) : nan; };
        std::string remark = way.detail;
        for (const std::string& also :
             {t.not_proved,
              way.curve && way.curve->answer != Answer::proved ? way.curve->detail : "", t.theorem})
            if (!also.empty()) remark += (remark.empty() ? "" : "; ") + also;
        table.rows.push_back({way.branch,
                              way.solver,
                              std::string(name(way.outcome)),
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
                              std::string(way.curve ? name(way.curve->answer) : ""),
                              way.curve ? double(way.curve->pieces) : nan,
                              way.curve ? finite_or_nan(1e3 * way.curve->width.length) : nan,
                              std::string(way.limit ? name(way.limit->answer) : ""),
                              way.limit ? finite_or_nan(in_unit(way.unit) * way.limit->from) : nan,
                              way.limit ? finite_or_nan(in_unit(way.unit) * way.limit->to) : nan,
                              remark});
    }
    return table;
}

}  // namespace elastocheck::compare
