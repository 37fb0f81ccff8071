// Scene reader: the shipped scenes, alternative notations, and file handling.
#include "elastocheck/read_scene.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <clocale>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <locale>
#include <numbers>
#include <random>
#include <sstream>

#include "tests/models/fixtures.hpp"
#include "tests/models/scene_numbers.hpp"

namespace elastocheck {
namespace {

namespace fs = std::filesystem;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double per_degree = 180 / std::numbers::pi;  // 1/deg -> 1/rad

Scene parsed(const std::string& text) { return parse_scene(text, "text.yaml"); }

double k_of(const AxialSpring& spring) { return std::get<LinearRate>(spring.law).k; }
Matrix6 K_of(const Bushing& bushing) { return std::get<LinearStiffness>(bushing.law).K; }

template <class T>
T joint(const Scene& scene, const std::string& name) {
    for (const auto& candidate : scene.joints)
        if (candidate.name == name) return std::get<T>(candidate.kind);
    throw std::out_of_range(name);
}

void expect_near(const Eigen::MatrixXd& actual, const Eigen::MatrixXd& expected, double tolerance) {
    const double worst = (actual - expected).cwiseAbs().maxCoeff();
    EXPECT_TRUE(std::isfinite(worst) && worst <= tolerance) << actual << "\n instead of\n"
                                                            << expected;
}

// Every number of `a` and `b`, to a relative tolerance. Coefficients of curves are differences of
// forces divided by lengths: round-off of the larger ones.
void expect_same(const Scene& a, const Scene& b, double tolerance) {
    const auto x = numbers(a), y = numbers(b);
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
        ASSERT_EQ(x[k].first, y[k].first);
        const double difference = std::abs(x[k].second - y[k].second);
        const bool of_curve = x[k].first.find("curved") != std::string::npos,
                   is_coefficient = x[k].first.find(".c_") != std::string::npos;
        const double size =
            is_coefficient ? 1e8 : std::max(std::abs(x[k].second), std::abs(y[k].second));
        EXPECT_TRUE(std::isfinite(difference) &&
                    difference <= (of_curve ? std::max(tolerance, 1e-14) : tolerance) * size)
            << x[k].first << ": " << x[k].second << " and " << y[k].second;
    }
}

// ---- The shipped scenes.

TEST(BuiltInScene, EveryOneLoadsWithClosedJointsAndUnrotatedBodies) {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(ELASTOCHECK_SCENES)) {
        if (entry.path().extension() != ".yaml") continue;
        ++count;
        const Scene scene = read_scene(entry.path());
        SCOPED_TRACE(scene.source);
        EXPECT_EQ(scene.source, entry.path().string());
        for (const auto& body : scene.bodies)
            EXPECT_EQ(body.design.p.coeffs(), Eigen::Vector4d(0, 0, 0, 1));
        const auto position = [&](const Point& p) -> Vector3d {
            return p.body == ground
                       ? p.s_local
                       : scene.bodies.at(static_cast<std::size_t>(p.body)).design.r + p.s_local;
        };
        for (const Joint& candidate : scene.joints)
            std::visit(
                [&](const auto& s) {
                    if constexpr (requires { s.i.s_local; }) {
                        double length = 0;
                        if constexpr (requires { s.length; }) length = s.length;
                        EXPECT_NEAR((position(s.i) - position(s.j)).norm(), length, 1e-15)
                            << candidate.name;
                    }
                },
                candidate.kind);
    }
    EXPECT_GE(count, 7);
}

TEST(Readme, ExampleIsAValidScene) {
    std::ifstream file(fs::path(ELASTOCHECK_SCENES) / "README.md");
    std::string text, line;
    while (std::getline(file, line) && line != "```yaml") continue;
    while (std::getline(file, line) && line != "```") text += line + "\n";
    const Scene scene = parse_scene(text, "README.md");
    EXPECT_EQ(scene.bodies.size(), 3U);  // the third is the rolling wheel
    EXPECT_EQ(scene.branches.at(1).drivers.size(), 2U);
    EXPECT_EQ(scene.elastics.size(), 5U);
}

