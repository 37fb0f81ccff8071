// `elastocheck solve-for`: numbers of a scene for wanted figures.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "compare/design/results.hpp"
#include "reports/command/design/request.hpp"
#include "reports/command/program/exit_code.hpp"

namespace elastocheck::reports {
namespace {

using Eigen::Index;

struct SolveForRequest : DesignRequest {
    std::vector<std::string> want;
};

void add_wish(compare::SolvedFor& solved, const std::string& word, const Model& model) {
    const auto equals = word.rfind('=');
    if (equals == word.npos || equals == 0)
        throw std::invalid_argument(
            "allowed: OUTPUT=VALUE or OUTPUT@BRANCH:PARAMETER=VALUE, such as bump_steer=0 or "
            "toe@jounce:3000=-0.1");
    solved.wanted.push_back(parse_figure(word.substr(0, equals), model));
    solved.target.conservativeResize(std::ssize(solved.wanted));
    solved.target[std::ssize(solved.wanted) - 1] =
        parse_number(std::string_view(word).substr(equals + 1));
}

// Exit code 0: the wishes are met and confirmed; 1: they cannot be met; 3: a leg has no values or
// does not confirm them.
int solve_for(const SolveForRequest& request, const Delivery& delivery) {
    check_may_write_scene(request.scene, request.output, request.settings);
    const LoadedScene loaded = load_scene(request.scene, request.settings);
    compare::Varied varied = parse_varied(request.vary, loaded.scene);
    for (Index k = 0; k < varied.start.size(); ++k)
        if (!std::isfinite(varied.low[k]))
            throw std::invalid_argument(
                fmt::format("--vary {}: needs limits, =LOW:HIGH; the smallest change is that of "
                            "the smallest shares of the ranges",
                            varied.numbers[static_cast<std::size_t>(k)].path));
    set_scene(varied, request.scene, request.settings);
    compare::SolvedFor solved{varied};
    for (const auto& word : request.want) try {
            add_wish(solved, word, loaded.model);
        } catch (const std::invalid_argument& error) {
            throw std::invalid_argument(fmt::format("--want '{}': {}", word, error.what()));
        }
    const compare::Figures figures =
        compare::solved_figures(varied, solved.wanted, threads_of(request.running));
    solved.start = compare::start_of(figures, varied);
    if (!solved.start.complete()) {
        print_error("{}\n", why_not_solved(varied, solved.wanted, varied.start));
        return could_not_judge;
    }
    for (std::size_t j = 0; j < solved.wanted.size(); ++j)
        if (solved.start.still[j])
            throw std::invalid_argument(
                fmt::format("--want {}: none of the numbers moves it:\n  {}", request.want[j],
                            compare::why_still(varied, solved.wanted[j])));
    solved.solution = compare::solve_for(
        figures, {solved.target, solved.target, solved.start.movement}, varied, varied.start);
    solved.after = figures.value(solved.solution.p);
    solved.by = compare::confirm(varied.scene(solved.solution.p), solved.wanted, solved.after,
                                 solved.start.movement);
    const int code =
        deliver_result(delivery, document_of(loaded, request.scene), result_of(solved));
    request.write(fmt::format("solve-for: {}{}", solved.met() ? "" : "nearest to ",
                              fmt::join(request.want, ", ")),
                  varied, solved.solution.p);
    return code;
}

}  // namespace

const Command solve_for_command{
    Group::change, "solve-for",
    "Change numbers of a scene as little as possible so that figures have wanted values; "
    "gradients by the equilibrium leg",
    [](CLI::App& command) -> Run {
        const auto request = std::make_shared<SolveForRequest>();
        add_design(command, *request);
        repeated(command.add_option("--vary", request->vary,
                                    "number that may change, with its limits: "
                                    "points.tie_rod_inner.z=260:340; repeat it"))
            ->required();
        repeated(command.add_option("--want", request->want,
                                    "figure and value: bump_steer=0 at the start of the first "
                                    "branch, toe@jounce:3000=-0.1 elsewhere; repeat it"))
            ->required();
        return [request](const std::string& line) {
            return solve_for(*request, request->delivery(line));
        };
    }};

}  // namespace elastocheck::reports
