#include "reports/json/json.hpp"

#include <fmt/format.h>

namespace elastocheck::reports {

nlohmann::ordered_json parse_json(std::string_view text) {
    // A value takes 16 bytes, in an object 48 with its name; a list or an object also has a heap
    // vector with doubling growth.
    constexpr double value_bytes = 2 * 48, list_bytes = 48;
    int depth = 0;
    double bytes = static_cast<double>(text.size());
    bool in_string = false;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const char c = text[k];
        if (in_string && c == '\\') {
            ++k;
        } else if (c == '"') {
            in_string = !in_string;
        } else if (!in_string) {
            const bool opens = c == '[' || c == '{';
            depth += opens - (c == ']' || c == '}');
            bytes += opens ? value_bytes + list_bytes : c == ',' ? value_bytes : 0;
            if (depth > deepest_json)
                throw JsonError(fmt::format("nested more than {} levels deep", deepest_json));
        }
    }
    if (bytes > largest_json)
        throw JsonError(fmt::format("would take about {:.1f} GB of memory; allowed: {:.0f} GB",
                                    1e-9 * bytes, 1e-9 * largest_json));
    try {
        return nlohmann::ordered_json::parse(text);
    } catch (const nlohmann::json::exception& error) {
        throw JsonError(fmt::format("is not JSON, or is cut off ({})", error.what()));
    }
}

}  // namespace elastocheck::reports
