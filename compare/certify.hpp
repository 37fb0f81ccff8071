// What of a path is proved (reference/certificate), point by point and as one curve.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/legs.hpp"
#include "compare/proof.hpp"
#include "compare/trade.hpp"
#include "models/equilibrium_path.hpp"
#include "models/model.hpp"
#include "reference/certificate/certificate.hpp"

namespace elastocheck::compare {

using reference::certificate::LimitPoint;
using reference::certificate::Tube;

// What is claimed where nobody says otherwise.
inline constexpr const char* claimed_accuracy = "1e-6mm,1e-6deg";
// "1e-8mm": what is not said is as above. Throws std::invalid_argument as parse_tolerance does.
Tolerance claim(std::string_view text);

// One solver along one way of a branch.
struct CertifiedWay {
    std::string branch;        // the name of the way
    Unit unit = Unit::newton;  // of its parameter
    double to = 0;             // where the way ends, in that unit
    std::string solver;        // "equilibrium", "energy", or a method of the recursion
    Outcome outcome = Outcome::converged;
    std::string detail = {};
    Tally tally = {};
    std::optional<Tube> curve = {};        // of the equilibrium leg
    std::optional<LimitPoint> limit = {};  // where the path ends in one
};

struct CertifyOptions {
    std::vector<Gait> solvers;  // empty: both references and the series
    Tolerance tolerance;
    int points = 20;  // of a way, at least, where it has as many steps; the start besides
    std::function<void(std::string_view)> progress = {};
};

struct CertifyStudy {
    Tolerance tolerance;
    std::vector<CertifiedWay> ways;

    int points() const;
    int proved() const;
    bool excluded() const;  // some point is proved wrong
    // Every solver came to its end, or to a limit point that is proved, and every point is proved.
    bool conclusive() const;
};

CertifyStudy certify(const Model& model, const CertifyOptions& options);

}  // namespace elastocheck::compare
