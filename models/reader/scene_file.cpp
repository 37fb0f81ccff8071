#include "models/reader/scene_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <system_error>

#include "models/reader/sections.hpp"
#include "models/reader/yaml.hpp"

namespace elastocheck {
namespace reader {
namespace {

constexpr int format_version = 1;

void check_version(const Cursor& scene) {
    const Cursor version = scene.require("elastocheck");
    if (version.text("the version of the format") != std::to_string(format_version))
        version.fail(fmt::format("{} is not a version of the format that this program reads; allowed: {}",
                                 version.found(), format_version));
}

// Every body must be touched by some joint or element, or nothing would hold it.
void check_all_held(const Cursor& scene, const Scene& result) {
    std::vector<bool> held(result.bodies.size(), false);
    const auto hold = [&](BodyId body) {
        if (body != ground) held[static_cast<std::size_t>(body)] = true;
    };
    const auto hold_both = [&](const auto& part) { hold(part.i.body), hold(part.j.body); };
    for (const Joint& joint : result.joints) std::visit(hold_both, joint.kind);
    for (const Elastic& elastic : result.elastics) std::visit(hold_both, elastic.kind);
    const Cursor bodies = scene.require("bodies");
    for (std::size_t b = 0; b < held.size(); ++b)
        if (!held[b])
            bodies.require(result.bodies[b].name)
                .fail("nothing holds it; a joint, spring or bushing is needed");
}

Scene read_tree(const Cursor& scene) {
    if (scene.value->kind == Value::Kind::nothing) scene.fail("empty; a scene begins with `elastocheck: 1`");
    scene.only_keys({"elastocheck", "name", "units", "points", "bodies", "joints", "springs", "bushings",
                     "static_loads", "loads", "branches", "wheel", "probes"});
    check_version(scene);
    Scene result;
    result.source = *scene.file;
    result.name = scene.require("name").text("the name of the scene");
    const Definitions defs = read_definitions(scene);
    result.bodies = defs.bodies;
    for (const auto& [name, position] : defs.points) result.hardpoints.push_back({name, position});

    const auto section = [&](const char* key, auto& list, auto read) {
        if (const auto field = scene.optional(key))
            for (const auto& [name, at] : field->entries()) list.push_back(read(name, at, defs));
    };
    section("joints", result.joints, read_joint);
    section("springs", result.elastics, read_spring);
    section("bushings", result.elastics, read_bushing);
    check_all_held(scene, result);
    read_loads(scene, defs, result.static_loads, result.branches);
    if (const auto wheel = scene.optional("wheel")) result.wheels.push_back(read_wheel(*wheel, defs));
    section("probes", result.probes, read_probe);
    if (result.wheels.empty() && result.probes.empty()) scene.fail("no output; a wheel or a probe is needed");
    return result;
}

}  // namespace

Wheel read_wheel(const Cursor& at, const Definitions& defs) {
    at.only_keys({"body", "centre", "contact_patch", "spin_axis", "side"});
    const BodyId body = moving_body(at.require("body"), defs, "a wheel");
    const auto contact = at.optional("contact_patch");
    const Cursor centre = at.require("centre"), spin_axis = at.require("spin_axis");
    const auto local = [&](const Cursor& field) {
        return point_of(body, hardpoint(field, defs), defs).s_local;
    };
    Wheel wheel{.name = {},
                .body = body,
                .centre_local = local(centre),
                .contact_local = local(contact ? *contact : centre),
                .spin_axis_local = direction(spin_axis, defs),
                .side = at.require("side").one_of("a side", {"left", "right"}) == 0 ? +1 : -1};
    if (!(wheel.side * wheel.spin_axis_local.y() > 0))
        spin_axis.fail(fmt::format("does not point outboard, which is {}y for a {} wheel",
                                   wheel.side > 0 ? '+' : '-', wheel.side > 0 ? "left" : "right"));
    return wheel;
}

Probe read_probe(const std::string& name, const Cursor& at, const Definitions& defs) {
    at.only_keys({"on", "at"});
    const BodyId on = moving_body(at.require("on"), defs, "a probe");
    return {name, point_of(on, hardpoint(at.require("at"), defs), defs)};
}

}  // namespace reader

Scene parse_scene(std::string_view text, const std::string& name) {
    const reader::Value tree = reader::parse_yaml(text, name);
    return reader::read_tree({&tree, "", &name});
}

Scene read_scene(const std::filesystem::path& file) {
    const std::string name = file.string();
    std::error_code ignored;
    const auto status = std::filesystem::status(file, ignored);
    if (status.type() == std::filesystem::file_type::not_found) reader::fail(name, 0, "", "no such file");
    if (is_directory(status)) reader::fail(name, 0, "", "a directory; a scene is one file");
    std::ifstream stream(file, std::ios::binary);
    std::string text(reader::largest_text + 1, '\0');  // one more than allowed, for parse_scene to refuse
    if (stream) stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!stream && !stream.eof()) reader::fail(name, 0, "", "cannot be read");
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return parse_scene(text, name);
}

}  // namespace elastocheck
