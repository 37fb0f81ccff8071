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
bool is_finite(const AxialSpring& e, const Rest<double>& rest, const State<double>& q) {
    const Axial<double> g = deformation<double>(e, q);
    return std::isfinite(g.length) &&
           std::isfinite(hessian<double>(e.law, [&] { return g.length - rest.free_length; }));
}
bool is_finite(const Bushing& e, const Rest<double>&, const State<double>& q) {
    const Spatial<double> g = deformation<double>(e, q);
    const Vector6<double> deformed = strain<double>(e, g);
    return deformed.allFinite() && axes<double>(e, q).allFinite() &&
           hessian<double>(e.law, [&] { return deformed; }).allFinite();
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
        std::visit(
            [&](const auto& e) {
                if (!q[e.i.body].lever(e.i.s_local).allFinite() ||
                    !q[e.j.body].lever(e.j.s_local).allFinite() ||
                    !is_finite(e, inputs.rest[at], q))
                    name("element", model.elastics[at].name);
            },
            model.elastics[at].kind);
    std::string all;
    for (const auto& one : names)
        all += (all.empty() ? "as drawn a number is not finite in " : ", ") + one;
    return all;
}

}  // namespace elastocheck::recursive
