#include "compare/variants/variant_figure.hpp"

#include <stdexcept>
#include <utility>

#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/definitions/figure_words.hpp"
#include "compare/outputs/not_a_number.hpp"

namespace elastocheck::compare::variants {
namespace {

// Whether redundant joints share this reaction at the design position.
bool is_shared(const Channel& output, const Model& model, const Branch& branch) {
    if (output.joints().empty()) return false;
    Analyses analyses;
    return evaluate(model, sides_of(model, branch).front(), std::span(&output, 1),
                    design_state(model), analyses)
               .front() == undefined;
}

}  // namespace

VariantFigure parse_variant_figure(const std::string& name, std::string words, const Model& model,
                                   std::span<const Channel> outputs) {
    VariantFigure figure{.name = name, .output = {}, .branch = {}};
    for (const auto& [word, over] :
         {std::pair("min ", Over::least), std::pair("max ", Over::largest)})
        if (words.starts_with(word)) figure.over = over, words.erase(0, 4);
    const FigureWords parsed = parse_figure_words(words, model, outputs);
    if (parsed.station.at && figure.over != Over::station)
        throw std::invalid_argument(
            "an extreme is that of the whole branch; allowed: min OUTPUT@BRANCH");
    figure.output = parsed.output->name, figure.unit = parsed.output->unit;
    figure.branch = parsed.station.branch->name;
    figure.at = parsed.station.at.value_or(0);
    if (is_shared(*parsed.output, model, *parsed.station.branch))
        throw std::invalid_argument(figure.output + ": " + why_undefined(*parsed.output));
    return figure;
}

}  // namespace elastocheck::compare::variants
