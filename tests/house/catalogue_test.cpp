// Who shows or judges outputs chooses them by their properties in the catalogue, not by their names.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "compare/outputs/catalogue/catalogue.hpp"

namespace elastocheck {
namespace {

namespace fs = std::filesystem;

// Words that are also the name of something else in these files.
const std::map<std::string, std::set<std::string>> other_meanings{
    {"travel",  // a load case, what a branch drives, or the column of a wheel rate
     {"compare/tables/compare_result.cpp", "reports/command/import_command.cpp",
      "reports/command/options/load_cases.cpp", "reports/given/headings.cpp",
      "reports/given/wheels.cpp", "reports/page/common.cpp", "reports/page/common.hpp",
      "reports/page/sections/inputs/suspension.cpp",
      "reports/page/sections/kinematics/travel.cpp"}},
    {"compression", {"compare/comparison/trim.cpp"}},  // of a spring, in a message
    {"wheel_rate",                                     // a field of a judgement
     {"reports/page/report/report.cpp", "reports/tables/judgement.cpp"}}};

TEST(Catalogue, NamesOfFiguresAreStringLiteralsOnlyInTheCatalogue) {
    std::set<std::string> names;
    for (const auto& entry : compare::catalogue()) names.insert(entry.name);
    ASSERT_GT(names.size(), 100u);
    static const std::regex literal(R"re("([^"\n]*)"|'([^'\n]*)')re");
    const fs::path root = ELASTOCHECK_ROOT;
    int files = 0;
    for (const char* folder : {"compare", "reports"})
        for (const auto& file : fs::recursive_directory_iterator(root / folder)) {
            const std::string path = fs::relative(file.path(), root).generic_string(),
                              ending = file.path().extension();
            if ((ending != ".cpp" && ending != ".hpp" && ending != ".js") ||
                path.starts_with("compare/outputs/catalogue/"))
                continue;
            ++files;
            std::ifstream in(file.path());
            for (std::string line; std::getline(in, line);) {
                line.resize(std::min(line.find("//"), line.size()));
                for (std::sregex_iterator found(line.begin(), line.end(), literal), end;
                     found != end; ++found) {
                    std::string word = (*found)[1].matched ? (*found)[1] : (*found)[2];
                    if (word.starts_with('.')) word.erase(0, 1);
                    const auto meant = other_meanings.find(word);
                    EXPECT_TRUE(!names.contains(word) ||
                                (meant != other_meanings.end() && meant->second.contains(path)))
                        << path << " has \"" << word << "\": choose by a property";
                }
            }
        }
    EXPECT_GT(files, 200);
}

}  // namespace
}  // namespace elastocheck
