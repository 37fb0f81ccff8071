// A scene as a function of the numbers of its file.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "elastocheck/read_scene.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::compare {

// A number of the file, its unit there, and the step in which its effect is shown: 1 mm of a length,
// else 1 % of the value; one unit where that is zero.
struct VariedNumber {
    std::string path = {};  // of Scene::numbers; or several joined by commas, which change together
    double value = 0;
    std::string unit = {};
    double step = 1;  // in its unit
    const char* step_name = "1 %";
    int side = 0;  // 1, -1: at the end of its range; derivatives are those where it grows (falls)
    std::string undefined = {};  // reason why there is no derivative by it
};
// The names between the commas.
std::vector<std::string> paths_in(const std::string& joined);
VariedNumber varied_number(const Number& number);

struct VaryingScene {
    std::vector<VariedNumber> numbers;
    // the scene as read, before a trim, with number k larger by `by`, in its unit; throws SceneError
    // where the file does not accept that
    std::function<Scene(std::size_t k, double by)> with = {};
};

// By these numbers of a file. Throws SceneError for a path that is not in Scene::numbers.
VaryingScene varying(const std::filesystem::path& file, std::span<const Setting> settings,
                     std::span<const std::string> paths);
// By the wanted numbers of a file in their order, also those of one side of the vehicle; by default all
// numbers of both sides except the counts of steps of branches. Numbers that the file
// accepts only together, such as the entries (1, 2) and (2, 1) of a stiffness matrix, are one, at the
// place of the first.
VaryingScene varying(const std::filesystem::path& file, std::span<const Setting> settings = {},
                     const std::function<bool(const std::string& path)>& wanted = {});

// The step h of the differences, in the unit of the number: a length of 0.05 mm, an angle of 0.05 deg,
// else a thousandth of the value, or a tenth of a unit where that is zero. With levers L of a
// suspension, h / L ≈ 1e-3, the four-point formula is exact to 1e-12.
double difference_step(const VariedNumber& number);

}  // namespace elastocheck::compare
