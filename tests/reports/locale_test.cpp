// Locale with decimal comma: output of every command is unchanged, byte for byte.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <langinfo.h>
#include <locale.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include "tests/reports/command.hpp"

namespace elastocheck {
namespace {

namespace fs = std::filesystem;

// German locale, compiled into the folder; the machine only needs locale sources (package locales).
struct German {
    Folder folder;

    std::string environment() const {
        return "LOCPATH=" + folder.path.string() + " LC_ALL=de_DE.UTF-8";
    }
    testing::AssertionResult make() const {
        const auto made = support::shell("localedef --no-archive -i de_DE -f UTF-8 " +
                                         (folder.path / "de_DE.UTF-8").string());
        ::setenv("LOCPATH", folder.path.c_str(), 1);
        const locale_t german = ::newlocale(LC_ALL_MASK, "de_DE.UTF-8", nullptr);
        ::unsetenv("LOCPATH");
        if (german == nullptr)
            return testing::AssertionFailure()
                   << "no German locale; is the package locales there? " << made.err;
        const std::string point = ::nl_langinfo_l(RADIXCHAR, german),
                          group = ::nl_langinfo_l(THOUSEP, german);
        ::freelocale(german);
        if (point != "," || group != ".")
            return testing::AssertionFailure()
                   << "writes numbers with '" << point << "' and '" << group << "'";
        return testing::AssertionSuccess();
    }
};

struct Line {
    std::string command, line;  // as in locale.lines
};
std::vector<Line> lines() {
    std::vector<Line> all;
    for (const auto& line : parts_of(text_of(ELASTOCHECK_LOCALE_LINES), '\n'))
        if (const auto at = line.find(": "); !line.starts_with("#"))
            all.push_back({line.substr(0, at), line.substr(at + 2)});
    return all;
}

struct Found {
    support::RunResult said;
    std::map<std::string, std::string> files;
};
Found run(const std::string& line, const std::string& environment) {
    static const std::regex seconds(
        "[0-9.e+-]+ s, [0-9.e+-]+ s of processor time.*|in [0-9]+ s of .*|\"seconds\": [0-9.e+-]+");
    const Folder folder;
    folder.write("chain.yaml", chain_of(15));
    Found found;
    found.said = support::shell(
        fmt::format("cd {} && unset CI GITHUB_STEP_SUMMARY; export {} E={} SCENES={} SAMPLES={} "
                    "FIXTURES={}; {}",
                    folder.path.string(), environment, ELASTOCHECK_ELSEWHERE, ELASTOCHECK_SCENES,
                    ELASTOCHECK_SAMPLES, ELASTOCHECK_FIXTURES, line));
    // Several threads advance one clock.
    if (contains(line, " stress "))
        found.said.out = std::regex_replace(found.said.out, seconds, "");
    for (const auto& entry : fs::recursive_directory_iterator(folder.path))
        if (entry.is_regular_file())
            found.files[fs::relative(entry.path(), folder.path).string()] =
                std::regex_replace(text_of(entry.path()), seconds, "");
    return found;
}

// First difference of two texts.
std::string parting(const std::string& a, const std::string& b) {
    std::size_t at = 0;
    while (at < a.size() && at < b.size() && a[at] == b[at]) ++at;
    const auto part = [&](const std::string& text) {
        return text.substr(at - std::min<std::size_t>(at, 60), 160);
    };
    return "..." + part(a) + "...\nand\n..." + part(b) + "...";
}

TEST(DecimalComma, LocaleWithDecimalCommaDoesNotChangeAnyOutput) {
    const German german;
    ASSERT_TRUE(german.make());
    for (const auto& [command, line] : lines()) {
        const Found here = run(line, "LC_ALL=C.UTF-8"), there = run(line, german.environment());
        EXPECT_EQ(here.said.code, there.said.code) << line << "\n" << there.said.err;
        EXPECT_TRUE(here.said.code >= 0 && here.said.code <= 3) << line << "\n" << here.said.err;
        EXPECT_EQ(here.said.out, there.said.out) << line << "\n"
                                                 << parting(here.said.out, there.said.out);
        EXPECT_EQ(here.said.err, there.said.err) << line;
        ASSERT_EQ(here.files.size(), there.files.size()) << line;
        for (const auto& [name, text] : here.files) {
            ASSERT_TRUE(there.files.contains(name)) << line << ": " << name;
            EXPECT_TRUE(text == there.files.at(name)) << line << ": " << name << "\n"
                                                      << parting(text, there.files.at(name));
        }
    }
}

TEST(DecimalComma, EveryCommandIsTestedInALocaleWithDecimalComma) {
    std::set<std::string> tried;
    for (const auto& line : lines()) tried.insert(line.command);
    int count = 0;
    const std::string heading = ".SS elastocheck ";
    for (const auto& line : parts_of(run_elastocheck("man").out, '\n')) {
        if (!line.starts_with(heading)) continue;
        std::string command = line.substr(heading.size());
        std::erase(command, '\\');
        EXPECT_TRUE(tried.contains(command)) << command;
        ++count;
    }
    EXPECT_GT(count, 10);
}

}  // namespace
}  // namespace elastocheck
