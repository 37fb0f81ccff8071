#include "reports/command/options/gradients_of.hpp"

#include <optional>
#include <utility>

#include "elastocheck/read_scene.hpp"

namespace elastocheck::reports {

compare::Gradients gradients_of(const std::string& file, const Settings& settings,
                                const LoadedScene& loaded,
                                std::span<const compare::Channel> outputs,
                                std::vector<ModelRate> rates, compare::GradientOptions options) {
    std::vector<compare::VariedNumber> numbers;
    for (const ModelRate& rate : rates)
        numbers.push_back(compare::varied_number(rate, loaded.scene.numbers));
    std::optional<compare::TrimRates> trim;
    if (loaded.trim) {
        trim = compare::trim_rates(read_scene(file, settings), {loaded.scene, loaded.trim}, rates);
        rates = trim->numbers;
        options.trim = &*trim;
    }
    return compare::gradients(loaded.model, outputs, numbers, rates, options);
}

}  // namespace elastocheck::reports
