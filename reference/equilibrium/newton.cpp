#include "reference/equilibrium/newton.hpp"

#include <ceres/ceres.h>
#include <ceres/jet.h>

#include <algorithm>

namespace elastocheck::reference::equilibrium {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// A part of the system depends on two bodies, at most three reactions and the parameter: 7 + 7 + 3 + 1
// derivatives, scattered afterwards.
constexpr int first_reaction = 14, the_parameter = 17;
using Jet = ceres::Jet<double, 18>;

// The first column of a body's or a row's unknowns.
int column(BodyId body) { return 7 * body; }
int column(const System& system, int row) { return 7 * system.bodies + row; }

struct Seeds {
    const System& system;
    const VectorXd& x;

    Frame<Jet> frame(const Part& part, int which) const {
        const BodyId body = which == 0 ? part.i : part.j;
        if (body == ground) {
            const auto at = ground_frame(system);
            return {at.r.cast<Jet>(), {Jet(1.0), Jet(0.0), Jet(0.0), Jet(0.0)}};
        }
        const auto seed = [&](int k) { return Jet(x[column(body) + k], 7 * which + k); };
        return {{system.length * seed(0), system.length * seed(1), system.length * seed(2)},
                {seed(6), seed(3), seed(4), seed(5)}};
    }
    Jet reaction(const Part& part, int k) const {
        return Jet(x[column(system, part.row) + k], first_reaction + k);
    }
};

struct Scatter {
    const System& system;
    VectorXd E;
    RowMajor dE;      // ∂E/∂x [n × (7 nb + m)]
    VectorXd E_rate;  // dE/dt [n]

    void add(const Part& part, int row, const Jet& term) {
        E[row] += term.a;
        E_rate[row] += term.v[the_parameter];
        if (part.i != ground) dE.row(row).segment<7>(column(part.i)) += term.v.segment<7>(0).transpose();
        if (part.j != ground) dE.row(row).segment<7>(column(part.j)) += term.v.segment<7>(7).transpose();
        for (int k = 0; k < part.rows; ++k)
            dE(row, column(system, part.row) + k) += term.v[first_reaction + k];
    }
    void balance(const Part& part, BodyId body, const Vec3<Jet>& force, const Vec3<Jet>& moment) {
        for (int k = 0; k < 3; ++k) add(part, 6 * body + k, force[k]);
        for (int k = 0; k < 3; ++k) add(part, 6 * body + 3 + k, moment[k]);
    }
    void constraint(const Part& part, int k, const Jet& Phi) {
        add(part, 6 * system.bodies + part.row + k, Phi);
    }
};

Scatter differentiated(const System& system, const Loading& loading, const VectorXd& x) {
    Scatter sum{system, VectorXd::Zero(system.equations()),
                RowMajor::Zero(system.equations(), system.unknowns()), VectorXd::Zero(system.equations())};
    Jet a(loading.a), held(loading.held);
    a.v[the_parameter] = loading.a_rate;
    held.v[the_parameter] = loading.held_rate;
    assemble<Jet>(system, a, held, loading.pieces, Seeds{system, x}, sum);
    sum.E -= loading.held * system.at_design;
    sum.E_rate -= loading.held_rate * system.at_design;
    return sum;
}

// Newton's steps are the same whatever regular matrix the equations are multiplied by; whether a step is an
// improvement is not. A member that is turned along its tangent by δ is stretched by ½ δ²: measured in forces, a long
// step makes things worse where members are stiff, and Ceres, which takes none that does, would creep; and what is
// left along a soft direction does not show beside the round-off of the stiff ones. So what Ceres sees is
//
//   r = ⎡ J  U ⎤⁻¹ ⎧ E ⎫
//       ⎣ Vᵀ 0 ⎦   ⎩ 0 ⎭        [n + k]
//
// the corrections that E asks for where the step begins (Deuflhard's natural level function; linearisation.hpp has J
// and its border). r is zero where E is.
//
// The whole system is one residual block: a balance gathers from every element that touches the body.
class SystemCost final : public ceres::CostFunction {
  public:
    SystemCost(const System& system, const Loading& loading, const Linearisation& near)
        : system_(system), loading_(loading), near_(near), x_(system.unknowns()) {
        set_num_residuals(static_cast<int>(near.bordered.rows()));
        mutable_parameter_block_sizes()->assign(static_cast<std::size_t>(system.bodies), 7);
        if (system.constraint_rows > 0) mutable_parameter_block_sizes()->push_back(system.constraint_rows);
    }

    bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
        const auto& sizes = parameter_block_sizes();
        for (std::size_t b = 0, at = 0; b < sizes.size(); at += static_cast<std::size_t>(sizes[b]), ++b)
            std::copy_n(parameters[b], sizes[b], x_.data() + at);
        Eigen::Map<VectorXd> r(residuals, num_residuals());
        if (jacobians == nullptr) {
            r = corrections(residual(system_, loading_, x_));
            return r.allFinite();
        }
        const auto sum = differentiated(system_, loading_, x_);
        r = corrections(sum.E);
        const MatrixXd dr = corrections(sum.dE);
        largest_ = largest(sum.E);
        for (std::size_t b = 0, at = 0; b < sizes.size(); at += static_cast<std::size_t>(sizes[b]), ++b)
            if (jacobians[b] != nullptr)
                Eigen::Map<RowMajor>(jacobians[b], num_residuals(), sizes[b]) =
                    dr.middleCols(static_cast<Eigen::Index>(at), sizes[b]);
        return r.allFinite() && dr.allFinite();
    }

    // Of |E|, where it was differentiated last.
    double largest_residual() const { return largest_; }

  private:
    MatrixXd corrections(const MatrixXd& E) const {
        MatrixXd bordered = MatrixXd::Zero(num_residuals(), E.cols());
        bordered.topRows(E.rows()) = E;
        return near_.bordered.solve(bordered);
    }

    const System& system_;
    Loading loading_;
    const Linearisation& near_;
    mutable double largest_ = 0;
    mutable VectorXd x_;  // room for the unknowns in one piece; a problem is solved by one thread
};

// A step after a correction of this size would be of its square, which is round-off.
constexpr double last_correction = 1e-8;

// Goes on until the residual is small and the corrections have died out.
struct StopAtFloor final : ceres::IterationCallback {
    StopAtFloor(const SystemCost& of, double limit) : cost(of), tolerance(limit) {}
    ceres::CallbackReturnType operator()(const ceres::IterationSummary& now) override {
        if (now.iteration == 0) return ceres::SOLVER_CONTINUE;
        const bool done = cost.largest_residual() <= tolerance && now.step_norm <= last_correction;
        return done ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
    }
    const SystemCost& cost;
    double tolerance;
};

ceres::Solver::Options solver_options(const Options& options) {
    ceres::Solver::Options o;
    o.linear_solver_type = ceres::DENSE_QR;  // not of the normal equations: they square the condition number
    o.max_num_iterations = options.iteration_limit;
    // Newton's method as nearly as can be; what damping is left turns idle modes and redundant rows into
    // minimum-norm steps.
    constexpr double hardly_any_damping = 1e16;  // the inverse of the damping, beside rows of order one
    o.initial_trust_region_radius = o.max_trust_region_radius = hardly_any_damping;
    o.min_lm_diagonal = 1;
    o.jacobi_scaling = false;
    // Tolerances are ours (StopAtFloor), except for a standstill: Newton's method makes the cost of a step
    // much smaller, or has come as far as it will.
    o.function_tolerance = 1e-4;
    o.gradient_tolerance = 0;
    o.parameter_tolerance = 0;
    o.num_threads = 1;
    o.logging_type = ceres::SILENT;
    return o;
}

// A body on its way through x: δ(x, y, z) = ½ (w δπ + δπ × v), δw = -½ v · δπ, as below.
using Dual = ceres::Jet<double, 1>;
Frame<Dual> moving_frame(const System& system, const VectorXd& x, const VectorXd& dx, BodyId body) {
    const Frame<double> at = frame_of(system, x, body);
    Frame<Dual> frame{at.r.cast<Dual>(), at.p.cast<Dual>()};
    if (body == ground) return frame;
    const Eigen::Vector3d v = at.p.vec(), turn = dx.segment<3>(6 * body + 3);
    const Eigen::Vector3d dv = (at.p.w() * turn + cross(turn, v)) / 2;
    for (int k = 0; k < 3; ++k) frame.r[k].v[0] = system.length * dx[6 * body + k];
    frame.p.x().v[0] = dv[0], frame.p.y().v[0] = dv[1], frame.p.z().v[0] = dv[2];
    frame.p.w().v[0] = -v.dot(turn) / 2;
    return frame;
}

}  // namespace

