#include "models/reader/document/suggestions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "models/reader/document/characters.hpp"

namespace elastocheck::reader {
namespace {

constexpr std::size_t longest_shown = 64;
constexpr std::size_t longest_list = 24;

// Edit distance with insertions, deletions, replacements and transpositions (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before_last, last(b.size() + 1), row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before_last = std::exchange(last, row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min(
                {last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before_last[j - 2] + 1);
        }
    }
    return row[b.size()];
}

// A probable misspelling: one letter or up to a third of them wrong. Words below three letters never match.
bool is_near(std::size_t distance, std::size_t letters) {
    return letters >= 3 && distance <= std::max<std::size_t>(1, letters / 3);
}

}  // namespace

std::string shown(std::string_view text) {
    const bool is_long = text.size() > longest_shown;
    std::size_t end = std::min(text.size(), longest_shown);
    const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
    while (is_long && end > 0 && continues(text[end])) --end;  // whole UTF-8 characters
    std::string line(text.substr(0, end));
    std::replace_if(line.begin(), line.end(), is_control, '?');
    return is_long ? line + "..." : line;
}

std::string quote(std::string_view text) { return fmt::format("'{}'", shown(text)); }

std::string child_path(const std::string& path, std::string_view key) {
    return path.empty() ? shown(key) : fmt::format("{}.{}", path, shown(key));
}

std::string listed(const std::vector<std::string>& words) {
    const std::size_t count = std::min(words.size(), longest_list);
    const auto rest =
        count == words.size() ? "" : fmt::format(" and {} more", words.size() - count);
    return fmt::format("{}{}", fmt::join(std::span(words).first(count), ", "), rest);
}

std::string did_you_mean(std::string_view wrong, const std::vector<std::string>& right,
                         const char* label) {
    const std::string* nearest = nullptr;
    std::size_t least = longest_shown;
    if (wrong.size() <= longest_shown) {
        for (const std::string& word : right) {
            const std::size_t distance = edit_distance(wrong, word);
            if (distance >= least || !is_near(distance, std::max(wrong.size(), word.size())))
                continue;
            least = distance;
            nearest = &word;
        }
    }
    const std::string allowed = fmt::format("{}: {}", label, listed(right));
    return nearest ? fmt::format(", did you mean '{}'? {}", *nearest, allowed)
                   : fmt::format("; {}", allowed);
}

}  // namespace elastocheck::reader
