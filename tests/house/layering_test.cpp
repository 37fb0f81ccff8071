// Includes between folders of source files; the public headers in
// include/elastocheck/ belong to the part of the product that defines what they declare.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Part {
    std::string folder;
    std::vector<std::string> public_headers;
    std::vector<std::string> may_include;  // parts, besides itself
};

const std::vector<Part> parts{
    {"models/reader", {"read_scene"}, {"models"}},  // before the part whose folder it is in
    {"models/import", {}, {"models/reader", "models"}},
    {"models", {"mechanism", "scene", "model", "compile", "equilibrium_path"}, {}},
    {"recursive", {"recursive", "recursive_batch", "recursive_method"}, {"models"}},
    {"reference/equilibrium", {"equilibrium"}, {"models"}},
    {"reference/energy", {"energy"}, {"models"}},
    {"reference/certificate", {}, {"models"}},
    {"compare",
     {"*"},  // every other public header
     {"models", "models/reader", "recursive", "reference/equilibrium", "reference/energy",
      "reference/certificate"}},
    {"reports",
     {},
     {"models/reader", "models/import", "models", "recursive", "reference/equilibrium",
      "reference/energy", "reference/certificate", "compare"}},
};

// A solver library belongs to one leg, and to its .cpp files. The numbers of a scene that
// compare/design/ searches with NLopt are no unknowns of a leg.
const std::map<std::string, std::vector<std::string>> owners_of_library{
    {"ceres/", {"reference/equilibrium"}}, {"nlopt", {"reference/energy", "compare/design"}}};

constexpr std::size_t max_files = 20;  // in a folder

bool is_below(const std::string& path, const std::string& folder) {
    return path.starts_with(folder + "/");
}

// The part that a file belongs to, by its path in the tree or as it is included; null if none.
const Part* part_of(std::string path) {
    if (path.starts_with("include/")) path.erase(0, std::string("include/").size());
    if (is_below(path, "elastocheck")) {
        const std::string name = fs::path(path).stem();
        for (const Part& part : parts)
            for (const std::string& header : part.public_headers)
                if (header == name || header == "*") return &part;
    }
    const auto part =
        std::ranges::find_if(parts, [&](const Part& p) { return is_below(path, p.folder); });
    return part == parts.end() ? nullptr : &*part;
}

// The folder of a file, or the public headers of a part.
std::string folder_of(const std::string& path) {
    if (is_below(path, "include/elastocheck") || is_below(path, "elastocheck"))
        return part_of(path)->folder + " (public)";
    return fs::path(path).parent_path();
}

struct Include {
    std::string target;
    bool quoted;
};
std::vector<Include> includes(const std::string& text) {
    static const std::regex include(R"(^\s*#\s*include\s*(["<])([^">]+)[">])");
    std::vector<Include> found;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (std::smatch match; std::regex_search(line, match, include))
            found.push_back({match[2], match[1] == "\""});
    return found;
}

// What is wrong with the includes of one file.
std::vector<std::string> violations(const std::string& file, const std::string& text) {
    const Part* part = part_of(file);
    if (!part) return {file + ": in no part of the product"};
    std::vector<std::string> found;
    for (const auto& [target, quoted] : includes(text)) {
        const bool relative = target.starts_with("../") || target.find("/../") != target.npos;
        if (relative) found.push_back(file + ": a relative include: " + target);
        if (target.starts_with("tests/")) found.push_back(file + " includes " + target);
        const Part* other = part_of(target);
        const bool generated = file.ends_with(".cpp") && target.find('/') == target.npos && quoted;
        if ((other != nullptr) != quoted && !generated && !relative)
            found.push_back(
                file + ": the product is included as \"FOLDER/...\", all else as <...>: " + target);
        if (other && other != part && std::ranges::count(part->may_include, other->folder) == 0)
            found.push_back(file + " includes " + target);
        for (const auto& [library, owners] : owners_of_library) {
            if (!target.starts_with(library)) continue;
            if (std::ranges::none_of(owners, [&](const auto& o) { return is_below(file, o); }))
                found.push_back(file + " includes " + target + ", which belongs to " +
                                owners.front());
            else if (file.ends_with(".hpp"))
                found.push_back(file + ": a header includes " + target);
        }
    }
    return found;
}

struct Source {
    std::string file, text;
};

// Every source file of the product.
const std::vector<Source>& sources() {
    static const std::vector<Source> all = [] {
        std::vector<Source> files;
        for (const char* folder :
             {"include", "models", "recursive", "reference", "compare", "reports"})
            for (const auto& entry :
                 fs::recursive_directory_iterator(fs::path(ELASTOCHECK_ROOT) / folder)) {
                if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp")
                    continue;
                std::ifstream in(entry.path());
                std::ostringstream text;
                text << in.rdbuf();
                files.push_back({fs::relative(entry.path(), ELASTOCHECK_ROOT), text.str()});
            }
        return files;
    }();
    EXPECT_GT(all.size(), 100u);
    return all;
}

using Graph = std::map<std::string, std::set<std::string>>;

// The folders of a cycle of includes; empty if there is none.
std::vector<std::string> cycle(const Graph& graph) {
    std::set<std::string> finished;
    std::vector<std::string> path, found;
    const auto visit = [&](const auto& self, const std::string& folder) -> bool {
        if (const auto at = std::ranges::find(path, folder); at != path.end()) {
            found.assign(at, path.end());
            return true;
        }
        if (finished.contains(folder)) return false;
        path.push_back(folder);
        if (const auto next = graph.find(folder); next != graph.end())
            for (const std::string& other : next->second)
                if (self(self, other)) return true;
        path.pop_back();
        finished.insert(folder);
        return false;
    };
    for (const auto& [folder, next] : graph)
        if (visit(visit, folder)) break;
    return found;
}

