// Includes run downwards only, and never from one leg to another.
#include <gtest/gtest.h>

#include <algorithm>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Arena {
    std::string folder;
    std::vector<std::string> may_include;
};

// A folder may include itself and what is listed.
const std::vector<Arena> rooms{
    {"models/reader", {"models"}},  // before the room it stands in
    {"models/import", {"models/reader", "models"}},
    {"models", {}},
    {"recursive", {"models"}},
    {"reference/equilibrium", {"models"}},
    {"reference/energy", {"models"}},
    {"reference/certificate", {"models"}},
    {"compare",
     {"models", "recursive", "reference/equilibrium", "reference/energy", "reference/certificate"}},
    {"reports",
     {"models/reader", "models/import", "models", "recursive", "reference/equilibrium",
      "reference/energy", "reference/certificate", "compare"}},
};

bool is_below(const std::string& path, const std::string& folder) {
    return path.starts_with(folder + "/");
}

// What is wrong with the includes of one file. The installed headers carry the prefix elastocheck/, which is put
// before what stands in quotes and begins with a room; so that is how the house is included.
std::vector<std::string> violations(const std::string& file, const std::string& text) {
    std::vector<std::string> found;
    const auto room =
        std::ranges::find_if(rooms, [&](const Arena& r) { return is_below(file, r.folder); });
    if (room == rooms.end()) return {file + ": in no room of the house"};
    static const std::regex include(R"(^\s*#\s*include\s*(["<])([^">]+)[">])");
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (!std::regex_search(line, match, include)) continue;
        const bool quoted = match[1] == "\"";
        std::string target = match[2];
        const bool prefixed = target.starts_with("elastocheck/");
        if (prefixed) target.erase(0, std::string("elastocheck/").size());
        const bool relative = target.starts_with("../") || target.find("/../") != target.npos;
        const bool ours =
            std::ranges::any_of(rooms, [&](const Arena& r) { return is_below(target, r.folder); });
        const bool generated = file.ends_with(".cpp") && target.find('/') == target.npos && quoted;
        if (prefixed || (ours != quoted && !generated && !relative))
            found.push_back(file + ": the house is included as \"ROOM/...\", all else as <...>: " +
                            match.str());
        if (relative) found.push_back(file + ": a relative include hides where it goes: " + target);
        if (target.starts_with("tests/")) found.push_back(file + " includes " + target);
        for (const Arena& other : rooms) {
            if (!is_below(target, other.folder) || other.folder == room->folder) continue;
            if (std::ranges::find(room->may_include, other.folder) == room->may_include.end())
                found.push_back(file + " includes " + target);
        }
        // Each solver library belongs to one leg, and none to a header.
        for (const auto& [library, owner] :
             {std::pair{"ceres/", "reference/equilibrium"}, {"nlopt", "reference/energy"}}) {
            if (!target.starts_with(library)) continue;
            if (room->folder != owner)
                found.push_back(file + " includes " + target + ", which belongs to " + owner);
            else if (file.ends_with(".hpp"))
                found.push_back(file + ": a header includes " + target);
        }
    }
    return found;
}

struct Source {
    std::string file, text;
};

// Every file of the product.
std::vector<Source> sources() {
    std::vector<Source> all;
    for (const char* folder : {"models", "recursive", "reference", "compare", "reports"})
        for (const auto& entry :
             fs::recursive_directory_iterator(fs::path(ELASTOCHECK_ROOT) / folder)) {
            if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
            std::ifstream in(entry.path());
            std::ostringstream text;
            text << in.rdbuf();
            all.push_back({fs::relative(entry.path(), ELASTOCHECK_ROOT), text.str()});
        }
    EXPECT_GT(all.size(), 100u);
    return all;
}

TEST(Layering, IncludesRunDownwardsAndNeverBetweenLegs) {
    for (const auto& [file, text] : sources())
        for (const auto& violation : violations(file, text)) ADD_FAILURE() << violation;
}

// A visit that asks what a kind can do, instead of saying what is done with each, leaves a new kind out silently.
TEST(Layering, NoKindIsLeftOutSilently) {
    static const std::regex asked(R"(if\s+constexpr\s*\(\s*!?\s*requires\b)");
    EXPECT_TRUE(std::regex_search("if constexpr (requires { point.s_local; }) {", asked));
    for (const auto& [file, text] : sources()) EXPECT_FALSE(std::regex_search(text, asked)) << file;
}

TEST(Layering, AlarmRings) {
    EXPECT_EQ(violations("recursive/a.cpp",
                         "#include \"include/elastocheck/model.hpp\"\n#include <Eigen/Core>\n")
                  .size(),
              0u);
    EXPECT_EQ(violations("recursive/a.cpp", "#include \"include/elastocheck/energy.hpp\"\n").size(),
              1u);
    EXPECT_EQ(violations("reference/energy/a.cpp", "  #  include \"recursive/formula/state.hpp\"\n")
                  .size(),
              1u);
    EXPECT_EQ(violations("recursive/a.cpp", "#include <include/elastocheck/model.hpp>\n").size(),
              1u);
    EXPECT_EQ(violations("recursive/a.cpp", "#include \"elastocheck/models/model.hpp\"\n").size(),
              1u);
    EXPECT_EQ(violations("recursive/a.hpp", "#include \"state.hpp\"\n").size(), 1u);
    EXPECT_EQ(violations("reports/a.cpp", "#include \"build_info.hpp\"\n").size(), 0u);
    EXPECT_EQ(
        violations("reference/energy/a.cpp", "#include \"include/elastocheck/equilibrium.hpp\"\n")
            .size(),
        1u);
    EXPECT_EQ(violations("reference/certificate/a.cpp",
                         "#include \"reference/equilibrium/statement/laws.hpp\"\n")
                  .size(),
              1u);
    EXPECT_EQ(violations("models/a.hpp", "#include \"compare/comparison/compare.hpp\"\n").size(),
              1u);
    EXPECT_EQ(violations("compare/a.hpp", "#include \"reports/csv.hpp\"\n").size(), 1u);
    EXPECT_EQ(violations("recursive/a.cpp", "#include \"../reference/energy/solve.hpp\"\n").size(),
              1u);
    EXPECT_EQ(violations("recursive/a.cpp", "#include <ceres/jet.h>\n").size(), 1u);
    EXPECT_EQ(violations("reference/equilibrium/a.hpp", "#include <ceres/jet.h>\n").size(), 1u);
    EXPECT_EQ(violations("reference/equilibrium/a.cpp", "#include <ceres/jet.h>\n").size(), 0u);
    EXPECT_EQ(violations("reference/energy/a.cpp", "#include <ceres/jet.h>\n").size(), 1u);
    EXPECT_EQ(violations("elsewhere/a.cpp", "").size(), 1u);
}

}  // namespace
