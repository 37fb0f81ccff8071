// The curves of a result.json as CSV, to plot again.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace elastocheck::reports {

// Every point of every leg, one number a row, since scenes differ in their outputs:
// scene,branch,leg,parameter,parameter unit,output,unit,value. Throws ResultError; `file` is where it
// was read.
// What is undefined is an empty cell.
std::string curves_csv(const nlohmann::ordered_json& result, const std::string& file);

// What elements and links bear at the ends of the branches: the table `forces` of every scene, with its name before.
std::string forces_csv(const nlohmann::ordered_json& result, const std::string& file);

}  // namespace elastocheck::reports
