// Runs the three legs on every branch, judges each state by the equations of the other legs, and
// compares the curves: deviations of the recursion, and disagreements of the references.
#include "compare/comparison/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "compare/comparison/compliance.hpp"
#include "compare/comparison/elements.hpp"
#include "compare/deviation/proof.hpp"
#include "compare/jobs/jobs.hpp"
#include "compare/outputs/catalogue/catalogue.hpp"
#include "compare/outputs/not_a_number.hpp"
#include "recursive/diagnosis/diagnosis.hpp"
#include "recursive/soft_motion.hpp"
#include "reference/certificate/proved_box.hpp"

namespace elastocheck::compare {
namespace {

// The larger residual of each kind; NaN counts as larger than all numbers.
Residuals worse(const Residuals& a, const Residuals& b) {
    return {compare::worse(a.length, b.length), compare::worse(a.direction, b.direction),
            compare::worse(a.force, b.force), compare::worse(a.moment, b.moment)};
}

// Processor time [s] of a run whose points are ignored. Work at the points evicts data from the
// caches, after which the short steps of the recursion take half as long again.
double seconds_alone(const std::vector<BranchSide>& sides, const SolverSettings& solver) {
    const double start = processor_time();
    for (const auto& side : sides) solve_branch(side, solver, [](const Equilibrium&) {});
    return processor_time() - start;
}

// Responses of the wheels at the landmarks of a run (its ends and start), kept if outputs have been read from
// them.
struct Responses {
    std::optional<WheelResponse> front, start, back;
};

// Compliance matrices at the ends and the start of a run, one for each value of the parameter.
std::vector<Compliance> compliance_of(const Model& model, const BranchSide& side,
                                      const SolverSettings& solver, const LegRun& run,
                                      const Responses& responses) {
    std::vector<Compliance> list;
    Analyses analyses;
    const auto& landmarks = run.landmarks;
    for (const auto& [state, known_response] : {std::pair{&landmarks.front, &responses.front},
                                                {&landmarks.start, &responses.start},
                                                {&landmarks.back, &responses.back}}) {
        if (!*state) continue;
        const double a = in_unit(run.curve.unit) * (*state)->load;
        if (std::ranges::find(list, a, &Compliance::a) != list.end()) continue;
        const WheelResponse response =
            *known_response
                ? **known_response
                : wheel_response(side, solver, steering_joint(model), **state, analyses);
        Compliance& entry = list.emplace_back();
        entry.a = a;
        entry.why_not = response.why_not_free;
        entry.centre = compliance(side.model, WheelPoint::centre, **state, response);
        entry.patch = compliance(side.model, WheelPoint::patch, **state, response);
        entry.reciprocity = reciprocity(side.model, entry.centre);
    }
    return list;
}

// Proofs of the states at the landmarks (ends, start and middle), or only at the ends, also of a path that
// ended early.
Tally proofs_at_landmarks(const BranchSide& side, const LegRun& run, bool ends_only,
                          std::vector<reference::certificate::ProvedBox>& known) {
    Tally tally;
    std::vector<double> certified;
    const auto& [front, start, middle, back] = run.landmarks;
    std::vector<const std::optional<Equilibrium>*> states{&start, &middle, &front, &back};
    if (ends_only) {
        states = {&front, &back};
        if (start) certified.push_back(start->load);  // a one-sided branch begins there
    }
    for (const auto* state : states) {
        if (!*state || std::ranges::find(certified, (*state)->load) != certified.end()) continue;
        certified.push_back((*state)->load);
        add(tally, (*state)->load, run.curve.unit,
            reference::certificate::certify(side.model, side.branch, **state, {}, known));
    }
    return tally;
}

// Parameters of the points whose states are kept: all if there are up to 17, else 17 evenly spaced.
std::vector<double> stations_of(const std::vector<double>& requested) {
    constexpr std::size_t max_intervals = 16;
    std::vector<double> stations;
    const std::size_t last = requested.size() - 1, count = std::min(max_intervals, last);
    for (std::size_t k = 0; k <= count; ++k)
        stations.push_back(requested[count == 0 ? 0 : (2 * k * last + count) / (2 * count)]);
    return stations;
}

}  // namespace

LegRun run(const Model& model, const std::vector<Channel>& channels, const Branch& branch,
           const std::vector<BranchSide>& sides, const SolverSettings& solver, bool times) {
    LegRun run;
    run.leg = solver.leg;
    if (solver.leg == Leg::recursive) run.method = solver.recursion.method.name;
    const BranchSide& side = sides.front();
    run.scale = scale_of(side.model, branch, {});
    const auto requested = requested_parameters(sides, solver.every);
    const double middle = requested[requested.size() / 2];
    const bool both_sides = sides.size() > 1;
    auto& landmarks = run.landmarks;
    Responses responses;
    const bool keeps_states = solver.leg == Leg::equilibrium;
    const auto stations = keeps_states ? stations_of(requested) : std::vector<double>{};
    std::optional<LargestForces> largest;
    if (keeps_states) largest.emplace(model, side);
    static_cast<PathCurve&>(run) =
        solve_branch(model, channels, branch, sides, solver,
                     [&](const Equilibrium& state, const WheelResponse* response) {
                         for (const Leg judging_leg : legs) {
                             auto& worst = run.judged[static_cast<std::size_t>(judging_leg)];
                             worst = worse(worst, judge(judging_leg, side, state));
                         }
                         run.scale = larger(run.scale, scale_of(side.model, branch, {&state, 1}));
                         // The farthest point on either side comes last.
                         const auto mark = [&](std::optional<Equilibrium>& landmark,
                                               std::optional<WheelResponse>& known_response) {
                             landmark = state;
                             known_response.reset();
                             if (response != nullptr) known_response = *response;
                         };
                         if (state.load == 0)
                             mark(landmarks.start, responses.start);
                         else if (both_sides && state.load * side.branch.to > 0)
                             mark(landmarks.front, responses.front);
                         else
                             mark(landmarks.back, responses.back);
                         if (state.load == middle) landmarks.middle = state;
                         if (largest) largest->add(state);
                         if (std::ranges::find(stations, state.load) != stations.end())
                             run.stations.push_back(state);
                     });
    std::ranges::stable_sort(run.stations, {}, &Equilibrium::load);
    if (largest) run.largest = largest->list();
    if (!landmarks.front) {
        landmarks.front = landmarks.start;
        responses.front = responses.start;
    }
    if (!landmarks.back) {
        landmarks.back = landmarks.start;
        responses.back = responses.start;
    }
    if (!model.wheels.empty() &&
        std::ranges::find(channels, ChannelKind::characteristic, &Channel::kind) != channels.end())
        run.compliance = compliance_of(model, side, solver, run, responses);
    if (!times)
        run.seconds = nan;
    else if (solver.leg == Leg::recursive || solver.leg == Leg::series)
        run.seconds = seconds_alone(sides, solver);
    return run;
}

namespace {

// Ratio of a value to its bound: above 1 it is a violation. Infinite if either is not finite.
double share_of_bound(double value, double bound) {
    const double part = bound > 0 ? value / bound : value > 0 ? INFINITY : 0;
    return std::isfinite(value) && std::isfinite(bound) ? part : INFINITY;
}

double bound_of(Unit unit, const Bounds& bounds) {
    switch (unit) {
        case Unit::mm: return bounds.length;
        case Unit::deg: return bounds.angle;
        case Unit::newton: return bounds.force;
        case Unit::newton_metre: return bounds.moment;
        // Ackermann, 100 (cot δ_o - cot δ_i) l/j: at δ = 2 deg, where it begins to be defined,
        // |d cot δ/dδ| = 1/sin² δ is 14.3 per deg; twice this for two wheels, times l/j = 2
        case Unit::percent: return 6e3 * bounds.angle;
        default: return 0;  // characteristics are bounded separately
    }
}

// Allowed difference of a characteristic: a millionth of its largest |value| on the branch, which
// counts as at least a thousandth of its unit; of a coordinate at least the bound of positions.
double bound_of_characteristic(const Channel& channel, const std::vector<double>& values,
                               const Bounds& bounds) {
    constexpr double share = 1e-6;
    double largest = 1e-3;
    for (const double value : values) largest = std::max(largest, std::abs(value));
    return std::max(share * largest, is_position(channel) ? bounds.length : 0);
}

int count(const Reading& reading, const std::vector<bool>& determined) {
    int sum = 0;
    for (std::size_t c = 0; c < reading.channels.size(); ++c)
        if (determined[c]) sum += reading.channels[c].compared;
    return sum;
}

// Message where the two legs are at two different equilibria: at a landmark both states are proved
// and the boxes of the proofs are disjoint. The distance of their outputs then says nothing about
// the error of either. Bodies with an idle mode are not compared. "the energy leg is on another
// equilibrium than the equilibrium leg at -120 N, each proved: body 'a' is 160 mm away"; empty if none.
std::string at_two_equilibria(const Model& model, const Branch& requested, const LegRun& truth,
                              const LegRun& other) {
    using namespace reference::certificate;
    const auto sides = sides_of(model, requested);
    const auto idle = bodies_with_idle_mode(model, recursive::diagnose(sides.back().model));
    for (const auto landmark :
         {&Landmarks::back, &Landmarks::front, &Landmarks::middle, &Landmarks::start}) {
        const auto &state = truth.landmarks.*landmark, &other_state = other.landmarks.*landmark;
        if (!state || !other_state || state->load != other_state->load) continue;
        std::size_t farthest = 0;
        double length = 0, angle = 0;
        for (std::size_t b = 0; b < state->poses.size(); ++b) {
            if (idle[b]) continue;
            const double distance = (state->poses[b].r - other_state->poses[b].r).norm();
            if (distance > length) {
                length = distance;
                farthest = b;
            }
            angle = std::max(angle, state->poses[b].p.angularDistance(other_state->poses[b].p));
        }
        const BranchSide& side = side_at(sides, state->load);
        const Certificate certificate = certify(side.model, side.branch, *state);
        if (certificate.state != ProofState::proved) continue;
        const Certificate other_certificate = certify(side.model, side.branch, *other_state);
        if (other_certificate.state != ProofState::proved) continue;
        if (!(length > certificate.error.length + other_certificate.error.length ||
              angle > certificate.error.angle + other_certificate.error.angle))
            continue;
        const Unit unit = unit_of(requested.unit);
        return fmt::format(
            "the {} leg is on another equilibrium than the {} leg at {:.6g} {}, each proved: body "
            "'{}' is "
            "{:.3g} mm away",
            name(other.leg), name(truth.leg), in_unit(unit) * state->load, symbol(unit),
            model.bodies[farthest].name, 1e3 * length);
    }
    return {};
}

// Message on the proofs of the other leg if a state of one leg is disproved; empty if they do not decide.
std::string proofs_of_other_leg(const LegRun& other) {
    const Tally& tally = other.proved;
    if (tally.excluded > 0 || tally.points == 0) return {};
    if (tally.proved == tally.points)
        return fmt::format("; the {} leg is right, by proof", name(other.leg));
    return fmt::format("; of the points of the {} leg {} of {} are proved and none is excluded",
                       name(other.leg), tally.proved, tally.points);
}

// Message on the first point at which only one of two runs has a value of an output; empty if none.
std::string defined_by_one_run(const Channel& channel, std::size_t c, const LegRun& one,
                               const LegRun& other) {
    for (std::size_t k = 0; k < std::min(one.curve.values.size(), other.curve.values.size()); ++k) {
        const bool by_one = one.curve.values[k][c] != undefined,
                   by_other = other.curve.values[k][c] != undefined;
        if (by_one != by_other)
            return fmt::format(
                "the reference legs disagree on whether {} is defined at {:.6g} {}: it is by the "
                "{} leg",
                channel.name, one.curve.a[k], symbol(one.curve.unit),
                name(by_one ? one.leg : other.leg));
    }
    return {};
}

}  // namespace

void Objections::add(std::string what, double share) {
    constexpr std::size_t max_listed = 3;
    ++count;
    const auto place =
        std::ranges::find_if(worst, [&](const Objection& o) { return o.share < share; });
    worst.insert(place, {std::move(what), share});
    if (worst.size() > max_listed) worst.pop_back();
}

std::vector<std::string> Objections::texts() const {
    std::vector<std::string> list;
    for (const auto& objection : worst) list.push_back(objection.what);
    if (const int more = count - static_cast<int>(worst.size()); more > 0)
        list.push_back(fmt::format("and {} more with smaller differences", more));
    return list;
}

namespace {

// The motion that is softest at the last point of a side that the run did not finish.
std::string ending_motion(const Model& model, const Branch& requested, const LegRun& run) {
    for (const BranchSide& side : sides_of(model, requested))
        for (const auto* last : {&run.landmarks.front, &run.landmarks.back}) {
            if (!*last || (*last)->load * side.branch.to < 0) continue;
            if (std::abs((*last)->load) < (1 - 1e-9) * std::abs(side.branch.to))
                return recursive::softest_motion(side.model, side.branch, **last);
        }
    return {};
}

// Why legs ended before the end of the branch. Where several ended after the same point it is one
// place, described once, by the first of them.
void add_ends(const Model& model, const Branch& requested, std::vector<const LegRun*> ended,
              Objections& objections) {
    while (!ended.empty()) {
        const LegRun& first = *ended.front();
        const auto ends_here = [&](const LegRun* run) {
            return run == &first || (!first.curve.a.empty() && run->curve.a == first.curve.a);
        };
        std::string others;
        for (const LegRun* run : ended)
            if (ends_here(run) && run != &first)
                others += fmt::format("{}{} leg: {}", others.empty() ? " (" : ", ", name(run->leg),
                                      elastocheck::name(run->outcome));
        std::string what =
            fmt::format("{} leg: {}{}: {}", name(first.leg), elastocheck::name(first.outcome),
                        others.empty() ? "" : others + ")", first.detail);
        if (!others.empty())
            if (const auto motion = ending_motion(model, requested, first); !motion.empty())
                what += "; the softest motion before it is " + motion;
        objections.add(std::move(what));
        std::erase_if(ended, ends_here);
    }
}

}  // namespace

std::vector<bool> bodies_with_idle_mode(const Model& model, const recursive::Diagnosis& diagnosis) {
    std::vector<bool> moved(model.bodies.size());
    for (const auto& mode : diagnosis.idle)
        for (Eigen::SparseVector<double>::InnerIterator entry(mode.dq); entry; ++entry)
            if (std::abs(entry.value()) > 1e-6)
                moved[static_cast<std::size_t>(entry.index() / 6)] = true;
    return moved;
}

bool energy_judges_states(const BranchComparison& branch) {
    return branch.second != Leg::energy && branch.run(Leg::energy).outcome == Outcome::too_large;
}

Objections disagreements(const Model& model, const std::vector<Channel>& channels,
                         const Branch& requested, const BranchComparison& branch,
                         RequiredLegs required) {
    Objections objections;
    std::vector<const LegRun*> ended;
    for (const Leg leg : {Leg::equilibrium, Leg::series, Leg::energy, Leg::recursive})
        for (const auto& run : branch.runs) {
            if (run.leg != leg || (leg == Leg::recursive && required == RequiredLegs::references))
                continue;
            if (leg == Leg::energy && branch.second != Leg::energy)
                continue;  // does not apply, and is not needed
            if (run.outcome != Outcome::converged) ended.push_back(&run);
        }
    add_ends(model, requested, ended, objections);
    if (!objections.empty()) return objections;
    const LegRun &equilibrium = branch.run(Leg::equilibrium), &second = branch.run(branch.second);
    if (const auto why = nothing_drives(model, requested); !why.empty()) objections.add(why);

    const auto& reading = branch.uncertainty.equal_parameter;
    if (!reading.not_compared.empty())
        objections.add("the references were not compared: " + reading.not_compared);
    Objections disagreements;
    for (std::size_t c = 0; c < reading.channels.size(); ++c) {
        if (!branch.determined[c]) continue;
        const double difference = reading.channels[c].max,
                     bound = channels[c].kind() == ChannelKind::characteristic
                                 ? bound_of_characteristic(
                                       channels[c], equilibrium.curve.channel(c), branch.bounds)
                                 : bound_of(channels[c].unit, branch.bounds);
        if (const double part = share_of_bound(difference, bound); !(part <= 1))
            disagreements.add(
                fmt::format(
                    "the reference legs disagree on {}: {:.3g} {}, at most {:.3g} is allowed",
                    channels[c].name, difference, symbol(channels[c].unit), bound),
                part);
    }
    if (!disagreements.empty())
        if (const auto message = at_two_equilibria(model, requested, equilibrium, second);
            !message.empty()) {
            objections.add(message);
            disagreements = {};
        }
    for (const auto& objection : disagreements.worst)
        objections.add(objection.what, objection.share);
    objections.count += disagreements.count - static_cast<int>(disagreements.worst.size());
    for (const auto& [run, other] :
         {std::pair(&equilibrium, &second), std::pair(&second, &equilibrium)})
        if (run->proved.excluded > 0)
            objections.add(fmt::format("the {} leg's point is provably no equilibrium: {}{}",
                                       name(run->leg), run->proved.not_proved,
                                       proofs_of_other_leg(*other)));
    // The references must also agree on where an output is undefined.
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (const auto where = defined_by_one_run(channels[c], c, equilibrium, second);
            !where.empty())
            objections.add(where);
    // Where the series is the second reference, its equations are those of the recursive leg.
    const Leg judge = branch.second == Leg::energy ? Leg::energy : Leg::recursive;
    std::vector<std::pair<const LegRun*, Leg>> judgements{{&equilibrium, judge},
                                                          {&second, Leg::equilibrium}};
    if (energy_judges_states(branch)) judgements.emplace_back(&equilibrium, Leg::energy);
    for (const auto& [run, other] : judgements) {
        const Residuals& r = run->judged[static_cast<std::size_t>(other)];
        const Bounds& b = branch.bounds;
        const double part = std::max({share_of_bound(r.force, b.residual_force),
                                      share_of_bound(r.moment, b.residual_moment),
                                      share_of_bound(1e3 * r.length, b.residual_length)});
        if (!(part <= 1))
            objections.add(
                fmt::format(
                    "the {} leg's states have residuals of {:.3g} N, {:.3g} N·m, {:.3g} mm in the "
                    "{} leg's equations; at most {:.3g} N, {:.3g} N·m, {:.3g} mm are allowed",
                    name(run->leg), r.force, r.moment, 1e3 * r.length, name(other),
                    b.residual_force, b.residual_moment, b.residual_length),
                part);
    }
    return objections;
}

namespace {

// The runs of one branch by all legs.
struct SolvedBranch {
    const Branch& branch;
    const std::vector<BranchSide>& sides;
    std::vector<LegRun> runs;
};

// Deviations between the runs. `requested_abscissa`: position in `channels`, or -1 for the default.
BranchComparison compare_runs(const Model& model, const std::vector<Channel>& channels,
                              SolvedBranch solved, int requested_abscissa, const Options& options) {
    const auto& [branch, sides, runs] = solved;
    BranchComparison b;
    b.branch = branch.name;
    b.unit = unit_of(branch.unit);
    for (const auto& side : sides) b.steps += side.branch.steps;
    b.every = options.every;
    b.determined = active_channels(channels, sides.front().model);
    b.runs = std::move(solved.runs);
    if (const LegRun& energy = b.run(Leg::energy); is_not_applicable(energy.outcome)) {
        b.second = Leg::series;
        b.why_not_energy = energy.detail;
    }
    for (std::size_t c = 0; c < channels.size(); ++c)
        b.determined[c] = b.determined[c] && std::ranges::none_of(b.runs, [&](const LegRun& run) {
                              return is_undefined_somewhere(c, run.curve);
                          });
    const LegRun& truth = b.run(Leg::equilibrium);
    b.abscissa =
        requested_abscissa >= 0 ? requested_abscissa : default_abscissa(channels, truth.curve);
    const auto pair_of = [&](Leg a, Leg c) {
        const Curve &of_a = b.run(a).curve, &of_c = b.run(c).curve;
        return Pair{
            a, c, at_equal_parameter(of_a, of_c),
            at_equal_abscissa(of_a, of_c, compare::abscissa(channels, b.abscissa, of_a, of_c))};
    };
    b.deviation = pair_of(Leg::equilibrium, Leg::recursive);
    b.cross_check = pair_of(b.second, Leg::recursive);
    b.uncertainty = pair_of(Leg::equilibrium, b.second);
    b.bounds = bounds_of(options.agreement, truth.scale);
    b.extents = extents_of(channels, truth.curve, truth.scale);
    b.inconclusive = disagreements(model, channels, branch, b);
    return b;
}

}  // namespace

bool Comparison::conclusive() const {
    for (const auto& branch : branches)
        if (!branch.inconclusive.empty()) return false;
    return compared > 0;
}

const BranchComparison& Comparison::branch(std::string_view name) const {
    return *std::ranges::find(branches, name, &BranchComparison::branch);
}

LegRun run(const Model& model, const Branch& branch, Leg leg, const recursive::Options& recursion) {
    return run(model, channels(model), branch, sides_of(model, branch, recursion.steps),
               {.leg = leg, .recursion = recursion}, true);
}

std::vector<Channel> compared_channels(const Model& model, const std::vector<Channel>& also) {
    auto list = channels(model);
    std::ranges::move(characteristics(model), std::back_inserter(list));
    std::ranges::copy(also, std::back_inserter(list));
    std::ranges::move(sums(model), std::back_inserter(list));
    return list;
}

Comparison compare(const Model& model, const Options& options) {
    return compare(model, options, {});
}

Comparison compare(const Model& model, const Options& options, const std::vector<Channel>& also) {
    Comparison result;
    result.channels = compared_channels(model, also);
    const int requested =
        options.abscissa.empty() ? -1 : find_channel(result.channels, options.abscissa);
    if (requested < 0 && !options.abscissa.empty())
        throw std::invalid_argument(
            fmt::format("'{}' is not an output of the scene", options.abscissa));

    std::vector<std::vector<BranchSide>> sides;
    for (const auto& branch : model.branches)
        sides.push_back(sides_of(model, branch, options.recursion.steps));

    const auto solve = [&](std::size_t k, const SolverSettings& solver) {
        return run(model, result.channels, model.branches[k], sides[k], solver, options.times);
    };
    // The references first: the points of the other legs lie near the boxes proved for these.
    const auto prove = [&](std::size_t k, std::vector<LegRun>& runs) {
        std::vector<reference::certificate::ProvedBox> known;
        for (const Leg leg : {Leg::equilibrium, Leg::energy, Leg::series, Leg::recursive})
            for (LegRun& leg_run : runs)
                if (leg_run.leg == leg && (!options.prove_ends_only || leg == Leg::equilibrium))
                    leg_run.proved = proofs_at_landmarks(sides[k].front(), leg_run,
                                                         options.prove_ends_only, known);
    };
    std::vector<std::vector<LegRun>> runs(model.branches.size(), std::vector<LegRun>(legs.size()));
    std::vector<std::optional<LegRun>> series(model.branches.size());
    // The longest jobs first, so that none of them is left to one thread at the end.
    std::vector<Job> jobs;
    for (const Leg leg : {Leg::energy, Leg::equilibrium, Leg::recursive})
        for (std::size_t k = 0; k < model.branches.size(); ++k)
            jobs.push_back(
                {fmt::format("{}: {} leg", model.branches[k].name, name(leg)), [&, k, leg] {
                     const SolverSettings solver{.leg = leg,
                                                 .recursion = options.recursion,
                                                 .every = options.every,
                                                 .energy = options.energy};
                     LegRun& leg_run = runs[k][static_cast<std::size_t>(leg)];
                     leg_run = solve(k, solver);
                     if (leg == Leg::energy && is_not_applicable(leg_run.outcome))
                         series[k] = solve(k, {.leg = Leg::series, .every = options.every});
                 }});
    run_jobs(jobs, options.threads, part(options.progress, 0, 0.8));

    result.branches.resize(model.branches.size());
    jobs.clear();
    for (std::size_t k = 0; k < model.branches.size(); ++k)
        jobs.push_back({fmt::format("{}: deviations", model.branches[k].name), [&, k] {
                            if (series[k]) runs[k].push_back(std::move(*series[k]));
                            if (options.prove) prove(k, runs[k]);
                            result.branches[k] =
                                compare_runs(model, result.channels,
                                             {model.branches[k], sides[k], std::move(runs[k])},
                                             requested, options);
                        }});
    run_jobs(jobs, options.threads, part(options.progress, 0.8, 1));
    for (const BranchComparison& b : result.branches)
        for (const Pair* p : {&b.deviation, &b.cross_check, &b.uncertainty})
            result.compared +=
                count(p->equal_parameter, b.determined) + count(p->equal_abscissa, b.determined);
    for (std::size_t c = 0; c < result.channels.size(); ++c) {
        if (result.channels[c].kind() != ChannelKind::characteristic) continue;
        double largest = 0;
        for (const auto& branch : result.branches)
            if (std::isfinite(branch.extents[c])) largest = std::max(largest, branch.extents[c]);
        for (auto& branch : result.branches) branch.extents[c] = largest;
    }
    return result;
}

}  // namespace elastocheck::compare
