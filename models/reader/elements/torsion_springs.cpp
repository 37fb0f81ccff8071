#include "models/kinds.hpp"
#include "models/reader/elements/sections.hpp"
#include "models/reader/tables/curves.hpp"

namespace elastocheck::reader {
namespace {

// The law of θ_z alone.
SpatialLaw about_z(const ScalarLaw& law) {
    if (const double* rate = rate_of(law)) {
        LinearStiffness stiffness;
        stiffness.K(5, 5) = *rate;
        return stiffness;
    }
    PerAxis axes;
    axes.axis[5] = law;
    return axes;
}

}  // namespace

// A bushing with z along the axis that resists only θ_z; its x and y are arbitrary.
Elastic read_torsion_spring(const std::string& name, const Cursor& field, const Definitions& defs) {
    field.only_keys({"bodies", "at", "axis", "rate", "curve", "preload_moment"});
    const auto [i, j] = body_pair(field.require("bodies"), defs);
    const Vector3 p = hardpoint(field.require("at"), defs),
                  z = direction(field.require("axis"), defs);
    Matrix3 frame;
    frame.col(2) = z;
    frame.col(0) = z.unitOrthogonal();
    frame.col(1) = z.cross(frame.col(0));
    Bushing spring{.i = marker_of(i, p, frame, defs),
                   .j = marker_of(j, p, frame, defs),
                   .law = about_z(read_law(field, of_angles(defs.units), defs))};
    if (const auto moment = field.optional("preload_moment"))
        spring.preload[5] = defs.units.moment.si(moment->number(defs.units.moment.name));
    return {name, spring, false, WrittenAs::torsion_spring};
}

}  // namespace elastocheck::reader
