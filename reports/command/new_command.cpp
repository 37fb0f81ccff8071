// `elastocheck new`: prints a built-in scene to start from.
#include <algorithm>
#include <memory>

#include "reports/command/delivery.hpp"
#include "reports/command/program/command.hpp"
#include "reports/command/templates.hpp"
#include "reports/files/terminal.hpp"

namespace elastocheck::reports {
namespace {

constexpr const char* templates_schema = "elastocheck/templates/1";

struct NewRequest {
    std::string name;
    bool as_json = false;
};

// Prints the template `name`; without a name, a list of all, one per line. Throws
// std::invalid_argument for an unknown name, with the nearest known one. As JSON: schema, and
// templates, the named one with its text.
int new_scene(const std::string& name, bool as_json) {
    if (!name.empty()) {
        const std::string_view text = template_named(name);
        if (as_json)
            print_document(
                {{"schema", templates_schema},
                 {"templates",
                  {{{"template", name}, {"name", template_title(text)}, {"text", text}}}}});
        else
            print("{}", text);
        return fine;
    }
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    std::size_t longest = 0;
    for (const auto& each : templates()) {
        longest = std::max(longest, each.size());
        list.push_back({{"template", each}, {"name", template_title(template_text(each))}});
    }
    if (as_json) {
        print_document({{"schema", templates_schema}, {"templates", list}});
        return fine;
    }
    for (const auto& each : templates())
        print("{:<{}}  {}\n", each, longest, template_title(template_text(each)));
    print("\nelastocheck new NAME > my.yaml\n");
    return fine;
}

}  // namespace

const Command new_command{
    Group::models, "new", "Print a template scene; without a name, list the templates",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<NewRequest>();
        command.add_option("NAME", request->name, "name of the template");
        add_json(command, request->as_json);
        return [request](const std::string&) { return new_scene(request->name, request->as_json); };
    }};

}  // namespace elastocheck::reports
