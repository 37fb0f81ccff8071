// Gate results as terminal text, JUnit, Markdown and annotations; pure functions of the verdicts.
// Tables and annotations show the worst number of each channel, JUnit one test per branch with its
// worst numbers; `gate --json` contains all numbers.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/comparison/changes.hpp"
#include "compare/gate/gate.hpp"
#include "reports/files/provenance.hpp"

namespace elastocheck::reports {

struct GatedScene {
    std::string file;  // of the scene, as given by the user
    std::string baseline_file;
    compare::Measurement accepted;         // content of the baseline; empty without one
    std::string reason;                    // of the last acceptance
    std::string class_reason;              // why this class of tolerances; empty: same build
    std::vector<compare::Change> changed;  // numbers of the scene changed since the acceptance
    std::vector<std::string> widened;      // tolerances beyond the default ones of the class
    std::vector<std::string> notes;        // remarks that do not affect the verdict
    bool bad_input = false;  // the scene could not be read; verdict.reasons has the reason
    compare::GateVerdict verdict;
};

// 1 if any limit is broken, else 2 if a scene could not be read, else 3 if anything could not be
// judged, else 0. 3 without a scene.
int exit_code(const std::vector<GatedScene>& scenes);

// "branch 'jounce', recursive: toe at load 3000: accepted -1.52 deg, measured ..."
std::string describe(const compare::Offence& offence);

// "points.tie_rod_inner.z: -0.055 m, was -0.06 m"
std::string describe(const compare::Change& change);

// Complete results for programs: {schema, provenance, verdict, exit_code, compared, scenes}.
inline constexpr const char* gate_schema = "elastocheck/gate/2";
nlohmann::ordered_json gate_document(const std::vector<GatedScene>& scenes,
                                     const Provenance& provenance);

std::string gate_table(const GatedScene& scene);                     // for a terminal
std::string gate_conclusion(const std::vector<GatedScene>& scenes);  // its last line
// Below `max_junit` bytes, the size that CI services accept: failures come first, omitted tests
// are counted.
inline constexpr std::size_t max_junit = 50'000;
std::string junit(const std::vector<GatedScene>& scenes);
std::string step_summary(const std::vector<GatedScene>& scenes);  // Markdown, under 1 MiB
// GitHub workflow commands, at most ten
std::string annotations(const std::vector<GatedScene>& scenes);

}  // namespace elastocheck::reports
