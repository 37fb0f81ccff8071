#include "reports/gate/baseline.hpp"

#include <algorithm>

#include "compare/comparison/changes.hpp"
#include "reports/files/files.hpp"
#include "reports/gate/gate_report.hpp"
#include "reports/json/json.hpp"
#include "reports/text/escape.hpp"
#include "tests/fuzz/targets.hpp"

namespace elastocheck::fuzz {

void expect_plain(std::string_view what, std::string_view text) {
    std::string one_line(text);
    std::ranges::replace(one_line, '\n', ' ');
    if (const std::string wrong = reports::flaw(one_line); !wrong.empty())
        throw Fault(std::string(what) + ": " + wrong);
}

namespace {

using reports::BaselineFile;

void judge(const BaselineFile& was, const BaselineFile& is, compare::ToleranceClass kind) {
    reports::GatedScene scene;
    scene.file = was.scene_file;
    scene.baseline_file = "fuzz.json";
    scene.accepted = was.baseline.accepted;
    scene.reason = was.baseline.reason;
    scene.class_reason = distance(was.provenance, is.provenance).differs;
    scene.verdict = compare::judge(was.baseline, is.baseline.accepted, kind);
    scene.changed = compare::changes(was.numbers, is.numbers);
    const std::vector all{scene};
    expect_plain("the table", gate_table(scene));
    expect_plain("the conclusion", gate_conclusion(all));
    expect_plain("JUnit", junit(all));
    expect_plain("the summary", step_summary(all));
    expect_plain("the annotations", annotations(all));
    (void)gate_document(all, is.provenance).dump();
    if (junit(all).size() > reports::max_junit)
        throw Fault("a JUnit file larger than services take");
}

// The two files of a baseline as a list of two; anything else is a first file alone.
reports::BaselineText pair(std::string_view input) {
    try {
        const auto both = reports::parse_json(input);
        if (both.is_array() && both.size() == 2) return {both[0].dump(), both[1].dump()};
    } catch (const std::exception&) {  // no JSON, no UTF-8
    }
    return {std::string(input), "{}"};
}

}  // namespace

void baseline(std::string_view input) {
    static const BaselineFile sound = reports::parse_baseline(
        pair(reports::read_whole(ELASTOCHECK_CORPUS "/baseline/sound.json")), "sound.json");
    try {
        const BaselineFile file = reports::parse_baseline(pair(input), "fuzz.json");
        for (const auto kind : compare::tolerance_classes) {
            judge(sound, file, kind);
            judge(file, sound, kind);
            judge(file, file, kind);
        }
        const auto text = baseline_text(file),
                   again = baseline_text(reports::parse_baseline(text, "again.json"));
        if (text.review != again.review || text.curves != again.curves)
            throw Fault("a baseline that is written and read is another");
    } catch (const reports::BaselineError& error) {
        const std::string_view what = error.what();
        if (!what.starts_with("fuzz.json: ") && !what.starts_with("curves/fuzz.json: "))
            throw Fault("a refusal without a place: " + std::string(what));
    }
}

}  // namespace elastocheck::fuzz
