// `elastocheck inspect`: the scene as read and compiled, before anything is solved.
#include <memory>

#include "reports/command/delivery.hpp"
#include "reports/command/program/command.hpp"
#include "reports/document/inspection.hpp"
#include "reports/render/render.hpp"

namespace elastocheck::reports {
namespace {

struct InspectRequest : SceneRequest {
    bool verbose = false, keep_all = false;
};

int inspect(const InspectRequest& request, const Delivery& delivery) {
    std::exception_ptr not_trimmed;
    const LoadedScene loaded =
        load_scene(request.scene, request.settings,
                   request.keep_all ? Detail::everything : Detail::required, &not_trimmed);
    const compare::Result result =
        inspection({.scene = loaded.scene, .model = loaded.model, .trim = loaded.trim});
    if (!delivery.wants_document())
        print(text(request.verbose ? verbose(result) : shortened(result)));
    else
        deliver_result(delivery, document_of(loaded, request.scene), result);
    if (not_trimmed) std::rethrow_exception(not_trimmed);
    return fine;
}

}  // namespace

const Command inspect_command{
    Group::solve, "inspect",
    "Show the compiled scene: bodies, coordinates, constraints, idle modes",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<InspectRequest>();
        add_scene(command, *request);
        command.add_flag("--verbose", request->verbose,
                         "long lists whole, all numbers with their sides, and the size of the "
                         "matrix and its fill-in");
        add_keep_all(command, request->keep_all);
        add_output(command, request->folder, "folder for result.json and a CSV file of each table");
        return [request](const std::string& line) {
            return inspect(*request, request->delivery(line));
        };
    }};

}  // namespace elastocheck::reports
