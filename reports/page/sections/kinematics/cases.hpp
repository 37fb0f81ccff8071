// Load cases of part 1 of the page: which outputs of which wheel they move, and over what.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/outputs/catalogue/catalogue.hpp"
#include "reports/page/common.hpp"

namespace elastocheck::reports {

using Quantity = compare::CurveOfFigure;

struct Case {
    Sweep sweep;
    SweepCurve curve;
    std::string legend() const { return as_words(sweep.name); }
};
// The sweeps for which `includes` holds, with two points or more.
std::vector<Case> cases_of(const SceneAnalyses& scene,
                           const std::function<bool(const Sweep&)>& includes);
// Whether the sweep is a force in the plane of the road, or a moment.
bool is_force_test(const Sweep& sweep);

// Load cases that share an abscissa: the parameter, the travel of each wheel, the force or moment on
// each wheel in the direction of a K&C test, the roll of the axle.
enum class By { parameter, travel, push, roll };
struct Family {
    std::string id, x;  // "travel", "wheel travel [mm]"
    By by = By::parameter;
    std::vector<Case> cases{};
    std::vector<Quantity> quantities{};
    bool with_given_only =
        true;  // also quantities without a curve unless measured or by a candidate
    // Channel that is the abscissa of a wheel; empty: the parameter.
    std::string abscissa(const Wheel& wheel) const;
};

// Channel of a quantity: of a wheel, of a spring or damper of it, or of the whole scene.
struct FoundOutput {
    std::string channel, unit;
    Wheel wheel;
    std::string element{};  // "coil", without the name of the wheel
    bool of_all = false;    // an output of the whole scene
};
std::vector<FoundOutput> outputs_of(const SceneAnalyses& scene, const std::string& quantity);

// Splits the name of a spring, damper or stop: "coil_left" is "coil" and the position of the wheel "left".
// None unless exactly one wheel has a word of the name.
std::optional<std::pair<std::string, std::size_t>> wheel_of(const std::string& owner,
                                                            const std::vector<Wheel>& wheels);

// From the values of an output to what is shown: factor · (value - origin).
struct Scale {
    double factor = 1, origin = 0;
    double operator()(double value) const { return factor * (value - origin); }
};
// `side`: sign by the side of the wheel; `start`: position of the branch's start among the values.
Scale scale_of(const Quantity& quantity, int side, const std::vector<double>& values,
               std::size_t start);
std::string label_of(const Quantity& quantity);  // "camber", "steer angle"
double without_rounding(double value);           // 0 for a value that is rounding

// Abscissa of a wheel in a case, the parameter times `push_of` where it is a push.
std::vector<double> abscissa_of(const SceneAnalyses& scene, const Family& family, const Case& c,
                                const Wheel& wheel);
// Force or moment on a wheel as the figures of a K&C test count it: the parameter times `factor`; for
// an unloaded wheel that on the other wheel.
struct Push {
    double factor = 1;
    std::string positive{};  // "inwards"; empty: the parameter as it stands
};
Push push_of(const SceneAnalyses& scene, const Case& c, const Wheel& wheel);
// ", inwards"; empty where the abscissa is no push.
std::string direction_of(const SceneAnalyses& scene, const Family& family, const Case& c);

// Points of an output that were measured or that candidates give, scaled as its curve is.
std::vector<DrawnCurve> given_of(const SceneAnalyses& scene, const Family& family, const Case& c,
                                 const FoundOutput& output, Scale scale);

}  // namespace elastocheck::reports
