// Joints (JOINT) and joint primitives (JPRIM) of ADAMS, and the joint of a scene for each.
#pragma once

#include <string_view>

namespace elastocheck::importer::adm {

// Where the origin of I is: anywhere, at that of J, on z of J, in the plane xy of J.
enum class Position { any, meet, on_line, on_plane };
// Which axes of I and J are parallel; one way: and point in the same direction.
enum class Parallel { none, z, z_and_x, z_and_x_one_way };

struct JointOfAdams {
    std::string_view keyword, flag;
    std::string_view type;  // in a scene; the first entry of a type is used for exports
    Position position = Position::any;
    Parallel parallel = Parallel::none;
    const char* along = nullptr;   // field of the scene's joint for z of J
    int axis_i = -1, axis_j = -1;  // axes of I and J that it keeps perpendicular: 0 x, 1 y, 2 z
};
inline constexpr JointOfAdams joints_of_adams[] = {
    {"JOINT", "REVOLUTE", "revolute", Position::meet, Parallel::z, "axis"},
    {"JOINT", "CYLINDRICAL", "cylindrical", Position::on_line, Parallel::z, "axis"},
    {"JOINT", "TRANSLATIONAL", "translational", Position::on_line, Parallel::z_and_x, "axis"},
    {"JOINT", "SPHERICAL", "spherical", Position::meet},
    {"JOINT", "FIXED", "fixed", Position::meet, Parallel::z_and_x_one_way},
    {"JOINT", "PLANAR", "planar", Position::on_plane, Parallel::z, "normal"},
    {"JOINT", "UNIVERSAL", "universal", Position::meet, Parallel::none, nullptr, 2, 2},
    {"JOINT", "HOOKE", "universal", Position::meet, Parallel::none, nullptr, 0, 1},
    {"JPRIM", "ATPOINT", "spherical", Position::meet},
    {"JPRIM", "INLINE", "in_line", Position::on_line, Parallel::none, "axis"},
    {"JPRIM", "INPLANE", "in_plane", Position::on_plane, Parallel::none, "normal"},
    {"JPRIM", "PARALLEL_AXES", "parallel", Position::any, Parallel::z, "axis"},
    {"JPRIM", "PERPENDICULAR", "perpendicular", Position::any, Parallel::none, nullptr, 2, 2},
    {"JPRIM", "ORIENTATION", "parallel", Position::any, Parallel::z_and_x_one_way, "axis"},
};

}  // namespace elastocheck::importer::adm
