// Points with names, of the programs whose files have them without a table.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "models/import/draft.hpp"

namespace elastocheck::importer {

struct NamedPoint {
    int line = 0;
    std::string name;
    std::array<double, 3> at{};  // as in the file, in mm
};

// A saved file has the names of its points under TEMP_SETTINGS, each with five lines of words and
// three numbers, which are not its place; the coordinates stand without names, in the same order, under
// FRONT SUSPENSION or REAR SUSPENSION. A listing has "x y z POINT:1 name". Points of both ends of a
// car are called front_axle NAME and rear_axle NAME. Millimetres, unless `unit` or a listing's line "(mm)" says
// otherwise. Throws SceneError with the line of what is neither.
std::vector<NamedPoint> points_of_shark(std::string_view text, const std::string& file,
                                        const std::string& unit, Draft& draft);

// The points and markers that the commands of ADAMS/View (.cmd) create, in the frames of the parts and
// markers that they name. The unit is that of the file's `defaults units`, else `unit`. Throws SceneError
// with the line of a place that is an expression, or in a frame that the file does not create.
std::vector<NamedPoint> points_of_view(std::string_view text, const std::string& file,
                                       const std::string& unit, Draft& draft);

}  // namespace elastocheck::importer
