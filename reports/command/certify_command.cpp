// `elastocheck certify`: proves by interval arithmetic that computed points are equilibria.
#include <algorithm>
#include <memory>

#include "compare/proofs/certify.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/grammar/command.hpp"
#include "reports/command/options/limits.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/options/running.hpp"
#include "reports/command/options/solving.hpp"

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

Command certify_command() {
    const auto request = std::make_shared<CertifyRequest>();
    return {
        "certify",
        "Prove by interval arithmetic that computed states are equilibria and locally unique",
        {scene_option(request->scene),
         set_option(request->settings),
         {"--method",
          TextList{&request->solvers, TextList::Form::commas, one_of(certified_solvers())},
          "solver of the points: equilibrium, energy, series (default: these three), or a "
          "method of the recursion"},
         {"--tolerance", Text{&request->tolerance},
          "accuracy to be proved (default: 1e-6mm,1e-6deg)"},
         {"--points", Integer{&request->points, 1, most_steps},
          "points of each direction of a branch, besides its start (default: 20)"},
         output_option(request->folder, "folder for result.json and sides.csv"),
         json_option(request->as_json),
         jobs_option(request->running),
         quiet_option(request->running)},
        [request](const std::string& line) { return certify(*request, request->delivery(line)); }};
}

}  // namespace elastocheck::reports
