#include "recursive/diagnosis/loops.hpp"

#include <algorithm>

#include "models/kinds.hpp"

namespace elastocheck::recursive {
namespace {

struct End {
    std::size_t body, constraint;
};
struct Visit {
    std::size_t body, by;  // the constraint by which the search came
    std::size_t next = 0;  // index among its ends
};

}  // namespace

std::vector<int> loops(const Model& model) {
    const std::size_t nowhere = model.constraints.size();
    std::vector<std::vector<End>> ends(model.bodies.size() + 1);  // ground in slot 0
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
    // Depth-first search (Hopcroft and Tarjan 1973): discovery time and low point of each body.
    std::vector<int> came(ends.size(), -1), earliest(ends.size(), 0);
    std::vector<std::size_t> open;  // constraints whose block is not complete
    std::vector<Visit> stack;
    const auto come_to = [&](std::size_t body, std::size_t by) {
        came[body] = earliest[body] = time++;
        stack.push_back({body, by});
    };
    for (std::size_t root = 0; root < ends.size(); ++root) {
        if (came[root] < 0) come_to(root, nowhere);
        while (!stack.empty()) {
            Visit& visit = stack.back();
            const std::size_t body = visit.body;
            if (visit.next < ends[body].size()) {
                const End end = ends[body][visit.next++];
                if (end.constraint == visit.by) continue;
                if (came[end.body] < 0) {
                    open.push_back(end.constraint);
                    come_to(end.body, end.constraint);
                } else if (came[end.body] < came[body]) {
                    open.push_back(end.constraint);
                    earliest[body] = std::min(earliest[body], came[end.body]);
                }
                continue;
            }
            const std::size_t by = visit.by;
            stack.pop_back();
            if (stack.empty()) continue;
            const std::size_t before = stack.back().body;
            earliest[before] = std::min(earliest[before], earliest[body]);
            if (earliest[body] < came[before]) continue;
            for (std::size_t last = nowhere; last != by; open.pop_back())
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
