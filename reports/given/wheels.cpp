#include "reports/given/wheels.hpp"

#include <algorithm>

#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "compare/outputs/wheel_load.hpp"
#include "models/kinds.hpp"

namespace elastocheck::reports {
namespace {

bool is_effort_of(const compare::Channel& channel, int joint) {
    const auto* effort = std::get_if<compare::Effort>(&channel.reads);
    return effort != nullptr && effort->joint == joint;
}

// What the parameter of a branch moves.
struct WheelEffects {
    std::vector<double> lift;  // per wheel, vertical motion or force per unit of the parameter
    std::vector<double> push;  // likewise, force or moment as in Pushes
    bool steers = false;       // a joint that holds no wheel
    bool across = false, along_centre = false, along_patch = false;  // forces on wheels
    bool turns = false;                                              // moments
    bool other = false;
};

void add(WheelEffects& effects, const Model& model, const LoadKind& load, double rate) {
    if (is_follower(load)) {
        effects.other = true;
    } else if (is_moment(load)) {
        effects.turns = true;
        for (std::size_t w = 0; w < model.wheels.size(); ++w)
            if (model.wheels[w].body == body_of(load) &&
                std::ranges::count(model.wheels, model.wheels[w].body, &Wheel::body) == 1)
                effects.push[w] -= rate * model.wheels[w].side * load_vector(load).z();
    } else {
        const auto wheel = compare::wheel_near(model, *member<Point>(load));
        const Eigen::Vector3d v = load_vector(load), f = v.cwiseAbs();
        if (!wheel)
            effects.other = true;
        else if (f.z() > f.x() && f.z() > f.y())
            effects.lift[*wheel] += rate * v.z();
        else if (f.y() > f.x()) {
            effects.across = true;
            effects.push[*wheel] -= rate * model.wheels[*wheel].side * v.y();
        } else {
            const Wheel& loaded = model.wheels[*wheel];
            const Point& point = *member<Point>(load);
            const bool at_centre =
                point.body == loaded.body && (loaded.centre_local - point.s_local).norm() < 1e-6;
            (at_centre ? effects.along_centre : effects.along_patch) = true;
            effects.push[*wheel] += (at_centre ? rate : -rate) * v.x();
        }
    }
}

WheelEffects effects_of(const Model& model, const Branch& branch) {
    WheelEffects effects;
    effects.lift.assign(model.wheels.size(), 0);
    effects.push = effects.lift;
    for (const auto& driver : branch.drivers) {
        if (driver.rate == 0) continue;
        const auto raise = [&](std::optional<std::size_t> wheel, bool& otherwise) {
            if (wheel)
                effects.lift[*wheel] += driver.rate;
            else
                otherwise = true;
        };
        if (const Load* load = driven_load(driver.what))
            add(effects, model, load->kind, driver.rate);
        else if (const int joint = driven_joint(driver.what); joint >= 0)
            raise(compare::wheel_on_jack(model, joint), effects.steers);
        else if (const int element = driven_element(driver.what); element >= 0)
            raise(compare::wheel_on_tyre(model, element), effects.other);
        else
            effects.other = true;
    }
    return effects;
}

bool holds_a_wheel(const Model& model, const Branch& branch) {
    return std::ranges::any_of(branch.drivers, [&](const Driver& driver) {
        const int joint = driven_joint(driver.what);
        return joint >= 0 && compare::wheel_on_jack(model, joint);
    });
}

}  // namespace

const char* load_case(const Model& model, const Branch& branch) {
    const WheelEffects e = effects_of(model, branch);
    const bool lifts = std::ranges::any_of(e.lift, [](double v) { return v != 0; });
    if (e.other || model.wheels.empty() ||
        lifts + e.steers + e.across + (e.along_centre || e.along_patch) + e.turns != 1)
        return "other";
    if (e.steers) return "steering";
    if (e.across) return "lateral force";
    if (e.along_centre || e.along_patch) return "longitudinal force";
    if (e.turns) return "moment";
    const double first = e.lift.front();
    if (std::ranges::all_of(e.lift, [&](double v) { return v == first; })) return "heave";
    return e.lift.size() == 2 && e.lift[1] == -first ? "roll" : "travel";
}

std::optional<Pushes> pushes_of(const Model& model, const Branch& branch) {
    const WheelEffects e = effects_of(model, branch);
    const std::string kind = load_case(model, branch);
    const bool known = kind == "lateral force" || kind == "moment" ||
                       (kind == "longitudinal force" && e.along_centre != e.along_patch);
    if (!known || std::ranges::all_of(e.push, [](double push) { return push == 0; }))
        return std::nullopt;
    return Pushes{e.push, kind == "moment"          ? "towards toe-in"
                          : kind == "lateral force" ? "inwards"
                          : e.along_centre          ? "forward"
                                                    : "to the back"};
}

std::vector<std::string> efforts_of(const Branch& branch,
                                    const std::vector<compare::Channel>& channels) {
    std::vector<std::string> efforts;
    for (const auto& driver : branch.drivers)
        if (const int joint = driven_joint(driver.what); joint >= 0 && driver.rate != 0)
            for (const auto& channel : channels)
                if (is_effort_of(channel, joint)) efforts.push_back(channel.name);
    return efforts;
}

std::size_t settled_on(const Model& model) {
    const auto free = std::ranges::find_if_not(
        model.branches, [&](const Branch& branch) { return holds_a_wheel(model, branch); });
    return free == model.branches.end() ? 0
                                        : static_cast<std::size_t>(free - model.branches.begin());
}

std::vector<compare::StaticRow> static_rows(const Model& model,
                                            const compare::Comparison& comparison) {
    std::vector<compare::StaticRow> rows;
    if (comparison.branches.empty()) return rows;
    const compare::Curve& curve =
        comparison.branches[settled_on(model)].run(compare::Leg::equilibrium).curve;
    const auto drawn = compare::evaluate(model, comparison.channels, compare::design_state(model));
    for (std::size_t w = 0; w < model.wheels.size(); ++w) {
        const std::string& wheel = model.wheels[w].name;
        for (std::size_t c = 0; c < comparison.channels.size(); ++c) {
            const auto& channel = comparison.channels[c];
            const auto* output = std::get_if<compare::Catalogued>(&channel.reads);
            if (output != nullptr && output->of == w && output->entry->properties.at_rest &&
                channel.name.starts_with(wheel))  // not of the axle
                rows.push_back({wheel, channel.name.substr(wheel.empty() ? 0 : wheel.size() + 1),
                                symbol(channel.unit), compare::finite_or_nan(drawn[c]),
                                curve.a.empty()
                                    ? compare::nan
                                    : compare::finite_or_nan(curve.values[curve.start][c])});
        }
    }
    return rows;
}

}  // namespace elastocheck::reports
