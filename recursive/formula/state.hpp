// State of the bodies (positions and orientations), and its update by an increment: eqs. (4)-(5).
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "elastocheck/model.hpp"

namespace elastocheck::recursive {

template <class Real>
using Vector3 = Eigen::Matrix<Real, 3, 1>;
template <class Real>
using Matrix3 = Eigen::Matrix<Real, 3, 3>;
template <class Real>
using Vector6 = Eigen::Matrix<Real, 6, 1>;
template <class Real>
using Matrix6 = Eigen::Matrix<Real, 6, 6>;
template <class Real>
using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
template <class Real>
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

// s̃, the matrix of s × (.)
template <class Real>
Matrix3<Real> tilde(const Vector3<Real>& s) {
    Matrix3<Real> m;
    m << Real(0), -s.z(), s.y(), s.z(), Real(0), -s.x(), -s.y(), s.x(), Real(0);
    return m;
}

template <class Real>
struct BodyState {
    Vector3<Real> r = Vector3<Real>::Zero();
    Eigen::Quaternion<Real> p = Eigen::Quaternion<Real>::Identity();
    Matrix3<Real> A = Matrix3<Real>::Identity();  // of p

    Vector3<Real> lever(const Eigen::Vector3d& s_local) const {
        return A * s_local.cast<Real>();
    }  // s = A s'
};

// The generalised coordinates q. Ground is a body like the others, fixed, in slot 0.
template <class Real>
struct State {
    std::vector<BodyState<Real>> slots;

    const BodyState<Real>& operator[](BodyId body) const {
        return slots[static_cast<std::size_t>(body + 1)];
    }
    BodyState<Real>& operator[](BodyId body) { return slots[static_cast<std::size_t>(body + 1)]; }
    int bodies() const { return static_cast<int>(slots.size()) - 1; }
};

template <class Real>
State<Real> state_of(const std::vector<Pose>& poses) {
    State<Real> q;
    q.slots.resize(poses.size() + 1);
    for (std::size_t b = 0; b < poses.size(); ++b) {
        BodyState<Real>& body = q.slots[b + 1];
        body.r = poses[b].r.cast<Real>();
        body.p = poses[b].p.cast<Real>().normalized();
        body.A = body.p.toRotationMatrix();
    }
    return q;
}

template <class Real>
State<Real> design_state(const Model& model) {
    std::vector<Pose> poses;
    for (const auto& body : model.bodies) poses.push_back(body.design);
    return state_of<Real>(poses);
}

// The unit quaternion of the rotation vector Δπ.
template <class Real>
Eigen::Quaternion<Real> exponential(const Vector3<Real>& dpi) {
    using std::cos;
    using std::sin;
    const Real half = dpi.norm() / 2;
    // sin(h)/h is accurate for every h > 0 whose square does not underflow; below that its
    // limit is used.
    const Real sinc = half > 0 ? sin(half) / half : Real(1);
    const Vector3<Real> v = sinc / 2 * dpi;
    return {cos(half), v.x(), v.y(), v.z()};
}

// q + Δq, Δq_i = (Δr_i, Δπ_i) with Δπ in ground axes [6 nb]:
// eqs. (4)-(5), the rotation by the exponential map.
template <class Real, class Increment>
void advance(State<Real>& q, const Eigen::MatrixBase<Increment>& dq) {
    for (BodyId b = 0; b < q.bodies(); ++b) {
        q[b].r += dq.template segment<3>(6 * b);
        q[b].p = (exponential<Real>(dq.template segment<3>(6 * b + 3)) * q[b].p).normalized();
        q[b].A = q[b].p.toRotationMatrix();
    }
}

}  // namespace elastocheck::recursive
