// Value of a FUNCTION expression of an ADAMS dataset at one time, at rest: a sum of a constant, multiples of
// displacements, and curves of one displacement each,
//
//   f = c + Σ k_m x_m + Σ s_n g_n(x_n).
//
// An expression of another form has an unknown value, with the reason.
#pragma once

#include <compare>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::importer::adm {

// DX(i, j, rm), ...: displacement of marker i relative to j in the axes of rm; j or rm 0: global frame.
struct Measure {
    enum class Kind { DM, DX, DY, DZ, AX, AY, AZ } kind = Kind::DM;
    int i = 0, j = 0, rm = 0;
    auto operator<=>(const Measure&) const = default;
};

// factor · g(u), u = scale · x + offset, x the measure:
//   spline   g(u) the interpolant of SPLINE/spline
//   impact   g(u) = rate · p^exponent, or with a spline its value at p, p = max(contact - u, 0)
struct CurveTerm {
    enum class Kind { spline, impact } kind = Kind::spline;
    double factor = 1;
    Measure measure;
    double scale = 1, offset = 0;
    int spline = 0;        // id; 0: none
    bool is_akima = true;  // the spline is interpolated by Akima's method, else by a cubic spline
    double contact = 0, rate = 0, exponent = 1;
    bool operator==(const CurveTerm&) const = default;
};

struct Value {
    double constant = 0;                        // c
    std::map<Measure, double> linear = {};      // x_m -> k_m
    std::vector<CurveTerm> curves = {};         // s_n g_n
    bool of_time = false, of_velocity = false;  // depends on TIME, on a velocity
    double per_time = 0;       // d constant / d TIME where the constant is linear in TIME, else NaN
    std::string unknown = {};  // why the value is not known at rest; empty if it is known

    bool is_known() const { return unknown.empty(); }
    bool is_constant() const { return is_known() && linear.empty() && curves.empty(); }
};

struct Context {
    double time = 0;
    bool drop_friction = false;  // a SIGN of a velocity is zero instead of unknown
    // if not null, collects the times at which a STEP begins or ends or an IF changes
    std::vector<double>* events = nullptr;
    std::function<Value(int id)> variable = {};  // value of a VARIABLE, for VARVAL
};

// Value of an expression. Text that cannot be read gives an unknown value.
Value static_value(std::string_view text, const Context& context);

}  // namespace elastocheck::importer::adm
