#include "models/import/adm/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "models/import/adm/statements.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer::adm {
namespace {

constexpr int max_depth = 100;
constexpr std::size_t max_terms = 1000;
constexpr std::size_t max_length = 1 << 16;  // [bytes]

Value unknown(std::string why) { return {.unknown = std::move(why)}; }
Value constant(double x) { return {.constant = x}; }

// Marks `to` as dependent on what `from` depends on.
void inherit(Value& to, const Value& from) {
    to.of_time |= from.of_time;
    to.of_velocity |= from.of_velocity;
}

// factor · a; exactly zero for factor 0, whatever a.
Value scaled(Value a, double factor) {
    if (factor == 0) {
        Value zero;
        inherit(zero, a);
        return zero;
    }
    a.constant *= factor;
    a.per_time *= factor;
    for (auto& [measure, k] : a.linear) k *= factor;
    for (CurveTerm& curve : a.curves) curve.factor *= factor;
    return a;
}

Value sum(Value a, const Value& b) {
    if (!a.is_known()) return a;
    if (!b.is_known()) return b;
    a.constant += b.constant;
    a.per_time += b.per_time;
    for (const auto& [measure, k] : b.linear)
        if ((a.linear[measure] += k) == 0) a.linear.erase(measure);
    a.curves.insert(a.curves.end(), b.curves.begin(), b.curves.end());
    inherit(a, b);
    if (a.linear.size() + a.curves.size() > max_terms) return unknown("too many terms");
    return a;
}

Value product(const Value& a, const Value& b) {
    if (!a.is_constant() && !b.is_constant())
        return !a.is_known() ? a : !b.is_known() ? b : unknown("a product of displacements");
    const auto& [factor, other] = a.is_constant() ? std::tie(a, b) : std::tie(b, a);
    Value result = scaled(other, factor.constant);
    if (factor.of_time) result.per_time = other.of_time ? NAN : factor.per_time * other.constant;
    inherit(result, factor);
    return result;
}

Value quotient(const Value& a, const Value& b) {
    if (!b.is_known()) return b;
    if (!b.is_constant()) return unknown("a division by a displacement");
    if (b.constant == 0) return unknown("a division by zero");
    Value result = scaled(a, 1 / b.constant);
    if (b.of_time) result.per_time = NAN;
    inherit(result, b);
    return result;
}

// STEP(x, x0, h0, x1, h1): a cubic from h0 to h1.
double step(const std::vector<double>& p) {
    const double x = p[0], x0 = p[1], h0 = p[2], x1 = p[3], h1 = p[4];
    if (x <= x0) return h0;
    if (x >= x1) return h1;
    const double t = (x - x0) / (x1 - x0);
    return h0 + (h1 - h0) * t * t * (3 - 2 * t);
}

using Numbers = std::vector<double>;
using Unary = double (*)(double);
constexpr std::pair<std::string_view, Unary> unary[] = {
    {"ABS", std::abs},   {"ACOS", std::acos}, {"AINT", std::trunc},  {"ANINT", std::round},
    {"ASIN", std::asin}, {"ATAN", std::atan}, {"COS", std::cos},     {"COSH", std::cosh},
    {"EXP", std::exp},   {"LOG", std::log},   {"LOG10", std::log10}, {"SIN", std::sin},
    {"SINH", std::sinh}, {"SQRT", std::sqrt}, {"TAN", std::tan},     {"TANH", std::tanh}};
struct Function {
    std::string_view name;
    std::size_t least, most;
    double (*f)(const Numbers&);
};
constexpr Function functions[] = {
    {"ATAN2", 2, 2, [](const Numbers& p) { return std::atan2(p[0], p[1]); }},
    {"DIM", 2, 2, [](const Numbers& p) { return std::max(p[0] - p[1], 0.0); }},
    {"MAX", 1, 64, [](const Numbers& p) { return *std::ranges::max_element(p); }},
    {"MIN", 1, 64, [](const Numbers& p) { return *std::ranges::min_element(p); }},
    {"MOD", 2, 2, [](const Numbers& p) { return std::fmod(p[0], p[1]); }},
    {"SIGN", 2, 2, [](const Numbers& p) { return p[1] < 0 ? -std::abs(p[0]) : std::abs(p[0]); }},
    {"STEP", 5, 5, step}};

constexpr std::pair<std::string_view, double> constants[] = {
    {"PI", std::numbers::pi}, {"RTOD", 180 / std::numbers::pi}, {"DTOR", std::numbers::pi / 180}};
constexpr std::string_view measures[] = {"DM", "DX", "DY", "DZ", "AX", "AY", "AZ"};
// Functions of velocities and accelerations.
constexpr std::string_view zero_at_rest =
    "VR VM VX VY VZ WM WX WY WZ ACCM ACCX ACCY ACCZ WDTM WDTX WDTY WDTZ";

class Parser {
  public:
    Parser(std::string_view text, const Context& context) : text_(text), context_(context) {}

