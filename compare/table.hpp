// One table a study: what text, CSV, JSON and the page are rendered from, so that no format says anything
// else.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "compare/certify.hpp"
#include "compare/compare.hpp"
#include "compare/elements.hpp"
#include "compare/findings.hpp"
#include "compare/formulations.hpp"
#include "compare/order_study.hpp"
#include "compare/precision.hpp"
#include "compare/study.hpp"
#include "compare/trade.hpp"

namespace elastocheck::compare {

using Cell = std::variant<double, std::string>;  // a number that is not there is NaN

struct Column {
    std::string name;
    std::string unit = {};  // "" where it differs from row to row (then a column `unit` says it) or has none
    std::string description = {};
    bool words = false;  // its cells are texts, else numbers
};

struct Table {
    std::string name;  // "deviation", "curves", ...
    std::vector<Column> columns;
    std::vector<std::vector<Cell>> rows;  // as many cells as columns, each of its column's kind
};

Table channel_table(const std::vector<Channel>& channels);  // what every output is, with its sign
Table settled_table(const std::vector<Channel>& channels, const std::vector<Settled>& settled);
Table curve_table(const Comparison& comparison);      // every leg, branch and point, all channels
Table deviation_table(const Comparison& comparison);  // per branch, reading and channel
Table agreement_table(const Comparison& comparison);  // bounds and objections per branch
// Kinematics and compliance at the design position, each with the error of the recursion; empty without a wheel.
Table characteristic_table(const Comparison& comparison);
// How far the wheels give, per branch, landmark, leg and point: a row each component of the answer, a column each of what acts.
Table compliance_table(const Model& model, const Comparison& comparison);
Table rate_table(const std::vector<RateError>& errors);  // wheel rates
Table force_table(
    const std::vector<ElementValue>& values);  // of elements and links at the ends of the branches
// Per branch and main output: the spread beside what it is to be read against; of the same scene's comparison.
Table formulation_table(const FormulationStudy& study, const Comparison& comparison);
Table study_table(const Study& study);  // per way, method, reading and channel
Table step_table(const Study& study);   // ... and level
Table gap_table(const std::vector<Channel>& main, const std::vector<BranchAttribution>& attribution);
Table order_table(const std::vector<BranchOrders>& orders);
Table precision_table(const PrecisionStudy& study);
Table floor_table(const PrecisionStudy& study);  // where more steps stop helping
Table trade_table(const Trade& trade);
Table certify_table(const CertifyStudy& study);  // per way and solver

}  // namespace elastocheck::compare
