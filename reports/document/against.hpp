// Two variants of a scene: what differs between their solved documents.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace elastocheck::reports {

// Adds "against" to the document of the base: the numbers of the variant's scene that differ, the
// outputs and K&C figures at the design position, and the main outputs over the branches that both
// have, at equal load or drive; all by the equilibrium leg. A swing arm is compared by its
// reciprocal. Throws ResultError for a document without curves or numbers.
void add_against(nlohmann::ordered_json& base, const nlohmann::ordered_json& variant);

// "B against A: 1 number of the scene and 31 figures at the design position differ, most bump_steer
// [deg/m] from -2.16 to 0.0812." Of a document with "against".
std::string against_sentence(const nlohmann::ordered_json& base);

}  // namespace elastocheck::reports
