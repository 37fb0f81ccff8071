// Lists in a field: one name, several names, or names with a number each.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "models/reader/definitions/definitions.hpp"
#include "models/reader/document/cursor.hpp"

namespace elastocheck::reader {

struct Term {
    std::string name;
    Cursor at;                // the number, or the name itself
    bool has_number = false;  // else the number is 1

    double number(const std::string& unit = "") const { return has_number ? at.number(unit) : 1; }
};

// A name, a list of names or a map of names to numbers, without repeats. `quantity` is what the names
// denote, "a load", for errors.
std::vector<Term> terms(const Cursor& field, const std::string& quantity);

// The section `loads`, numbers as written.
using Loads = std::map<std::string, Load>;
const Load& look_up_load(const Term& term, const Loads& loads);

// The constant value of a load: a force, or a moment for a moment load [N, N·m].
double held_value(const Term& term, const Load& load, const Units& units);

}  // namespace elastocheck::reader
