// Converts ADAMS forces along a line, torques about an axis, and forces given by expressions.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "models/import/adm/bushings.hpp"

namespace elastocheck::importer::adm {
namespace {

using Eigen::Vector3d;

// ---- Forces along a line, and torques about an axis.

struct StopLaw {
    bool is_bump = true;
    double contact = 0;  // deformation x at which it touches
    Rows curve = {};     // force over the penetration; empty: the rate applies
    double rate = 0;
    bool extrapolates = true;
};

// Restoring force f(x) = -value of one deformation x, in units of the scene.
struct ForceLaw {
    double rate = 0;  // df/dx
    double f_0 = 0;   // f(0)
    Rows curve = {};  // replaces rate and f_0
    bool extrapolates = true;
    std::vector<StopLaw> stops = {};

    bool is_zero() const { return curve.empty() && rate == 0 && f_0 == 0 && stops.empty(); }
};

constexpr int rows_of_power = 24;  // of the table of an impact with an exponent

// Converts a Value whose terms are all of one measure to a law. The functions that return text return the
// reason why a scene cannot represent a term; empty if it can.
struct LawConversion {
    Conversion& c;
    const Statement& s;
    bool is_angle;    // the law is torsional, and its force is a torque
    double from, to;  // range of x [length of the scene, rad], for tables of a power
    const Units& units = c.geometry.units;
    double unit = is_angle ? 1 : units.length;
    double force = is_angle ? units.force * units.length : units.force;
    std::string unit_of_x = is_angle ? "rad" : units.length_name;
    std::string unit_of_force =
        is_angle ? units.force_name + " " + units.length_name : units.force_name;

    // Warns if the scene's interpolant of a SPLINE deviates from that of ADAMS.
    void warn_of_spline(const CurveTerm& term, const Rows& rows) const {
        const InterpolantDeviation deviation =
            term.is_akima ? deviation_from_akima(rows) : deviation_from_natural_spline(rows);
        if (deviation.force > 1e-6 * deviation.largest_force)
            c.warn(s,
                   "differs by up to {:.3g} {} (of {:.4g}), at {:.4g} {}: between the points of "
                   "SPLINE/{} the file has {}, the scene the monotone interpolant",
                   deviation.force, unit_of_force, deviation.largest_force, deviation.at, unit_of_x,
                   term.spline, term.is_akima ? "Akima's curve" : "a cubic spline");
    }

    // The points of the term's SPLINE; null, with the reason in `why`, if there are none.
    const Table* points_of(const CurveTerm& term, std::string& why) const {
        const auto found = c.splines.find(term.spline);
        if (found != c.splines.end()) return &found->second;
        why = fmt::format("SPLINE/{} does not exist or has no points", term.spline);
        return nullptr;
    }

    std::string add_stop(const CurveTerm& term, ForceLaw& law) const {
        if (!(term.factor > 0) == (term.scale > 0))
            return "a contact with a tensile force, which no stop of a scene has";
        StopLaw stop{.is_bump = term.scale > 0,
                     .contact = (term.contact - term.offset) / term.scale * unit};
        const double scale = std::abs(term.scale), size = std::abs(term.factor);
        if (term.spline != 0) {
            std::string why;
            const Table* points = points_of(term, why);
            if (!points) return why;
            if (points->x.front() != 0 || points->y.front() != 0)
                return fmt::format("SPLINE/{} of a penetration does not begin at 0, 0",
                                   term.spline);
            stop.extrapolates = points->extrapolates;
            for (std::size_t n = 0; n < points->x.size(); ++n)
                stop.curve.emplace_back(points->x[n] / scale * unit, size * points->y[n] * force);
            warn_of_spline(term, stop.curve);
        } else {
            // Over the penetration p of x: factor · rate · (|scale| p)^e.
            const double factor = size * term.rate * std::pow(scale / unit, term.exponent) * force;
            if (term.exponent == 1)
                stop.rate = factor;
            else
                tabulate(factor, term.exponent, stop);
        }
        law.stops.push_back(stop);
        return {};
    }
    // factor · p^exponent as a table.
    void tabulate(double factor, double exponent, StopLaw& stop) const {
        const double depth = std::max(
            std::abs(stop.is_bump ? stop.contact - from : to - stop.contact), 1e-3 * (to - from));
        for (int n = 0; n <= rows_of_power; ++n) {
            const double p = depth * n * n / (rows_of_power * rows_of_power);
            stop.curve.emplace_back(p, factor * std::pow(p, exponent));
        }
        const InterpolantDeviation deviation = deviation_from_power(stop.curve, factor, exponent);
        c.warn(s,
               "differs by up to {:.2g} {} (of {:.4g}): a contact with exponent {:g} becomes a "
               "table of {} rows up to {:.4g} {}",
               deviation.force, unit_of_force, deviation.largest_force, exponent, rows_of_power + 1,
               depth, unit_of_x);
    }

