// Sample result document with all parts, for tests of readers and pages.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace elastocheck::reports {

// As read from result.json: NaN is null. Made once per scene.
const nlohmann::ordered_json& sample_result(const std::string& scene = "chrono_mcpherson");

// Of a scene of this name, without studies and drawing: two figures.
nlohmann::ordered_json small_result(const std::string& name = "small");

// Without the studies and the judgement: trimmed and compared alone.
const nlohmann::ordered_json& compared_result(const std::string& scene);

}  // namespace elastocheck::reports
