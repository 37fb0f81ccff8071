// Parser of external JSON, with limits; the only place that parses JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "reports/files/limits.hpp"

namespace elastocheck::reports {

// what() gives the reason without the name of the file.
struct JsonError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Throws JsonError for text that is not JSON, is truncated, is nested deeper than `deepest_json`
// (which could overflow the stack) or needs more memory than `largest_json`.
nlohmann::ordered_json parse_json(std::string_view text);

}  // namespace elastocheck::reports
