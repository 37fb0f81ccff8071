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
    const auto name = [&](const std::string& kind, const std::string& who) {
        const std::string entry = kind + " '" + who + "'";
        if (std::ranges::find(names, entry) == names.end()) names.push_back(entry);
    };
    for (std::size_t c = 0; c < model.constraints.size(); ++c)
        rows<double>(model.constraints[c].kind, inputs.offset[c], q, [&](const Row<double>& row) {
            if (!is_finite(row))
                name("joint",
                     model.joints[static_cast<std::size_t>(model.constraints[c].joint)].name);
        });
    for (std::size_t at = 0; at < model.elastics.size(); ++at)
        if (!is_finite(model.elastics[at].kind, inputs.rest[at], q))
            name("element", model.elastics[at].name);
    std::string all;
    for (const auto& one : names)
        all += (all.empty() ? "a number of the model is not finite in " : ", ") + one;
    return all;
}

}  // namespace elastocheck::recursive
