// Spread of the outputs over bushing formulations (include/elastocheck/mechanism.hpp: Formulation), the
// modelling choice in which tools differ legitimately.
//
// The equilibrium leg solves one scene with the same numbers once per listed formulation. The
// spread of an output at a parameter value is the largest minus the smallest of its values. Another
// tool may deviate from this one by that spread and be correct.
//
// Every bushing is reformulated except those without a choice: elements that act along or about one
// axis only, tyres, torsion springs, and elements with their frame in the middle, such as beams,
// whose stiffness is defined in that frame.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "elastocheck/compare.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::compare {

struct NamedFormulation {
    std::string_view name;
    std::optional<Formulation> formulation;  // none: each bushing keeps its own
};
inline constexpr std::array formulations{
    NamedFormulation{"as written", std::nullopt},
    NamedFormulation{"frame on i", Formulation{}},
    NamedFormulation{"frame on j", Formulation{.frame = Formulation::Frame::on_j}},
    NamedFormulation{"frame in the middle", Formulation{.frame = Formulation::Frame::middle}},
    NamedFormulation{"Cardan angles", Formulation{.angles = Formulation::Angles::cardan}},
    NamedFormulation{"projected angles", Formulation{.angles = Formulation::Angles::projected}},
    // Convention of a commercial code: forces along the axes of the second marker.
    NamedFormulation{"commercial", Formulation{.frame = Formulation::Frame::on_j,
                                               .angles = Formulation::Angles::projected,
                                               .conjugate = false}},
    NamedFormulation{"without offset moment", Formulation{.offset_moment = false}},
};

// Whether the element is reformulated, by the rule above.
bool is_reformulated(const Elastic& elastic);
Scene reformulated(const Scene& scene, const Formulation& formulation);

// One output over one branch.
struct FormulationSpread {
    std::size_t channel = 0;  // position in FormulationStudy::channels
    double spread = 0;        // in the channel's unit, where it is largest
    double at = 0;            // parameter of the largest spread, in the branch's unit
    // formulations with the lowest and highest value; empty without a spread
    std::string lowest, highest;
};
struct BranchSpread {
    std::string branch;
    Unit unit = Unit::newton;             // of its parameter
    std::vector<std::string> solved;      // formulations included in the spread
    std::vector<std::string> not_solved;  // formulations that failed, with the reason
    std::vector<FormulationSpread> outputs;
};
struct FormulationStudy {
    std::vector<Channel> channels;      // the main ones
    std::vector<std::string> bushings;  // names of the reformulated bushings
    std::vector<BranchSpread> branches;
    // reason why there is no spread: no bushing to reformulate, fewer than two solved
    std::vector<std::string> inconclusive;

    bool conclusive() const { return inconclusive.empty(); }
};

// Converts every bushing to one formulation, that of another program, for `export`. Not converted:
// torsion springs, tyres, and bushings that have this formulation already, also with their markers
// exchanged. Rates, preloads and curves keep their values, so the law differs under rotation.
struct Conversion {
    Scene scene;
    std::vector<std::string> bushings;  // names of the converted bushings
};
Conversion converted(const Scene& scene, const Formulation& formulation);

// Spread of the outputs over scenes with the same branches, as below; `bushings` stays empty.
FormulationStudy spread_among(const std::vector<std::pair<std::string, Scene>>& scenes,
                              int steps = 0, int every = 1, int threads = 1,
                              const Progress& progress = {});

// Spread over the listed formulations. `scene` is the scene as it is solved, already trimmed. Each
// branch has `steps` equal increments (0: its own number), of which every `every`-th is compared,
// up to the first value that one of the formulations does not reach.
FormulationStudy formulation_study(const Scene& scene, int steps = 0, int every = 1,
                                   int threads = 1, const Progress& progress = {});

}  // namespace elastocheck::compare
