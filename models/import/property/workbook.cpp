// Writes the cells of a sheet of a workbook (.xlsx, ISO/IEC 29500) as CSV.
#include <minizip/unzip.h>

#include <algorithm>
#include <map>
#include <memory>
#include <pugixml.hpp>
#include <string_view>
#include <vector>

#include "models/import/import.hpp"
#include "models/import/property/columns.hpp"
#include "models/reader/document/suggestions.hpp"

namespace elastocheck::importer {
namespace {

constexpr std::size_t largest_part = 64 << 20;  // [bytes], unpacked
constexpr std::size_t max_rows = 100'000;

// The text of a part of a zip file; empty if there is none.
std::string unpacked(void* zip, const std::string& name, const std::string& file) {
    if (unzLocateFile(zip, name.c_str(), 2) != UNZ_OK) return "";  // 2: in any case
    const auto broken = [&](const char* what) {
        fail(file, 0, "", "the part {} of the workbook {}", reader::quote(name), what);
    };
    if (unzOpenCurrentFile(zip) != UNZ_OK) broken("cannot be opened");
    std::string text;
    std::vector<char> block(1 << 16);
    int count = 0;
    while ((count = unzReadCurrentFile(zip, block.data(), 1 << 16)) > 0) {
        text.append(block.data(), static_cast<std::size_t>(count));
        if (text.size() > largest_part) broken("is larger than 64 MiB");
    }
    if (unzCloseCurrentFile(zip) != UNZ_OK || count < 0) broken("is damaged");
    return text;
}

struct Workbook {
    const std::string& file;
    const WorkbookParts& part;

