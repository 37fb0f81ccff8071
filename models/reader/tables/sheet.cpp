#include "models/reader/tables/sheet.hpp"

#include <algorithm>
#include <utility>

#include "models/reader/document/characters.hpp"
#include "models/reader/document/yaml.hpp"

namespace elastocheck::reader {
namespace {

// RFC 4180, with any separator and with LF, CR LF or CR as line end.
struct Splitter {
    std::string_view text;
    char separator;
    std::size_t place = 0;  // in the text
    int line = 1;
    int wrong_line = 0;           // line of the error
    const char* wrong = nullptr;  // a quote that does not end, or too many cells; null: no error

    bool ends_line() const { return text[place] == '\n' || text[place] == '\r'; }
    void pass_line_end() {
        if (text[place] == '\r' && place + 1 < text.size() && text[place + 1] == '\n') ++place;
        ++place;
        ++line;
    }

    // From the quote to behind the one that ends it; "" is a quote within.
    std::string quoted() {
        const int begin = line;
        std::string cell;
        for (++place; place < text.size();) {
            if (text[place] == '"') {
                if (++place == text.size() || text[place] != '"') return cell;
                cell += text[place++];
            } else if (ends_line()) {
                cell += ' ';
                pass_line_end();
            } else {
                cell += text[place++];
            }
        }
        if (wrong == nullptr) {
            wrong_line = begin;
            wrong = "the quote in this line does not end";
        }
        return cell;
    }

    std::string cell() {
        while (place < text.size() && text[place] != separator &&
               (text[place] == ' ' || text[place] == '\t'))
            ++place;
        std::string cell;
        if (place < text.size() && text[place] == '"') cell = quoted();
        while (place < text.size() && text[place] != separator && !ends_line())
            cell += text[place++];
        return std::string(trimmed(cell));
    }

    SheetRow row() {
        SheetRow row{.line = line, .cells = {}};
        for (;;) {
            row.cells.push_back(cell());
            if (row.cells.size() > SheetRow::max_cells && wrong == nullptr) {
                wrong_line = row.line;
                wrong = "more than 10000 cells";
            }
            if (place == text.size() || wrong != nullptr) return row;
            if (ends_line()) {
                pass_line_end();
                return row;
            }
            ++place;
        }
    }
};

// A text split by one separator, and the error in it if any.
struct Trial {
    Sheet sheet;
    int wrong_line = 0;
    const char* wrong = nullptr;
};

Trial split(std::string_view text, char separator, int first_line) {
    Trial trial{.sheet = {separator, {}}};
    Splitter splitter{.text = text, .separator = separator, .line = first_line};
    while (splitter.place < text.size() && splitter.wrong == nullptr) {
        SheetRow row = splitter.row();
        if (!std::ranges::all_of(row.cells, &std::string::empty))
            trial.sheet.rows.push_back(std::move(row));
    }
    trial.wrong_line = splitter.wrong_line;
    trial.wrong = splitter.wrong;
    return trial;
}

Sheet checked(Trial trial, const std::string& file) {
    if (trial.wrong != nullptr) fail(file, trial.wrong_line, "", trial.wrong);
    return std::move(trial.sheet);
}

// Number of rows with at least `columns` cells; without such rows, the number of cells decides.
std::pair<std::ptrdiff_t, std::size_t> score(const Trial& trial, std::size_t columns) {
    if (trial.wrong != nullptr) return {-1, 0};
    const auto wide = std::ranges::count_if(
        trial.sheet.rows, [&](const SheetRow& row) { return row.cells.size() >= columns; });
    std::size_t cells = 0;
    if (wide == 0)
        for (const SheetRow& row : trial.sheet.rows) cells += row.cells.size();
    return {wide, cells};
}

}  // namespace

Sheet read_sheet(std::string_view text, const std::string& file, std::size_t columns) {
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
        fail(file, 1, "", "UTF-16; allowed: a CSV file in UTF-8");
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    if (text.starts_with("sep=") && text.size() > 5 && (text[5] == '\r' || text[5] == '\n')) {
        const char separator = text[4];
        const bool has_crlf = text[5] == '\r' && text.size() > 6 && text[6] == '\n';
        return checked(split(text.substr(has_crlf ? 7 : 6), separator, 2), file);
    }
    Trial best = split(text, ';', 1);
    for (const char separator : {'\t', ','})
        if (Trial trial = split(text, separator, 1); score(trial, columns) > score(best, columns))
            best = std::move(trial);
    return checked(std::move(best), file);
}

std::string letters_of(std::size_t column) {
    std::string letters;
    for (std::size_t k = column + 1; k > 0; k = (k - 1) / 26)
        letters.insert(letters.begin(), static_cast<char>('A' + (k - 1) % 26));
    return letters;
}

}  // namespace elastocheck::reader
