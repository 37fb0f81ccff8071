// Studies of `elastocheck converge`: methods of the recursion over their steps, the series over its
// order, a candidate over its steps.
#pragma once

#include <optional>
#include <vector>

#include "compare/studies/order_study.hpp"
#include "compare/studies/study.hpp"

namespace elastocheck::compare {

struct ConvergenceStudies {
    std::optional<Study> methods{};
    std::vector<BranchAttribution> attribution{};  // of their gap
    std::vector<BranchOrders> orders{};
    std::optional<Study> candidate{};
};

struct Result;
Result result_of(const Model& model, const ConvergenceStudies& studies);  // compare/tables/

}  // namespace elastocheck::compare
