#include "reference/energy/minimise/stability.hpp"

#include <cmath>

namespace elastocheck::reference::energy {
namespace {

using Eigen::VectorXd;

// of a stiffness: largest predicted fall in a step, and largest misfit of a prediction
constexpr double max_fall = 0.5;
// of the step: a slope is taken over at least this length, to limit its noise
constexpr double min_length = 0.25;
// times the noise: a smaller stiffness has no significant slope
constexpr double min_significance = 100;

StiffnessRecord::Sample sample(double a, const Modes& modes) {
    return {a, modes.stiffness(modes.resisting()), modes.idle_limit};
}

// dw/da from the last sample and the nearest one before it at a distance of at least `distance`;
// zero if none.
VectorXd slope(const StiffnessRecord& record, double distance) {
    const auto& last = record.samples.back();
    for (auto earlier = record.samples.rbegin() + 1; earlier != record.samples.rend(); ++earlier) {
        if (earlier->w.size() != last.w.size()) break;
        if (std::abs(last.a - earlier->a) >= distance)
            return (last.w - earlier->w) / (last.a - earlier->a);
    }
    return VectorXd::Zero(last.w.size());
}

}  // namespace

void StiffnessRecord::add(double a, const Modes& modes) { samples.push_back(sample(a, modes)); }

double limited_step(const StiffnessRecord& record, double h) {
    if (record.samples.empty()) return h;
    const auto& last = record.samples.back();
    const VectorXd fall = -slope(record, min_length * std::abs(h)) * h;
    double share = 1;
    for (int i = 0; i < last.w.size(); ++i)
        if (last.w[i] > min_significance * last.noise && fall[i] > max_fall * last.w[i])
            share = std::min(share, max_fall * last.w[i] / fall[i]);
    return share * h;
}

bool meets_prediction(const StiffnessRecord& record, double a, const Modes& modes) {
    if (record.samples.empty()) return true;
    const auto& last = record.samples.back();
    const auto actual = sample(a, modes);
    if (actual.w.size() != last.w.size()) return true;
    const double h = a - last.a;
    const VectorXd miss = actual.w - last.w - slope(record, min_length * std::abs(h)) * h;
    for (int i = 0; i < miss.size(); ++i)
        if (last.w[i] > min_significance * last.noise &&
            !(std::abs(miss[i]) <= max_fall * last.w[i]))
            return false;
    return true;
}

}  // namespace elastocheck::reference::energy
