// Verdict in one sentence, the same on the terminal, on the page and in result.json.
#pragma once

#include <string>

#include "compare/candidate/judgement.hpp"

namespace elastocheck::reports {

std::string sentence(const compare::Assessment& judgement);

// The tolerance as text: "0.01 mm, 0.001 deg and 1 % of the extent of forces, moments and rates (the
// default)"; forces, moments and rates only if `others`, outputs that are neither positions nor
// angles, are judged; the default unless the user gave it.
std::string tolerance_text(const compare::Tolerance& tolerance, bool others, bool given);

// A deviation as text, with enough digits to differ from its limit; "nothing" for rounding.
std::string deviation_text(double value, double limit, const char* unit);

// "Not judged: the references disagree (and 2 reasons more)."
std::string not_judged(const std::vector<std::string>& reasons);

}  // namespace elastocheck::reports
