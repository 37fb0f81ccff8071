// Functions that the sources refer to and that are not part of the page: the two references, and the clock of the
// processor. The page calls none of them; a call of a reference throws.
#include <stdexcept>

#include "compare/jobs/jobs.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "reference/energy/linear_response.hpp"
#include "reference/equilibrium/linear_response.hpp"

namespace elastocheck {
namespace {
[[noreturn]] void absent(const char* what) {
    throw std::logic_error(std::string(what) + " is not part of a live page");
}
}  // namespace

namespace reference::equilibrium {
EquilibriumPath solve(const Model&, const Branch&, std::span<const double>, const Options&,
                      const PointVisitor&) {
    absent("the equilibrium leg");
}
Residuals residuals(const Model&, const Branch&, const Equilibrium&) {
    absent("the equilibrium leg");
}
Response linear_response(const Model&, const Branch&, const Equilibrium&,
                         std::span<const Disturbance>, std::shared_ptr<const Orders>*) {
    absent("the equilibrium leg");
}
}  // namespace reference::equilibrium

namespace reference::energy {
EquilibriumPath solve(const Model&, const Branch&, std::span<const double>, const Options&,
                      const PointVisitor&) {
    absent("the energy leg");
}
Residuals residuals(const Model&, const Branch&, const Equilibrium&) { absent("the energy leg"); }
Response linear_response(const Model&, const Branch&, const Equilibrium&,
                         std::span<const Disturbance>) {
    absent("the energy leg");
}
}  // namespace reference::energy

namespace compare {
double processor_time() { return 0; }
}  // namespace compare
}  // namespace elastocheck
