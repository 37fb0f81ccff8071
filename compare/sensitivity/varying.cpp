#include "compare/sensitivity/varying.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "models/reader/document/suggestions.hpp"
#include "models/reader/parsed_scene.hpp"

namespace elastocheck::compare {
namespace {

struct File {
    File(const std::filesystem::path& file, std::span<const Setting> set)
        : parsed(std::make_shared<const reader::ParsedScene>(file)),
          settings(set.begin(), set.end()) {}

    std::shared_ptr<const reader::ParsedScene> parsed;
    std::vector<Setting> settings;

    // the scene where the number has this value
    Scene with(const VariedNumber& number, double value) const {
        const auto paths = paths_in(number.path);
        std::vector<Setting> others = settings;
        std::erase_if(others, [&](const Setting& set) {
            return std::ranges::find(paths, set.path) != paths.end();
        });
        return reader::VariedScene(*parsed, paths, std::move(others))
            .read(std::vector<double>(paths.size(), value));
    }
    bool accepts(const VariedNumber& number) const {
        const double h = difference_step(number);
        for (const double by : {h, -h}) try {
                (void)with(number, number.value + by);
                return true;
            } catch (const SceneError&) {
            }
        return false;
    }
};

VaryingScene varying(File file, std::vector<VariedNumber> numbers) {
    return {numbers, [file = std::move(file), numbers](std::size_t k, double by) {
                return file.with(numbers[k], numbers[k].value + by);
            }};
}

// Whether the number is a count, the steps of a branch, which has no derivative.
bool is_count(std::string_view path) {
    return path.starts_with("branches.") && path.ends_with(".steps");
}

// The group of a number: "bushings.mount" of "bushings.mount.rates.y".
std::string_view group(std::string_view path) {
    const auto dot = path.find('.');
    return path.substr(0, path.find('.', dot == path.npos ? dot : dot + 1));
}

// The wanted ones of all numbers. One that cannot be varied alone is joined with another that it can
// be varied together with: of its group and of its value.
std::vector<VariedNumber> joined(const File& file, std::vector<VariedNumber> numbers,
                                 std::vector<bool> wanted) {
    std::map<std::size_t, bool> known;
    const auto alone = [&](std::size_t k) {
        const auto [at, is_new] = known.try_emplace(k);
        if (is_new) at->second = file.accepts(numbers[k]);
        return at->second;
    };
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        if (!wanted[k] || alone(k)) continue;
        for (std::size_t l = 0; l < numbers.size(); ++l) {
            if (l == k || group(numbers[k].path) != group(numbers[l].path) ||
                numbers[k].value != numbers[l].value || alone(l))
                continue;
            const auto [first, second] = std::minmax(k, l);
            VariedNumber both = numbers[first];
            both.path += "," + numbers[second].path;
            if (!file.accepts(both)) continue;
            numbers[first] = std::move(both);
            wanted[first] = known[first] = known[second] = true;
            wanted[second] = false;
            break;
        }
    }
    std::vector<VariedNumber> list;
    for (std::size_t k = 0; k < numbers.size(); ++k)
        if (wanted[k]) list.push_back(std::move(numbers[k]));
    return list;
}

// A millimetre in each unit of length.
const std::map<std::string, double>& millimetre() {
    static const std::map<std::string, double> units{
        {"mm", 1}, {"m", 1e-3}, {"cm", 0.1}, {"in", 1 / 25.4}};
    return units;
}

}  // namespace

std::vector<std::string> paths_in(const std::string& joined) {
    std::vector<std::string> paths;
    for (std::size_t from = 0; from <= joined.size();) {
        const std::size_t end = std::min(joined.find(',', from), joined.size());
        paths.push_back(joined.substr(from, end - from));
        from = end + 1;
    }
    return paths;
}

VariedNumber varied_number(const Number& number) {
    VariedNumber varied{.path = number.path, .value = number.value, .unit = number.unit};
    if (const auto unit = millimetre().find(varied.unit); unit != millimetre().end()) {
        varied.step = unit->second;
        varied.step_name = "1 mm";
        return varied;
    }
    varied.step = varied.value != 0 ? std::abs(varied.value) / 100 : 1;
    if (varied.value == 0) varied.step_name = "1 unit";
    return varied;
}

double difference_step(const VariedNumber& number) {
    if (const auto unit = millimetre().find(number.unit); unit != millimetre().end())
        return 0.05 * unit->second;
    if (number.unit == "deg") return 0.05;
    const double scale = number.unit.empty() ? 10 : 100;  // of a weight or a direction; of a force
    return 1e-3 * (number.value != 0 ? std::abs(number.value) : scale);
}

VaryingScene varying(const std::filesystem::path& file, std::span<const Setting> settings,
                     std::span<const std::string> paths) {
    const File scene_file(file, settings);
    const Scene scene = scene_file.parsed->read(settings);
    std::vector<VariedNumber> numbers;
    for (const std::string& joined : paths) {
        for (const std::string& path : paths_in(joined))
            if (!find_number(scene, path)) {
                std::vector<std::string> names;
                for (const Number& number : scene.numbers) names.push_back(number.path);
                throw SceneError(fmt::format("{}: the scene has no number {}{}", scene.source,
                                             reader::quote(path),
                                             reader::did_you_mean(path, names, "there")));
            }
        numbers.push_back(varied_number(*find_number(scene, paths_in(joined).front())));
        numbers.back().path = joined;
    }
    return varying(scene_file, std::move(numbers));
}

VaryingScene varying(const std::filesystem::path& file, std::span<const Setting> settings,
                     const std::function<bool(const std::string& path)>& wanted) {
    std::vector<VariedNumber> numbers;
    std::vector<bool> chosen;
    File scene_file(file, settings);
    const Scene scene = scene_file.parsed->read(settings);
    for (const Number& number : scene.numbers) {
        numbers.push_back(varied_number(number));
        chosen.push_back(wanted ? wanted(number.path) : !is_count(number.path));
        for (const auto& [side, value] : number.sides)
            if (const std::string path = number.path + "@" + side; wanted && wanted(path)) {
                numbers.push_back(varied_number({path, value, number.unit, {}}));
                chosen.push_back(true);
            }
    }
    auto list = joined(scene_file, std::move(numbers), std::move(chosen));
    return varying(std::move(scene_file), std::move(list));
}

}  // namespace elastocheck::compare
