#include "compare/sensitivity/differences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "compare/comparison/legs.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/sensitivity/one_sided.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/branch.hpp"
#include "models/kinds.hpp"
#include "models/structure.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/neighbours.hpp"
#include "reference/energy/neighbours.hpp"
#include "reference/equilibrium/neighbours.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Error of the formula of lower order, which `check` computes: h²/2 y''' for central differences over h
// and 2h, h³/4 y'''' for one-sided ones.
const Stencil around{
    {-2, -1, 1, 2}, {1. / 12, -2. / 3, 2. / 3, -1. / 12}, {.25, -.5, .5, -.25}, {-.5, 2, 2, -.5}};
const Stencil above{{1, 2, 3, 4}, {4, -3, 4. / 3, -.25}, {1, -1.5, 1, -.25}, {}};
const Stencil below{{-1, -2, -3, -4}, {-4, 3, -4. / 3, .25}, {-1, 1.5, -1, .25}, {}};

// Largest error of lower order, as a share of the size of its row; that of the derivative is near its square.
constexpr double settled = 1e-4;
constexpr int max_shorter_steps = 3;  // divisions of h by eight
constexpr double one_slope = 1e-3;    // likewise: a smaller difference of both slopes is none
constexpr double across_a_knot = std::numeric_limits<double>::max();

bool compile_points(const Changing& changing, const Stencil& stencil, double h, Compiled& result) {
    result.points.clear();
    result.stencil = &stencil;
    result.h = h;
    try {
        for (const double t : stencil.t) result.points.push_back(changing.at(t * h));
    } catch (const SceneError& error) {
        result.undefined = std::string("cannot be varied alone: ") + error.what();
        return false;
    }
    result.undefined.clear();
    return true;
}

// A part that compile() leaves out of one of two models, for a message; empty if there is none.
std::string difference(const Model& a, const Model& b) {
    for (const auto& [has, lacks] : {std::pair{&a, &b}, {&b, &a}})
        for (const Omission& omission : has->omitted)
            if (std::ranges::find(lacks->omitted, omission.what, &Omission::what) ==
                lacks->omitted.end())
                return fmt::format(" ({})", omission.what);
    return "";
}

std::vector<NeighbourStates> neighbour_states(Leg leg, const BranchSide& side,
                                              const Equilibrium& state,
                                              std::span<const Neighbours> stencils) {
    switch (leg) {
        case Leg::recursive:
        case Leg::series:
            return recursive::neighbour_states(side.model, side.branch, state, stencils,
                                               *side.analysis);
        case Leg::equilibrium:
            return reference::equilibrium::neighbour_states(side.model, side.branch, state,
                                                            stencils);
        case Leg::energy:
            return reference::energy::neighbour_states(side.model, side.branch, state, stencils);
    }
    return {};
}

// Per curve of an element: the piece on which it is deformed.
std::vector<std::size_t> pieces(const BranchSide& side, const Equilibrium& state) {
    std::vector<std::size_t> rows_with_number;
    for (std::size_t e = 0; e < side.model.elastics.size(); ++e) {
        const ElasticKind& kind = side.model.elastics[e].kind;
        std::optional<Vector6> x;
        each_curve(kind, [&](std::size_t axis, const elastocheck::Curve& curve) {
            if (!x) x = deformation(kind, e, side.branch, state);
            rows_with_number.push_back(static_cast<std::size_t>(
                std::ranges::upper_bound(curve.knots, (*x)[static_cast<Index>(axis)]) -
                curve.knots.begin()));
        });
    }
    return rows_with_number;
}

struct Entries {
    // [outputs × numbers]; `check` is `across_a_knot` where a neighbour is on another piece of a law
    MatrixXd rate, check, kink;
    std::vector<std::string> why;
    // deformation beyond a corner, per number
    VectorXd beyond = {};
};

