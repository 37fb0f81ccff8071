#include <elastocheck/compile.hpp>
#include <elastocheck/read_scene.hpp>
#include <elastocheck/recursive.hpp>
#include <iostream>

int main(int, char** arguments) {
    const auto model = elastocheck::compile(elastocheck::read_scene(arguments[1]));
    const auto path = elastocheck::recursive::solve(model, model.branches.front());
    std::cout << name(path.outcome) << " in " << path.points.size() - 1 << " steps\n";
}