    std::string add_curve(const CurveTerm& term, ForceLaw& law) const {
        if (!law.curve.empty()) return "a sum of two splines";
        std::string why;
        const Table* points = points_of(term, why);
        if (!points) return why;
        law.extrapolates = points->extrapolates;
        for (std::size_t n = 0; n < points->x.size(); ++n)
            law.curve.emplace_back((points->x[n] - term.offset) / term.scale * unit,
                                   -term.factor * points->y[n] * force);
        if (term.scale < 0) std::ranges::reverse(law.curve);
        warn_of_spline(term, law.curve);
        return {};
    }

    std::string convert(const Value& value, ForceLaw& law) const {
        for (const auto& [measure, k] : value.linear) law.rate += -k * force / unit;
        law.f_0 = -value.constant * force;
        for (const CurveTerm& term : value.curves)
            if (const std::string why = term.kind == CurveTerm::Kind::impact ? add_stop(term, law)
                                                                             : add_curve(term, law);
                !why.empty())
                return why;
        for (auto& [x, f] : law.curve) f += law.rate * x + law.f_0;
        for (std::size_t n = 1; n < law.curve.size(); ++n)
            if (!(law.curve[n].second >= law.curve[n - 1].second))
                return fmt::format(
                    "a force that decreases with the deformation (at {:.6g}), which a scene does "
                    "not allow",
                    law.curve[n].first);
        if (law.curve.empty() && law.rate < 0)
            return "a negative rate, which a scene does not allow";
        return {};
    }
};

void add_stops(Fields& fields, const ForceLaw& law, double drawn, const std::string& ending) {
    for (const StopLaw& stop : law.stops) {
        Fields stop_fields;
        stop_fields.add("clearance",
                        computed(stop.is_bump ? drawn - stop.contact : stop.contact - drawn,
                                 std::max(1.0, std::abs(drawn))));
        if (stop.curve.empty())
            stop_fields.add("rate", stop.rate);
        else
            stop_fields.add("curve", curve_of_rows(stop.curve, stop.extrapolates));
        fields.add((stop.is_bump ? "bump" : "rebound") + ending, stop_fields.braced());
    }
}

// A force along the line from I to J, positive if repulsive; `value` is a function of DM(I, J).
void put_spring(Conversion& c, const Statement& s, const Marker& I, const Marker& J,
                const Value& value, bool is_damper) {
    const double drawn = (I.pose.r - J.pose.r).norm();
    const std::string name = c.name(c.element_names, s);
    const auto ends = [&](const std::string& bodies) {
        return Fields{}.add("bodies", bodies).add("from", c.point(I)).add("to", c.point(J));
    };
    if (!(drawn > 1e-9 * c.geometry.size)) return c.miss(s, "its ends coincide in the file");
    ForceLaw law;
    const std::string why = LawConversion{c, s, false, 0, 2 * drawn}.convert(value, law);
    if (!why.empty()) return c.miss(s, why);
    if (law.stops.size() > 2 ||
        (law.stops.size() == 2 && law.stops[0].is_bump == law.stops[1].is_bump))
        return c.miss(s, "more than one stop per direction");
    if (law.is_zero()) {
        if (!is_damper || c.options.drop_dynamics) return c.leave_out(s, "without force at rest");
        const std::string bodies = fmt::format("[{}, {}]", c.body(I.part), c.body(J.part));
        c.dampers.push_back({I.part, J.part, {name, ends(bodies).braced(), s.place()}});
        return;
    }
    Fields fields = ends(c.pair(I.part, J.part));
    const auto add_line = [&](double f, double slope) {  // a straight line over the drawn length
        const double h = 0.5 * drawn;
        fields.add("curve", curve_of_rows({{-h, f - slope * h}, {h, f + slope * h}}, true));
    };
    const double free = -law.f_0 / law.rate;  // free length of a linear law
    if (!law.curve.empty()) {
        for (auto& [x, f] : law.curve) x -= drawn;
        fields.add("curve", curve_of_rows(law.curve, law.extrapolates));
    } else if (law.rate > 0 && free > 0) {
        fields.add("rate", law.rate).add("free_length", computed(free));
        if (free < drawn * (1 - 1e-9))
            c.warn(s, "this spring is in tension at the position in the file");
    } else if (law.rate > 0) {  // as a table, since a free length must be positive
        add_line(law.f_0 + law.rate * drawn, law.rate);
    } else if (law.f_0 != 0) {
        add_line(law.f_0, 0);
    } else {
        add_stops(fields, law, drawn, "");
        c.draft.stops.push_back({name, fields.braced(), s.place()});
        return;
    }
    add_stops(fields, law, drawn, "_stop");
    c.draft.springs.push_back({name, fields.braced(), s.place()});
}

// A torque about z, positive on I; `value` is a function of AZ(I, J).
void put_torsion(Conversion& c, const Statement& s, const Marker& I, const Marker& J,
                 const Value& value) {
    const Vector3d z = J.axis(2);
    if (const double off = z.cross(I.axis(2)).norm(); off > 1e-2)
        s.fail("the axes z of I and J are {:.3g} deg apart; a torque needs one axis",
               off * 180 / std::numbers::pi);
    const double drawn = angle_about_z(I, J);
    ForceLaw law;
    const std::string why = LawConversion{c, s, true, -3.14, 3.14}.convert(value, law);
    if (!why.empty()) return c.miss(s, why);
    if (!law.stops.empty()) return c.miss(s, "a stop of a rotation, which a scene does not have");
    if (law.is_zero()) return c.leave_out(s, "without force at rest");
    Fields fields;
    fields.add("bodies", c.pair(J.part, I.part)).add("at", c.point(I)).add("axis", direction(z));
    if (!law.curve.empty()) {
        for (auto& [x, f] : law.curve) x -= drawn;
        fields.add("curve", curve_of_rows(law.curve, law.extrapolates));
    } else {
        fields.add("rate", law.rate);
        const double moment = law.f_0 + law.rate * drawn;
        if (std::abs(moment) > 1e-12 * (std::abs(law.f_0) + std::abs(law.rate)))
            fields.add("preload_moment", computed(moment));
    }
    c.draft.torsion_springs.push_back({c.name(c.element_names, s), fields.braced(), s.place()});
}

bool is_rotational(const Statement& s) {
    const bool rotates = s.has("ROTATIONAL");
    if (!rotates && !s.has("TRANSLATIONAL")) s.fail("neither TRANSLATIONAL nor ROTATIONAL");
    return rotates;
}

void convert_springdamper(Conversion& c, const Statement& s) {
    const Marker &I = c.marker(s, "I"), &J = c.marker(s, "J");
    const bool rotates = is_rotational(s);
    if (!c.is_between_two(s, I, J)) return;
    c.count("SPRINGDAMPER");
    const double k = s.number(rotates ? "KT" : "K", 0);
    const bool damps = s.number(rotates ? "CT" : "C", 0) != 0;
    if (damps && k != 0) c.leave_out(s, "damping", "without effect at rest");
    const double free =
        rotates ? s.number("ANGLE", 0, Statement::Unit::angle) : s.number("LENGTH", 0);
    Value value{.constant = s.number(rotates ? "TORQUE" : "FORCE", 0) + k * free};
    if (k != 0) value.linear[{.kind = rotates ? Measure::Kind::AZ : Measure::Kind::DM}] = -k;
    if (rotates)
        put_torsion(c, s, I, J, value);
    else
        put_spring(c, s, I, J, value, damps);
}

// ---- Forces given by expressions.

// One component of a force or torque on I that does not depend on displacements, along an axis fixed to the
// part (a follower) or to ground. Its value at time 0 is a static load; its change over time becomes a branch.
struct LoadComponent {
    Vector3d axis;
    bool is_moment = false;
    TimeFunction value;  // [unit of the file]
};

void put_load(Conversion& c, const Statement& s, const Marker& I,
              const std::vector<LoadComponent>& components, bool follows) {
    const Units& units = c.geometry.units;
    const std::string name = c.name(c.load_names, s);
    const auto load = [&](const Vector3d& v, bool is_moment) {
        Fields fields;
        fields.add("on", c.body(I.part));
        if (!is_moment) fields.add("at", c.point(I));
        fields.add(is_moment ? "moment" : "force", triple(v));
        if (follows) fields.add("follows", "true");
        return fields.braced();
    };
    Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
    for (const auto& [axis, is_moment, value] : components) {
        const double unit = units.force * (is_moment ? units.length : 1);
        (is_moment ? moment : force) += axis * value.first.constant * unit;
        if (!value.varies()) continue;
        Drive drive{.kind = is_moment ? Drive::Kind::moment : Drive::Kind::force,
                    .quantity = c.load_names.take(name + ".change"),
                    .from = s.place()};
        for (const double x : value.path) drive.path.push_back((x - value.path[0]) * unit);
        drive.least = (value.least - value.path[0]) * unit;
        drive.most = (value.most - value.path[0]) * unit;
        c.draft.loads.push_back({drive.quantity, load(axis, is_moment), s.place()});
        c.drives.push_back(std::move(drive));
    }
    if (!force.isZero(0)) c.draft.static_loads.push_back({name, load(force, false), s.place()});
    if (!moment.isZero(0))
        c.draft.static_loads.push_back(
            {c.load_names.take(name + ".moment"), load(moment, true), s.place()});
}

// A scene has no branch for a force between two parts that changes with time. If all its values lie
// between the first and the last, it is held at the last, with a warning. Returns the reason if
// that is not possible; else empty.
std::string hold_final_value(Conversion& c, const Statement& s, const TimeFunction& time_function,
                             Value& value) {
    if (!time_function.varies()) return {};
    const double first = time_function.path.front(), last = time_function.path.back();
    const double round_off = 1e-12 * (time_function.most - time_function.least);
    const bool goes_one_way = std::min(first, last) <= time_function.least + round_off &&
                              std::max(first, last) >= time_function.most - round_off;
    if (!goes_one_way || !value.is_constant())
        return fmt::format(
            "a force between two parts that changes with time, {:g} to {:g}, which a scene cannot "
            "represent",
            time_function.least, time_function.most);
    c.warn(s,
           "a force between two parts that changes from {:g} to {:g} over {:g} of time; the scene "
           "has its final value",
           first, last, c.times.back());
    value.constant = last;
    return {};
}

void convert_sforce(Conversion& c, const Statement& s) {
    const Marker &I = c.marker(s, "I"), &J = c.marker(s, "J");
    const bool rotates = is_rotational(s);
    if (s.has("ROUTINE")) return c.miss(s, "its force is a user-written function");
    const std::string* text = s.expression("FUNCTION");
    if (!text) s.fail("FUNCTION is missing");
    const TimeFunction time_function = c.time_function(*text);
    Value value = time_function.first;
    if (!value.is_known()) return c.miss(s, value.unknown);
    const bool is_zero = value.is_constant() && value.constant == 0 && !time_function.varies();
    if (is_zero && !value.of_velocity) return c.leave_out(s, "without force at rest");
    if (s.has("ACTIONONLY")) {
        if (I.floats || c.is_flexible(I) || c.is_ground(I.part))
            return c.leave_out(s, "acting on ground only");
        if (!value.is_constant())
            return c.miss(s, "a force on a single part that depends on displacements");
        if (is_zero) return c.leave_out(s, "without force at rest");
        const bool follows = J.part == I.part;
        if (!follows && !c.is_ground(J.part))
            return c.miss(s, "a force on a single part along an axis of another moving part");
        c.count("SFORCE");
        return put_load(c, s, I, {{J.axis(2), rotates, time_function}}, follows);
    }
    if (const std::string why = hold_final_value(c, s, time_function, value); !why.empty())
        return c.miss(s, why);
    if (!c.is_between_two(s, I, J)) return;
    // Expresses the value by DM(I, J) = DM(J, I), or by AZ(I, J) = -AZ(J, I).
    const int i = I.statement->id, j = J.statement->id;
    const auto kind = rotates ? Measure::Kind::AZ : Measure::Kind::DM;
    const auto sign = [&](const Measure& m) {
        if (m.kind == kind && m.i == i && m.j == j) return 1;
        return m.kind == kind && m.i == j && m.j == i ? (rotates ? -1 : 1) : 0;
    };
    Value own{.constant = value.constant};
    bool is_own = true;
    for (const auto& [measure, k] : value.linear) {
        is_own &= sign(measure) != 0;
        own.linear[{.kind = kind}] += sign(measure) * k;
    }
    for (CurveTerm term : value.curves) {
        is_own &= sign(term.measure) != 0;
        term.scale *= sign(term.measure);
        own.curves.push_back(term);
    }
    if (!is_own) return c.miss(s, "a force that depends on a displacement between other markers");
    if (value.of_velocity && !own.is_constant())
        c.leave_out(s, "damping", "without effect at rest");
    c.count("SFORCE");
    if (rotates)
        put_torsion(c, s, I, J, own);
    else
        put_spring(c, s, I, J, own, value.of_velocity);
}

constexpr const char* components[] = {"FX", "FY", "FZ", "TX", "TY", "TZ"};

// VFORCE, VTORQUE or GFORCE: components in the axes of RM of a wrench on I, with the opposite wrench on the
// part of JFLOAT, that depend on displacements of I from one marker on that part. The functions that
// return text return the reason why a scene cannot represent it; empty if it can.
struct VectorForce {
    Conversion& c;
    const Statement& s;
    const Marker& I;
    const Marker& RM;
    std::array<Value, 6> value = {};
    const Marker* from = nullptr;  // the marker on the other part
    SixLaws laws = {};

