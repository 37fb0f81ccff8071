// A block on a vertical slide and a spring, built in code: 1 kN/m lets it sink by 10 mm under 10 N.
#include <elastocheck/compile.hpp>
#include <elastocheck/recursive.hpp>
#include <iostream>

#if __has_include(<compile.hpp>) || __has_include(<models/scenes/README.md>)
#error "headers are on the path without elastocheck/"
#endif

using namespace elastocheck;

int main() {
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    Scene scene;
    scene.bodies = {{.name = "block"}};
    scene.joints = {{.name = "slide",
                     .kind = Translational{
                         .i = {0}, .j = {ground}, .axis_i = {0, up}, .axis_j = {ground, up}}}};
    scene.elastics = {
        {.name = "spring",
         .kind =
             AxialSpring{.i = {ground}, .j = {0, up}, .law = LinearRate{1000}, .free_length = 1}}};
    scene.branches = {
        {.name = "down",
         .to = 10,
         .steps = 10,
         .drivers = {{.what = Load{"weight", DeadForce{.at = {0}, .f = -up}}, .rate = 1}}}};
    scene.probes = {{.name = "block", .at = {0}}};
    const Model model = compile(scene);
    const EquilibriumPath path = recursive::solve(model, model.branches.front());
    std::cout << name(path.outcome) << " at " << path.points.back().poses.front().r.z() << " m\n";
}