// Later examples replace or extend sections of the first.
TEST(Readme, ExamplesOfLawsAreValidInTheFirstExample) {
    std::ifstream file(fs::path(ELASTOCHECK_SCENES) / "README.md");
    std::vector<std::string> blocks;
    for (std::string line; std::getline(file, line);) {
        if (line != "```yaml") continue;
        for (blocks.emplace_back(); std::getline(file, line) && line != "```";)
            blocks.back() += line + "\n";
    }
    ASSERT_GE(blocks.size(), 3U);
    for (std::size_t k = 1; k < blocks.size(); ++k) {
        if (!blocks[k].starts_with("springs:") && !blocks[k].starts_with("stops:")) continue;
        SCOPED_TRACE(blocks[k]);
        std::string text = blocks[0];
        std::istringstream lines(blocks[k]);
        for (std::string line; std::getline(lines, line);) {
            if (line.empty() || line[0] == ' ') continue;  // not the head of a section
            const std::string head = "\n" + line.substr(0, line.find(':') + 1);
            if (const auto begin = text.find(head); begin != std::string::npos)
                text.erase(begin, text.find("\n\n", begin) - begin);
        }
        support::Folder folder;
        folder.write("mount.csv", "displacement [m], force [N]\n0, 0\n0.001, 1000\n0.002, 4000\n");
        EXPECT_NO_THROW(read_scene(folder.write("scene.yaml", text + "\n" + blocks[k])));
    }
}

// ---- Units.

// The scene fixtures/units.yaml in these units. Its numbers are in SI units, "<28e3 F/L>": a force by
// a length; A is an angle, M a moment.
std::string scene_in(const std::string& length, const std::string& angle,
                     const std::string& force = "N", const std::string& moment = "") {
    const double L = length == "mm" ? 1000 : 1;        // per m
    const double A = angle == "deg" ? per_degree : 1;  // per rad
    const double F = force == "kN" ? 1e-3 : 1;         // per N
    const double M =
        moment.empty() ? F * L  // per N·m
                       : (moment.starts_with("k") ? 1e-3 : 1) * (moment.ends_with("mm") ? 1e3 : 1);
    std::string text = replaced(fixture("units"), "length: m, angle: rad, force: N",
                                fmt::format("length: {}, angle: {}, force: {}{}", length, angle,
                                            force, moment.empty() ? "" : ", moment: " + moment));
    for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
        const std::size_t end = text.find('>', at), unit = text.find(' ', at) + 1;
        double x = std::stod(text.substr(at + 1, unit - at));
        for (std::size_t k = unit; k < end; ++k) {
            if (text[k] == '/') continue;
            const double factor = text[k] == 'L' ? L : text[k] == 'A' ? A : text[k] == 'F' ? F : M;
            x = text[k - 1] == '/' ? x / factor : x * factor;
        }
        text.replace(at, end + 1 - at, fmt::format("{:.17g}", x));
    }
    return text;
}

TEST(Units, SceneDoesNotDependOnItsUnits) {
    const Scene si = parsed(scene_in("m", "rad"));
    for (const char* length : {"m", "mm"})
        for (const char* angle : {"rad", "deg"}) {
            SCOPED_TRACE(fmt::format("{} {}", length, angle));
            for (const char* force : {"N", "kN"})
                for (const char* moment : {"", "N·m", "N*mm", "kNm", "kN·mm"}) {
                    SCOPED_TRACE(fmt::format("{} {}", force, moment));
                    expect_same(si, parsed(scene_in(length, angle, force, moment)), 2e-15);
                }
        }
}

// ---- Alternative notations.

struct CommaForPoint : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

TEST(Numbers, AreReadWithAPointInEveryLocale) {
    const Scene expected = parsed(bench_scene);
    const std::locale before =
        std::locale::global(std::locale(std::locale::classic(), new CommaForPoint));
    std::setlocale(LC_ALL, "de_DE.UTF-8");  // where it is installed
    const Scene scene = parsed(bench_scene);
    std::string message;
    try {
        parsed(replaced(bench_scene, "preload: 300", "preload: -4500"));
    } catch (const SceneError& error) {
        message = error.what();
    }
    std::locale::global(before);
    std::setlocale(LC_ALL, "C");
    expect_same(scene, expected, 0);
    EXPECT_EQ(message,
              "text.yaml:22: springs.coil.preload: needs a free length of -8.57864 mm; a free "
              "length must be "
              "above zero");
}

TEST(Direction, PerpendicularAxesAreOrthogonalToRounding) {
    for (int n = -10; n <= 10; ++n) {
        const Scene scene = parsed(replaced(
            bench_scene, "axis_j: y", fmt::format("axis_j: [{:.17g}, 0.8, 0.6]", n * 0.99e-10)));
        const auto cross = joint<Universal>(scene, "cross");
        EXPECT_LE(std::abs(cross.axis_i.u_local.dot(cross.axis_j.u_local)), 1e-16) << n;
    }
}

