#include "models/reader/tables/csv.hpp"

namespace elastocheck::reader {
namespace {

// End of the first cell of a line; commas between quotes do not count.
std::size_t end_of_cell(std::string_view line) {
    const auto begin = line.find_first_not_of(" \t");
    if (begin == line.npos || line[begin] != '"') return line.find(',');
    const auto close = line.find('"', begin + 1);
    return line.find(',', close == line.npos ? 0 : close);
}

std::string_view unquoted(std::string_view cell) {
    const bool quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
    return quoted ? cell.substr(1, cell.size() - 2) : cell;
}

}  // namespace

CsvLines::CsvLines(std::string_view text)
    : lines_(text.substr(text.starts_with("\xEF\xBB\xBF") ? 3 : 0)) {}

bool CsvLines::next() {
    do {
        if (!lines_.next()) return false;
        line_ = trimmed(lines_.line());
    } while (line_.empty());
    return true;
}

std::vector<std::string_view> CsvLines::cells() const {
    std::vector<std::string_view> cells;
    for (std::string_view line = line_;;) {
        const auto comma = end_of_cell(line);
        cells.push_back(unquoted(trimmed(line.substr(0, comma))));
        if (comma == line.npos || cells.size() > max_cells) return cells;
        line.remove_prefix(comma + 1);
    }
}

}  // namespace elastocheck::reader
