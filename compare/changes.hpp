// What became of the numbers of a scene file since a result was accepted: a result that moved has its reason there, or
// in the code.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "models/scene.hpp"

namespace elastocheck::compare {

struct Change {
    std::optional<Number> was, is;  // of one path; none where it is new, or gone
};

// In the order of the scene as it is, then what is gone. Numbers are told by their paths, and are the same where value
// and unit are, as they stand in the file.
std::vector<Change> changes(std::span<const Number> was, std::span<const Number> is);

}  // namespace elastocheck::compare
