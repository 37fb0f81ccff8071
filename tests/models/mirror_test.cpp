// A mirrored scene equals the same scene with both sides written by hand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "elastocheck/read_scene.hpp"
#include "tests/models/axle_scene.hpp"
#include "tests/models/scene_numbers.hpp"

namespace elastocheck {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const std::string whole = axle_head + R"(
points:
  arm_front_left: [220, 520, -156]
  arm_rear_left: [-300, 507, -137]
  ball_left: [-21, 940, -174]
  top_left: [-115, 785, 579]
  lower_left: [-74, 853, 248]
  tie_inner_left: [-300, 520, -59]
  tie_outer_left: [-237, 895, -16]
  wheel_left: [-40, 1100, -26]
  contact_left: [-40, 1100, -346]
  rack: [-300, 10, -59]
  arm_front_right: [220, -520, -156]
  arm_rear_right: [-300, -507, -137]
  ball_right: [-21, -940, -174]
  top_right: [-115, -785, 579]
  lower_right: [-74, -853, 248]
  tie_inner_right: [-300, -520, -59]
  tie_outer_right: [-237, -895, -16]
  wheel_right: [-40, -1100, -26]
  contact_right: [-40, -1100, -346]
bodies:
  arm_left: {origin: ball_left}
  hub_left: {origin: wheel_left}
  rack: {origin: rack}
  arm_right: {origin: ball_right}
  hub_right: {origin: wheel_right}
joints:
  ball_left: {type: spherical, bodies: [arm_left, hub_left], at: ball_left}
  arm_left: {type: revolute, bodies: [arm_left, ground], at: arm_front_left, axis: [arm_rear_left, arm_front_left]}
  tube_left: {type: cylindrical, bodies: [hub_left, ground], at: lower_left, axis: [1, 2, 3]}
  slot_left: {type: translational, bodies: [hub_left, arm_left], at: top_left, axis: [1, 2, 3]}
  cross_left: {type: universal, bodies: [hub_left, rack], at: tie_outer_left, axis_i: [0, 3, 4], axis_j: x}
  flat_left: {type: planar, bodies: [hub_left, rack], at: tie_outer_left, normal: [1, 1, 5]}
  weld_left: {type: fixed, bodies: [hub_left, arm_left], at: wheel_left}
  tie_left: {type: distance, bodies: [hub_left, rack], from: tie_outer_left, to: tie_inner_left, length: 377}
  pad_left: {type: in_plane, bodies: [hub_left, ground], at: contact_left, normal: [1, 1, 0]}
  line_left: {type: in_line, bodies: [hub_left, rack], at: contact_left, axis: [1, 1, 0]}
  square_left: {type: perpendicular, bodies: [hub_left, arm_left], axis_i: [0, 3, 4], axis_j: x}
  same_left: {type: parallel, bodies: [hub_left, arm_left], axis: [3, 2, 1]}
  guide: {type: translational, bodies: [rack, ground], at: rack, axis: y, held: true}
  ball_right: {type: spherical, bodies: [arm_right, hub_right], at: ball_right}
  arm_right: {type: revolute, bodies: [arm_right, ground], at: arm_front_right, axis: [arm_front_right, arm_rear_right]}
  tube_right: {type: cylindrical, bodies: [hub_right, ground], at: lower_right, axis: [-1, 2, -3]}
  slot_right: {type: translational, bodies: [hub_right, arm_right], at: top_right, axis: [1, -2, 3]}
  cross_right: {type: universal, bodies: [hub_right, rack], at: tie_outer_right, axis_i: [0, -3, 4], axis_j: x}
  flat_right: {type: planar, bodies: [hub_right, rack], at: tie_outer_right, normal: [1, -1, 5]}
  weld_right: {type: fixed, bodies: [hub_right, arm_right], at: wheel_right}
  tie_right: {type: distance, bodies: [hub_right, rack], from: tie_outer_right, to: tie_inner_right, length: 377}
  pad_right: {type: in_plane, bodies: [hub_right, ground], at: contact_right, normal: [1, -1, 0]}
  line_right: {type: in_line, bodies: [hub_right, rack], at: contact_right, axis: [1, -1, 0]}
  square_right: {type: perpendicular, bodies: [hub_right, arm_right], axis_i: [0, -3, 4], axis_j: x}
  same_right: {type: parallel, bodies: [hub_right, arm_right], axis: [3, -2, 1]}
springs:
  coil_left: {bodies: [hub_left, ground], from: lower_left, to: top_left, rate: 28, preload: 3500}
  coil_right: {bodies: [hub_right, ground], from: lower_right, to: top_right, rate: 28, preload: 3500}
bushings:
  mount_left: {bodies: [arm_left, ground], at: arm_rear_left, frame: {x: [1, 2, 3], z: [0, -1, 5]},
    rates: [1, 2, 3], rotational_rates: [4, 5, 6], preload: [7, 8, 9], preload_moment: [10, 11, 12]}
  block_left:
    bodies: [arm_left, rack]
    at: arm_front_left
    stiffness:
      - [100, 1, 2, 3, 4, 5]
      - [1, 100, 6, 7, 8, 9]
      - [2, 6, 100, 1, 2, 3]
      - [3, 7, 1, 9000, 4, 5]
      - [4, 8, 2, 4, 9000, 6]
      - [5, 9, 3, 5, 6, 9000]
  mount_right: {bodies: [arm_right, ground], at: arm_rear_right, frame: {x: [1, -2, 3], z: [0, 1, 5]},
    rates: [1, 2, 3], rotational_rates: [4, 5, 6], preload: [7, -8, 9], preload_moment: [-10, 11, -12]}
  block_right:
    bodies: [arm_right, rack]
    at: arm_front_right
    stiffness:
      - [100, -1, 2, -3, 4, -5]
      - [-1, 100, -6, 7, -8, 9]
      - [2, -6, 100, -1, 2, -3]
      - [-3, 7, -1, 9000, -4, 5]
      - [4, -8, 2, -4, 9000, -6]
      - [-5, 9, -3, 5, -6, 9000]
static_loads:
  weight_left: {on: hub_left, at: wheel_left, force: [1, 2, -400]}
  torque_left: {on: hub_left, moment: [1, 2, 3]}
  weight_right: {on: hub_right, at: wheel_right, force: [1, -2, -400]}
  torque_right: {on: hub_right, moment: [-1, 2, -3]}
loads:
  push_left: {on: hub_left, at: contact_left, force: [-1, 2, 3]}
  twist_left: {on: hub_left, moment: [1, 2, 3]}
  push_right: {on: hub_right, at: contact_right, force: [-1, -2, 3]}
  twist_right: {on: hub_right, moment: [-1, 2, -3]}
branches:
  roll: {load: {push_left: 1, push_right: -1, twist_right: 2}, to: 1000, steps: 10}
  steer: {drive: joints.guide, to: 60, steps: 6, hold: {left.travel: 30, right.travel: -10}}
  lift: {drive: [joints.arm_left, joints.arm_right], to: 9, steps: 6}
  trim: {drive: {bushings.mount_left.preload.y: 1, bushings.mount_right.preload.y: -1}, to: 9, steps: 6}
wheels:
  left: {body: hub_left, centre: wheel_left, contact_patch: contact_left, spin_axis: [0.1, 1, 0.02], side: left, steering_axis: [ball_left, {on: arm_left, at: top_left}]}
  right: {body: hub_right, centre: wheel_right, contact_patch: contact_right, spin_axis: [0.1, -1, 0.02], side: right, steering_axis: [ball_right, {on: arm_right, at: top_right}]}
probes:
  tip_left: {on: arm_left, at: ball_left}
  tip_right: {on: arm_right, at: ball_right}
dampers:
  damper_left: {bodies: [hub_left, rack], from: lower_left, to: top_left}
  damper_right: {bodies: [hub_right, rack], from: lower_right, to: top_right}
vehicle: {wheelbase: 2700, cg_height: 550, axle: front, brake_share: 0.7, drive_share: 0.25}
)";

