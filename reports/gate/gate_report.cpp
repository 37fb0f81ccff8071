#include "reports/gate/gate_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <span>

#include "reports/document/document.hpp"
#include "reports/render/render.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

using compare::Grade;
using compare::Offence;
using json = nlohmann::ordered_json;

constexpr std::size_t rows_in_table = 10, annotations_in_all = 10;
// A step summary is rejected from 1 MiB; this many rows with cells of this length stay below it.
constexpr std::size_t rows_in_summary = 100, scenes_in_summary = 300, cell_length = 300;

// Worst number of a channel or counter over branches, legs and loads.
struct WorstOffence {
    const GatedScene* scene;
    const Offence* offence;
    std::size_t numbers = 1;  // number of values of this channel out of tolerance
};

// In the order of comes_before, of each scene and over all.
std::vector<WorstOffence> worst_of_each_channel(const GatedScene* scene,
                                                const std::vector<const Offence*>& offences) {
    std::vector<WorstOffence> list;
    std::map<std::string_view, std::size_t> place;
    for (const auto* offence : offences) {
        const auto [entry, is_new] = place.emplace(offence->channel, list.size());
        if (is_new)
            list.push_back({scene, offence});
        else
            ++list[entry->second].numbers;
    }
    return list;
}
std::vector<WorstOffence> worst_of_each_channel(std::span<const GatedScene> scenes) {
    std::vector<WorstOffence> list;
    for (const auto& scene : scenes) {
        std::vector<const Offence*> offences;
        for (const auto& offence : scene.verdict.offences) offences.push_back(&offence);
        std::ranges::copy(worst_of_each_channel(&scene, offences), std::back_inserter(list));
    }
    std::ranges::stable_sort(list, [](const WorstOffence& a, const WorstOffence& b) {
        return comes_before(*a.offence, *b.offence);
    });
    return list;
}

std::string describe_worst(const WorstOffence& worst) {
    return describe(*worst.offence) +
           (worst.numbers > 1 ? fmt::format("; {} numbers of it in all", worst.numbers) : "");
}

std::vector<std::string> described(const std::vector<compare::Change>& changes) {
    std::vector<std::string> list;
    for (const auto& change : changes) list.push_back(describe(change));
    return list;
}

std::string quantity_name(const Offence& o) {
    return o.of_limit ? fmt::format("limit on {}", name(o.quantity)) : name(o.quantity);
}

// "was" is the accepted number, or the limit.
compare::Table offences_table(const std::vector<WorstOffence>& worst, bool with_scene) {
    using enum compare::Digits;
    using compare::nan;
    std::vector<compare::ColumnOf<WorstOffence>> columns{
        {"branch", words, [](const WorstOffence& w) { return w.offence->branch; }},
        {"what", words, [](const WorstOffence& w) { return quantity_name(*w.offence); }},
        {"channel", words, [](const WorstOffence& w) { return w.offence->channel; }},
        {"unit", words, [](const WorstOffence& w) { return w.offence->unit; }},
        {"at", given, [](const WorstOffence& w) { return w.offence->a.value_or(nan); }},
        {"unit of at", words, [](const WorstOffence& w) { return w.offence->a_unit; }, "", "", " "},
        {"accepted", given, [](const WorstOffence& w) { return w.offence->was; },
         "of a limit: its bound"},
        {"measured", given, [](const WorstOffence& w) { return w.offence->is; }},
        {"difference", three, [](const WorstOffence& w) { return w.offence->difference(); }},
        {"tolerance", hidden, [](const WorstOffence& w) { return w.offence->tolerance; }},
        {"noticeable", three,
         [](const WorstOffence& w) { return w.offence->of_limit ? nan : w.offence->noticed(); },
         "ratio to the smallest change that an engineer notices", "", "times noticeable"},
        {"tolerances", three, [](const WorstOffence& w) { return w.offence->share(); },
         "ratio to the tolerance; of a limit 1 + excess / |limit|", "", "times the tolerance"},
        {"numbers", whole, &WorstOffence::numbers, "of the channel out of it"}};
    if (with_scene)
        columns.insert(columns.begin(),
                       {"scene", words, [](const WorstOffence& w) { return w.scene->file; }});
    return compare::table({.id = "offences"}, columns, worst);
}

// Truncates a list to `most` entries; returns "... and 3 more channels", or nothing.
template <class List>
std::string cut(List& list, std::size_t most, const char* noun) {
    if (list.size() <= most) return "";
    const std::size_t omitted = list.size() - most;
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(most), list.end());
    return fmt::format("... and {} more{}", omitted, noun);
}

