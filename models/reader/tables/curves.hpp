// Reads laws of one deformation: a rate, or a curve.
#pragma once

#include "models/reader/definitions/definitions.hpp"
#include "models/reader/document/cursor.hpp"
#include "models/reader/tables/table.hpp"

namespace elastocheck::reader {

// f(x) = scale · t(x - offset), t the interpolant of the table or, if it is symmetric, of the table
// and its mirror image -t(-x).
Curve read_curve(const Cursor& field, const LawUnits& units, const Definitions& defs);

// The `rate` of an element or its `curve`.
ScalarLaw read_law(const Cursor& element, const LawUnits& units, const Definitions& defs);

// Law of a stop as a force over the deflection x from the design length. `rate` or `curve` are over the
// penetration s = -x - clearance (bump) or x - clearance (rebound) [N, m].
enum class Stop { bump, rebound };
Curve read_stop(const Cursor& field, Stop stop, const Definitions& defs);

// The unique deflection at which the law has this force [N]. `field` reports an error if there is
// none or several.
double deflection_at(const Cursor& field, const ScalarLaw& law, double force, const Unit& unit);

// The law of a spring with loose seats, which only pushes: zero beyond the deflection at which the given
// law is zero. `field` reports an error if there are several such deflections.
ScalarLaw pushing_only(const Cursor& field, const ScalarLaw& law, const Unit& unit);

}  // namespace elastocheck::reader