    Value parse() {
        Value value = expression();
        skip();
        return text_.empty() ? value : unreadable();
    }

  private:
    void skip() {
        while (!text_.empty() && (text_.front() == ' ' || text_.front() == '\t'))
            text_.remove_prefix(1);
    }
    bool take(char c) {
        skip();
        if (text_.empty() || text_.front() != c) return false;
        text_.remove_prefix(1);
        return true;
    }

    Value unreadable() { return give_up(reader::quote(text_.substr(0, 40)) + " cannot be read"); }
    Value give_up(const std::string& why) {
        text_ = {};
        return unknown(why);
    }

    Value expression() {
        if (++depth_ > max_depth) return give_up("brackets nested too deep");
        Value value = operations("+-");
        --depth_;
        return value;
    }

    // A sum of products of powers, or a product, from left to right.
    Value operations(std::string_view operators) {
        const bool sums = operators == "+-";
        const auto operand = [&] { return sums ? operations("*/") : power(); };
        Value value = operand();
        for (skip(); !text_.empty() && operators.find(text_.front()) != operators.npos; skip()) {
            const char c = text_.front();
            text_.remove_prefix(1);
            const Value right = operand();
            value = c == '+'   ? sum(value, right)
                    : c == '-' ? sum(value, scaled(right, -1))
                    : c == '*' ? product(value, right)
                               : quotient(value, right);
        }
        return value;
    }

    // -x**2 is -(x**2).
    Value power() {
        int sign = 1;
        for (bool minus; (minus = take('-')) || take('+');)
            if (minus) sign = -sign;
        Value base = primary();
        skip();
        if (text_.starts_with("**")) {
            text_.remove_prefix(2);
            if (++depth_ > max_depth) return give_up("powers nested too deep");
            const Value exponent = power();
            --depth_;
            if (!base.is_known()) return base;
            if (!exponent.is_known()) return exponent;
            if (!exponent.is_constant()) return unknown("a power of a displacement");
            if (base.is_constant()) {
                Value result = constant(std::pow(base.constant, exponent.constant));
                inherit(result, base);
                inherit(result, exponent);
                if (result.of_time) result.per_time = NAN;
                base = result;
            } else if (exponent.constant != 1)
                return unknown("a power of a displacement");
        }
        return sign < 0 ? scaled(std::move(base), -1) : base;
    }

    Value primary() {
        skip();
        if (take('(')) {
            Value value = expression();
            if (!take(')')) return give_up("a bracket is not closed");
            return value;
        }
        double x = 0;
        bool degrees = false;
        if (const std::size_t n = number_at(text_, x, degrees); n > 0) {
            text_.remove_prefix(n);
            return constant(degrees ? x * std::numbers::pi / 180 : x);
        }
        std::size_t n = 0;
        while (n < text_.size() && reader::is_word(text_[n])) ++n;
        if (n == 0) return unreadable();
        const std::string name = capitals(text_.substr(0, n));
        text_.remove_prefix(n);
        if (take('(')) return call(name);
        for (const auto& [known, size] : constants)
            if (name == known) return constant(size);
        if (name == "TIME") return {.constant = context_.time, .of_time = true, .per_time = 1};
        return unknown(fmt::format("{} is not a known constant", reader::quote(name)));
    }

    Value call(const std::string& name) {
        std::vector<Value> arguments;
        if (!take(')'))
            for (;;) {
                arguments.push_back(expression());
                if (take(')')) break;
                if (!take(',') && !take(':'))
                    return give_up(fmt::format("{}(: a bracket is not closed", name));
                if (arguments.size() > 64)
                    return give_up(fmt::format("{}(: too many arguments", name));
            }
        return apply(name, arguments);
    }