Scene parsed(const std::string& text) { return parse_scene(text, "axle.yaml"); }

template <class List>
const auto& named(const List& list, const std::string& name) {
    for (const auto& entry : list)
        if (entry.name == name) return entry;
    throw std::out_of_range(name);
}

// x_j and y_j of an angle are an arbitrary pair perpendicular to the axis: only the axis and the
// angle between u_i and x_j are significant.
bool is_gauge(const std::string& what) {
    return what.find(".drive.") != std::string::npos && what.find("u_local") != std::string::npos;
}

TEST(Mirror, MakesTheTwinThatIsWrittenByHand) {
    const auto mirrored = numbers(parsed(axle_scene)), by_hand = numbers(parsed(whole));
    ASSERT_EQ(mirrored.size(), by_hand.size());
    std::string worst;
    double largest = 0;
    for (std::size_t k = 0; k < mirrored.size(); ++k) {
        ASSERT_EQ(mirrored[k].first, by_hand[k].first);
        const double a = mirrored[k].second, b = by_hand[k].second;
        ASSERT_TRUE(std::isfinite(a) && std::isfinite(b)) << mirrored[k].first;
        const double difference = std::abs(a - b) / std::max(1.0, std::abs(b));
        if (!is_gauge(mirrored[k].first) && difference > largest)
            largest = difference, worst = mirrored[k].first;
    }
    EXPECT_LE(largest, 4e-16) << worst;
    const Scene scene = parsed(axle_scene);
    EXPECT_EQ(scene.hardpoints.size(), parsed(whole).hardpoints.size());
    EXPECT_EQ(named(scene.hardpoints, "ball_right").position, Vector3d(-0.021, -0.94, -0.174));
}

