#include "models/structure.hpp"

#include "models/kinds.hpp"
#include "models/overloaded.hpp"

namespace elastocheck {
namespace {

void append(const ScalarLaw& law, std::vector<int>& list) {
    list.push_back(static_cast<int>(law.index()));
    if (const Curve* curve = curve_of(law)) list.push_back(static_cast<int>(curve->pieces.size()));
}
void append(const LinearStiffness&, std::vector<int>&) {}
void append(const PerAxis& law, std::vector<int>& list) {
    for (const ScalarLaw& axis : law.axis) append(axis, list);
}
void append(const SpatialLaw& law, std::vector<int>& list) {
    list.push_back(static_cast<int>(law.index()));
    std::visit([&](const auto& kind) { append(kind, list); }, law);
}
void append(const Formulation& f, std::vector<int>& list) {
    for (const auto value : {static_cast<int>(f.frame), static_cast<int>(f.angles),
                             static_cast<int>(f.conjugate), static_cast<int>(f.offset_moment)})
        list.push_back(value);
}

// Kind and bodies of a constraint, an element or a load, and the law of an element.
template <class Kinds>
void append_kind(const Kinds& kinds, std::vector<int>& list) {
    list.push_back(static_cast<int>(kinds.index()));
    const auto body = [&](const auto& member) { list.push_back(member.body); };
    each_member(kinds,
                overloaded{[&](const BodyId& member) { list.push_back(member); },
                           [&](const Point& member) { body(member); },
                           [&](const Direction& member) { body(member); },
                           [&](const Marker& member) { body(member); },
                           [&](const ScalarLaw& law) { append(law, list); },
                           [&](const SpatialLaw& law) { append(law, list); },
                           [&](const Formulation& formulation) { append(formulation, list); }});
}

}  // namespace

void structure(const Model& model, std::vector<int>& list) {
    list.clear();
    for (const std::size_t count :
         {model.bodies.size(), model.joints.size(), model.constraints.size(), model.elastics.size(),
          model.static_loads.size(), model.branches.size(), model.wheels.size(),
          model.probes.size(), model.dampers.size()})
        list.push_back(static_cast<int>(count));
    for (const auto& joint : model.joints) list.insert(list.end(), {joint.i, joint.driven});
    for (const auto& constraint : model.constraints) {
        list.push_back(constraint.joint);
        append_kind(constraint.kind, list);
    }
    for (const auto& elastic : model.elastics) append_kind(elastic.kind, list);
    for (const auto& load : model.static_loads) append_kind(load.kind, list);
    for (const auto& branch : model.branches) {
        list.push_back(static_cast<int>(branch.drivers.size()));
        list.push_back(branch.from == 0);
        for (const auto& driver : branch.drivers) {
            list.push_back(static_cast<int>(driver.what.index()));
            std::visit(overloaded{[&](const Load& load) { append_kind(load.kind, list); },
                                  [&](const Motion& motion) { list.push_back(motion.joint); },
                                  [&](const auto& element) { list.push_back(element.elastic); }},
                       driver.what);
        }
    }
}

}  // namespace elastocheck
