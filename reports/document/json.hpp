// JSON from outside: the only place where it is parsed.
#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

#include "reports/files/limits.hpp"

namespace elastocheck::reports {

// what() says why, without the name of the file.
struct JsonError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Throws JsonError: not JSON, cut off, nested deeper than `deepest_json`, which would end in a crash somewhere, or
// larger than `largest_json`.
nlohmann::ordered_json parse_json(std::string_view text);

}  // namespace elastocheck::reports
