// Figures of an axle in roll: roll centre, roll steer, stiffness in roll.
#include <algorithm>
#include <optional>

#include "compare/outputs/catalogue/motions.hpp"
#include "compare/outputs/deformation.hpp"
#include "compare/outputs/rates.hpp"
#include "models/eigen/dense.hpp"
#include "models/kinds.hpp"

namespace elastocheck::compare {
namespace {

constexpr auto no_roll_centre = "no finite roll centre";

// Change of the angle of the line through the wheel centres under `motions` [rad], positive where the
// left wheel rises: with (y, z) from the right centre to the left one
//
//   φ = atan(z / y)      dφ = (y dz - z dy) / (y² + z²)
double turn_of_axle(const Subject& x, const Motions& motions) {
    const Subject left = x.other_wheel(left_wheel(x.model)), right = x.other_wheel(1 - left.k);
    const Vector3d line = left.centre().position - right.centre().position,
                   d = x.displacement(motions, left.centre()) -
                       x.displacement(motions, right.centre());
    return (line.y() * d.z() - line.z() * d.y()) / (line.y() * line.y() + line.z() * line.z());
}

// Body roll by 1 rad towards this wheel of an axle, against the line through the wheel centres: this
// wheel rises, the other one goes down by as much.
Motions rolled_towards(const Subject& x) {
    Motions roll = roll_motions(x);
    const double scale = x.side() / turn_of_axle(x, roll);
    for (auto& motion : roll) {
        motion.dr *= scale;
        motion.dpi *= scale;
    }
    return roll;
}
double in_roll(const Subject& x, double (Subject::*angle)(const Motions&) const) {
    return x.response->tied ? undefined : (x.*angle)(rolled_towards(x));
}

// Intersection P of the lines A P = b: of coincident lines the point nearest to the origin, of parallel
// ones none.
std::optional<Vector2d> intersection(const Eigen::Matrix2d& A, const Vector2d& b, double track) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> lines;
    lines.setThreshold(1e-9);
    lines.compute(Eigen::MatrixXd(A));
    const Eigen::VectorXd right = b, P = lines.solve(right);
    if ((A * P - b).norm() > 1e-9 * track || !(P.norm() <= max_distance)) return std::nullopt;
    return Vector2d(P);
}
// In front view the patch c of a wheel moves by (dy, dz), perpendicular to the line from it to the
// instant centre of the wheel. The roll centre P lies on that line: for an axle in roll at the
// intersection of both lines; for one wheel at the middle of the vehicle, y = 0.
//
//   (P - c) · (dy, dz) = 0      height P_z - c_z
//
// Two coincident lines (arms that guide the wheels vertically) meet halfway between the wheels.
//
// `point`: the patch c, or by another definition the wheel centre. Returns y, and z above the road; none
// at infinity.
std::optional<Vector2d> centre_of_axle(const Subject& x, PlacedPoint (Subject::*point)() const) {
    const auto front_view = [](const Vector3d& v) { return Vector2d(v.y(), v.z()); };
    if (x.response->tied) return std::nullopt;
    const Motions roll = roll_motions(x);
    Eigen::Matrix2d A;
    Vector2d c[2], b;
    double above = 0;  // mean height of the points above the road
    for (std::size_t w = 0; w < 2; ++w) {
        const PlacedPoint placed = (x.other_wheel(w).*point)();
        c[w] = front_view(placed.position);
        above += (placed.position.z() - x.other_wheel(w).patch().position.z()) / 2;
        A.row(static_cast<Eigen::Index>(w)) =
            front_view(x.displacement(roll, placed)).normalized().transpose();
    }
    const Vector2d middle = (c[0] + c[1]) / 2;
    for (int w = 0; w < 2; ++w) b[w] = A.row(w).dot(c[w] - middle);
    const auto P = intersection(A, b, std::abs(c[0].x() - c[1].x()));
    if (!P) return std::nullopt;
    return Vector2d(middle.x() + P->x(), P->y() + above);
}
double roll_centre(const Subject& x, PlacedPoint (Subject::*point)() const) {
    if (is_axle(x.model)) {
        const auto centre = centre_of_axle(x, point);
        return centre ? centre->y() : undefined;
    }
    const PlacedPoint reference = (x.*point)();
    const Vector3d d = x.displacement(x.response->travel[0], reference);
    return ratio(reference.position.y() * d.y(), d.z(), max_distance) + reference.position.z() -
           x.patch().position.z();
}
// Lateral forces f_y on all patches in one direction, with vertical forces f_z that hold the wheel
// centres at their height (of an axle: opposite ones that prevent roll); the roll centre is where the
// resultant acts. With C_y, C_z the rise of the centres per unit of these forces, of an axle that of
// the left less that of the right one:
//
//   f_z = -f_y C_y / C_z      h = -(t/2) f_z / f_y      t/2 = y of the patch of one wheel
double roll_centre_by_forces(const Subject& x) {
    const ResponsesByWheel& free = x.response->free;
    if (free.empty()) return value_without_free_response(x);
    const auto rise = [](const Subject& wheel, const Motions& motions) {
        return wheel.displacement(motions, wheel.centre()).z();
    };
    if (!is_axle(x.model))
        return ratio(x.patch().position.y() * rise(x, free[0][first_patch_force + 1]),
                     rise(x, free[0][first_patch_force + 2]), max_distance);
    if (x.response->tied) return undefined;
    const Subject left = x.other_wheel(left_wheel(x.model)), right = x.other_wheel(1 - left.k);
    const auto roll = [&](const Motions& by) { return rise(left, by) - rise(right, by); };
    return ratio((left.patch().position.y() - right.patch().position.y()) / 2 *
                     roll(axle_motions(free, left, first_patch_force + 1, 1)),
                 roll(axle_motions(free, left, first_patch_force + 2, -1)), max_distance);
}

// Unit forces on the patches, up on the left and down on the right one, are the moment t, the track, and
// turn the line through the wheel centres by φ:  stiffness t / φ.
double roll_stiffness(const Subject& x) {
    if (x.response->free.empty()) return value_without_free_response(x);
    if (x.response->tied) return undefined;
    const Subject left = x.other_wheel(left_wheel(x.model)), right = x.other_wheel(1 - left.k);
    const Motions motions = axle_motions(x.response->free, left, first_patch_force + 2, -1);
    return ratio(left.patch().position.y() - right.patch().position.y(), turn_of_axle(x, motions),
                 max_stiffness);
}

// The part of the elements of one kind in the roll stiffness. The work of the unit forces is the rise of
// their points; that of the elements is Σ Δs·Δe, Δe and Δs their changes of deformation and force under
// the unit forces. The remainder of the sum over all kinds is the work of preloads, which rotate.
enum class Carries { spring, bar, bushing };
Carries carries(const Elastic& elastic) {
    if (member<ScalarLaw>(elastic.kind) != nullptr) return Carries::spring;
    const bool bends =
        elastic.written_as == WrittenAs::beam || elastic.written_as == WrittenAs::torsion_spring;
    return bends ? Carries::bar : Carries::bushing;
}
double roll_stiffness_by(const Subject& x, Carries kind) {
    const double whole = roll_stiffness(x);
    if (!std::isfinite(whole)) return whole;
    const Subject left = x.other_wheel(left_wheel(x.model)), right = x.other_wheel(1 - left.k);
    const Motions motions = axle_motions(x.response->free, left, first_patch_force + 2, -1);
    const double rise =
        x.displacement(motions, left.patch()).z() - x.displacement(motions, right.patch()).z();
    constexpr double step = 1e-5;  // [m] of the rise, to either side
    const Equilibrium above = moved_by(*x.state, motions, step / rise),
                      below = moved_by(*x.state, motions, -step / rise);
    const Branch none;
    double work = 0;  // over a rise of 2 step, for which the unit forces do (2 step)² / rise
    for (std::size_t k = 0; k < x.model.elastics.size(); ++k) {
        const Elastic& elastic = x.model.elastics[k];
        if (carries(elastic) != kind || elastic.written_as == WrittenAs::tyre) continue;
        const Branch& branch = x.branch == nullptr ? none : *x.branch;
        const Vector6 high = deformation(elastic.kind, k, branch, above),
                      low = deformation(elastic.kind, k, branch, below);
        work += (high - low).dot(force(elastic.kind, high) - force(elastic.kind, low));
    }
    return whole * work * rise / (4 * step * step);
}
Entry roll_stiffness_by(Carries kind, const std::string& name, const std::string& elements) {
    return {
        Owner::axle,
        "roll_stiffness_of_" + name,
        Unit::newton_metre_per_deg,
        "part of the roll stiffness: work of the " + elements +
            " over that of the roll moment; what is left of the sum are turning preloads",
        no_rate,
        [kind](const Subject& x) { return roll_stiffness_by(x, kind); },
        {.sources = "split of the roll stiffness", .needs_free_response = true, .cause = "roll"}};
}

const Entry of_roll[] = {
    Entry(
        Owner::wheels, "roll_centre_height", Unit::mm,
        "height above the contact patches of the intersection of the lines that are perpendicular, "
        "seen from the front, to the motion of the patches: of both wheels for an axle that rolls, "
        "with the middle plane of the vehicle for one wheel; positive above the road",
        no_roll_centre, [](const Subject& x) { return roll_centre(x, &Subject::patch); },
        {.sources = "kinematic or geometric roll centre; force-based ones (SAE J670) are the "
                    "same wherever virtual work holds, which a test shows",
         .is_key_figure = true,
         .explained = true,
         .live_rank = {.heave = 3, .roll = 1},
         .cause = "roll",
         .drawings = {{DrawnAbscissa::travel, 9, "Roll centre height", "above the road"},
                      {DrawnAbscissa::roll, 5, "Roll centre height in roll", "above the road"}}}),
    Entry(Owner::axle, "roll_centre_lateral", Unit::mm,
          "lateral position of the same intersection, positive to the left of the middle plane",
          no_roll_centre,
          [](const Subject& x) {
              const auto centre = centre_of_axle(x, &Subject::patch);
              return centre ? centre->x() : undefined;
          },
          {.sources = "migration of the roll centre in roll",
           .is_position = true,
           .live_rank = {.roll = 5},
           .cause = "roll",
           .drawings = {{DrawnAbscissa::roll, 6, "Lateral position of the roll centre",
                         "left of the middle plane positive"}}}),
    Entry(Owner::axle, "roll_stiffness", Unit::newton_metre_per_deg,
          "moment of opposite vertical forces at the patches over the roll of the wheel centres, "
          "without the tyres",
          no_rate, roll_stiffness,
          {.sources = "suspension roll rate with springs, bar and bushings",
           .needs_free_response = true,
           .is_key_figure = true,
           .live_rank = {.roll = 2},
           .cause = "roll",
           .drawings = {{DrawnAbscissa::roll, 4, "Roll stiffness", "without the tyres"}}}),
    roll_stiffness_by(Carries::spring, "springs", "springs and stops"),
    roll_stiffness_by(Carries::bar, "bar",
                      "torsion springs and beams (anti-roll bars, twist beams)"),
    roll_stiffness_by(Carries::bushing, "rubber", "bushings"),
    Entry(
        Owner::wheel_of_axle, "roll_steer", Unit::deg_per_deg,
        "change of toe over the roll of the car body towards this wheel, against the line through "
        "the wheel centres; positive towards toe-in",
        does_not_roll, [](const Subject& x) { return in_roll(x, &Subject::toe); },
        {.sources = "roll steer coefficient", .is_key_figure = true, .cause = "roll"}),
    Entry(Owner::wheel_of_axle, "roll_camber", Unit::deg_per_deg,
          "change of camber against the car body over its roll towards this wheel; positive where "
          "the top leans out",
          does_not_roll, [](const Subject& x) { return in_roll(x, &Subject::camber); },
          {.sources = "often given relative to the road, which adds 1", .cause = "roll"}),
    Entry(Owner::wheel_of_axle, std::string(figure::wheel_rate_in_roll), Unit::newton_per_mm,
          "vertical force at the contact patch over vertical displacement of the wheel centre, "
          "with the opposite force on the other wheel",
          no_rate,
          [](const Subject& x) { return vertical_rate(x, first_patch_force + 2, x.centre(), -1); },
          {.sources = "with the anti-roll bar", .cause = "roll"}),
};

const Entry roll_definitions[] = {
    Entry(
        Owner::wheels, "roll_centre_height@centre", Unit::mm,
        "height above the contact patches of the intersection of the lines that are perpendicular, "
        "seen from the front, to the motion of the wheel centres and pass through them",
        no_roll_centre, [](const Subject& x) { return roll_centre(x, &Subject::centre); },
        {.sources = "tracks that are measured at the wheel centres"}),
    Entry(Owner::wheels, "roll_centre_height@forces", Unit::mm,
          "height above the contact patches of the point at which a lateral force on the body "
          "leaves the wheel centres at their height (of an axle: the body without roll), the same "
          "lateral force on each patch, elements included",
          no_roll_centre, roll_centre_by_forces,
          {.sources = "SAE J670e: roll center; force-based roll centre",
           .definition_set = "sae",
           .needs_free_response = true}),
    Entry(Owner::wheel_of_axle, "roll_camber@road", Unit::deg_per_deg,
          "change of camber against the road over the roll of the car body towards this wheel; "
          "positive where the top leans out",
          does_not_roll, [](const Subject& x) { return in_roll(x, &Subject::camber) + 1; },
          {.sources = "inclination to the ground"}),
};

}  // namespace

