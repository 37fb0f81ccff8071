// Study of the series over its order: number of expansions, cost and error.
#pragma once

#include <string>
#include <vector>

#include "compare/studies/solves.hpp"
#include "compare/studies/work_precision.hpp"
#include "elastocheck/model.hpp"
#include "recursive/series/path.hpp"

namespace elastocheck::compare {

struct OrderLevel {
    int order = 0;
    double tolerance = 0;  // given to the series [m]
    Outcome outcome = Outcome::converged;
    int expansions = 0, rejected = 0;
    Work work;
    double first_reach = 0;  // of the first expansion, as a share of the branch
    // to the first expansion; radius as a share of the branch
    recursive::series::Singularity nearest;
    double force = 0, error_end = 0;  // worst certificate: residual [N, N·m], error at an end [m]
    Accuracy error;  // to the equilibrium leg, over all points; NaN unless converged
};

struct BranchOrders {
    std::string branch;    // one side of it if it has two: "bounce to -80 mm"
    std::string failure;   // reason why the references failed, else empty
    Accuracy uncertainty;  // distance of the references
    std::vector<OrderLevel> levels;
};

struct OrderOptions {
    std::vector<int> orders{2, 4, 6, 8, 12, 16, 20, 24};
    std::vector<double> tolerances{1e-6, 1e-9, 1e-12};
    int points = 20;  // compared points per branch
    int threads = 1;
    Progress progress = {};
};

std::vector<BranchOrders> order_study(const Model& model, const OrderOptions& options = {});
// The same from shared solves. Pre: their base divides `points`.
std::vector<BranchOrders> order_study(Solves& solves, const OrderOptions& options);

// Whether every branch has a level with a finite error.
bool conclusive(const std::vector<BranchOrders>& orders);

}  // namespace elastocheck::compare
