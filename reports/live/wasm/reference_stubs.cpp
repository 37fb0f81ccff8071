// Stubs for the live page, which contains neither of the two references. A call of a reference throws;
// processor_time() returns 0, since the page shows no computing times.
#include <stdexcept>

#include "compare/jobs/jobs.hpp"
#include "elastocheck/energy.hpp"
#include "elastocheck/equilibrium.hpp"
#include "reference/energy/linear_response.hpp"
#include "reference/equilibrium/linear_response.hpp"

namespace elastocheck {
namespace {
[[noreturn]] void throw_absent(const char* leg) {
    throw std::logic_error(std::string(leg) + " is not part of a live page");
}
}  // namespace

namespace reference::equilibrium {
EquilibriumPath solve(const Model&, const Branch&, std::span<const double>, const Options&,
                      const PointVisitor&) {
    throw_absent("the equilibrium leg");
}
Residuals residuals(const Model&, const Branch&, const Equilibrium&) {
    throw_absent("the equilibrium leg");
}
Response linear_response(const Model&, const Branch&, const Equilibrium&,
                         std::span<const Disturbance>, std::shared_ptr<const Orders>*) {
    throw_absent("the equilibrium leg");
}
}  // namespace reference::equilibrium

namespace reference::energy {
EquilibriumPath solve(const Model&, const Branch&, std::span<const double>, const Options&,
                      const PointVisitor&) {
    throw_absent("the energy leg");
}
Residuals residuals(const Model&, const Branch&, const Equilibrium&) {
    throw_absent("the energy leg");
}
Response linear_response(const Model&, const Branch&, const Equilibrium&,
                         std::span<const Disturbance>) {
    throw_absent("the energy leg");
}
}  // namespace reference::energy

namespace compare {
double processor_time() { return 0; }
}  // namespace compare
}  // namespace elastocheck
