// Exact error messages for curves, stops, torsion springs, formulations and followers.
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "tests/models/laws_scene.hpp"

namespace elastocheck {
namespace {

struct Mistake {
    const char* name;
    std::string elements;  // sections
    std::string message;   // after "laws.yaml:"
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

std::string curve(const std::string& fields) { return spring_with("curve: {" + fields + "}"); }
std::string bump(const std::string& fields) {
    return spring_with("rate: 5, bump_stop: {" + fields + "}");
}
std::string torsion(const std::string& fields) {
    return "torsion_springs:\n  bar: {bodies: [arm, ground], at: p, " + fields + "}";
}
std::string bushing(const std::string& fields) {
    return "bushings:\n  mount: {bodies: [arm, ground], at: p, " + fields + "}";
}
std::string stops(const std::string& fields) {
    return "stops:\n  axle: {bodies: [arm, ground], " + fields + "}";
}

const std::string table = "table: [[-50, -900], [0, 0], [50, 1400]]";
const std::string one_of_two = "allowed: one of the two";
const std::string one_axis = "11: bushings.mount.frame: one axis is not enough, because ";
const std::string second = "; give a second one";

const std::vector<Mistake> mistakes{
    // ---- curves
    {"CurveIsAList", spring_with("curve: [[0, 0], [1, 1]]"),
     "11: springs.coil.curve: expected a map with the fields table, file, scale, offset, "
     "symmetric, "
     "interpolation, outside, "
     "found a "
     "list of 2"},
    {"UnknownFieldOfCurve", curve("tabel: [[0, 0], [1, 1]]"),
     "11: springs.coil.curve: unknown field 'tabel', did you mean 'table'? allowed: table, file, "
     "scale, "
     "offset, "
     "symmetric, interpolation, outside"},
    {"CurveWithoutPoints", curve("scale: 2"),
     "11: springs.coil.curve: no points; required: table or file"},
    {"TableAndFile", curve(table + ", file: coil.csv"),
     "11: springs.coil.curve.file: given together with table; " + one_of_two},
    {"FileOfAText", curve("file: coil.csv"),
     "11: springs.coil.curve.file: relative to the scene's file, but this scene is not a file; "
     "give a table"},
    {"FileIsAList", curve("file: [coil.csv]"),
     "11: springs.coil.curve.file: expected the name of a file, found a list of 1"},
    {"TableIsANumber", curve("table: 5"),
     "11: springs.coil.curve.table: expected at least two rows [deflection, force], found '5'"},
    {"TableOfOneRow", curve("table: [[0, 0]]"),
     "11: springs.coil.curve.table: expected at least two rows [deflection, force], found a list "
     "of 1"},
    {"TableIsAMap", curve("table: {0: 0, 1: 1}"),
     "11: springs.coil.curve.table: expected at least two rows [deflection, force], found a map"},
    {"RowOfOneNumber", curve("table: [[0, 0], [5]]"),
     "11: springs.coil.curve.table: row 2: expected two numbers, deflection and force, found a "
     "list of 1"},
    {"RowIsANumber", curve("table: [0, 5]"),
     "11: springs.coil.curve.table: row 1: expected two numbers, deflection and force, found '0'"},
    {"RowOfAWord", curve("table: [[0, 0], [5, much]]"),
     "11: springs.coil.curve.table: expected a number, found 'much'"},
    {"RowNotFinite", curve("table: [[0, 0], [5, inf]]"),
     "11: springs.coil.curve.table: 'inf' is out of range; allowed: 0, or 1e-30 to 1e+30 in size"},
    {"DeflectionRepeated", curve("table: [[0, 0], [5, 10], [5, 20]]"),
     "11: springs.coil.curve.table: row 3: deflection '5' is not larger than that of the row "
     "before"},
    {"DeflectionFalling", curve("table: [[0, 0], [-5, 10]]"),
     "11: springs.coil.curve.table: row 2: deflection '-5' is not larger than that of the row "
     "before"},
    {"ForceFalling", curve("table: [[0, 0], [5, 20], [10, 19]]"),
     "11: springs.coil.curve.table: row 3: force '19' is smaller than that of the row before; it "
     "must not decrease"},
    {"ScaleOfZero", curve(table + ", scale: 0"),
     "11: springs.coil.curve.scale: '0' is not a scale; allowed: above zero"},
    {"NegativeScale", curve(table + ", scale: -1"),
     "11: springs.coil.curve.scale: '-1' is not a scale; allowed: above zero"},
    {"OffsetTooLarge", curve(table + ", offset: 1e20"),
     "11: springs.coil.curve.offset: '1e20' is so large that rows of the table coincide"},
    {"SymmetricOfBothSides", curve(table + ", symmetric: true"),
     "11: springs.coil.curve.symmetric: the table of a symmetric curve must begin with [0, 0]; the "
     "other half is generated"},
    {"SymmetricWithAForceAtZero", curve("table: [[0, 1], [1, 2]], symmetric: true"),
     "11: springs.coil.curve.symmetric: the table of a symmetric curve must begin with [0, 0]; the "
     "other half is generated"},
    {"SymmetricPerhaps", curve(table + ", symmetric: perhaps"),
     "11: springs.coil.curve.symmetric: 'perhaps' is not yes or no; allowed: true, false"},
    {"OutsideOtherwise", curve(table + ", outside: constant"),
     "11: springs.coil.curve.outside: 'constant' is not a kind of extrapolation; allowed: linear, "
     "unknown"},
    {"RateAndCurve", spring_with("rate: 5, curve: {" + table + "}"),
     "11: springs.coil.curve: given together with rate; " + one_of_two},
    {"NeitherRateNorCurve", spring_with("preload: 5"),
     "11: springs.coil: no law; required: rate or curve"},
    // ---- preload of a spring with a curve
    {"PreloadBeyondAnUnknownEnd",
     spring_with("curve: {" + table + ", outside: unknown}, preload: 901"),
     "11: springs.coil.preload: the curve never has -901 N; its table goes from -900 to 1400"},
    {"TensionBeyondAnUnknownEnd",
     spring_with("curve: {" + table + ", outside: unknown}, preload: -1401"),
     "11: springs.coil.preload: the curve never has 1401 N; its table goes from -900 to 1400"},
    {"PreloadBeyondAFlatEnd",
     spring_with("curve: {table: [[-50, -900], [-40, -900], [0, 0]]}, preload: 901"),
     "11: springs.coil.preload: the curve never has -901 N; its table goes from -900 to 0"},
    {"PreloadOnAFlatEnd", spring_with("curve: {table: [[-50, 0], [0, 0], [40, 1000]]}, preload: 0"),
     "11: springs.coil.preload: the curve has 0 N at more than one deflection; give free_length "
     "instead"},
    {"PreloadOnAFlatPiece",
     spring_with("curve: {table: [[-50, -900], [-40, -500], [-20, -500], [0, 0]]}, preload: 500"),
     "11: springs.coil.preload: the curve has -500 N at more than one deflection; give free_length "
     "instead"},
    {"PreloadThatNeedsNoLength", spring_with("curve: {" + table + "}, preload: -30e3"),
     "11: springs.coil.preload: needs a free length of -516.667 mm; a free length must be above "
     "zero"},
    {"FreeLengthAndPreload", spring_with("curve: {" + table + "}, free_length: 400, preload: 5"),
     "11: springs.coil.preload: given together with free_length; " + one_of_two},
    // ---- stops
    {"StopWithoutClearance", bump("rate: 5"),
     "11: springs.coil.bump_stop.clearance: missing; this field is required"},
    {"StopWithoutLaw", bump("clearance: 5"),
     "11: springs.coil.bump_stop: no law; required: rate or curve"},
    {"StopOfRateAndCurve", bump("clearance: 5, rate: 5, curve: {table: [[0, 0], [1, 1]]}"),
     "11: springs.coil.bump_stop.curve: given together with rate; " + one_of_two},
    {"StopOfNegativeRate", bump("clearance: 5, rate: -5"),
     "11: springs.coil.bump_stop.rate: negative rate '-5'; allowed: zero or more"},
    {"UnknownFieldOfStop", bump("clearence: 5, rate: 5"),
     "11: springs.coil.bump_stop: unknown field 'clearence', did you mean 'clearance'? allowed: "
     "clearance, "
     "rate, curve"},
    {"StopWithForceWhereItTouches", bump("clearance: 5, curve: {table: [[0, 10], [1, 20]]}"),
     "11: springs.coil.bump_stop.curve: the table of a stop must begin with [0, 0], where it "
     "closes"},
    {"StopThatTouchesLater", bump("clearance: 5, curve: {table: [[1, 0], [2, 20]]}"),
     "11: springs.coil.bump_stop.curve: the table of a stop must begin with [0, 0], where it "
     "closes"},
    {"StopWithOffset", bump("clearance: 5, curve: {table: [[0, 0], [1, 20]], offset: 1}"),
     "11: springs.coil.bump_stop.curve: unknown field 'offset'; allowed: table, file, scale, "
     "interpolation, "
     "outside"},
    {"StopTooFar", bump("clearance: 1e20, curve: {table: [[0, 0], [1, 20]]}"),
     "11: springs.coil.bump_stop.clearance: '1e20' is so large that rows of the curve coincide"},
    {"StopsWithoutAny", stops("from: p, to: t"),
     "11: stops.axle: no stop; required: bump or rebound"},
    {"UnknownStop", stops("from: p, to: t, bump_stop: {clearance: 5, rate: 5}"),
     "11: stops.axle: unknown field 'bump_stop'; allowed: bodies, from, to, bump, rebound"},
    {"StopOfNoLength", stops("from: p, to: p, bump: {clearance: 5, rate: 5}"),
     "11: stops.axle.to: the same position as `from`; a spring needs a length"},
    {"StopOfATakenName",
     "springs:\n  axle.bump: {bodies: [arm, ground], from: p, to: t, rate: 5}\n" +
         stops("from: p, to: t, bump: {clearance: 5, rate: 5}"),
     "13: stops.axle.bump: the element name 'axle.bump' is reserved for its stop, but already in "
     "use; rename the other element"},
    {"StopInASpringOfATakenName",
     spring_with("rate: 5, bump_stop: {clearance: 5, rate: 5}") +
         "\n  coil.bump_stop: {bodies: [arm, ground], from: p, to: t, rate: 5}",
     "11: springs.coil.bump_stop: the element name 'coil.bump_stop' is reserved for its stop, but "
     "already in use; rename the other element"},
    // ---- torsion springs
    {"TorsionSpringWithoutLaw", torsion("axis: x"),
     "11: torsion_springs.bar: no law; required: rate or curve"},
    {"TorsionSpringOfTwoLaws", torsion("axis: x, rate: 5, curve: {" + table + "}"),
     "11: torsion_springs.bar.curve: given together with rate; " + one_of_two},
    {"TorsionSpringWithoutAxis", torsion("rate: 5"),
     "11: torsion_springs.bar.axis: missing; this field is required"},
    {"TorsionSpringWithoutPoint",
     "torsion_springs:\n  bar: {bodies: [arm, ground], axis: x, rate: 5}",
     "11: torsion_springs.bar.at: missing; this field is required"},
    {"TorsionSpringOfNegativeRate", torsion("axis: x, rate: -5"),
     "11: torsion_springs.bar.rate: negative rate '-5'; allowed: zero or more"},
    {"PreloadMomentOfThree", torsion("axis: x, rate: 5, preload_moment: [1, 2, 3]"),
     "11: torsion_springs.bar.preload_moment: expected a number, found a list of 3"},
    {"UnknownFieldOfTorsionSpring", torsion("axis: x, rate: 5, preload: 1"),
     "11: torsion_springs.bar: unknown field 'preload'; allowed: bodies, at, axis, rate, curve, "
     "preload_moment"},
    // ---- bushings
    {"StiffnessAndCurves", bushing("curves: {x: {" + table + "}}, stiffness: [[0]]"),
     "11: bushings.mount.curves: given together with stiffness; allowed: curves, with or without "
     "rates, or "
     "stiffness"},
    {"NoCurves", bushing("curves: {}"),
     "11: bushings.mount.curves: empty; a curve for at least one axis is needed"},
    {"CurveOfNoAxis", bushing("curves: {w: {" + table + "}}"),
     "11: bushings.mount.curves: unknown field 'w'; allowed: x, y, z, rx, ry, rz"},
    {"UndeformedOfOne", bushing("rates: [1, 1, 1], undeformed: 1"),
     "11: bushings.mount.undeformed: expected a list of 3 numbers, found '1'"},
    {"UndeformedAnglesOfTwo", bushing("rates: [1, 1, 1], undeformed_angles: [1, 2]"),
     "11: bushings.mount.undeformed_angles: expected a list of 3 numbers, found a list of 2"},
    {"FormulationIsAWord", bushing("rates: [1, 1, 1], formulation: cardan"),
     "11: bushings.mount.formulation: expected a map with the fields frame, angles, conjugate, "
     "offset_moment, found "
     "'cardan'"},
    {"FrameOnK", bushing("rates: [1, 1, 1], formulation: {frame: k}"),
     "11: bushings.mount.formulation.frame: 'k' is not a frame; allowed: i, j, middle"},
    {"UnknownAngles", bushing("rates: [1, 1, 1], formulation: {angles: euler}"),
     "11: bushings.mount.formulation.angles: 'euler' is not a definition of the angles; allowed: "
     "rotation_vector, cardan, projected"},
    {"ConjugatePerhaps", bushing("rates: [1, 1, 1], formulation: {conjugate: maybe}"),
     "11: bushings.mount.formulation.conjugate: 'maybe' is not yes or no; allowed: true, false"},
    {"NotConjugateInTheMiddle",
     bushing("rates: [1, 1, 1], formulation: {frame: middle, conjugate: false}"),
     "11: bushings.mount.formulation.conjugate: false is not defined with the frame in the middle; "
     "allowed there: true"},
    {"OneAxisForACurveAcrossIt",
     bushing("frame: {z: z}, curves: {x: {table: [[0, 0], [1, 1]]}, y: {table: [[0, 0], [1, 1]]}}"),
     one_axis + "a curve across it is not axisymmetric" + second},
    {"OneAxisForARotationalCurveAcrossIt", bushing("frame: {z: z}, curves: {ry: {" + table + "}}"),
     one_axis + "a curve across it is not axisymmetric" + second},
    {"OneAxisForUnequalRatesBesideACurve",
     bushing("frame: {z: z}, rates: [1, 2, 0], curves: {z: {" + table + "}}"),
     one_axis + "the rates or the preload across it are not axisymmetric" + second},
    {"OneAxisForAnOffsetAcrossIt",
     bushing("frame: {z: z}, rates: [1, 1, 2], undeformed: [1, 0, 0]"),
     one_axis + "the undeformed position is not on it" + second},
    {"OneAxisForCardanAngles",
     bushing("frame: {z: z}, rates: [1, 1, 2], formulation: {angles: cardan}"),
     one_axis + "cardan and projected angles need all three" + second},
    // ---- loads
    {"FollowsABody", "static_loads:\n  drag: {on: arm, at: p, force: [1, 2, 3], follows: arm}",
     "11: static_loads.drag.follows: 'arm' is not yes or no; allowed: true, false"},
};

class WrongLaw : public testing::TestWithParam<Mistake> {};

TEST_P(WrongLaw, IsRefusedWithItsPlaceAndWhatIsAllowed) {
    try {
        laws(GetParam().elements);
        FAIL() << "was accepted";
    } catch (const SceneError& error) {
        EXPECT_EQ(error.what(), "laws.yaml:" + GetParam().message);
    }
}

INSTANTIATE_TEST_SUITE_P(SceneReader, WrongLaw, testing::ValuesIn(mistakes),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(LawsScene, IsSoundWithoutAMistake) { EXPECT_NO_THROW(laws("")); }

TEST(WrongSetting, OfATableSaysSo) {
    const Setting falling{"springs.coil.curve.table.2.2", "-950"};
    try {
        parse_scene(laws_scene(curve(table)), "laws.yaml", {&falling, 1});
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_STREQ(error.what(),
                     "laws.yaml:11: springs.coil.curve.table: row 2: force '-950' is smaller than "
                     "that of the row before; it must not decrease (as set)");
    }
}

TEST(WrongDrive, OfWhatCannotBeDrivenSaysWhy) {
    const std::tuple<std::string, const char*, std::string> cases[] = {
        {curve(table), "springs.coil.preload",
         "'springs.coil.preload' is the preload of a spring with a curve, which is not "
         "proportional to a length; allowed: its free_length"},
        {bump("clearance: 5, rate: 5"), "springs.coil.bump_stop.free_length",
         "'springs.coil.bump_stop.free_length' cannot be driven, did you mean "
         "'springs.coil.free_length'? allowed: springs.coil.free_length, springs.coil.preload"},
        {torsion("axis: x, rate: 5"), "torsion_springs.bar.preload_moment.z",
         "'torsion_springs.bar.preload_moment.z' cannot be driven, did you mean "
         "'torsion_springs.bar.preload_moment'? allowed: torsion_springs.bar.preload_moment"},
    };
    for (const auto& [elements, drive, message] : cases) {
        const std::string text = laws_scene(elements, "length: mm, angle: deg, force: N",
                                            std::string("drive: ") + drive + ", to: 10, steps: 1");
        try {
            parse_scene(text, "laws.yaml");
            ADD_FAILURE() << drive;
        } catch (const SceneError& error) {
            EXPECT_EQ(error.what(), "laws.yaml:13: branches.up.drive: " + message);
        }
    }
}

// The twin of a stop is also a named element.
TEST(WrongMirror, MakesNoTwoElementsOfOneName) {
    const std::string text =
        "elastocheck: 1\nname: axle\nunits: {length: mm, angle: deg, force: N}\nmirror: left -> "
        "right\n"
        "points: {o: [0, 0, 0], p_left: [0, 600, 0], t_left: [0, 600, 400]}\nbodies: {arm: "
        "{origin: o}}\n"
        "joints: {ball: {type: spherical, bodies: [arm, ground], at: o}}\n"
        "stops:\n"
        "  a_left: {bodies: [arm, ground], from: p_left, to: t_left, bump: {clearance: 5, rate: "
        "5}}\n"
        "springs:\n"
        "  a_right.bump: {bodies: [arm, ground], from: p_left, to: p_right, rate: 5}\n"
        "loads: {push: {on: arm, at: p_left, force: [0, 0, 1]}}\n"
        "branches: {up: {load: push, to: 10, steps: 1}}\n"
        "probes: {tip: {on: arm, at: o}}\n";
    try {
        parse_scene(text, "axle.yaml");
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_STREQ(error.what(),
                     "axle.yaml:9: stops.a_left.bump: the element name 'a_right.bump' is reserved "
                     "for its stop, but already in use; rename the other element");
    }
}

}  // namespace
}  // namespace elastocheck
