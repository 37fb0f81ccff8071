// Everything that `report` finds on one scene: what result.json, the tables and the page are made of.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compare/candidate/judgement.hpp"
#include "compare/result/result.hpp"
#include "compare/studies/formulations.hpp"
#include "compare/studies/study.hpp"
#include "compare/studies/work_precision.hpp"
#include "compare/tables/rows.hpp"
#include "elastocheck/candidate.hpp"
#include "elastocheck/compare.hpp"
#include "elastocheck/scene.hpp"
#include "elastocheck/trim.hpp"
#include "reports/document/against.hpp"
#include "reports/document/drawing.hpp"
#include "reports/given/measurement.hpp"

namespace elastocheck::reports {

// Effects of the numbers of the scene on its key figures, along the leading sweep.
struct Effects {
    std::vector<compare::EffectRow> rows{};
    std::vector<std::string> reasons{};  // why they are not confirmed; empty: they are
    long compared = 0;                   // derivatives that two solvers gave
    double difference = 0;               // of two solvers at most, of the largest of a figure
};

compare::Result result_of(const Effects& effects);  // a table of them

struct JudgedCandidate {
    compare::CandidateJudgement judgement;
    std::string sentence;
};

// Error of the recommended configuration over every branch.
struct Recommended {
    compare::TradePoint configuration{};
    std::vector<std::pair<std::string, compare::Profile>> branches{};  // by their names
};

// Parts that were not requested are empty.
struct SceneAnalyses {
    Scene scene{};  // trimmed
    Model model{};
    std::optional<compare::TrimRecord> trim{};
    std::vector<std::string> warnings{};
    std::string hash{};           // of the file
    compare::Result inspected{};  // as `inspect` has it
    compare::Comparison comparison{};
    std::vector<std::string> reasons{};  // why it cannot be judged; empty when it can
    // per branch: where tyres and springs with loose seats lift off and return, in words
    std::vector<std::vector<std::string>> lift_offs{};
    Drawing drawing{};
    std::optional<Effects> effects{};
    std::optional<compare::FormulationStudy> formulations{};
    std::optional<compare::Study> study{};
    std::optional<compare::Trade> trade{};
    std::optional<Recommended> recommended{};
    std::optional<compare::Assessment> judgement{};
    std::optional<Measured> measured{};
    std::vector<JudgedCandidate> candidates{};
    std::optional<compare::Result> loads{};  // at the pickup points, under cases
    std::optional<Against> against{};        // a variant, of which this is the base
    std::string only{};                      // kc, evidence; empty: both
    bool quick = false;                      // proved at the ends alone

    bool conclusive() const { return reasons.empty(); }
};

// Adds a comparison, the reasons why it is not conclusive, lift-offs and the drawing.
void add_comparison(SceneAnalyses& scene, compare::Comparison comparison);

}  // namespace elastocheck::reports