    // The component 0-5 of a displacement of I in the axes of RM, or of an angle about them, and its sign; -1
    // for any other measure.
    int axis_of(const Measure& m, double& sign) {
        const auto has_axes_of_rm = [&](int id) {
            const Marker& other = c.marker(s, id);
            return other.part == RM.part && (other.pose.A - RM.pose.A).norm() <= 1e-9;
        };
        const int k = static_cast<int>(m.kind) - static_cast<int>(Measure::Kind::DX);
        if (k < 0 || m.j == 0) return -1;
        const bool of_I = m.i == I.statement->id, from_I = m.j == I.statement->id;
        const int other = of_I ? m.j : m.i;
        if (of_I == from_I || c.marker(s, other).part != RM.part) return -1;
        sign = of_I ? 1 : -1;
        if (k >= 3) return of_I && has_axes_of_rm(other) ? k : -1;
        if (m.rm == 0 || !has_axes_of_rm(m.rm)) return -1;
        const Marker& origin = c.marker(s, other);
        if (from && (from->pose.r - origin.pose.r).norm() > 1e-12 * c.geometry.size) return -1;
        from = &origin;
        return k;
    }

    // Splits the components into a stiffness and curves of their own displacement.
    std::string split(Matrix6& K, std::array<Value, 6>& curves) {
        for (int r = 0; r < 6; ++r) {
            const auto component = static_cast<std::size_t>(r);
            const std::string name = components[component],
                              other = name +
                                      ": a force that depends on a displacement other than "
                                      "that of its own marker in the axes of the force";
            double sign = 1;
            for (const auto& [measure, k] : value[component].linear) {
                const int axis = axis_of(measure, sign);
                if (axis < 0) return other;
                K(r, axis) += -sign * k;
            }
            for (CurveTerm term : value[component].curves) {
                if (axis_of(term.measure, sign) != r) return other;
                if (term.kind == CurveTerm::Kind::impact)
                    return name + ": a contact in one direction of a vector";
                term.scale *= sign;
                curves[component].curves.push_back(term);
            }
        }
        return {};
    }

