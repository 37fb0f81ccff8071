// Diagnosis of wrong columns: signs, units, reference positions and exchanged columns.
//
// A column v that deviates from its reference r is tested against transformations, the simplest
// first; the first one that makes it right is reported:
//
//   v = -r     v = r + c     v = f r     v = r_0 + f (r - r_0)     v = -r + c     v = f r + c
//   v = ± another output
//   v = f d + c, d the figure by another definition, f a sign or a unit; all that apply
//
// with f a unit factor, or fitted; c the mean of the remaining difference; r_0 the value at the
// start of the branch. Right means: at most a twentieth of the deviation remains, and at most the
// tolerance or a thousandth of the range of the reference. A factor has to reproduce the column
// itself as well: at most a twentieth of its largest value remains, and together with an offset,
// from r_0 or of a definition, at most a twentieth of its range. Else a small factor and an offset
// would make any curve right for a column that hardly moves. If none applies, the column may be
// right up to a point.
//
// A transformation that makes the column right by accident is not an explanation. The information
// in a column is the number of coefficients of the polynomial that describes it as well as the
// transformation does (at most one per point): two for a straight line, however many points it has.
// Each coefficient that does not serve to fit an offset or a factor agrees by accident with a
// probability of about 2 left / range, where `left` is the remaining deviation. Of m
// transformations tried, one is right by accident with a probability of about
//
//   m (2 left / range)^(coefficients - fitted)
//
// and is accepted only if this is at most a hundredth. Where nothing is fitted, one coefficient is
// the level of the column, and its range is the largest value. Another definition as it stands is
// as simple as the figure: m counts such definitions alone. A column that is written with few
// decimals may be off by half of its last one.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "compare/candidate/candidate.hpp"
#include "compare/deviation/tolerance.hpp"
#include "models/eigen/dense.hpp"

