// The published sweep, 300 steps each way, for an instruction counter: `sweep SCENE`.
#include <cstdio>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/recursive.hpp"

int main(int argc, char** argv) {
    using namespace elastocheck;
    if (argc != 2) return 2;
    const Model model = compile(read_scene(argv[1]));
    std::size_t steps = 0;
    for (const auto& branch : model.branches) {
        const EquilibriumPath path = recursive::solve(model, branch);
        if (path.outcome != Outcome::converged) return 3;
        steps += path.points.size() - 1;
    }
    std::printf("%zu steps\n", steps);
}
