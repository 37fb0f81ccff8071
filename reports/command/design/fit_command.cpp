// `elastocheck fit`: numbers of a scene from measured curves.
#include <memory>

#include "reports/command/design/request.hpp"
#include "reports/command/options/fitting.hpp"

namespace elastocheck::reports {
namespace {

struct FitRequest : DesignRequest {
    std::string measured, map;
    bool robust = false;
};

// Exit code 0: the data determine all numbers; 3: not all, or there is no fit.
int fit(const FitRequest& request, const Delivery& delivery) {
    check_may_write_scene(request.output);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    const compare::FittedScene all =
        fitted({request.scene, request.settings, request.vary, request.measured, request.map,
                request.robust, threads_of(request.running)},
               loaded);
    const int code = deliver_result(delivery, document_of(loaded, request.scene), result_of(all));
    if (all.fitted.why_not.empty())
        request.write("fit: to " + request.measured, all.varied, all.fitted.p);
    return code;
}

}  // namespace

const Command fit_command{
    Group::change, "fit",
    "Fit numbers of a scene to measured curves, with 95 % intervals; gradients "
    "of the equilibrium leg",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<FitRequest>();
        add_design(command, *request);
        as_file(command.add_option("--measured", request->measured,
                                   "measured points (CSV), as for report"))
            ->required();
        repeated(command.add_option(
                     "--vary", request->vary,
                     "number to fit, or pattern with *; limits as NAME=LOW:HIGH; repeat it"))
            ->required();
        as_file(command.add_option(
            "--map", request->map,
            "YAML file with the table's column names, units, signs and offsets"));
        command.add_flag("--robust", request->robust,
                         "give gross outliers little weight (Cauchy's loss)");
        return
            [request](const std::string& line) { return fit(*request, request->delivery(line)); };
    }};

}  // namespace elastocheck::reports
