#include "reports/text/words.hpp"

#include <algorithm>

namespace elastocheck::reports {

std::string enumerated(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t k = 0; k < words.size(); ++k)
        text += (k == 0 ? "" : k + 1 == words.size() ? " and " : ", ") + words[k];
    return text;
}

std::string counted(std::size_t count, const std::string& noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string as_words(std::string name) {
    std::ranges::replace(name, '_', ' ');
    if (const auto at = name.find('@'); at != name.npos) name.replace(at, 1, ", ");
    return name;
}

}  // namespace elastocheck::reports
