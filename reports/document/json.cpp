#include "reports/document/json.hpp"

#include <fmt/format.h>

namespace elastocheck::reports {

nlohmann::ordered_json parse_json(std::string_view text) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const char c = text[k];
        if (in_string && c == '\\') {
            ++k;
        } else if (c == '"') {
            in_string = !in_string;
        } else if (!in_string) {
            depth += (c == '[' || c == '{') - (c == ']' || c == '}');
            if (depth > deepest_json) throw JsonError(fmt::format("nested more than {} deep", deepest_json));
        }
    }
    try {
        return nlohmann::ordered_json::parse(text);
    } catch (const nlohmann::json::exception& error) {
        throw JsonError(fmt::format("is no JSON, or was cut off ({})", error.what()));
    }
}

}  // namespace elastocheck::reports
