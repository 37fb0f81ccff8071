#include "reports/gate/gate_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "reports/document/document.hpp"
#include "reports/files/templates.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

using compare::Judgement;
using compare::Offence;
using json = nlohmann::ordered_json;

constexpr std::size_t rows_in_table = 10, annotations_in_all = 10;
// A step summary is rejected from 1 MiB; this many rows with cells of this length stay below it.
constexpr std::size_t rows_in_summary = 100, scenes_in_summary = 300, cell_length = 300;

// Worst number of a channel or counter over branches, legs and loads.
struct Worst {
    const GatedScene* scene;
    const Offence* offence;
    std::size_t numbers = 1;  // number of values of this channel out of tolerance
};

// Keeps the order of comes_before.
std::vector<Worst> worst_of_each_channel(const GatedScene* scene,
                                         const std::vector<const Offence*>& offences) {
    std::vector<Worst> all;
    std::map<std::string_view, std::size_t> place;
    for (const auto* offence : offences) {
        const auto [at, is_new] = place.emplace(offence->channel, all.size());
        if (is_new)
            all.push_back({scene, offence});
        else
            ++all[at->second].numbers;
    }
    return all;
}

// Over all scenes, in the order of comes_before.
std::vector<Worst> worst_of_each_channel(const std::vector<const GatedScene*>& scenes) {
    std::vector<Worst> all;
    for (const auto* scene : scenes) {
        std::vector<const Offence*> offences;
        for (const auto& offence : scene->verdict.offences) offences.push_back(&offence);
        std::ranges::copy(worst_of_each_channel(scene, offences), std::back_inserter(all));
    }
    std::ranges::stable_sort(
        all, [](const Worst& a, const Worst& b) { return comes_before(*a.offence, *b.offence); });
    return all;
}

std::string describe_worst(const Worst& worst) {
    return describe(*worst.offence) +
           (worst.numbers > 1 ? fmt::format("; {} numbers of it in all", worst.numbers) : "");
}

std::vector<const GatedScene*> pointers(const std::vector<GatedScene>& scenes) {
    std::vector<const GatedScene*> all;
    all.reserve(scenes.size());
    for (const auto& scene : scenes) all.push_back(&scene);
    return all;
}

std::string where(const Offence& o) { return o.a ? fmt::format("{:g} {}", *o.a, o.a_unit) : ""; }
std::string what(const Offence& o) {
    return o.of_limit ? fmt::format("limit on {}", name(o.quantity)) : name(o.quantity);
}

// Ratio to a noticeable change; "limit" for an absolute limit.
std::string times_noticeable(const Offence& o) {
    return o.of_limit ? "limit" : fmt::format("{:.3g}", o.noticed());
}

std::string verdict_of(const std::vector<GatedScene>& scenes) {
    switch (exit_code(scenes)) {
        case 0: return name(Judgement::passed);
        case 1: return name(Judgement::failed);
        case 2: return "BAD INPUT";
        default: return name(Judgement::could_not_judge);
    }
}
std::string verdict_of(const GatedScene& scene) {
    return scene.bad_input ? "BAD INPUT" : name(scene.verdict.judgement());
}

std::string class_of(const GatedScene& scene) {
    return scene.differs.empty() ? name(scene.verdict.kind)
                                 : fmt::format("{} ({})", name(scene.verdict.kind), scene.differs);
}

std::string headline(const GatedScene& scene) {
    const auto& verdict = scene.verdict;
    std::string line = fmt::format("{}: {}: ", scene.file, verdict_of(scene));
    if (verdict.offences.empty())
        line += fmt::format("{} numbers compared, none out of tolerance", verdict.compared);
    else
        line += fmt::format("{} of {} numbers out of tolerance", verdict.offences.size(),
                            verdict.compared);
    if (verdict.compared > 0) line += ", " + class_of(scene);
    if (!scene.widened.empty())
        line += fmt::format(", with tolerances wider than those of the class: {}",
                            fmt::join(scene.widened, ", "));
    return line;
}

