// A folder with scenes and studies of them, and the command `study` in it.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "compare/variants/openturns.hpp"
#include "tests/reports/command.hpp"

namespace elastocheck::reports {

namespace fs = std::filesystem;
using nlohmann::json;

// A folder with scenes and a study of one of them.
struct StudyCommand : testing::Test, Folder {
    void SetUp() override {
        if (!compare::variants::openturns::available())
            GTEST_SKIP() << "libopenturns-dev is not installed";
        for (const char* scene : {"parallel_springs.yaml", "mcpherson.yaml"})
            write(scene, text_of(scenes + "/" + scene));
    }
    std::string at(const std::string& name) const { return (path / name).string(); }
    // `study` on the file study.yaml with this content.
    Said study(const std::string& yaml, const std::string& options = "-o out") const {
        write("study.yaml", yaml);
        return run(options);
    }
    Said run(const std::string& options) const {
        return support::says("cd " + path.string() +
                             " && " ELASTOCHECK_COMMAND " study study.yaml --quiet " + options);
    }
    json statistics(const std::string& folder = "out") const {
        return json::parse(text_of(path / folder / "statistics.json"));
    }
};

inline double cell(const json& table, std::size_t row, const std::string& name) {
    for (std::size_t c = 0; c < table["columns"].size(); ++c)
        if (table["columns"][c]["name"] == name) return table["rows"][row][c].get<double>();
    ADD_FAILURE() << "no column " << name;
    return 0;
}

inline std::string replaced(const std::string& text, const std::string& what,
                            const std::string& by) {
    const auto at = text.find(what);
    EXPECT_NE(at, text.npos) << what;
    return std::string(text).replace(at, what.size(), by);
}

// z = z₀ + (F + P₁ + W) / (k₁ + k₂): linear in the preload and in the weight.
inline const std::string linear = R"(elastocheck_study: 1
scene: parallel_springs.yaml
variables:
  springs.first.preload: {normal: {sd: 20}}
  static_loads.weight.force.z: {normal: {sd: 30}}
design: {kind: sobol, count: 4096, seed: 3}
figures:
  height: centre_z@up:1500
limits:
  height: {max: 420.8}
witness: 1024
)";

inline const std::string mcpherson = R"(elastocheck_study: 1
scene: mcpherson.yaml
variables:
  points.tie_rod_inner.z: {normal: {sd: 0.0005}}
  points.strut_top.x: {triangular: {half_width: 0.001}}
  springs.K1_coil.rate: {truncated_normal: {sd: 2000, low: 1000, high: 40000}}
  bushes: {scale: 'bushings.K3_arm_front.rates.*', uniform: {half_width: 0.2}}
design: {kind: sobol, count: 780, seed: 5}
figures:
  toe: toe@jounce:3000
  camber: camber@rebound:-3000
  wheel rate: wheel_rate@jounce:1500
witness: 390
)";

inline std::string content(const Said& said) {
    static const std::regex line("Content ([0-9a-f]{16})");
    std::smatch match;
    return std::regex_search(said.out, match, line) ? match[1].str() : "none: " + said.err;
}

}  // namespace elastocheck::reports
