#include "recursive/diagnosis/finite.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "recursive/linear_algebra/assembly.hpp"

namespace elastocheck::recursive {
namespace {

bool is_finite(const Row<double>& row) {
    return std::isfinite(row.on_i().norm()) && std::isfinite(row.on_j().norm()) &&
           std::isfinite(row.Phi);
}
bool is_finite(const ElasticKind& e, const Rest<double>& rest, const State<double>& q) {
    bool finite = deflections<double>(e, rest, q).allFinite() &&
                  element_stiffness<double>(e, rest, q).K.allFinite();
    each_point(e, [&](const auto& at) { finite &= q[at.body].lever(at.s_local).allFinite(); });
    return finite;
}

}  // namespace

std::string not_finite(const Model& model) {
    const State<double> q = design_state<double>(model);
    const Inputs<double> inputs = inputs_as_drawn<double>(model);
    std::vector<std::string> names;
    const auto add = [&](const std::string& kind, const std::string& name) {
        const std::string entry = kind + " '" + name + "'";
        if (std::ranges::find(names, entry) == names.end()) names.push_back(entry);
    };
    for (std::size_t c = 0; c < model.constraints.size(); ++c)
        rows<double>(model.constraints[c].kind, inputs.offset[c], q, [&](const Row<double>& row) {
            if (!is_finite(row))
                add("joint",
                    model.joints[static_cast<std::size_t>(model.constraints[c].joint)].name);
        });
    for (std::size_t e = 0; e < model.elastics.size(); ++e)
        if (!is_finite(model.elastics[e].kind, inputs.rest[e], q))
            add("element", model.elastics[e].name);
    std::string text;
    for (const auto& name : names)
        text += (text.empty() ? "a number of the model is not finite in " : ", ") + name;
    return text;
}

}  // namespace elastocheck::recursive