// One cell of a Markdown table, truncated and escaped.
std::string cell(std::string_view text) {
    if (std::string safe = for_markdown(text); safe.size() <= cell_length) return safe;
    // each character may take a backslash
    std::size_t end = std::min(text.size(), cell_length / 2);
    while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) ++end;
    return for_markdown(text.substr(0, end)) + "...";
}

std::string joined(const std::vector<std::string>& parts) {
    std::string all;
    for (const auto& part : parts) all += (all.empty() ? "" : "; ") + part;
    return all;
}

json count_beyond(std::size_t all, std::size_t shown) {
    return all > shown ? json(std::to_string(all - shown)) : json(false);
}

// ---- JUnit: one test for whether the scene could be judged, and one per branch for its result.

struct Test {
    const GatedScene* scene;
    std::string name;
    std::vector<const Offence*> failed;
    bool error = false;  // the scene could not be judged

    bool passed() const { return failed.empty() && !error; }
};

std::vector<Test> tests_of(const GatedScene& scene) {
    std::vector<Test> tests{{&scene, "can be judged", {}, !scene.verdict.reasons.empty()}};
    const auto test = [&](const std::string& branch) -> Test& {
        const auto found = std::find_if(tests.begin() + 1, tests.end(), [&](const Test& t) {
            return t.name == "branch " + branch;
        });
        return found != tests.end() ? *found
                                    : tests.emplace_back(Test{&scene, "branch " + branch, {}});
    };
    for (const auto& s : scene.accepted.series) (void)test(s.branch);
    for (const auto& o : scene.verdict.offences) test(o.branch).failed.push_back(&o);
    return tests;
}

// Truncates a text to `most` bytes at a character boundary.
std::string beginning(std::string_view text, std::size_t most) {
    if (text.size() <= most) return std::string(text);
    while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xC0U) == 0x80U) --most;
    return std::string(text.substr(0, most)) + "...";
}

constexpr std::size_t line_length = 300;

// Up to `most` truncated lines, and the number of the others.
std::string lines(const std::vector<std::string>& all, std::size_t most) {
    std::string text;
    for (std::size_t k = 0; k < std::min(most, all.size()); ++k)
        text += beginning(all[k], line_length) + "\n";
    if (all.size() > most)
        text += fmt::format("... and {} more: elastocheck gate --json\n", all.size() - most);
    return text;
}

// An XML attribute ` name="value"`.
std::string attribute(const char* name, std::string_view value) {
    return fmt::format(" {}=\"{}\"", name, for_xml(beginning(value, line_length)));
}

std::string message(const char* kind, std::string_view summary, const std::string& text) {
    return fmt::format("   <{0}{1}>{2}</{0}>\n", kind, attribute("message", summary),
                       for_xml(text));
}

std::string testcase(const Test& test, std::size_t most_lines) {
    std::vector<std::string> all;
    for (const auto& change : test.scene->changed) all.push_back("changed: " + describe(change));
    const std::string changed = all.empty() ? "" : lines(all, most_lines);
    const std::vector<std::string>& reasons = test.scene->verdict.reasons;
    std::string messages;
    if (test.error)
        messages += message("error", reasons.front(),
                            headline(*test.scene) + "\n" + lines(reasons, most_lines) + changed);
    if (!test.failed.empty()) {
        std::vector<std::string> descriptions;
        for (const auto& worst : worst_of_each_channel(test.scene, test.failed))
            descriptions.push_back(describe_worst(worst));
        messages +=
            message("failure", descriptions.front(), lines(descriptions, most_lines) + changed);
    }
    return fmt::format("  <testcase{}{}>\n{}  </testcase>\n",
                       attribute("classname", test.scene->file), attribute("name", test.name),
                       messages);
}

