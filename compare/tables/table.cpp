#include "compare/tables/table.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/readings.hpp"

namespace elastocheck::compare {
namespace {

double count(auto number) { return static_cast<double>(number); }

Column words(const char* name, const char* description = "") {
    return {name, "", description, true};
}

// Calls sink(name of the reading, value) for both readings of a branch: over its parameter and its
// abscissa.
template <class T, class Sink>
void both(Unit unit, const std::string& abscissa, const T& at_parameter, const T& at_abscissa,
          Sink&& sink) {
    sink(parameter_reading(symbol(unit)), at_parameter);
    sink(abscissa_reading(abscissa), at_abscissa);
}

// A row of its first cells and of the last, which says why there are no others.
std::vector<Cell> without_values(const Table& table, std::vector<Cell> row,
                                 const std::string& why) {
    while (row.size() + 1 < table.columns.size())
        row.push_back(table.columns[row.size()].words ? Cell("") : Cell(nan));
    row.emplace_back(why);
    return row;
}

// Percentage; NaN where the whole is rounding, mm or deg.
double percent(double part, double whole) {
    return std::abs(whole) < 1e-9 ? nan : 100 * part / whole;
}

}  // namespace

Table channel_table(const std::vector<Channel>& channels) {
    Table table{"channels", {words("output"), words("unit"), words("definition")}, {}};
    for (const auto& c : channels) table.rows.push_back({c.name, symbol(c.unit), c.definition});
    return table;
}

Table settled_table(const std::vector<Channel>& channels, const std::vector<Settled>& settled) {
    Table table{"settled",
                {words("branch"),
                 words("outcome"),
                 words("output"),
                 words("unit"),
                 {"displacement", "",
                  "value at a = 0, settled under the static loads and held quantities, less its "
                  "value at the design position"}},
                {}};
    for (const auto& s : settled)
        for (std::size_t c = 0; c < channels.size(); ++c)
            if (channels[c].main)
                table.rows.push_back({s.branch, elastocheck::name(s.outcome), channels[c].name,
                                      symbol(channels[c].unit), s.displacement[c]});
    return table;
}

Table curve_table(const Comparison& comparison) {
    Table table{"curves",
                {words("branch"),
                 words("leg"),
                 {"a", "", "parameter of the branch"},
                 words("unit", "of a")},
                {}};
    for (const auto& c : comparison.channels)
        table.columns.push_back({c.name, symbol(c.unit), c.definition});
    for (const auto& branch : comparison.branches)
        for (const auto& run : branch.runs)
            for (std::size_t k = 0; k < run.curve.a.size(); ++k) {
                std::vector<Cell> row{branch.branch, name(run.leg), run.curve.a[k],
                                      symbol(run.curve.unit)};
                for (const double v : run.curve.values[k]) row.emplace_back(v);
                table.rows.push_back(std::move(row));
            }
    return table;
}

Table deviation_table(const Comparison& comparison) {
    Table table{"deviation",
                {words("branch"),
                 words("reading"),
                 words("output"),
                 words("unit"),
                 {"range", "", "of the equilibrium leg"},
                 {"deviation", "", "largest difference, recursion less equilibrium leg"},
                 {"where", "", "value of the parameter or abscissa there"},
                 words("where unit"),
                 {"end", "", "deviation at the last compared point"},
                 {"rms"},
                 {"compared", "", "numbers"},
                 {"references apart", "", "energy leg from equilibrium leg, at most"},
                 words("not compared", "why")},
                {}};
    for (const auto& branch : comparison.branches)
        both(branch.unit,
             branch.abscissa < 0
                 ? ""
                 : comparison.channels[static_cast<std::size_t>(branch.abscissa)].name,
             std::pair{&branch.deviation.equal_parameter, &branch.uncertainty.equal_parameter},
             std::pair{&branch.deviation.equal_abscissa, &branch.uncertainty.equal_abscissa},
             [&](const std::string& reading, const auto& found) {
                 const auto& [off, doubt] = found;
                 const bool parameter = off == &branch.deviation.equal_parameter;
                 const Unit where =
                     parameter || branch.abscissa < 0
                         ? branch.unit
                         : comparison.channels[static_cast<std::size_t>(branch.abscissa)].unit;
                 if (!off->not_compared.empty())
                     table.rows.push_back({branch.branch, reading, "", "", nan, nan, nan,
                                           symbol(where), nan, nan, 0.0, nan, off->not_compared});
                 for (std::size_t c = 0; c < off->channels.size(); ++c) {
                     if (!branch.determined[c]) continue;
                     const Deviation& d = off->channels[c];
                     table.rows.push_back(
                         {branch.branch, reading, comparison.channels[c].name,
                          symbol(comparison.channels[c].unit), d.range, d.signed_max, d.at,
                          symbol(where), d.end, d.rms, count(d.compared),
                          c < doubt->channels.size() ? doubt->channels[c].max : nan, ""});
                 }
             });
    return table;
}

Table agreement_table(const Comparison& comparison) {
    Table table{
        "agreement",
        {words("branch"),
         {"positions", "mm", "allowed difference of the references"},
         {"angles", "deg", "likewise"},
         {"forces", "N", "likewise"},
         {"moments", "N·m", "likewise"},
         {"balance", "N", "allowed residual of a reference's states in the other's equations"},
         {"constraints", "mm", "likewise"},
         {"objections", "", "how many"},
         words("worst", "in words")},
        {}};
    for (const auto& b : comparison.branches)
        table.rows.push_back({b.branch, b.bounds.length, b.bounds.angle, b.bounds.force,
                              b.bounds.moment, b.bounds.residual_force, b.bounds.residual_length,
                              count(b.inconclusive.count),
                              b.inconclusive.empty() ? "" : b.inconclusive.worst.front().what});
    return table;
}

Table force_table(const std::vector<ElementValue>& values) {
    Table table{"forces",
                {words("branch"),
                 {"end", "", "parameter there"},
                 words("end unit"),
                 words("element"),
                 words("output"),
                 words("unit"),
                 {"value", "", "of the equilibrium leg"},
                 {"error", "", "recursion less equilibrium leg, in the same unit"},
                 {"share", "%", "of the value"}},
                {}};
    for (const auto& v : values)
        table.rows.push_back({v.branch, v.a, symbol(v.a_unit), v.element, v.output, symbol(v.unit),
                              v.value, v.off, 100 * v.share});
    return table;
}

Table rate_table(const std::vector<RateError>& errors) {
    Table table{
        "wheel rate",
        {words("branch"),
         words("wheel"),
         {"end", "", "of the branch"},
         words("unit"),
         {"error", "%", "of the recursion's force over travel; positive: too stiff"},
         {"travel", "mm", "recursion less reference at that end"},
         {"jack force", "N", "likewise"},
         {"wheel rate", "N/mm", "of the reference, force over travel from the start to that end"},
         {"ride rate", "N/mm", "of wheel and tyre in series; empty without a tyre"},
         {"ride error", "%", "of the recursion's ride rate; positive: too stiff"}},
        {}};
    for (const auto& e : errors)
        table.rows.push_back({e.branch, e.wheel, e.to, symbol(e.unit), 100 * e.off, e.travel,
                              e.force, e.wheel_rate, e.ride_rate, 100 * e.ride_off});
    return table;
}

Table formulation_table(const FormulationStudy& study, const Comparison& comparison) {
    Table table{"formulations",
                {words("branch"),
                 words("output"),
                 words("unit"),
                 {"spread", "",
                  "largest less smallest value over the formulations, maximum over the branch"},
                 {"at", "", "parameter there"},
                 words("parameter unit"),
                 words("smallest by", "the formulation that gives the smallest value there"),
                 words("largest by", "likewise"),
                 {"references apart", "", "at most, at equal parameter"},
                 {"deviation", "",
                  "of the recursion from the equilibrium leg at equal parameter, at most"}},
                {}};
    const auto in = [&](const Reading& reading, const std::string& channel) {
        const int c = find_channel(comparison.channels, channel);
        return c < 0 || reading.channels.empty()
                   ? nan
                   : reading.channels[static_cast<std::size_t>(c)].max;
    };
    for (std::size_t b = 0; b < study.branches.size(); ++b)
        for (const auto& found : study.branches[b].outputs) {
            const Channel& channel = study.channels[found.channel];
            const BranchComparison& compared = comparison.branches[b];
            table.rows.push_back({study.branches[b].branch, channel.name, symbol(channel.unit),
                                  found.spread, found.at, symbol(study.branches[b].unit),
                                  found.lowest, found.highest,
                                  in(compared.uncertainty.equal_parameter, channel.name),
                                  in(compared.deviation.equal_parameter, channel.name)});
        }
    return table;
}

namespace {

std::string behaviour_words(const ChannelStudy& study) {
    std::string text = name(study.behaviour);
    if (study.behaviour == Behaviour::converging && study.zero_at_end)
        text += "; nearly zero at the end";
    return text;
}

}  // namespace

Table study_table(const Study& study) {
    Table table{"convergence",
                {words("branch"),
                 words("method"),
                 words("reading"),
                 words("output"),
                 words("unit"),
                 words("behaviour", "of the value with the largest step error on the branch"),
                 {"order", "", "at which the largest step error over the branch falls"},
                 {"order error", "", "its standard error"},
                 words("as formal", "the order agrees with the method's"),
                 {"limit", "", "own limit for infinitely many steps, at the end"},
                 {"band", "", "uncertainty of the limit"},
                 {"finest step error", "", "largest over the branch with the most steps"},
                 {"gap", "", "own limit less reference at the end"},
                 {"largest gap"},
                 {"rms gap"},
                 {"gap exponent", "", "power of the parameter or abscissa with which it grows"},
                 {"references apart"},
                 {"range", "", "of the reference over the branch"},
                 {"gap share", "%", "gap at the end, of the range"},
                 {"constraint order", "", "order at which |Φ| of eq. (31) decreases at the end"},
                 {"constraint order error", "", "its standard error"},
                 words("not studied", "why")},
                {}};
    for (const auto& branch : study.branches)
        for (const auto& m : branch.methods)
            both(branch.unit, branch.abscissa, m.equal_parameter, m.equal_abscissa,
                 [&](const std::string& reading, const std::vector<ChannelStudy>& found) {
                     const OrderFit& Phi = m.constraint_order;
                     if (found.empty()) {
                         auto row =
                             without_values(table, {branch.branch, m.method, reading},
                                            m.not_studied.empty() ? m.no_abscissa : m.not_studied);
                         row.end()[-3] = Phi.order, row.end()[-2] = Phi.order_error;
                         table.rows.push_back(std::move(row));
                     }
                     for (std::size_t c = 0; c < found.size(); ++c) {
                         const ChannelStudy& s = found[c];
                         table.rows.push_back({branch.branch,
                                               m.method,
                                               reading,
                                               study.channels[c].name,
                                               symbol(study.channels[c].unit),
                                               behaviour_words(s),
                                               s.order.order,
                                               s.order.order_error,
                                               s.as_formal ? "yes" : "",
                                               s.end.limit,
                                               s.end.band,
                                               s.step_error_max.back(),
                                               s.gap,
                                               s.gap_max,
                                               s.gap_rms,
                                               s.gap_exponent,
                                               s.uncertainty,
                                               s.range,
                                               percent(s.gap, s.range),
                                               Phi.order,
                                               Phi.order_error,
                                               ""});
                     }
                 });
    return table;
}

Table step_table(const Study& study) {
    Table table{"step error",
                {words("branch"),
                 words("method"),
                 words("reading"),
                 words("output"),
                 words("unit"),
                 {"steps"},
                 words("outcome"),
                 {"end", "", "value less own limit at the end"},
                 {"largest"},
                 {"rms"},
                 {"error", "", "value less reference at the end: step error and gap"},
                 {"constraint error", "m", "or rad: |Φ| at the end, eq. (31)"}},
                {}};
    for (const auto& branch : study.branches)
        for (const auto& m : branch.methods)
            both(branch.unit, branch.abscissa, m.equal_parameter, m.equal_abscissa,
                 [&](const std::string& reading, const std::vector<ChannelStudy>& found) {
                     const auto row = [&](std::size_t l, const std::string& output,
                                          const std::string& unit,
                                          const std::array<double, 4>& error) {
                         table.rows.push_back({branch.branch, m.method, reading, output, unit,
                                               count(branch.steps[l]),
                                               elastocheck::name(m.outcomes[l]), error[0], error[1],
                                               error[2], error[3], m.constraint_error[l]});
                     };
                     if (found.empty())
                         for (std::size_t l = 0; l < branch.steps.size(); ++l)
                             row(l, "", "", {nan, nan, nan, nan});
                     for (std::size_t c = 0; c < found.size(); ++c)
                         for (std::size_t l = 0; l < branch.steps.size(); ++l)
                             row(l, study.channels[c].name, symbol(study.channels[c].unit),
                                 {found[c].step_error_end[l], found[c].step_error_max[l],
                                  found[c].step_error_rms[l],
                                  found[c].step_error_end[l] + found[c].gap});
                 });
    return table;
}

Table gap_table(const std::vector<Channel>& main,
                const std::vector<BranchAttribution>& attribution) {
    Table table{"gap",
                {words("branch"),
                 words("reading"),
                 words("output"),
                 words("unit"),
                 {"whole", "", "gap of the recursion in which forces do not follow the bodies"},
                 {"lever", "", "contribution of the lever of the stored force"},
                 {"axis", "", "contribution of its axis and law"},
                 {"load", "", "contribution of the lever of the load"},
                 {"rest", "", "remaining gap when all three follow: 0 within the band"},
                 {"band"},
                 {"lever share", "%", "of the whole"},
                 {"axis share", "%", "likewise"},
                 {"load share", "%", "likewise"}},
                {}};
    // In the order of GapShare::combinations.
    for (const char* follows : {"nothing", "lever", "axis", "lever and axis", "load",
                                "lever and load", "axis and load", "lever, axis and load"})
        table.columns.push_back({std::string("gap, following: ") + follows});
    table.columns.push_back(words("not attributed", "why"));
    for (const auto& branch : attribution)
        both(branch.unit, branch.abscissa, branch.equal_parameter, branch.equal_abscissa,
             [&](const std::string& reading, const std::vector<GapShare>& found) {
                 if (found.empty())
                     table.rows.push_back(without_values(table, {branch.branch, reading},
                                                         branch.not_attributed.empty()
                                                             ? branch.no_abscissa
                                                             : branch.not_attributed));
                 for (std::size_t c = 0; c < found.size(); ++c) {
                     const GapShare& s = found[c];
                     std::vector<Cell> row{branch.branch,
                                           reading,
                                           main[c].name,
                                           symbol(main[c].unit),
                                           s.whole,
                                           s.lever,
                                           s.axis,
                                           s.load,
                                           s.rest,
                                           s.band,
                                           percent(s.lever, s.whole),
                                           percent(s.axis, s.whole),
                                           percent(s.load, s.whole)};
                     row.insert(row.end(), s.combinations.begin(), s.combinations.end());
                     row.emplace_back("");
                     table.rows.push_back(std::move(row));
                 }
             });
    return table;
}

Table order_table(const std::vector<BranchOrders>& orders) {
    Table table{"orders",
                {words("branch"),
                 {"told", "m"},
                 {"order"},
                 words("outcome"),
                 {"expansions"},
                 {"rejected"},
                 {"factorisations"},
                 {"solves"},
                 {"evaluations"},
                 {"error", "mm", "from the equilibrium leg, largest over all points"},
                 {"angle error", "deg", "likewise"},
                 {"residual", "N", "or N·m: largest residual of an expansion in the balance"},
                 {"error at ends", "m", "largest at the end of an expansion, as it estimates it"},
                 {"first reach", "", "of the first expansion, share of the branch"},
                 {"references apart", "mm"},
                 {"references' angles apart", "deg"},
                 {"singularity", "",
                  "distance of the nearest, seen from the start, in lengths of the branch"},
                 {"its angle", "rad", "direction"},
                 {"its misfit", "", "relative residual of the fit to the coefficients"},
                 words("not compared", "why")},
                {}};
    for (const auto& branch : orders)
        for (const auto& l : branch.levels)
            table.rows.push_back({branch.branch,
                                  l.tolerance,
                                  count(l.order),
                                  elastocheck::name(l.outcome),
                                  count(l.expansions),
                                  count(l.rejected),
                                  count(l.work.factorisations),
                                  count(l.work.solves),
                                  count(l.work.evaluations),
                                  l.error.mm,
                                  l.error.deg,
                                  l.force,
                                  l.error_end,
                                  l.first_reach,
                                  branch.uncertainty.mm,
                                  branch.uncertainty.deg,
                                  l.nearest.radius,
                                  l.nearest.angle,
                                  l.nearest.misfit,
                                  branch.failure});
    return table;
}

Table precision_table(const PrecisionStudy& study) {
    Table table{"precision",
                {words("method"),
                 words("arithmetic"),
                 {"steps"},
                 words("outcome"),
                 {"constraint error", "m", "or rad: |Φ| at the end, eq. (31)"},
                 {"error", "mm"},
                 {"angle error", "deg"}},
                {}};
    for (const auto& series : study.series)
        for (const auto& l : series.levels)
            table.rows.push_back({series.method, name(series.precision), count(l.steps),
                                  elastocheck::name(l.outcome), l.constraint, l.error.mm,
                                  study.angles ? l.error.deg : nan});
    return table;
}

Table floor_table(const PrecisionStudy& study) {
    Table table{"floors",
                {words("method"),
                 words("arithmetic"),
                 {"least constraint error", "m", "or rad: |Φ| over the steps"},
                 {"steps that lower it", "", "no larger number of steps reduces it below a third"},
                 words("constraint remark"),
                 {"least error", "mm"},
                 {"steps that lower the error", "", "likewise"},
                 words("error remark")},
                {}};
    const auto steps = [](const Floor& floor) {
        return floor.useful_steps > 0 ? floor.useful_steps : nan;
    };
    const auto remark = [](const Floor& floor, bool by_reference) {
        return floor.useful_steps == 0           ? "no number"
               : !floor.reached                  ? "more steps still help"
               : by_reference && floor.reference ? "at the reference uncertainty"
                                                 : "";
    };
    for (const auto& s : study.series)
        table.rows.push_back({s.method, name(s.precision), s.constraint.least, steps(s.constraint),
                              remark(s.constraint, false), s.mm.least, steps(s.mm),
                              remark(s.mm, true)});
    return table;
}

Table trade_table(const Trade& trade) {
    Table table{
        "trade",
        {words("leg"),
         words("method"),
         {"steps", "", "per branch; none if the method chooses them"},
         {"told", "m", "if the method chooses its steps"},
         words("outcome"),
         {"error", "mm"},
         {"angle error", "deg"},
         {"share", "", "of the tolerance"},
         {"solves"},
         {"factorisations"},
         {"evaluations"},
         {"price", "", "in back-substitutions: N/3 · factorisations + solves + evaluations"},
         {"time", "s", "median over the rounds"},
         {"time ratio", "", "to the equilibrium leg"},
         words("front",
               "no other is as accurate with s: fewer solves, f: fewer factorisations + "
               "evaluations, t: less time"),
         words("not ranked", "why"),
         words("recommended"),
         words("detail", "of the outcome")},
        {}};
    for (std::size_t k = 0; k < trade.points.size(); ++k) {
        const TradePoint& p = trade.points[k];
        const bool chosen = trade.recommendation && trade.recommendation->point == k;
        std::string front;
        for (std::size_t kind = 0; kind < p.on_front.size(); ++kind)
            if (p.on_front[kind]) front += "sft"[kind];
        table.rows.push_back(
            {name(p.leg), p.method, p.steps > 0 ? count(p.steps) : nan,
             p.own_tolerance > 0 ? p.own_tolerance : nan, elastocheck::name(p.outcome), p.error.mm,
             trade.angles ? p.error.deg : nan, p.share, count(p.work.solves),
             count(p.work.factorisations), count(p.work.evaluations), p.work.price, p.work.seconds,
             p.ratio, front, p.not_ranked, chosen ? "yes" : "", p.detail});
    }
    return table;
}

}  // namespace elastocheck::compare
