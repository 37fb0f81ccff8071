#include "recursive/series/expand.hpp"

#include <complex>

#include "models/eigen/dense.hpp"

namespace elastocheck::recursive::series {
namespace {

// |x_k| [m], as defined at reach(). Where constraints alone determine the motion, λ has a longer
// series than the motion. A force counts as the displacement that it causes at the largest
// stiffness.
double size(const SteppingState& s, const Coefficients<double>& c, double metres_per_unit, int k) {
    const int n = s.n();
    const double max_stiffness = stiffest(s.system.M);
    const double metres_per_force = max_stiffness > 0 ? 1 / max_stiffness : 0;
    return std::hypot(c.x.col(k).head(n).cwiseProduct(s.system.weight.head(n)).norm(),
                      metres_per_force * c.x.col(k).tail(s.m()).norm(),
                      k > 1 ? metres_per_unit * c.load[k] : 0.0);
}

}  // namespace

double parameter(const SteppingState& s, Drive drive) {
    return drive == Drive::start ? s.parameters.t : s.parameters.a;
}

void expand(SteppingState& s, Equations<double>& e, Coefficients<double>& c, const Extent& extent,
            const Vector<double>& previous_direction) {
    const int n = s.n();
    const bool arc_length = extent.arc_length;
    const auto W2 = s.system.weight.head(n).array().square();
    const auto inner = [&](const auto& a, const auto& b) {
        return (a.head(n).array() * W2 * b.head(n).array()).sum();
    };
    // Order 0: the present point.
    const double a_0 = parameter(s, e.drive);
    begin(e, s.q, s.lambda, a_0);
    evaluate(e, {0, Pass::known});
    c.x.setZero();
    c.x.col(0).tail(s.m()) = s.lambda;
    c.load.setZero();
    c.load[0] = a_0;

    // Order 1: x_1 = a_1 x̂; with arc length |x_1| = 1, in the previous direction.
    drive_at(s, e.drive, 1.0, s.q, s.lambda);
    back_substitute(s);
    c.unit = s.work.x;
    if (arc_length) {
        const double size = std::sqrt(inner(c.unit, c.unit));
        const bool decreases =
            previous_direction.isZero(0) ? extent.a_1 < 0 : inner(c.unit, previous_direction) < 0;
        c.load[1] = (decreases ? -1 : 1) / size;
    } else {
        c.load[1] = extent.a_1;
    }
    c.x.col(1) = c.load[1] * c.unit;
    s.work.x = c.x.col(1);

    // Higher orders.
    const auto solve = [&] {
        s.work.upper = -e.G;
        s.work.lower = -e.Phi;
        back_substitute(s);
    };
    // x_k + a_k x̂ ⟂ x_1
    const auto straighten = [&](int k) {
        if (!arc_length) return;
        c.load[k] = -inner(s.work.x, c.x.col(1)) / inner(c.unit, c.x.col(1));
        s.work.x += c.load[k] * c.unit;
    };
    const auto loses = [&](auto&& correct) {
        if (arc_length) return false;
        correct();
        return !(s.work.x.head(n).norm() <= loses_digits * c.x.col(1).head(n).norm());
    };
    const auto keep_all = [] {};
    // The margin is for a singularity, which may shorten the range (reach()), and for the accuracy of
    // λ. From p on the orders go on only where they are likely to reach the end, as the range grows
    // by about (|x| / tolerance)^(1/p - 1/k).
    const auto suffices = [&](int k) {
        constexpr int min_order = 8;
        constexpr double margin = 2, growth = 1.7;
        const auto exceeds = [&](int order, double tau) {
            return !(size(s, c, extent.metres_per_unit, order) * std::pow(tau, order) <=
                     extent.tolerance);
        };
        if (k < min_order || k % 2 != 0) return k == extent.order;
        if (k >= extent.order && exceeds(k, extent.rest / growth)) return true;
        return !exceeds(k, margin * extent.rest) && !exceeds(k - 1, margin * extent.rest);
    };
    compute_orders(e, c, s.work.x, OrderSteps{solve, straighten, loses, keep_all, suffices});
}

double reach(const SteppingState& s, const Coefficients<double>& c, double tolerance,
             double metres_per_unit, double radius) {
    const int p = c.order;
    double last_size = size(s, c, metres_per_unit, p);
    if (p > 1 && std::isfinite(radius))
        last_size = std::max(last_size, size(s, c, metres_per_unit, p - 1) / radius);
    if (!std::isfinite(last_size)) return std::numeric_limits<double>::quiet_NaN();
    if (last_size == 0) return std::numeric_limits<double>::infinity();
    const double tau = std::pow(tolerance / last_size, 1.0 / p);
    if (!(tau > radius / 2)) return tau;
    // |x_p| τᵖ (τ/R) / (1 - τ/R) = tolerance, by bisection
    constexpr int halvings = 50;
    double low = 0, high = std::min(tau, radius);
    for (int k = 0; k < halvings; ++k) {
        const double middle = (low + high) / 2;
        const double tail = last_size * std::pow(middle, p) * middle / (radius - middle);
        (tail <= tolerance ? low : high) = middle;
    }
    return low;
}

Singularity nearest_singularity(const SteppingState& s, const Coefficients<double>& c) {
    const int n = s.n(), p = c.order;
    // The last six orders, which the nearest singularity dominates; y_2 is the lowest order used.
    const int first_order = std::max(4, p - 5);
    Singularity none{std::numeric_limits<double>::infinity(), 0, 1};
    const auto weighted = [&](int k) -> Vector<double> {
        return c.x.col(k).head(n).cwiseProduct(s.system.weight.head(n));
    };
    const double last = weighted(p).norm(), last_but_one = weighted(p - 1).norm();
    if (p < 5 || !(last > 0 || last_but_one > 0)) return none;
    // Scale τ so that the last coefficients are near one and all orders have the same weight
    // in the fit.
    const double unit =
        std::min(last > 0 ? std::pow(last, -1.0 / p) : std::numeric_limits<double>::infinity(),
                 last_but_one > 0 ? std::pow(last_but_one, -1.0 / (p - 1))
                                  : std::numeric_limits<double>::infinity());
    Matrix<double> y(n, p + 1);
    double binomial = 1, power = 1;
    for (int k = 0; k <= p; ++k) {
        if (k > 0) {
            binomial *= std::abs((1.5 - k) / k);
            power *= unit;
        }
        if (k >= first_order - 2) y.col(k) = weighted(k) * (power / binomial);
    }
    // Least squares for y_k = b_1 y_{k-1} + b_2 y_{k-2}.
    const int orders = p - first_order + 1;
    Matrix<double> A(orders * n, 2);
    Vector<double> b(orders * n);
    for (int k = first_order; k <= p; ++k) {
        const int row = (k - first_order) * n;
        A.block(row, 0, n, 1) = y.col(k - 1);
        A.block(row, 1, n, 1) = y.col(k - 2);
        b.segment(row, n) = y.col(k);
    }
    if (!A.allFinite() || !(b.norm() > 0)) return none;
    const Eigen::VectorXd fit = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(A).solve(b);
    // z² = b_1 z + b_2; the root of largest modulus belongs to the nearest singularity, τ_s = 1 / z.
    const std::complex<double> root = std::sqrt(std::complex<double>(fit[0] * fit[0] / 4 + fit[1]));
    std::complex<double> z = fit[0] / 2 + root;
    if (std::abs(fit[0] / 2 - root) > std::abs(z)) z = fit[0] / 2 - root;
    const std::complex<double> tau = unit / z;
    return {std::abs(tau), std::abs(std::arg(tau)), (A * fit - b).norm() / b.norm()};
}

void horner(const Eigen::Ref<const Eigen::MatrixXd>& c, double tau, Vector<double>& value) {
    const Eigen::Index p = c.cols() - 1;
    value = c.col(p);
    for (Eigen::Index k = p; k-- > 0;) value = value * tau + c.col(k);
}

void displace(const State<double>& from, const Eigen::Ref<const Vector<double>>& x,
              State<double>& q) {
    for (BodyId b = 0; b < from.bodies(); ++b) {
        const Vector3<double> g = x.segment<3>(6 * b + 3) / 2;
        q[b].r = from[b].r + x.segment<3>(6 * b);
        q[b].p = (Eigen::Quaterniond(1, g.x(), g.y(), g.z()) * from[b].p).normalized();
        q[b].A = q[b].p.toRotationMatrix();
    }
}

}  // namespace elastocheck::recursive::series