    static std::optional<int> id(const Value& value) {
        if (!value.is_constant() || !(value.constant >= 0) || value.constant > 1e9 ||
            value.constant != std::floor(value.constant))
            return std::nullopt;
        return static_cast<int>(value.constant);
    }

    Value apply(const std::string& name, std::vector<Value>& p) const {
        if (has_word(zero_at_rest, name)) return {.of_velocity = true};
        if (const auto found = std::ranges::find(measures, name); found != std::end(measures)) {
            Measure measure{.kind = static_cast<Measure::Kind>(found - std::begin(measures))};
            int* const to[] = {&measure.i, &measure.j, &measure.rm};
            if (p.empty() || p.size() > 3) return unknown(name + " without one to three markers");
            for (std::size_t k = 0; k < p.size(); ++k) {
                const auto marker = id(p[k]);
                if (!marker) return unknown(name + " of something other than a marker");
                *to[k] = *marker;
            }
            return {.linear = {{measure, 1}}};
        }
        if (name == "IF") return choose(p);
        if (name == "AKISPL" || name == "CUBSPL") return spline(name, p);
        if (name == "IMPACT") return impact(p);
        if (name == "DIM" && p.size() == 2 && p[0].is_constant() != p[1].is_constant())
            return penetration(p);
        if (name == "BISTOP") return bistop(p);
        if (name == "VARVAL") {
            const auto variable = p.size() == 1 ? id(p[0]) : std::nullopt;
            if (!variable || !context_.variable)
                return unknown("VARVAL of something other than a variable");
            return context_.variable(*variable);
        }
        return of_numbers(name, p);
    }

    // A function of constant arguments.
    Value of_numbers(const std::string& name, const std::vector<Value>& p) const {
        const auto of_one_argument =
            std::ranges::find(unary, name, &std::pair<std::string_view, Unary>::first);
        const auto function = std::ranges::find(functions, name, &Function::name);
        const bool is_unary = of_one_argument != std::end(unary);
        if (!is_unary && function == std::end(functions))
            return unknown(fmt::format("{}(...), an unsupported function", name));
        Numbers numbers;
        Value result;
        for (const Value& value : p) {
            if (!value.is_known()) return value;
            if (!value.is_constant()) return unknown(name + " of a displacement");
            numbers.push_back(value.constant);
            inherit(result, value);
        }
        if (name == "SIGN" && p.size() == 2 && p[1].of_velocity) {
            if (context_.drop_friction) return scaled(result, 0);
            return unknown(
                "SIGN of a velocity: friction, which also acts at rest, and a scene has no "
                "friction (--drop dynamics leaves it out)");
        }
        if (name == "STEP" && p.size() == 5)
            for (const std::size_t k : {1, 3}) note_event(p[0], p[k].constant);
        if (result.of_time) result.per_time = NAN;
        if (numbers.size() < (is_unary ? 1 : function->least) ||
            numbers.size() > (is_unary ? 1 : function->most))
            return unknown(fmt::format("{} with {} arguments", name, numbers.size()));
        result.constant = is_unary ? of_one_argument->second(numbers[0]) : function->f(numbers);
        if (!std::isfinite(result.constant))
            return unknown(name + " of numbers for which it is not defined");
        return result;
    }

    // Adds the time at which x, linear in TIME, reaches `edge` to the events.
    void note_event(const Value& x, double edge) const {
        if (!context_.events || !x.of_time || !std::isfinite(x.per_time) || x.per_time == 0) return;
        const double time = context_.time + (edge - x.constant) / x.per_time;
        if (time > 0 && std::isfinite(time)) context_.events->push_back(time);
    }

    // IF(e: a, b, c): a where e < 0, b where it is 0, c above.
    Value choose(const std::vector<Value>& p) const {
        if (p.size() != 4) return unknown("IF without four arguments");
        if (!p[0].is_known()) return p[0];
        note_event(p[0], 0);
        const auto is_zero = [](const Value& value) {
            return value.is_constant() && value.constant == 0;
        };
        Value result;
        if (p[0].is_constant())
            result = p[0].constant < 0 ? p[1] : p[0].constant == 0 ? p[2] : p[3];
        else if (!is_zero(p[1]) || !is_zero(p[2]) || !is_zero(p[3]))
            return unknown("IF on a displacement");
        inherit(result, p[0]);
        return result;
    }