// Equal angles on both sides are a symmetric motion: a point p of the left arm rotated about the
// left axis is the mirror image of S p rotated by the same angle about the right one.
TEST(Mirror, EqualDrivesAreASymmetricMotion) {
    const Scene scene = parsed(axle_scene);
    const auto axis = [&](const char* name) {
        return std::get<Revolute>(named(scene.joints, name).kind).axis_j.u_local;
    };
    const auto drive_axis = [&](const char* name) {
        const auto& angle = std::get<Angle>(named(scene.joints, name).kind);
        return Vector3d(angle.j.u_local.cross(angle.y_j.u_local));
    };
    const Matrix3d S = Vector3d(1, -1, 1).asDiagonal();
    for (const double angle : {0.1, -2.0}) {
        const Matrix3d left = Eigen::AngleAxisd(angle, axis("arm_left")).toRotationMatrix();
        const Matrix3d right = Eigen::AngleAxisd(angle, axis("arm_right")).toRotationMatrix();
        EXPECT_LE((S * left * S - right).cwiseAbs().maxCoeff(), 1e-15);
    }
    EXPECT_LE((drive_axis("arm_right.drive") - axis("arm_right")).norm(), 1e-15);
}

// In ground axes a translational stiffness C = A K A' (of polar vectors) becomes S C S for any
// choice of frame; a preload becomes S f, a moment -S m.
TEST(Mirror, ReflectsABushingInGroundAxes) {
    const Scene scene = parsed(axle_scene);
    const Matrix3d S = Vector3d(1, -1, 1).asDiagonal();
    for (const std::string name : {"mount", "block"}) {
        const auto& left = std::get<Bushing>(named(scene.elastics, name + "_left").kind);
        const auto& right = std::get<Bushing>(named(scene.elastics, name + "_right").kind);
        const auto in_ground = [](const Bushing& b, int row, int column) {
            const Matrix3d A = b.i.A_local.toRotationMatrix();
            const Matrix6& K = std::get<LinearStiffness>(b.law).K;
            return Matrix3d(A * K.block<3, 3>(row, column) * A.transpose());
        };
        for (const auto& [row, column, sign] :
             {std::tuple{0, 0, 1.0}, {0, 3, -1.0}, {3, 0, -1.0}, {3, 3, 1.0}}) {
            const Matrix3d expected = sign * S * in_ground(left, row, column) * S;
            EXPECT_LE((in_ground(right, row, column) - expected).cwiseAbs().maxCoeff(),
                      1e-15 * (1 + expected.cwiseAbs().maxCoeff()))
                << name << " " << row << " " << column;
        }
        const auto preload = [](const Bushing& b, int row) {
            return Vector3d(b.i.A_local * b.preload.segment<3>(row));
        };
        EXPECT_LE((preload(right, 0) - S * preload(left, 0)).norm(), 1e-14) << name;
        EXPECT_LE((preload(right, 3) + S * preload(left, 3)).norm(), 1e-14) << name;
        EXPECT_NEAR(right.i.A_local.toRotationMatrix().determinant(), 1, 1e-15);
    }
}