// The first `most` tests, with up to `most_lines` numbers each.
std::string junit_of(const std::vector<Test>& tests, std::size_t most, std::size_t most_lines) {
    struct Suite {
        const GatedScene* scene;
        int tests = 0, failures = 0, errors = 0;
        std::string cases{};
    };
    std::vector<Suite> suites;
    for (std::size_t k = 0; k < std::min(most, tests.size()); ++k) {
        const Test& test = tests[k];
        auto suite = std::ranges::find(suites, test.scene, &Suite::scene);
        if (suite == suites.end()) suite = suites.insert(suite, {test.scene});
        suite->cases += testcase(test, most_lines);
        ++suite->tests;
        suite->failures += !test.failed.empty();
        suite->errors += test.error;
    }
    std::string xml =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuites name=\"elastocheck gate\">\n";
    for (const auto& suite : suites)
        xml += fmt::format(
            " <testsuite{} tests=\"{}\" failures=\"{}\" errors=\"{}\">\n{} </testsuite>\n",
            attribute("name", suite.scene->file), suite.tests, suite.failures, suite.errors,
            suite.cases);
    if (tests.size() > most) {
        const auto left =
            std::ranges::count_if(tests.begin() + static_cast<std::ptrdiff_t>(most), tests.end(),
                                  [](const Test& t) { return !t.passed(); });
        xml += fmt::format(
            " <testsuite name=\"left out\" tests=\"0\">\n  <system-out>{} more tests, {} of them "
            "failed, are left out to keep this file small; elastocheck gate --json has them "
            "all</system-out>\n </testsuite>\n",
            tests.size() - most, left);
    }
    return xml + "</testsuites>\n";
}

std::string annotation(const GatedScene& scene, const std::string& title, const std::string& text) {
    return fmt::format("::error file={},title={}::{}\n", for_github_property(scene.file),
                       for_github_property(title), for_github(text));
}

}  // namespace

int exit_code(const std::vector<GatedScene>& scenes) {
    bool failed = false, bad = false, unjudged = scenes.empty();
    for (const auto& scene : scenes) {
        const Judgement judgement = scene.verdict.judgement();
        failed = failed || judgement == Judgement::failed;
        bad = bad || scene.bad_input;
        unjudged = unjudged || judgement == Judgement::could_not_judge;
    }
    return failed ? 1 : bad ? 2 : unjudged ? 3 : 0;
}

std::string describe(const Offence& o) {
    std::string line = fmt::format("branch '{}', {}: {}", o.branch, name(o.quantity), o.channel);
    if (o.a) line += fmt::format(" at {:g} {}", *o.a, o.a_unit);
    if (o.of_limit)
        return line + fmt::format(": {:.6g} {} is {} its limit of {:g} {}", o.is, o.unit,
                                  o.is < o.was ? "below" : "over", o.was, o.unit);
    line += fmt::format(": accepted {:.10g} {}, measured {:.10g} {}, difference {:+.3g}", o.was,
                        o.unit, o.is, o.unit, o.difference());
    line += o.tolerance > 0
                ? fmt::format(", {:.3g} times the tolerance of {:.3g}", o.share(), o.tolerance)
                : ", and nothing is tolerated";
    return line + fmt::format(", {:.3g} times what an engineer notices", o.noticed());
}

std::string describe(const compare::Change& change) {
    const auto shown = [](const Number& n) {
        return fmt::format("{}{}{}", n.value, n.unit.empty() ? "" : " ", n.unit);
    };
    const std::string& path = (change.is ? change.is : change.was)->path;
    if (!change.is) return fmt::format("{}: is gone, was {}", path, shown(*change.was));
    if (!change.was) return fmt::format("{}: {}, is new", path, shown(*change.is));
    return fmt::format("{}: {}, was {}", path, shown(*change.is), shown(*change.was));
}