TEST(Frame, TwoAxesInAnyOrderAreARightHandedFrameThatKeepsTheFirst) {
    const Vector3d first(1, 2, -2), second(-0.5, 3, 1);
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
            if (a == b) continue;
            const std::string frame =
                fmt::format("frame: {{{}: [1, 2, -2], {}: [-0.5, 3, 1]}}", "xyz"[a], "xyz"[b]);
            const Scene scene = parsed(replaced(bench_scene, "frame: {x: [middle, front]}", frame));
            const Matrix3d A = element<Bushing>(scene, "mount").i.A_local.toRotationMatrix();
            SCOPED_TRACE(frame);
            expect_near(A.col(a), first.normalized(), 1e-15);
            EXPECT_NEAR(A.col(3 - a - b).dot(second), 0, 1e-15);
            EXPECT_GT(A.col(b).dot(second), 0);
            expect_near(A.transpose() * A, Matrix3d::Identity(), 1e-15);
            EXPECT_NEAR(A.determinant(), 1, 1e-15);
        }
}

TEST(Frame, OneAxisInAnyDirectionIsCompletedRightHanded) {
    for (int axis = 0; axis < 3; ++axis)
        for (const Vector3d& u :
             {Vector3d(1, 0, 0), Vector3d(0, -1, 0), Vector3d(0, 0, 1), Vector3d(0.3, -2, 0.7)}) {
            Vector3d rates(2, 2, 2);
            rates[axis] = 1;
            const Scene scene = parsed(replaced(
                bench_scene,
                "frame: {x: [middle, front]}, rates: [1, 2, 2], rotational_rates: [3, 4, 4]",
                fmt::format("frame: {{{}: [{}, {}, {}]}}, rates: [{}, {}, {}]", "xyz"[axis], u.x(),
                            u.y(), u.z(), rates.x(), rates.y(), rates.z())));
            const auto mount = element<Bushing>(scene, "mount");
            const Matrix3d A = mount.i.A_local.toRotationMatrix();
            expect_near(A.col(axis), u.normalized(), 1e-15);
            expect_near(A.transpose() * A, Matrix3d::Identity(), 1e-15);
            EXPECT_NEAR(A.determinant(), 1, 1e-15);
            EXPECT_EQ(mount.i.A_local.coeffs(), mount.j.A_local.coeffs());
        }
}

TEST(Spring, PreloadIsTheCompressiveForceAtTheDesignPosition) {
    const double length = 0.1 * std::numbers::sqrt2;  // of the bench's coil [m]
    for (const double preload : {-4000.0, -1.0, 0.0, 300.0, 1e5}) {
        const Scene scene =
            parsed(replaced(bench_scene, "preload: 300", fmt::format("preload: {}", preload)));
        const auto coil = element<AxialSpring>(scene, "coil");
        EXPECT_NEAR(k_of(coil) * (length - coil.free_length), -preload, 1e-11) << preload;
    }
    const Scene unloaded = parsed(replaced(bench_scene, ", preload: 300", ""));
    EXPECT_DOUBLE_EQ(element<AxialSpring>(unloaded, "coil").free_length, length);
}

// The bench scene with K as the 6×6 of its bushing `block`.
std::string bench_with(const Matrix6& K) {
    std::string rows;
    for (int i = 0; i < 6; ++i) {
        rows += "      - [";
        for (int j = 0; j < 6; ++j) rows += fmt::format("{}{:.17g}", j > 0 ? ", " : "", K(i, j));
        rows += "]\n";
    }
    const auto begin = bench_scene.find("      - [100"), end = bench_scene.find("\nstatic_loads");
    return bench_scene.substr(0, begin) + rows + bench_scene.substr(end);
}

// The 6×6 of SI units K as it is written in the units named.
struct UnitsOfText {
    const char *text, *length, *angle;
    double per_newton_metre;  // of the declared moment
};
const UnitsOfText all_units[] = {
    {"length: m, angle: rad, force: N", "m", "rad", 1},
    {"length: m, angle: deg, force: N", "m", "deg", 1},
    {"length: mm, angle: rad, force: N", "mm", "rad", 1000},
    {"length: mm, angle: deg, force: N", "mm", "deg", 1000},
    {"length: mm, angle: deg, force: N, moment: N·m", "mm", "deg", 1},
};

Matrix6 written(const Matrix6& K, const UnitsOfText& units) {
    const double per_m = units.length == std::string("mm") ? 1000 : 1;
    const double per_rad = units.angle == std::string("deg") ? per_degree : 1;
    Matrix6 W = K;
    W.topLeftCorner<3, 3>() /= per_m;
    W.topRightCorner<3, 3>() /= per_rad;
    W.bottomLeftCorner<3, 3>() /= per_rad;
    W.bottomRightCorner<3, 3>() *= units.per_newton_metre / per_rad;
    return W;
}