TEST(Mirror, ASettingMovesBothSides) {
    const Setting lower{"points.ball_left.z", "-200"};
    const Scene scene = parse_scene(axle_scene, "axle.yaml", {&lower, 1});
    EXPECT_EQ(named(scene.bodies, "arm_left").design.r, Vector3d(-0.021, 0.94, -0.2));
    EXPECT_EQ(named(scene.bodies, "arm_right").design.r, Vector3d(-0.021, -0.94, -0.2));
}

TEST(Mirror, TurnsWholeWordsOnly) {
    std::string text = axle_scene;
    for (std::size_t at = 0; (at = text.find("rack", at)) != std::string::npos; at += 4)
        if (text.substr(at - 1, 1) != "\n") text.replace(at, 4, "leftover");
    const Scene scene = parsed(text);
    EXPECT_NO_THROW(named(scene.bodies, "leftover"));
    EXPECT_EQ(scene.bodies.size(), 5U);
}

std::string changed(const std::string& from, const std::string& to) {
    std::string text = axle_scene;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(Mirror, WhatCannotBeMirroredIsRefused) {
    const std::tuple<const char*, const char*, const char*> cases[] = {
        {"left -> right", "left",
         "4: mirror: 'left' is not a mirror; expected two different words of letters, like "
         "left -> right"},
        {"left -> right", "left -> left",
         "4: mirror: 'left -> left' is not a mirror; expected two different words of "
         "letters, like left -> right"},
        {"left -> right", "a1 -> b",
         "4: mirror: 'a1 -> b' is not a mirror; expected two different words of letters, "
         "like left -> right"},
        {"left -> right", "near -> far",
         "4: mirror: nothing to mirror: no name contains the word 'near'"},
        {"  rack: [-300, 10, -59]", "  ball_right: [0, 0, 0]\n  rack: [-300, 10, -59]",
         "15: points.ball_right: the mirror generates it from 'ball_left'; remove one of the two"},
        {"  rack: {origin: rack}", "  rack: {origin: rack}\n  arm_right: {origin: rack}",
         "20: bodies.arm_right: the mirror generates it from 'arm_left'; remove one of the two"},
        {"  coil_left:", "  coil:",
         "35: springs.coil: shared by both sides, since its name does not contain 'left', but "
         "refers to 'hub_left' and not to 'hub_right'"},
        {"  left: {body", "  front: {body",
         "61: wheels.front: shared by both sides, since its name does not contain 'left', but "
         "refers to 'arm_left' and not to 'arm_right'"},
        {"  damper_left:", "  damper:",
         "65: dampers.damper: shared by both sides, since its name does not contain 'left', but "
         "refers to 'hub_left' and not to 'hub_right'"},
        {"  damper_left:", "  coil_left:",
         "65: dampers.coil_left: a spring has the same name 'coil_left', and each has an output of "
         "that name; rename one of the two"},
    };
    for (const auto& [from, to, message] : cases) {
        try {
            parsed(changed(from, to));
            ADD_FAILURE() << to << " was accepted";
        } catch (const SceneError& error) {
            EXPECT_EQ(error.what(), std::string("axle.yaml:") + message);
        }
    }
    EXPECT_THROW(parsed(changed("wheels:\n  left: {body", "wheel: {body")), SceneError);
}

}  // namespace
}  // namespace elastocheck
