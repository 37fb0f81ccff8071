// Solves of one model that several studies read. Each is run once, by the first study that needs it.
//
// The points of all studies are multiples of one base: `base` equal increments of the parameter
// over a branch, divided among its sides. N steps are recorded at most at `finest` points for each
// of these, so that the points of one curve are among those of a finer one.
#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "compare/comparison/legs.hpp"

namespace elastocheck::compare {

struct Solves {
    explicit Solves(const Model& of, int base_points = 10, int finest_multiple = 1);

    const Model& model;
    const int base, finest;
    const std::vector<Channel> channels;              // channels(model)
    std::vector<std::vector<BranchSide>> sides = {};  // per branch, at the base points

    // Result of one solver along one side of a branch, at its points.
    struct Run {
        std::once_flag once = {};
        PathCurve curve = {};
        References references = {};  // run, not judged
    };
    std::mutex lock = {};  // guards the map, not its runs
    std::map<std::string, Run> runs = {};
    std::atomic<int> requests = 0;
};

// The side with `multiple` points for each of the base.
BranchSide at_points(BranchSide side, int multiple);

// Curve of a solver along a side, at the points that `side` records. Threads that need the same run
// wait for it.
const PathCurve& solved(Solves& solves, const BranchSide& side, const SolverSettings& solver);

// Curve of a method along a side with `steps` for each of the base points. Pre: steps <= finest, or a
// multiple of it.
const PathCurve& solved(Solves& solves, const BranchSide& side, const recursive::Method& method,
                        int steps);

// The references on a branch, or on one of its sides, at `multiple` points for each of the base:
// solved at the finest, and read at these. Pre: `multiple` divides finest.
References references_on_branch(Solves& solves, std::size_t branch, int multiple);
References references_on_side(Solves& solves, const BranchSide& side, int multiple);

}  // namespace elastocheck::compare
