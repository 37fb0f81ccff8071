// Output of recorded points: stored in the path, or streamed to a visitor.
// Streamed points share one preallocated buffer. The memory is allocated before the first step.
#pragma once

#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive {

// Where a sweep stopped: the parameter, NaN while settling; and the motion in which the
// settled start is unstable, if that is the cause.
struct Stop {
    double at = std::numeric_limits<double>::quiet_NaN();
    std::string unstable_start = {};  // as in SteppingState
};

struct Recording {
    EquilibriumPath& path;
    const PointVisitor& visit;
    std::size_t points, reached = 0;

    Recording(const Model& model, int recorded, EquilibriumPath& into, const PointVisitor& visits)
        : path(into), visit(visits), points(static_cast<std::size_t>(recorded)) {
        const Equilibrium blank{0, std::vector<Pose>(model.bodies.size()),
                                std::vector<Wrench>(model.joints.size()), 0};
        path.points.assign(visit ? 1 : points, blank);
    }

    void keep(const Model& model, const Inputs<double>& inputs, const State<double>& q,
              const State<double>& where_lambda_acts, const Vector<double>& lambda, double load) {
        Equilibrium& point = path.points[visit ? 0 : reached];
        point.load = load;
        record(model, inputs, q, {lambda, where_lambda_acts}, point);
        ++reached;
        if (visit) visit(point);
    }

    void finish() { path.points.resize(visit ? 0 : reached); }
};

}  // namespace elastocheck::recursive
