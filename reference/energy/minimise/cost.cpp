#include "reference/energy/minimise/cost.hpp"

#include <algorithm>

namespace elastocheck::reference::energy {
namespace {

constexpr double doublings = 6;  // of the first stride to the span
// counted on the built-in scenes and on chains: 2 to 13
constexpr double evaluations_of_a_step = 6;
constexpr double states_of_a_step = 2.5;  // 2 to 5

}  // namespace

Cost cost_of(const Model& model, std::size_t values) {
    const double n = coordinates(model), m = std::min<double>(n, constraint_rows(model)), k = n - m;
    const double qr = 2 * m * m * (n - m / 3);
    const double slsqp =
        4.0 / 3 * (n * n * n - k * k * k) + 2 * m * (n * n - k * k) + 2 * k * k * (n - k / 3);
    const double q = 4 * (n * n * m - n * m * m + m * m * m / 3), across = 4 * n * n * m;
    const double along = m > 0 ? 2 * n * k * (n + k) : 0, modes = 9 * k * k * k;
    const double steps = static_cast<double>(values) + doublings;
    return {.evaluations = evaluations_of_a_step * steps,
            .states = states_of_a_step * steps,
            .per_evaluation = slsqp + qr,
            .per_state = qr + q + along + modes + across};
}

}  // namespace elastocheck::reference::energy
