// JSON from outside: the only place where it is parsed.
#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>

namespace elastocheck::reports {

// what() says why, without the name of the file.
struct JsonError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

inline constexpr int deepest_json = 64;  // a result needs fourteen

// Throws JsonError: not JSON, cut off, or nested deeper than `deepest_json`, which would end in a crash
// somewhere.
nlohmann::ordered_json parse_json(std::string_view text);

}  // namespace elastocheck::reports