    pugi::xml_document xml(const std::string& name) const {
        pugi::xml_document document;
        const std::string text = part(name);
        if (text.empty()) return document;
        constexpr unsigned as_written = pugi::parse_default | pugi::parse_ws_pcdata_single;
        if (const auto read = document.load_buffer(text.data(), text.size(), as_written); !read)
            fail(file, 0, "", "the part {} of the workbook: {}", reader::quote(name),
                 read.description());
        return document;
    }
};

// Whether an element has the name, in any XML namespace: "x:row" is a row.
bool is_called(const pugi::xml_node& node, std::string_view name) {
    const std::string_view full = node.name();
    return full.substr(full.find(':') + 1) == name;  // npos + 1 is 0
}
std::vector<pugi::xml_node> children(const pugi::xml_node& parent, std::string_view name) {
    std::vector<pugi::xml_node> found;
    for (const pugi::xml_node& child : parent)
        if (is_called(child, name)) found.push_back(child);
    return found;
}
pugi::xml_node child(const pugi::xml_node& parent, std::string_view name) {
    const auto found = children(parent, name);
    return found.empty() ? pugi::xml_node() : found.front();
}

// The text of a string: of its runs (r) and texts (t), without phonetic runs (rPh).
std::string text_in(const pugi::xml_node& string) {
    std::string text;
    for (const pugi::xml_node& node : string) {
        if (is_called(node, "t")) text += node.child_value();
        if (is_called(node, "r")) text += text_in(node);
    }
    return text;
}

// Column of a cell reference such as "AB12", from 0.
std::size_t column_in(std::string_view place) {
    std::size_t column = 0;
    for (const char c : place)
        if (c >= 'A' && c <= 'Z') column = 26 * column + static_cast<std::size_t>(c - 'A' + 1);
    return column - 1;
}

std::string value_in(const pugi::xml_node& cell, const std::vector<std::string>& strings) {
    const std::string_view type = cell.attribute("t").value();
    if (type == "inlineStr") return text_in(child(cell, "is"));
    const auto value = child(cell, "v");
    if (type != "s") return value.child_value();
    const std::size_t at = value.text().as_uint(static_cast<unsigned>(strings.size()));
    return at < strings.size() ? strings[at] : "";
}

std::string quoted(const std::string& cell) {
    std::string text = "\"";
    for (const char c : cell) text += c == '"' ? "\"\"" : std::string(1, c == '\n' ? ' ' : c);
    return text + '"';
}

struct SheetText {
    std::string name, csv;
    bool has_numbers = false;  // at least three in one row
};

SheetText text_of_sheet(const Workbook& book, const std::string& name, const std::string& part,
                        const std::vector<std::string>& strings) {
    SheetText sheet{name, ""};
    const auto document = book.xml(part);
    std::size_t line = 1;
    for (const auto& row : children(child(document.document_element(), "sheetData"), "row")) {
        const std::size_t number = row.attribute("r").as_uint(static_cast<unsigned>(line));
        if (number < line || number > max_rows)
            fail(book.file, static_cast<int>(number), name, "rows are not in order, or beyond {}",
                 max_rows);
        for (; line < number; ++line) sheet.csv += '\n';
        std::size_t column = 0, numbers = 0;
        for (const auto& cell : children(row, "c")) {
            const std::string_view place = cell.attribute("r").value();
            const std::size_t at = place.empty() ? column : column_in(place);
            if (at < column || at >= SheetRow::max_cells)
                fail(book.file, static_cast<int>(number), name,
                     "cells are not in order, or beyond {}", SheetRow::max_cells);
            const std::string value = value_in(cell, strings);
            sheet.csv.append(at - column, ',').append(quoted(value)).append(",");
            column = at + 1;
            if (coordinate(value, false)) ++numbers;
        }
        if (column > 0) sheet.csv.pop_back();
        sheet.has_numbers = sheet.has_numbers || numbers >= 3;
        sheet.csv += '\n';
        ++line;
    }
    return sheet;
}

std::vector<SheetText> sheets_of(const Workbook& book) {
    const auto links = book.xml("xl/_rels/workbook.xml.rels");
    std::map<std::string, std::string> parts;
    for (const auto& link : children(links.document_element(), "Relationship")) {
        std::string target = link.attribute("Target").value();
        target = target.starts_with('/') ? target.substr(1) : "xl/" + target;
        parts[link.attribute("Id").value()] = target;
    }
    std::vector<std::string> strings;
    const auto shared = book.xml("xl/sharedStrings.xml");
    for (const auto& string : children(shared.document_element(), "si"))
        strings.push_back(text_in(string));
    std::vector<SheetText> sheets;
    const auto index = book.xml("xl/workbook.xml");
    for (const auto& sheet : children(child(index.document_element(), "sheets"), "sheet"))
        if (const std::string_view state = sheet.attribute("state").as_string("visible");
            state == "visible")
            sheets.push_back(text_of_sheet(book, sheet.attribute("name").value(),
                                           parts[sheet.attribute("r:id").value()], strings));
    return sheets;
}

}  // namespace

std::string csv_of_workbook(const std::filesystem::path& path, const std::string& wanted) {
    const std::string file = path.string();
    const std::unique_ptr<void, int (*)(void*)> zip{unzOpen64(file.c_str()), unzClose};
    if (!zip) fail(file, 0, "", "not a workbook (.xlsx)");
    return csv_of_workbook([&](const std::string& name) { return unpacked(zip.get(), name, file); },
                           file, wanted);
}

std::string csv_of_workbook(const WorkbookParts& parts, const std::string& file,
                            const std::string& wanted) {
    const Workbook book{file, parts};
    std::vector<SheetText> sheets = sheets_of(book);
    if (sheets.empty()) fail(file, 0, "", "a workbook without a visible sheet");
    std::vector<std::string> names;
    for (const SheetText& sheet : sheets) names.push_back(sheet.name);
    if (!wanted.empty() && std::ranges::find(names, wanted) == names.end())
        fail(file, 0, "--sheet", "there is no sheet {}{}", reader::quote(wanted),
             reader::did_you_mean(wanted, names, "sheets"));
    std::erase_if(sheets, [&](const SheetText& sheet) {
        return wanted.empty() ? !sheet.has_numbers : sheet.name != wanted;
    });
    names.clear();
    for (const SheetText& sheet : sheets) names.push_back(sheet.name);
    if (sheets.size() > 1)
        fail(file, 0, "--sheet", "several sheets have numbers; choose one: {}",
             reader::listed(names));
    return sheets.empty() ? "" : sheets.front().csv;
}

}  // namespace elastocheck::importer
