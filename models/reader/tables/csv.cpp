#include "models/reader/tables/csv.hpp"

#include "models/reader/document/characters.hpp"

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

CsvLines::CsvLines(std::string_view text) : rest_(text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
}

bool CsvLines::next() {
    while (!rest_.empty()) {
        ++number_;
        const auto end = rest_.find('\n');
        line_ = trimmed(rest_.substr(0, end));
        rest_ = end == rest_.npos ? std::string_view{} : rest_.substr(end + 1);
        if (!line_.empty()) return true;
    }
    return false;
}

std::vector<std::string_view> CsvLines::cells() const {
    std::vector<std::string_view> cells;
    for (std::string_view line = line_;;) {
        const auto comma = end_of_cell(line);
        cells.push_back(unquoted(trimmed(line.substr(0, comma))));
        if (comma == line.npos || cells.size() > most_cells) return cells;
        line.remove_prefix(comma + 1);
    }
}

}  // namespace elastocheck::reader
