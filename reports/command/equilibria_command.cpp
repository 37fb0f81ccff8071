// `elastocheck equilibria`: the equilibria at one load, each proved, and their relation to a branch.
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>

#include "compare/proofs/multiple_equilibria.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/program/command.hpp"
#include "reports/files/terminal.hpp"

namespace elastocheck::reports {
namespace {

struct EquilibriaRequest : SceneRequest {
    std::string branch;  // empty: the first
    double at = 0;       // of its parameter, in display units: N, N·m, mm, deg
    double turned = 90;  // excludes states with a body rotated further [deg]
};

// Exit code 0: the branch reaches this value and all found equilibria are proved; else 3.
int equilibria(const EquilibriaRequest& request, const Delivery& delivery) {
    if (!std::isfinite(request.at)) throw std::invalid_argument("--at: not a finite number");
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const Branch& branch = request.branch.empty() ? loaded.model.branches.front()
                                                  : branch_named(loaded.model, request.branch);
    const double a = request.at / compare::in_unit(compare::unit_of(branch.unit));
    const auto found = compare::find_equilibria(
        loaded.model, branch, a,
        {.max_rotation = request.turned / 57.29577951308232, .progress = progress});
    progress("");
    return deliver_result(delivery, document_of(loaded, request.scene),
                          result_of(loaded.model, found));
}

}  // namespace

const Command equilibria_command{
    Group::prove, "equilibria", "Search all equilibria at one load, prove each, and describe them",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<EquilibriaRequest>();
        constexpr double any = std::numeric_limits<double>::infinity();
        add_scene(command, *request);
        add_number(command, "--at", request->at, {-any, any},
                   "value of the branch parameter in N, N·m, mm or deg")
            ->required();
        command.add_option("--branch", request->branch, "name of the branch (default: the first)");
        add_number(command, "--turned", request->turned, {0, 180},
                   "leave out equilibria with a body rotated by more [deg] (default: 90)");
        return [request](const std::string& line) {
            return equilibria(*request, request->delivery(line));
        };
    }};

}  // namespace elastocheck::reports