std::string verdict_of(const std::vector<GatedScene>& scenes) {
    constexpr std::array words{"passed", "FAILED", "BAD INPUT", "COULD NOT JUDGE"};
    return words.at(static_cast<std::size_t>(exit_code(scenes)));
}
std::string verdict_of(const GatedScene& scene) { return verdict_of(std::vector{scene}); }

std::string class_of(const GatedScene& scene) {
    return scene.class_reason.empty()
               ? name(scene.verdict.kind)
               : fmt::format("{} ({})", name(scene.verdict.kind), scene.class_reason);
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
std::string lines(std::vector<std::string> texts, std::size_t most) {
    const std::string more = cut(texts, most, ": elastocheck gate --json");
    std::string text;
    for (const auto& line : texts) text += beginning(line, line_length) + "\n";
    return more.empty() ? text : text + more + "\n";
}

// An XML attribute ` name="value"`.
std::string attribute(const char* name, std::string_view value) {
    return fmt::format(" {}=\"{}\"", name, for_xml(beginning(value, line_length)));
}

std::string message(const char* kind, std::string_view summary, const std::string& text) {
    return fmt::format("   <{0}{1}>{2}</{0}>\n", kind, attribute("message", summary),
                       for_xml(text));
}

std::string testcase(const Test& test, std::size_t max_lines) {
    std::vector<std::string> changes = described(test.scene->changed);
    for (auto& change : changes) change = "changed: " + change;
    const std::string changed = changes.empty() ? "" : lines(changes, max_lines);
    const std::vector<std::string>& reasons = test.scene->verdict.reasons;
    std::string messages;
    if (test.error)
        messages += message("error", reasons.front(),
                            headline(*test.scene) + "\n" + lines(reasons, max_lines) + changed);
    if (!test.failed.empty()) {
        std::vector<std::string> descriptions;
        for (const auto& worst : worst_of_each_channel(test.scene, test.failed))
            descriptions.push_back(describe_worst(worst));
        messages +=
            message("failure", descriptions.front(), lines(descriptions, max_lines) + changed);
    }
    return fmt::format("  <testcase{}{}>\n{}  </testcase>\n",
                       attribute("classname", test.scene->file), attribute("name", test.name),
                       messages);
}

// The tests with up to `max_lines` numbers each; those left out are counted.
std::string junit_of(std::span<const Test> tests, std::span<const Test> omitted,
                     std::size_t max_lines) {
    struct Suite {
        int tests = 0, failures = 0, errors = 0;
        std::string cases{};
    };
    std::map<const GatedScene*, Suite> suites;  // in the order of the scenes
    for (const Test& test : tests) {
        Suite& suite = suites[test.scene];
        suite.cases += testcase(test, max_lines);
        ++suite.tests;
        suite.failures += !test.failed.empty();
        suite.errors += test.error;
    }
    std::string xml =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuites name=\"elastocheck gate\">\n";
    for (const auto& [scene, suite] : suites)
        xml += fmt::format(
            " <testsuite{} tests=\"{}\" failures=\"{}\" errors=\"{}\">\n{} </testsuite>\n",
            attribute("name", scene->file), suite.tests, suite.failures, suite.errors, suite.cases);
    if (!omitted.empty())
        xml += fmt::format(
            " <testsuite name=\"left out\" tests=\"0\">\n  <system-out>{} more tests, {} of them "
            "failed, are left out to keep this file small; elastocheck gate --json has them "
            "all</system-out>\n </testsuite>\n",
            omitted.size(),
            std::ranges::count_if(omitted, [](const Test& t) { return !t.passed(); }));
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
        failed = failed || scene.verdict.grade() == Grade::fail;
        bad = bad || scene.bad_input;
        unjudged = unjudged || scene.verdict.grade() == Grade::not_judged;
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
    std::string out = headline(scene) + "\n";
    const auto list = [&](const char* title, std::vector<std::string> texts, const char* noun) {
        const std::string more = cut(texts, rows_in_table, noun);
        for (const auto& text : texts) out += fmt::format("  {}: {}\n", title, text);
        if (!more.empty()) out += "  " + more + "\n";
    };
    list("changed", described(scene.changed), " numbers of the scene");
    auto worst = worst_of_each_channel(std::span(&scene, 1));
    const std::string more = cut(worst, rows_in_table, " channels");
    if (!worst.empty()) out += text(offences_table(worst, false));
    if (!more.empty()) out += "  " + more + "\n";
    list("could not judge", scene.verdict.reasons, " reasons");
    for (const auto& note : scene.notes) out += fmt::format("  note: {}\n", note);
    return out;
}

std::string gate_conclusion(const std::vector<GatedScene>& scenes) {
    std::size_t failed = 0, unjudged = 0, offences = 0;
    int compared = 0;
    for (const auto& scene : scenes) {
        failed += scene.verdict.grade() == Grade::fail;
        unjudged += !scene.verdict.reasons.empty();
        offences += scene.verdict.offences.size();
        compared += scene.verdict.compared;
    }
    return fmt::format(
        "{}: {} of {} numbers out of tolerance, in {} of {} scenes; {} could not be judged wholly.",
        verdict_of(scenes), offences, compared, failed, scenes.size(), unjudged);
}

json gate_document(const std::vector<GatedScene>& scenes, const Provenance& provenance) {
    json list = json::array();
    int compared = 0;
    for (const auto& scene : scenes) {
        std::vector<WorstOffence> offences;
        for (const auto& offence : scene.verdict.offences) offences.push_back({&scene, &offence});
        compared += scene.verdict.compared;
        list.push_back({{"scene", scene.file},
                        {"baseline", scene.baseline_file},
                        {"verdict", verdict_of(scene)},
                        {"tolerance_class", name(scene.verdict.kind)},
                        {"because", scene.class_reason},
                        {"widened", scene.widened},
                        {"last_acceptance", scene.reason},
                        {"compared", scene.verdict.compared},
                        {"changed", table_json(compare::table_of(scene.changed))},
                        {"offences", table_json(offences_table(offences, false))},
                        {"could_not_judge", scene.verdict.reasons},
                        {"notes", scene.notes}});
    }
    return {{"schema", gate_schema},         {"provenance", provenance_json(provenance)},
            {"verdict", verdict_of(scenes)}, {"exit_code", exit_code(scenes)},
            {"compared", compared},          {"scenes", list}};
}

std::string junit(const std::vector<GatedScene>& scenes) {
    std::vector<Test> tests;
    for (const auto& scene : scenes) std::ranges::move(tests_of(scene), std::back_inserter(tests));
    for (const std::size_t max_lines : {50, 10, 3, 1})
        if (std::string xml = junit_of(tests, {}, max_lines); xml.size() < max_junit) return xml;
    std::ranges::stable_partition(tests, [](const Test& test) { return !test.passed(); });
    const std::span all(tests);
    for (std::size_t most = tests.size();; most /= 2)
        if (std::string xml = junit_of(all.first(most), all.subspan(most), 1);
            xml.size() < max_junit)
            return xml;
}

std::string step_summary(const std::vector<GatedScene>& scenes) {
    std::string page =
        fmt::format("# elastocheck gate: {}\n\n{}\n", verdict_of(scenes), gate_conclusion(scenes));
    const auto add = [&](const std::string& part, const std::string& more) {
        if (!part.empty()) page += "\n" + part;
        if (!more.empty()) page += "\n" + more + ".\n";
    };
    auto worst = worst_of_each_channel(scenes);
    const std::string more_worst = cut(worst, rows_in_summary, " channels");
    add(worst.empty() ? "" : markdown(offences_table(worst, true), cell_length), more_worst);
    const auto list = [&](const char* title, const auto& texts_of, const char* noun) {
        std::vector<std::string> items;
        for (const auto& scene : scenes)
            for (const auto& text : texts_of(scene))
                items.push_back(fmt::format("- {}: {}\n", markdown(scene.file, cell_length),
                                            markdown(text, cell_length)));
        const std::string more = cut(items, rows_in_summary, noun);
        add(items.empty() ? "" : fmt::format("{}:\n\n{}", title, fmt::join(items, "")), more);
    };
    list(
        "Changed in the scene", [](const GatedScene& s) { return described(s.changed); },
        " numbers of scenes");
    list(
        "Could not be judged", [](const GatedScene& s) { return s.verdict.reasons; }, "");
    const std::size_t shown = std::min(scenes.size(), scenes_in_summary);
    using enum compare::Digits;
    using Gated = GatedScene;
    const compare::Table table = compare::table<Gated>(
        {.id = "scenes"},
        {{"scene", words, &Gated::file},
         {"verdict", words, [](const Gated& s) { return verdict_of(s); }},
         {"numbers compared", whole, [](const Gated& s) { return s.verdict.compared; }},
         {"tolerance class", words, [](const Gated& s) { return class_of(s); }},
         {"last acceptance", words, &Gated::reason},
         {"notes", words,
          [](const Gated& s) { return fmt::format("{}", fmt::join(s.notes, "; ")); }}},
        std::span(scenes).first(shown));
    page += "\n<details><summary>All scenes</summary>\n";
    add(markdown(table, cell_length),
        shown < scenes.size() ? fmt::format("... and {} more", scenes.size() - shown) : "");
    return page + "\n</details>\n";
}

std::string annotations(const std::vector<GatedScene>& scenes) {
    std::string out;
    std::size_t count = 0;
    for (const auto& worst : worst_of_each_channel(scenes)) {
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