std::string bench_with(const Matrix6& K, const UnitsOfText& units) {
    return replaced(bench_with(written(K, units)), "length: mm, angle: deg, force: N", units.text);
}

// V Vᵀ with V [6 × rank], like a bushing matrix computed elsewhere. Its zero eigenvalues are
// ±1e-16. The same 6×6 is accepted or rejected in all units.
TEST(Stiffness, DefinitenessDoesNotDependOnUnits) {
    std::mt19937 random(6);
    std::normal_distribution<double> normal;
    for (int n = 0; n < 100; ++n) {
        Eigen::MatrixXd V(6, 1 + n % 5);
        for (double& v : V.reshaped()) v = normal(random) * std::exp(3 * normal(random));
        const Matrix6 K = V * V.transpose();
        const Matrix6 indefinite = K - 1e-9 * Matrix6(K.diagonal().asDiagonal());
        for (const UnitsOfText& units : all_units) {
            EXPECT_NO_THROW(parsed(bench_with(K, units))) << units.text << "\n" << K;
            EXPECT_THROW(parsed(bench_with(indefinite, units)), SceneError) << units.text << "\n"
                                                                            << indefinite;
        }
    }
}

// The congruence with D = diag(√N/mm ..., √N·mm/deg ...) has √(N/mm · N·mm/deg) = N/√deg in its
// off-diagonal blocks, where N/deg is written: converting deg to rad increases the coupling
// relative to the diagonal by √57.3.
TEST(Stiffness, MatrixIndefiniteInSiIsRejectedInAllUnits) {
    Matrix6 K = Matrix6::Identity();
    K.topLeftCorner<3, 3>() *= 1e6;
    K.bottomRightCorner<3, 3>() *= 1e2;
    K(0, 4) = K(4, 0) = 3e4;  // √(1e6 · 1e2) = 1e4 is the most that it may be
    for (const UnitsOfText& units : all_units)
        EXPECT_THROW(parsed(bench_with(K, units)), SceneError) << units.text;
    const Eigen::MatrixXd in_degrees = written(K, all_units[3]);
    EXPECT_GT(in_degrees.eigenvalues().real().minCoeff(), 0) << "as written it looks definite";
    K(0, 4) = K(4, 0) = 0.99e4;
    for (const UnitsOfText& units : all_units)
        EXPECT_NO_THROW(parsed(bench_with(K, units))) << units.text;
}

TEST(Stiffness, MatrixSymmetricToRoundingIsReadAsExactlySymmetric) {
    Matrix6 K = 100 * Matrix6::Identity();
    K(0, 4) = 5;
    K(4, 0) = 5 * (1 + 9e-13);
    const Matrix6 read = K_of(element<Bushing>(parsed(bench_with(K)), "block"));
    EXPECT_EQ(read, read.transpose());
    EXPECT_NE(read(0, 4), 0);
}

TEST(SceneSections, OrderDoesNotChangeTheScene) {
    std::vector<std::string> sections;
    std::istringstream lines(bench_scene);
    for (std::string line; std::getline(lines, line);) {
        const bool begins = !line.empty() && line[0] != ' ';
        if (begins) sections.emplace_back();
        sections.back() += line + "\n";
    }
    std::string backwards;
    for (auto section = sections.rbegin(); section != sections.rend(); ++section)
        backwards += *section;
    expect_same(parsed(bench_scene), parsed(backwards), 0);
}

TEST(SceneText, LineEndsAndByteOrderMarkDoNotChangeTheScene) {
    std::string windows = "\xEF\xBB\xBF";
    for (const char c : bench_scene) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    expect_same(parsed(bench_scene), parsed(windows), 0);
}

// ---- Files.

struct TemporaryFile {
    fs::path path = fs::path(testing::TempDir()) /
                    fmt::format("elastocheck_{}.yaml",
                                testing::UnitTest::GetInstance()->current_test_info()->name());
    explicit TemporaryFile(const std::string& text) {
        std::ofstream(path, std::ios::binary) << text;
    }
    ~TemporaryFile() { fs::remove(path); }
};

TEST(SceneFile, IsReadAsTheSceneOfItsText) {
    const TemporaryFile file(bench_scene);
    const Scene scene = read_scene(file.path);
    EXPECT_EQ(scene.source, file.path.string());
    EXPECT_EQ(scene.name, "Bench");
    expect_same(scene, parsed(bench_scene), 0);
}

}  // namespace
}  // namespace elastocheck
