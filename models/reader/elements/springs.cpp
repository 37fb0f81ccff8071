// Reads springs between two points and their stops.
#include <fmt/format.h>

#include <array>
#include <utility>

#include "models/reader/elements/sections.hpp"
#include "models/reader/tables/curves.hpp"
#include "models/reader/tables/table.hpp"

namespace elastocheck::reader {
namespace {

// Reads the two ends as a spring that is free at the design length.
AxialSpring read_ends(const Cursor& field, const Definitions& defs) {
    const auto [i, j, length] = between(field, defs, "a spring");
    return {.i = i, .j = j, .law = {}, .free_length = length};
}

// ℓ₀ [m]. At the design length ℓ the deflection is x = ℓ - ℓ₀.
double free_length(const Cursor& spring, double length, const ScalarLaw& law,
                   const Definitions& defs) {
    const Units& units = defs.units;
    const auto given = spring.optional("free_length");
    const auto preload = spring.optional("preload");
    if (given && preload) preload->fail("given together with free_length; allowed: one of the two");
    if (given) return above_zero(*given, "not a length", units.length);
    if (!preload) {
        const auto curve = spring.optional("curve");
        const auto of_file = curve ? free_length_of_file(*curve, defs) : std::nullopt;
        return of_file ? *of_file : length;
    }
    // a preload p is positive in compression: f(x) = -p; 0 - p is 0, not -0, for 0
    const double p = units.force.si(preload->number(units.force.name));
    const double l0 = length - deflection_at(*preload, law, 0 - p, units.force);
    if (!(l0 > 0))
        preload->fail(
            fmt::format("needs a free length of {:g} {}; a free length must be above zero",
                        units.length.written(l0), units.length.name));
    return l0;
}

using StopFields = std::array<std::pair<const char*, Stop>, 2>;

// Appends the stops given in these fields, with the names "NAME.FIELD".
void add_stops(const std::string& name, const Cursor& spring, const AxialSpring& ends,
               const StopFields& fields, const Definitions& defs, std::vector<Elastic>& list) {
    for (const auto& [field, kind] : fields)
        if (const auto stop = spring.optional(field)) {
            AxialSpring element = ends;
            element.law = read_stop(*stop, kind, defs);
            list.push_back({name + "." + field, element, false, WrittenAs::stop});
        }
}

}  // namespace

std::vector<Elastic> read_spring(const std::string& name, const Cursor& field,
                                 const Definitions& defs, const std::vector<Wheel>& wheels) {
    if (const auto at_wheel = read_at_wheel(name, field, defs, wheels)) return {*at_wheel};
    field.only_keys({"bodies", "from", "to", "rate", "curve", "free_length", "preload", "seats",
                     "bump_stop", "rebound_stop", "at_wheel"});
    const AxialSpring ends = read_ends(field, defs);
    AxialSpring spring = ends;
    spring.law = read_law(field, of_springs(defs.units), defs);
    spring.free_length = free_length(field, ends.free_length, spring.law, defs);
    if (const auto seats = field.optional("seats");
        seats && seats->one_of("a kind of seats", {"fixed", "free"}) == 1)
        spring.law = pushing_only(*seats, spring.law, defs.units.force);
    std::vector<Elastic> result{{name, spring}};
    add_stops(name, field, ends, {{{"bump_stop", Stop::bump}, {"rebound_stop", Stop::rebound}}},
              defs, result);
    return result;
}

std::vector<Elastic> read_stops(const std::string& name, const Cursor& field,
                                const Definitions& defs) {
    field.only_keys({"bodies", "from", "to", "bump", "rebound"});
    std::vector<Elastic> result;
    add_stops(name, field, read_ends(field, defs),
              {{{"bump", Stop::bump}, {"rebound", Stop::rebound}}}, defs, result);
    if (result.empty()) field.fail("no stop; required: bump or rebound");
    return result;
}

}  // namespace elastocheck::reader