    // Sets the curve of one component, to which the rate of its stiffness is added.
    std::string put_curve(int row, const Value& own) {
        ForceLaw law;
        const double rate = laws.K(row, row);
        const auto component = static_cast<std::size_t>(row);
        std::string why = LawConversion{c, s, row >= 3, -1, 1}.convert(own, law);
        laws.K(row, row) = 0;
        if (why.empty() && !laws.K.row(row).isZero(0))
            why = "a spline in combination with a coupled stiffness";
        if (!why.empty()) return fmt::format("{}: {}", components[component], why);
        for (auto& [x, f] : law.curve) f += rate * x;
        laws.curves[component] = law.curve;
        laws.extrapolates[component] = law.extrapolates;
        return {};
    }

    void convert(int part_j, bool damps) {
        Matrix6 K = Matrix6::Zero();
        std::array<Value, 6> curves;
        if (const std::string why = split(K, curves); !why.empty()) return c.miss(s, why);
        laws.K = in_scene_units(K, c.geometry.units);
        if (!make_symmetric(c, s, laws.K)) return;
        for (std::size_t r = 0; r < 6; ++r)
            if (!curves[r].curves.empty())
                if (const std::string why = put_curve(static_cast<int>(r), curves[r]); !why.empty())
                    return c.miss(s, why);
        if (laws.is_coupled() &&
            std::ranges::any_of(laws.curves, [](const Rows& curve) { return !curve.empty(); }))
            return c.miss(s, "a spline in combination with a coupled stiffness");
        if (damps) c.leave_out(s, "damping", "without effect at rest");
        c.count(std::string(s.keyword));
        put_bushing(c, s, I, part_j, {from ? from->pose.r : I.pose.r, RM.pose.A}, laws);
    }
};

void convert_vector(Conversion& c, const Statement& s) {
    if (s.has("FUNCTION") || s.has("ROUTINE"))
        return c.miss(s, "its force is a user-written function");
    const Marker &I = c.marker(s, "I"), &floating = c.marker(s, "JFLOAT");
    if (!s.has("RM")) return c.miss(s, "the axes of the force are unknown without RM");
    const Marker& RM = c.marker(s, "RM");
    if (RM.floats || I.floats) s.fail("I and RM must not be floating markers");
    if (c.is_flexible(I) || c.is_flexible(RM) || c.is_flexible(floating))
        return c.miss(s, "it is on a flexible body, which a scene does not have");
    VectorForce force{c, s, I, RM};
    std::array<TimeFunction, 6> time_functions;
    std::vector<LoadComponent> given;
    bool is_constant = true, is_zero = true, damps = false;
    for (std::size_t k = 0; k < 6; ++k) {
        const std::string* text = s.expression(components[k]);
        if (!text) continue;
        time_functions[k] = c.time_function(*text);
        const Value& value = force.value[k] = time_functions[k].first;
        if (!value.is_known()) return c.miss(s, "{}: {}", components[k], value.unknown);
        is_constant &= value.is_constant();
        is_zero &= value.is_constant() && value.constant == 0 && !time_functions[k].varies();
        damps |= value.of_velocity;
        given.push_back({RM.axis(static_cast<int>(k % 3)), k >= 3, time_functions[k]});
    }
    if (is_zero) return c.leave_out(s, "without force at rest");
    if (I.part == floating.part) return c.leave_out(s, "since both ends are on one part");
    const bool on_ground = c.is_ground(floating.part);
    if (is_constant && (on_ground || c.is_ground(I.part)) &&
        (c.is_ground(RM.part) || RM.part == I.part || RM.part == floating.part)) {
        // On one moving part: a dead or a follower load.
        if (!on_ground) return c.miss(s, "a constant force on a part at a marker of ground");
        c.count(std::string(s.keyword));
        return put_load(c, s, I, given, !c.is_ground(RM.part));
    }
    Vector6 F;
    for (std::size_t k = 0; k < 6; ++k) {
        if (const std::string why = hold_final_value(c, s, time_functions[k], force.value[k]);
            !why.empty())
            return c.miss(s, "{}: {}", components[k], why);
        F[static_cast<int>(k)] = force.value[k].constant;
    }
    force.laws.preload = wrench_in_scene_units(F, c.geometry.units);
    if (RM.part != floating.part)
        return c.miss(
            s, "a force between two parts in axes other than those of the part with the reaction");
    force.convert(floating.part, damps);
}

}  // namespace

void read_splines(Conversion& c) {
    for (const Statement& s : c.data.statements) {
        if (!s.is("SPLINE")) continue;
        if (s.has("FILE") || s.has("Z")) {  // reported as missing by the statements that use it
            c.leave_out(s, "with points in another file, or of two variables");
            continue;
        }
        const Table table{.x = s.numbers("X", 2, 10'000),
                          .y = s.numbers("Y", 2, 10'000),
                          .extrapolates = s.has("LINEAR_EXTRAPOLATE")};
        if (table.x.empty() || table.x.size() != table.y.size())
            s.fail("{} X and {} Y; their numbers must be equal", table.x.size(), table.y.size());
        const auto not_rising = std::ranges::adjacent_find(table.x, std::ranges::greater_equal{});
        if (not_rising != table.x.end())
            s.fail("X: {:g} is not larger than the value before", *(not_rising + 1));
        c.splines.emplace(s.id, table);
        c.count("SPLINE");
    }
}

void convert_forces(Conversion& c) {
    for (const Statement& s : c.data.statements) {
        if (s.is("BUSHING")) convert_bushing(c, s);
        if (s.is("FIELD")) convert_field(c, s);
        if (s.is("BEAM")) convert_beam(c, s);
        if (s.is("SPRINGDAMPER")) convert_springdamper(c, s);
        if (s.is("SFORCE")) convert_sforce(c, s);
        if (s.is("VFORCE VTORQUE GFORCE")) convert_vector(c, s);
    }
}

}  // namespace elastocheck::importer::adm
