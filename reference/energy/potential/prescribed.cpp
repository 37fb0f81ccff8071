#include "reference/energy/potential/prescribed.hpp"

#include "models/overloaded.hpp"

namespace elastocheck::reference::energy {
namespace {

void add(Prescribed& to, const LoadKind& load, double factor) {
    if (factor == 0) return;
    std::visit(overloaded{[&](const DeadForce& force) {
                              if (force.at.body != ground)
                                  to.forces.push_back({force.at, factor * force.f});
                          },
                          [&](const DeadMoment& moment) {
                              if (moment.body != ground)
                                  to.moments.push_back({moment.body, factor * moment.m});
                          },
                          // Models with followers are not solved, and their forces are
                          // not judged: conservative.hpp.
                          [](const FollowerForce&) {}, [](const FollowerMoment&) {},
                          [&](const BrakeForce& brake) {
                              if (brake.body != ground)
                                  to.brakes.push_back({brake.patch, brake.body, factor * brake.f});
                          }},
               load);
}

// Adds the prescribed value of a driver at `factor`.
void add(Prescribed& to, const Model& model, const Driven& driven, double factor) {
    std::visit(
        overloaded{[&](const Load& load) { add(to, load.kind, factor); },
                   [&](const Motion& motion) {
                       to.offset[model.joints.at(static_cast<std::size_t>(motion.joint)).driven] +=
                           factor;
                   },
                   [&](const FreeLength& length) { to.free_length[length.elastic] += factor; },
                   [&](const Preload& preload) {
                       to.preload.col(preload.elastic) += factor * preload.direction;
                   }},
        driven);
}

}  // namespace

Prescribed nothing_prescribed(const Model& model) {
    const auto constraints = static_cast<Eigen::Index>(model.constraints.size()),
               elements = static_cast<Eigen::Index>(model.elastics.size());
    return {.forces = {},
            .moments = {},
            .brakes = {},
            .offset = Eigen::VectorXd::Zero(constraints),
            .free_length = Eigen::VectorXd::Zero(elements),
            .preload = Eigen::Matrix<double, 6, Eigen::Dynamic>::Zero(6, elements),
            .gap = Eigen::VectorXd::Zero(constraint_rows(model)),
            .strength = Eigen::VectorXd::Zero(elements)};
}

Course course_of(const Model& model, const Branch& branch) {
    Course course{nothing_prescribed(model), nothing_prescribed(model)};
    for (const auto& load : model.static_loads) add(course.start, load.kind, 1);
    for (const auto& driver : branch.drivers) {
        add(course.start, model, driver.what, driver.start);
        add(course.rate, model, driver.what, driver.rate);
    }
    return course;
}

Prescribed sum(const Prescribed& f, double factor, const Prescribed& g) {
    Prescribed result = f;
    for (const auto& force : g.forces) result.forces.push_back({force.at, factor * force.f});
    for (const auto& moment : g.moments) result.moments.push_back({moment.body, factor * moment.m});
    for (const auto& brake : g.brakes)
        result.brakes.push_back({brake.patch, brake.body, factor * brake.f});
    result.offset += factor * g.offset;
    result.free_length += factor * g.free_length;
    result.preload += factor * g.preload;
    result.gap += factor * g.gap;
    result.strength += factor * g.strength;
    return result;
}

Prescribed at(const Course& course, double a) { return sum(course.start, a, course.rate); }

}  // namespace elastocheck::reference::energy
