#include "reports/command/equilibria_command.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "compare/find_all.hpp"
#include "models/reader/words.hpp"
#include "reports/command/exit_code.hpp"
#include "reports/command/load_scene.hpp"
#include "reports/document/document.hpp"
#include "reports/tables/equilibria.hpp"
#include "reports/text/terminal.hpp"

namespace elastocheck::reports {
namespace {

const Branch& branch_named(const Model& model, const std::string& name) {
    if (name.empty()) return model.branches.front();
    std::vector<std::string> names;
    for (const auto& branch : model.branches) {
        if (branch.name == name) return branch;
        names.push_back(branch.name);
    }
    throw std::invalid_argument(fmt::format("--branch: the scene has no branch {}{}", reader::quote(name),
                                            reader::did_you_mean(name, names, "branches")));
}

}  // namespace

CLI::App* add_equilibria_command(CLI::App& app, EquilibriaRequest& request) {
    auto* command = app.add_subcommand(
        "equilibria", "All equilibria that can be found at one load, each proved, and what they mean");
    command->add_option("SCENE", request.scene, "scene file (YAML)")->required()->check(a_file("*.yaml"));
    constexpr double any = std::numeric_limits<double>::infinity();
    add_number(*command, "--at", request.at, -any, any,
               "value of the branch's parameter, in the unit that reports show: N, N·m, mm, deg")
        ->required();
    command->add_option("--branch", request.branch, "name of the branch (default: the first)");
    add_number(*command, "--turned", request.turned, 0, 180,
               "list none with a body turned by more [deg] (default: 90)");
    add_settings(*command, request.settings);
    return command;
}

int equilibria(const EquilibriaRequest& request, const Delivery& delivery,
               const std::function<void(std::string_view)>& progress) {
    if (!std::isfinite(request.at)) throw std::invalid_argument("--at: not a finite number");
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const Branch& branch = branch_named(loaded.model, request.branch);
    const double a = request.at / compare::in_unit(compare::unit_of(branch.unit));
    const auto all = compare::find_all(loaded.model, branch, a,
                                       {.turn = request.turned / 57.29577951308232, .progress = progress});
    progress("");
    delivery.say(equilibria_text(all));
    if (delivery.as_json) {
        nlohmann::ordered_json document = {{"schema", equilibria_schema},
                                           {"reproduce", delivery.command},
                                           {"provenance", provenance_json(provenance())}};
        document.update(equilibria_json(loaded.model, all));
        print_document(document);
    }
    return all.outcome == Outcome::converged && all.proved ? fine : could_not_judge;
}

}  // namespace elastocheck::reports
