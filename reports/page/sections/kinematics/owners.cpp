// The outputs of a quantity, and which wheel a spring, damper or stop belongs to, by its name.
#include <algorithm>
#include <iterator>
#include <sstream>

#include "reports/page/sections/kinematics/cases.hpp"

namespace elastocheck::reports {
namespace {

std::vector<std::string> words_in(std::string name) {
    std::ranges::replace_if(
        name, [](char c) { return c == '_' || c == '.' || c == '-'; }, ' ');
    std::istringstream in(name);
    return {std::istream_iterator<std::string>(in), {}};
}

}  // namespace

std::optional<std::pair<std::string, std::size_t>> wheel_of(const std::string& owner,
                                                            const std::vector<Wheel>& wheels) {
    std::optional<std::size_t> wheel;
    if (wheels.size() == 1) wheel = 0;
    std::string others;
    for (const auto& word : words_in(owner)) {
        std::vector<std::size_t> with;
        for (std::size_t w = 0; w < wheels.size(); ++w) {
            const auto own = words_in(wheels[w].name);
            if (std::ranges::find(own, word) != own.end()) with.push_back(w);
        }
        if (with.size() != 1) {
            others += (others.empty() ? "" : " ") + word;
            continue;
        }
        if (wheel && *wheel != with[0]) return std::nullopt;
        wheel = with[0];
    }
    if (!wheel) return std::nullopt;
    return std::pair{others, *wheel};
}

std::vector<FoundOutput> outputs_of(const SceneAnalyses& scene, const std::string& quantity) {
    const auto& channels = scene.comparison.channels;
    const auto& wheels = scene.model.wheels;
    std::vector<FoundOutput> outputs;
    const auto add = [&](const std::string& name, const Wheel& wheel, bool of_all) {
        if (const int c = compare::find_channel(channels, name); c >= 0)
            outputs.push_back({.channel = name,
                               .unit = symbol(channels[static_cast<std::size_t>(c)].unit),
                               .wheel = wheel,
                               .of_all = of_all});
    };
    for (const auto& wheel : wheels) add(output_of(wheel, quantity), wheel, false);
    if (outputs.empty()) add(quantity, wheels.empty() ? Wheel{} : wheels[0], true);
    if (!outputs.empty() || wheels.empty()) return outputs;
    for (const auto& channel : channels) {
        if (!compare::is_figure(channel, quantity)) continue;
        const std::string owner = channel.name.substr(0, channel.name.rfind('.'));
        const auto found = wheel_of(owner, wheels);
        add(channel.name, wheels[found ? found->second : 0], !found);
        outputs.back().element = found ? found->first : as_words(owner);
    }
    return outputs;
}

}  // namespace elastocheck::reports
