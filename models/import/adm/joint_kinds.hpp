// Joints (JOINT) and joint primitives (JPRIM) of ADAMS, and the joint of a scene for each.
#pragma once

#include <string_view>

namespace elastocheck::importer::adm {

// Where the origin of marker I is: anywhere, at that of J, on z of J, in the plane xy of J.
enum class Position { any, coincident, on_line, on_plane };
// Which axes of I and J are parallel. With same_sense they point in the same direction; the others may
// also be opposite.
enum class Parallel { none, z, z_and_x, z_and_x_same_sense };

struct JointOfAdams {
    std::string_view keyword, flag;
    // Type of the joint in a scene. An export writes the first entry of that type.
    std::string_view type;
    Position position = Position::any;
    Parallel parallel = Parallel::none;
    const char* z_field = nullptr;  // field of the scene's joint that holds the direction z of J
    // The axes of I and J that the joint keeps perpendicular: 0 x, 1 y, 2 z; -1 none.
    int axis_i = -1, axis_j = -1;
};
inline constexpr JointOfAdams joints_of_adams[] = {
    {"JOINT", "REVOLUTE", "revolute", Position::coincident, Parallel::z, "axis"},
    {"JOINT", "CYLINDRICAL", "cylindrical", Position::on_line, Parallel::z, "axis"},
    {"JOINT", "TRANSLATIONAL", "translational", Position::on_line, Parallel::z_and_x, "axis"},
    {"JOINT", "SPHERICAL", "spherical", Position::coincident},
    {"JOINT", "FIXED", "fixed", Position::coincident, Parallel::z_and_x_same_sense},
    {"JOINT", "PLANAR", "planar", Position::on_plane, Parallel::z, "normal"},
    {"JOINT", "UNIVERSAL", "universal", Position::coincident, Parallel::none, nullptr, 2, 2},
    {"JOINT", "HOOKE", "universal", Position::coincident, Parallel::none, nullptr, 0, 1},
    {"JPRIM", "ATPOINT", "spherical", Position::coincident},
    {"JPRIM", "INLINE", "in_line", Position::on_line, Parallel::none, "axis"},
    {"JPRIM", "INPLANE", "in_plane", Position::on_plane, Parallel::none, "normal"},
    {"JPRIM", "PARALLEL_AXES", "parallel", Position::any, Parallel::z, "axis"},
    {"JPRIM", "PERPENDICULAR", "perpendicular", Position::any, Parallel::none, nullptr, 2, 2},
    {"JPRIM", "ORIENTATION", "parallel", Position::any, Parallel::z_and_x_same_sense, "axis"},
};

}  // namespace elastocheck::importer::adm
