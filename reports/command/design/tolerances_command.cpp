// `elastocheck tolerances`: scatter of figures by the tolerances of the numbers of a scene.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "compare/design/results.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "models/reader/document/cursor.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/yaml.hpp"
#include "reports/command/design/request.hpp"
#include "reports/files/files.hpp"

namespace elastocheck::reports {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using reader::Cursor;

struct TolerancesRequest : SceneRequest {
    std::string file;
    std::vector<std::string> of;
    int most = 5;
};

void add_correlation(const Cursor& entry, compare::ToleratedNumbers& tolerated) {
    const auto parts = entry.list(3, "two numbers of the file and their correlation");
    Index k[2];
    for (std::size_t i = 0; i < 2; ++i)
        k[i] = static_cast<Index>(parts[i].one_of("a number with a tolerance", tolerated.numbers));
    const double rho = parts[2].number();
    if (k[0] == k[1]) entry.fail("a number with itself; required: two different numbers");
    if (!(std::abs(rho) <= 1)) parts[2].fail(fmt::format("{:g}; allowed: -1 to 1", rho));
    tolerated.correlation(k[0], k[1]) = tolerated.correlation(k[1], k[0]) = rho;
}

// reports/README.md, "Tolerances". Throws SceneError "file:line: field: ...".
compare::ToleratedNumbers read_tolerances(const std::string& file, const Scene& scene) {
    const reader::Value tree = reader::parse_yaml(read_whole(file, largest_baseline), file);
    std::vector<Number> ignored;
    const Cursor whole{&tree, "", &file, &ignored};
    std::vector<std::string> known;
    for (const Number& number : scene.numbers) known.push_back(number.path);
    compare::ToleratedNumbers tolerated;
    for (const auto& [name, entry] : whole.entries(Cursor::Keys::numbers)) {
        if (name == "correlations") continue;
        if (!find_number(scene, name))
            entry.fail("the scene has no such number" +
                       reader::did_you_mean(name, known, "numbers"));
        entry.only_keys({"normal", "uniform"});
        const auto normal = entry.optional("normal"), uniform = entry.optional("uniform");
        if (normal.has_value() == uniform.has_value())
            entry.fail("allowed: one of {normal: {sd: ...}} and {uniform: {half_width: ...}}");
        const char* field = normal ? "sd" : "half_width";
        (normal ? normal : uniform)->only_keys({field});
        const Cursor size = (normal ? normal : uniform)->require(field);
        const double value = size.number();
        if (!(value > 0)) size.fail(fmt::format("{:g}; allowed: more than zero", value));
        tolerated.numbers.push_back(name);
        const auto n = std::ssize(tolerated.numbers);
        tolerated.sd.conservativeResize(n);
        tolerated.largest.conservativeResize(n);
        tolerated.sd[n - 1] = normal ? value : value / std::sqrt(3.0);
        tolerated.largest[n - 1] = normal ? 3 * value : value;
    }
    if (tolerated.numbers.empty()) whole.fail("no tolerance; allowed: NUMBER: {normal: {sd: 0.5}}");
    tolerated.correlation = MatrixXd::Identity(tolerated.sd.size(), tolerated.sd.size());
    if (const auto correlations = whole.optional("correlations")) {
        for (const Cursor& entry : correlations->items()) add_correlation(entry, tolerated);
        if (!compare::is_correlation(tolerated.correlation))
            correlations->fail("contradict each other: their matrix has a negative eigenvalue");
    }
    return tolerated;
}

// The requested figures; without a request the characteristics at the start of the first branch.
std::vector<compare::Figure> requested_figures(std::vector<std::string> requested,
                                               const Model& model) {
    if (requested.empty())
        for (const auto& channel : compare::characteristics(model))
            requested.push_back(channel.name);
    if (requested.empty())
        throw std::invalid_argument(
            "--of: a scene without a wheel has no characteristics; name outputs");
    std::vector<compare::Figure> figures;
    for (const auto& word : requested) try {
            figures.push_back(parse_figure(word, model));
        } catch (const std::invalid_argument& error) {
            throw std::invalid_argument(fmt::format("--of: {}", error.what()));
        }
    return figures;
}

// Exit code 0: every figure has a scatter; 3: not every requested one.
int tolerances(const TolerancesRequest& request, const Delivery& delivery) {
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    compare::ToleratedScene tolerated{read_tolerances(request.file, loaded.scene)};
    compare::Varied varied = parse_varied(tolerated.tolerances.numbers, loaded.scene);
    set_scene(varied, request.scene, request.settings);
    const auto figures = requested_figures(request.of, loaded.model);
    const compare::Figures solved =
        compare::solved_figures(varied, figures, threads_of(request.running));
    const VectorXd nominal = solved.value(varied.start);
    const MatrixXd gradient = solved.gradient(varied.start);
    for (std::size_t k = 0; k < figures.size(); ++k) {
        const auto i = static_cast<Index>(k);
        if (std::isfinite(nominal[i]) && gradient.row(i).allFinite()) {
            tolerated.figures.push_back(figures[k]);
            tolerated.nominal.push_back(nominal[i]);
            tolerated.scatter.push_back(compare::scatter(gradient.row(i), tolerated.tolerances));
        } else if (!request.of.empty()) {
            tolerated.missing.push_back(request.of[k] + ": " +
                                        why_not_solved(varied, {&figures[k], 1}, varied.start));
        }
    }
    return deliver_result(delivery, document_of(loaded, request.scene),
                          result_of(tolerated, delivery.as_json ? 0 : request.most));
}

}  // namespace

const Command tolerances_command{
    Group::change, "tolerances",
    "Scatter of the figures by the tolerances of the numbers of a scene; rates by the "
    "equilibrium leg",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<TolerancesRequest>();
        add_scene_and_run(command, *request);
        as_file(command.add_option("TOLERANCES", request->file,
                                   "file with the tolerances, such as points.tie_rod_inner.z: "
                                   "{normal: {sd: 0.5}}"))
            ->required();
        command
            .add_option("--of", request->of,
                        "outputs, OUTPUT or OUTPUT@BRANCH:PARAMETER (default: the characteristics "
                        "at the start of the first branch)")
            ->delimiter(',');
        command.add_option("--most", request->most, "shares shown per output (default: 5; 0: all)")
            ->check(CLI::Range(0, 100000));
        return [request](const std::string& line) {
            return tolerances(*request, request->delivery(line));
        };
    }};

}  // namespace elastocheck::reports
