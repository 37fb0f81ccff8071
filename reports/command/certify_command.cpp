// `elastocheck certify`: proves by interval arithmetic that computed points are equilibria.
#include <memory>

#include "compare/proofs/certify.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/options/limits.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/options/running.hpp"
#include "reports/command/options/solving.hpp"
#include "reports/command/program/command.hpp"

namespace elastocheck::reports {
namespace {

struct CertifyRequest : SceneRequest {
    std::string tolerance = compare::claimed_accuracy;
    std::vector<std::string> solvers;
    int points = compare::CertifyOptions{}.points;
};

int certify(const CertifyRequest& request, const Delivery& delivery) {
    compare::CertifyOptions options;
    options.tolerance = compare::claim(request.tolerance);  // throws before the work
    if (!request.folder.empty()) Staging::check(request.folder);
    for (const auto& solver : request.solvers) options.solvers.push_back(certified_solver(solver));
    options.points = request.points;
    options.threads = threads_of(request.running);
    options.progress = progress;
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const compare::CertifyStudy study = compare::certify(loaded.model, options);
    progress("");
    return deliver_result(delivery, document_of(loaded, request.scene), result_of(study));
}

}  // namespace

const Command certify_command{
    Group::prove, "certify",
    "Prove by interval arithmetic that computed states are equilibria and locally unique",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<CertifyRequest>();
        add_scene_and_run(command, *request);
        as_word(command
                    .add_option("--method", request->solvers,
                                "solver of the points: equilibrium, energy, series (default: these "
                                "three), or a method of the recursion")
                    ->delimiter(','),
                certified_solvers());
        command.add_option("--tolerance", request->tolerance,
                           "accuracy to be proved (default: 1e-6mm,1e-6deg)");
        command
            .add_option("--points", request->points,
                        "points of each direction of a branch, besides its start (default: 20)")
            ->check(CLI::Range(1, max_steps));
        add_output(command, request->folder, "folder for result.json and sides.csv");
        return [request](const std::string& line) {
            return certify(*request, request->delivery(line));
        };
    }};

}  // namespace elastocheck::reports
