// State of a continuation by power series: the present point and expansion, and the path so far.
#pragma once

#include <vector>

#include "models/parameter_unit.hpp"
#include "recursive/series/expand.hpp"
#include "recursive/series/path.hpp"
#include "recursive/series/pieces.hpp"
#include "recursive/stepping/stepping_state.hpp"

namespace elastocheck::recursive::series {

// One continuation: t from 0 to 1 while the start settles, or a from 0 to the branch's end.
struct Continuation {
    SteppingState& s;
    const recursive::Series& options;
    Equations<double> e;
    Coefficients<double> c;
    std::vector<CurvePiece>& curves;
    KnotTolerance near;
    double to;   // end of the branch in the parameter
    double end;  // last value that is followed: `to`, or less where a driven length becomes zero
    double a_1;  // of the next expansion; by arc length only its sign counts, where `ahead` is zero
    double per_unit;       // metres equivalent to an error of one unit of the parameter
    Vector<double> ahead;  // x'(τ) at the end of the last expansion: the forward direction
    // a'(τ) at the end of the last expansion: positive where the parameter increases
    double heading = 0;
    int sign_at_start = 0;        // determinant_sign() at the start of the path
    Matrix<double> softest = {};  // the basis that min_stiffness() keeps
    bool stable = false;          // whether the start is stable; then every later point must be
    double log_begin = 0;         // log₂ |determinant| at the start of the expansion
    // determinant() at the midpoint of the expansion; -1 if the matrix is singular there
    double at_middle = 1;
    bool reversed = false;  // whether an element reversed at the end of the last expansion
    Vector<double> x;       // value of the polynomial
    Path path;

    Continuation(SteppingState& s_, std::vector<CurvePiece>& curves_,
                 const recursive::Series& options_, Drive drive)
        : s(s_),
          options(options_),
          e(equations<double>(s.model, s.branch, options.order, drive)),
          c(reserve_coefficients<double>(s.n() + s.m(), options.order)),
          curves(curves_),
          near{s.setup.length, 0.1 * options.tolerance, 10 * options.tolerance},
          to(drive == Drive::start ? 1 : s.branch.to),
          end(drive == Drive::start ? 1 : s.setup.end),
          a_1(to),
          per_unit(s.setup.length / std::abs(to)),
          ahead(Vector<double>::Zero(s.n() + s.m())) {
        e.G_d = -s.start.R_d;
        e.Phi_d = s.start.Phi_d;
        for (const auto& curve : curves) use(curve);
    }
    // Sets the piece of the curve in the equations and in the inputs.
    void use(const CurvePiece& curve) {
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

// Range of τ in which the present expansion is used, whether the branch ends there, and knots
// crossed there.
struct End {
    double tau = 0;
    bool last = false;
    std::vector<Crossing> crossings = {};
    // deformations that leave their piece at τ = 0: the expansion is invalid
    std::vector<Crossing> wrong_pieces = {};
};

// Sets the state to the polynomial about `from` at τ.
void move_to(Continuation& w, const State<double>& from, double tau);

}  // namespace elastocheck::recursive::series
