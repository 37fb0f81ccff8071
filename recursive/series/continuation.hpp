// A path in the making: the state, the present expansion and what is known of the path behind it.
#pragma once

#include <vector>

#include "recursive/formula/parameter.hpp"
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
    std::vector<Followed>& curves;
    Near near;
    double to;   // of the parameter
    double end;  // the last one that is followed: `to`, or before a driven length is zero
    // a_1 of the next expansion; by arc length its sign, where `ahead` is zero
    double first;
    double per_unit;       // metres equivalent to an error of one unit of the parameter
    Vector<double> ahead;  // x'(τ) at the end of the last expansion: the forward direction
    // a'(τ) at the end of the last expansion: positive where the parameter increases
    double heading = 0;
    // sign of the determinant at the start; by arc length of the matrix bordered by x'
    int side = 0;
    Matrix<double> softest = {};
    bool stable = false;   // whether the start is stable; then every later point must be
    double log_begin = 0;  // log₂ |determinant| at the start of the expansion
    // determinant() at the midpoint of the expansion; -1 if the matrix is singular there
    double in_middle = 1;
    bool reversed = false;  // whether an element reversed at the end of the last expansion
    Vector<double> x;       // value of the polynomial
    Path path;

    Continuation(SteppingState& s_, std::vector<Followed>& curves_,
                 const recursive::Series& options_, Drive drive)
        : s(s_),
          options(options_),
          e(equations<double>(s.model, s.branch, options.order, drive)),
          c(reserve_coefficients<double>(s.n() + s.m(), options.order)),
          curves(curves_),
          near{s.setup.length, 0.1 * options.tolerance, 10 * options.tolerance},
          to(drive == Drive::start ? 1 : s.branch.to),
          end(drive == Drive::start ? 1 : s.setup.end),
          first(to),
          per_unit(s.setup.length / std::abs(to)),
          ahead(Vector<double>::Zero(s.n() + s.m())) {
        e.G_d = -s.start.R_d;
        e.Phi_d = s.start.Phi_d;
        for (const auto& curve : curves) follow(curve);
    }
    void follow(const Followed& curve) {
        follow_on(curve, e);
        follow_on(curve, s.inputs);
    }
    bool by_arc() const { return options.arc_length && e.drive == Drive::rate; }
    double at() const { return parameter(s, e.drive); }
    void go_to(double value) {
        recursive::go_to(s, e.drive == Drive::start ? recursive::Parameters{value, 0}
                                                    : recursive::Parameters{1, value});
        s.a = s.parameters.a;
    }
};

// A crossing of a knot, by the number of the curve.
struct Crossing {
    std::size_t curve = 0;
    int direction = 0;
};

// Range of τ in which the present expansion is used, whether the branch ends there, and knots
// crossed there.
struct End {
    double tau = 0;
    bool last = false;
    std::vector<Crossing> over = {};
    // deformations outside their piece from the start: the expansion is invalid
    std::vector<Crossing> at_once = {};
};

// Sets the state to the polynomial about `from` at τ.
void move_to(Continuation& w, const State<double>& from, double tau);

}  // namespace elastocheck::recursive::series
