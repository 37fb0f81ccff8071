// The list of what is drawn of a suspension, by the report's fixed views, its turned view
// and the live page: points, lines and labels at the design position, and their positions
// along every branch.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/comparison/compare.hpp"
#include "elastocheck/model.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::reports {

using Position = std::array<double, 3>;  // x forward, y left, z up: a point [mm], or a unit vector

struct Drawing {
    struct Point {  // an attachment of a joint, element, wheel or probe
        std::string name, body;
        bool hardpoint = false;  // else named after the joint or element there
        Position at{};
    };
    struct Link {
        std::string kind;  // body, rod, spring, stop, beam, damper
        std::string name;
        std::size_t i = 0, j = 0;  // indices of points
    };
    struct Face {  // a body's coplanar points, in order along their outline: an arm
        std::string body;
        std::vector<std::size_t> points;
    };
    struct Symbol {
        std::string kind;  // spherical, revolute, universal, sliding, plane, fixed, bushing, drive
        std::string name;
        std::optional<std::size_t> point;  // its index; empty: no point there
        Position at{};
        std::optional<Position> axis{};
    };
    struct Wheel {
        std::string name;
        std::size_t centre = 0, patch = 0;  // indices of points
        Position spin_axis{};               // unit vector
    };
    struct Placed {
        std::vector<Position> points{};
        std::vector<std::vector<Position>> rims{};  // of the wheels
    };
    // By the equilibrium leg, at the middle and the ends of every branch.
    struct Station : Placed {
        std::string side, branch;  // "travel to -80 mm", of the branch "travel"
        std::string unit;
        bool end = false;
        double a = 0;  // parameter, in `unit`
    };
    // At up to 17 stations of the equilibrium leg; rounded, since they are only drawn.
    struct Motion {
        std::string branch, unit;
        std::vector<double> a{};  // parameters, in `unit`
        // per station: coordinates of all points one after the other [mm], spin axes of the wheels
        std::vector<std::vector<double>> points{}, axes{};
    };
    std::vector<Point> points{};
    std::vector<Link> links{};
    std::vector<Face> faces{};
    std::vector<Symbol> symbols{};
    std::vector<Wheel> wheels{};
    Placed design{};
    std::vector<Station> stations{};
    std::vector<Motion> motion{};
};

Drawing drawing_of(const Scene& scene, const Model& model, const compare::Comparison& comparison);

// The same in result.json and for the scripts of the pages.
nlohmann::ordered_json drawing_json(const Drawing& drawing);

}  // namespace elastocheck::reports
