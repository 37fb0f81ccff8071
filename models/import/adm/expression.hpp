// A FUNCTION of a dataset, as far as statics knows it: a sum of a constant, multiples of displacements, and curves of one
// displacement,
//
//   f = c + Σ k_m x_m + Σ s_n g_n(x_n),
//
// at one time, with everything at rest. What is not of this form says why.
#pragma once

#include <compare>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace elastocheck::importer::adm {

// DX(i, j, rm), ...: how marker i stands against j, in the axes of rm. j or rm 0 is the global frame.
struct Measure {
    enum class Kind { DM, DX, DY, DZ, AX, AY, AZ } kind = Kind::DM;
    int i = 0, j = 0, rm = 0;
    auto operator<=>(const Measure&) const = default;
};

// A curve of scale · x + offset.
struct CurveTerm {
    enum class Kind { akima, cubic, impact } kind = Kind::akima;
    double factor = 1;  // of the curve
    Measure of;
    double scale = 1, offset = 0;
    int spline = 0;  // its id
    double contact = 0, rate = 0,
           exponent = 1;  // of an impact: rate · (contact - x)^exponent below contact, else 0
};

struct Value {
    double constant = 0;
    std::map<Measure, double> linear = {};
    std::vector<CurveTerm> curves = {};
    bool of_time = false, of_velocity = false;
    std::string unknown = {};  // why statics cannot know it; empty where it does

    bool is_known() const { return unknown.empty(); }
    bool is_constant() const { return is_known() && linear.empty() && curves.empty(); }
};

struct Context {
    double time = 0;
    std::function<Value(int id)> variable = {};  // VARVAL
};

// Never throws: what cannot be read is unknown.
Value evaluate(std::string_view text, const Context& context);

}  // namespace elastocheck::importer::adm
