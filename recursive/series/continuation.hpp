// State of a continuation by power series: the present point and expansion, and the path so far.
#pragma once

#include <vector>

#include "models/parameter_unit.hpp"
#include "recursive/series/expand.hpp"
#include "recursive/series/path.hpp"
#include "recursive/series/pieces.hpp"
#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive::series {

// One continuation: t from 0 to 1 while the start settles (a homotopy from the design position to
// the equilibrium at load factor 0), or a from 0 to the branch's end.
struct Continuation {
    SteppingState& s;  // present point, its inputs and the factors there
    const recursive::Series& options;
    Equations<double> e;     // series of every term of the equations about the present point
    Coefficients<double> c;  // of the present expansion
    std::vector<CurvePiece>& curves;
    KnotTolerance knot_tolerance;
    double branch_end;      // end of the branch in the parameter
    double last_parameter;  // branch_end, or less where a driven length becomes zero before it
    // a_1 of the next expansion; with arc length only its sign is used, and only while there is no
    // previous direction
    double a_1;
    double
        metres_per_unit;  // length that counts as much as a unit of the parameter in an error [m]
    // Direction of the last expansion: x'(τ) at its end with arc length, else x_1; zero if there is
    // none, or a slope has jumped since
    Vector<double> previous_direction;
    // has the sign of a'(τ) at the last point that record_limit_points() has tested
    double parameter_rate = 0;
    int sign_at_start = 0;              // determinant_sign() at the start of the path
    Matrix<double> softest_modes = {};  // start of the iteration of min_stiffness(), updated by it
    bool stable = false;  // whether the start is stable; then every later point must be
    double start_log_determinant = 0;  // log₂ |determinant| at the start of the expansion
    // determinant() at the midpoint of the expansion, relative to that at its start; -1 if the
    // matrix is singular there
    double middle_determinant = 1;
    bool reversed = false;  // whether an element reversed at the end of the last expansion
    Vector<double> x;       // workspace: value of the polynomial
    Path path;

    Continuation(SteppingState& s_, std::vector<CurvePiece>& curves_,
                 const recursive::Series& options_, Drive drive)
        : s(s_),
          options(options_),
          e(equations<double>(s.model, s.branch, std::max(options.order, options.last_order),
                              drive)),
          c(reserve_coefficients<double>(s.n() + s.m(), e.order())),
          curves(curves_),
          // A corrected point may miss a knot by the accepted error, ten tolerances.
          knot_tolerance{.length = s.setup.length,
                         .overshoot = 0.1 * options.tolerance,
                         .start = 10 * options.tolerance},
          branch_end(drive == Drive::start ? 1 : s.branch.to),
          last_parameter(drive == Drive::start ? 1 : s.setup.end),
          a_1(branch_end),
          metres_per_unit(s.setup.length / std::abs(branch_end)),
          previous_direction(Vector<double>::Zero(s.n() + s.m())) {
        e.G_d = -s.start.R_d;
        e.Phi_d = s.start.Phi_d;
        for (const auto& curve : curves) use_piece(curve);
    }
    // Sets the piece of the curve in the equations and in the inputs.
    void use_piece(const CurvePiece& curve) {
        set_piece(curve, e);
        set_piece(curve, s.inputs);
    }
    bool by_arc() const { return options.arc_length && e.drive == Drive::rate; }
    double parameter_now() const { return parameter(s, e.drive); }
    void go_to(double value) {
        recursive::go_to(s, e.drive == Drive::start ? recursive::Parameters{value, 0}
                                                    : recursive::Parameters{1, value});
        s.a = s.parameters.a;
    }
};

// A crossing of a knot: the number of the curve, and the direction (PieceExit).
struct Crossing {
    std::size_t curve = 0;
    int direction = 0;
};

// Range of the present expansion, 0 ≤ τ ≤ tau, and the knots at its end.
struct Range {
    double tau = 0;
    bool reaches_end = false;  // whether the branch ends at tau
    std::vector<Crossing> crossings = {};
    // deformations that leave their piece at τ = 0: the expansion is invalid
    std::vector<Crossing> wrong_pieces = {};
};

// Sets the state to the polynomial about `from` at τ.
void move_to(Continuation& run, const State<double>& from, double tau);

}  // namespace elastocheck::recursive::series
