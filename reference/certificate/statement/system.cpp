#include "reference/certificate/statement/system.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "models/branch.hpp"

namespace elastocheck::reference::certificate {
namespace {

using Eigen::Vector3d;

void set_paths(System& system) {
    const Model& model = *system.model;
    DrivenInputs<Affine> inputs = driven_inputs<Affine>(model, *system.branch);
    system.values = std::move(inputs.values);
    system.loads = std::move(inputs.loads);
    for (const auto& element : inputs.elements) system.elements.push_back(ElementPath{element});
    for (const auto& constraint : model.constraints) {
        system.first_row.push_back(system.rows);
        system.rows += rows(constraint.kind);
    }
}

bool resists_rotation(const SpatialLaw& law) {
    return std::visit(
        overloaded{[](const LinearStiffness& u) {
                       return (u.K.bottomRows<3>().array() != 0).any() ||
                              (u.K.rightCols<3>().array() != 0).any();
                   },
                   [](const PerAxis& u) {
                       return !(is_zero(u.axis[3]) && is_zero(u.axis[4]) && is_zero(u.axis[5]));
                   }},
        law);
}

// Whether the law is isotropic in two axes of the frame: k (d_i² + d_j²) / 2. Its undeformed
// lengths and preloads along them must be zero. A driven free length acts along axis 2.
bool is_round(const Bushing& bushing, const ElementPath& path, std::size_t i, std::size_t j) {
    const auto I = static_cast<Eigen::Index>(i), J = static_cast<Eigen::Index>(j);
    for (const std::size_t k : {i, j})
        if (bushing.undeformed[static_cast<Eigen::Index>(k)] != 0 ||
            (k == 2 && !(is_zero(path.free_length.start) && is_zero(path.free_length.rate))) ||
            !is_zero(path.preload[k].start) || !is_zero(path.preload[k].rate))
            return false;
    return std::visit(
        overloaded{[&](const LinearStiffness& u) {
                       Matrix6 coupled = u.K;
                       coupled(I, I) = coupled(J, J) = 0;
                       return u.K(I, I) == u.K(J, J) && (coupled.row(I).array() == 0).all() &&
                              (coupled.row(J).array() == 0).all() &&
                              (coupled.col(I).array() == 0).all() &&
                              (coupled.col(J).array() == 0).all();
                   },
                   [&](const PerAxis& u) {
                       const double *of_i = rate_of(u.axis[i]), *of_j = rate_of(u.axis[j]);
                       return of_i != nullptr && of_j != nullptr && *of_i == *of_j;
                   }},
        bushing.law);
}

void set_formulations(System& system) {
    for (const auto& load : system.loads)
        if (body_of(load.kind) != ground && !has_potential(load.kind)) system.conservative = false;
    for (std::size_t e = 0; e < system.elements.size(); ++e) {
        const auto& elastic = system.model->elastics[e];
        const auto* bushing = std::get_if<Bushing>(&elastic.kind);
        if (bushing == nullptr) continue;
        ElementPath& path = system.elements[e];
        path.rotational = resists_rotation(bushing->law);
        for (std::size_t k = 3; k < 6; ++k)
            path.rotational |= !is_zero(path.preload[k].start) || !is_zero(path.preload[k].rate);
        for (std::size_t k = 0; k < 3; ++k)
            path.turns_freely[k] = is_round(*bushing, path, (k + 1) % 3, (k + 2) % 3);
        const Formulation& f = bushing->formulation;
        if (f.frame == Formulation::Frame::on_j ||
            (f.frame == Formulation::Frame::middle && !f.conjugate))
            throw std::invalid_argument("bushing '" + elastic.name +
                                        "' has a frame for which this leg has no law");
        if (!elastocheck::has_energy(f)) system.conservative = false;
    }
}

// Origin c, the mean of all origins and attachment points, and size L, the largest distance of one
// from c [m]. The proof does not depend on them.
void set_size(System& system) {
    std::vector<Vector3d> points;
    const auto add = [&](BodyId body, const Vector3d& s_local) {
        if (body == ground) return points.push_back(s_local);
        const Pose& pose = system.model->bodies[static_cast<std::size_t>(body)].design;
        points.push_back(pose.r + pose.p * s_local);
    };
    const auto add_point = [&](const auto& at) { add(at.body, at.s_local); };
    for (const auto& body : system.model->bodies) points.push_back(body.design.r);
    for (const auto& constraint : system.model->constraints) each_point(constraint.kind, add_point);
    for (const auto& elastic : system.model->elastics) each_point(elastic.kind, add_point);
    for (const auto& p : points) system.c += p / static_cast<double>(points.size());
    // of the coordinates: coincident points may differ by this
    constexpr double rounding = 0x1p-42;
    double radius = 0, farthest = 0;
    for (const auto& p : points) {
        radius = std::max(radius, (p - system.c).norm());
        farthest = std::max(farthest, p.norm());
    }
    if (std::isfinite(radius) && radius > rounding * farthest) system.length = radius;
    if (std::isfinite(farthest)) system.farthest = std::max(system.length, farthest);
    if (!system.c.allFinite()) system.c.setZero();
}

}  // namespace

std::string why_not_tried(const System& system, int max_unknowns) {
    if (!arithmetic_is_as_proved())
        return "the arithmetic does not round to nearest, or flushes denormals to zero: nothing "
               "can be proved";
    if (system.n() <= max_unknowns) return {};
    return fmt::format("not tried: {} unknowns, proofs are tried up to {}", system.n(),
                       max_unknowns);
}

const ScalarLaw& law_of(const System& system, const SeparatedCurve& curve) {
    return *scalar_law(system.model->elastics[curve.element].kind, curve.axis);
}

void set_separated(const System& system, Eigen::VectorXd& z, double a) {
    if (system.separated.empty()) return;
    const auto x = deformations(system, {z.data(), z.data() + z.size()}, Interval(a));
    for (std::size_t k = 0; k < system.separated.size(); ++k) {
        const SeparatedCurve& curve = system.separated[k];
        const double at = mid(x[curve.element][curve.axis]);
        z[system.deformation(k)] = at;
        z[system.deformation(k) + 1] = force(law_of(system, curve), at);
    }
}

System make_system(const Model& model, const Branch& branch, Curves curves) {
    if (!fits_branch(model, branch))
        throw std::invalid_argument(
            "branch '" + branch.name +
            "' must be a single side from 0, with the model of that side (on_branch)");
    System system;
    system.model = &model;
    system.branch = &branch;
    system.bodies = static_cast<int>(model.bodies.size());
    set_paths(system);
    set_formulations(system);
    set_size(system);
    for (std::size_t e = 0; curves == Curves::separated && e < model.elastics.size(); ++e)
        each_curve(model.elastics[e].kind, [&](std::size_t k, const Curve&) {
            system.separated.push_back({e, k});
            system.elements[e].separated[k] = true;
        });
    return system;
}

std::vector<int> rows_of_joint(const System& system, int joint) {
    std::vector<int> list;
    for (std::size_t c = 0; c < system.values.size(); ++c)
        if (system.model->constraints[c].joint == joint)
            for (int n = 0; n < rows(system.model->constraints[c].kind); ++n)
                list.push_back(system.first_row[c] + n);
    return list;
}

}  // namespace elastocheck::reference::certificate