std::string gate_table(const GatedScene& scene) {
    const auto& verdict = scene.verdict;
    std::string out = headline(scene) + "\n";
    for (std::size_t k = 0; k < std::min(scene.changed.size(), rows_in_table); ++k)
        out += fmt::format("  changed: {}\n", describe(scene.changed[k]));
    if (scene.changed.size() > rows_in_table)
        out += fmt::format("  ... and {} more numbers of the scene\n",
                           scene.changed.size() - rows_in_table);
    const auto worst = worst_of_each_channel({&scene});
    if (!worst.empty())
        out += fmt::format("  {:10} {:32} {:28} {:>8} {:>16} {:>16} {:>12} {:>10} {:>10} {:>8}\n",
                           "branch", "what", "channel", "at", "accepted", "measured", "difference",
                           "noticeable", "tolerances", "numbers");
    for (std::size_t k = 0; k < std::min(worst.size(), rows_in_table); ++k) {
        const Offence& o = *worst[k].offence;
        out += fmt::format(
            "  {:10} {:32} {:28} {:>8} {:>16.10g} {:>16.10g} {:>+12.3g} {:>10} {:>10.3g} {:>8}\n",
            o.branch, what(o), fmt::format("{} [{}]", o.channel, o.unit), where(o), o.was, o.is,
            o.difference(), times_noticeable(o), o.share(), worst[k].numbers);
    }
    if (worst.size() > rows_in_table)
        out += fmt::format("  ... and {} more channels\n", worst.size() - rows_in_table);
    for (std::size_t k = 0; k < std::min(verdict.reasons.size(), rows_in_table); ++k)
        out += fmt::format("  could not judge: {}\n", verdict.reasons[k]);
    if (verdict.reasons.size() > rows_in_table)
        out += fmt::format("  ... and {} more reasons\n", verdict.reasons.size() - rows_in_table);
    for (const auto& note : scene.notes) out += fmt::format("  note: {}\n", note);
    return out;
}

std::string gate_conclusion(const std::vector<GatedScene>& scenes) {
    std::size_t failed = 0, unjudged = 0, offences = 0;
    int compared = 0;
    for (const auto& scene : scenes) {
        failed += scene.verdict.judgement() == Judgement::failed;
        unjudged += !scene.verdict.reasons.empty();
        offences += scene.verdict.offences.size();
        compared += scene.verdict.compared;
    }
    return fmt::format(
        "{}: {} of {} numbers out of tolerance, in {} of {} scenes; {} could not be judged wholly.",
        verdict_of(scenes), offences, compared, failed, scenes.size(), unjudged);
}

json gate_document(const std::vector<GatedScene>& scenes, const Provenance& provenance) {
    const auto number = [](const std::optional<Number>& n) {
        return n ? json{{"value", n->value}, {"unit", n->unit}} : json(nullptr);
    };
    json list = json::array();
    int compared = 0;
    for (const auto& scene : scenes) {
        json changed = json::array(), offences = json::array();
        for (const auto& change : scene.changed)
            changed.push_back({{"path", (change.is ? change.is : change.was)->path},
                               {"was", number(change.was)},
                               {"is", number(change.is)}});
        for (const auto& o : scene.verdict.offences) {
            json one = {{"branch", o.branch},
                        {"of", name(o.quantity)},
                        {"channel", o.channel},
                        {"unit", o.unit}};
            if (o.a) one["at"] = {{"value", *o.a}, {"unit", o.a_unit}};
            one["measured"] = o.is;
            one[o.of_limit ? "limit" : "accepted"] = o.was;
            if (!o.of_limit) one["tolerance"] = o.tolerance, one["noticeable"] = o.noticeable;
            offences.push_back(std::move(one));
        }
        compared += scene.verdict.compared;
        list.push_back({{"scene", scene.file},
                        {"baseline", scene.baseline_file},
                        {"verdict", verdict_of(scene)},
                        {"tolerance_class", name(scene.verdict.kind)},
                        {"because", scene.differs},
                        {"widened", scene.widened},
                        {"last_acceptance", scene.reason},
                        {"compared", scene.verdict.compared},
                        {"changed", changed},
                        {"offences", offences},
                        {"could_not_judge", scene.verdict.reasons},
                        {"notes", scene.notes}});
    }
    return {{"schema", gate_schema},         {"provenance", provenance_json(provenance)},
            {"verdict", verdict_of(scenes)}, {"exit_code", exit_code(scenes)},
            {"compared", compared},          {"scenes", list}};
}

