#include "reports/command/templates.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "models/reader/document/suggestions.hpp"
#include "scenes_embedded.hpp"  // generated: name and text of every scene of models/scenes

namespace elastocheck::reports {

std::vector<std::string> templates() {
    std::vector<std::string> names;
    for (const auto& scene : embedded_scenes) names.emplace_back(scene.name);
    return names;
}

std::string_view template_text(const std::string& name) {
    for (const auto& scene : embedded_scenes)
        if (scene.name == name) return scene.text;
    return {};
}

std::string_view template_title(std::string_view scene) {
    constexpr std::string_view field = "\nname: ";
    const auto begin = scene.find(field);
    if (begin == scene.npos) return {};
    scene.remove_prefix(begin + field.size());
    return scene.substr(0, scene.find('\n'));
}

std::string_view template_named(const std::string& name) {
    const std::string_view text = template_text(name);
    if (text.empty())
        throw std::invalid_argument(
            fmt::format("new: there is no template {}{}", reader::quote(name),
                        reader::did_you_mean(name, templates(), "there are")));
    return text;
}

}  // namespace elastocheck::reports
