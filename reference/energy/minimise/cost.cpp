#include "reference/energy/minimise/cost.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "reference/energy/constraints/quadratic.hpp"

namespace elastocheck::reference::energy {
namespace {

constexpr double doublings = 6;  // of the first stride to the span
// counted on the built-in scenes and on chains: 2 to 13
constexpr double evaluations_of_a_step = 6;
constexpr double states_of_a_step = 2.5;  // 2 to 5
constexpr double by_body = 3e4;           // counted on chains of a large number of bodies
constexpr double applications = 100;      // of a factor: modes, corrections

// For a large model. A state takes a share proportional to the bodies, and a factor whose columns
// have c bodies below the diagonal, found as that of the graph of bodies: 2 (6 c)² operations for each of six
// columns, and 4 · 36 c for each column to which it is applied.
double sparse_state(const Model& model) {
    const Chart design = chart_about(design_poses(model));
    const Prescribed nothing = nothing_prescribed(model);
    const int bodies = coordinates(model) / 6;
    std::vector<Eigen::Triplet<double>> at_rows, pairs;
    for (const auto& slope : constraints(model, nothing, design).Phi_q.slopes)
        at_rows.emplace_back(slope.row, slope.body, 1);
    for (const auto& block : stiffness(model, nothing, design).blocks)
        pairs.emplace_back(block.row / 6, block.column / 6, 1);
    Sparse rows(constraint_rows(model), bodies), graph(bodies, bodies);
    rows.setFromTriplets(at_rows.begin(), at_rows.end());
    graph.setFromTriplets(pairs.begin(), pairs.end());
    graph += Sparse(rows.transpose() * rows);
    Eigen::SimplicialLDLT<Sparse> factor;
    factor.analyzePattern(graph);
    factor.factorize(graph);
    const Sparse L = factor.matrixL().nestedExpression();
    double operations = by_body * bodies;
    for (int column = 0; column < bodies; ++column) {
        const double c =
            1 + static_cast<double>(L.outerIndexPtr()[column + 1] - L.outerIndexPtr()[column]);
        operations += 6 * 2 * 36 * c * c + applications * 4 * 36 * c;
    }
    return operations;
}

double steps_to(std::size_t values) { return static_cast<double>(values) + doublings; }

}  // namespace

Cost cost_of(const Model& model, std::size_t values) {
    if (!is_large(model)) return dense_cost(model, values);
    return {.states = states_of_a_step * steps_to(values), .per_state = sparse_state(model)};
}

Cost dense_cost(const Model& model, std::size_t values) {
    const double steps = steps_to(values);
    const double n = coordinates(model), m = std::min<double>(n, constraint_rows(model)), k = n - m;
    const double qr = 2 * m * m * (n - m / 3);
    const double slsqp =
        4.0 / 3 * (n * n * n - k * k * k) + 2 * m * (n * n - k * k) + 2 * k * k * (n - k / 3);
    const double q = 4 * (n * n * m - n * m * m + m * m * m / 3), across = 4 * n * n * m;
    const double along = m > 0 ? 2 * n * k * (n + k) : 0, modes = 9 * k * k * k;
    return {.evaluations = evaluations_of_a_step * steps,
            .states = states_of_a_step * steps,
            .per_evaluation = slsqp + qr,
            .per_state = qr + q + along + modes + across};
}

}  // namespace elastocheck::reference::energy
