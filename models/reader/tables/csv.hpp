// Lines and cells of a CSV text.
#pragma once

#include <string_view>
#include <vector>

#include "models/reader/document/characters.hpp"

namespace elastocheck::reader {

// Reads a CSV text line by line. A byte-order mark and lines without content are skipped.
class CsvLines {
  public:
    static constexpr std::size_t max_cells = 10'000;

    explicit CsvLines(std::string_view text);

    // Advances to the next line with content; false at the end.
    bool next();

    int number() const { return lines_.number(); }    // of the line, from 1
    std::string_view whole() const { return line_; }  // the line, trimmed
    // trimmed, without quotes around a cell; at most `max_cells` + 1 of them
    std::vector<std::string_view> cells() const;

  private:
    Lines lines_;
    std::string_view line_;
};

}  // namespace elastocheck::reader
