// Derivatives of models by the numbers of their files: against extrapolated differences of
// read_scene() and compile(), and against closed forms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <typeinfo>
#include <utility>
#include <vector>

#include "elastocheck/compile.hpp"
#include "models/rates/bridge.hpp"
#include "models/rates/fields.hpp"
#include "models/rates/model_rates.hpp"
#include "tests/models/fixtures.hpp"

namespace elastocheck {
namespace {

namespace fs = std::filesystem;

// All data of a scene or a model: `structure` all but its numbers.
struct Data {
    static constexpr bool writes = false;
    std::vector<std::string> structure;
    std::vector<double> numbers;
    void text(const std::string& x) { structure.push_back(x); }
    void whole(auto x) { structure.push_back(std::to_string(static_cast<long long>(x))); }
    void number(const double& x) { numbers.push_back(x); }
};
template <class T>
Data data(const T& x) {
    Data result;
    rates::each_datum(result, x);
    return result;
}

// The numbers of the scene, then those of its model.
std::vector<double> numbers_of(const Data& scene, const Data& model) {
    std::vector<double> all = scene.numbers;
    all.insert(all.end(), model.numbers.begin(), model.numbers.end());
    return all;
}

struct Original {
    fs::path file;
    Scene scene = read_scene(file);
    Data scene_data = data(scene), model_data = data(compile(scene));
    std::vector<double> numbers = numbers_of(scene_data, model_data);

