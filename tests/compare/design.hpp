// Figures in closed form and of scenes, for the tests of compare/design/.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "compare/design/figures.hpp"
#include "elastocheck/read_scene.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::compare {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

inline Eigen::VectorXd list_of(std::initializer_list<double> values) {
    Eigen::VectorXd v(std::ssize(values));
    std::ranges::copy(values, v.begin());
    return v;
}

// Of numbers of the size of one.
inline Figures closed(std::function<Eigen::VectorXd(const Eigen::VectorXd&)> value,
                      Eigen::Index numbers) {
    return {[value = std::move(value)](const std::vector<Eigen::VectorXd>& points) {
                std::vector<Eigen::VectorXd> all;
                for (const auto& p : points) all.push_back(value(p));
                return all;
            },
            Eigen::VectorXd::Constant(numbers, 1e-3)};
}

// Numbers of a scene without limits.
inline Varied varied_of(const std::function<Scene(std::span<const Setting>)>& scene,
                        const std::vector<std::string>& paths) {
    Varied all;
    const auto n = std::ssize(paths);
    all.start.resize(n);
    all.low = Eigen::VectorXd::Constant(n, -infinity);
    all.high = -all.low;
    for (Eigen::Index k = 0; k < n; ++k) {
        all.numbers.push_back(find_number(scene({}), paths[static_cast<std::size_t>(k)]).value());
        all.start[k] = all.numbers.back().value;
    }
    all.scene = [scene, paths](const Eigen::VectorXd& p) {
        std::vector<Setting> settings;
        for (std::size_t k = 0; k < paths.size(); ++k)
            settings.push_back(setting(paths[k], p[static_cast<Eigen::Index>(k)]));
        return scene(settings);
    };
    return all;
}
inline Varied varied_of(const std::string& name, const std::vector<std::string>& paths,
                        Eigen::VectorXd low = {}, Eigen::VectorXd high = {}) {
    Varied all =
        varied_of([file = std::string(ELASTOCHECK_SCENES "/") + name + ".yaml"](
                      std::span<const Setting> settings) { return read_scene(file, settings); },
                  paths);
    if (low.size() > 0) {
        all.low = low;
        all.high = high;
    }
    return all;
}

}  // namespace elastocheck::compare
