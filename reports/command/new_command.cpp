#include "reports/command/templates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "models/reader/document/suggestions.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/grammar/command.hpp"
#include "reports/command/grammar/exit_code.hpp"
#include "reports/files/terminal.hpp"
#include "scenes_embedded.hpp"  // generated: name and text of every scene of models/scenes

namespace elastocheck::reports {
namespace {

// JsonCursor `name` of a scene file.
std::string_view title(std::string_view scene) {
    constexpr std::string_view field = "\nname: ";
    const auto begin = scene.find(field);
    if (begin == scene.npos) return {};
    scene.remove_prefix(begin + field.size());
    return scene.substr(0, scene.find('\n'));
}

}  // namespace

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

namespace {

constexpr const char* templates_schema = "elastocheck/templates/1";

// Prints the template `name`; without a name, a list of all, one per line. Throws
// std::invalid_argument for an unknown name, with the nearest known one. As JSON: schema, and
// templates, the named one with its text.
int new_scene(const std::string& name, bool as_json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    std::size_t longest = 0;
    for (const auto& scene : embedded_scenes) {
        longest = std::max(longest, scene.name.size());
        list.push_back({{"template", scene.name}, {"name", title(scene.text)}});
        if (scene.name != name) continue;
        if (as_json)
            print_document(
                {{"schema", templates_schema},
                 {"templates",
                  {{{"template", name}, {"name", title(scene.text)}, {"text", scene.text}}}}});
        else
            print("{}", scene.text);
        return fine;
    }
    const std::vector<std::string> names = templates();
    if (!name.empty())
        throw std::invalid_argument(fmt::format("new: there is no template {}{}",
                                                reader::quote(name),
                                                reader::did_you_mean(name, names, "there are")));
    if (as_json) {
        print_document({{"schema", templates_schema}, {"templates", list}});
        return fine;
    }
    for (const auto& scene : embedded_scenes)
        print("{:<{}}  {}\n", scene.name, longest, title(scene.text));
    print("\nelastocheck new NAME > my.yaml\n");
    return fine;
}

}  // namespace

Command new_command() {
    struct Request {
        std::string name;
        bool as_json = false;
    };
    const auto request = std::make_shared<Request>();
    return {"new",
            "Print a template scene; without a name, list the templates",
            {{"NAME", Text{&request->name, such_as(templates())}, "name of the template"},
             json_option(request->as_json)},
            [request](const std::string&) { return new_scene(request->name, request->as_json); }};
}

}  // namespace elastocheck::reports
