// A result document with every part, made quickly, to be damaged and drawn.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace elastocheck::reports {

// As a reader of result.json has it: NaN is null. Made once per scene.
const nlohmann::ordered_json& sample_result(const std::string& scene = "chrono_mcpherson");

}  // namespace elastocheck::reports
