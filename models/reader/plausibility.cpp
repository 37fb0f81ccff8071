#include "models/reader/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "models/kinds.hpp"
#include "models/laws.hpp"

namespace elastocheck::reader {
namespace {

using std::sqrt;

constexpr double largest_car = 20, smallest_car = 0.02;  // [m]
constexpr double smallest_bushing = 0.4e-3;              // [m]

std::string warning(const Cursor& field, const std::string& what) {
    return fmt::format("{}:{}: {}: {}", *field.file, field.value->line, field.path, what);
}

void check_size(const Cursor& scene, const Units& units, const Scene& read,
                std::vector<std::string>& warnings) {
    Vector3 low = Vector3::Constant(INFINITY), high = -low;
    for (const auto& point : read.hardpoints) {
        low = low.cwiseMin(point.position);
        high = high.cwiseMax(point.position);
    }
    const double extent = (high - low).maxCoeff();
    const bool is_huge = extent > largest_car,
               is_tiny = !read.wheels.empty() && extent > 0 && extent < smallest_car;
    if (!is_huge && !is_tiny) return;
    warnings.push_back(warning(
        scene.require("units").require("length"),
        fmt::format("the hardpoints extend over {:.3g} m, far from the size of a car; are they in "
                    "{}, not in {}?",
                    extent, units.length.name == "m" ? "mm" : "m", units.length.name)));
}

// df/dx at the design position [SI].
double rate_as_drawn(const ScalarLaw& law) {
    constexpr double small = 1e-5;  // [m], [rad]
    return (force(law, small) - force(law, -small)) / (2 * small);
}

struct Rates {
    double translational = 0, rotational = 0;  // the largest of each kind [N/m], [N·m/rad]
};
Rates rates_of(const SpatialLaw& law) {
    Rates rates;
    const auto add = [&](Eigen::Index k, double rate) {
        double& largest = k < 3 ? rates.translational : rates.rotational;
        largest = std::max(largest, rate);
    };
    std::visit(overloaded{[&](const LinearStiffness& u) {
                              for (Eigen::Index k = 0; k < 6; ++k) add(k, u.K(k, k));
                          },
                          [&](const PerAxis& u) {
                              for (std::size_t k = 0; k < 6; ++k)
                                  add(static_cast<Eigen::Index>(k), rate_as_drawn(u.axis[k]));
                          }},
               law);
    return rates;
}

void check_bushings(const Cursor& scene, const Units& units, const Scene& read,
                    std::vector<std::string>& warnings) {
    const auto section = scene.optional("bushings");
    if (!section) return;
    std::string first;
    int others = 0;
    for (const auto& [name, bushing] : section->entries()) {
        const auto element = std::ranges::find(read.elastics, name, &Elastic::name);
        if (element == read.elastics.end()) continue;
        const auto* law = member<SpatialLaw>(element->kind);
        if (law == nullptr) continue;
        const Rates rates = rates_of(*law);
        const double radius = sqrt(rates.rotational / rates.translational);
        if (!(rates.rotational > 0 && radius < smallest_bushing)) continue;
        if (!first.empty()) {
            ++others;
            continue;
        }
        const auto given = bushing.optional("rotational_rates");
        first = warning(
            given.value_or(bushing),
            fmt::format("{:.3g} {} beside {:.3g} {} is the rotational stiffness of a bushing "
                        "with a radius of {:.2g} mm; {}",
                        units.rotational_rate.written(rates.rotational), units.rotational_rate.name,
                        units.rate.written(rates.translational), units.rate.name, 1e3 * radius,
                        scene.require("units").optional("moment")
                            ? "is it in another unit of moment?"
                            : "`units` says no moment: is `moment: N·m` meant?"));
    }
    if (others > 0) first += fmt::format(" (and so of {} more)", others);
    if (!first.empty()) warnings.push_back(std::move(first));
}

// Plausible range of a length of a car [m].
struct Length {
    const char* field;
    double from, to;
};
constexpr Length lengths_of_vehicle[] = {{"wheelbase", 0.5, 10}, {"cg_height", 0.05, 4}};

void check_vehicle(const Cursor& scene, const Units& units, std::vector<std::string>& warnings) {
    const auto vehicle = scene.optional("vehicle");
    if (!vehicle) return;
    for (const auto& [field, from, to] : lengths_of_vehicle) {
        const Cursor given = vehicle->require(field);
        const double value = units.length.si(given.number());
        if (value >= from && value <= to) continue;
        warnings.push_back(warning(
            given,
            fmt::format("{:.6g} {}, expected {:g} to {:g} {}; `units` says that lengths are in {}",
                        given.number(), units.length.name, units.length.written(from),
                        units.length.written(to), units.length.name, units.length.name)));
    }
}

// The entry of this name under `static_loads` or `trim.under`; the section itself for a mirrored load.
Cursor place_of_load(const Cursor& scene, const std::string& name) {
    Cursor place = scene;
    if (const auto trim = scene.optional("trim"))
        if (const auto under = trim->optional("under"))
            place = under->optional(name).value_or(*under);
    if (const auto section = scene.optional("static_loads"))
        if (const auto own = section->optional(name)) return *own;
    return place;
}

// Plausible static vertical load on a wheel, gravity on its body not counted [N].
constexpr double lightest_wheel = 50, heaviest_wheel = 1e5;

void check_wheels(const Cursor& scene, const Units& units, const Scene& read,
                  std::vector<std::string>& warnings) {
    for (const Wheel& wheel : read.wheels) {
        // the rolling wheel's origin is its centre
        if (wheel.contact.s_local.z() > (wheel.rolls() ? 0 : wheel.centre_local.z())) {
            const Cursor section =
                wheel.name.empty() ? scene.require("wheel") : scene.require("wheels");
            warnings.push_back(
                warning(section.optional(wheel.name).value_or(section),
                        "the contact patch is above the wheel centre; does z point up?"));
            return;
        }
        double up = 0;
        std::string name;
        for (const Load& load : read.static_loads) {
            const Point* point = member<Point>(load.kind);
            if (point == nullptr || is_moment(load.kind) ||
                (point->body != wheel.body && point->body != wheel.contact.body) ||
                load.name.starts_with("gravity."))
                continue;
            up += load_vector(load.kind).z();
            name = load.name;
        }
        if (up == 0 || (up >= lightest_wheel && up <= heaviest_wheel)) continue;
        warnings.push_back(warning(
            place_of_load(scene, name),
            up < 0 ? fmt::format("the static load pulls wheel{} down with {:.6g} {}; the road "
                                 "pushes it up, which is +z",
                                 wheel.name.empty() ? "" : " '" + wheel.name + "'",
                                 units.force.written(-up), units.force.name)
                   : fmt::format("a static wheel load of {:.6g} N, plausible: {} to {} N; is it "
                                 "in another unit than {}?",
                                 up, lightest_wheel, heaviest_wheel, units.force.name)));
        return;  // one for all wheels
    }
}

}  // namespace

std::vector<std::string> implausible(const Cursor& scene, const Units& units, const Scene& read) {
    std::vector<std::string> warnings;
    check_size(scene, units, read, warnings);
    check_bushings(scene, units, read, warnings);
    check_vehicle(scene, units, warnings);
    check_wheels(scene, units, read, warnings);
    return warnings;
}

}  // namespace elastocheck::reader
