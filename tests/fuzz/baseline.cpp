#include "reports/gate/baseline.hpp"

#include "compare/comparison/changes.hpp"
#include "reports/files/files.hpp"
#include "reports/gate/gate_report.hpp"
#include "tests/fuzz/targets.hpp"

namespace elastocheck::fuzz {
namespace {

using reports::BaselineFile;

void judge(const BaselineFile& was, const BaselineFile& is, compare::ToleranceClass kind) {
    reports::GatedScene scene;
    scene.file = was.scene_file;
    scene.baseline_file = "fuzz.json";
    scene.accepted = was.baseline.accepted;
    scene.reason = was.baseline.reason;
    scene.differs = distance(was.provenance, is.provenance).differs;
    scene.verdict = compare::judge(was.baseline, is.baseline.accepted, kind);
    if (was.numbers && is.numbers) scene.changed = compare::changes(*was.numbers, *is.numbers);
    const std::vector all{scene};
    expect_plain("the table", gate_table(scene));
    expect_plain("the conclusion", gate_conclusion(all));
    expect_plain("JUnit", junit(all));
    expect_plain("the summary", step_summary(all));
    expect_plain("the annotations", annotations(all));
    (void)gate_document(all, is.provenance).dump();
    if (junit(all).size() > reports::most_junit)
        throw Fault("a JUnit file larger than services take");
}

}  // namespace

void baseline(std::string_view input) {
    static const BaselineFile sound = reports::parse_baseline(
        reports::read_whole(ELASTOCHECK_CORPUS "/baseline/sound.json"), "sound.json");
    try {
        const BaselineFile file = reports::parse_baseline(input, "fuzz.json");
        for (const auto kind : compare::tolerance_classes) {
            judge(sound, file, kind);
            judge(file, sound, kind);
            judge(file, file, kind);
        }
        const std::string text = baseline_text(file);
        if (baseline_text(reports::parse_baseline(text, "again.json")) != text)
            throw Fault("a baseline that is written and read is another");
    } catch (const reports::BaselineError& error) {
        if (!std::string_view(error.what()).starts_with("fuzz.json: "))
            throw Fault(std::string("a refusal without a place: ") + error.what());
    }
}

}  // namespace elastocheck::fuzz
