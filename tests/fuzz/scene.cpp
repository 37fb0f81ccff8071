
#include <cmath>
#include <fstream>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "models/branch.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/support/folder.hpp"

namespace elastocheck::fuzz {
namespace {

void use(const Scene& scene) {
    for (const auto& number : scene.numbers)
        if (!std::isfinite(number.value)) throw Fault(number.path + " is not finite");
    for (const auto detail : {Detail::required, Detail::everything}) {
        const Model model = compile(scene, detail);
        for (const auto& branch : model.branches)
            for (const auto& way : branch_sides(branch))
                if (!std::isfinite(way.from) || !std::isfinite(way.to) || way.steps < 1)
                    throw Fault("branch '" + branch.name + "' leads nowhere");
    }
}

// Refused with the place and the reason, in a line that a terminal can be shown.
void expect_refusal(const SceneError& error, const std::string& file) {
    const std::string_view what = error.what();
    if (!what.starts_with(file + ":") && what.find(" is not a setting; ") == what.npos)
        throw Fault("a refusal without a place: " + std::string(what));
}

}  // namespace

void scene(std::string_view input) {
    constexpr std::string_view marker = "# --set ";
    try {
        std::vector<Setting> settings;
        for (std::size_t at = 0; at < input.size() && settings.size() < 8;) {
            const std::size_t end = std::min(input.find('\n', at), input.size());
            const std::string_view line = input.substr(at, end - at);
            if (line.starts_with(marker))
                settings.push_back(parse_setting(line.substr(marker.size())));
            at = end + 1;
        }
        use(parse_scene(input, "fuzz.yaml", settings));
    } catch (const SceneError& error) {
        expect_refusal(error, "fuzz.yaml");
    }
}

void table(std::string_view input) {
    static const support::Folder folder;
    static const std::string file = folder.write("fuzz.yaml", R"(elastocheck: 1
name: a table
units: {length: mm, angle: deg, force: N}
points: {low: [0, 0, 0], high: [0, 0, 100]}
bodies: {body: {origin: low}}
joints: {slide: {type: translational, bodies: [body, ground], at: low, axis: z}}
springs: {spring: {bodies: [body, ground], from: low, to: high, curve: {file: table.csv}}}
loads: {push: {on: body, at: low, force: [0, 0, 1]}}
branches: {up: {load: push, to: 10, steps: 1}}
probes: {tip: {body: body, at: low}}
)");
    static const std::string csv = (folder.path / "table.csv").string();
    std::ofstream(csv, std::ios::binary) << input;
    try {
        use(read_scene(file));
    } catch (const SceneError& error) {
        const std::string_view what = error.what();
        if (!what.starts_with(file + ":") && !what.starts_with(csv + ":"))
            throw Fault("a refusal without a place: " + std::string(what));
    }
}

}  // namespace elastocheck::fuzz
