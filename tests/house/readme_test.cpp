// The CI workflow in the documentation refers to what exists; links between the pages of the repository lead to files.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/command.hpp"

namespace {

using elastocheck::support::RunResult;
using elastocheck::support::shell;
using elastocheck::support::text_of;

const std::string root = ELASTOCHECK_ROOT;

TEST(Readme, CommitsOfTheExampleWorkflowExist) {
    const std::string git = "git -c safe.directory='*' -C '" + root + "' ";
    if (shell(git + "rev-parse --show-prefix").out != "\n")
        GTEST_SKIP() << "not a checkout of its own";
    if (shell(git + "rev-parse --is-shallow-repository").out != "false\n")
        GTEST_SKIP() << "a checkout without history";
    const std::string page = text_of(root + "/tests/gate/README.md");
    static const std::regex reference("\\bref: ([^ ,}\n]+)");
    int references = 0;
    for (std::sregex_iterator at(page.begin(), page.end(), reference), end; at != end;
         ++at, ++references) {
        const std::string name = (*at)[1];
        bool there = false;
        for (const std::string place : {"", "origin/"})
            there = there ||
                    shell(git + "rev-parse --verify -q '" + place + name + "^{commit}'").code == 0;
        EXPECT_TRUE(there) << "ref: " << name;
    }
    EXPECT_GT(references, 0);
}

// The pages of the repository, each with its folder.
std::vector<std::filesystem::path> pages() {
    namespace fs = std::filesystem;
    std::vector<fs::path> found;
    for (const char* part : {"models", "recursive", "reference", "compare", "reports", "tests"})
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(root) / part))
            if (entry.path().extension() == ".md") found.push_back(entry.path());
    for (const char* page : {"README.md", "CONTRIBUTING.md"})
        found.push_back(fs::path(root) / page);
    return found;
}

TEST(Readme, LinksBetweenPagesLeadToFiles) {
    static const std::regex link("\\]\\(([^):#]+)(#[^)]*)?\\)|src=\"([^\"]+)\"");
    int links = 0;
    for (const auto& page : pages()) {
        const std::string text = text_of(page);
        for (std::sregex_iterator at(text.begin(), text.end(), link), end; at != end;
             ++at, ++links) {
            const std::string target = (*at)[1].matched ? (*at)[1] : (*at)[3];
            EXPECT_TRUE(std::filesystem::exists(page.parent_path() / target))
                << page << " links to " << target;
        }
    }
    EXPECT_GT(links, 30);
}

TEST(Readme, SpeedTableOfTheBenchmarkPageIsTheMeasuredOne) {
    const std::string folder = root + "/tests/benchmark/";
    EXPECT_NE(text_of(folder + "README.md").find(text_of(folder + "speed.md") + "<!-- end -->"),
              std::string::npos)
        << "regenerate both: cmake --build --preset release --target speed_figures";
}

// The page of a folder lists its files: a header that was moved or removed is noticed here.
TEST(Readme, HeadersThatPagesOfFoldersNameExist) {
    static const std::regex file("`([A-Za-z_/]+\\.[hc]pp)`");
    int named = 0;
    for (const char* part : {"models", "recursive", "reference", "compare", "reports"}) {
        const std::filesystem::path folder = std::filesystem::path(root) / part;
        const std::string text = text_of(folder / "README.md");
        std::filesystem::path last = folder;
        for (std::sregex_iterator at(text.begin(), text.end(), file), end; at != end;
             ++at, ++named) {
            const std::string name = (*at)[1];
            // From the folder, from the repository, or beside the file that is named before.
            bool exists = false;
            for (const auto& from : {folder, std::filesystem::path(root), last})
                if (std::filesystem::exists(from / name)) {
                    exists = true;
                    last = (from / name).parent_path();
                    break;
                }
            EXPECT_TRUE(exists) << part << "/README.md names " << name;
        }
    }
    EXPECT_GT(named, 100);
}

}  // namespace