// The weighted differences over the neighbours of each number.
Entries differences(const ReadSide& read_side, Leg leg, const Equilibrium& state,
                    std::span<const Neighbouring> near, Analyses& analyses,
                    const std::optional<Corner>& corner = {}) {
    const auto rows = std::ssize(read_side.outputs.channels), columns = std::ssize(near);
    Entries entries{MatrixXd::Constant(rows, columns, nan),
                    MatrixXd::Zero(rows, columns),
                    MatrixXd::Zero(rows, columns),
                    {},
                    VectorXd::Constant(columns, nan)};
    std::vector<Neighbours> stencils;
    std::vector<std::size_t> of_column;
    for (std::size_t k = 0; k < near.size(); ++k) {
        entries.why.push_back(near[k].undefined);
        if (!near[k].undefined.empty()) continue;
        of_column.push_back(k);
        Neighbours& stencil = stencils.emplace_back();
        for (std::size_t p = 0; p < near[k].sides.size(); ++p)
            stencil.push_back({&near[k].sides[p].model, near[k].stencil->t[p] * near[k].h,
                               near[k].stencil->weight[p] / near[k].h});
    }
    if (stencils.empty()) return entries;
    std::vector<Channel> channels = read_side.outputs.channels;
    const auto read = [&](const BranchSide& side, const Equilibrium& at,
                          const Outputs::Placed& placed) {
        for (std::size_t c = 0; c < channels.size(); ++c) channels[c].reads = placed.reads[c];
        const auto values = row_of(side.model, channels, side, {.leg = leg}, at, analyses).values;
        return VectorXd(Eigen::Map<const VectorXd>(values.data(), rows) - placed.from);
    };
    const auto pieces_here = pieces(read_side.side, state);
    const VectorXd centre =
        read(read_side.side, state, read_side.outputs.placed(read_side.side.model, {}));
    const auto neighbours = neighbour_states(leg, read_side.side, state, stencils);
    for (std::size_t n = 0; n < neighbours.size(); ++n) {
        const std::size_t k = of_column[n];
        if (neighbours[n].outcome != Outcome::converged) {
            entries.why[k] =
                fmt::format("{}: {}", name(neighbours[n].outcome), neighbours[n].detail);
            continue;
        }
        VectorXd rate = VectorXd::Zero(rows), check = rate, kink = rate;
        double opens = 0;
        bool crosses = false;
        for (std::size_t p = 0; p < near[k].sides.size(); ++p) {
            const BranchSide& side = near[k].sides[p];
            const VectorXd change = read(side, neighbours[n].states[p], near[k].placed[p]) - centre;
            rate += near[k].stencil->weight[p] / near[k].h * change;
            check += near[k].stencil->check[p] / near[k].h * change;
            kink += near[k].stencil->kink[p] / near[k].h * change;
            crosses = crosses || (!corner && pieces(side, neighbours[n].states[p]) != pieces_here);
            if (corner)
                opens += near[k].stencil->weight[p] / near[k].h *
                         beyond_knot(side.model, side.branch, neighbours[n].states[p], *corner);
        }
        for (Index c = 0; c < rows; ++c)
            if (const auto column = static_cast<Index>(k); std::isfinite(rate[c])) {
                entries.rate(c, column) = rate[c];
                entries.kink(c, column) = std::abs(kink[c]);
                entries.check(c, column) =
                    crosses ? across_a_knot : std::abs(check[c]) + std::abs(kink[c]);
            }
        if (corner) entries.beyond[static_cast<Index>(k)] = opens;
    }
    return entries;
}

