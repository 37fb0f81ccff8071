// Predictor-corrector continuation along a path of equilibria: nodes and accepted steps.
//
// A node is a point z = (q, λ) of the path with its derivative z' = dz/dp, p the parameter (t while
// settling, a on the branch): ∂G z' = the drivers' terms, one more right-hand side for the factors
// of the node. From one node to the next:
//
//   predictor    z⁺ = z + h z' + ½ h² z'', z'' from the last two derivatives
//   corrector    Newton steps, each with fresh factors: their sizes fall quadratically, so the
//                square of the last one over the one before estimates the remaining error. (With
//                the factors of the old node they hardly fall: where stiff bushings rotate beside
//                soft springs, the error of old factors is the angle of rotation times the ratio of
//                the rates.)
//
// Newton's method is not bound to the branch: past a limit point it converges to any other
// equilibrium. So a step is accepted only where the determinant of the matrix keeps its sign and
// the sum of all corrections is less than half of the predictor step.
#pragma once

#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive {

struct Node {
    State<double> q;
    Vector<double> lambda, dq = {}, dlambda = {};  // z' = (dq, dlambda) per unit of p
    double p = 0;
    int orientation = 0;  // sign of the determinant
};

// The parameter that moves, and the tolerances of the corrector.
struct ContinuationSettings {
    Drive drive = Drive::rate;
    double length_tolerance = 0, angle_tolerance = 0;  // of the corrections [m], [rad]

    Parameters at(double p) const {
        return drive == Drive::start ? Parameters{p, 0} : Parameters{1, p};
    }
};

// z' at the node, with the factors in the system.
inline void differentiate(SteppingState& s, const ContinuationSettings& settings, Node& node) {
    go_to(s, settings.at(node.p));
    drive_at(s, settings.drive, 1, node.q, node.lambda);
    back_substitute(s);
    node.dq = s.work.x.head(s.n());
    node.dlambda = s.work.x.tail(s.m());
    node.orientation = s.system.lu.orientation;
}

// Size of the motion dq over the tolerances: the largest of all bodies [-].
template <class Motion>
double size_in_tolerances(const ContinuationSettings& settings, const Motion& dq) {
    double worst = 0;
    for (Eigen::Index b = 0; b < dq.size() / 6; ++b) {
        worst = std::max(worst, dq.template segment<3>(6 * b).norm() / settings.length_tolerance);
        worst =
            std::max(worst, dq.template segment<3>(6 * b + 3).norm() / settings.angle_tolerance);
    }
    return worst;
}

// One Newton correction of (q, lambda) at p; `size` returns it in units of the tolerance.
Outcome correct(SteppingState& s, const ContinuationSettings& settings, State<double>& q,
                Vector<double>& lambda, double p, double& size);

// Result of a step. |δ_k| is the k-th correction and |h z' + ½ h² z''| the predictor step, both in
// units of the tolerance; det the determinant of the consistent tangent.
enum class Verdict {
    accepted,        // none of the following
    unsolved,        // |δ_k| ≥ |δ_k-1|, or |δ_k|² / |δ_k-1| > 0.01 after the last correction
    another_branch,  // Σ |δ_k| > ½ |h z' + ½ h² z''| + 1: an equilibrium far from the predictor
    nearly_singular,     // on this path, det passes near zero between the nodes (stability.hpp)
    past_singular_point  // sign det differs between the nodes
};

struct Trial {
    Outcome outcome = Outcome::converged;  // of the linear algebra
    Verdict verdict = Verdict::unsolved;
    // remaining error of the corrector, over the tolerance
    double error = std::numeric_limits<double>::infinity();
};

// Tries a step from `node` to next.p; `curvature` and `lambda_curvature` estimate z''. Fills
// `next`, with its derivative unless the verdict is `unsolved`.
Trial try_step(SteppingState& s, const ContinuationSettings& settings, const Node& node,
               const Vector<double>& curvature, const Vector<double>& lambda_curvature, Node& next);

// Whether redundant joints are inconsistent at the node whose factors are in the system, by the gap
// that remains after corrections with these factors. q and lambda are workspace.
bool is_inconsistent_at(SteppingState& s, const Node& node, State<double>& q,
                        Vector<double>& lambda);

// Why the path ends at `node`, judged by the smallest rejected step, of length h.
Outcome end_reason(const Trial& trial, const Node& node, const Vector<double>& curvature, double h,
                   double length);

}  // namespace elastocheck::recursive
