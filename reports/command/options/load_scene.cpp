#include "reports/command/options/load_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

#include <algorithm>

#include "compare/comparison/elements.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/warnings/plausibility.hpp"
#include "models/branch.hpp"
#include "models/reader/document/suggestions.hpp"
#include "models/reader/document/text_file.hpp"
#include "models/reader/document/yaml.hpp"
#include "recursive/soft_motion.hpp"
#include "reports/document/document.hpp"
#include "reports/files/files.hpp"
#include "reports/files/terminal.hpp"
#include "reports/given/headings.hpp"

namespace elastocheck::reports {

namespace {

// The outputs by the definitions that a scene requests. A figure or definition that does not exist, or
// that this scene does not have, is an error; of a set, only the figures that the scene has are taken.
std::vector<compare::Channel> requested(const std::vector<reader::RequestedDefinition>& list,
                                        const Model& model, const std::string& file) {
    std::vector<compare::Channel> outputs;
    if (list.empty()) return outputs;
    const auto all = compare::definition_channels(model), own = compare::characteristics(model);
    const auto definitions = compare::definitions();
    // Adds the outputs of a figure by a definition, of every wheel; returns whether there is one.
    const auto add = [&](const std::string& figure, const std::string& name) {
        bool any = false;
        for (const compare::Channel& channel : all) {
            if (compare::figure_of(channel.name) != figure || !channel.name.ends_with("@" + name))
                continue;
            any = true;
            if (compare::find_channel(outputs, channel.name) < 0 &&
                compare::find_channel(own, channel.name) < 0)
                outputs.push_back(channel);
        }
        return any;
    };
    for (const auto& request : list) {
        const auto fail = [&](const std::string& what) {
            reader::fail(file, request.line, request.path, what);
        };
        std::vector<std::string> names;
        if (request.figure.empty()) {
            const auto sets = compare::definition_sets();
            const auto set = std::ranges::find(sets, request.name, &compare::DefinitionSet::name);
            for (const auto& known : sets) names.push_back(known.name);
            if (set == sets.end())
                fail(fmt::format("there is no set {}{}", reader::quote(request.name),
                                 reader::did_you_mean(request.name, names, "allowed")));
            bool any = false;
            for (const std::string& member : set->members) {
                const auto at = member.find('@');
                any = add(member.substr(0, at), member.substr(at + 1)) || any;
            }
            if (!any) fail("the scene has none of its figures");
            continue;
        }
        std::vector<std::string> figures;
        const auto add_once = [](std::vector<std::string>& words, std::string word) {
            if (std::ranges::find(words, word) == words.end()) words.push_back(std::move(word));
        };
        for (const compare::Entry* known : definitions) {
            const auto at = known->name.find('@');
            add_once(figures, known->name.substr(0, at));
            if (known->name.substr(0, at) == request.figure)
                add_once(names, known->name.substr(at + 1));
        }
        if (names.empty())
            fail(fmt::format("no figure with other definitions{}",
                             reader::did_you_mean(request.figure, figures, "allowed")));
        if (std::ranges::find(names, request.name) == names.end())
            fail(fmt::format("there is no definition {}{}", reader::quote(request.name),
                             reader::did_you_mean(request.name, names, "allowed")));
        if (!add(request.figure, request.name))
            fail(fmt::format("the scene has no {} by the definition {}", request.figure,
                             reader::quote(request.name)));
    }
    for (auto& output : outputs) output.main = output.kinematic();
    return outputs;
}

// The requested channels, in that order, each once; those after the first `own` are figures by other
// definitions.
// Throws std::invalid_argument for a pattern without a match, with the nearest name.
std::vector<compare::Channel> chosen(const std::vector<compare::Channel>& all, std::size_t own,
                                     const std::vector<std::string>& patterns) {
    std::vector<compare::Channel> list;
    std::vector<std::string> names;
    for (const auto& channel : all) names.push_back(channel.name);
    for (const auto& pattern : patterns) {
        // "suspension.*" does not mean suspension.motion_ratio@inverse; "suspension.*@*" does
        const bool with_definitions = pattern.find('@') != std::string::npos;
        bool fits = false;
        for (std::size_t k = 0; k < all.size(); ++k) {
            const auto& channel = all[k];
            if (channel.name != pattern &&
                ((!with_definitions && k >= own) ||
                 ::fnmatch(pattern.c_str(), channel.name.c_str(), 0) != 0))
                continue;
            fits = true;
            if (compare::find_channel(list, channel.name) < 0) list.push_back(channel);
        }
        if (fits) continue;
        std::vector<std::string> tests;  // of an axle, which has no figure without its test
        for (const auto& name : names)
            if (name.starts_with(pattern + "@")) tests.push_back(name);
        throw std::invalid_argument(
            fmt::format("--channels: there is no output {}{}", reader::quote(pattern),
                        tests.empty() ? reader::did_you_mean(pattern, names, "outputs")
                                      : fmt::format("; allowed: {}", fmt::join(tests, ", "))));
    }
    return list;
}

// "FILE:LINE: place: what"; an entry that was made by mirroring has the line of its section.
std::vector<std::string> located(const std::vector<compare::Implausible>& list,
                                 const std::string& file) {
    std::vector<std::string> lines;
    if (list.empty()) return lines;
    const reader::TextFile read = reader::read_text(file, reader::Pipes::refused);
    const reader::Value tree =
        read.trouble.empty() ? reader::parse_yaml(read.text, file) : reader::Value{};
    for (const auto& [place, what] : list) {
        const reader::Value* at = &tree;
        std::string path;
        for (const auto& key : place) {
            path += (path.empty() ? "" : ".") + key;
            const auto found = std::ranges::find(at->keys, key);
            if (found == at->keys.end()) break;
            at = &at->items[static_cast<std::size_t>(found - at->keys.begin())];
        }
        const std::string line = at == &tree ? "" : fmt::format("{}:", at->line);
        lines.push_back(fmt::format("{}:{} {}: {}", file, line, path, what));
    }
    return lines;
}

// The reason why the trim fails, after the free motions or locked bodies of the drawn scene, which cause
// it; without any, followed by the softest motion, which may be the cause.
std::string cause(const Scene& scene, const std::string& reason) {
    const Model drawn = on_branch(compile(scene), {});
    std::string text;
    for (const auto& line : recursive::free_or_locked(drawn)) text += line + "; ";
    if (!text.empty()) return text + "so the trim fails: " + reason;
    const auto soft = recursive::softest_motion(drawn, {}, compare::design_state(drawn), true);
    return soft.empty() ? reason : reason + "; the softest motion as drawn is " + soft;
}

}  // namespace

LoadedScene trimmed_and_compiled(reader::SceneAndWarnings read, const std::string& file,
                                 Detail detail) {
    auto& [scene, warnings, definitions] = read;
    const auto where = [&, &scene = scene] {
        return scene.trim && scene.trim->line > 0
                   ? fmt::format("{}:{}: trim", file, scene.trim->line)
                   : file + ": trim";
    };
    compare::Trimmed trimmed;
    try {
        trimmed = compare::trim(scene);
    } catch (const std::invalid_argument& error) {
        throw SceneError(fmt::format("{}: {}", where(), cause(scene, error.what())));
    }
    if (trimmed.record && !trimmed.record->reached())
        throw NotTrimmed(fmt::format("{}: {}", where(), cause(scene, trimmed.record->detail)));
    Model model = compile(trimmed.scene, detail);
    std::ranges::move(located(compare::implausible(model), file), std::back_inserter(warnings));
    auto outputs = requested(definitions, model, file);
    return {std::move(trimmed.scene), std::move(model), std::move(trimmed.record),
            std::move(warnings), std::move(outputs)};
}

LoadedScene load_scene(const std::string& file, const Settings& settings, Detail detail,
                       std::exception_ptr* not_trimmed) {
    auto read = reader::read_scene_with_warnings(file, settings);
    std::size_t printed = 0;
    const auto print_from = [&](const std::vector<std::string>& warnings) {
        for (; printed < warnings.size(); ++printed)
            print_error("{} (warning)\n", warnings[printed]);
    };
    print_from(read.warnings);
    LoadedScene loaded;
    try {
        loaded = trimmed_and_compiled(read, file, detail);
    } catch (...) {
        if (not_trimmed == nullptr || !read.scene.trim) throw;
        *not_trimmed = std::current_exception();
        read.scene.trim.reset();
        loaded = trimmed_and_compiled(read, file, detail);
    }
    print_from(loaded.warnings);
    return loaded;
}

std::vector<compare::Channel> requested_channels(const LoadedScene& loaded,
                                                 const std::vector<std::string>& patterns) {
    const Model& model = loaded.model;
    auto all = compare::channels(model);
    if (patterns.empty()) {
        std::ranges::copy(loaded.definitions, std::back_inserter(all));
        return all;
    }
    std::ranges::move(compare::characteristics(model), std::back_inserter(all));
    std::ranges::move(compare::element_channels(model), std::back_inserter(all));
    std::ranges::move(compare::sums(model), std::back_inserter(all));
    const std::size_t own = all.size();
    std::ranges::move(compare::definition_channels(model), std::back_inserter(all));
    return chosen(all, own, patterns);
}

SceneAnalyses analyses_of(const LoadedScene& loaded, const std::string& file) {
    return {.scene = loaded.scene,
            .model = loaded.model,
            .trim = loaded.trim,
            .warnings = loaded.warnings,
            .hash = input_hash(read_whole(file))};
}

nlohmann::ordered_json document_of(const LoadedScene& loaded, const std::string& file) {
    return scene_head(analyses_of(loaded, file));
}

const Branch& branch_named(const Model& model, const std::string& name, const char* option) {
    std::vector<std::string> names;
    for (const auto& branch : model.branches) {
        if (branch.name == name) return branch;
        names.push_back(branch.name);
    }
    throw std::invalid_argument(fmt::format("{}: {}", option, no_branch(name, names)));
}

}  // namespace elastocheck::reports
