// `elastocheck sensitivity`: derivatives of the outputs by the numbers of a scene, by all legs.
#include <memory>

#include "compare/sensitivity/sensitivity.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/options/gradients_of.hpp"
#include "reports/command/options/load_scene.hpp"
#include "reports/command/options/running.hpp"
#include "reports/command/program/command.hpp"
#include "reports/files/files.hpp"
#include "reports/render/render.hpp"

namespace elastocheck::reports {
namespace {

struct SensitivityRequest {
    std::string scene;
    Settings settings;
    GradientsRequest gradients;
    std::string csv;  // file of all derivatives; empty: none
    int most = 5;
    bool as_json = false;
    Running running;
};

// Exit code 0: every leg that applies follows every branch and they agree; else 3.
int sensitivity(const SensitivityRequest& request, const Delivery& delivery) {
    if (!request.csv.empty()) check_may_write(request.csv, gradients_file);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    GradientsRequest gradients = request.gradients;
    gradients.threads = threads_of(request.running);
    const compare::Gradients all = gradients_of(request.scene, request.settings, loaded, gradients,
                                                [](const std::string& what) { progress(what); });
    progress("");
    const compare::Result result = result_of(all, request.most);
    if (!request.csv.empty())
        write_whole(request.csv, csv(whole_table(result, "derivatives")), gradients_file);
    return deliver_result(delivery, document_of(loaded, request.scene), result);
}

}  // namespace

const Command sensitivity_command{
    Group::change, "sensitivity",
    "Derivatives of the outputs by the numbers of the scene, by all legs: what should I "
    "change?",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<SensitivityRequest>();
        add_scene(command, request->scene);
        command
            .add_option("--of", request->gradients.of,
                        "outputs, names or patterns with *: channels, characteristics such as "
                        "bump_steer, forces of elements (default: positions and angles of wheels "
                        "and probes)")
            ->delimiter(',');
        command
            .add_option("--to", request->gradients.to,
                        "numbers of the scene, names as for --set or patterns with * "
                        "(default: all)")
            ->delimiter(',');
        command
            .add_option("--branch", request->gradients.branches,
                        "names of branches, or patterns (default: all)")
            ->delimiter(',');
        command
            .add_option("--points", request->gradients.points,
                        "stations per branch after its start (default: 4)")
            ->check(CLI::Range(1, 1000));
        command
            .add_option("--at", request->gradients.at,
                        "stations BRANCH:VALUE in place of --points for that branch, such as "
                        "jounce:1500")
            ->delimiter(',');
        command
            .add_option("--most", request->most,
                        "numbers shown per output, those with the largest effect (default: 5; "
                        "0: all)")
            ->check(CLI::Range(0, 100000));
        as_file(
            command.add_option("--csv", request->csv, "file of all derivatives at all stations"));
        add_set(command, request->settings);
        add_running(command, request->running);
        add_json(command, request->as_json);
        return [request](const std::string& line) {
            return sensitivity(*request, {.as_json = request->as_json, .command = line});
        };
    }};

}  // namespace elastocheck::reports
