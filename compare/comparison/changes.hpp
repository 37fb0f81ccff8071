// Changes of the numbers in a scene file since a result was accepted: possible causes of
// a moved result.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "compare/result/table.hpp"
#include "elastocheck/scene.hpp"

namespace elastocheck::compare {

struct Change {
    std::optional<Number> was, is;  // of one path; empty where the number is new or removed
};

// In the order of the current scene, then the removed numbers. Numbers are identified by their
// paths and compared by value and unit as written in the file.
std::vector<Change> changes(std::span<const Number> was, std::span<const Number> is);

// Columns: number, old value (headed `was`), new value (headed `is`), unit.
Table table_of(const std::vector<Change>& changes, const char* was = "was", const char* is = "is");

}  // namespace elastocheck::compare
