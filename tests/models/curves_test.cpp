// Force curves: interpolation of tables, file format, and conversion of preloads.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "models/laws.hpp"
#include "models/reader/tables/interpolant.hpp"
#include "tests/models/fixtures.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/pipe.hpp"

namespace elastocheck {
namespace {

using reader::interpolant;
using reader::TablePoint;
using Points = std::vector<TablePoint>;

// ---- The interpolant.

// Tables of many shapes: even and uneven, steep, flat at the ends and inside, of 2 to 12 points.
std::vector<Points> tables() {
    std::mt19937 random(1984);
    std::uniform_real_distribution<double> any(0, 1);
    std::vector<Points> all;
    for (int n = 0; n < 400; ++n) {
        Points points{{any(random) - 0.5, 1e3 * (any(random) - 0.5)}};
        const auto count = 2 + random() % 11;
        while (points.size() < count) {
            const double h = n % 2 ? 0.01 : 0.05 * std::pow(any(random) + 0.01, 3);
            const double rise = random() % 4 == 0 ? 0 : 1e3 * std::pow(any(random), 5);
            points.push_back({points.back().x + h, points.back().f + rise});
        }
        all.push_back(points);
    }
    return all;
}

double value(const std::array<double, 4>& c, double t) {
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}
double slope(const std::array<double, 4>& c, double t) {
    return c[1] + t * (2 * c[2] + t * 3 * c[3]);
}

double width(const Curve& curve, std::size_t k) { return curve.knots[k + 1] - curve.knots[k]; }

double largest_force(const Points& points) {
    return std::max(std::abs(points.front().f), std::abs(points.back().f));
}

// The slope of a cubic is least at an end or where its second derivative is zero.
TEST(Interpolant, IsContinuouslyDifferentiableAndMonotone) {
    for (const Points& points : tables()) {
        const Curve curve = interpolant(points);
        ASSERT_EQ(curve.knots.size(), points.size());
        ASSERT_EQ(curve.pieces.size(), points.size() + 1);
        EXPECT_EQ(value(curve.pieces[0], 0), points[0].f);
        EXPECT_EQ(curve.pieces[0][1], curve.pieces[1][1]);
        for (std::size_t k = 0; k < points.size(); ++k) {
            EXPECT_EQ(curve.knots[k], points[k].x);
            EXPECT_EQ(value(curve.pieces[k + 1], 0), points[k].f);
            EXPECT_GE(curve.pieces[k + 1][1], 0);
            if (k == 0) continue;
            const auto& c = curve.pieces[k];
            const double h = width(curve, k - 1), secant = (points[k].f - points[k - 1].f) / h;
            EXPECT_NEAR(value(c, h), points[k].f, 4e-15 * largest_force(points));
            EXPECT_NEAR(slope(c, h), curve.pieces[k + 1][1], 8e-15 * secant);
            if (c[3] > 0) {
                EXPECT_GE(slope(c, std::clamp(-c[2] / (3 * c[3]), 0.0, h)), -4e-15 * secant);
            }
        }
    }
}

TEST(Polygon, IsLinearBetweenThePointsAndBeyondThem) {
    for (const Points& points : tables()) {
        const Curve curve = reader::piecewise_linear(points);
        ASSERT_EQ(curve.knots.size(), points.size());
        ASSERT_EQ(curve.pieces.size(), points.size() + 1);
        for (std::size_t k = 0; k < points.size(); ++k) {
            EXPECT_EQ(curve.knots[k], points[k].x);
            EXPECT_EQ(value(curve.pieces[k + 1], 0), points[k].f);
            EXPECT_EQ(curve.pieces[k + 1][2], 0);
            EXPECT_EQ(curve.pieces[k + 1][3], 0);
            if (k > 0) {
                EXPECT_NEAR(value(curve.pieces[k], width(curve, k - 1)), points[k].f,
                            4e-15 * largest_force(points));
            }
        }
        EXPECT_EQ(curve.pieces.front()[0], points.front().f);
        EXPECT_EQ(curve.pieces.front()[1], curve.pieces[1][1]);
        EXPECT_EQ(curve.pieces.back()[1], curve.pieces[points.size() - 1][1]);
    }
}

// Three points (0, 0), (1, 1), (3, 5): secants 1 and 2. Inside 1/m = (5/9)/1 + (4/9)/2; at the ends
// (4·1 - 1·2)/3 and (5·2 - 2·1)/3.
TEST(Interpolant, HasTheSlopesOfFritschAndButland) {
    const Curve curve = interpolant({{0, 0}, {1, 1}, {3, 5}});
    EXPECT_DOUBLE_EQ(curve.pieces[1][1], 2.0 / 3);
    EXPECT_DOUBLE_EQ(curve.pieces[2][1], 9.0 / 7);
    EXPECT_DOUBLE_EQ(curve.pieces[3][1], 8.0 / 3);
}

TEST(Interpolant, CollinearPointsGiveAStraightLine) {
    const Curve line = interpolant({{-2, -6}, {-1, -3}, {0.5, 1.5}, {4, 12}});
    for (const double x : {-9.0, -2.0, -1.3, 0.0, 0.5, 3.0, 4.0, 11.0})
        EXPECT_NEAR(force(line, x), 3 * x, 1e-14);
    const Curve two = interpolant({{1, 5}, {2, 9}});
    for (const double x : {-3.0, 1.0, 1.7, 8.0}) EXPECT_DOUBLE_EQ(force(two, x), 5 + 4 * (x - 1));
    const Curve flat = interpolant({{0, 0}, {1, 7}, {2, 7}, {3, 7}, {4, 9}});
    for (const double x : {1.0, 1.2, 1.999, 2.5, 3.0}) EXPECT_EQ(force(flat, x), 7);
}

// ---- Curves in the file.

Curve curve_of(const Scene& scene) {
    return std::get<Curve>(element<AxialSpring>(scene, "coil").law);
}
Curve curve_of(const std::string& curve) {
    return curve_of(laws(spring_with("curve: {" + curve + "}")));
}

// Sample positions: on both sides of all knots and far beyond them [m].
std::vector<double> positions() {
    std::vector<double> all;
    for (int n = -300; n <= 300; ++n) all.push_back(n * 0.5e-3);
    return all;
}

void expect_equal(const Curve& a, const std::function<double(double)>& b, double tolerance) {
    double worst = 0, where = 0;
    for (const double x : positions())
        if (const double gap = std::abs(force(a, x) - b(x)); !(gap <= worst)) {
            worst = gap;
            where = x;
        }
    EXPECT_TRUE(std::isfinite(worst) && worst <= tolerance) << worst << " N at " << where << " m";
}

const std::string one_sided = "table: [[0, 0], [10, 900], [20, 4000], [35, 4000], [50, 9500]]";

TEST(Curve, ExtrapolationHasTheSlopeOfTheEnd) {
    const Curve curve = curve_of("table: [[-50, -900], [0, 0], [50, 1400]], outside: linear");
    for (const double x : {0.05, 0.2, 3.0}) {
        EXPECT_NEAR(force(curve, x), 1400 + curve.pieces.back()[1] * (x - 0.05), 1e-9);
        EXPECT_NEAR(force(curve, -x), -900 - curve.pieces.front()[1] * (x - 0.05), 1e-9);
    }
    EXPECT_GT(curve.pieces.back()[1], 28e3);  // steeper than the last secant
    EXPECT_FALSE(
        curve_of("table: [[-50, -900], [0, 0], [50, 1400]], outside: unknown").known_outside);
}

TEST(Curve, InterpolationIsMonotoneByDefault) {
    const std::string table = "table: [[-50, -900], [0, 0], [50, 1400]]";
    const Curve straight = curve_of(table + ", interpolation: linear");
    for (const double x : {-0.05, -0.02, 0.0, 0.01, 0.04, 0.2})
        EXPECT_NEAR(force(straight, x), (x < 0 ? 18e3 : 28e3) * x, 1e-9) << x;
    const Curve smooth = curve_of(table + ", interpolation: monotone");
    expect_equal(
        smooth, [&](double x) { return force(curve_of(table), x); }, 0);
    EXPECT_THROW(curve_of(table + ", interpolation: cubic"), SceneError);
    const Curve odd = curve_of(
        "table: [[0, 0], [20, 100], [50, 900]], symmetric: true, scale: 2, interpolation: linear");
    EXPECT_NEAR(force(odd, -0.035), -1000, 1e-9);
}

TEST(Curve, SymmetricTableGivesAnOddFunction) {
    const Curve curve = curve_of(one_sided + ", symmetric: true");
    expect_equal(
        curve, [&](double x) { return -force(curve, -x); }, 2e-12);
    const Curve half = curve_of(one_sided);
    for (const double x : {0.01, 0.02, 0.03, 0.05})
        EXPECT_DOUBLE_EQ(force(curve, x), force(half, x));
    const Curve whole = curve_of(
        "table: [[-50, -9500], [-35, -4000], [-20, -4000], [-10, -900], [0, 0], [10, 900], [20, "
        "4000], [35, "
        "4000], "
        "[50, 9500]]");
    expect_equal(
        curve, [&](double x) { return force(whole, x); }, 0);
    expect_equal(
        curve_of(one_sided + ", symmetric: false"), [&](double x) { return force(half, x); }, 0);
}

// f(x) = scale · t(x - offset)
TEST(Curve, ScaleMultipliesTheForceAndOffsetShiftsTheTable) {
    for (const char* symmetric : {"true", "false"}) {
        const std::string table = one_sided + ", symmetric: " + symmetric;
        const Curve t = curve_of(table), f = curve_of(table + ", scale: 1.1, offset: 2");
        expect_equal(
            f, [&](double x) { return 1.1 * force(t, x - 0.002); }, 1e-9);
        EXPECT_EQ(f.knots.back(), 0.05 + 0.002);
    }
}

// ---- CSV files.

struct Beside {
    support::Folder folder;
    explicit Beside(const std::string& csv, const std::string& file = "coil.csv") {
        folder.write("scene.yaml", laws_scene(spring_with("curve: {file: " + file + "}")));
        folder.write("coil.csv", csv);
    }
};

TEST(CurveFile, TableBesideTheSceneIsRead) {
    const Curve table = curve_of(one_sided);
    for (const std::string csv :
         {"0,0\n10,900\n20,4000\n35,4000\n50,9500\n", "0, 0\n10,\t900\n20 ,4e3\n+35,4000\n50,9500",
          "deflection [mm], force [N]\n0,0\n10,900\n20,4000\n35,4000\n50,9500\n",
          R"(# measured

  # twice
x,f
0,0
10,900

20,4000
# the end stop
35,4000
50,9500

)",
          "x,f\r\n0,0\r\n10,900\r\n20,4000\r\n35,4000\r\n50,9500\r\n",
          "x,f\r0,0\r10,900\r20,4000\r35,4000\r50,9500\r",
          "\xEF\xBB\xBF"
          "0,0\n10,900\n20,4000\n35,4000\n50,9500\n"}) {
        SCOPED_TRACE(csv);
        const Beside beside(csv);
        const Curve read = curve_of(read_scene(beside.folder.path / "scene.yaml"));
        EXPECT_EQ(read.knots, table.knots);
        EXPECT_EQ(read.pieces, table.pieces);
    }
}

TEST(CurveFile, TableInAFolderBelowTheSceneIsRead) {
    support::Folder folder;
    folder.write("scene.yaml", laws_scene(spring_with("curve: {file: rubber/coil.csv}")));
    std::filesystem::create_directory(folder.path / "rubber");
    folder.write("rubber/coil.csv", "0,0\n10,900\n");
    EXPECT_EQ(force(curve_of(read_scene(folder.path / "scene.yaml")), 0.01), 900);
}

// Numbers of the file are not numbers of the scene; scale and offset vary the table.
TEST(CurveFile, NumbersOfAFileCannotBeSet) {
    const Beside beside("0,0\n10,900\n");
    const Scene scene = read_scene(beside.folder.path / "scene.yaml");
    for (const Number& number : scene.numbers)
        EXPECT_EQ(number.path.find("curve"), std::string::npos) << number.path;
}

TEST(CurveFile, ErrorGivesTheLineInTheFile) {
    const auto folder = std::filesystem::path(ELASTOCHECK_FIXTURES) / "tables";
    support::expect_refusals(
        folder / "coil.mistakes", support::text_of(folder / "coil.csv"), "coil.csv",
        [](const std::string& csv) -> std::string {
            const Beside beside(csv);
            try {
                read_scene(beside.folder.path / "scene.yaml");
            } catch (const SceneError& error) {
                return std::string(error.what()).substr(beside.folder.path.string().size() + 1);
            }
            return "accepted";
        });
}

// A pipe is rejected without blocking, and a symbolic link must not lead out of the scene's folder.
TEST(CurveFile, PathOutsideTheFolderOfTheSceneIsRejected) {
    const auto refusal = [](const Beside& beside) {
        try {
            read_scene(beside.folder.path / "scene.yaml");
        } catch (const SceneError& error) {
            return std::string(error.what());
        }
        return std::string("read");
    };
    namespace fs = std::filesystem;
    const support::Folder elsewhere;
    elsewhere.write("coil.csv", "0,0\n1,1\n");
    const Beside beside("0,0\n1,1\n", "coil.csv");
    const fs::path curve = beside.folder.path / "coil.csv";
    fs::rename(curve, beside.folder.path / "other.csv");
    fs::create_symlink("other.csv", curve);
    EXPECT_EQ(refusal(beside), "read");
    fs::remove(curve);
    fs::create_symlink(elsewhere.path / "coil.csv", curve);
    EXPECT_NE(
        refusal(beside).find(
            ":11: springs.coil.curve.file: 'coil.csv' is a symbolic link that leads out of the "
            "scene's folder; allowed: a file in it, or in a folder below"),
        std::string::npos)
        << refusal(beside);
    fs::remove(curve);
    const support::Pipe pipe(curve);
    ASSERT_TRUE(pipe.is_there());
    const std::string said = refusal(beside);
    EXPECT_NE(said.find("'coil.csv': a pipe or a device; a regular file is needed"),
              std::string::npos)
        << said;
}

TEST(CurveFile, UnreadableFileIsRejectedAtItsLineInTheScene) {
    std::string rows;
    for (int n = 0; n <= 10000; ++n) rows += fmt::format("{},{}\n", n, n);
    const std::tuple<std::string, std::string, std::string> cases[] = {
        {"none.csv", "", ":11: springs.coil.curve.file: 'none.csv': no such file"},
        {".", "", ":11: springs.coil.curve.file: '.': a directory; a file is needed"},
        {"../coil.csv", "0,0\n1,1\n",
         ":11: springs.coil.curve.file: '../coil.csv' is outside the scene's folder; allowed: a "
         "file in it, or in a folder below"},
        {"/tmp/coil.csv", "0,0\n1,1\n",
         ":11: springs.coil.curve.file: '/tmp/coil.csv' is outside the scene's folder; allowed: a "
         "file in it, or in a folder below"},
        {"coil.csv", "0,0\n1,\xFF\n",
         ":11: springs.coil.curve.file: 'coil.csv': not plain text (UTF-8)"},
        {"coil.csv", std::string((1 << 20) + 1, '#'),
         ":11: springs.coil.curve.file: 'coil.csv': larger than 1 MiB, the limit for a table"},
    };
    for (const auto& [file, csv, message] : cases) {
        const Beside beside(csv, file);
        const std::string scene = (beside.folder.path / "scene.yaml").string();
        try {
            read_scene(scene);
            ADD_FAILURE() << file << " was accepted";
        } catch (const SceneError& error) {
            EXPECT_EQ(error.what(), scene + message);
        }
    }
    const Beside beside(rows);
    try {
        read_scene(beside.folder.path / "scene.yaml");
        ADD_FAILURE();
    } catch (const SceneError& error) {
        EXPECT_EQ(error.what(),
                  (beside.folder.path / "coil.csv").string() +
                      ":1: springs.coil.curve.file: 10001 rows; allowed: at most 10000");
    }
}

// ---- Springs with curves: f(ℓ - ℓ₀) = -P at the design length ℓ = 400 mm.

double design_force(const AxialSpring& spring) {
    return force(spring.law, 0.4 - spring.free_length);
}

TEST(SpringCurve, PreloadDeterminesTheDeflectionAtDesign) {
    for (const char* table : {"[[-80, -6000], [-50, -900], [-10, -10], [0, 0], [50, 1400]]",
                              "[[-50, -900], [0, 0]]", "[[-100, -9000], [-40, -2000], [5, 30]]"})
        for (const double preload :
             {9500.0, 8000.0, 6000.0, 3500.0, 900.0, 700.1, 11.0, 1.0, 0.0, -1.0, -30.0, -5000.0}) {
            const auto spring = element<AxialSpring>(
                laws(spring_with(fmt::format("curve: {{table: {}}}, preload: {}", table, preload))),
                "coil");
            EXPECT_NEAR(design_force(spring), -preload, 1e-11 * 9500) << table;
        }
    const auto edge = element<AxialSpring>(
        laws(spring_with(
            "curve: {table: [[-50, -900], [0, 0], [50, 1400]], outside: unknown}, preload: 900")),
        "coil");
    EXPECT_DOUBLE_EQ(edge.free_length, 0.45);
}

}  // namespace
}  // namespace elastocheck