Attempt newton(const System& system, const Loading& loading, const VectorXd& start, const Linearisation& near,
               const Options& options, Counts& counts) {
    Attempt attempt{start, 0, false};
    VectorXd& x = attempt.x;
    ++counts.evaluations;
    attempt.residual = largest(residual(system, loading, start));
    if (!std::isfinite(attempt.residual) || system.equations() == 0)
        return attempt;  // Ceres would complain aloud

    SystemCost cost(system, loading, near);
    ceres::ProductManifold<ceres::EuclideanManifold<3>, ceres::EigenQuaternionManifold> rigid_body;
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ownership.disable_all_safety_checks = true;
    ceres::Problem problem(ownership);
    std::vector<double*> blocks;
    for (int body = 0; body < system.bodies; ++body) {
        blocks.push_back(x.data() + column(body));
        problem.AddParameterBlock(blocks.back(), 7, &rigid_body);
    }
    if (system.constraint_rows > 0) blocks.push_back(x.data() + column(system, 0));
    problem.AddResidualBlock(&cost, nullptr, blocks);

    StopAtFloor stop(cost, options.tolerance);
    ceres::Solver::Options solver = solver_options(options);
    solver.callbacks.push_back(&stop);
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);

    counts.factorisations += summary.num_linear_solves;
    counts.iterations += summary.num_linear_solves;  // `iterations` leaves out one that ends at a standstill
    counts.evaluations += summary.num_residual_evaluations + 1;
    for (int body = 0; body < system.bodies; ++body) x.segment<4>(column(body) + 3).normalize();
    attempt.residual = largest(residual(system, loading, x));
    attempt.out_of_time = static_cast<int>(summary.iterations.size()) > options.iteration_limit;
    return attempt;
}

// A turn by δπ changes the quaternion by ½ (δπ, 0) p:  δ(x, y, z) = ½ (w δπ + δπ × v),  δw = -½ v · δπ.
Derivatives derivatives(const System& system, const Loading& loading, const VectorXd& x, Counts& counts) {
    auto sum = differentiated(system, loading, x);
    ++counts.evaluations;
    MatrixXd J(system.equations(), system.equations());
    for (int body = 0; body < system.bodies; ++body) {
        const Eigen::Vector4d p = x.segment<4>(7 * body + 3);
        Eigen::Matrix<double, 4, 3> turn;
        turn << p[3], p[2], -p[1],  //
            -p[2], p[3], p[0],      //
            p[1], -p[0], p[3],      //
            -p[0], -p[1], -p[2];
        J.middleCols<3>(6 * body) = sum.dE.middleCols<3>(7 * body);
        J.middleCols<3>(6 * body + 3) = sum.dE.middleCols<4>(7 * body + 3) * (turn / 2);
    }
    J.rightCols(system.constraint_rows) = sum.dE.rightCols(system.constraint_rows);
    return {std::move(J), std::move(sum.E_rate)};
}

std::vector<OnCurve> on_curves(const System& system, const Loading& loading, const VectorXd& x,
                               const VectorXd& dx) {
    std::vector<OnCurve> all;
    Dual a(loading.a);
    a.v[0] = loading.a_rate;
    const auto& elastics = system.model->elastics;
    for (std::size_t e = 0; e < elastics.size(); ++e) {
        std::array<const Curve*, 6> curves{};
        for (std::size_t k = 0; k < 6; ++k)
            curves[k] = std::visit([&](const auto& kind) { return curve_of(kind, k); }, elastics[e].kind);
        if (std::ranges::count(curves, nullptr) == 6) continue;
        const auto [i, j] = bodies_of(elastics[e].kind);
        const Vec6<Dual> now =
            deformations(system, e, a, moving_frame(system, x, dx, i), moving_frame(system, x, dx, j));
        for (std::size_t k = 0; k < 6; ++k)
            if (curves[k] != nullptr) {
                const Dual& value = now[static_cast<int>(k)];
                all.push_back({e, k, curves[k], k < 3 ? system.length : 1, value.a, value.v[0]});
            }
    }
    return all;
}

}  // namespace elastocheck::reference::equilibrium
