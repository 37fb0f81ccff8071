// A solver from outside, as a command: simbody_candidate SCENE STEPS OUTPUT [BRANCH...]
//
// One JSON object a line, SI units, for every equilibrium of every branch (or of those named): from the first end of the
// branch to the last, at as many equal steps as told, shared by its two ways as everywhere. Exit codes as everywhere, too:
// 2 for what it cannot read or represent, 3 where a branch does not settle; then nothing is written.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "models/branch.hpp"
#include "tests/engines/simbody/engine.hpp"

namespace {

using namespace elastocheck;

struct DoesNotSettle : std::runtime_error {
    using std::runtime_error::runtime_error;
};

std::string line(const Model& model, const Branch& branch, const Equilibrium& state) {
    nlohmann::json bodies;
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        const auto& [r, p] = state.poses[b];
        bodies[model.bodies[b].name] = {{"position", {r.x(), r.y(), r.z()}},
                                        {"orientation", {p.w(), p.x(), p.y(), p.z()}}};
    }
    return nlohmann::json{{"branch", branch.name}, {"load", state.load}, {"bodies", bodies}}
               .dump() +
           "\n";
}

// Each way from its start; of two, the first one told backwards and without the start that the other has as well.
std::string lines(const Model& model, Branch branch, int steps) {
    branch.steps = steps;
    std::string told;
    const auto all = branch_sides(branch);
    for (const Branch& way : all) {
        std::vector<double> values;
        for (int k = 0; k <= way.steps; ++k) values.push_back(way.to * k / way.steps);
        EquilibriumPath path = engines::simbody(on_branch(model, way), way, values);
        if (path.outcome != Outcome::converged) throw DoesNotSettle(path.detail);
        if (&way != &all.back()) {
            path.points.erase(path.points.begin());
            std::ranges::reverse(path.points);
        }
        for (const Equilibrium& state : path.points) told += line(model, branch, state);
    }
    return told;
}

void write(const std::filesystem::path& output, const std::string& text) {
    const std::filesystem::path unfinished = output.string() + ".unfinished";
    std::ofstream out(unfinished);
    if (!(out << text).flush()) throw SceneError("cannot write " + unfinished.string());
    std::filesystem::rename(unfinished, output);
}

int run(const std::vector<std::string>& arguments) {
    if (arguments.size() < 3)
        throw SceneError("usage: simbody_candidate SCENE STEPS OUTPUT [BRANCH...]");
    const std::string& number = arguments[1];
    int steps = 0;
    const auto read = std::from_chars(number.data(), number.data() + number.size(), steps);
    if (read.ec != std::errc() || read.ptr != number.data() + number.size() || steps < 1)
        throw SceneError("STEPS: expected a positive integer, found '" + number + "'");
    const std::vector<std::string> asked(arguments.begin() + 3, arguments.end());
    const auto trimmed = compare::trim(read_scene(arguments[0]));
    if (trimmed.record && !trimmed.record->reached())
        throw DoesNotSettle("trim: " + trimmed.record->detail);
    const Model model = compile(trimmed.scene);
    for (const auto& name : asked)
        if (std::ranges::find(model.branches, name, &Branch::name) == model.branches.end())
            throw SceneError("no branch '" + name + "' in " + arguments[0]);
    std::string told;
    for (const Branch& branch : model.branches)
        if (asked.empty() || std::ranges::find(asked, branch.name) != asked.end())
            told += lines(model, branch, steps);
    write(arguments[2], told);
    return 0;
}

}  // namespace

int main(int count, char** arguments) {
    try {
        return run({arguments + 1, arguments + count});
    } catch (const SceneError& error) {
        fmt::print(stderr, "simbody_candidate: {}\n", error.what());
        return 2;
    } catch (const elastocheck::engines::NotRepresented& error) {
        fmt::print(stderr, "simbody_candidate: {}\n", error.what());
        return 2;
    } catch (const DoesNotSettle& error) {
        fmt::print(stderr, "simbody_candidate: {}\n", error.what());
        return 3;
    } catch (const std::exception& error) {
        fmt::print(stderr, "simbody_candidate: {}\n", error.what());
        return 4;
    }
}
