// Interval proofs as terminal text and as a part of result.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/proofs/certify.hpp"

namespace elastocheck::reports {

// "63 of 63 points proved: ..." or the missing proofs.
std::string sentence(const compare::CertifyStudy& study);

std::string certify_text(const compare::CertifyStudy& study);

// {tolerance, proved, points, says, ways}: the table of compare::certify_table.
nlohmann::ordered_json certify_json(const compare::CertifyStudy& study);

}  // namespace elastocheck::reports
