// Inputs of the equations that the drivers of a branch change.
// Balance and Φ are functions of (q, inputs); at the parameter a
//
//   input(t, a) = value at the design position + t · start + a · rate
//
// for every driver. t goes from 0, the model at the design position, to 1 while the start is
// settled (settle.hpp), and stays 1 on the branch.
#pragma once

#include <stdexcept>

#include "models/branch.hpp"
#include "models/kinds.hpp"
#include "models/vanishing_length.hpp"
#include "recursive/formula/law.hpp"

namespace elastocheck::recursive {

// Rest values of an elastic element; the field of the other kind stays zero.
template <class Real>
struct Rest {
    Real free_length = 0;                              // ℓ₀ of an AxialSpring [m]
    Vector6<Real> preload = Vector6<Real>::Zero();     // of a Bushing [N, N·m]
    Vector6<Real> undeformed = Vector6<Real>::Zero();  // likewise, e₀ [m, rad]
    Pieces piece = everywhere;                         // of its curves; constant on a branch
};

template <class Real>
struct Inputs {
    std::vector<Real> offset;  // per constraint: its offset or length [m], its angle [rad]; else 0
    std::vector<Rest<Real>> rest;   // per elastic element
    std::vector<Real> load_factor;  // per driver of the branch: of its load; else 0
    std::vector<int> row;           // per constraint: its first row of Φ
};

// ---- Values of the model at the design position.

template <class Real>
Real offset_of(const ConstraintKind& kind) {
    const double* value = driven_number(kind);
    return value != nullptr ? static_cast<Real>(*value) : Real(0);
}
template <class Real>
Rest<Real> rest_of(const ElasticKind& kind) {
    Rest<Real> rest;
    if (const double* length = driven_number(kind)) rest.free_length = static_cast<Real>(*length);
    if (const auto* wrench = preload(kind)) rest.preload = wrench->template cast<Real>();
    each_member(kind, [&](Deformation<const Vector6<double>> e) {
        rest.undeformed = e.value.template cast<Real>();
    });
    return rest;
}

template <class Real>
Inputs<Real> inputs_as_drawn(const Model& model) {
    Inputs<Real> inputs;
    int row = 0;
    for (const auto& constraint : model.constraints) {
        inputs.offset.push_back(offset_of<Real>(constraint.kind));
        inputs.row.push_back(row);
        row += rows(constraint.kind);
    }
    for (const auto& elastic : model.elastics) inputs.rest.push_back(rest_of<Real>(elastic.kind));
    return inputs;
}

// ---- Values along the branch.

// The constraint whose offset a motion changes. Pre: `fits_branch`.
inline std::size_t constraint_of(const Model& model, const Motion& motion) {
    return static_cast<std::size_t>(model.joints[static_cast<std::size_t>(motion.joint)].driven);
}

// Throws std::invalid_argument unless the branch fits the model and every driver has
// a matching target.
inline void check(const Model& model, const Branch& branch) {
    const auto require = [&](bool met, const char* what) {
        if (!met) throw std::invalid_argument("branch '" + branch.name + "': " + what);
    };
    const auto elastic = [&](int k) -> const ElasticKind* {
        const auto at = static_cast<std::size_t>(k);
        return at < model.elastics.size() ? &model.elastics[at].kind : nullptr;
    };
    for (const auto& driver : branch.drivers)
        std::visit(overloaded{
                       [](const Load&) {},
                       [&](const Motion& m) {
                           const auto at = static_cast<std::size_t>(m.joint);
                           require(at < model.joints.size() && model.joints[at].driven >= 0,
                                   "it drives a joint without offset, length or angle");
                       },
                       [&](const FreeLength& f) {
                           require(elastic(f.elastic) != nullptr,
                                   "it drives the free length of an element that does not exist");
                       },
                       [&](const Preload& p) {
                           const ElasticKind* kind = elastic(p.elastic);
                           require(kind != nullptr && preload(*kind) != nullptr,
                                   "it drives the preload of an element that is not a bushing");
                       },
                   },
                   driver.what);
    for (const auto& element : model.elastics) {
        const auto* f = member<Formulation>(element.kind);
        if (f == nullptr) continue;
        require(f->frame != Formulation::Frame::on_j,
                "a bushing's frame is on j; compile() converts it to one on i");
        require(f->conjugate || f->frame == Formulation::Frame::on_i,
                "a bushing's forces are not conjugate, which is defined with its frame on i only");
    }
    require(fits_branch(model, branch),
            "the model has parts that are inactive on it, or it does not begin at 0 (on_branch, "
            "branch_sides)");
}

// The last parameter that is followed: `to` unless a driven length between two points vanishes
// before. The row (d·d - c²) / (2c) of a length c is also zero where c = -|d|.
inline double last_parameter(const Model& model, const Branch& branch) {
    constexpr double share = 1 - 1e-3;
    const auto vanishing = vanishing_length(model, branch);
    return vanishing ? share * vanishing->parameter : branch.to;
}

// The inputs at (t, a), from those at the design position. Allocates only on the first call with
// the same `inputs`.
template <class Real>
void set_inputs(const Model& model, const Branch& branch, const Inputs<Real>& drawn, Real t, Real a,
                Inputs<Real>& inputs) {
    if (inputs.row.size() != drawn.row.size() || inputs.rest.size() != drawn.rest.size())
        inputs = drawn;
    inputs.load_factor.resize(branch.drivers.size());
    // Each driver changes one input and two drivers may share it: first reset all, then add.
    const auto each = [&](auto&& change) {
        for (std::size_t k = 0; k < branch.drivers.size(); ++k) {
            const Real value = t * static_cast<Real>(branch.drivers[k].start) +
                               a * static_cast<Real>(branch.drivers[k].rate);
            std::visit(overloaded{
                           [&](const Load&) { change(inputs.load_factor[k], Real(0), value); },
                           [&](const Motion& m) {
                               const std::size_t c = constraint_of(model, m);
                               change(inputs.offset[c], drawn.offset[c], value);
                           },
                           [&](const FreeLength& f) {
                               const auto e = static_cast<std::size_t>(f.elastic);
                               Rest<Real>& rest = inputs.rest[e];
                               const Rest<Real>& as_drawn = drawn.rest[e];
                               if (driven_number(model.elastics[e].kind) != nullptr)
                                   change(rest.free_length, as_drawn.free_length, value);
                               else
                                   change(rest.undeformed[2], as_drawn.undeformed[2], value);
                           },
                           [&](const Preload& p) {
                               const auto e = static_cast<std::size_t>(p.elastic);
                               change(inputs.rest[e].preload, drawn.rest[e].preload,
                                      value * p.direction.cast<Real>());
                           },
                       },
                       branch.drivers[k].what);
        }
    };
    each([](auto& input, const auto& as_drawn, const auto&) { input = as_drawn; });
    each([](auto& input, const auto&, const auto& by) { input += by; });
}

template <class Real>
Inputs<Real> inputs_at(const Model& model, const Branch& branch, Real a) {
    const Inputs<Real> drawn = inputs_as_drawn<Real>(model);
    Inputs<Real> inputs;
    set_inputs<Real>(model, branch, drawn, Real(1), a, inputs);
    return inputs;
}

// Instantiated in linear_algebra/in_double.cpp.
extern template void set_inputs<double>(const Model&, const Branch&, const Inputs<double>&, double,
                                        double, Inputs<double>&);

}  // namespace elastocheck::recursive
