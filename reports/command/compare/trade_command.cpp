// `elastocheck trade`: cost of accuracy of every method, and the cheapest that is accurate enough.
#include <memory>

#include "compare/studies/work_precision.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/program/command.hpp"

namespace elastocheck::reports {
namespace {

struct TradeRequest : SceneRequest {
    std::string tolerance = "0.01mm,0.001deg,1%";
};

int trade(const TradeRequest& request, const Delivery& delivery) {
    const int threads = threads_of(request.running);
    if (!delivery.folder.empty()) Staging::check(delivery.folder);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    compare::TradeOptions options;
    options.tolerance =
        compare::parse_tolerance(request.tolerance, compare::ToleranceParts::with_shares);
    options.threads = threads;
    options.progress = progress;
    const compare::Trade trade = compare::trade(loaded.model, options);
    progress("");
    return deliver_result(delivery, document_of(loaded, request.scene),
                          result_of(loaded.model, trade));
}

}  // namespace

const Command trade_command{
    Group::compare, "trade",
    "Cost of accuracy: every method against both references, and a recommendation",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<TradeRequest>();
        add_scene_and_run(command, *request);
        command.add_option("--tolerance", request->tolerance,
                           "required accuracy (default: 0.01mm,0.001deg,1%)");
        add_output(command, request->folder, "folder for result.json and trade.csv");
        return
            [request](const std::string& line) { return trade(*request, request->delivery(line)); };
    }};

}  // namespace elastocheck::reports
