// What a study leaves besides its ledger: the page, HDF5 and its readers; rare failures.
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

// ---- HDF5, and python3-openturns on the exported sample

struct StudyPython : StudyCommand {
    void SetUp() override {
        StudyCommand::SetUp();
        if (!has_hdf5) GTEST_SKIP() << "libhdf5-dev is not installed";
        if (python("import h5py, pandas, openturns").code != 0)
            GTEST_SKIP() << "python3-h5py, python3-pandas or python3-openturns is not installed";
    }
    static constexpr bool has_hdf5 = ELASTOCHECK_HAS_HDF5;
    Said python(const std::string& program) const {
        const_cast<StudyPython*>(this)->write("program.py", program);
        return support::says("cd " + path.string() + " && /usr/bin/python3 program.py");
    }
};

TEST_F(StudyPython, ReadsTheRowsOfTheCsv) {
    study(R"(elastocheck_study: 1
scene: parallel_springs.yaml
variables:
  springs.first.rate: {normal: {mean: 10, sd: 15}}
  factor: {scale: springs.second.rate, normal: {sd: 0.1}}
design: {kind: sobol, count: 400, seed: 1}
figures: {height: centre_z@up:3000, low: min centre_z@down}
witness: 50
)",
          "-o out --csv rows.csv --hdf5 rows.h5");
    expect_said(python(R"(
import h5py, numpy, pandas
file = h5py.File("rows.h5")
assert file.attrs["schema"] == b"elastocheck/variants/1", file.attrs["schema"]
frame = pandas.DataFrame(file["variants"][:])
rows = pandas.read_csv("rows.csv", float_precision="round_trip")
assert list(frame.columns) == list(rows.columns), frame.columns
assert len(frame) == 400
assert (frame["outcome"].str.decode("utf-8") == rows["outcome"]).all()
assert (frame["reason"].str.decode("utf-8") == rows["reason"].fillna("")).all()
assert (rows["outcome"] == "no scene").any(), rows["outcome"].value_counts()
for name in rows.columns[3:]:
    assert numpy.array_equal(frame[name], rows[name], equal_nan=True), name
witnesses = file["witnesses"][:]
assert list(witnesses["variant"]) == list(range(0, 400, 50))
assert numpy.nanmax(abs(witnesses["height [mm]"] - frame["height [mm]"][::50])) < 1e-9
print("same", file.attrs["content"].decode())
)"),
                0, {.out = {"same " + content(run("-o out --show"))}});
    write("rows.h5", "text");
    expect_said(run("-o out --hdf5 rows.h5"), 2, {.err = {"rows.h5: "}});
    EXPECT_EQ(text_of(path / "rows.h5"), "text");
    expect_said(run("-o out --show --hdf5 nowhere/rows.h5"), 2, {.err = {"nowhere/rows.h5: "}});
}

// The same estimators on the exported rows, and that the variables are a design for them.
TEST_F(StudyPython, FindsTheSameSobolIndices) {
    study(replaced(linear, "seed: 3", "seed: 3, indices: true"), "-o out --hdf5 rows.h5");
    expect_said(python(R"(
import h5py, json, numpy, openturns
rows = h5py.File("rows.h5")["variants"][:]
names = ["springs.first.preload [N]", "static_loads.weight.force.z [N]"]
d, blocks = len(names), len(rows) // 4
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

// ---- Rare failures

double rare_cell(const json& statistics, const std::string& name, std::size_t row = 0) {
    return cell(statistics["rare"], row, name);
}

// The height is normal: 420 mm, sd = √(20² + 30²) / 75.
TEST_F(StudyCommand, FindsTheFailureShareOfALinearSuspension) {
    const double sd = std::hypot(20, 30) / 75;
    for (const double beta : {1.5, 4.2649, 6.0}) {
        expect_said(study(replaced(linear, "max: 420.8", "max: " + std::to_string(420 + beta * sd)),
                          "-o out --count 256 --rare"),
                    0, {.out = {"Rare failures"}});
        const json found = statistics();
        const double share = 0.5 * std::erfc(beta / std::sqrt(2.0));
        EXPECT_NEAR(rare_cell(found, "beta"), beta, 1e-4);
        EXPECT_NEAR(rare_cell(found, "FORM"), share, 2e-3 * share);
        EXPECT_NEAR(rare_cell(found, "probability"), share, 0.08 * share);
        EXPECT_LT(rare_cell(found, "low"), share * 1.02);
        EXPECT_GT(rare_cell(found, "high"), share / 1.02);
        EXPECT_LT(rare_cell(found, "variants"), 21000);
    }
}

// Height = 400 + (3000 + P₁ - 600) / (k₁ + k₂), with a uniform preload: both limits against counting.
TEST_F(StudyCommand, FindsTheFailureShareOfACurvedCaseAsCountingDoes) {
    const std::string curved = R"(elastocheck_study: 1
scene: parallel_springs.yaml
variables:
  springs.first.rate: {normal: {sd: 3}}
  springs.second.rate: {normal: {sd: 4}}
  springs.first.preload: {uniform: {half_width: 60}}
design: {kind: monte_carlo, count: 20000, seed: 1}
figures: {height: centre_z@up:3000}
limits: {height: {min: 433, max: 447}}
)";
    expect_said(study(curved, "-o out --rare"), 0);
    const json found = statistics();
    const double counted = cell(found["figures"], 0, "outside low"),
                 counted_high = cell(found["figures"], 0, "outside high");
    const double both = rare_cell(found, "probability", 0) + rare_cell(found, "probability", 1);
    EXPECT_GT(both, counted);
    EXPECT_LT(both, counted_high);
}

TEST_F(StudyCommand, SaysWhyARareFailureIsNotFound) {
    expect_said(study(replaced(linear, "limits:\n  height: {max: 420.8}\n", ""),
                      "-o out --count 10 --rare"),
                2, {.err = {"--rare needs limits, and the study has none"}});
    expect_said(study(replaced(linear, "{normal: {sd: 20}}", "{list: [600, 620]}"),
                      "-o lists --count 10 --rare"),
                2, {.err = {"--rare needs continuous distributions, and 'springs.first.preload'"}});
    const Said beyond =
        study(replaced(linear, "max: 420.8", "max: 419"), "-o beyond --count 10 --rare");
    expect_said(beyond, 3, {.out = {"the design is beyond this limit"}});
    // a negative rate is no scene
    expect_said(study(R"(elastocheck_study: 1
scene: parallel_springs.yaml
variables:
  springs.first.rate: {normal: {sd: 30}}
design: {kind: monte_carlo, count: 64, seed: 1}
figures: {height: centre_z@up:3000}
limits: {height: {max: 600}}
)",
                      "-o none --rare"),
                3, {.out = {"a variant has no value: "}});
}

}  // namespace
}  // namespace elastocheck::reports
