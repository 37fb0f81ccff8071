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

std::vector<std::string> lower_words(std::string_view text) {
    std::vector<std::string> words;
    bool open = false;
    for (const char c : text) {
        const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        const bool letter = (lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9');
        if (letter && !open) words.emplace_back();
        if (letter) words.back() += lower;
        open = letter;
    }
    return words;
}

}  // namespace elastocheck::reports
