// What proofs come to, as one table: points of scenes (the smallest box, the largest without another equilibrium, the time over
// the equilibrium leg's own), whole branches as one curve, the arch up to its limit, wrong points. Processor time, within one
// process.
//
//   certificate_table [POINTS [SCENE.yaml ...]]      20 points a branch, the McPherson strut of the paper
#include <fmt/format.h>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/trim.hpp"
#include "models/branch.hpp"
#include "reference/certificate/certificate.hpp"

namespace {

using namespace elastocheck;
using namespace elastocheck::reference::certificate;

double now() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void raise(Extent& to, const Extent& by) {
    to = {std::max(to.length, by.length), std::max(to.angle, by.angle),
          std::max(to.force, by.force), std::max(to.moment, by.moment)};
}

struct Points {
    int proved = 0, of = 0;
    Extent error{0, 0, 0, 0};
    double unique = std::numeric_limits<double>::infinity();
    double leg = 0, proof = 0;  // [s]
};

void table(const std::string& file, int count) {
    const Model model = compile(compare::trim(read_scene(file)).scene);
    for (const auto& branch : model.branches)
        for (const auto& way : compare::sides_of(model, branch, count)) {
            compare::SolverSettings solver;
            solver.leg = compare::Leg::equilibrium;
            Points points;
            const double start = now();
            const auto path = compare::solve_branch(way, solver);
            points.leg = now() - start;
            for (const auto& state : path.points) {
                const double from = now();
                const Certificate c = certify(way.model, way.branch, state);
                points.proof += now() - from;
                ++points.of;
                if (c.state != ProofState::proved) continue;
                ++points.proved;
                raise(points.error, c.error);
                points.unique = std::min(points.unique, c.unique.length);
            }
            const double from = now();
            const Tube tube = certify_branch(way.model, way.branch, path.points);
            const double seconds = now() - from;
            fmt::print(
                "| {} | {} | {}/{} | {:.1e} mm, {:.1e} rad, {:.1e} N | {:.1e} mm | {:.2f} ms, "
                "{:.1f} x | {}, "
                "{} "
                "pieces, {:.1e} mm, {:.2f} s |\n",
                model.name, way.name, points.proved, points.of, 1e3 * points.error.length,
                points.error.angle, points.error.force, 1e3 * points.unique,
                1e3 * points.proof / points.of, points.proof / points.leg, name(tube.state),
                tube.pieces, 1e3 * tube.width.length, seconds);
            if (tube.state != ProofState::proved) fmt::print("    {}\n", tube.detail);
        }
}

// The arch of models/scenes/two_spring_arch.yaml, pushed to its limit: certificates around, from a state by its closed form.
void arch(const std::string& file) {
    Model model = compile(read_scene(file));
    Branch way = model.branches.front();
    way.to = -1500;
    model = on_branch(model, way);
    const double k = 100e3, b = 0.3, h = 0.08, free = std::hypot(b, h);
    const auto force = [&](double z) { return 2 * k * z * (1 - free / std::hypot(b, z)); };
    const double l = std::cbrt(free * b * b), top = std::sqrt(l * l - b * b);
    const auto state = [&](double z, double load) {
        Equilibrium at;
        at.load = load;
        at.poses = {model.bodies[0].design};
        at.poses[0].r[2] = z;
        at.reactions.resize(model.joints.size());
        return at;
    };
    const LimitPoint limit = certify_limit_point(model, way, state(top, force(top)));
    fmt::print("\narch: limit {}, {:.12f} ± {:.1e} N\n", name(limit.state),
               (limit.from + limit.to) / 2, (limit.to - limit.from) / 2);
    for (double share = 1e-6; share > 1e-14; share /= 10) {
        const double load = force(top) * (1 - share);
        double low = top, high = h;
        for (int n = 0; n < 200; ++n)
            (force((low + high) / 2) < load ? low : high) = (low + high) / 2;
        const Certificate c = certify(model, way, state(low, load), {.length = 1e-7});
        fmt::print("  {:.0e} from it: {}, {:.1e} mm\n", share, name(c.state), 1e3 * c.error.length);
    }
}

}  // namespace

int main(int count, char** arguments) {
    const int points = count > 1 ? std::atoi(arguments[1]) : 20;
    std::vector<std::string> files(arguments + std::min(count, 2), arguments + count);
    if (files.empty()) files.push_back(ELASTOCHECK_SCENES "/mcpherson.yaml");
    fmt::print(
        "| scene | branch | proved | within | alone within | time a point, over the leg's | as one "
        "curve |\n"
        "|---|---|---|---|---|---|---|\n");
    for (const auto& file : files) table(file, points);
    arch(ELASTOCHECK_SCENES "/two_spring_arch.yaml");
}
