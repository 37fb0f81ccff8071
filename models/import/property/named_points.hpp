// Readers of named points from files that are not tables.
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

// Points of a file of Lotus SHARK (.shk). A saved file has the names of its points under TEMP_SETTINGS, each
// followed by five lines of words and three numbers that are not its coordinates; the coordinates are
// without names, in the same order, under FRONT SUSPENSION or REAR SUSPENSION. A listing has lines
// "x y z POINT:1 name". Points of a file with both ends of a car are called front_axle NAME and
// rear_axle NAME. The unit is mm, unless `unit` or a line "(mm)" of a listing says otherwise. Throws
// SceneError with the line of anything else.
std::vector<NamedPoint> points_of_shark(std::string_view text, const std::string& file,
                                        const std::string& unit, Draft& draft);

// The points and markers that the commands of ADAMS/View (.cmd) create, in the frames of the parts and
// markers that they name. The unit is that of the file's `defaults units`, else `unit`. Throws SceneError
// with the line of a place that is an expression, or in a frame that the file does not create.
std::vector<NamedPoint> points_of_view(std::string_view text, const std::string& file,
                                       const std::string& unit, Draft& draft);

}  // namespace elastocheck::importer
