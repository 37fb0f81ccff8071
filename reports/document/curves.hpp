// Curves of a result.json as CSV.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace elastocheck::reports {

// Every point of every leg, one number per row, since scenes differ in their outputs:
// scene,branch,leg,parameter,parameter unit,output,unit,value. An undefined value is an empty cell.
// Throws ResultError; `file` is the source of the document.
std::string curves_csv(const nlohmann::ordered_json& result, const std::string& file);

// Forces of elements and links at the ends of the branches: the table `forces` of every scene, with
// the scene's name first.
std::string forces_csv(const nlohmann::ordered_json& result, const std::string& file);

}  // namespace elastocheck::reports
