// Sets of bodies that joints without freedom fix to each other. compile() merges these unless it keeps
// every part (Detail::everything); outputs that depend on the body of a point are the same either way.
#pragma once

#include <algorithm>
#include <vector>

#include "elastocheck/model.hpp"

namespace elastocheck::compare {

class FixedBodies {
  public:
    explicit FixedBodies(const Model& model) : first_(model.bodies.size() + 1) {
        for (std::size_t b = 0; b < first_.size(); ++b) first_[b] = static_cast<BodyId>(b) - 1;
        std::vector<int> rows_of(model.joints.size());
        for (const Constraint& c : model.constraints)
            rows_of[static_cast<std::size_t>(c.joint)] += rows(c.kind);
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t k = 0; k < model.joints.size(); ++k) {
                const ModelJoint& joint = model.joints[k];
                if (rows_of[k] != 6 || joint.active_only_where_driven) continue;
                BodyId &i = first(joint.i), &j = first(joint.j);
                changed = changed || i != j;
                i = j = std::min(i, j);
            }
        }
    }
    bool are_one(BodyId a, BodyId b) const { return first(a) == first(b); }
    bool is_first(BodyId body) const { return first(body) == body; }
    // whether i is fixed to a and j to b, or i to b and j to a
    bool are_two(BodyId i, BodyId j, BodyId a, BodyId b) const {
        return (are_one(i, a) && are_one(j, b)) || (are_one(i, b) && are_one(j, a));
    }

  private:
    BodyId& first(BodyId body) { return first_[static_cast<std::size_t>(body + 1)]; }
    BodyId first(BodyId body) const { return first_[static_cast<std::size_t>(body + 1)]; }
    std::vector<BodyId> first_;  // of the bodies fixed to each; ground is number 0
};

}  // namespace elastocheck::compare
