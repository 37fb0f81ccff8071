// Other definitions of kinematic figures, as other tools and standards have them.
//
// The definition of an output of channels() or characteristics() is the project's own, one each
// (include/elastocheck/channels.hpp). Each entry here defines one of these figures otherwise: it is
// an output of its own, "camber@kingpin", computed from the same state.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "elastocheck/channels.hpp"

namespace elastocheck::compare {

struct Definition {
    std::string figure;  // the output that it defines otherwise: "camber"
    std::string name;    // after "@": "kingpin"
    Unit unit;
    const char* formula;  // one line, with the sign
    const char* used_by;  // where it is found; names for it elsewhere
};
// Those of a state, then the rates (rates.cpp).
std::vector<Definition> definitions();

// Definitions by the name of a standard or a way of drawing, for scenes that ask for them.
struct DefinitionSet {
    std::string name;                  // "sae"
    const char* source;                // what they have in common, and where it is defined
    std::vector<std::string> members;  // "scrub_radius@ground_axes"
};
std::vector<DefinitionSet> definition_sets();

// An output per definition and wheel that has a value in the design position, "left.camber@kingpin";
// figures of an axle once, without the name of a wheel. None of them is a main output.
std::vector<Channel> definition_channels(const Model& model);

// "camber" of "left.camber@kingpin" and of "left.camber".
std::string figure_of(std::string_view output);

// The outputs among them that define `figure`, "left.camber", otherwise.
std::vector<Channel> definitions_of(std::span<const Channel> defined, const std::string& figure);

}  // namespace elastocheck::compare