    // With another value; empty where the file is not accepted or has another structure.
    std::vector<double> with(const std::string& path, double value) const {
        try {
            const std::vector<Setting> settings{setting(path, value)};
            const Scene varied = read_scene(file, settings);
            const Data its_scene = data(varied), its_model = data(compile(varied));
            const bool same = its_scene.structure == scene_data.structure &&
                              its_model.structure == model_data.structure;
            return same ? numbers_of(its_scene, its_model) : std::vector<double>{};
        } catch (const SceneError&) {
            return {};
        }
    }
};

// Size of a change of the number that changes the model by about its size. The rows of a table lie
// close to each other.
double size_of(const Number& number) {
    if (number.path.find(".table.") != std::string::npos)
        return std::max(0.1 * std::abs(number.value), number.unit == "m" ? 1e-3 : 1e-1);
    const double least = number.unit == "mm"  ? 100
                         : number.unit == "m" ? 0.1
                         : number.value == 0  ? 1e-3
                                              : 0;
    return std::max(std::abs(number.value), least);
}

// The largest of an entry and its neighbours, which belong to the same vector or polynomial.
double largest(const std::vector<double>& entries, std::size_t n) {
    double result = 0;
    for (std::size_t k = n < 4 ? 0 : n - 4; k < std::min(n + 5, entries.size()); ++k)
        result = std::max(result, std::abs(entries[k]));
    return result;
}

// Derivatives by differences, with their uncertainty.
struct Differences {
    std::vector<double> rates, uncertainty;
    std::vector<bool> jump;  // the entry is not continuous here
    bool exist() const { return !rates.empty(); }
};

// Richardson's table of differences `d`: column k removes the error of order k·p of the step, which
// is halved from row to row. Its last two diagonal entries differ by the uncertainty.
Differences extrapolated(std::vector<std::vector<double>> d, int p) {
    std::vector<double> before = d.back();
    for (std::size_t k = 1; k < d.size(); ++k) {
        before = d.back();
        for (std::size_t row = d.size() - 1; row >= k; --row) {
            const double factor = std::pow(2, p * static_cast<int>(k)) - 1;
            for (std::size_t n = 0; n < d[row].size(); ++n)
                d[row][n] += (d[row][n] - d[row - 1][n]) / factor;
        }
    }
    Differences result{d.back(), {}, {}};
    for (std::size_t n = 0; n < before.size(); ++n)
        result.uncertainty.push_back(std::abs(before[n] - result.rates[n]));
    return result;
}

// Central differences, or to the side (±1) where the number is at the end of its range. None if it
// cannot be varied by so much.
Differences by_differences(const Original& original, const Number& number, int side) {
    std::vector<std::vector<double>> differences, middles;
    const double first = 2e-3 * size_of(number);
    const std::vector<double>& here = original.numbers;
    for (double h = first; h > first / 7; h /= 2) {
        const auto above = side < 0 ? here : original.with(number.path, number.value + h),
                   below = side > 0 ? here : original.with(number.path, number.value - h);
        if (above.empty() || below.empty()) return {};
        // the step as made: the sums are rounded
        const double step = (side < 0 ? number.value : number.value + h) -
                            (side > 0 ? number.value : number.value - h);
        auto& d = differences.emplace_back();
        auto& middle = middles.emplace_back();
        for (std::size_t n = 0; n < here.size(); ++n) {
            d.push_back((above[n] - below[n]) / step);
            middle.push_back(std::abs(0.5 * (above[n] + below[n]) - here[n]));
        }
    }
    Differences result = extrapolated(differences, side == 0 ? 2 : 1);
    // A jump is as large for a quarter of the step, and concerns all of a vector or quaternion.
    std::vector<double> jumps;
    for (std::size_t n = 0; n < here.size(); ++n)
        jumps.push_back(side == 0 && middles.back()[n] > 0.9 * middles.front()[n] &&
                        middles.back()[n] > 1e-3);
    for (std::size_t n = 0; n < here.size(); ++n) result.jump.push_back(largest(jumps, n) > 0);
    return result;
}

constexpr double tolerance = 1e-8;  // of the size of an entry

// Size of the derivative of an entry: its own, or the entry's value over the size of the number.
double size_of(std::size_t entry, const Differences& by, const Original& original,
               const Number& number) {
    return std::max({std::abs(by.rates[entry]), std::abs(original.numbers[entry]) / size_of(number),
                     1e-12 / size_of(number)});
}

// The entry that differs most, relative to what it may differ by: the tolerance, twenty uncertainties
// of its neighbours, and their round-off.
struct Worst {
    double error = 0;
    std::size_t entry = 0;
    int known = 0, unknown = 0;  // entries whose uncertainty is below the tolerance or above
};
Worst worst(const std::vector<double>& rates, const Differences& by, const Original& original,
            const Number& number) {
    Worst result;
    for (std::size_t n = 0; n < rates.size(); ++n) {
        const double allowed = tolerance * size_of(n, by, original, number);
        ++(by.jump[n] || by.uncertainty[n] > allowed ? result.unknown : result.known);
        const double error =
            std::abs(rates[n] - by.rates[n]) /
            (allowed + 20 * largest(by.uncertainty, n) + 1e-12 * largest(by.rates, n));
        if (!by.jump[n] && !(error <= result.error)) result.error = error, result.entry = n;
    }
    return result;
}

std::vector<fs::path> all_files() {
    std::vector<fs::path> files;
    for (const char* folder : {ELASTOCHECK_SCENES, ELASTOCHECK_FIXTURES})
        for (const auto& entry : fs::directory_iterator(folder))
            if (entry.path().extension() == ".yaml" && entry.path().stem() != "units")
                files.push_back(entry.path());  // units.yaml: text with gaps to fill
    std::ranges::sort(files);
    return files;
}

class Rates : public testing::TestWithParam<fs::path> {};
INSTANTIATE_TEST_SUITE_P(, Rates, testing::ValuesIn(all_files()), [](const auto& file) {
    return file.param.parent_path().filename().string() + "_" + file.param.stem().string();
});

std::vector<std::string> paths_of(const Scene& scene) {
    std::vector<std::string> paths;
    for (const Number& number : scene.numbers) paths.push_back(number.path);
    return paths;
}

TEST_P(Rates, AreTheLimitOfDifferences) {
    const Original original{GetParam()};
    const auto rates = model_rates(GetParam(), {}, paths_of(original.scene));
    ASSERT_EQ(rates.size(), original.scene.numbers.size());
    int known = 0, unknown = 0;
    for (std::size_t k = 0; k < rates.size(); ++k) {
        const Number& number = original.scene.numbers[k];
        SCOPED_TRACE(number.path);
        EXPECT_EQ(rates[k].path, number.path);
        const Data model = data(rates[k].rate), scene = data(rates[k].scene_rate);
        EXPECT_EQ(model.structure, original.model_data.structure);
        EXPECT_EQ(scene.structure, original.scene_data.structure);
        const auto differences = by_differences(original, number, rates[k].side);
        if (!rates[k].undefined.empty()) {
            // A change that the file accepts and that keeps the structure has a derivative, or two.
            EXPECT_TRUE(!differences.exist() || rates[k].below.has_value() ||
                        rates[k].undefined == "a whole number")
                << rates[k].undefined;
            continue;
        }
        ASSERT_TRUE(differences.exist());
        const auto all = numbers_of(scene, model);
        const Worst at = worst(all, differences, original, number);
        EXPECT_LE(at.error, 1) << "entry " << at.entry << ": " << all[at.entry]
                               << ", by differences " << differences.rates[at.entry] << " ± "
                               << differences.uncertainty[at.entry] << ", value "
                               << original.numbers[at.entry];
        known += at.known, unknown += at.unknown;
    }
    RecordProperty("known", known);
    EXPECT_GT(known, 0);
    EXPECT_LE(unknown, 0.02 * known) << "of " << known << " entries";
}

TEST_P(Rates, ComeWithTheValuesOfTheModelToTheLastBit) {
    const Scene scene = read_scene(GetParam());
    const Data of_scene = data(scene), of_model = data(compile(scene));
    const std::string text = support::text_of(GetParam());
    const auto answer = elastocheck_dual::read({.text = text,
                                                .name = GetParam().string(),
                                                .folder = GetParam().parent_path().string(),
                                                .settings = {}},
                                               false, {}, 0);
    EXPECT_EQ(answer.error, "");
    EXPECT_EQ(answer.scene.values, of_scene.numbers);
    EXPECT_EQ(answer.model.values, of_model.numbers);
}

TEST_P(Rates, OfASceneAreCompiledToThoseOfItsModel) {
    const Scene scene = read_scene(GetParam());
    const auto rates = model_rates(GetParam(), {}, paths_of(scene));
    for (const ModelRate& rate : rates) {
        if (!rate.undefined.empty()) continue;
        SCOPED_TRACE(rate.path);
        const ModelRate compiled = model_rate(scene, rate.scene_rate);
        EXPECT_EQ(compiled.undefined, "");
        EXPECT_EQ(data(compiled.rate).numbers, data(rate.rate).numbers);
    }
}

// ---- A member that fields.hpp forgets would have no derivative.

struct Anything {
    template <class T>
    operator T() const;
};
template <class T, class... A>
concept Takes = requires {
    T{A{}...};
};
template <class T, class... A>
constexpr std::size_t members() {
    if constexpr (Takes<T, A..., Anything>)
        return members<T, A..., Anything>();
    else
        return sizeof...(A);
}
template <class T>
std::size_t visited() {
    T x;
    std::size_t count = 0;
    rates::fields(x, [&](auto&... all) { count = sizeof...(all); });
    return count;
}
template <class T>
void expect_visited() {
    EXPECT_EQ(visited<T>(), members<T>()) << typeid(T).name();
}
template <class... T>
void expect_all_visited() {
    (expect_visited<T>(), ...);
}

TEST(ModelRates, HaveEveryMember) {
    expect_all_visited<Pose, Body, Point, Direction, Marker, Formulation, LinearRate, Curve,
                       LinearStiffness, PerAxis, Joint, Elastic, Load, Driver, Branch, SteeringAxis,
                       Wheel, Probe, Damper, Vehicle, Hardpoint, WheelTravel, WheelToe, WheelCamber,
                       ProbeCoordinate, Trim::Adjustment, Trim::Condition, Trim, Omission, Scene,
                       Constraint, ModelJoint, Size, Model>();
    EXPECT_EQ(visited<Number>() + 1, members<Number>());  // all but the value
}

// ---- Closed forms.

ModelRate rate_of(const std::string& text, const std::string& path) {
    return model_rates(text, "scene.yaml", {}, std::vector{path}).front();
}
template <class T>
T element(const Model& model, const std::string& name) {
    for (const auto& elastic : model.elastics)
        if (elastic.name == name) return std::get<T>(elastic.kind);
    throw std::out_of_range(name);
}
void expect_near(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    EXPECT_LE((a - b).norm(), 1e-13 * (1 + b.norm())) << a.transpose() << "  " << b.transpose();
}

// d(v/|v|) = (dv - u u·dv)/|v|
TEST(ModelRates, OfANormalisedAxis) {
    const std::string text = laws_scene(
        "torsion_springs: {bar: {bodies: [arm, ground], at: p, axis: [1, 2, 2], rate: 3}}");
    const auto rate = rate_of(text, "torsion_springs.bar.axis.y");
    const Vector3 v(1, 2, 2), u = v / 3, du = (Vector3::UnitY() - u * u.y()) / 3;
    const Bushing bar = element<Bushing>(compile(parse_scene(text, "scene.yaml")), "bar"),
                  dbar = element<Bushing>(rate.rate, "bar");
    // The axis is A e_z, A of the unit quaternion p, dA that of p dp and dp p.
    const auto axis = [](const Quaternion& p, const Quaternion& q) {
        const Quaternion z(0, 0, 0, 1);
        return Vector3((p * z * q.conjugate()).vec());
    };
    expect_near(axis(bar.i.A_local, bar.i.A_local), u);
    expect_near(axis(dbar.i.A_local, bar.i.A_local) + axis(bar.i.A_local, dbar.i.A_local), du);
    EXPECT_NEAR(bar.i.A_local.coeffs().dot(dbar.i.A_local.coeffs()), 0, 1e-15);
}

// Where the axis is along z, the perpendicular directions are those of this axis; for any other
// axis they are different ones. The derivative is that of the axis all the same.
TEST(ModelRates, OfAnAxisAlongZ) {
    const std::string text = laws_scene(
        "torsion_springs: {bar: {bodies: [arm, ground], at: p, axis: [0, 0, 4], rate: 3}}");
    const auto rate = rate_of(text, "torsion_springs.bar.axis.x");
    EXPECT_EQ(rate.undefined, "");
    const Bushing dbar = element<Bushing>(rate.rate, "bar"),
                  bar = element<Bushing>(compile(parse_scene(text, "scene.yaml")), "bar");
    const Quaternion z(0, 0, 0, 1);
    const Quaternion dz = dbar.i.A_local * z * bar.i.A_local.conjugate();
    expect_near(2 * dz.vec(), Vector3(0.25, 0, 0));
}

// ℓ₀ = ℓ + P/k
TEST(ModelRates, OfTheFreeLengthUnderAPreload) {
    const std::string text = laws_scene(
        "springs: {coil: {bodies: [arm, ground], from: p, to: t, rate: 20, preload: 300}}");
    const auto of = [&](const char* path) {
        return element<AxialSpring>(rate_of(text, path).rate, "coil");
    };
    // per N, per N/mm and per mm; t is 400 mm above p
    EXPECT_NEAR(of("springs.coil.preload").free_length, 1 / 20e3, 1e-18);
    EXPECT_NEAR(of("springs.coil.rate").free_length, -300 / 20e3 / 20e3 * 1e3, 1e-18);
    EXPECT_EQ(std::get<LinearRate>(of("springs.coil.rate").law).k, 1e3);
    EXPECT_NEAR(of("points.t.z").free_length, 1e-3, 1e-17);
    expect_near(of("points.t.z").j.s_local, Vector3(0, 0, 1e-3));
}

// f(ℓ - ℓ₀) = -P on the cubic between [0, 0] and [50, 1400]: dℓ₀/dP = 1/f'.
TEST(ModelRates, OfTheFreeLengthUnderAPreloadByACurve) {
    const std::string text = laws_scene(
        "springs: {coil: {bodies: [arm, ground], from: p, to: t, preload: -300, "
        "curve: {table: [[-50, -900], [0, 0], [50, 1400]]}}}");
    const AxialSpring coil = element<AxialSpring>(compile(parse_scene(text, "scene.yaml")), "coil"),
                      dcoil =
                          element<AxialSpring>(rate_of(text, "springs.coil.preload").rate, "coil");
    const Curve& curve = std::get<Curve>(coil.law);
    const double x = 0.4 - coil.free_length, t = x - curve.knots[1];
    const auto& c = curve.pieces[2];
    EXPECT_NEAR(c[0] + t * (c[1] + t * (c[2] + t * c[3])), 300, 1e-10);
    EXPECT_NEAR(dcoil.free_length * (c[1] + t * (2 * c[2] + t * 3 * c[3])), 1, 1e-12);
}

TEST(ModelRates, OfMirroredPartsMoveOnBothSides) {
    const auto rate = rate_of(axle_scene, "points.tie_outer_left.y");
    Vector3 left = Vector3::Zero(), right = Vector3::Zero();
    for (const Hardpoint& point : rate.scene_rate.hardpoints) {
        if (point.name == "tie_outer_left") left = point.position;
        if (point.name == "tie_outer_right") right = point.position;
    }
    EXPECT_EQ(left, Vector3(0, 1e-3, 0));
    EXPECT_EQ(right, Vector3(0, -1e-3, 0));
}

// ---- Where there is none.

TEST(ModelRates, AtTheEndOfARangeAreThoseToItsInside) {
    const std::string text =
        laws_scene("bushings: {mount: {bodies: [arm, ground], at: p, rates: [0, 2, 3]}}");
    const auto rate = rate_of(text, "bushings.mount.rates.x");
    EXPECT_EQ(rate.undefined, "");
    EXPECT_EQ(rate.side, 1);
    EXPECT_EQ(std::get<LinearStiffness>(element<Bushing>(rate.rate, "mount").law).K(0, 0), 1e3);
}

// The deflection at 0 N, where the slope of the polygon is 18 N/mm below and 28 N/mm above. A
// larger preload is a compression.
TEST(ModelRates, AtAKinkAreThoseToBothSides) {
    const auto rate = rate_of(
        laws_scene("springs: {coil: {bodies: [arm, ground], from: p, to: t, preload: 0, curve: "
                   "{table: [[-50, -900], [0, 0], [50, 1400]], interpolation: linear}}}"),
        "springs.coil.preload");
    EXPECT_EQ(rate.undefined, "the derivative differs on both sides of this value");
    EXPECT_TRUE(std::isnan(element<AxialSpring>(rate.rate, "coil").free_length));
    ASSERT_TRUE(rate.below && rate.above);
    EXPECT_NEAR(element<AxialSpring>(*rate.below, "coil").free_length, 1 / 28e3, 1e-18);
    EXPECT_NEAR(element<AxialSpring>(*rate.above, "coil").free_length, 1 / 18e3, 1e-18);
}

TEST(ModelRates, OfWhatTheFileAcceptsOnlyTogetherAreJoined) {
    const std::string mount =
        "bushings: {mount: {bodies: [arm, ground], at: p, frame: {z: z}, "
        "rates: [2, 2, 3]}}";
    const auto alone = rate_of(laws_scene(mount), "bushings.mount.rates.x");
    EXPECT_TRUE(alone.undefined.starts_with("cannot be varied alone: ")) << alone.undefined;
    EXPECT_NE(alone.undefined.find("one axis is not enough"), std::string::npos);
    const auto both = rate_of(laws_scene(mount), "bushings.mount.rates.x,bushings.mount.rates.y");
    EXPECT_EQ(both.undefined, "");
    const auto& K = std::get<LinearStiffness>(element<Bushing>(both.rate, "mount").law).K;
    EXPECT_EQ(K.diagonal(), 1e3 * (Vector6() << 1, 1, 0, 0, 0, 0).finished());
}

TEST(ModelRates, OfAllNumbersAreJoinedWhereTheFileAcceptsThemTogether) {
    std::vector<std::string> paths, open;
    for (const ModelRate& rate : all_model_rates(fs::path(ELASTOCHECK_SCENES) / "mcpherson.yaml")) {
        paths.push_back(rate.path);
        if (!rate.undefined.empty()) open.push_back(rate.path);
    }
    EXPECT_TRUE(
        std::ranges::count(paths, "bushings.K3_arm_front.rates.y,bushings.K3_arm_front.rates.z"));
    for (const std::string& path : open) EXPECT_TRUE(path.ends_with(".steps")) << path;
}

TEST(ModelRates, OfANumberThatDecidesWhatIsModelledHaveAReason) {
    const std::string scene = laws_scene(
        "static_loads: {pull: {on: arm, at: p, force: [0, 0, 0]}}\n"
        "springs: {coil: {bodies: [arm, ground], from: p, to: t, rate: 20}}");
    EXPECT_TRUE(rate_of(scene, "static_loads.pull.force.x")
                    .undefined.starts_with("decides at this value which parts the model has"));
    const auto all =
        model_rates(scene, "scene.yaml", {}, std::vector<std::string>{"static_loads.pull.force.x"},
                    Detail::everything);
    EXPECT_EQ(all.front().undefined, "");
    EXPECT_EQ(rate_of(scene, "branches.up.steps").undefined, "a whole number");
}

TEST(ModelRates, OfAnUnknownNumberAreRefused) {
    try {
        rate_of(bench_scene, "springs.coil.rat");
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean 'springs.coil.rate'"),
                  std::string::npos)
            << error.what();
    }
}

// The comparison with differences would notice an error of a millionth in any entry that changes.
TEST(ModelRates, AWrongOneIsNoticed) {
    const Original original{fs::path(ELASTOCHECK_SCENES) / "mcpherson.yaml"};
    const Number& number =
        *std::ranges::find(original.scene.numbers, "points.arm_front.y", &Number::path);
    const auto rate = model_rates(original.file, {}, std::vector{number.path}).front();
    const auto differences = by_differences(original, number, 0);
    auto all = numbers_of(data(rate.scene_rate), data(rate.rate));
    int noticed = 0;
    for (std::size_t n = 0; n < all.size(); ++n) {
        const double size = size_of(n, differences, original, number);
        if (size < 1e-6) continue;
        const double right = std::exchange(all[n], all[n] + 1e-6 * size);
        EXPECT_GT(worst(all, differences, original, number).error, 1) << n;
        all[n] = right;
        ++noticed;
    }
    EXPECT_GT(noticed, 3);
    EXPECT_LE(worst(all, differences, original, number).error, 1);
}

}  // namespace
}  // namespace elastocheck
