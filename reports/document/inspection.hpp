// `elastocheck inspect`: the scene as read and compiled, before anything is solved.
#pragma once

#include <optional>
#include <string>

#include "elastocheck/model.hpp"
#include "elastocheck/trim.hpp"
#include "recursive/diagnosis/diagnosis.hpp"

namespace elastocheck::reports {

struct Inspected {
    const Scene& scene;  // trimmed
    const Model& model;  // as solved
    const std::optional<compare::TrimRecord>& trim;
    const recursive::Diagnosis diagnosis;  // of `model`
    bool verbose = false;                  // complete lists, and the cost of a step
};

std::string inspection(const Inspected& inspected);

}  // namespace elastocheck::reports
