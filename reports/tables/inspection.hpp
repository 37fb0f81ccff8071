// `elastocheck inspect`: how a scene was understood, before anything is solved.
#pragma once

#include <string>

#include "models/model.hpp"
#include "recursive/diagnosis.hpp"

namespace elastocheck::reports {

std::string inspection(const Model& model, const recursive::Diagnosis& diagnosis);

}  // namespace elastocheck::reports
