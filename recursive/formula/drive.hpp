// Derivatives of balance and Φ with respect to the drivers: ∂/∂a, and ∂/∂t while settling.
#pragma once

#include "recursive/formula/constraints.hpp"
#include "recursive/formula/elastic.hpp"
#include "recursive/formula/loads.hpp"

namespace elastocheck::recursive {

// Which amplitude of a driver is applied: its start while settling, its rate on the branch.
enum class Drive { start, rate };

template <class Real>
Real amplitude(const Driver& driver, Drive drive) {
    return static_cast<Real>(drive == Drive::start ? driver.start : driver.rate);
}

// A change of t (Drive::start) or a (Drive::rate) by `amount`, at q and these inputs.
template <class Real>
struct DriverChange {
    const Model& model;
    const Branch& branch;
    const Inputs<Real>& inputs;
    Drive drive = Drive::rate;
    Real amount = 1;
    const State<Real>& q;
};

// Adds amount · ∂f_ext/∂a to `force` [6nb].
template <class Real>
void add_load_rate(const Branch& branch, Drive drive, Real amount, const State<Real>& q,
                   Vector<Real>& force) {
    for (const auto& driver : branch.drivers)
        if (const Load* load = driven_load(driver.what))
            add_load<Real>(load->kind, amount * amplitude<Real>(driver, drive), q, force);
}

// amount · ∂f_elast/∂a, element by element: add(element number, (F, M) on its body j).
template <class Real, class Add>
void for_each_stored_rate(const DriverChange<Real>& change, Add&& add) {
    const auto& [model, branch, inputs, drive, amount, q] = change;
    for (const auto& driver : branch.drivers) {
        const Real change_of_input = amount * amplitude<Real>(driver, drive);
        std::visit(overloaded{
                       [](const Load&) {},
                       [](const Motion&) {},
                       [&](const FreeLength& f) {
                           const auto k = static_cast<std::size_t>(f.elastic);
                           ElementForce<Real> force = std::visit(
                               [&](const auto& e) {
                                   return force_of_free_length<Real>(e, inputs.rest[k], q);
                               },
                               model.elastics[k].kind);
                           force.F *= change_of_input;
                           force.M *= change_of_input;
                           add(k, force);
                       },
                       [&](const Preload& p) {
                           const auto k = static_cast<std::size_t>(p.elastic);
                           const auto& bushing = std::get<Bushing>(model.elastics[k].kind);
                           add(k, force_of_preload<Real>(
                                      bushing, change_of_input * p.direction.cast<Real>(), q));
                       },
                   },
                   driver.what);
    }
}
// Adds amount · ∂f_elast/∂a to `force` [6nb].
template <class Real>
void add_stored_rate(const DriverChange<Real>& change, Vector<Real>& force) {
    for_each_stored_rate<Real>(change, [&](std::size_t k, const ElementForce<Real>& stored) {
        const auto [i, j] = bodies_of(change.model.elastics[k].kind);
        add_element_force<Real>(i, j, stored, force);
    });
}

// amount · ∂/∂a of the driven rows: add(row number, ∂row/∂c, change of c).
template <class Real, class Add>
void for_each_row_rate(const DriverChange<Real>& change, Add&& add) {
    const auto& [model, branch, inputs, drive, amount, q] = change;
    for (const auto& driver : branch.drivers)
        if (const int joint = driven_joint(driver.what); joint >= 0) {
            const std::size_t k = constraint_of(model, {joint});
            add(inputs.row[k], rate<Real>(model.constraints[k].kind, inputs.offset[k], q),
                amount * amplitude<Real>(driver, drive));
        }
}
// Adds amount · ∂Φ/∂a to `Phi` [m].
template <class Real>
void add_constraint_rate(const DriverChange<Real>& change, Vector<Real>& Phi) {
    for_each_row_rate<Real>(change,
                            [&](int row, const Row<Real>& d, Real dc) { Phi[row] += dc * d.Phi; });
}
// Adds amount · ∂(Φ_qᵀ λ)/∂a to `force` [6nb]: a driven length or angle scales or rotates the rows
// along which λ acts.
template <class Real>
void add_reaction_rate(const DriverChange<Real>& change, const Vector<Real>& lambda,
                       Vector<Real>& force) {
    for_each_row_rate<Real>(change, [&](int row, const Row<Real>& d, Real dc) {
        if (d.i != ground) force.template segment<6>(6 * d.i) += dc * lambda[row] * d.on_i();
        if (d.j != ground) force.template segment<6>(6 * d.j) += dc * lambda[row] * d.on_j();
    });
}

}  // namespace elastocheck::recursive
