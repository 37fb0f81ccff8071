#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "reports/render/render.hpp"
#include "reports/text/escape.hpp"

namespace elastocheck::reports {

std::string markdown(std::string_view text, std::size_t longest) {
    if (std::string safe = for_markdown(text); safe.size() <= longest) return safe;
    // each character may take a backslash
    std::size_t end = std::min(text.size(), longest / 2);
    while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) ++end;
    return for_markdown(text.substr(0, end)) + "...";
}

std::string markdown(const compare::Table& table, std::size_t longest) {
    std::vector<std::string> lines(table.rows.size() + 2, "|");
    for (const auto& column : shown_columns(table)) {
        lines[0] += fmt::format(" {} |", markdown(column.heading, longest));
        lines[1] += column.words ? "---|" : "--:|";
        for (std::size_t r = 0; r < column.cells.size(); ++r)
            lines[r + 2] += fmt::format(" {} |", markdown(column.cells[r], longest));
    }
    return fmt::format("{}\n", fmt::join(lines, "\n"));
}

}  // namespace elastocheck::reports
