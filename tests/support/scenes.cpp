#include "tests/support/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <stdexcept>

#include "elastocheck/read_scene.hpp"
#include "tests/support/folder.hpp"

namespace elastocheck::support {
namespace {

// Factor that converts a number from metres and newtons to millimetres and kilonewtons: 1e-3 · 1e3 for "N·m/deg".
double in_mm_and_kN(const std::string& unit) {
    if (unit == "m/s²") return 1;  // gravity is in m/s² in all units
    const auto power = [&](std::string_view part) {
        double factor = 1;
        while (!part.empty()) {
            const auto dot = part.find("·");
            std::string_view one = part.substr(0, dot);
            part = dot == part.npos ? "" : part.substr(dot + std::string_view("·").size());
            const double base = one.starts_with('m') ? 1e3 : one.starts_with('N') ? 1e-3 : 1;
            const int n = one.ends_with("²")   ? 2
                          : one.ends_with("³") ? 3
                          : one.ends_with("⁴") ? 4
                                               : 1;
            factor *= std::pow(base, n);
        }
        return factor;
    };
    const auto slash = unit.find('/');
    const std::string_view whole = unit;
    return power(whole.substr(0, slash)) /
           (slash == unit.npos ? 1 : power(whole.substr(slash + 1)));
}

Eigen::Vector3d random_vector(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> in(-size, size);
    return {in(random), in(random), in(random)};
}
Eigen::Quaterniond random_turn(std::mt19937& random) {
    std::normal_distribution<double> in;
    return Eigen::Quaterniond(in(random), in(random), in(random), in(random)).normalized();
}
Matrix6 random_stiffness(std::mt19937& random) {
    const Matrix6 root =
        Matrix6::NullaryExpr([&] { return std::uniform_real_distribution<double>(-1, 1)(random); });
    Vector6 units;  // √(N/m), √(N·m/rad)
    units << 400, 400, 400, 30, 30, 30;
    const Matrix6 spd = root * root.transpose() + 0.3 * Matrix6::Identity();
    return units.asDiagonal() * spd * units.asDiagonal();
}

}  // namespace

Scene scene(const std::string& name) {
    return read_scene(std::filesystem::path(ELASTOCHECK_SCENES) / (name + ".yaml"));
}

std::vector<std::string> scene_names() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(ELASTOCHECK_SCENES))
        if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem());
    std::ranges::sort(names);
    return names;
}

std::vector<std::string> small_scene_names() {
    std::vector<std::string> names = scene_names();
    std::erase_if(names, [](const std::string& name) { return scene(name).trim.has_value(); });
    return names;
}

std::vector<std::string> trimmed_scene_names() {
    std::vector<std::string> names = scene_names();
    std::erase_if(names, [](const std::string& name) { return !scene(name).trim.has_value(); });
    return names;
}

bool has_potential(const Scene& scene) {
    bool has = true;
    const auto look_at = [&](const Load& load) {
        has &= std::holds_alternative<DeadForce>(load.kind) ||
               std::holds_alternative<DeadMoment>(load.kind);
    };
    for (const auto& load : scene.static_loads) look_at(load);
    for (const auto& branch : scene.branches)
        for (const auto& driver : branch.drivers)
            if (const auto* load = std::get_if<Load>(&driver.what)) look_at(*load);
    for (const auto& elastic : scene.elastics)
        if (const auto* bushing = std::get_if<Bushing>(&elastic.kind))
            has &= has_energy(bushing->formulation);
    return has;
}

Scene in_millimetres_and_kilonewtons(const std::string& name) {
    const auto file = std::filesystem::path(ELASTOCHECK_SCENES) / (name + ".yaml");
    const std::string units = "units: {length: m, angle: deg, force: N}";
    std::string text = text_of(file);
    const auto at = text.find(units);
    if (at == text.npos) throw std::logic_error(name + " is not in m, deg and N");
    text.replace(at, units.size(), "units: {length: mm, angle: deg, force: kN}");
    std::vector<Setting> settings;
    for (const auto& number : read_scene(file).numbers) {
        const bool is_ratio =
            number.path.find(".drive.") != std::string::npos;  // of one length to another
        const double factor = is_ratio ? 1 : in_mm_and_kN(number.unit);
        if (factor != 1) settings.push_back(setting(number.path, factor * number.value));
    }
    return parse_scene(text, file, settings);
}

