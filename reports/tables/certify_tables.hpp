// Interval proofs as terminal text and as a part of result.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/proofs/certify.hpp"

namespace elastocheck::reports {

// Statement and limits of the proofs in one paragraph, for text and page.
std::string what_is_proved(const compare::CertifyStudy& study);

// "63 of 63 points proved: ..." or the missing proofs.
std::string sentence(const compare::CertifyStudy& study);

std::string certify_text(const compare::CertifyStudy& study);

// {tolerance, proved, points, says, ways}: the table of compare::certify_table.
nlohmann::ordered_json certify_json(const compare::CertifyStudy& study);

}  // namespace elastocheck::reports
