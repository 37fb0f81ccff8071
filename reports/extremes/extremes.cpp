#include "reports/extremes/extremes.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "elastocheck/read_scene.hpp"
#include "extremes_embedded.hpp"  // generated: name and text of every scene of models/extremes

namespace elastocheck::reports {
namespace {

using By = compare::Variant::Construction;

struct Extreme {
    const char *scene, *label;
    std::string_view settings;  // PATH=VALUE, in the units of the file: mm
    By known = By::unknown;     // what the construction of the scene implies of its equilibria
};
constexpr Extreme table[]{
    {"two_hinges", "axes at 1e-1 rad", "points.skew.x=100", By::nothing_moves},
    {"two_hinges", "axes at 1e-3 rad", "points.skew.x=1", By::nothing_moves},
    {"two_hinges", "axes at 1e-6 rad", "points.skew.x=1e-3", By::nothing_moves},
    {"two_hinges", "axes at 1e-9 rad", "points.skew.x=1e-6", By::nothing_moves},
    {"two_hinges", "axes in one line", "points.skew.x=0"},
    {"tie_rod_through_axis", "lever 100 mm", "points.arm.x=100", By::nothing_moves},
    {"tie_rod_through_axis", "lever 1 mm", "points.arm.x=1", By::nothing_moves},
    {"tie_rod_through_axis", "lever 1e-3 mm", "points.arm.x=1e-3", By::nothing_moves},
    {"tie_rod_through_axis", "lever 1e-6 mm", "points.arm.x=1e-6", By::nothing_moves},
    {"tie_rod_through_axis", "through the axis", "points.arm.x=0"},
    {"links_in_a_plane", "50 mm out of it", "points.a_in.z=50 points.b_in.z=100"},
    {"links_in_a_plane", "1 mm out of it", "points.a_in.z=1 points.b_in.z=2"},
    {"links_in_a_plane", "1e-3 mm out of it", "points.a_in.z=1e-3 points.b_in.z=0.002"},
    {"links_in_a_plane", "1e-6 mm out of it", "points.a_in.z=1e-6 points.b_in.z=2e-06"},
    {"links_in_a_plane", "in the plane", "points.a_in.z=0 points.b_in.z=0"},
    {"collinear_arm", "lever 300 mm", "points.ball.y=300"},
    {"collinear_arm", "lever 1 mm", "points.ball.y=1"},
    {"collinear_arm", "lever 1e-6 mm", "points.ball.y=1e-6"},
    {"collinear_arm", "in one line", "points.ball.y=0"},
    {"redundant_link", "consistent", ""},
    {"redundant_link", "1e-9 mm apart", "joints.link.length=500.000000001"},
    {"redundant_link", "1e-5 mm apart", "joints.link.length=500.00001", By::no_equilibrium},
    {"redundant_link", "1e-3 mm apart", "joints.link.length=500.001", By::no_equilibrium},
    {"redundant_link", "1 mm apart", "joints.link.length=501", By::no_equilibrium},
    {"stop_that_touches", "1 mm away", ""},
    {"stop_that_touches", "1e-9 mm away", "springs.coil.bump_stop.clearance=1e-9"},
    {"stop_that_touches", "just touches", "springs.coil.bump_stop.clearance=0"},
    {"stop_that_touches", "pressed by 1e-9 mm", "springs.coil.bump_stop.clearance=-1e-9"},
    {"flat_and_steep", "as it is", ""},
    {"flat_and_steep", "flat rises by 1e-3 N",
     "springs.coil.curve.table.7.2=500.001 springs.coil.curve.table.3.2=-500.001"},
    {"flat_and_steep", "flat",
     "springs.coil.curve.table.7.2=500 springs.coil.curve.table.3.2=-500"},
    {"flat_and_steep", "steep within 1e-3 mm",
     "springs.coil.curve.table.9.1=30.001 springs.coil.curve.table.1.1=-30.001"},
    {"flat_and_steep", "steep within 1e-6 mm",
     "springs.coil.curve.table.9.1=30.000001 springs.coil.curve.table.1.1=-30.000001"},
    {"column", "10 mm out of line", ""},
    {"column", "1e-3 mm out of line", "points.top.x=1e-3"},
    {"column", "1e-6 mm out of line", "points.top.x=1e-6"},
    {"column", "1e-9 mm out of line", "points.top.x=1e-9"},
    {"column", "straight", "points.top.x=0"},
    {"over_centre", "short of the limit point", "branches.pull.to=60"},
    {"over_centre", "just short of it", "branches.pull.to=63.34"},
    {"over_centre", "past it", "branches.pull.to=70"},
    {"over_centre", "far past it", "branches.pull.to=400"},
};

std::vector<Setting> settings_of(std::string_view text) {
    std::vector<Setting> settings;
    std::istringstream words{std::string(text)};
    for (std::string word; words >> word;) {
        const auto equals = word.find('=');
        settings.push_back({word.substr(0, equals), word.substr(equals + 1)});
    }
    return settings;
}

}  // namespace

std::vector<compare::Trial> extremes() {
    std::vector<compare::Trial> trials;
    for (const Extreme& row : table) {
        const auto* file =
            std::ranges::find(embedded_extremes, row.scene, &Embedded_extremes::name);
        if (file == std::end(embedded_extremes)) throw std::logic_error("no scene of this name");
        trials.push_back({row.scene,
                          std::string(compare::extreme),
                          {.label = row.label,
                           .scene = parse_scene(file->text, row.scene, settings_of(row.settings)),
                           .known = row.known}});
    }
    return trials;
}

}  // namespace elastocheck::reports