// The one-sided derivatives at a corner. Where a number moves the state above the knot, those of the
// model above it hold; the two models must agree on the direction.
OneSided beside_corner(const ReadSide& read_side, Leg leg, const Equilibrium& state,
                       const Corner& corner, std::span<const Neighbouring> near,
                       Analyses& analyses) {
    const auto on = [&](int which) {
        ReadSide side = read_side;
        side.side.model = one_sided(side.side.model, corner, which);
        std::vector<Neighbouring> beside(near.begin(), near.end());
        for (Neighbouring& one : beside)
            for (BranchSide& there : one.sides) there.model = one_sided(there.model, corner, which);
        return differences(side, leg, state, beside, analyses, corner);
    };
    const Entries up = on(+1), down = on(-1);
    OneSided both{MatrixXd::Constant(up.rate.rows(), up.rate.cols(), nan), {}};
    both.falling = both.growing;
    for (Index k = 0; k < up.rate.cols(); ++k) {
        if (!(up.beyond[k] * down.beyond[k] > 0) && !(up.beyond[k] == 0 && down.beyond[k] == 0))
            continue;
        both.growing.col(k) = (up.beyond[k] > 0 ? up : down).rate.col(k);
        both.falling.col(k) = (up.beyond[k] > 0 ? down : up).rate.col(k);
    }
    // what needs a stiffness of the corner itself has none
    for (std::size_t c = 0; c < read_side.outputs.channels.size(); ++c)
        if (read_side.outputs.channels[c].kind() == ChannelKind::characteristic) {
            both.growing.row(static_cast<Index>(c)).setConstant(nan);
            both.falling.row(static_cast<Index>(c)).setConstant(nan);
        }
    return both;
}

std::vector<double> sizes_of_rows(const ReadSide& of, const MatrixXd& rate,
                                  std::span<const Changing> numbers) {
    std::vector<double> largest(of.outputs.channels.size(), 0);
    for (std::size_t c = 0; c < largest.size(); ++c)
        for (std::size_t k = 0; k < numbers.size(); ++k) {
            const double entry =
                std::abs(rate(static_cast<Index>(c), static_cast<Index>(k)) * numbers[k].step);
            if (entry > largest[c]) largest[c] = entry;
        }
    return min_sizes(of.outputs.channels, std::move(largest));
}

// 6 standard deviations of the rounding of an entry. With ε the rounding of one value of its output, of
// all numbers alike, a sum Σ c_k (y_k - y_0) has √(Σ c_k² + (Σ c_k)²) ε. ε is measured by the kink,
// which is h³ of smooth functions: its median over the numbers that move the output is 0.6745 ε √(...).
double spread(const std::array<double, 4>& c) {
    double sum = 0, squares = 0;
    for (const double one : c) {
        sum += one;
        squares += one * one;
    }
    return std::sqrt(squares + sum * sum);
}
MatrixXd rounding_of(const Entries& entries, std::span<const Neighbouring> near) {
    constexpr double deviations = 6, median_of_normal = 0.6745;
    MatrixXd rounding = MatrixXd::Zero(entries.rate.rows(), entries.rate.cols());
    for (Index c = 0; c < rounding.rows(); ++c) {
        // exactly zero where no neighbour changes the output
        const auto moves = [&](Index k) {
            return entries.rate(c, k) != 0 || entries.check(c, k) != 0;
        };
        std::vector<double> noise;
        for (Index k = 0; k < rounding.cols(); ++k) {
            const Neighbouring& number = near[static_cast<std::size_t>(k)];
            if (number.stencil == &around && moves(k) && entries.check(c, k) < across_a_knot)
                noise.push_back(entries.kink(c, k) * number.h);
        }
        if (noise.empty()) continue;
        const auto middle = noise.begin() + std::ssize(noise) / 2;
        std::ranges::nth_element(noise, middle);
        const double epsilon = *middle / (median_of_normal * spread(around.kink));
        for (Index k = 0; k < rounding.cols(); ++k) {
            const Neighbouring& number = near[static_cast<std::size_t>(k)];
            if (moves(k))
                rounding(c, k) =
                    std::max(entries.check(c, k) < across_a_knot ? entries.kink(c, k) : 0,
                             deviations * spread(number.stencil->weight) * epsilon / number.h);
        }
    }
    return rounding;
}