TEST(Layering, IncludesRunDownwardsAndNeverBetweenLegs) {
    for (const auto& [file, text] : sources())
        for (const auto& violation : violations(file, text)) ADD_FAILURE() << violation;
}

TEST(Layering, FoldersIncludeEachOtherInNoCycle) {
    Graph graph;
    for (const auto& [file, text] : sources())
        for (const auto& [target, quoted] : includes(text))
            if (quoted && part_of(target) && folder_of(target) != folder_of(file))
                graph[folder_of(file)].insert(folder_of(target));
    EXPECT_GT(graph.size(), 20u);
    for (const std::string& folder : cycle(graph)) ADD_FAILURE() << "in a cycle: " << folder;
}

TEST(Layering, AFolderHoldsAtMostTwentySourceFiles) {
    std::map<fs::path, std::size_t> count;
    for (const auto& source : sources()) ++count[fs::path(source.file).parent_path()];
    for (const auto& [folder, files] : count) EXPECT_LE(files, max_files) << folder;
}

TEST(Layering, FoldersOfReportsIncludeOnlyAllowedAnalyses) {
    const std::map<std::string, std::vector<std::string>> allowed{
        {"reports/page", {"compare/result", "compare/tables", "compare/outputs"}},
        {"reports/tables", {"compare"}},
        {"reports/gate", {"compare/gate", "compare/comparison"}},
        {"reports/text", {}},
        {"reports/files", {}},
        {"reports/json", {}}};
    for (const auto& [file, text] : sources())
        for (const auto& [folder, folders] : allowed)
            for (const auto& [target, quoted] : includes(text))
                if (is_below(file, folder) &&
                    (is_below(target, "compare") || is_below(target, "recursive"))) {
                    EXPECT_TRUE(std::ranges::any_of(
                        folders, [&](const std::string& r) { return is_below(target, r); }))
                        << file << " includes " << target;
                }
}

TEST(Layering, ThePageReadsNoJson) {
    for (const auto& [file, text] : sources())
        for (const auto& [target, quoted] : includes(text)) {
            EXPECT_FALSE(is_below(file, "reports/page") && is_below(target, "reports/json"))
                << file << " includes " << target;
        }
}

// A generic visitor that tests for a member would skip a new kind silently.
TEST(Layering, VisitorsAreExhaustive) {
    static const std::regex asked(R"(if\s+constexpr\s*\(\s*!?\s*requires\b)");
    EXPECT_TRUE(std::regex_search("if constexpr (requires { point.s_local; }) {", asked));
    for (const auto& [file, text] : sources()) EXPECT_FALSE(std::regex_search(text, asked)) << file;
}

TEST(Layering, ForbiddenIncludesAreDetected) {
    EXPECT_EQ(
        violations("recursive/a.cpp", "#include \"elastocheck/model.hpp\"\n#include <Eigen/Core>\n")
            .size(),
        0u);
    EXPECT_EQ(violations("recursive/a.cpp", "#include \"elastocheck/energy.hpp\"\n").size(), 1u);
    EXPECT_EQ(violations("reference/energy/a.cpp", "  #  include \"recursive/formula/state.hpp\"\n")
                  .size(),
              1u);
    EXPECT_EQ(violations("recursive/a.cpp", "#include <elastocheck/model.hpp>\n").size(), 1u);
    EXPECT_EQ(violations("recursive/a.cpp", "#include \"elastocheck/models/curve.hpp\"\n").size(),
              1u);
    EXPECT_EQ(violations("recursive/a.hpp", "#include \"state.hpp\"\n").size(), 1u);
    EXPECT_EQ(violations("reports/a.cpp", "#include \"build_info.hpp\"\n").size(), 0u);
    EXPECT_EQ(
        violations("reference/energy/a.cpp", "#include \"elastocheck/equilibrium.hpp\"\n").size(),
        1u);
    EXPECT_EQ(violations("reference/certificate/a.cpp",
                         "#include \"reference/equilibrium/statement/laws.hpp\"\n")
                  .size(),
              1u);
    EXPECT_EQ(violations("models/a.hpp", "#include \"compare/comparison/compare.hpp\"\n").size(),
              1u);
    EXPECT_EQ(violations("compare/a.hpp", "#include \"reports/csv.hpp\"\n").size(), 1u);
    EXPECT_EQ(
        violations("recursive/a.cpp", "#include \"../reference/energy/linear_response.hpp\"\n")
            .size(),
        1u);
    EXPECT_EQ(violations("recursive/a.cpp", "#include <ceres/jet.h>\n").size(), 1u);
    EXPECT_EQ(violations("reference/equilibrium/a.hpp", "#include <ceres/jet.h>\n").size(), 1u);
    EXPECT_EQ(violations("reference/equilibrium/a.cpp", "#include <ceres/jet.h>\n").size(), 0u);
    EXPECT_EQ(violations("reference/energy/a.cpp", "#include <ceres/jet.h>\n").size(), 1u);
    EXPECT_EQ(violations("compare/design/a.cpp", "#include <nlopt.h>\n").size(), 0u);
    EXPECT_EQ(violations("compare/design/a.hpp", "#include <nlopt.h>\n").size(), 1u);
    EXPECT_EQ(violations("compare/a.cpp", "#include <nlopt.h>\n").size(), 1u);
    EXPECT_EQ(violations("elsewhere/a.cpp", "").size(), 1u);
    EXPECT_EQ(cycle({{"a", {"b"}}, {"b", {"c"}}, {"c", {}}}).size(), 0u);
    EXPECT_EQ(cycle({{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}}).size(), 2u);
}

}  // namespace
