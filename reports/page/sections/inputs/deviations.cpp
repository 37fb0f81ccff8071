#include "reports/page/sections/inputs/deviations.hpp"

#include <algorithm>
#include <cmath>

#include "compare/outputs/curve.hpp"
#include "compare/tables/compare_result.hpp"

namespace elastocheck::reports {
namespace {

using compare::Leg;
using compare::Unit;

std::vector<double> errors_of(const compare::Profile& profile, Unit unit) {
    std::vector<double> values;
    for (const auto& apart : profile.apart)
        values.push_back(unit == Unit::mm ? apart.mm : apart.deg);
    return values;
}

}  // namespace

std::vector<DeviationAt> deviations_over(const SceneAnalyses& scene, const Sweep& sweep,
                                         Unit unit) {
    const auto& channels = scene.comparison.channels;
    std::vector<DeviationAt> stations;
    for (const auto& branch : sweep.branches) {
        const compare::Curve &truth = branch.truth(),
                             &other = branch.result->run(Leg::recursive).curve,
                             &second = branch.result->run(branch.result->second).curve;
        const auto by = compare::abscissa(channels, branch.result->abscissa, truth, other);
        const auto load = errors_of(profile_at_equal_parameter(channels, truth, other), unit),
                   travel = errors_of(profile_at_equal_abscissa(channels, truth, other, by), unit),
                   doubt = errors_of(profile_at_equal_parameter(channels, truth, second), unit);
        compare::Profile chosen;
        if (scene.recommended)
            for (const auto& [name, profile] : scene.recommended->branches)
                if (name == branch.name()) chosen = profile;
        const auto errors = errors_of(chosen, unit);
        const auto recommended = [&](double a) {
            for (std::size_t l = 0; l < errors.size(); ++l)
                if (std::abs(chosen.a[l] - a) <= 1e-9 * std::abs(truth.a.back())) return errors[l];
            return compare::nan;
        };
        const auto value = [](const std::vector<double>& of, std::size_t k) {
            return k < of.size() ? of[k] : compare::nan;
        };
        for (const auto k : thinned(load.size(), 60))
            if (truth.a[k] != 0 || stations.empty())
                stations.push_back({truth.a[k], load[k], value(travel, k), recommended(truth.a[k]),
                                    value(doubt, k)});
    }
    std::ranges::stable_sort(stations, {}, &DeviationAt::a);
    return stations;
}

Table table_of(const std::vector<DeviationAt>& stations, const SceneAnalyses& scene,
               const Sweep& sweep, Unit of_unit) {
    using enum Digits;
    using S = DeviationAt;
    const char* unit = symbol(of_unit);
    return compare::table<S>("",
                             {{sweep.parameter, place, [](const S& s) { return s.a; }},
                              {"published, " + sweep.at_equal_parameter(), three,
                               [](const S& s) { return s.load; }, "", unit},
                              {"published, " + sweep.at_equal_abscissa(), three,
                               [](const S& s) { return s.travel; }, "", unit},
                              {scene.recommended ? configuration(scene.recommended->configuration) +
                                                       ", " + sweep.at_equal_parameter()
                                                 : "recommended",
                               three, [](const S& s) { return s.recommended; }, "", unit},
                              {"difference of the references", three,
                               [](const S& s) { return s.references; }, "", unit}},
                             stations);
}

}  // namespace elastocheck::reports
