// Compliance matrices of the wheels for a live page, as a report has them.
#pragma once

#include "reports/live/engine.hpp"

namespace elastocheck::live {

// Matrices at the start of the first branch, jacks and tyres removed. Throws as prepared(). The answer:
//   why_not  reason why there are none; else absent
//   causes   names of the columns, wheel by wheel
//   centre, patch   rows: name, values [mm or deg per kN or per 100 N·m]; of the wheel centre, and of
//                   the contact patch
nlohmann::ordered_json compliance(Session& session, const std::vector<Setting>& settings);

}  // namespace elastocheck::live
