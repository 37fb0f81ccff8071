#include <elastocheck/candidate.hpp>
#include <elastocheck/compile.hpp>
#include <elastocheck/read_scene.hpp>
#include <elastocheck/trim.hpp>
#include <iostream>

using namespace elastocheck;

// Your solver: where the bodies are at these values of what the branch moves. Here it is the paper's recursion.
EquilibriumPath my_solver(const Model& model, const Branch& branch, std::span<const double> loads) {
    return recursive::solve(model, branch, {.steps = static_cast<int>(loads.size()) - 1});
}

int main(int, char** arguments) {
    const Model model = compile(compare::trim(read_scene(arguments[1])).scene);
    const auto legs = compare::compare(model);
    const auto mine = judge_candidate(model, legs, candidate_of(model, legs, "mine", my_solver));
    for (const auto& off : mine.worst)
        std::cout << off.channel << ": " << off.max << " " << symbol(off.unit) << " off on "
                  << off.branch << "\n";
    std::cout << name(mine.verdict) << ", " << mine.compared << " numbers compared\n";
}
