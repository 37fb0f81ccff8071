// One table per study, from which text, CSV, JSON and HTML are rendered, so that all formats agree.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "compare/comparison/elements.hpp"
#include "compare/proofs/certify.hpp"
#include "compare/studies/findings.hpp"
#include "compare/studies/formulations.hpp"
#include "compare/studies/order_study.hpp"
#include "compare/studies/precision.hpp"
#include "compare/studies/study.hpp"
#include "compare/studies/work_precision.hpp"
#include "elastocheck/compare.hpp"

namespace elastocheck::compare {

using Cell = std::variant<double, std::string>;  // a missing number is NaN

struct Column {
    std::string name;
    // "" without a unit, or where it differs from row to row (given in a column `unit`)
    std::string unit = {};
    std::string description = {};
    bool words = false;  // its cells are texts, not numbers
};

struct Table {
    std::string name;  // "deviation", "curves", ...
    std::vector<Column> columns;
    std::vector<std::vector<Cell>> rows;  // one cell per column, of the column's kind
};

Table channel_table(const std::vector<Channel>& channels);  // definition and sign of every output
Table settled_table(const std::vector<Channel>& channels, const std::vector<Settled>& settled);
Table curve_table(const Comparison& comparison);      // every leg, branch and point, all channels
Table deviation_table(const Comparison& comparison);  // per branch, reading and channel
Table agreement_table(const Comparison& comparison);  // bounds and objections per branch
// Kinematics and compliance at the design position, with the error of the recursion; empty without
// a wheel.
Table characteristic_table(const Comparison& comparison);
// Compliance per branch, landmark, leg and point: one row per displacement component, one column
// per cause.
Table compliance_table(const Model& model, const Comparison& comparison);
Table rate_table(const std::vector<RateError>& errors);  // wheel rates
Table force_table(
    const std::vector<ElementValue>& values);  // elements and links at the ends of the branches
// Per branch and main output: the formulation spread beside the deviations in the same scene's
// comparison.
Table formulation_table(const FormulationStudy& study, const Comparison& comparison);
Table study_table(const Study& study);  // per branch side, method, reading and channel
Table step_table(const Study& study);   // ... and level
Table gap_table(const std::vector<Channel>& main,
                const std::vector<BranchAttribution>& attribution);
Table order_table(const std::vector<BranchOrders>& orders);
Table precision_table(const PrecisionStudy& study);
// step counts beyond which refinement gains nothing
Table floor_table(const PrecisionStudy& study);
Table trade_table(const Trade& trade);
Table certify_table(const CertifyStudy& study);  // per branch side and solver

}  // namespace elastocheck::compare
