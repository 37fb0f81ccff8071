// A mirrored scene equals the same scene with both sides written by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "elastocheck/read_scene.hpp"
#include "tests/models/fixtures.hpp"
#include "tests/models/scene_numbers.hpp"

namespace elastocheck {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const std::string by_both_sides = fixture("axle_by_hand");

Scene parsed_axle(const std::string& text) { return parse_scene(text, "axle.yaml"); }

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

TEST(Mirror, MirroredAxleEqualsTheTwinWrittenByHand) {
    const auto mirrored = numbers(parsed_axle(axle_scene)),
               by_hand = numbers(parsed_axle(by_both_sides));
    ASSERT_EQ(mirrored.size(), by_hand.size());
    std::string worst;
    double largest = 0;
    for (std::size_t k = 0; k < mirrored.size(); ++k) {
        ASSERT_EQ(mirrored[k].first, by_hand[k].first);
        const double a = mirrored[k].second, b = by_hand[k].second;
        ASSERT_TRUE(std::isfinite(a) && std::isfinite(b)) << mirrored[k].first;
        const double difference = std::abs(a - b) / std::max(1.0, std::abs(b));
        if (!is_gauge(mirrored[k].first) && difference > largest) {
            largest = difference;
            worst = mirrored[k].first;
        }
    }
    EXPECT_LE(largest, 4e-16) << worst;
    const Scene scene = parsed_axle(axle_scene);
    EXPECT_EQ(scene.hardpoints.size(), parsed_axle(by_both_sides).hardpoints.size());
    EXPECT_EQ(named(scene.hardpoints, "ball_right").position, Vector3d(-0.021, -0.94, -0.174));
}

// Equal angles on both sides are a symmetric motion: a point p of the left arm rotated about the
// left axis is the mirror image of S p rotated by the same angle about the right one.
TEST(Mirror, EqualDrivesGiveASymmetricMotion) {
    const Scene scene = parsed_axle(axle_scene);
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
TEST(Mirror, StiffnessAndPreloadOfABushingAreReflectedInTheGroundXZPlane) {
    const Scene scene = parsed_axle(axle_scene);
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

TEST(Mirror, NameThatContainsLeftInsideAWordIsKept) {
    std::string text = axle_scene;
    for (std::size_t at = 0; (at = text.find("rack", at)) != std::string::npos; at += 4)
        if (text.substr(at - 1, 1) != "\n") text.replace(at, 4, "leftover");
    const Scene scene = parsed_axle(text);
    EXPECT_NO_THROW(named(scene.bodies, "leftover"));
    EXPECT_EQ(scene.bodies.size(), 7U);
}

}  // namespace
}  // namespace elastocheck