Scene rich_scene() {
    using Eigen::Quaterniond, Eigen::Vector3d;
    std::mt19937 random(7);
    Scene s;
    s.name = "rich";
    enum : BodyId { subframe, arm, knuckle, upper, slider, link, plate };
    const std::vector<Vector3d> origins = {{0, .3, 0},   {0, .7, -.1}, {0, .8, .1}, {0, .6, .3},
                                           {.2, .5, .1}, {-.2, .6, 0}, {.1, .9, .1}};
    const char* names[] = {"subframe", "arm", "knuckle", "upper", "slider", "link", "plate"};
    for (std::size_t b = 0; b < origins.size(); ++b)
        s.bodies.push_back({names[b], {origins[b], random_turn(random)}});
    const auto point = [&](BodyId body, const Vector3d& p) {
        if (body == ground) return Point{body, p};
        const auto& pose = s.bodies[static_cast<std::size_t>(body)].design;
        return Point{body, pose.p.conjugate() * (p - pose.r)};
    };
    const auto along = [&](BodyId body, const Vector3d& u) {
        if (body == ground) return Direction{body, u.normalized()};
        return Direction{
            body, s.bodies[static_cast<std::size_t>(body)].design.p.conjugate() * u.normalized()};
    };
    const auto marker = [&](BodyId body, const Vector3d& p, const Quaterniond& axes) {
        const auto at = point(body, p);
        return Marker{body, at.s_local,
                      body == ground
                          ? axes
                          : s.bodies[static_cast<std::size_t>(body)].design.p.conjugate() * axes};
    };
    const auto bushing = [&](const char* name, BodyId i, BodyId j, const Vector3d& at,
                             double preload) {
        const Quaterniond axes = random_turn(random);
        Vector6 pre;
        pre << random_vector(random, 1), random_vector(random, 0.02);
        s.elastics.push_back(
            {name, Bushing{marker(i, at, axes), marker(j, at, axes),
                           LinearStiffness{random_stiffness(random)}, preload * pre}});
    };
    const Vector3d lower_ball(.02, .75, -.12), upper_ball(-.01, .68, .3), tie_out(-.12, .72, 0),
        tie_in(-.15, .35, .02);
    for (const Vector3d& at : {Vector3d(.3, .3, .05), Vector3d(-.3, .3, .05), Vector3d(.3, .2, -.1),
                               Vector3d(-.3, .2, -.1)})
        bushing("mount", ground, subframe, at, 200);
    bushing("front", arm, subframe, {.2, .35, -.1}, 100);
    bushing("rear", subframe, arm, {-.2, .35, -.1}, 0);
    const Vector3d axis(1, .05, .02);
    s.joints = {
        {"lower ball", Spherical{point(arm, lower_ball), point(knuckle, lower_ball)}},
        {"upper ball", Spherical{point(knuckle, upper_ball), point(upper, upper_ball)}},
        {"upper pivot", Revolute{point(ground, {0, .4, .32}), point(upper, {0, .4, .32}),
                                 along(ground, axis), along(upper, axis)}},
        {"tie rod",
         Distance{point(knuckle, tie_out), point(ground, tie_in), (tie_out - tie_in).norm()}},
        {"damper", Translational{point(slider, {.2, .5, .1}), point(subframe, {.2, .5, .1}),
                                 along(slider, {.1, .2, 1}), along(subframe, {.1, .2, 1})}},
        {"cross", Universal{point(link, {-.2, .5, 0}), point(subframe, {-.2, .5, 0}),
                            along(link, {1, 0, 0}), along(subframe, {0, 0, 1})}},
        {"weld",
         Fixed{point(plate, {.1, .9, .1}), point(knuckle, {.1, .9, .1}), along(plate, {1, 0, 0}),
               along(plate, {0, 1, 0}), along(knuckle, {1, 0, 0}), along(knuckle, {0, 1, 0})}},
        {"tube",
         InLine{point(link, {-.2, .7, 0}), point(arm, {-.2, .7, 0}), along(arm, {1, .1, 0})}},
    };
    bushing("spin", link, arm, {-.2, .7, 0}, 0);
    s.elastics.push_back(
        {"coil", AxialSpring{point(arm, {.05, .6, -.1}), point(ground, {.05, .5, .35}),
                             LinearRate{30e3}, .49}});
    s.elastics.push_back(
        {"damper spring", AxialSpring{point(slider, {.25, .5, .15}), point(arm, {.2, .6, -.1}),
                                      LinearRate{20e3}, .27}});
    s.static_loads = {{"weight", DeadForce{point(knuckle, {0, .85, .1}), {0, 0, 400}}}};
    s.branches = {{"mixed",
                   0,
                   1500,
                   30,
                   ParameterUnit::newton,
                   {{Load{"push", DeadForce{point(plate, {.1, 1.0, 0}), {.1, .2, 1}}}, 0, 1},
                    {Load{"twist", DeadMoment{knuckle, {.02, .05, .03}}}, 0, 1}}}};
    s.wheels = {Wheel{"", plate, point(plate, {0, .95, .1}).s_local, point(plate, {0, .95, -.2}),
                      along(plate, {0, 1, 0}).u_local, 1}};
    return s;
}

}  // namespace elastocheck::support
