// Other definitions of kinematic figures, as other tools and standards have them.
//
// The definition of an output of channels() or characteristics() is the project's own, one each
// (include/elastocheck/channels.hpp). Each entry here defines one of these figures otherwise: it is
// an output of its own, "camber@kingpin", computed from the same state.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "elastocheck/channels.hpp"

namespace elastocheck::compare {

struct Definition {
    const char* figure;  // the output that it defines otherwise: "camber"
    const char* name;    // after "@": "kingpin"
    Unit unit;
    const char* formula;  // one line, with the sign
    const char* used_by;  // where it is found; names for it elsewhere
    // SI; `undefined` where the scene has no such part. `wheel`: position in Model::wheels.
    double (*value)(const Model& model, std::size_t wheel, const Equilibrium& state);
    bool of_axle = false;  // of both wheels together, not of each
};
std::span<const Definition> definitions();

// An output per definition and wheel that has a value in the design position, "left.camber@kingpin";
// figures of an axle once, without the name of a wheel. None of them is a main output.
std::vector<Channel> definition_channels(const Model& model);

// The outputs among them that define `figure`, "left.camber", otherwise.
std::vector<Channel> definitions_of(std::span<const Channel> defined, const std::string& figure);

}  // namespace elastocheck::compare
