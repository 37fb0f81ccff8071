#include "tests/support/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "elastocheck/read_scene.hpp"
#include "tests/support/folder.hpp"

namespace elastocheck::support {
namespace {

// What is written in metres and newtons, in millimetres and kilonewtons: "N·m/deg" is a thousand times a thousandth.
double in_mm_and_kN(const std::string& unit) {
    if (unit == "m/s²") return 1;  // gravity is, whatever the units
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

std::vector<std::string> family_names() {
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

}  // namespace elastocheck::support
