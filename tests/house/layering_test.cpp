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

struct Room {
    std::string folder;
    std::vector<std::string> may_include;
};

// A folder may include itself and what is listed.
const std::vector<Room> rooms{
    {"models/reader", {"models"}},  // before the room it stands in
    {"models", {}},
    {"recursive", {"models"}},
    {"reference/equilibrium", {"models"}},
    {"reference/energy", {"models"}},
    {"compare", {"models", "recursive", "reference/equilibrium", "reference/energy"}},
    {"reports",
     {"models/reader", "models", "recursive", "reference/equilibrium", "reference/energy", "compare"}},
};

bool is_below(const std::string& path, const std::string& folder) { return path.starts_with(folder + "/"); }

// What is wrong with the includes of one file.
std::vector<std::string> violations(const std::string& file, const std::string& text) {
    std::vector<std::string> found;
    const auto room = std::ranges::find_if(rooms, [&](const Room& r) { return is_below(file, r.folder); });
    if (room == rooms.end()) return {file + ": in no room of the house"};
    static const std::regex include(R"(^\s*#\s*include\s*["<]([^">]+)[">])");
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (!std::regex_search(line, match, include)) continue;
        std::string target = match[1];
        if (target.starts_with("elastocheck/")) target.erase(0, std::string("elastocheck/").size());
        if (target.starts_with("../") || target.find("/../") != target.npos)
            found.push_back(file + ": a relative include hides where it goes: " + target);
        if (target.starts_with("tests/")) found.push_back(file + " includes " + target);
        for (const Room& other : rooms) {
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

TEST(Layering, IncludesRunDownwardsAndNeverBetweenLegs) {
    int files = 0;
    for (const char* folder : {"models", "recursive", "reference", "compare", "reports"}) {
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(ELASTOCHECK_ROOT) / folder)) {
            if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
            std::ifstream in(entry.path());
            std::ostringstream text;
            text << in.rdbuf();
            for (const auto& violation : violations(fs::relative(entry.path(), ELASTOCHECK_ROOT), text.str()))
                ADD_FAILURE() << violation;
            ++files;
        }
    }
    EXPECT_GT(files, 30);
}

TEST(Layering, AlarmRings) {
    EXPECT_EQ(violations("recursive/a.cpp", "#include \"models/model.hpp\"\n#include <Eigen/Core>\n").size(),
              0u);
    EXPECT_EQ(violations("recursive/a.cpp", "#include \"reference/energy/solve.hpp\"\n").size(), 1u);
    EXPECT_EQ(violations("reference/energy/a.cpp", "  #  include <elastocheck/recursive/state.hpp>\n").size(),
              1u);
    EXPECT_EQ(violations("reference/energy/a.cpp", "#include \"reference/equilibrium/solve.hpp\"\n").size(),
              1u);
    EXPECT_EQ(violations("models/a.hpp", "#include \"compare/compare.hpp\"\n").size(), 1u);
    EXPECT_EQ(violations("compare/a.hpp", "#include \"reports/csv.hpp\"\n").size(), 1u);
    EXPECT_EQ(violations("recursive/a.cpp", "#include \"../reference/energy/solve.hpp\"\n").size(), 1u);
    EXPECT_EQ(violations("recursive/a.cpp", "#include <ceres/jet.h>\n").size(), 1u);
    EXPECT_EQ(violations("reference/equilibrium/a.hpp", "#include <ceres/jet.h>\n").size(), 1u);
    EXPECT_EQ(violations("reference/equilibrium/a.cpp", "#include <ceres/jet.h>\n").size(), 0u);
    EXPECT_EQ(violations("reference/energy/a.cpp", "#include <ceres/jet.h>\n").size(), 1u);
    EXPECT_EQ(violations("elsewhere/a.cpp", "").size(), 1u);
}

}  // namespace
