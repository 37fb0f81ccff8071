// How much the outputs depend on what a bushing is taken to measure (models/mechanism.hpp: Formulation): the choice in
// which tools differ, and all are right.
//
// One scene, solved by the equilibrium leg once for every formulation on a list, with the same numbers in it. The
// spread of an output at a value of the parameter is the largest less the smallest of its values. A tool that is
// compared with this one may be off by that, and be right.
//
// Every bushing is reformulated but those that leave no choice: what resists along or about one axis alone, a tyre or
// a torsion spring; and what is written with its frame in the middle, as a beam is, whose stiffness is meant there.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/compare.hpp"
#include "models/scene.hpp"

namespace elastocheck::compare {

struct NamedFormulation {
    std::string_view name;
    std::optional<Formulation> formulation;  // none: each bushing's own
};
inline constexpr std::array formulations{
    NamedFormulation{"as written", std::nullopt},
    NamedFormulation{"frame on i", Formulation{}},
    NamedFormulation{"frame on j", Formulation{.frame = Formulation::Frame::on_j}},
    NamedFormulation{"frame in the middle", Formulation{.frame = Formulation::Frame::middle}},
    NamedFormulation{"Cardan angles", Formulation{.angles = Formulation::Angles::cardan}},
    NamedFormulation{"projected angles", Formulation{.angles = Formulation::Angles::projected}},
    // A commercial code's: forces straight along the axes of the second marker.
    NamedFormulation{"commercial", Formulation{.frame = Formulation::Frame::on_j,
                                               .angles = Formulation::Angles::projected,
                                               .conjugate = false}},
    NamedFormulation{"without offset moment", Formulation{.offset_moment = false}},
};

// Whether the element leaves a choice, as above.
bool is_reformulated(const Elastic& elastic);
Scene reformulated(const Scene& scene, const Formulation& formulation);

// One output over one branch.
struct FormulationSpread {
    std::size_t channel = 0;      // position in FormulationStudy::channels
    double spread = 0;            // in the channel's unit, where it is largest
    double at = 0;                // there: the parameter in the branch's unit
    std::string lowest, highest;  // whose values they are; empty where there is no spread
};
struct BranchSpread {
    std::string branch;
    Unit unit = Unit::newton;             // of its parameter
    std::vector<std::string> solved;      // formulations that the spread is over
    std::vector<std::string> not_solved;  // those that are not in it, with the reason
    std::vector<FormulationSpread> outputs;
};
struct FormulationStudy {
    std::vector<Channel> channels;      // the main ones
    std::vector<std::string> bushings;  // that were reformulated
    std::vector<BranchSpread> branches;
    std::vector<std::string>
        inconclusive;  // why there is no spread: no bushing to reformulate, fewer than two solved

    bool conclusive() const { return inconclusive.empty(); }
};

// `scene` as it is solved: trimmed already. Curves are read at `steps` equal increments of a branch (0: as many as it
// says), or at every so-many-th of them, of all formulations up to the first value that one of them does not reach.
FormulationStudy formulation_study(const Scene& scene, int steps = 0, int every = 1,
                                   const std::function<void(std::string_view)>& progress = {});

}  // namespace elastocheck::compare
