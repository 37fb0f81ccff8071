#include "reports/gate/gate_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <pugixml.hpp>
#include <sstream>

#include "reports/page/templates.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {
namespace {

using compare::Judgement;
using compare::Offence;
using json = nlohmann::ordered_json;

constexpr std::size_t rows_in_table = 10, annotations_in_all = 10;
// A step summary is refused from 1 MiB on; this many rows of cells this long stay below it.
constexpr std::size_t rows_in_summary = 100, scenes_in_summary = 300, cell_length = 300;

// The worst number of a channel or counter, over branches, legs and loads: what a reader wants to know first.
struct Worst {
    const GatedScene* scene;
    const Offence* offence;
    std::size_t numbers = 1;  // of this channel out of tolerance in all
};

// Worst first, over all scenes.
std::vector<Worst> worst_of_each_channel(const std::vector<const GatedScene*>& scenes) {
    std::vector<Worst> all;
    for (const auto* scene : scenes) {
        std::map<std::string, std::size_t> place;
        for (const auto& offence : scene->verdict.offences) {  // worst first already
            const auto [at, is_new] = place.emplace(offence.channel, all.size());
            if (is_new)
                all.push_back({scene, &offence});
            else
                ++all[at->second].numbers;
        }
    }
    std::ranges::stable_sort(all, std::ranges::greater{}, [](const Worst& w) { return w.offence->share(); });
    return all;
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
        line += fmt::format("{} of {} numbers out of tolerance", verdict.offences.size(), verdict.compared);
    if (verdict.compared > 0) line += ", " + class_of(scene);
    return line;
}

// One cell of a Markdown table, not too long; nothing in it is markup.
std::string cell(std::string_view text) {
    if (std::string safe = for_markdown(text); safe.size() <= cell_length) return safe;
    std::size_t end = std::min(text.size(), cell_length / 2);  // every character may need a backslash
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

void add_message(pugi::xml_node test, const char* kind, std::string_view message, const std::string& text) {
    auto node = test.append_child(kind);
    node.append_attribute("message") = for_xml(message).c_str();
    node.text() = for_xml(text).c_str();
}

pugi::xml_node add_test(pugi::xml_node suite, const GatedScene& scene, const std::string& test_name) {
    auto test = suite.append_child("testcase");
    test.append_attribute("classname") = for_xml(scene.file).c_str();
    test.append_attribute("name") = for_xml(test_name).c_str();
    return test;
}

// One test says whether the scene could be judged;
// one more per branch and channel or counter what came of it.
void add_suite(pugi::xml_node root, const GatedScene& scene) {
    auto suite = root.append_child("testsuite");
    suite.append_attribute("name") = for_xml(scene.file).c_str();
    int tests = 1, failures = 0;
    const bool error = !scene.verdict.reasons.empty();

    auto judged = add_test(suite, scene, "can be judged");
    if (error)
        add_message(judged, "error", scene.verdict.reasons.front(),
                    headline(scene) + "\n" + fmt::format("{}", fmt::join(scene.verdict.reasons, "\n")));

    const auto title = [](const std::string& branch, compare::Quantity quantity, const std::string& channel) {
        const bool work = quantity >= compare::Quantity::work_recursive;
        return fmt::format("{}: {}{}", branch, work ? std::string(name(quantity)) + ": " : "", channel);
    };
    std::vector<std::string> titles;
    for (const auto& s : scene.accepted.series)
        if (const auto t = title(s.branch, s.quantity, s.channel);
            std::ranges::find(titles, t) == titles.end())
            titles.push_back(t);
    for (const auto& o : scene.verdict.offences)  // a limit may be on what the baseline does not hold
        if (const auto t = title(o.branch, o.quantity, o.channel);
            std::ranges::find(titles, t) == titles.end())
            titles.push_back(t);
    for (const auto& t : titles) {
        auto test = add_test(suite, scene, t);
        ++tests;
        std::vector<std::string> stories;
        for (const auto& o : scene.verdict.offences)
            if (title(o.branch, o.quantity, o.channel) == t) stories.push_back(story(o));
        if (stories.empty()) continue;
        ++failures;
        add_message(test, "failure", stories.front(), fmt::format("{}", fmt::join(stories, "\n")));
    }
    suite.append_attribute("tests") = tests;
    suite.append_attribute("failures") = failures;
    suite.append_attribute("errors") = error ? 1 : 0;
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

std::string story(const Offence& o) {
    std::string line = fmt::format("branch '{}', {}: {}", o.branch, name(o.quantity), o.channel);
    if (o.a) line += fmt::format(" at {:g} {}", *o.a, o.a_unit);
    if (o.of_limit)
        return line + fmt::format(": {:.6g} {} is over its limit of {:g} {}", o.is, o.unit, o.was, o.unit);
    line += fmt::format(": accepted {:.10g} {}, measured {:.10g} {}, difference {:+.3g}", o.was, o.unit, o.is,
                        o.unit, o.difference());
    return line + (o.tolerance > 0
                       ? fmt::format(", {:.3g} times the tolerance of {:.3g}", o.share(), o.tolerance)
                       : ", and nothing is tolerated");
}

std::string gate_table(const GatedScene& scene) {
    const auto& verdict = scene.verdict;
    std::string out = headline(scene) + "\n";
    const auto worst = worst_of_each_channel({&scene});
    if (!worst.empty())
        out += fmt::format("  {:10} {:32} {:28} {:>8} {:>16} {:>16} {:>12} {:>10} {:>8}\n", "branch", "what",
                           "channel", "at", "accepted", "measured", "difference", "tolerances", "numbers");
    for (std::size_t k = 0; k < std::min(worst.size(), rows_in_table); ++k) {
        const Offence& o = *worst[k].offence;
        out += fmt::format("  {:10} {:32} {:28} {:>8} {:>16.10g} {:>16.10g} {:>+12.3g} {:>10.3g} {:>8}\n",
                           o.branch, what(o), fmt::format("{} [{}]", o.channel, o.unit), where(o), o.was,
                           o.is, o.difference(), o.share(), worst[k].numbers);
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

std::string junit(const std::vector<GatedScene>& scenes) {
    pugi::xml_document document;
    auto declaration = document.append_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    declaration.append_attribute("encoding") = "UTF-8";
    auto root = document.append_child("testsuites");
    root.append_attribute("name") = "elastocheck gate";
    for (const auto& scene : scenes) add_suite(root, scene);
    std::ostringstream out;
    document.save(out, " ");
    return out.str();
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
                            {"share", fmt::format("{:.3g}", o.share())},
                            {"numbers", all[k].numbers}});
    }
    std::size_t reasons_in_all = 0;
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
    for (const auto& [scene, offence, numbers] : worst_of_each_channel(pointers(scenes)))
        if (++count <= annotations_in_all)
            out += annotation(
                *scene, "elastocheck gate: out of tolerance",
                story(*offence) + (numbers > 1 ? fmt::format("; {} numbers of it in all", numbers) : ""));
    for (const auto& scene : scenes)
        for (const auto& why : scene.verdict.reasons)
            if (++count <= annotations_in_all)
                out += annotation(scene, "elastocheck gate: could not judge", why);
    return out;
}

}  // namespace elastocheck::reports
