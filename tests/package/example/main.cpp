#include <elastocheck/compare/legs.hpp>
#include <elastocheck/compare/trim.hpp>
#include <elastocheck/models/compile.hpp>
#include <elastocheck/models/reader/scene_file.hpp>
#include <iostream>

int main(int, char** arguments) {
    using namespace elastocheck;
    const Model model = compile(compare::trim(read_scene(arguments[1])).scene);
    const auto outputs = compare::channels(model);
    const auto toe = static_cast<std::size_t>(compare::find_channel(outputs, "toe"));
    for (const auto& point :
         compare::walk(compare::sides_of(model, model.branches.front()), {}).points)
        std::cout << 1e3 * point.load << " mm: " << compare::evaluate(model, outputs, point)[toe]
                  << " deg\n";
}
