// Files that comments and pages name exist.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;

const fs::path root = ELASTOCHECK_ROOT;

// The comment of a line of code; all of a line of a page.
std::string prose_of(const std::string& line, const std::string& extension) {
    if (extension == ".md") return line;
    const auto begin = line.find(extension == ".py" ? "#" : "//");
    return begin == line.npos ? "" : line.substr(begin);
}

// Every path in the tree with and without its first folders.
std::set<std::string> ends_of_paths() {
    std::set<std::string> ends;
    for (const char* folder :
         {"include", "models", "recursive", "reference", "compare", "reports", "tests"})
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            std::string path = fs::relative(entry.path(), root).generic_string();
            while (true) {
                ends.insert(path);
                const auto slash = path.find('/');
                if (slash == path.npos) break;
                path.erase(0, slash + 1);
            }
        }
    for (const auto& entry : fs::directory_iterator(root)) ends.insert(entry.path().filename());
    return ends;
}

// Names in capitals stand for any name; written files and installed ones are not in the tree.
bool is_elsewhere(const std::string& path) {
    static const std::regex stands_for("(^|/)[A-Z]+(_[a-z]+)?\\.");
    static const std::set<std::string> written{"report.md", "build/validation/report.md",
                                               "elastocheck/_errors.py", "elastocheck/__init__.py"};
    return std::regex_search(path, stands_for) || written.contains(path);
}

TEST(Paths, FilesThatCommentsAndPagesNameExist) {
    static const std::regex path(
        "(^|[^A-Za-z0-9_./{}$<*-])"
        "((?:[A-Za-z0-9_.-]+/)*[A-Za-z0-9_.-]+\\.(?:cpp|hpp|py|js|md|mustache|claims))"
        "(?![A-Za-z0-9_/*-]|\\.[a-z])");
    const auto ends = ends_of_paths();
    int named = 0;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
        const std::string file = fs::relative(entry.path(), root).generic_string(),
                          extension = entry.path().extension();
        if (file.starts_with("build/") || file.starts_with(".git/") || file == "CHANGELOG.md" ||
            !std::set<std::string>{".md", ".hpp", ".cpp", ".py", ".js"}.contains(extension))
            continue;
        std::ifstream lines(entry.path());
        std::string line;
        for (int n = 1; std::getline(lines, line); ++n) {
            const std::string prose = prose_of(line, extension);
            for (std::sregex_iterator at(prose.begin(), prose.end(), path), end; at != end; ++at) {
                const std::string name = (*at)[2];
                if (is_elsewhere(name)) continue;
                ++named;
                EXPECT_TRUE(ends.contains(name) || fs::exists(entry.path().parent_path() / name))
                    << file << ":" << n << ": " << name;
            }
        }
    }
    EXPECT_GT(named, 100);
}

}  // namespace
