// Numbers published by others, reproduced by the references and the series: README.md names each
// source, and the definitions by which its columns are reproduced.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "compare/comparison/legs.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"

namespace elastocheck::compare {
namespace {

using Eigen::Vector3d;

constexpr double degrees = 180 / std::numbers::pi;
const std::string folder = ELASTOCHECK_OUTSIDE;
constexpr Leg solvers[] = {Leg::equilibrium, Leg::energy, Leg::series};

// The rows of a published table, by column; an empty cell is NaN. Lines with # are remarks.
std::vector<std::map<std::string, double>> table(const std::string& file) {
    std::ifstream text(folder + "/" + file);
    std::vector<std::string> names;
    std::vector<std::map<std::string, double>> rows;
    for (std::string line; std::getline(text, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream cells(line);
        std::vector<std::string> row;
        for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
        if (names.empty()) {
            names = row;
            continue;
        }
        auto& values = rows.emplace_back();
        for (std::size_t c = 0; c < names.size(); ++c)
            values[names[c]] = c < row.size() && !row[c].empty() ? std::stod(row[c]) : NAN;
    }
    return rows;
}

// Outputs and poses of a leg at one value of the parameter.
struct Seen {
    std::map<std::string, double> output;  // in mm and deg
    std::vector<Pose> poses;
};

// A branch of a scene by one leg: by the parameter, in the unit of the branch, to the nearest 1e-6.
std::map<long, Seen> solved(const Model& model, Leg leg) {
    const auto outputs = channels(model);
    const Branch& branch = model.branches.front();
    std::map<long, Seen> path;
    const PathCurve curve = solve_branch(
        model, outputs, branch, sides_of(model, branch), {.leg = leg},
        [&](const Equilibrium& state, const WheelResponse*) {
            Seen seen;
            const auto values = evaluate(model, outputs, state);
            for (std::size_t c = 0; c < outputs.size(); ++c)
                seen.output[outputs[c].name] = values[c];
            seen.poses = state.poses;
            path[std::lround(1e6 * parameter_in(unit_of(branch.unit), state.load))] = seen;
        });
    EXPECT_EQ(curve.outcome, Outcome::converged) << name(leg) << ": " << curve.detail;
    return path;
}

// A line of the page of numbers from outside: of a column the place with the largest difference.
struct Row {
    std::string scene, source, figure, at, published, ours, difference, definition;
};
const std::string rill = "G. Rill, A. A. Castro, *Road Vehicle Dynamics*: closed form",
                  manual = "Formula Renault 2.0 (2009), chassis manual, part 2",
                  printed_listing = "listing of a kinematics program, double wishbone";
// Ours less printed; zero has no sign.
std::string difference(double ours, double printed, int digits) {
    const std::string text = fmt::format("{:+.{}f}", ours - printed, digits);
    return text.find_first_of("123456789") == text.npos ? text.substr(1) : text;
}
std::string open_question(const std::string& text) { return "**open**: " + text; }

// G. Rill and A. A. Castro: a closed form over the angle of the lower arm and the rack. Their toe
// is about +z, their camber the angle to the ground in the plane of the axle.
std::vector<Row> double_wishbone() {
    std::vector<Row> rows;
    const auto published = table("double_wishbone.csv");
    EXPECT_EQ(published.size(), 83u);
    std::set<double> racks;
    for (const auto& state : published) racks.insert(state.at("rack_m"));
    std::map<Leg, double> mm, deg;
    std::map<Leg, int> states;
    for (const double rack : racks) {
        const std::vector<Setting> settings{setting("branches.arm.hold.joints.rack", rack)};
        const Model model = compile(read_scene(folder + "/double_wishbone.yaml", settings));
        for (const Leg leg : solvers) {
            auto path = solved(model, leg);
            for (const auto& state : published) {
                if (state.at("rack_m") != rack) continue;
                const auto found = path.find(std::lround(1e6 * state.at("arm_angle_deg")));
                EXPECT_NE(found, path.end()) << name(leg);
                if (found == path.end()) continue;
                const auto& out = found->second.output;
                for (const char* axis : {"x", "y", "z"})
                    mm[leg] =
                        std::max(mm[leg], std::abs(out.at(fmt::format("wheel_centre_{}", axis)) -
                                                   1e3 * state.at(fmt::format("{}_m", axis))));
                const double toe = out.at("toe") / degrees, camber = out.at("camber") / degrees;
                const Vector3d spin{std::sin(toe) * std::cos(camber),
                                    std::cos(toe) * std::cos(camber), -std::sin(camber)};
                deg[leg] = std::max(
                    {deg[leg],
                     std::abs(degrees * std::atan2(-spin.x(), spin.y()) -
                              state.at("toe_deg_about_z")),
                     std::abs(degrees * std::atan2(spin.z(), spin.y()) - state.at("camber_deg"))});
                ++states[leg];
            }
        }
    }
    for (const Leg leg : solvers) {
        EXPECT_EQ(states[leg], 83) << name(leg);
        EXPECT_LE(mm[leg], 1e-9) << name(leg) << ": positions [mm]";  // printed to 1e-9 mm
        EXPECT_LE(deg[leg], 1e-10) << name(leg) << ": angles [deg]";  // printed to 1e-10 deg
        testing::Test::RecordProperty(fmt::format("{} mm", name(leg)),
                                      fmt::format("{:.2g}", mm[leg]));
        testing::Test::RecordProperty(fmt::format("{} deg", name(leg)),
                                      fmt::format("{:.2g}", deg[leg]));
    }
    const auto add = [&](const char* figure, const char* within, const char* definition) {
        rows.push_back({"double_wishbone.yaml", rill, figure, "83 states", "to 1e-9 mm, 1e-10 deg",
                        "the same", within, definition});
    };
    add("wheel centre", "below 1e-9 mm", "position, ground axes");
    add("toe", "below 1e-10 deg", "of the spin axis e: atan2(−e_x, e_y)");
    add("camber", "below 1e-10 deg", "`camber@front_view`: atan2(e_z, e_y)");
    return rows;
}
TEST(Outside, DoubleWishboneAgreesWithItsClosedForm) { (void)double_wishbone(); }

// Height of the roll centre above the patch: the line from the patch to the instant centre, which
// is where the planes of both wishbones meet in the transverse plane x = 0 of the drawn wheel
// centre, at y = 0.
double by_planes(const std::array<Vector3d, 3>& lower, const std::array<Vector3d, 3>& upper,
                 const Vector3d& patch) {
    Eigen::Matrix2d rows;
    Eigen::Vector2d right;
    int k = 0;
    for (const auto& arm : {lower, upper}) {
        const Vector3d normal = (arm[1] - arm[0]).cross(arm[2] - arm[0]);
        rows.row(k) << normal.y(), normal.z();
        right[k++] = normal.dot(arm[0]);
    }
    const Eigen::Vector2d instant = rows.inverse() * right;
    return -patch.y() * (instant[1] - patch.z()) / (instant[0] - patch.y());
}

Vector3d read(const Seen& seen, const std::string& name) {
    return {seen.output.at(name + "_x"), seen.output.at(name + "_y"), seen.output.at(name + "_z")};
}

// Value at x of the polynomial through the six points (x_k, y_k) nearest to x; its derivative where
// `slope`.
double interpolated(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
    std::vector<std::size_t> order(xs.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, [&](std::size_t k) { return std::abs(xs[k] - x); });
    order.resize(6);
    double sum = 0;
    for (const std::size_t k : order) {
        double term = ys[k];
        for (const std::size_t j : order)
            if (j != k) term *= (x - xs[j]) / (xs[k] - xs[j]);
        sum += term;
    }
    return sum;
}

// A manufacturer's table. Its camber is the static camber less the change of the kingpin
// inclination; its contact point lies below the wheel centre in the plane of that camber, without
// toe; deflection, half track, trail and rim offset are those of that contact point;
// its toe is that of an axis that was lateral at the design position; its roll centre is by the
// planes of the wishbones.
std::vector<Row> formula_rear() {
    std::map<std::string, Row> worst;
    std::map<std::string, double> by;
    const auto published = table("formula_rear.csv");
    EXPECT_EQ(published.size(), 4u);
    const Model model = compile(read_scene(folder + "/formula_rear.yaml"));
    const Vector3d lower_front{264.30, 105.50, 178.50}, lower_rear{-110.49, 105.50, 162.30},
        upper_front{214.30, 106.44, 348.08}, upper_rear{-214.30, 106.44, 350.47};
    constexpr double radius = 283.92, static_camber = -5;
    const double spring_drawn =
        (Vector3d(21.90, 45.25, 407.58) - Vector3d(-297.97, 47.63, 390.34)).norm();
    const auto wheel = static_cast<std::size_t>(model.wheels.front().body);
    constexpr double within = 0.0055;  // mm, deg: half of the last printed digit, and a tenth
    for (const Leg leg : solvers) {
        const auto path = solved(model, leg);
        const double kingpin_drawn = path.at(0).output.at("kingpin_inclination");
        std::map<std::string, std::vector<double>> curves;
        for (const auto& [at, seen] : path) {
            const Vector3d centre = read(seen, "wheel_centre"), lower = read(seen, "lower_outer"),
                           upper = read(seen, "upper_outer"),
                           lateral = seen.poses[wheel].p * Vector3d::UnitY();
            const double kingpin = seen.output.at("kingpin_inclination"),
                         camber = static_camber + kingpin_drawn - kingpin;
            const Vector3d contact = centre - radius * Vector3d{0, std::sin(camber / degrees),
                                                                std::cos(camber / degrees)};
            const Vector3d axis =
                lower + (upper - lower) * (contact.z() - lower.z()) / (upper.z() - lower.z());
            const auto put = [&](const char* column, double value) {
                curves[column].push_back(value);
            };
            put("contact", contact.z());
            put("contact_x", contact.x());
            put("camber_deg", camber);
            put("toe_deg", degrees * std::atan2(lateral.x(), lateral.y()));
            put("roll_centre_mm", by_planes({lower_front, lower_rear, lower},
                                            {upper_front, upper_rear, upper}, contact));
            put("spring_mm", spring_drawn - seen.output.at("coil.compression"));
            put("wheelbase_mm", -centre.x());
            put("half_track_mm", contact.y());
            put("castor_deg", seen.output.at("caster"));
            put("kingpin_deg", kingpin);
            put("rim_offset_mm", contact.y() - axis.y());
            put("castor_trail_mm", axis.x() - centre.x());
        }
        const auto& contact = curves.at("contact");
        const std::size_t drawn = contact.size() / 2;
        const double height = contact[drawn], track = curves.at("half_track_mm")[drawn];
        for (double& value : curves.at("half_track_mm")) value -= track;
        for (const auto& row : published) {
            const double at = height + row.at("deflection_mm");
            const auto note = [&](const std::string& column, double printed, double ours) {
                if (leg != Leg::equilibrium || std::abs(ours - printed) < by[column]) return;
                by[column] = std::abs(ours - printed);
                const int digits = column == "motion_ratio" ? 3 : 2;
                worst[column] = {"formula_rear.yaml",
                                 manual,
                                 column,
                                 fmt::format("deflection {:g} mm", row.at("deflection_mm")),
                                 fmt::format("{:.{}f}", printed, digits),
                                 fmt::format("{:.{}f}", ours, digits + 1),
                                 difference(ours, printed, digits + 1),
                                 ""};
            };
            for (const auto& [column, printed] : row) {
                if (column == "deflection_mm" || std::isnan(printed)) continue;
                if (column == "motion_ratio") {  // no definition reproduces it (README.md)
                    constexpr double h = 0.5;
                    const auto& spring = curves.at("spring_mm");
                    const double ratio = -2 * h /
                                         (interpolated(contact, spring, at + h) -
                                          interpolated(contact, spring, at - h));
                    EXPECT_NEAR(printed / ratio, 1.0068, 0.0012) << name(leg);
                    note(column, printed, ratio);
                    // with the path of the contact point, `motion_ratio@patch_path`
                    const auto slope = [&](const char* of) {
                        return (interpolated(contact, curves.at(of), at + h) -
                                interpolated(contact, curves.at(of), at - h)) /
                               (2 * h);
                    };
                    const double over_path =
                        ratio * std::hypot(1., slope("half_track_mm"), slope("contact_x"));
                    EXPECT_NEAR(printed / over_path, 1.0024, 0.0016) << name(leg);
                    continue;
                }
                const double value = interpolated(contact, curves.at(column), at);
                EXPECT_NEAR(value, printed, within)
                    << name(leg) << " " << column << " at " << row.at("deflection_mm") << " mm";
                note(column, printed, value);
            }
        }
    }
    std::vector<Row> rows;
    const auto add = [&](const char* column, const char* figure, const std::string& definition) {
        if (!worst.contains(column)) return;
        Row row = worst.at(column);
        row.figure = figure, row.definition = definition;
        rows.push_back(row);
    };
    add("camber_deg", "camber [deg]", "`camber@kingpin`");
    add("toe_deg", "toe [deg]", "`toe@lateral`");
    add("roll_centre_mm", "roll centre [mm]",
        "`roll_centre_height@planes`, above the contact point");
    add("half_track_mm", "half track [mm]", "of the contact point, in the plane of that camber");
    add("rim_offset_mm", "rim offset [mm]", "of that contact point");
    add("castor_trail_mm", "trail [mm]", "of that contact point");
    add("castor_deg", "castor [deg]", "as here: `caster`");
    add("kingpin_deg", "kingpin inclination [deg]", "as here: `kingpin_inclination`");
    add("spring_mm", "spring length [mm]", "as here");
    add("wheelbase_mm", "wheelbase [mm]", "of the wheel centre, growing to the back");
    add("motion_ratio", "motion ratio",
        open_question("deflection over spring length is 0.6 to 0.8 % below the printed ratio; with "
                      "the path of the contact point in place of the deflection "
                      "(`motion_ratio@patch_path`) 0.1 to 0.4 %"));
    return rows;
}
TEST(Outside, FormulaRearAxleAgreesWithItsPublishedTable) { (void)formula_rear(); }

// The printed static figures of a kinematics program; the last digit printed is 0.01.
std::vector<Row> listing() {
    std::vector<Row> rows;
    const Model model = compile(read_scene(folder + "/listing.yaml"));
    const auto state = design_state(model);
    auto outputs = channels(model);
    std::ranges::move(definition_channels(model), std::back_inserter(outputs));
    const auto values = evaluate(model, outputs, state);
    const auto add = [&](const char* figure, double printed, double ours,
                         const std::string& definition, double within = 0.005) {
        EXPECT_NEAR(ours, printed, within) << figure;
        rows.push_back({"listing.yaml", printed_listing, figure, "static",
                        fmt::format("{:.2f}", printed), fmt::format("{:.3f}", ours),
                        difference(ours, printed, 3), definition});
    };
    const auto check = [&](const char* figure, double printed, const char* output,
                           double sign = 1) {
        add(figure, printed,
            sign * values.at(static_cast<std::size_t>(find_channel(outputs, output))),
            fmt::format("`{}`{}", output, sign < 0 ? ", its sign turned" : ""));
    };
    check("castor [deg]", 16.22, "caster");
    check("kingpin inclination [deg]", 9.75, "kingpin_inclination");
    check("kingpin offset at the ground [mm]", 50.13, "scrub_radius");
    check("castor offset [mm]", 76.31, "mechanical_trail");
    check("mechanical trail [mm]", 73.27, "mechanical_trail@across_axis");
    check("hub trail [mm]", 5.00, "mechanical_trail@centre", -1);
    check("kingpin offset at the wheel [mm]", 98.13, "scrub_radius@centre");
    check("roll centre by the planes [mm]", 267.52, "roll_centre_height@planes");

    const auto rates = characteristics(model);
    const auto height = static_cast<std::size_t>(find_channel(rates, "roll_centre_height"));
    const auto sides = sides_of(model, model.branches.front());
    for (const Leg leg : {Leg::energy, Leg::equilibrium}) {
        double found = NAN;
        (void)solve_branch(
            model, rates, model.branches.front(), sides, {.leg = leg},
            [&](const Equilibrium& at, const WheelResponse*) {
                if (at.load == 0)
                    found = row_of(model, rates, sides.front(), {.leg = leg}, at).values[height];
            });
        EXPECT_NEAR(found, 293.58, 0.005) << name(leg) << ": by the motion of the patch";
        if (leg == Leg::equilibrium)
            add("roll centre [mm]", 293.64, found,
                open_question("by the motion of the patch, `roll_centre_height`"), 0.1);
    }
    return rows;
}
TEST(Outside, StaticFiguresAgreeWithTheOutputOfAKinematicsProgram) { (void)listing(); }

// reports/validation/outside.md shows these numbers.
TEST(Outside, NumbersAreThoseOfTheCommittedPage) {
    std::string table =
        "| scene | source | figure | at | published | ours | difference | definition |\n"
        "|---|---|---|---|---|---|---|---|\n";
    for (const auto& part : {double_wishbone(), formula_rear(), listing()})
        for (const Row& row : part)
            table +=
                fmt::format("| [{}](../../tests/outside/{}) | {} | {} | {} | {} | {} | {} | {} |\n",
                            row.scene, row.scene, row.source, row.figure, row.at, row.published,
                            row.ours, row.difference, row.definition);
    std::ifstream file(ELASTOCHECK_VALIDATION "/outside.md");
    const std::string page{std::istreambuf_iterator<char>(file), {}};
    EXPECT_NE(page.find(table), page.npos) << "reports/validation/outside.md has to contain\n\n"
                                           << table;
}

}  // namespace
}  // namespace elastocheck::compare
