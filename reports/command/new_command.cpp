#include "reports/command/new_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "models/reader/words.hpp"
#include "reports/command/exit_code.hpp"
#include "reports/text/terminal.hpp"
#include "scenes_embedded.hpp"  // generated: name and text of every scene of models/scenes

namespace elastocheck::reports {
namespace {

// What a scene file says in its field `name`.
std::string_view title(std::string_view scene) {
    constexpr std::string_view field = "\nname: ";
    const auto begin = scene.find(field);
    if (begin == scene.npos) return {};
    scene.remove_prefix(begin + field.size());
    return scene.substr(0, scene.find('\n'));
}

}  // namespace

int new_scene(const std::string& name) {
    for (const auto& scene : embedded_scenes)
        if (scene.name == name) {
            print("{}", scene.text);
            return fine;
        }
    std::vector<std::string> names;
    std::size_t longest = 0;
    for (const auto& scene : embedded_scenes) {
        names.emplace_back(scene.name);
        longest = std::max(longest, scene.name.size());
    }
    if (!name.empty())
        throw std::invalid_argument(fmt::format("new: no template is called {}{}", reader::quote(name),
                                                reader::did_you_mean(name, names, "there are")));
    for (const auto& scene : embedded_scenes) print("{:<{}}  {}\n", scene.name, longest, title(scene.text));
    print("\nelastocheck new NAME > my.yaml\n");
    return fine;
}

}  // namespace elastocheck::reports
