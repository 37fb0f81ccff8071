// `elastocheck inspect`: the scene as read and compiled, before anything is solved.
#pragma once

#include <optional>
#include <string>

#include "elastocheck/model.hpp"
#include "elastocheck/trim.hpp"

namespace elastocheck::reports {

struct Inspected {
    const Scene& scene;  // trimmed
    const Model& model;  // as solved
    const std::optional<compare::TrimRecord>& trim;
    bool verbose = false;  // complete lists, and the cost of a step
};

std::string inspection(const Inspected& inspected);

}  // namespace elastocheck::reports