// The side with only these of its outputs.
ReadSide with_rows(const ReadSide& of, const std::vector<Index>& rows) {
    ReadSide some{of.side, {}};
    for (const Index c : rows)
        some.outputs.channels.push_back(of.outputs.channels[static_cast<std::size_t>(c)]);
    some.outputs.placed = [&of, rows](const Model& on_side, const std::optional<Trim>& trim) {
        const Outputs::Placed all = of.outputs.placed(on_side, trim);
        Outputs::Placed placed{{}, all.from(rows)};
        for (const Index c : rows) placed.reads.push_back(all.reads[static_cast<std::size_t>(c)]);
        return placed;
    };
    return some;
}

// Shortens h where the entries of a number are not settled, then asks for the slopes to both sides.
struct Refining {
    const ReadSide& of;
    Leg leg;
    const Equilibrium& state;
    const Changing& number;
    const std::vector<double>& sizes;
    bool judges_kinks;
    Analyses& analyses;

    // Differences of the outputs `some` over h; `stencil` null: the one that the file accepts.
    Entries with(const ReadSide& some, const Stencil* stencil, double h) const {
        Changing shorter = number;
        shorter.h = h;
        Compiled points;
        if (stencil == nullptr)
            points = compiled(shorter);
        else
            (void)compile_points(shorter, *stencil, h, points);
        const Neighbouring near = on_side(points, some);
        return differences(some, leg, state, {&near, 1}, analyses);
    }
    // The largest error that counts as settled.
    double limit(Index c) const {
        return settled * sizes[static_cast<std::size_t>(c)] / number.step;
    }
    // The rows whose error is larger, and those that cost little to read: all but characteristics.
    std::vector<Index> unsettled(const VectorXd& check, bool and_cheap) const {
        std::vector<Index> rows;
        for (Index c = 0; c < check.size(); ++c)
            if (const Channel& output = of.outputs.channels[static_cast<std::size_t>(c)];
                std::abs(check[c]) > limit(c) ||
                (and_cheap && output.kind() != ChannelKind::characteristic))
                rows.push_back(c);
        return rows;
    }
    // The largest ratio of an error to its limit.
    double worst(const VectorXd& check) const {
        double largest = 0;
        for (Index c = 0; c < check.size(); ++c)
            largest = std::max(largest, std::abs(check[c]) / limit(c));
        return largest;
    }
    void refine(Index column, Rates& rates, VectorXd check) const {
        double h = number.h;
        const VectorXd rounding = rates.rounding.col(column) * h;
        for (int shorter = 0; shorter < max_shorter_steps && worst(check) > 1; ++shorter) {
            h /= 8;
            const double before = worst(check);
            const auto rows = unsettled(check, true);
            const Entries finer = with(with_rows(of, rows), nullptr, h);
            for (std::size_t n = 0; n < rows.size(); ++n)
                if (const auto at = static_cast<Index>(n); finer.check(at, 0) < check[rows[n]]) {
                    const Index c = rows[n];
                    rates.at(c, column) = finer.rate(at, 0);
                    check[c] = finer.check(at, 0);
                    rates.rounding(c, column) = rounding[c] / h;
                }
            if (worst(check) > before / 2) break;  // rounding, or a kink at the number itself
        }
        const auto rows = unsettled(check, false);
        if (rows.empty() || !judges_kinks) return;
        const ReadSide some = with_rows(of, rows);
        const Entries up = with(some, &above, number.h / 8),
                      down = with(some, &below, number.h / 8);
        if (!up.why.front().empty() || !down.why.front().empty())
            return;  // at the end of its range
        for (std::size_t n = 0; n < rows.size(); ++n) {
            const Index c = rows[n];
            const double growing = up.rate(static_cast<Index>(n), 0),
                         falling = down.rate(static_cast<Index>(n), 0),
                         rounded = 50 * rounding[c] / number.h;
            if (std::abs(growing - falling) <= one_slope / settled * limit(c) + rounded) continue;
            if (rates.one_sided.empty())
                rates.one_sided = {MatrixXd::Constant(rates.at.rows(), rates.at.cols(), nan),
                                   MatrixXd::Constant(rates.at.rows(), rates.at.cols(), nan)};
            rates.at(c, column) = nan;
            rates.one_sided.growing(c, column) = growing;
            rates.one_sided.falling(c, column) = falling;
            rates.why[static_cast<std::size_t>(column)] =
                "the derivative differs on both sides of this value";
        }
    }
};

}  // namespace

