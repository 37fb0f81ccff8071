// The jobs whose instructions are held: `performance JOB`. What is counted is the function `counted`.
#include <map>
#include <string>
#include <vector>

#include "elastocheck/compile.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/recursive.hpp"
#include "models/branch.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/series/path.hpp"

namespace {

using namespace elastocheck;
using recursive::Analysis;

Outcome published(const Model& model, const Branch& branch, const Analysis& analysis) {
    return recursive::solve(model, branch, {.steps = 300}, analysis).outcome;
}
Outcome polynomials(const Model& model, const Branch& branch, const Analysis& analysis) {
    return recursive::series::follow(model, branch, {}, analysis).outcome;
}
Outcome series(const Model& model, const Branch& branch, const Analysis& analysis) {
    return recursive::solve(model, branch,
                            {.method = *recursive::find_method("series"), .steps = 300}, analysis)
        .outcome;
}
// With the analysis of the model.
Outcome analysed_series(const Model& model, const Branch& branch, const Analysis&) {
    return series(model, branch, recursive::analyse(model));
}

// 30 equal increments.
std::vector<double> loads(const Branch& branch) {
    std::vector<double> values;
    for (int k = 0; k <= 30; ++k) values.push_back(branch.to * k / 30);
    return values;
}
Outcome equilibrium(const Model& model, const Branch& branch, const Analysis&) {
    return reference::equilibrium::solve(model, branch, loads(branch)).outcome;
}
Outcome energy(const Model& model, const Branch& branch, const Analysis&) {
    return reference::energy::solve(model, branch, loads(branch)).outcome;
}

struct Job {
    const char* scene;
    std::size_t branches;  // the first so many of the scene
    Outcome (*run)(const Model&, const Branch&, const Analysis&);
};
const std::map<std::string, Job> jobs{
    {"published", {"chrono_mcpherson", 2, published}},
    {"series_polynomials", {"chrono_mcpherson", 2, polynomials}},
    {"series_points", {"chrono_mcpherson", 2, series}},
    {"equilibrium", {"chrono_mcpherson", 1, equilibrium}},
    {"energy", {"chrono_mcpherson", 1, energy}},
    {"axle_series", {"front_axle", 1, analysed_series}},
    {"axle_equilibrium", {"front_axle", 1, equilibrium}},
};

}  // namespace

extern "C" [[gnu::noinline]] Outcome counted(const Job& job, const Model& model,
                                             const Branch& branch, const Analysis& analysis) {
    return job.run(model, branch, analysis);
}

int main(int argc, char** argv) {
    if (argc != 2 || !jobs.contains(argv[1])) return 2;
    const Job& job = jobs.at(argv[1]);
    const Model model =
        compile(read_scene(std::string(ELASTOCHECK_SCENES) + "/" + job.scene + ".yaml"));
    for (std::size_t k = 0; k < job.branches; ++k) {
        const Branch side = branch_sides(model.branches.at(k)).front();
        const Model part = on_branch(model, side);
        if (counted(job, part, side, recursive::analyse(part)) != Outcome::converged) return 3;
    }
}
