// Static part of a FUNCTION expression in an ADAMS dataset.
// It is a sum of a constant, multiples of displacements, and curves of one displacement,
//
//   f = c + Σ k_m x_m + Σ s_n g_n(x_n),
//
// at one time, at rest. For other functions the reason is stored.
#pragma once

#include <compare>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::importer::adm {

// DX(i, j, rm), ...: displacement of marker i relative to j, in the axes of rm. j or rm
// 0: global frame.
struct Measure {
    enum class Kind { DM, DX, DY, DZ, AX, AY, AZ } kind = Kind::DM;
    int i = 0, j = 0, rm = 0;
    auto operator<=>(const Measure&) const = default;
};

// A curve of scale · x + offset.
struct CurveTerm {
    enum class Kind { spline, impact } kind = Kind::spline;
    double factor = 1;  // of the curve
    Measure of;
    double scale = 1, offset = 0;
    // Its id. For an impact: replaces the power, over the penetration; 0 if there is none.
    int spline = 0;
    bool is_akima = true;  // its interpolant is Akima's, else a cubic spline
    double contact = 0, rate = 0,
           exponent = 1;  // of an impact: rate · (contact - x)^exponent below contact, else 0
    bool operator==(const CurveTerm&) const = default;
};

struct Value {
    double constant = 0;
    std::map<Measure, double> linear = {};
    std::vector<CurveTerm> curves = {};
    bool of_time = false, of_velocity = false;
    double per_time = 0;       // d constant / d TIME where the constant is linear in TIME, else NaN
    std::string unknown = {};  // why the value is not known at rest; empty if it is known

    bool is_known() const { return unknown.empty(); }
    bool is_constant() const { return is_known() && linear.empty() && curves.empty(); }
};

struct Context {
    double time = 0;
    bool drop_friction = false;  // a SIGN of a velocity is zero instead of unknown
    std::vector<double>* events =
        nullptr;  // if not null, collects the times at which a STEP begins or ends or an IF changes
    std::function<Value(int id)> variable = {};  // VARVAL
};

// Never throws: unreadable text gives an unknown value.
Value static_value(std::string_view text, const Context& context);

}  // namespace elastocheck::importer::adm
