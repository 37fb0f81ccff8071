#include "recursive/diagnosis/loops.hpp"

#include <algorithm>

#include "models/kinds.hpp"

namespace elastocheck::recursive {
namespace {

struct End {
    std::size_t body, constraint;
};
struct Visit {
    std::size_t body, from;  // the constraint by which the search came
    std::size_t next = 0;    // index among its ends
};

}  // namespace

std::vector<int> loops(const Model& model) {
    const std::size_t no_constraint = model.constraints.size();
    // edges of the graph at each body: the other body and the constraint; ground in slot 0
    std::vector<std::vector<End>> ends(model.bodies.size() + 1);
    std::vector<int> block(model.constraints.size(), -1);
    int time = 0, blocks = 0;
    for (std::size_t c = 0; c < model.constraints.size(); ++c) {
        const auto [i, j] = elastocheck::ends(model.constraints[c].kind);
        if (i == j) {  // on one body, or between ground and ground: a loop by itself
            block[c] = blocks++;
            continue;
        }
        ends[static_cast<std::size_t>(i + 1)].push_back({static_cast<std::size_t>(j + 1), c});
        ends[static_cast<std::size_t>(j + 1)].push_back({static_cast<std::size_t>(i + 1), c});
    }
    // Depth-first search (Hopcroft and Tarjan 1973): discovery time of each body, and its low
    // point, the earliest discovery that its descendants reach by an edge outside the tree. A block
    // is complete where the low point of a body is not before the discovery of its parent.
    std::vector<int> discovered(ends.size(), -1), low_point(ends.size(), 0);
    std::vector<std::size_t> open;  // constraints whose block is not complete
    std::vector<Visit> stack;
    const auto discover = [&](std::size_t body, std::size_t from) {
        discovered[body] = low_point[body] = time++;
        stack.push_back({body, from});
    };
    for (std::size_t root = 0; root < ends.size(); ++root) {
        if (discovered[root] < 0) discover(root, no_constraint);
        while (!stack.empty()) {
            Visit& visit = stack.back();
            const std::size_t body = visit.body;
            if (visit.next < ends[body].size()) {
                const End end = ends[body][visit.next++];
                if (end.constraint == visit.from) continue;
                if (discovered[end.body] < 0) {
                    open.push_back(end.constraint);
                    discover(end.body, end.constraint);
                } else if (discovered[end.body] < discovered[body]) {
                    open.push_back(end.constraint);
                    low_point[body] = std::min(low_point[body], discovered[end.body]);
                }
                continue;
            }
            const std::size_t from = visit.from;
            stack.pop_back();
            if (stack.empty()) continue;
            const std::size_t parent = stack.back().body;
            low_point[parent] = std::min(low_point[parent], low_point[body]);
            if (low_point[body] < discovered[parent]) continue;
            for (std::size_t last = no_constraint; last != from; open.pop_back())
                block[last = open.back()] = blocks;
            ++blocks;
        }
    }
    std::vector<int> of_row;
    for (std::size_t c = 0; c < block.size(); ++c)
        of_row.insert(of_row.end(), static_cast<std::size_t>(rows(model.constraints[c].kind)),
                      block[c]);
    return of_row;
}

}  // namespace elastocheck::recursive
