// What the gate found, as people and CI read it. Pure functions of the verdicts. Tables and annotations show the worst
// number of each channel, JUnit a test a branch with the worst of its numbers; `gate --json` holds them all.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/changes.hpp"
#include "compare/gate.hpp"
#include "reports/document/provenance.hpp"

namespace elastocheck::reports {

struct GatedScene {
    std::string file;                      // of the scene, as the user knows it
    std::string baseline_file;             //
    compare::Measurement accepted;         // what the baseline holds; empty when there is none
    std::string reason;                    // of the last acceptance
    std::string differs;                   // builds: why the class is not same-build
    std::vector<compare::Change> changed;  // numbers of the scene that are not those that were accepted
    std::vector<std::string> notes;        // worth saying, not worth failing
    bool bad_input = false;                // the scene itself could not be read: verdict.reasons says why
    compare::Verdict verdict;
};

// 1 where a limit is broken anywhere, else 2 where a scene could not be read, else 3 where anything could not
// be judged, else 0. No scene at all is 3.
int exit_code(const std::vector<GatedScene>& scenes);

// "branch 'jounce', recursive: toe at load 3000: accepted -1.52 deg, measured ..."
std::string story(const compare::Offence& offence);

// "points.tie_rod_inner.z: -0.055 m, was -0.06 m"
std::string story(const compare::Change& change);

// Everything, for machines: {schema, provenance, verdict, exit_code, compared, scenes}.
inline constexpr const char* gate_schema = "elastocheck/gate/1";
nlohmann::ordered_json gate_document(const std::vector<GatedScene>& scenes, const Provenance& provenance);

std::string gate_table(const GatedScene& scene);                     // for a terminal
std::string gate_conclusion(const std::vector<GatedScene>& scenes);  // its last line
// Under `most_junit` bytes, which services that show it take, whatever fails: what fails comes first, and what is left
// out is counted.
inline constexpr std::size_t most_junit = 50'000;
std::string junit(const std::vector<GatedScene>& scenes);
std::string step_summary(const std::vector<GatedScene>& scenes);  // Markdown, under 1 MiB
std::string annotations(const std::vector<GatedScene>& scenes);   // GitHub workflow commands, at most ten

}  // namespace elastocheck::reports
