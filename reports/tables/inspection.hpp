// `elastocheck inspect`: how a scene was understood, before anything is solved.
#pragma once

#include <optional>
#include <string>

#include "compare/trim.hpp"
#include "models/model.hpp"
#include "recursive/diagnosis.hpp"

namespace elastocheck::reports {

struct Inspected {
    const Scene& scene;  // trimmed
    const Model& model;  // as it is solved
    const std::optional<compare::TrimRecord>& trim;
    const recursive::Diagnosis diagnosis;  // of `model`
    bool verbose = false;                  // long lists whole; what solving a step takes
};

std::string inspection(const Inspected& inspected);

}  // namespace elastocheck::reports
