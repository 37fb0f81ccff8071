#include "recursive/linear_algebra/saddle_point.hpp"

#include <map>

namespace elastocheck::recursive {

Vector<double> equilibration(const SaddleMatrix<double>& M) {
    Vector<double> d = Vector<double>::Ones(M.n + M.m), largest(M.n + M.m);
    // Rates far below the unit of Φ_q would be satisfied by d = 1 and stay small.
    double rate = 0;
    for_each_entry(M, [&](int i, int j, int entry) {
        if (i < M.n && j < M.n && i % 6 < 3 && j % 6 < 3)
            rate = std::max(rate, std::abs(M.values[static_cast<std::size_t>(entry)]));
    });
    if (rate > 0 && rate < 1) {
        d.head(M.n).setConstant(1 / std::sqrt(rate));
        d.tail(M.m).setConstant(std::sqrt(rate));
    }
    for (int sweep = 0; sweep < 10; ++sweep) {
        largest.setZero();
        for_each_entry(M, [&](int i, int j, int entry) {
            largest[i] =
                std::max(largest[i], std::abs(M.values[static_cast<std::size_t>(entry)]) * d[j]);
        });
        for (Eigen::Index k = 0; k < d.size(); ++k)
            if (largest[k] > 0) d[k] /= std::sqrt(largest[k] * d[k]);
    }
    return d.unaryExpr([](double value) { return std::exp2(std::round(std::log2(value))); });
}

namespace {

// Pattern of M bordered by the held directions.
Pattern bordered(const Pattern& inner, const Held<double>& held) {
    const int N = inner.size, d = held.size();
    Pattern result{N + d, {}, {}};
    std::vector<int> of_row, first_of_row;
    sort_into_rows(static_cast<std::size_t>(N), first_of_row, of_row, nullptr, [&](auto&& put) {
        for (int c = 0; c < d; ++c)
            for (int e = held.begin(c); e < held.end(c); ++e)
                put(held.row[static_cast<std::size_t>(e)], N + c, 0);
    });
    const auto append = [&](const std::vector<int>& list, int from, int to) {
        result.row.insert(result.row.end(), list.begin() + from, list.begin() + to);
    };
    for (int j = 0; j < N + d; ++j) {
        result.first.push_back(static_cast<int>(result.row.size()));
        const auto column = static_cast<std::size_t>(j);
        if (j < N) {
            append(inner.row, inner.first[column], inner.first[column + 1]);
            append(of_row, first_of_row[column], first_of_row[column + 1]);
        } else {
            append(held.row, held.begin(j - N), held.end(j - N));
        }
    }
    result.first.push_back(static_cast<int>(result.row.size()));
    return result;
}

// Entries that each held direction, a column of `null_space`, may have on the whole branch. For an
// idle mode they are the unknowns of the bodies that it moves, for a redundant combination the rows
// of its loops of joints (`loop` of every row; joints of different loops are independent).
// Directions that share a body or loop form a group (union-find; its leader is the first), whose
// directions all have the entries of the group.
Held<double> held_entries(int idle, const Eigen::SparseMatrix<double>& null_space,
                          const Vector<double>& weight, int n, const std::vector<int>& loop) {
    using Column = Eigen::SparseMatrix<double>::InnerIterator;
    const auto as_index = [](auto k) { return static_cast<std::size_t>(k); };
    const auto d = static_cast<int>(null_space.cols());
    // A part is a body or a loop (numbered after the bodies), with the first direction found there.
    const int bodies = n / 6, loops = loop.empty() ? 0 : *std::ranges::max_element(loop) + 1;
    std::vector<int> leader(as_index(d)), first_there(as_index(bodies + loops), -1);
    std::vector<std::vector<int>> of_leader(as_index(d));
    const auto leader_of = [&](int c) {
        while (leader[as_index(c)] != c)
            c = leader[as_index(c)] = leader[as_index(leader[as_index(c)])];
        return c;
    };
    for (int c = 0; c < d; ++c) {
        leader[as_index(c)] = c;
        std::map<int, double> share;  // squared norm in each part
        double total = 0;
        for (Column e(null_space, c); e; ++e) {
            const auto row = static_cast<int>(e.row());
            const int part = row < n ? row / 6 : bodies + loop[as_index(row - n)];
            const double size = weight[row] * e.value();
            share[part] += size * size;
            total += size * size;
        }
        for (const auto& [part, size] : share) {
            if (!(size > 1e-10 * total)) continue;
            if (first_there[as_index(part)] < 0) {
                first_there[as_index(part)] = c;
            } else {
                const int first_leader = leader_of(first_there[as_index(part)]),
                          other = leader_of(c);
                leader[as_index(std::max(first_leader, other))] = std::min(first_leader, other);
            }
        }
    }
    const auto add_entry = [&](int part, int row) {
        if (first_there[as_index(part)] >= 0)
            of_leader[as_index(leader_of(first_there[as_index(part)]))].push_back(row);
    };
    for (int row = 0; row < n; ++row) add_entry(row / 6, row);
    for (std::size_t k = 0; k < loop.size(); ++k)
        add_entry(bodies + loop[k], n + static_cast<int>(k));
    std::vector<int> order(as_index(d));
    for (int c = 0; c < d; ++c) order[as_index(c)] = c;
    // idle modes stay first: they share no part with redundant combinations
    std::ranges::stable_sort(order, {}, leader_of);

    Held<double> held;
    held.idle = idle;
    held.first.push_back(0);
    for (int k = 0; k < d; ++k) {
        const int c = order[as_index(k)];
        const auto& rows = of_leader[as_index(leader_of(c))];
        const bool same_group = k > 0 && leader_of(order[as_index(k - 1)]) == leader_of(c);
        held.with.push_back(same_group ? held.with.back() : k);
        held.row.insert(held.row.end(), rows.begin(), rows.end());
        held.first.push_back(static_cast<int>(held.row.size()));
        held.value.resize(held.row.size(), 0);
        for (Column e(null_space, c); e; ++e) {
            const auto at = std::ranges::lower_bound(rows, static_cast<int>(e.row()));
            if (at != rows.end() && *at == e.row())
                held.value[as_index(held.begin(k) + (at - rows.begin()))] = e.value();
        }
    }
    return held;
}

// The scaling of each entry of the bordered matrix.
void set_scaling(SaddlePoint<double>& system, const Pattern& pattern) {
    const int N = system.n + system.m;
    system.lu.factor.clear();
    for (int j = 0; j < pattern.size; ++j)
        for (int e = pattern.first[static_cast<std::size_t>(j)];
             e < pattern.first[static_cast<std::size_t>(j) + 1]; ++e) {
            const int i = pattern.row[static_cast<std::size_t>(e)];
            system.lu.factor.push_back(i < N && j < N ? system.scale[i] * system.scale[j] : 1);
        }
}

// log₂ of det M̂ / det M: D on both sides, and each border divided by its length.
double log_of_scaling(const SaddlePoint<double>& system) {
    double sum = system.scale.array().log2().sum();
    for (int c = 0; c < system.held.size(); ++c) {
        const auto W2 = weights(system, c);
        double square = 0;
        for (int e = system.held.begin(c); e < system.held.end(c); ++e) {
            const auto position = static_cast<std::size_t>(e);
            const double b = system.scale[system.held.row[position]] *
                             W2(e - system.held.begin(c)) * system.held.value[position];
            square += b * b;
        }
        sum -= std::log2(square) / 2;
    }
    return 2 * sum;
}

}  // namespace

void analyse(SaddlePoint<double>& system, int idle, const Eigen::SparseMatrix<double>& null_space,
             const Pattern& inner, const std::vector<int>& loop, const EliminationOrder& like) {
    const int N = system.n + system.m;
    system.scale = equilibration(system.M);
    system.largest = {system.M.values.begin(), system.M.values.end()};
    for (double& entry : system.largest) entry = std::abs(entry);
    system.held = held_entries(idle, null_space, system.weight, system.n, loop);
    orthonormalise(system);

    const Pattern pattern = bordered(inner, system.held);
    std::vector<int>& source = system.lu.source;
    source.clear();
    for (int j = 0; j < pattern.size; ++j)
        for (int e = pattern.first[static_cast<std::size_t>(j)];
             e < pattern.first[static_cast<std::size_t>(j) + 1]; ++e) {
            const int i = pattern.row[static_cast<std::size_t>(e)];
            source.push_back(i < N && j < N ? system.M.at(i, j) : 0);
        }
    set_scaling(system, pattern);
    const int border = system.M.part_at(system.m, 0);
    system.M.values.resize(static_cast<std::size_t>(border) + system.held.row.size());
    for (int c = 0; c < system.borders(); ++c)
        for (int e = system.held.begin(c); e < system.held.end(c); ++e) {
            const int row = system.held.row[static_cast<std::size_t>(e)];
            for (const int position :
                 {entry_at(pattern, row, N + c), entry_at(pattern, N + c, row)})
                source[static_cast<std::size_t>(position)] = border + e;
        }
    system.rhs.setZero(N + system.borders());
    system.solution.setZero(N + system.borders());
    set_border(system);
    analyse_scaled(system.lu, pattern, system.M.values.data(), like);
}

void rescale(SaddlePoint<double>& system) {
    const double old_log = log_of_scaling(system);
    SaddleMatrix<double> largest_entries = system.M;
    for (std::size_t e = 0; e < system.largest.size(); ++e)
        largest_entries.values[e] = system.largest[e] =
            std::max(system.largest[e], std::abs(largest_entries.values[e]));
    system.scale = equilibration(largest_entries);
    set_scaling(system, system.lu.order->pattern);
    system.log_scale += log_of_scaling(system) - old_log;
}

}  // namespace elastocheck::recursive
