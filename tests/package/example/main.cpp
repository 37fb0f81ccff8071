#include <elastocheck/channels.hpp>
#include <elastocheck/compile.hpp>
#include <elastocheck/legs.hpp>
#include <elastocheck/read_scene.hpp>
#include <elastocheck/trim.hpp>
#include <iostream>

int main(int, char** arguments) {
    using namespace elastocheck;
    const Model model = compile(compare::trim(read_scene(arguments[1])).scene);
    const auto outputs = compare::channels(model);
    const auto toe = static_cast<std::size_t>(compare::find_channel(outputs, "toe"));
    for (const auto& point :
         compare::solve_branch(compare::sides_of(model, model.branches.front()), {}).points)
        std::cout << 1e3 * point.load << " mm: " << compare::evaluate(model, outputs, point)[toe]
                  << " deg\n";
}