std::string junit(const std::vector<GatedScene>& scenes) {
    std::vector<Test> tests;
    for (const auto& scene : scenes)
        for (auto& test : tests_of(scene)) tests.push_back(std::move(test));
    for (const std::size_t most_lines : {50, 10, 3, 1})
        if (std::string xml = junit_of(tests, tests.size(), most_lines); xml.size() < most_junit)
            return xml;
    std::stable_partition(tests.begin(), tests.end(),
                          [](const Test& test) { return !test.passed(); });
    std::size_t most = tests.size();
    for (;; most /= 2)
        if (std::string xml = junit_of(tests, most, 1); xml.size() < most_junit) return xml;
}

std::string step_summary(const std::vector<GatedScene>& scenes) {
    json offences = json::array(), reasons = json::array(), rows = json::array();
    const auto all = worst_of_each_channel(pointers(scenes));
    for (std::size_t k = 0; k < std::min(all.size(), rows_in_summary); ++k) {
        const Offence& o = *all[k].offence;
        offences.push_back({{"scene", cell(all[k].scene->file)},
                            {"branch", cell(o.branch)},
                            {"what", cell(what(o))},
                            {"channel", cell(fmt::format("{} [{}]", o.channel, o.unit))},
                            {"at", where(o)},
                            {"was", fmt::format("{:.10g}", o.was)},
                            {"is", fmt::format("{:.10g}", o.is)},
                            {"difference", fmt::format("{:+.3g}", o.difference())},
                            {"noticed", times_noticeable(o)},
                            {"share", fmt::format("{:.3g}", o.share())},
                            {"numbers", all[k].numbers}});
    }
    json changes = json::array();
    std::size_t changes_in_all = 0, reasons_in_all = 0;
    for (const auto& scene : scenes)
        for (const auto& change : scene.changed)
            if (++changes_in_all <= rows_in_summary)
                changes.push_back({{"scene", cell(scene.file)}, {"what", cell(describe(change))}});
    for (const auto& scene : scenes)
        for (const auto& why : scene.verdict.reasons) {
            if (++reasons_in_all > rows_in_summary) continue;
            reasons.push_back({{"scene", cell(scene.file)}, {"why", cell(why)}});
        }
    for (std::size_t k = 0; k < std::min(scenes.size(), scenes_in_summary); ++k)
        rows.push_back({{"scene", cell(scenes[k].file)},
                        {"verdict", verdict_of(scenes[k])},
                        {"compared", scenes[k].verdict.compared},
                        {"class", cell(class_of(scenes[k]))},
                        {"reason", cell(scenes[k].reason)},
                        {"notes", cell(joined(scenes[k].notes))}});
    return render("markdown/gate_summary",
                  {{"verdict", verdict_of(scenes)},
                   {"conclusion", gate_conclusion(scenes)},
                   {"has_offences", !all.empty()},
                   {"offences", offences},
                   {"more_offences", count_beyond(all.size(), rows_in_summary)},
                   {"has_changes", changes_in_all > 0},
                   {"changes", changes},
                   {"more_changes", count_beyond(changes_in_all, rows_in_summary)},
                   {"has_reasons", reasons_in_all > 0},
                   {"reasons", reasons},
                   {"more_reasons", count_beyond(reasons_in_all, rows_in_summary)},
                   {"scenes", rows},
                   {"more_scenes", count_beyond(scenes.size(), scenes_in_summary)}},
                  Escape::nothing);
}

std::string annotations(const std::vector<GatedScene>& scenes) {
    std::string out;
    std::size_t count = 0;
    for (const auto& worst : worst_of_each_channel(pointers(scenes))) {
        const auto& changed = worst.scene->changed;
        if (++count <= annotations_in_all)
            out += annotation(
                *worst.scene, "elastocheck gate: out of tolerance",
                describe_worst(worst) +
                    (changed.empty() ? ""
                                     : "; changed in the scene: " + describe(changed.front())) +
                    (changed.size() > 1 ? fmt::format(" and {} more", changed.size() - 1) : ""));
    }
    for (const auto& scene : scenes)
        for (const auto& why : scene.verdict.reasons)
            if (++count <= annotations_in_all)
                out += annotation(scene, "elastocheck gate: could not judge", why);
    return out;
}

}  // namespace elastocheck::reports