namespace elastocheck::compare {
namespace {

using Kind = Explanation::Kind;
using Values = std::vector<double>;

// Largest remaining deviation, as a share of three things: the deviation, the range of the column (see
// above), the range of the reference.
constexpr double share_of_deviation = 0.05, share_of_column = 0.05, share_of_reference = 1e-3;
// wrong_from(): the first tenth of the points of a branch or more must be right, to a thousandth of the
// largest deviation. A tenth of the branch further on the deviation must exceed 0.03 of the largest:
// one that grows as a power up to the sixth is below 0.01 there, and such a column was never right.
constexpr double min_right_part = 0.1, right_to = 1e-3, min_jump = 0.03;
// A definition replaces a simpler explanation where it leaves at most a hundredth of the deviation that
// this leaves, unless this is rounding, a millionth of the range.
constexpr double much_better = 0.01, rounding_of_range = 1e-6;

constexpr double max_accident = 0.01;  // probability
constexpr int max_coefficients = 5;    // counted per branch

struct UnitConfusion {
    double factor;
    const char* word;
};
constexpr double pi = std::numbers::pi;
// Possible unit confusions: column in a wrong unit = factor · column in the assumed unit.
constexpr std::array units{UnitConfusion{1e-3, "metres for millimetres, or the like"},
                           UnitConfusion{1e3, "millimetres for metres, or the like"},
                           UnitConfusion{0.1, "centimetres for millimetres"},
                           UnitConfusion{10, "millimetres for centimetres"},
                           UnitConfusion{1 / 25.4, "inches for millimetres"},
                           UnitConfusion{25.4, "millimetres for inches"},
                           UnitConfusion{pi / 180, "radians for degrees"},
                           UnitConfusion{180 / pi, "degrees for radians"},
                           UnitConfusion{60, "minutes of arc for degrees"},
                           UnitConfusion{1 / 4.4482216152605, "pounds for newtons"},
                           UnitConfusion{1 / 9.80665, "kilograms for newtons"},
                           UnitConfusion{2, "an axle's total for a wheel's"},
                           UnitConfusion{0.5, "half of it"}};

double mean(const Values& x) {
    double sum = 0;
    for (const double v : x) sum += v;
    return x.empty() ? 0 : sum / static_cast<double>(x.size());
}
double max_difference(const Values& a, const Values& b) {
    double worst = 0;
    for (std::size_t k = 0; k < a.size(); ++k) worst = std::max(worst, std::abs(a[k] - b[k]));
    return worst;
}
double span(const Values& x) {
    if (x.empty()) return 0;
    const auto [low, high] = std::ranges::minmax(x);
    return high - low;
}
Values times(double f, Values x) {
    for (double& v : x) v *= f;
    return x;
}
Values plus(Values x, double c) {
    for (double& v : x) v += c;
    return x;
}
Values less(Values a, const Values& b) {
    for (std::size_t k = 0; k < a.size(); ++k) a[k] -= b[k];
    return a;
}
// Half of the last decimal with which a column is written; 0 of one with more than six.
double rounding_of(const Values& v) {
    double unit = 1;
    for (int decimals = 0; decimals <= 6; ++decimals, unit /= 10)
        if (std::ranges::all_of(
                v, [&](double x) { return std::abs(x / unit - std::round(x / unit)) < 1e-6; }))
            return unit / 2;
    return 0;
}
// Largest |value| or the range, if that is larger.
double level(const Values& v) { return std::max(max_difference(v, Values(v.size(), 0)), span(v)); }
double dot(const Values& a, const Values& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
    return sum;
}

// Coefficients of the polynomials that describe a column to within `left`, one polynomial a branch,
// or its points if these are fewer.
int coefficients_of(const ColumnWithReference& b, double left) {
    int coefficients = 0;
    for (std::size_t first = 0; first < b.branch.size();) {
        std::size_t last = first;
        while (last < b.branch.size() && b.branch[last] == b.branch[first]) ++last;
        const auto n = static_cast<Eigen::Index>(last - first);
        const auto [low, high] =
            std::minmax_element(b.at.begin() + static_cast<std::ptrdiff_t>(first),
                                b.at.begin() + static_cast<std::ptrdiff_t>(last));
        const double middle = (*low + *high) / 2, half = std::max((*high - *low) / 2, 1e-300);
        Eigen::VectorXd v(n);
        for (Eigen::Index k = 0; k < n; ++k)
            v[k] = b.candidate[first + static_cast<std::size_t>(k)];
        int count = 1;
        for (; count < std::min<Eigen::Index>(n, max_coefficients); ++count) {
            Eigen::MatrixXd powers(n, count);
            for (Eigen::Index k = 0; k < n; ++k)
                for (Eigen::Index j = 0; j < count; ++j)
                    powers(k, j) =
                        std::pow((b.at[first + static_cast<std::size_t>(k)] - middle) / half, j);
            const Eigen::VectorXd rest = v - powers * solve_by_qr(powers, v);
            if (rest.cwiseAbs().maxCoeff() <= left) break;
        }
        coefficients += count;
        first = last;
    }
    return coefficients;
}

// Whether a transformation that leaves `left`, with `fitted` numbers and one of `tried`, may be right by
// accident, with a probability of more than `max_accident`.
bool is_accident(const ColumnWithReference& b, double left, int fitted, int tried) {
    const double range = span(b.candidate);
    if (!(range > 0)) return true;
    const int free = coefficients_of(b, left) - fitted;
    const double each = std::min(1., 2 * left / range);
    const double of_level = fitted == 0 && free > 0 ? range / level(b.candidate) : 1;
    return !(tried * of_level * std::pow(each, free) <= max_accident);
}

const char* unit_word(double factor) {
    for (const auto& unit : units)
        if (std::abs(std::abs(factor) / unit.factor - 1) < 1e-6) return unit.word;
    return "";
}

// First wrong point of a column that is right before it on its branch.
std::optional<Explanation> wrong_from(const ColumnWithReference& b) {
    for (std::size_t first = 0; first < b.branch.size();) {
        std::size_t last = first;
        while (last < b.branch.size() && b.branch[last] == b.branch[first]) ++last;
        // From a = 0 outwards.
        std::vector<std::size_t> order;
        for (std::size_t k = first; k < last; ++k) order.push_back(k);
        std::ranges::stable_sort(order, {}, [&](std::size_t k) { return std::abs(b.at[k]); });
        double worst = 0;
        for (const std::size_t k : order)
            worst = std::max(worst, std::abs(b.candidate[k] - b.reference[k]));
        double before = 0;
        std::size_t n = 0;
        for (; n < order.size(); ++n) {
            const double e = std::abs(b.candidate[order[n]] - b.reference[order[n]]);
            if (e > right_to * worst) break;
            before = std::max(before, e);
        }
        const double limit =
            std::isfinite(b.tolerance) ? b.tolerance : share_of_reference * span(b.reference);
        const std::size_t ahead =
            std::min(n + std::max<std::size_t>(1, order.size() / 10), order.size() - 1);
        const double jump = std::abs(b.candidate[order[ahead]] - b.reference[order[ahead]]);
        if (worst > limit &&
            static_cast<double>(n) >= min_right_part * static_cast<double>(order.size()) && n > 1 &&
            n < order.size() && jump >= min_jump * worst)
            return Explanation{.kind = Kind::from_there_on,
                               .column = b.column,
                               .branch = b.branch[first],
                               .at = b.at[order[n - 1]],
                               .left = before};
        first = last;
    }
    return std::nullopt;
}

// All other definitions of the figure that make the column right, within `allowed`, each by the
// simplest transformation that does.
std::optional<Explanation> by_definitions(const ColumnWithReference& b, double allowed,
                                          int others) {
    struct Fit {
        std::string name;
        double left = 0;
    };
    std::vector<Fit> fits;
    const Values& v = b.candidate;
    for (std::size_t d = 0; d < b.definitions.size(); ++d) {
        const Values& r = b.definitions[d];
        const std::string& name = b.definition_names[d];
        if (r.size() != v.size() ||
            !std::ranges::all_of(r, [](double x) { return std::isfinite(x); }))
            continue;
        std::optional<Fit> fit;
        const auto try_it = [&](const std::string& as, const Values& reading, bool needs_movement,
                                int fitted) {
            const int tried = as == name ? static_cast<int>(b.definitions.size()) : ++others;
            const double left = max_difference(v, reading);
            const bool moves = left <= share_of_column * span(v);
            if (!fit && left <= allowed && (moves || !needs_movement) &&
                !is_accident(b, left, fitted, tried))
                fit = Fit{as, left};
        };
        for (const bool with_offset : {false, true})
            for (const double sign : {1., -1.})
                for (std::size_t u = 0; u <= units.size(); ++u) {
                    const double factor = sign * (u == 0 ? 1 : units[u - 1].factor);
                    Values reading = times(factor, r);
                    const double offset = with_offset ? mean(less(v, reading)) : 0;
                    if (with_offset) reading = plus(std::move(reading), offset);
                    try_it(name +
                               (u > 0      ? fmt::format(" taken {:.6g} times ({})", factor,
                                                         units[u - 1].word)
                                : sign < 0 ? " with its sign turned"
                                           : "") +
                               (with_offset ? fmt::format(", {:.6g} taken off", offset) : ""),
                           reading, with_offset || u > 0, with_offset ? 1 : 0);
                }
        if (fit) fits.push_back(*fit);
    }
    if (fits.empty()) return std::nullopt;
    std::ranges::stable_sort(fits, {}, &Fit::left);
    Explanation found{
        .kind = Kind::definition, .column = b.column, .definitions = {}, .left = fits.back().left};
    for (const Fit& fit : fits) found.definitions.push_back(fit.name);
    return found;
}

}  // namespace

std::optional<Explanation> explain(const ColumnWithReference& b) {
    const Values &v = b.candidate, &r = b.reference;
    if (v.size() < 2) return std::nullopt;
    const double deviation = max_difference(v, r), movement = span(r);
    if (!(deviation > 0)) return std::nullopt;
    if (!(span(v) > 1e-9) && movement > 1e-6)
        return Explanation{.kind = Kind::still, .column = b.column, .left = deviation};
    const double allowed = std::min(
        share_of_deviation * deviation,
        std::max(std::isfinite(b.tolerance) ? b.tolerance : 0, share_of_reference * movement));
    std::optional<Explanation> accepted;
    // A factor alone has to reproduce the column's level; with an offset or from r_0, its range.
    int tests = 0;
    // Tests v = `transformed`; the first explanation that makes the column right is accepted.
    const auto try_it = [&](Explanation explanation, const Values& transformed,
                            bool is_level = true, int fitted = 0) {
        ++tests;
        explanation.left = max_difference(v, transformed);
        explanation.column = b.column;
        const bool scaled =
            explanation.kind == Kind::factor || explanation.kind == Kind::factor_and_offset;
        if (scaled && !(explanation.left <= share_of_column * (is_level ? level(v) : span(v))))
            return;
        if (!accepted && explanation.left <= allowed &&
            !is_accident(b, explanation.left, fitted, tests))
            accepted = explanation;
    };
    const auto with_offset = [&](Explanation explanation, const Values& transformed) {
        explanation.offset = mean(less(v, transformed));
        try_it(explanation, plus(transformed, explanation.offset), false, 1);
    };
    // v = -r, v = r + c, v = ± unit r
    try_it({.kind = Kind::sign}, times(-1, r));
    with_offset({.kind = Kind::offset}, r);
    for (const double sign : {1., -1.})
        for (const auto& unit : units)
            try_it({.kind = Kind::factor, .factor = sign * unit.factor, .unit_word = unit.word},
                   times(sign * unit.factor, r));
    // v = f r and v = r_0 + f (r - r_0), with f by least squares
    if (const double rr = dot(r, r); rr > 0) {
        const double f = dot(v, r) / rr;
        try_it({.kind = Kind::factor, .factor = f, .unit_word = unit_word(f)}, times(f, r), true,
               1);
    }
    const Values change = less(r, b.begin);
    if (const double cc = dot(change, change); cc > 0) {
        const double f = dot(less(v, b.begin), change) / cc;
        Values transformed = times(f, change);
        for (std::size_t k = 0; k < transformed.size(); ++k) transformed[k] += b.begin[k];
        if (f > 0)
            try_it({.kind = Kind::factor, .factor = f, .unit_word = unit_word(f)}, transformed,
                   false, 1);
    }
    // v = -r + c, v = ± another output, v = ± unit r + c
    with_offset({.kind = Kind::sign_and_offset}, times(-1, r));
    for (std::size_t o = 0; o < b.others.size(); ++o)
        if (b.others[o].size() == v.size()) {
            try_it({.kind = Kind::other_output, .other = b.other_channels[o]}, b.others[o]);
            try_it({.kind = Kind::other_turned, .other = b.other_channels[o]},
                   times(-1, b.others[o]));
        }
    for (const double sign : {1., -1.})
        for (const auto& unit : units)
            with_offset({.kind = Kind::factor_and_offset,
                         .factor = sign * unit.factor,
                         .unit_word = unit.word},
                        times(sign * unit.factor, r));
    if (!accepted || accepted->left > rounding_of_range * movement)
        if (const auto other = by_definitions(
                b,
                accepted ? much_better * accepted->left
                         // the figure may not move at all where another definition of it does
                         : std::max(allowed, std::min(share_of_deviation * deviation,
                                                      std::max(share_of_reference * span(v),
                                                               rounding_of(v)))),
                tests))
            accepted = other;
    if (!accepted) accepted = wrong_from(b);
    return accepted;
}

// With v the column, r its reference, d = rms(v - r) and s = rms(v - mean v), the transformation
// that leaves the smallest rms, if it leaves less than
//
//   v = -r      d / 4 and s / 4
//   v = r + c   d / 4                 c = mean(v - r)
//   v = ± f r   d / 4 and s / 4       f a unit factor > 2.5 or < 1 / 2.5, which no model is off by
//
// All units within the last bound are named, since several may be as near.
std::string nearer_with(const ColumnWithReference& b, const Channel& channel) {
    constexpr double quarter = 0.25, model_is_off = 2.5;
    const Values &v = b.candidate, &r = b.reference;
    const auto rms = [](const Values& x) {
        return std::sqrt(dot(x, x) / static_cast<double>(x.size()));
    };
    const double before = rms(less(v, r)), scatter = rms(plus(v, -mean(v)));
    double left = quarter * before;
    std::string how;
    const auto try_it = [&](const Values& reading, const std::string& as, double at_most) {
        const double now = rms(less(v, reading));
        if (now < std::min(left, at_most)) {
            left = now;
            how = as;
        }
    };
    try_it(times(-1, r), "with its sign turned", quarter * scatter);
    const double offset = mean(less(v, r));
    const std::string symbol = compare::symbol(channel.unit);
    try_it(plus(r, offset), fmt::format("once {:.3g} {} is taken off", offset, symbol), before);
    std::vector<std::string> near;
    for (const double sign : {1., -1.})
        for (const auto& unit : units) {
            const double now = rms(less(v, times(sign * unit.factor, r)));
            if ((unit.factor > model_is_off || unit.factor < 1 / model_is_off) &&
                now < quarter * std::min(before, scatter)) {
                near.push_back(fmt::format("{:.6g} times ({})", sign * unit.factor, unit.word));
                try_it(times(sign * unit.factor, r), "unit", quarter * scatter);
            }
        }
    if (how == "unit") how = fmt::format("with the reference taken {}", fmt::join(near, " or "));
    if (how.empty()) return "";
    return fmt::format("{} is nearer {}: {:.2g} {} off (rms) instead of {:.2g}", channel.name, how,
                       left, symbol, before);
}

std::string describe(const Explanation& e, const Comparison& comparison, const Points& points) {
    const Channel& channel = comparison.channels[points.columns[e.column].channel];
    const std::string unit = symbol(channel.unit);
    const std::string agrees = fmt::format("{} agrees to {:.1e} {}", channel.name, e.left, unit);
    const auto times = [&] {
        return fmt::format("taken {:.6g} times{}", e.factor,
                           e.unit_word.empty() ? "" : " (" + e.unit_word + ")");
    };
    switch (e.kind) {
        case Kind::sign: return agrees + " with its sign turned";
        case Kind::offset:
            return fmt::format("{} once {:.6g} {} is taken off", agrees, e.offset, unit);
        case Kind::factor:
            if (const double share = std::abs(e.factor) - 1;
                e.unit_word.empty() && std::abs(share) < 0.2)
                return fmt::format(
                    "{} is {:.2g} % too {} throughout{}, and agrees to {:.1e} {} without that",
                    channel.name, 100 * std::abs(share), share > 0 ? "large" : "small",
                    e.factor < 0 ? " with its sign turned" : "", e.left, unit);
            return agrees + " with the reference " + times();
        case Kind::sign_and_offset:
            return fmt::format("{} with its sign turned, once {:.6g} {} is taken off", agrees,
                               e.offset, unit);
        case Kind::factor_and_offset:
            return fmt::format("{} with the reference {}, once {:.6g} {} is taken off", agrees,
                               times(), e.offset, unit);
        case Kind::other_output:
        case Kind::other_turned: {
            const std::string& other = comparison.channels[e.other].name;
            if (e.mutual)
                return fmt::format(
                    "{} and {} are changed over: each agrees to {:.1e} {} with the other's "
                    "reference",
                    channel.name, other, e.left, unit);
            return fmt::format("{} agrees to {:.1e} {} with the reference's {}{}", channel.name,
                               e.left, unit, other,
                               e.kind == Kind::other_turned ? ", its sign turned" : "");
        }
        case Kind::definition:
            return fmt::format("{} by another definition: {}", agrees,
                               fmt::join(e.definitions, ", or "));
        case Kind::from_there_on: {
            const auto& branch = comparison.branch(e.branch);
            return fmt::format(
                "{} agrees to {:.1e} {} up to {:.6g} {} of branch '{}', and is off from there on",
                channel.name, e.left, unit, e.at,
                points.a.empty() && branch.abscissa >= 0
                    ? symbol(comparison.channels[static_cast<std::size_t>(branch.abscissa)].unit)
                    : symbol(branch.unit),
                e.branch);
        }
        case Kind::still:
            return fmt::format("{} does not move, where the reference does", channel.name);
    }
    return {};
}

}  // namespace elastocheck::compare
