// What a study leaves besides its ledger: the page, the rows as CSV.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/reports/study_command.hpp"

namespace elastocheck::reports {
namespace {

// ---- The page

TEST_F(StudyCommand, DrawsAPage) {
    study(replaced(linear, "seed: 3", "seed: 3, indices: true"));
    const std::string page = text_of(path / "out" / "study.html");
    for (const char* part :
         {"<h2 id=\"figure-1-title\">height</h2>", "Shares of the variance",
          "Over static_loads.weight.force.z", "Outside the limits: ",
          "Total Sobol indices of height: static_loads.weight.force.z 0.", "default-src 'none'"})
        EXPECT_NE(page.find(part), page.npos) << part;
    // histogram, shares, two variables
    std::size_t pictures = 0;
    for (auto at = page.find("<svg"); at != page.npos; at = page.find("<svg", at + 1)) ++pictures;
    EXPECT_EQ(pictures, 4u);
    EXPECT_EQ(page.find(">nan"), page.npos);
    EXPECT_EQ(page.find("nan,"), page.npos);

    write("list.csv", "springs.first.rate\n-1\n30\n");
    study(R"(elastocheck_study: 1
scene: parallel_springs.yaml
variables: {springs.first.rate: {}}
design: {kind: list, file: list.csv}
figures: {height: centre_z@up:3000}
)",
          "-o other");
    const std::string other = text_of(path / "other" / "study.html");
    EXPECT_NE(other.find("1 solved, 1 no scene"), other.npos);
    EXPECT_NE(other.find("Squared correlation"), other.npos);

    fs::create_directories(path / "mine");
    write("mine/study.html", "<!DOCTYPE html><html>mine");
    expect_said(run("-o mine"), 2, {.err = {"mine/study.html: "}});
    EXPECT_EQ(text_of(path / "mine" / "study.html"), "<!DOCTYPE html><html>mine");
}

// ---- python3-openturns on the exported sample

struct StudyPython : StudyCommand {
    void SetUp() override {
        StudyCommand::SetUp();
        if (python("import pandas, openturns").code != 0)
            GTEST_SKIP() << "python3-pandas or python3-openturns is not installed";
    }
    Said python(const std::string& program) const {
        const_cast<StudyPython*>(this)->write("program.py", program);
        return support::says("cd " + path.string() + " && /usr/bin/python3 program.py");
    }
};

// The same estimators on the exported rows, and that the variables are a design for them.
TEST_F(StudyPython, FindsTheSameSobolIndices) {
    study(replaced(linear, "seed: 3", "seed: 3, indices: true"), "-o out --csv rows.csv");
    expect_said(python(R"(
import json, numpy, openturns, pandas
rows = {n: c.to_numpy() for n, c in pandas.read_csv("rows.csv", float_precision="round_trip").items()}
names = ["springs.first.preload [N]", "static_loads.weight.force.z [N]"]
d, blocks = len(names), len(rows["variant"]) // 4
x = numpy.stack([rows[n] for n in names], 1)[:4 * blocks].reshape(blocks, d + 2, d)
y = rows["height [mm]"][:4 * blocks].reshape(blocks, d + 2)
for j in range(d):
    assert numpy.array_equal(x[:, 2 + j, j], x[:, 1, j])
    assert numpy.array_equal(x[:, 2 + j, 1 - j], x[:, 0, 1 - j])
inputs = openturns.Sample(x.transpose(1, 0, 2).reshape(-1, d))
outputs = openturns.Sample(y.T.reshape(-1, 1))
table = json.load(open("out/statistics.json"))["sobol"]
column = [c["name"] for c in table["columns"]]
for algorithm, near in ((openturns.JansenSensitivityAlgorithm, 1e-12),
                        (openturns.MauntzKucherenkoSensitivityAlgorithm, 0.05)):
    found = algorithm(inputs, outputs, blocks)
    for kind, values in (("first", found.getFirstOrderIndices()),
                         ("total", found.getTotalOrderIndices())):
        for j in range(d):
            assert abs(values[j] - table["rows"][j][column.index(kind)]) < near, (kind, j)
# the variables themselves, by the distributions of OpenTURNS
for j, normal in enumerate((openturns.Normal(600, 20), openturns.Normal(-1500, 30))):
    sample = openturns.Sample(x[:, 0, j].reshape(-1, 1))
    if abs(sample.computeMean()[0] - normal.getMean()[0]) < 3:
        assert openturns.FittingTest.Kolmogorov(sample, normal).getPValue() > 0.05
print("same")
)"),
                0, {.out = {"same"}});
}

}  // namespace
}  // namespace elastocheck::reports
