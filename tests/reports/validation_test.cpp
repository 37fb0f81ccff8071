// The committed report in reports/validation/ agrees with the present code.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "elastocheck/compile.hpp"
#include "elastocheck/trim.hpp"
#include "reports/page/report/report.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::reports {
namespace {

struct Number {
    double value, tolerance;
};
using Numbers = std::map<std::string, Number>;

// The last two cells are the value and its tolerance, the others are its name.
Numbers numbers_in(const std::string& csv) {
    Numbers numbers;
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        const auto last = line.rfind(','), second = line.rfind(',', last - 1);
        numbers[line.substr(0, second)] = {std::stod(line.substr(second + 1)),
                                           std::stod(line.substr(last + 1))};
    }
    return numbers;
}

std::vector<std::string> drift(const Numbers& committed, const Numbers& now) {
    std::vector<std::string> found;
    for (const auto& [name, number] : committed) {
        const auto other = now.find(name);
        if (other == now.end()) {
            found.push_back(name + ": no longer computed");
            continue;
        }
        const double off = std::abs(other->second.value - number.value);
        if (!(std::isfinite(off) && off <= number.tolerance))
            found.push_back(name + ": committed " + std::to_string(number.value) + ", now " +
                            std::to_string(other->second.value));
    }
    for (const auto& [name, number] : now)
        if (!committed.contains(name)) found.push_back(name + ": not in the committed report");
    return found;
}

TEST(Validation, CommittedNumbersEqualThoseOfTheCode) {
    std::vector<SceneAnalyses> scenes;
    auto names = support::small_scene_names();  // as in ./dev validation
    names.push_back("double_wishbone");
    for (const auto& name : names) {
        SceneAnalyses scene{.scene = compare::trim(support::scene(name)).scene};
        scene.model = compile(scene.scene);
        scene.comparison = compare::compare(scene.model);
        scenes.push_back(std::move(scene));
    }
    const Numbers committed = numbers_in(support::text_of(ELASTOCHECK_VALIDATION "/numbers.csv"));
    const Numbers now = numbers_in(numbers_csv(scenes));
    EXPECT_GT(committed.size(), 100u);
    for (const auto& line : drift(committed, now))
        ADD_FAILURE() << line
                      << "\nIf that is meant, run ./dev validation and commit what it writes.";
}

TEST(Validation, DriftBeyondItsToleranceIsDetected) {
    const Numbers old{{"a", {1, 0.1}}, {"b", {2, 0.1}}};
    EXPECT_TRUE(drift(old, {{"a", {1.05, 0.1}}, {"b", {2, 0.1}}}).empty());
    EXPECT_EQ(drift(old, {{"a", {1.2, 0.1}}, {"b", {2, 0.1}}}).size(), 1u);
    EXPECT_EQ(drift(old, {{"a", {NAN, 0.1}}, {"b", {2, 0.1}}}).size(), 1u);
    EXPECT_EQ(drift(old, {{"b", {2, 0.1}}, {"c", {2, 0.1}}}).size(), 2u);
}

}  // namespace
}  // namespace elastocheck::reports
