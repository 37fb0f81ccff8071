// `elastocheck loads`: loads at every pickup point under load cases, for stress analysis.
#include <memory>

#include "compare/loads/loads.hpp"
#include "elastocheck/compile.hpp"
#include "reports/command/delivery.hpp"
#include "reports/command/options/load_cases.hpp"
#include "reports/command/program/command.hpp"
#include "reports/files/files.hpp"
#include "reports/render/render.hpp"

namespace elastocheck::reports {
namespace {

// `folder` is the CSV file.
struct LoadsRequest : SceneRequest {
    std::string cases;
};

int loads(const LoadsRequest& request, const Delivery& delivery) {
    if (!request.folder.empty()) check_may_write(request.folder, loads_file);
    const LoadedScene loaded = load_scene(request.scene, request.settings, Detail::everything);
    const auto cases = read_load_cases(read_whole(request.cases), request.cases, loaded.scene);
    const Model model = compile(compare::with_cases(loaded.scene, cases), Detail::everything);
    const compare::Result result = result_of(compare::pickup_loads(model));
    if (!request.folder.empty())
        write_whole(request.folder, csv(whole_table(result, "loads")), loads_file);
    return deliver_result({.as_json = delivery.as_json, .command = delivery.command},
                          document_of(loaded, request.scene), result);
}

}  // namespace

const Command loads_command{
    Group::solve, "loads",
    "Forces and moments at every joint and bushing of every body under load cases, for stress "
    "analysis",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<LoadsRequest>();
        add_scene(command, *request);
        as_file(
            command
                .add_option("CASES", request->cases,
                            "CSV file: a row a case; columns case, WHEEL.patch_force_x, _y, _z, "
                            "WHEEL.centre_force_x, ..., WHEEL.moment_x, ..., WHEEL.travel, "
                            "BODY.force_x, ..., acceleration_x [g], ...")
                ->required());
        as_file(command.add_option("-o,--output", request->folder,
                                   "CSV file: a row a case, the loads in vehicle and body axes"));
        return
            [request](const std::string& line) { return loads(*request, request->delivery(line)); };
    }};

}  // namespace elastocheck::reports