    // Sets u = scale · x + offset of a term from a value of this form; else returns the reason.
    static std::string set_argument(const Value& x, CurveTerm& term) {
        if (!x.is_known()) return x.unknown;
        if (!x.curves.empty() || x.linear.size() != 1)
            return "a curve that is not over one displacement";
        term.measure = x.linear.begin()->first;
        term.scale = x.linear.begin()->second;
        term.offset = x.constant;
        return {};
    }

    // A value that is the curve alone, with the dependences of its argument x.
    static Value value_of(const CurveTerm& curve, const Value& x) {
        Value value;
        inherit(value, x);
        value.curves.push_back(curve);
        return value;
    }

    Value spline(const std::string& name, const std::vector<Value>& p) const {
        if (p.size() < 3 || p.size() > 4) return unknown(name + " without three or four arguments");
        if (!p[1].is_constant() || p[1].constant != 0)
            return unknown(name + " of a second variable");
        if (p.size() == 4 && !(p[3].is_constant() && p[3].constant == 0))
            return unknown("a derivative of " + name);
        const auto number = id(p[2]);
        if (!number) return unknown(name + " of something other than a spline");
        CurveTerm term;
        if (is_penetration(p[0]))
            term = p[0].curves.front();
        else if (const std::string why = set_argument(p[0], term); !why.empty())
            return unknown(p[0].is_constant() ? name + " without a displacement" : why);
        term.is_akima = name == "AKISPL";
        term.spline = *number;
        return value_of(term, p[0]);
    }

    // DIM(a, b) = max(a - b, 0) of a displacement and a constant, as an impact of rate 1.
    static Value penetration(const std::vector<Value>& p) {
        const Value unit = constant(1);
        Value value = p[0].is_constant() ? contact(p[1], p[0], unit, unit)
                                         : contact(scaled(p[0], -1), scaled(p[1], -1), unit, unit);
        value.of_velocity = p[0].of_velocity || p[1].of_velocity;
        return value;
    }
    static bool is_penetration(const Value& x) {
        if (!x.is_known() || x.constant != 0 || !x.linear.empty() || x.curves.size() != 1)
            return false;
        const CurveTerm& term = x.curves.front();
        return term.kind == CurveTerm::Kind::impact && term.factor == 1 && term.rate == 1 &&
               term.exponent == 1 && term.spline == 0;
    }

    // IMPACT(x, v, x1, k, e, c, d): k (x1 - x)^e below x1; its damping is zero at rest.
    static Value impact(const std::vector<Value>& p) {
        if (p.size() != 7) return unknown("IMPACT without seven arguments");
        return contact(p[0], p[2], p[3], p[4]);
    }
    // BISTOP(x, v, lo, hi, k, e, c, d): the same below lo, and its mirror image above hi.
    static Value bistop(const std::vector<Value>& p) {
        if (p.size() != 8) return unknown("BISTOP without eight arguments");
        return sum(contact(p[0], p[2], p[4], p[5]),
                   scaled(contact(scaled(p[0], -1), scaled(p[3], -1), p[4], p[5]), -1));
    }
    static Value contact(const Value& x, const Value& at, const Value& rate,
                         const Value& exponent) {
        CurveTerm term;
        term.kind = CurveTerm::Kind::impact;
        for (const Value* value : {&at, &rate, &exponent})
            if (!value->is_constant())
                return unknown(value->is_known() ? "IMPACT or BISTOP with variable parameters"
                                                 : value->unknown);
        if (const std::string why = set_argument(x, term); !why.empty()) return unknown(why);
        term.contact = at.constant;
        term.rate = rate.constant;
        term.exponent = exponent.constant;
        if (!(term.rate >= 0) || !(term.exponent > 0))
            return unknown("IMPACT or BISTOP with a tensile force");
        Value value = value_of(term, x);
        value.of_velocity = true;
        return value;
    }

    std::string_view text_;
    const Context& context_;
    int depth_ = 0;
};

}  // namespace

Value static_value(std::string_view text, const Context& context) {
    if (text.size() > max_length) return unknown("too long for a function");
    Parser parser(text, context);
    Value value = parser.parse();
    if (value.is_known() && !std::isfinite(value.constant))
        return unknown("a number that is not finite");
    for (const auto& [measure, k] : value.linear)
        if (!std::isfinite(k)) return unknown("a number that is not finite");
    return value;
}

}  // namespace elastocheck::importer::adm