Compiled compiled(const Changing& changing) {
    Compiled result;
    if (compile_points(changing, around, changing.h, result)) return result;
    const std::string why = result.undefined;
    if (compile_points(changing, above, changing.h, result)) {
        result.side = 1;
    } else if (compile_points(changing, below, changing.h, result)) {
        result.side = -1;
    } else {
        result.undefined = why;
    }
    return result;
}

Neighbouring on_side(const Compiled& compiled, const ReadSide& read_side) {
    Neighbouring near{{}, {}, compiled.stencil, compiled.h, compiled.undefined};
    if (!near.undefined.empty()) return near;
    std::vector<int> expected, structure;
    elastocheck::structure(read_side.side.model, expected);
    for (const Changed& point : compiled.points) {
        BranchSide moved{read_side.side.name, {}, read_side.side.branch, read_side.side.analysis};
        const auto branch =
            std::ranges::find(point.model.branches, read_side.side.branch.name, &Branch::name);
        if (branch != point.model.branches.end()) moved.branch.drivers = branch->drivers;
        moved.model = on_branch(point.model, moved.branch);
        elastocheck::structure(moved.model, structure);
        if (structure != expected) {
            near.undefined = "decides at this value which parts the model has" +
                             difference(read_side.side.model, moved.model);
            return near;
        }
        near.placed.push_back(read_side.outputs.placed(moved.model, point.trim));
        near.sides.push_back(std::move(moved));
    }
    return near;
}

Rates rates_at(const StateOfLeg& of, std::span<const Changing> numbers,
               std::span<const Neighbouring> near, bool judges_kinks, Analyses& analyses) {
    const auto& [side, leg, state] = of;
    const auto corners_here = corners(side.side.model, side.side.branch, state);
    if (!corners_here.empty()) {
        const MatrixXd nothing =
            MatrixXd::Constant(std::ssize(side.outputs.channels), std::ssize(near), nan);
        Rates none{nothing, nothing, {}};
        for (const Neighbouring& number : near)
            none.why.push_back(!number.undefined.empty()
                                   ? number.undefined
                                   : "an element is at a corner of its law, where its stiffness "
                                     "has two values");
        if (corners_here.size() == 1)
            none.one_sided = beside_corner(side, leg, state, corners_here.front(), near, analyses);
        return none;
    }
    const Entries first = differences(side, leg, state, near, analyses);
    Rates rates{first.rate, rounding_of(first, near), first.why};
    const auto sizes = sizes_of_rows(side, first.rate, numbers);
    for (std::size_t k = 0; k < near.size(); ++k)
        if (rates.why[k].empty())
            Refining{side, leg, state, numbers[k], sizes, judges_kinks, analyses}.refine(
                static_cast<Index>(k), rates, first.check.col(static_cast<Index>(k)));
    return rates;
}

std::vector<double> min_sizes(std::span<const Channel> outputs, std::vector<double> largest) {
    constexpr double smallest_row = 1e-6, smallest_effect = 1e-5, smallest_characteristic = 1e-3;
    double motions = 0, forces = 0;
    const auto is_characteristic = [&](std::size_t c) {
        return outputs[c].kind() == ChannelKind::characteristic;
    };
    const auto of_kind = [&](std::size_t c) -> double& {
        const Unit unit = outputs[c].unit;
        return unit == Unit::newton || unit == Unit::newton_metre ? forces : motions;
    };
    for (std::size_t c = 0; c < largest.size(); ++c)
        if (!is_characteristic(c)) of_kind(c) = std::max(of_kind(c), largest[c]);
    for (std::size_t c = 0; c < largest.size(); ++c)
        largest[c] =
            std::max(largest[c], is_characteristic(c)
                                     ? smallest_characteristic
                                     : std::max(smallest_effect, smallest_row * of_kind(c)));
    return largest;
}

}  // namespace elastocheck::compare
