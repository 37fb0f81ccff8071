// Locale with decimal comma: output of every command is unchanged, byte for byte.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <langinfo.h>
#include <locale.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
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
        const auto made = support::says("localedef --no-archive -i de_DE -f UTF-8 " +
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

// A shell line with $E the command, $SCENES and $SAMPLES folders; run in its own folder.
struct Line {
    const char* command;  // one of those in the manual
    const char* line;
};
const Line lines[] = {
    {"inspect", "$E inspect $SCENES/mcpherson.yaml --verbose"},
    {"inspect", "$E inspect $SCENES/pendulum.yaml --json"},
    {"solve", "$E solve $SCENES/mcpherson.yaml --steps 20 --method balanced --states states.jsonl"},
    {"solve",
     "$E solve $SCENES/two_spring_arch.yaml --method series --rates rates.csv -o curves.csv"},
    {"solve", "$E solve $SCENES/pendulum.yaml --method energy --set points.tip.x=0.3125"},
    {"compare",
     "$E compare $SCENES/pendulum.yaml --quiet --jobs 1 -o compared --formulations --within "
     "0.02mm,0.002deg"},
    {"converge", "$E converge $SCENES/parallel_springs.yaml --quiet -o converged"},
    {"trade", "$E trade chain.yaml --quiet -o traded --tolerance 0.015mm,0.0015deg"},
    {"new", "$E new double_wishbone"},
    {"import",
     "$E import $SAMPLES/generic__DoubleWishbone.json -o wishbone.yaml && $E inspect "
     "wishbone.yaml"},
    {"import", "$E import $SAMPLES/chrono_RotSpring_Case01.adm -o adm.yaml"},
    {"import", "$E import $FIXTURES/front.sub -o front.yaml"},
    {"export", "$E export $SCENES/mcpherson.yaml -o m.adm && $E import m.adm -o back.yaml"},
    {"export", "$E export $SCENES/double_wishbone_rigid.yaml --format chrono -o w.json"},
    {"gate",
     "cp $SCENES/single_bushing.yaml . && $E gate single_bushing.yaml --accept --reason first && "
     "$E gate single_bushing.yaml --junit gate.xml --summary gate.md --json"},
    {"certify", "$E certify $SCENES/pendulum.yaml --quiet -o proved"},
    {"judge",
     "$E solve $SCENES/pendulum.yaml --method midpoint --steps 150 -o mine.csv && "
     "$E judge $SCENES/pendulum.yaml --candidate mine.csv --tolerance 0.01mm,0.001deg -o judged"},
    {"judge",
     "$E judge $SCENES/pendulum.yaml --candidate-timeout 30.5 --candidate-command "
     "\"$E solve {scene} --method published --steps {steps} -o {output}\""},
    {"report", "$E report $SCENES/single_bushing.yaml --quiet -o page"},
    // Its joints are inconsistent, so no solver takes the requested million steps.
    {"stress",
     "$E stress $SCENES/../extremes/redundant_link.yaml --set joints.link.length=500.25 --quiet -o "
     "extremes"},
    {"equilibria", "$E equilibria $SCENES/two_spring_arch.yaml --at -120.5 --turned 80.5"},
    {"sensitivity",
     "$E sensitivity $SCENES/pendulum.yaml --points 1 --most 0 --csv derivatives.csv --json"},
    {"solve-for",
     "$E solve-for $SCENES/parallel_springs.yaml --vary springs.first.rate=10.5:60.5 --want "
     "centre_z@up:1500.5=419.5 -o new.yaml --quiet"},
    {"optimise",
     "printf 'vary: {springs.first.rate: [10.5, 60.5]}\\ngoals: [{figure: centre_z@up:1500.5, "
     "at_most: 419.5}]\\n' > g.yaml && $E optimise $SCENES/parallel_springs.yaml g.yaml -o "
     "new.yaml "
     "--quiet"},
    {"fit",
     "$E solve $SCENES/parallel_springs.yaml --steps 4 --channels centre_z -o rig.csv && $E fit "
     "$SCENES/parallel_springs.yaml --measured rig.csv --vary springs.first.rate=10.5:60.5 --quiet "
     "-o fitted.yaml"},
    {"tolerances",
     "echo 'springs.first.rate: {normal: {sd: 0.25}}' > t.yaml && $E tolerances "
     "$SCENES/parallel_springs.yaml t.yaml --of centre_z@up:1500.5 --quiet"},
    {"study",
     "$E study $SCENES/../studies/mcpherson.yaml --count 16 -o studied --csv rows.csv --quiet && "
     "rm -r studied"},
    {"live", "$E live $SCENES/pendulum.yaml -o live.html"},  // without its component an error
    {"loads",
     "printf 'case,patch_force_z\\nA,6000.5\\n' > c.csv && $E loads $SCENES/mcpherson.yaml c.csv "
     "-o loads.csv"},
    {"man", "$E man"},
    // Errors are reported with line and number.
    {"inspect",
     "{ head -c 3000 /dev/zero | tr '\\0' '\\n'; sed 's/^units:.*/units: {length: 1.5}/' "
     "$SCENES/pendulum.yaml; } "
     "> bad.yaml; $E inspect bad.yaml"},
    {"inspect",
     "{ head -c 3000 /dev/zero | tr '\\0' '\\n'; echo '[: }'; } > bad.yaml; $E inspect bad.yaml"},
    {"solve", "$E solve $SCENES/pendulum.yaml --steps 12.5"},
    {"solve", "$E solve $SCENES/pendulum.yaml --set points.tip.x=1,5"},
};

struct Found {
    support::Said said;
    std::map<std::string, std::string> files;
};
Found run(const std::string& line, const std::string& environment) {
    static const std::regex seconds(
        "[0-9.e+-]+ s, [0-9.e+-]+ s of processor time.*|in [0-9]+ s of .*|\"seconds\": [0-9.e+-]+");
    const Folder folder;
    folder.write("chain.yaml", chain_of(15));
    Found found;
    found.said = support::says(
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
    for (const auto& [command, line] : lines) {
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

TEST(DecimalComma, IsTriedOnEveryCommand) {
    std::set<std::string> tried;
    for (const auto& line : lines) tried.insert(line.command);
    int count = 0;
    const std::string heading = ".SS elastocheck ";
    for (const auto& line : parts_of(elastocheck_says("man").out, '\n')) {
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
