// Exact messages of the scene reader: one change to a valid scene, one message.
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "elastocheck/read_scene.hpp"
#include "tests/models/bench_scene.hpp"

namespace elastocheck {
namespace {

const char* const whole_text = nullptr;

struct Mistake {
    const char* name;
    const char* right;    // occurs once in the bench scene; or whole_text
    std::string wrong;    // its replacement
    std::string message;  // after "bench.yaml:"
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

std::string repeated(const std::string& text, int times) {
    std::string result;
    for (int n = 0; n < times; ++n) result += text;
    return result;
}

const std::string sections =
    "elastocheck, name, units, mirror, gravity, points, bodies, joints, springs, stops, "
    "torsion_springs, "
    "bushings, "
    "beams, tyres, static_loads, loads, trim, branches, wheel, wheels, probes, dampers, vehicle";
const std::string joint_types =
    "spherical, revolute, universal, cylindrical, translational, planar, fixed, distance, "
    "in_plane, in_line, perpendicular, parallel";
const std::string joint_fields =
    "type, bodies, at, axis, held, axis_i, axis_j, normal, from, to, length";
const std::string no_name =
    " cannot be a name; allowed: up to 64 letters, digits, _ and, not first, - + . and spaces";
const std::string out_of_range = " is out of range; allowed: 0, or 1e-30 to 1e+30 in size";
const std::string directions = "x, y, z, -x, -y, -z, [x, y, z] or two hardpoints [from, to]";
const std::string hardpoints = "again, front, middle, side, top";
const std::string one_axis =
    "one axis is not enough, because the rates or the preload across it are not axisymmetric; give "
    "a second one";
const std::string steps = "expected a whole number from 1 to 1000000, found ";
const std::string plain_text = "; a scene is plain text";
const std::string no_aliases = "aliases (*name) are not part of the scene format; repeat the value";
const std::string one_document = "; a scene is a single YAML document";
const std::string semidefinite =
    " when scaled to a unit diagonal; a stiffness must be positive semidefinite";
const std::string on_ground = " cannot be on ground, which is fixed; allowed: a body";
const std::string missing = ": missing; this field is required";
const std::string empty = "empty; a scene begins with `elastocheck: 1`";
const std::string together =
    "given together with rates; allowed: stiffness, or rates and/or rotational_rates";

const std::vector<Mistake> mistakes{
    // ---- the text
    {"EmptyText", whole_text, "", "1: " + empty},
    {"OnlyComments", whole_text, "# nothing here\n\n# nor here\n", "1: " + empty},
    {"OnlyADocumentMark", whole_text, "---\n", "2: " + empty},
    {"ListInsteadOfMap", whole_text, "[elastocheck, 1]\n",
     "1: expected a map with the fields " + sections + ", found a list of 2"},
    {"TextInsteadOfMap", whole_text, "elastocheck 1\n",
     "1: expected a map with the fields " + sections + ", found 'elastocheck 1'"},
    {"FlowListNotClosed", "  middle: [0, 0, 0]", "  middle: [0, 0, 0",
     "7: invalid YAML: end of sequence flow not found"},
    {"QuoteNotClosed", "name: Bench", "name: \"Bench",
     "2: name: 'Bench units: {length: mm, angle: deg, force: N}?points: middle: ...' is not "
     "one line of plain text"},
    {"WrongIndentation", "  arm: {origin: middle}", " arm: {origin: middle}",
     "14: invalid YAML: end of map not found"},
    {"TabAsIndentation", "  arm: {origin: middle}", "\tarm: {origin: middle}",
     "13: invalid YAML: illegal map value"},
    {"SecondDocument",
     "probes:", "---\nprobes:", "49: text after the end of the scene" + one_document},
    {"TextAfterTheEnd",
     "probes:", "...\nprobes:", "50: text after the end of the scene" + one_document},
    {"UnknownAlias", "bodies: [arm, hub], at: front, axis_i", "bodies: *pair, at: front, axis_i",
     "18: invalid YAML: the referenced anchor is not defined"},
    {"Alias",
     "  ball: {type: spherical, bodies: [arm, hub], at: front}\n  cross: {type: universal, "
     "bodies: [arm, hub]",
     "  ball: {type: spherical, bodies: &pair [arm, hub], at: front}\n  cross: {type: "
     "universal, bodies: *pair",
     "18: joints.cross.bodies: " + no_aliases},
    {"CyclicAlias", "[push, twist]", "&loop [push, *loop]", "46: branches.up.load: " + no_aliases},
    {"Tag", "to: 1000", "to: !!float 1000",
     "46: branches.up.to: tags ('tag:yaml.org,2002:float') are not part of the scene format"},
    {"TagOfAList", "load: [push, twist]", "load: !set [push, twist]",
     "46: branches.up.load: tags ('!set') are not part of the scene format"},
    {"DeepNesting", "to: 1000", "to: [[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]",
     "46: branches.up.to: nested more than 16 levels deep"},
    {"VeryDeepNesting", whole_text, repeated("- ", 100000), "1: nested more than 16 levels deep"},
    {"ControlCharacter", "name: Bench", "name: Ben\004ch",
     "2: control character 0x04" + plain_text},
    {"NotUtf8", "name: Bench", "name: Ben\377ch", "2: byte 0xff is not UTF-8" + plain_text},
    {"NotUtf8Overlong", "name: Bench", "name: Ben\300\257ch",
     "2: byte 0xc0 is not UTF-8" + plain_text},
    {"TooLarge", whole_text, repeated("#", 1048577), " larger than 1 MiB, the limit for a scene"},
    {"ListAsKey", "  arm: {origin: middle}", "  [arm, hub]: {origin: middle}",
     "13: bodies: a list or map where the name of a field is expected"},
    {"NothingAsKey", "  arm: {origin: middle}", "  : {origin: middle}",
     "13: bodies: the name of a field is missing before ':'"},
    {"DuplicateSection", "probes:\n", "points:\n", "49: 'points' is given twice, first on line 5"},
    {"DuplicateName", "  hub: {origin: front}", "  arm: {origin: front}",
     "14: bodies: 'arm' is given twice, first on line 13"},
    {"DuplicateField", "to: 1000,", "to: 1000, to: 2000,",
     "46: branches.up: 'to' is given twice, first on line 46"},
    // ---- the top level
    {"NoVersion", "elastocheck: 1\n", "", "1: elastocheck" + missing},
    {"WrongVersion", "elastocheck: 1\n", "elastocheck: 2\n",
     "1: elastocheck: '2' is not a supported version of the format; allowed: 1"},
    {"VersionIsAList", "elastocheck: 1\n", "elastocheck: [1]\n",
     "1: elastocheck: expected the version of the format, found a list of 1"},
    {"UnknownSection", "bushings:", "bushing:",
     "24: unknown field 'bushing', did you mean 'bushings'? allowed: " + sections},
    {"UnknownSectionUnlikeAny",
     "bushings:", "rubber:", "24: unknown field 'rubber'; allowed: " + sections},
    {"NoName", "name: Bench\n", "", "1: name" + missing},
    {"EmptyName", "name: Bench", "name:", "2: name: expected the name of the scene, found nothing"},
    {"QuotedEmptyName", "name: Bench", "name: ''",
     "2: name: expected the name of the scene, found ''"},
    {"NameWithControlCharacter", "name: Bench", "name: \"Ben\\nch\"",
     "2: name: 'Ben?ch' is not one line of plain text"},
    {"NoUnits", "units: {length: mm, angle: deg, force: N}\n", "", "1: units" + missing},
    {"UnitsAreNotAMap", "{length: mm, angle: deg, force: N}", "mm",
     "3: units: expected a map with the fields length, angle, force, moment, found 'mm'"},
    {"UnitsAreEmpty", "units: {length: mm, angle: deg, force: N}", "units:",
     "3: units: expected a map with the fields length, angle, force, moment, found nothing"},
    {"NoAngleUnit", "angle: deg, ", "", "3: units.angle" + missing},
    {"WrongLengthUnit", "length: mm", "length: cm",
     "3: units.length: 'cm' is not a unit of length; allowed: m, mm"},
    {"WrongAngleUnit", "angle: deg", "angle: degree",
     "3: units.angle: 'degree' is not a unit of angle; allowed: deg, rad"},
    {"WrongForceUnit", "force: N}", "force: lbf}",
     "3: units.force: 'lbf' is not a unit of force; allowed: N, kN"},
    {"WrongMomentUnit", "force: N}", "force: N, moment: Nmmm}",
     "3: units.moment: 'Nmmm' is not a unit of moment, did you mean 'N*mm'? allowed: N·m, N*m, Nm, "
     "N·mm, "
     "N*mm, Nmm, "
     "kN·m, kN*m, kNm, kN·mm, kN*mm, kNmm"},
    {"UnknownUnit", "force: N}", "force: N, time: s}",
     "3: units: unknown field 'time'; allowed: length, angle, force, moment"},
    // ---- names
    {"NameBeginsWithADash", "  tip:", "  -tip:", "50: probes: '-tip'" + no_name},
    {"NameWithASlash", "  tip:", "  a/tip:", "50: probes: 'a/tip'" + no_name},
    {"NameTooLong",
     "  tip:", "  ttttttttttttttttttttttttttttttttttttttttttttttttttttttttttttttttt:",
     "50: probes: 'tttttttttttttttttttttttttttttttttttttttttttttttttttttttttttttttt...'" + no_name},
    {"EmptyKey", "  tip:", "  '':", "50: probes: ''" + no_name},
    // ---- points and numbers
    {"NoPoints",
     "points:\n  middle: [0, 0, 0]\n  front: [100, 0, 0]\n  side: [0, 100, 0]\n  top: [0, 0, 100]\n"
     "  again: [0, 0, 0]\n",
     "", "1: points" + missing},
    {"PointsAreEmpty",
     "\n  middle: [0, 0, 0]\n  front: [100, 0, 0]\n  side: [0, 100, 0]\n  top: [0, 0, 100]\n  "
     "again: [0, 0, 0]\n",
     "\n", "5: points: empty; at least one hardpoint is needed"},
    {"PointsAreAList",
     "points:\n  middle: [0, 0, 0]\n  front: [100, 0, 0]\n  side: [0, 100, 0]\n  top: [0, 0, 100]\n"
     "  again: [0, 0, 0]\n",
     "points: [1, 2]\n", "5: points: expected a map of names, found a list of 2"},
    {"PointOfTwoNumbers", "top: [0, 0, 100]", "top: [0, 0]",
     "9: points.top: expected a list of 3 numbers, found a list of 2"},
    {"PointIsANumber", "top: [0, 0, 100]", "top: 100",
     "9: points.top: expected a list of 3 numbers, found '100'"},
    {"DecimalComma", "top: [0, 0, 100]", "top: [0, 0, '1,5']",
     "9: points.top: expected a number, found '1,5'"},
    {"WordForNumber", "top: [0, 0, 100]", "top: [0, 0, abc]",
     "9: points.top: expected a number, found 'abc'"},
    {"NothingForNumber", "top: [0, 0, 100]", "top: [0, 0, ~]",
     "9: points.top: expected a number, found nothing"},
    {"ListForNumber", "top: [0, 0, 100]", "top: [0, 0, [1]]",
     "9: points.top: expected a number, found a list of 1"},
    {"NotANumber", "top: [0, 0, 100]", "top: [0, 0, nan]",
     "9: points.top: expected a number, found 'nan'"},
    {"YamlNotANumber", "top: [0, 0, 100]", "top: [0, 0, .nan]",
     "9: points.top: expected a number, found '.nan'"},
    {"Infinite", "top: [0, 0, 100]", "top: [0, 0, -inf]", "9: points.top: '-inf'" + out_of_range},
    {"Overflow", "top: [0, 0, 100]", "top: [0, 0, 1e999]", "9: points.top: '1e999'" + out_of_range},
    {"Underflow", "top: [0, 0, 100]", "top: [0, 0, 1e-999]",
     "9: points.top: '1e-999'" + out_of_range},
    {"TooLargeANumber", "top: [0, 0, 100]", "top: [0, 0, 1.1e30]",
     "9: points.top: '1.1e30'" + out_of_range},
    {"TooSmallANumber", "top: [0, 0, 100]", "top: [0, 0, -9e-31]",
     "9: points.top: '-9e-31'" + out_of_range},
    {"TrailingUnit", "top: [0, 0, 100]", "top: [0, 0, 100mm]",
     "9: points.top: expected a number, found '100mm'"},
    {"TwoSigns", "top: [0, 0, 100]", "top: [0, 0, +-1]",
     "9: points.top: expected a number, found '+-1'"},
    {"Hexadecimal", "top: [0, 0, 100]", "top: [0, 0, 0x10]",
     "9: points.top: expected a number, found '0x10'"},
    // ---- bodies
    {"NoBodies", "bodies:\n  arm: {origin: middle}\n  hub: {origin: front}\n", "",
     "1: bodies" + missing},
    {"BodiesAreEmpty", "\n  arm: {origin: middle}\n  hub: {origin: front}\n", "\n",
     "12: bodies: empty; at least one body is needed"},
    {"BodyNamedGround", "  arm: {origin", "  ground: {origin",
     "13: bodies.ground: ground is predefined and cannot be defined again; choose another name"},
    {"BodyIsNotAMap", "arm: {origin: middle}", "arm: middle",
     "13: bodies.arm: expected a map with the fields origin, mass, centre_of_gravity, found "
     "'middle'"},
    {"BodyWithoutOrigin", "arm: {origin: middle}", "arm: {}", "13: bodies.arm.origin" + missing},
    {"UnknownFieldOfBody", "arm: {origin: middle}", "arm: {orgin: middle}",
     "13: bodies.arm: unknown field 'orgin', did you mean 'origin'? allowed: origin, mass, "
     "centre_of_gravity"},
    {"UnknownHardpoint", "arm: {origin: middle}", "arm: {origin: midle}",
     "13: bodies.arm.origin: there is no hardpoint called 'midle', did you mean 'middle'? "
     "defined: " +
         hardpoints},
    {"HardpointIsAList", "arm: {origin: middle}", "arm: {origin: [0, 0, 0]}",
     "13: bodies.arm.origin: expected the name of a hardpoint, found a list of 3"},
    {"BodyThatNothingHolds", "  hub: {origin: front}",
     "  hub: {origin: front}\n  spare: {origin: top}",
     "15: bodies.spare: no joint or element is attached to it; a joint, spring or bushing is "
     "needed"},
    // ---- joints
    {"JointsAreAList",
     "joints:\n  ball: {type: spherical, bodies: [arm, hub], at: front}\n  cross: {type: "
     "universal, bodies: [arm, hub], at: front, axis_i: x, axis_j: y}\n  rod: {type: distance, "
     "bodies: [hub, ground], from: front, to: side}\n",
     "joints: [ball]\n", "16: joints: expected a map of names, found a list of 1"},
    {"JointIsNotAMap", "ball: {type: spherical, bodies: [arm, hub], at: front}", "ball: spherical",
     "17: joints.ball: expected a map with the fields " + joint_fields + ", found 'spherical'"},
    {"NoJointType", "{type: spherical, ", "{", "17: joints.ball.type" + missing},
    {"UnknownJointType", "spherical", "sperical",
     "17: joints.ball.type: 'sperical' is not a joint type, did you mean 'spherical'? "
     "allowed: " +
         joint_types},
    {"MisspeltType", "{type: spherical", "{tpye: spherical",
     "17: joints.ball: unknown field 'tpye', did you mean 'type'? allowed: " + joint_fields},
    {"FieldOfAnotherJointType", "type: spherical, bodies: [arm, hub], at: front",
     "type: spherical, bodies: [arm, hub], at: front, axis: x",
     "17: joints.ball: unknown field 'axis'; allowed: type, bodies, at"},
    {"JointWithoutBodies", "type: spherical, bodies: [arm, hub], ", "type: spherical, ",
     "17: joints.ball.bodies" + missing},
    {"JointOfThreeBodies", "type: spherical, bodies: [arm, hub]",
     "type: spherical, bodies: [arm, hub, ground]",
     "17: joints.ball.bodies: expected a list of 2 bodies, found a list of 3"},
    {"JointOfOneBody", "type: spherical, bodies: [arm, hub]", "type: spherical, bodies: arm",
     "17: joints.ball.bodies: expected a list of 2 bodies, found 'arm'"},
    {"UnknownBody", "type: spherical, bodies: [arm, hub]", "type: spherical, bodies: [arn, hub]",
     "17: joints.ball.bodies: there is no body called 'arn', did you mean 'arm'? defined: arm, "
     "ground, hub"},
    {"JointBetweenABodyAndItself", "type: spherical, bodies: [arm, hub]",
     "type: spherical, bodies: [arm, arm]",
     "17: joints.ball.bodies: both bodies are 'arm'; two different bodies are needed"},
    {"JointBetweenGroundAndItself", "type: spherical, bodies: [arm, hub]",
     "type: spherical, bodies: [ground, ground]",
     "17: joints.ball.bodies: both bodies are 'ground'; two different bodies are needed"},
    {"JointWithoutPoint", "type: spherical, bodies: [arm, hub], at: front",
     "type: spherical, bodies: [arm, hub]", "17: joints.ball.at" + missing},
    {"AxesNotPerpendicular", "axis_j: y}", "axis_j: [1, 1, 0]}",
     "18: joints.cross.axis_j: 45 deg from axis_i; the two axes must be perpendicular"},
    {"AxesAlmostPerpendicular", "axis_j: y}", "axis_j: [2e-9, 1, 0]}",
     "18: joints.cross.axis_j: 89.99999989 deg from axis_i; the two axes must be perpendicular"},
    {"DistanceOfNoLength", "from: front, to: side", "from: front, to: front",
     "19: joints.rod.to: the same position as `from`; a distance joint needs a length"},
    {"DistanceBetweenPointsAtOnePlace", "from: front, to: side", "from: middle, to: again",
     "19: joints.rod.to: the same position as `from`; a distance joint needs a length"},
    {"AxisIsAWord", "axis_j: y}", "axis_j: w}",
     "18: joints.cross.axis_j: 'w' is not a direction; allowed: " + directions},
    {"AxisIsAMap", "axis_j: y}", "axis_j: {y: 1}}",
     "18: joints.cross.axis_j: expected a direction (" + directions + "), found a map"},
    {"AxisOfFourNumbers", "axis_j: y}", "axis_j: [0, 1, 0, 0]}",
     "18: joints.cross.axis_j: expected a direction (" + directions + "), found a list of 4"},
    {"AxisOfNoLength", "axis_j: y}", "axis_j: [0, 0, 0]}",
     "18: joints.cross.axis_j: the vector has length zero; a direction needs a length"},
    {"AxisBetweenCoincidentPoints", "axis_j: y}", "axis_j: [middle, again]}",
     "18: joints.cross.axis_j: the two hardpoints coincide; a direction needs two different "
     "ones"},
    {"AxisToUnknownPoint", "axis_j: y}", "axis_j: [middle, sied]}",
     "18: joints.cross.axis_j: there is no hardpoint called 'sied', did you mean 'side'? "
     "defined: " +
         hardpoints},
    // ---- springs
    {"UnknownFieldOfSpring", "rate: 30, preload", "rates: 30, preload",
     "22: springs.coil: unknown field 'rates', did you mean 'rate'? allowed: bodies, from, "
     "to, rate, curve, free_length, preload, bump_stop, rebound_stop"},
    {"SpringWithoutRate", "rate: 30, preload", "preload",
     "22: springs.coil: no law; required: rate or curve"},
    {"NegativeRate", "rate: 30,", "rate: -30,",
     "22: springs.coil.rate: negative rate '-30'; allowed: zero or more"},
    {"SpringOfNoLength", "from: front, to: top, rate", "from: front, to: front, rate",
     "22: springs.coil.to: the same position as `from`; a spring needs a length"},
    {"FreeLengthAndPreload", "preload: 300", "preload: 300, free_length: 150",
     "22: springs.coil.preload: given together with free_length; allowed: one of the two"},
    {"FreeLengthOfZero", "preload: 300", "free_length: 0",
     "22: springs.coil.free_length: '0' is not a length; allowed: above zero"},
    {"FreeLengthBelowZero", "preload: 300", "free_length: -150",
     "22: springs.coil.free_length: '-150' is not a length; allowed: above zero"},
    {"PreloadOfASpringWithoutRate", "rate: 30, preload: 300", "rate: 0, preload: 300",
     "22: springs.coil.preload: a spring of rate zero cannot have a preload; remove it or give a "
     "rate"},
    {"TensionBeyondTheSpring", "preload: 300", "preload: -4500",
     "22: springs.coil.preload: needs a free length of -8.57864 mm; a free length must be "
     "above zero"},
    // ---- bushings
    {"UnknownFieldOfBushing", "rates: [1, 2, 2], rot", "rate: [1, 2, 2], rot",
     "25: bushings.mount: unknown field 'rate', did you mean 'rates'? allowed: bodies, at, "
     "frame, frame_j, rates, rotational_rates, stiffness, curves, preload, preload_moment, "
     "undeformed, "
     "undeformed_angles, formulation"},
    {"NoStiffness", ", rates: [1, 2, 2], rotational_rates: [3, 4, 4]", "",
     "25: bushings.mount: no stiffness; allowed: rates, rotational_rates and/or curves, or "
     "stiffness"},
    {"RatesAndStiffness",
     "    at: middle\n    stiffness:", "    at: middle\n    rates: [1, 1, 1]\n    stiffness:",
     "30: bushings.block.stiffness: " + together},
    {"RotationalRatesAndStiffness", "    at: middle\n    stiffness:",
     "    at: middle\n    rotational_rates: [1, 1, 1]\n    stiffness:",
     "30: bushings.block.stiffness: " + together},
    {"TwoRates", "rates: [1, 2, 2], rot", "rates: [1, 2], rot",
     "25: bushings.mount.rates: expected a list of 3 rates, found a list of 2"},
    {"OneRate", "rates: [1, 2, 2], rot", "rates: 2, rot",
     "25: bushings.mount.rates: expected a list of 3 rates, or the name of a property file (.bus), "
     "found "
     "'2'"},
    {"NegativeRateOfBushing", "rates: [1, 2, 2], rot", "rates: [1, 2, -2], rot",
     "25: bushings.mount.rates: negative rate '-2'; allowed: zero or more"},
    {"NegativeRotationalRate", "rotational_rates: [3, 4, 4]", "rotational_rates: [-3, 4, 4]",
     "25: bushings.mount.rotational_rates: negative rate '-3'; allowed: zero or more"},
    {"StiffnessOfFiveRows", "      - [0, 0, 0, 0, 0, 50]\n", "",
     "29: bushings.block.stiffness: expected a list of 6 rows, found a list of 5"},
    {"StiffnessWithAShortRow", "      - [0, 0, 0, 50, 0, 0]", "      - [0, 0, 0, 50, 0]",
     "33: bushings.block.stiffness: expected a list of 6 numbers (row 4), found a list of 5"},
    {"StiffnessNotSymmetric", "      - [5, 0, 0, 0, 50, 0]", "      - [5.00001, 0, 0, 0, 50, 0]",
     "29: bushings.block.stiffness: not symmetric: row 1, column 5 is 5, row 5, column 1 is "
     "5.00001"},
    {"StiffnessIndefinite", "- [100, 0, 0, 0, 5, 0]\n      - [0, 100, 0, 0, 0, 0]",
     "- [100, 200, 0, 0, 5, 0]\n      - [200, 100, 0, 0, 0, 0]",
     "29: bushings.block.stiffness: indefinite, its lowest eigenvalue is -1.07038" + semidefinite},
    {"StiffnessWithANegativeDiagonal", "      - [0, 0, 0, 0, 0, 50]",
     "      - [0, 0, 0, 0, 0, -50]",
     "29: bushings.block.stiffness: indefinite, its lowest eigenvalue is -1" + semidefinite},
    {"StiffnessCouplingAFreeDirection", "      - [100, 0, 0, 0, 5, 0]",
     "      - [0, 0, 0, 0, 5, 0]",
     "29: bushings.block.stiffness: indefinite, its lowest eigenvalue is -0.618034" + semidefinite},
    {"StiffnessCouplingAFreeDirectionToAStiffOne",
     "      - [100, 0, 0, 0, 5, 0]\n      - [0, 100, 0, 0, 0, 0]\n      - [0, 0, 100, 0, 0, 0]\n "
     "     - [0, 0, 0, 50, 0, 0]\n      - [5, 0, 0, 0, 50, 0]",
     "      - [0, 0, 0, 0, 5, 0]\n      - [0, 100, 0, 0, 0, 0]\n      - [0, 0, 100, 0, 0, 0]\n   "
     "   - [0, 0, 0, 50, 0, 0]\n      - [5, 0, 0, 0, 1e20, 0]",
     "29: bushings.block.stiffness: indefinite, its lowest eigenvalue is -0.618034" + semidefinite},
    {"FrameWithoutAxis", "frame: {x: [middle, front]}", "frame: {}",
     "25: bushings.mount.frame: 0 axes given; allowed: one or two"},
    {"FrameOfThreeAxes", "frame: {x: [middle, front]}", "frame: {x: x, y: y, z: z}",
     "25: bushings.mount.frame: 3 axes given; allowed: one or two"},
    {"FrameIsADirection", "frame: {x: [middle, front]}", "frame: x",
     "25: bushings.mount.frame: expected a map with the fields x, y, z, found 'x'"},
    {"FrameWithUnknownAxis", "frame: {x: [middle, front]}", "frame: {w: x}",
     "25: bushings.mount.frame: unknown field 'w'; allowed: x, y, z"},
    {"FrameAxesParallel", "frame: {x: [middle, front]}", "frame: {x: [middle, front], y: -x}",
     "25: bushings.mount.frame: axes x and y are parallel; two different directions are needed"},
    {"FrameOfOneAxisForUnequalRates", "rates: [1, 2, 2], rot", "rates: [1, 2, 3], rot",
     "25: bushings.mount.frame: " + one_axis},
    {"FrameOfOneAxisForUnequalRotationalRates", "rotational_rates: [3, 4, 4]",
     "rotational_rates: [3, 4, 5]", "25: bushings.mount.frame: " + one_axis},
    {"FrameOfOneAxisForAPreloadAcrossIt", "rotational_rates: [3, 4, 4]",
     "rotational_rates: [3, 4, 4], preload: [0, 1, 0]", "25: bushings.mount.frame: " + one_axis},
    {"FrameOfOneAxisForACoupling", "    stiffness:", "    frame: {z: z}\n    stiffness:",
     "29: bushings.block.frame: " + one_axis},
    {"PreloadOfOneNumber", "rotational_rates: [3, 4, 4]",
     "rotational_rates: [3, 4, 4], preload: 10",
     "25: bushings.mount.preload: expected a list of 3 numbers, found '10'"},
    {"PreloadMomentOfOneNumber", "rotational_rates: [3, 4, 4]",
     "rotational_rates: [3, 4, 4], preload_moment: 10",
     "25: bushings.mount.preload_moment: expected a list of 3 numbers, found '10'"},
    // ---- loads
    {"NoLoads",
     "loads:\n  push: {on: hub, at: front, force: [0, 0, 1]}\n  twist: {on: hub, moment: [0, 0, "
     "1]}\n  nil: {on: hub, at: front, force: [0, 0, 0]}\n",
     "", "42: branches.up.load: there is no load called 'push'; the scene has no loads"},
    {"LoadOnGround", "weight: {on: hub", "weight: {on: ground",
     "38: static_loads.weight.on: a load" + on_ground},
    {"LoadOnUnknownBody", "weight: {on: hub", "weight: {on: hup",
     "38: static_loads.weight.on: there is no body called 'hup', did you mean 'hub'? defined: arm, "
     "ground, hub"},
    {"LoadWithoutBody", "weight: {on: hub, ", "weight: {", "38: static_loads.weight.on" + missing},
    {"ForceWithoutPoint", "weight: {on: hub, at: front, ", "weight: {on: hub, ",
     "38: static_loads.weight.at" + missing},
    {"ForceAndMoment", "twist: {on: hub, ", "twist: {on: hub, at: front, force: [0, 0, 1], ",
     "42: loads.twist.moment: given together with force; allowed: one of the two"},
    {"NeitherForceNorMoment", "twist: {on: hub, moment: [0, 0, 1]}", "twist: {on: hub}",
     "42: loads.twist: no load; required: force with at, or moment"},
    {"MomentWithPoint", "twist: {on: hub, ", "twist: {on: hub, at: front, ",
     "42: loads.twist.at: a moment has no point of application; remove this field"},
    {"UnknownFieldOfLoad", "twist: {on: hub, moment", "twist: {on: hub, momnet",
     "42: loads.twist: unknown field 'momnet', did you mean 'moment'? allowed: on, at, force, "
     "moment, follows"},
    // ---- branches
    {"NoBranches", "branches:\n  up: {load: [push, twist], to: 1000, steps: 10}\n", "",
     "1: branches" + missing},
    {"BranchesAreEmpty", "branches:\n  up: {load: [push, twist], to: 1000, steps: 10}\n",
     "branches:\n", "45: branches: empty; at least one branch is needed"},
    {"BranchWithoutLoad", "load: [push, twist], ", "",
     "46: branches.up: the branch drives nothing; required: load or drive"},
    {"BranchOfNoLoads", "load: [push, twist]", "load: []",
     "46: branches.up.load: empty; a load is needed"},
    {"UnknownLoad", "load: [push, twist]", "load: [psuh, twist]",
     "46: branches.up.load: there is no load called 'psuh', did you mean 'push'? defined: nil, "
     "push, twist"},
    {"LoadWithoutWeight", "load: [push, twist]", "load: {push: , twist: 1}",
     "46: branches.up.load.push: expected a number, found nothing"},
    {"LoadOfZeroWeight", "load: [push, twist]", "load: {push: 0.0, twist: 1}",
     "46: branches.up.load.push: zero, which loads nothing; remove it"},
    {"UnknownLoadWithWeight", "load: [push, twist]", "load: {push: 1, twits: 1}",
     "46: branches.up.load.twits: there is no load called 'twits', did you mean 'twist'? defined: "
     "nil, push, twist"},
    {"LoadListedTwice", "load: [push, twist]", "load: [push, push]",
     "46: branches.up.load: 'push' is listed twice"},
    {"BranchOfZeroLoad", "load: [push, twist]", "load: nil",
     "46: branches.up.load: zero in every component; a branch needs a nonzero load"},
    {"BranchWithoutEnd", "to: 1000, ", "", "46: branches.up.to" + missing},
    {"BranchToZero", "to: 1000", "to: 0.0",
     "46: branches.up.to: zero: the branch would have no length; allowed: any other value"},
    {"BranchToNowhere", "to: 1000", "to: far",
     "46: branches.up.to: expected a number, found 'far'"},
    {"BranchWithoutSteps", ", steps: 10", "", "46: branches.up.steps" + missing},
    {"NoSteps", "steps: 10", "steps: 0", "46: branches.up.steps: " + steps + "'0'"},
    {"NegativeSteps", "steps: 10", "steps: -5", "46: branches.up.steps: " + steps + "'-5'"},
    {"HalfAStep", "steps: 10", "steps: 2.5", "46: branches.up.steps: " + steps + "'2.5'"},
    {"TooManySteps", "steps: 10", "steps: 1000001",
     "46: branches.up.steps: " + steps + "'1000001'"},
    {"StepsBeyondAnyInteger", "steps: 10", "steps: 99999999999999999999",
     "46: branches.up.steps: " + steps + "'99999999999999999999'"},
    {"UnknownFieldOfBranch", "steps: 10", "step: 10",
     "46: branches.up: unknown field 'step', did you mean 'steps'? allowed: load, drive, from, to, "
     "steps, "
     "static_loads, hold"},
    // ---- outputs
    {"NoOutput",
     "wheel: {body: hub, centre: front, contact_patch: side, spin_axis: y, side: left}\n"
     "probes:\n  tip: {on: hub, at: front}\n",
     "", "1: no outputs; a wheel or a probe is needed"},
    {"EmptyProbes",
     "wheel: {body: hub, centre: front, contact_patch: side, spin_axis: y, side: left}\n"
     "probes:\n  tip: {on: hub, at: front}\n",
     "probes:\n", "1: no outputs; a wheel or a probe is needed"},
    {"ProbeOnGround", "tip: {on: hub", "tip: {on: ground",
     "50: probes.tip.on: a probe" + on_ground},
    {"ProbeWithoutPoint", "tip: {on: hub, at: front}", "tip: {on: hub}",
     "50: probes.tip.at" + missing},
    {"WheelOnGround", "wheel: {body: hub", "wheel: {body: ground",
     "48: wheel.body: a wheel" + on_ground},
    {"WheelWithoutCentre", "wheel: {body: hub, centre: front, ", "wheel: {body: hub, ",
     "48: wheel.centre" + missing},
    {"WheelWithoutSpinAxis", "spin_axis: y, ", "", "48: wheel.spin_axis" + missing},
    {"WheelWithoutSide", ", side: left", "", "48: wheel.side" + missing},
    {"WrongSide", "side: left", "side: lef",
     "48: wheel.side: 'lef' is not a side, did you mean 'left'? allowed: left, right"},
    {"SideUnlikeAny", "side: left", "side: driver",
     "48: wheel.side: 'driver' is not a side; allowed: left, right"},
    {"SpinAxisInboard", "spin_axis: y", "spin_axis: -y",
     "48: wheel.spin_axis: does not point outboard, which is +y for a left wheel"},
    {"SpinAxisInboardOnTheRight", "side: left", "side: right",
     "48: wheel.spin_axis: does not point outboard, which is -y for a right wheel"},
    {"SpinAxisForward", "spin_axis: y", "spin_axis: x",
     "48: wheel.spin_axis: does not point outboard, which is +y for a left wheel"},
    {"UnknownFieldOfWheel", "contact_patch: side", "contact: side",
     "48: wheel: unknown field 'contact'; allowed: body, centre, contact_patch, spin_axis, "
     "side, steering_axis"},
};

std::string text_with(const Mistake& mistake) {
    if (mistake.right == whole_text) return mistake.wrong;
    return replaced(bench_scene, mistake.right, mistake.wrong);
}

class WrongScene : public testing::TestWithParam<Mistake> {};

TEST_P(WrongScene, IsRefusedWithItsPlaceAndWhatIsAllowed) {
    try {
        parse_scene(text_with(GetParam()), "bench.yaml");
        FAIL() << "was accepted";
    } catch (const SceneError& error) {
        EXPECT_EQ(error.what(), "bench.yaml:" + GetParam().message);
    }
}

INSTANTIATE_TEST_SUITE_P(SceneReader, WrongScene, testing::ValuesIn(mistakes),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(BenchScene, IsSoundWithoutAMistake) {
    EXPECT_NO_THROW(parse_scene(bench_scene, "bench.yaml"));
}

}  // namespace
}  // namespace elastocheck