std::vector<Vector3> points_of_figures(const Model& model, const Equilibrium& state,
                                       const WheelResponse& response) {
    std::vector<Vector3> points;
    const Vector3 none = Vector3::Constant(undefined);
    const bool moves = !response.travel.empty();
    const auto subject = [&](std::size_t w) {
        return Subject{model, &state, w, nullptr, &response};
    };
    Vector3 roll = Vector3::Zero();  // its middle of the wheel centres in x, of the patches in z
    for (std::size_t w = 0; w < model.wheels.size(); ++w) {
        const Subject x = subject(w);
        const auto& axis = x.wheel().steering_axis;
        points.push_back(axis ? Vector3(x.placed(axis->lower).position) : none);
        points.push_back(axis ? Vector3(x.placed(axis->upper).position) : none);
        points.push_back(moves ? front_instant_centre(x) : none);
        points.push_back(moves ? side_instant_centre(x) : none);
        roll += Vector3(x.centre().position.x(), 0, x.patch().position.z()) /
                double(model.wheels.size());
    }
    if (model.wheels.empty()) return points;
    if (!moves || (model.wheels.size() > 1 && !is_axle(model)))
        roll = none;
    else if (!is_axle(model))
        roll.z() += roll_centre(subject(0), &Subject::patch);
    else if (const auto centre = centre_of_axle(subject(0), &Subject::patch))
        roll += Vector3(0, centre->x(), centre->y());
    else
        roll = none;
    points.push_back(roll);
    return points;
}

void add_roll(std::vector<Entry>& all) { std::ranges::copy(of_roll, std::back_inserter(all)); }

void add_roll_definitions(std::vector<Entry>& all) {
    std::ranges::copy(roll_definitions, std::back_inserter(all));
}

}  // namespace elastocheck::compare
