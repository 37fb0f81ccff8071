// What the study in Python takes from the program: its reader of YAML, its pages, its files.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "models/reader/document/cursor.hpp"
#include "models/reader/document/suggestions.hpp"
#include "reports/files/csv_table.hpp"
#include "reports/files/files.hpp"
#include "reports/files/provenance.hpp"
#include "reports/files/templates.hpp"
#include "reports/page/plot.hpp"
#include "reports/page/svg.hpp"
#include "reports/page/template_data.hpp"
#include "reports/python/convert.hpp"
#include "reports/python/variants.hpp"

namespace elastocheck::python {

namespace py = pybind11;
using json = nlohmann::ordered_json;
using reader::Cursor;
using reports::Figure;
using reports::Series;

namespace {

struct Whole {  // what a cursor refers to
    std::string file;
    reader::Value tree;
    std::vector<Number> numbers = {};
};
struct Field {
    std::shared_ptr<Whole> whole;
    Cursor at;

    Field with(const Cursor& other) const { return {whole, other}; }
};

Series series_of(const json& from) {
    static const std::map<std::string, Series::Style> styles{{"bars", Series::Style::bars},
                                                             {"dashed", Series::Style::dashed},
                                                             {"line", Series::Style::line},
                                                             {"points", Series::Style::points}};
    return {.title = from.value("title", ""),
            .style = styles.at(from.at("style")),
            .colour = from.value("colour", reports::ink),
            .rows = from.at("rows")};
}

std::string svg_of(const json& from, const std::string& id) {
    Figure figure{.title = from.at("title"),
                  .description = from.at("description"),
                  .x = from.at("x"),
                  .y = from.value("y", "")};
    figure.y_low = from.value("y_low", figure.y_low);
    figure.y_high = from.value("y_high", figure.y_high);
    figure.height = from.value("height", 1.);
    for (const json& tick : from.value("y_ticks", json::array()))
        figure.y_ticks.emplace_back(tick.at(0), tick.at(1));
    for (const json& one : from.at("series")) figure.series.push_back(series_of(one));
    return illustrate(draw(figure), id, figure.title, figure.description).inlined;
}

json table_of(const json& from) {
    reports::Table table{.caption = from.at("caption"),
                         .rows = from.at("rows"),
                         .folded = from.value("folded", false)};
    for (const json& column : from.at("columns"))
        table.columns.push_back({column.at(0), column.at(1)});
    return table_data(table);
}

// The page of a study (page/templates/html/study.mustache) from its JSON, with plots and tables as
// data.
std::string study_page(const std::string& text) {
    json data = json::parse(text);
    std::size_t drawn = 0;
    for (json& figure : data.at("figures"))
        for (json& plot : figure.at("plots"))
            plot["svg"] = svg_of(plot, "f" + std::to_string(++drawn));
    for (json& table : data.at("tables")) table = table_of(table);
    data["provenance"] = table_of(data.at("provenance"));
    data["tints"] = reports::tints();
    return reports::render("html/study", data, reports::Escape::html);
}

// The numbers of a CSV file whose columns are these names, in any order [rows × names].
py::array read_table(const std::string& file, const std::vector<std::string>& names) {
    std::vector<std::size_t> column;
    std::vector<double> values;
    const auto head = [&](const reports::Cells& cells, int line) {
        for (const std::string_view cell : cells) {
            const auto found = std::ranges::find(names, cell);
            const auto k = static_cast<std::size_t>(found - names.begin());
            if (found == names.end())
                reports::fail_at(file, line,
                                 "the study has no variable " + reader::quote(cell) +
                                     reader::did_you_mean(cell, names, "variables"));
            if (std::ranges::count(column, k) > 0)
                reports::fail_at(file, line, std::string(cell) + ": a second column");
            column.push_back(k);
        }
        if (column.size() != names.size())
            reports::fail_at(file, line,
                             fmt::format("{} columns, but the study has {} variables",
                                         column.size(), names.size()));
    };
    const auto row = [&](const reports::Cells& cells, int line) {
        const std::size_t begin = values.size();
        values.resize(begin + cells.size());
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const double x = reports::number_in(cells[c], file, line, names[column[c]]);
            if (!std::isfinite(x)) reports::fail_at(file, line, names[column[c]] + ": no value");
            values[begin + column[c]] = x;
        }
    };
    constexpr std::size_t most_rows = 10'000'000;
    reports::read_sheet(reports::read_whole(file, reports::largest_measurement), file, most_rows,
                        head, row);
    return matrix(std::move(values), names.size());
}

}  // namespace

void bind_study(py::module_& module) {
    // A value of a YAML file, with its path and line for messages: models/reader/document/cursor.hpp.
    py::class_<Field>(module, "Field")
        .def(py::init([](const std::string& text, const std::string& file) {
                 const auto whole = std::make_shared<Whole>(file, reader::parse_yaml(text, file));
                 return Field{whole, {&whole->tree, "", &whole->file, &whole->numbers}};
             }),
             py::arg("text"), py::arg("file"))
        .def("fail", [](const Field& f, const std::string& what) { f.at.fail(what); })
        .def("only", [](const Field& f, const std::vector<std::string>& k) { f.at.only_keys(k); })
        .def("need", [](const Field& f, const std::string& k) { return f.with(f.at.require(k)); })
        .def("get",
             [](const Field& f, const std::string& key) -> std::optional<Field> {
                 const auto found = f.at.optional(key);
                 return found ? std::optional(f.with(*found)) : std::nullopt;
             })
        .def("entries",
             [](const Field& f) {
                 std::vector<std::pair<std::string, Field>> all;
                 for (const auto& [name, at] : f.at.entries(Cursor::Keys::numbers))
                     all.emplace_back(name, f.with(at));
                 return all;
             })
        .def("items",
             [](const Field& f, const std::string& what) {
                 if (!f.at.is_list())
                     f.at.fail("expected a list of " + what + ", found " + f.at.found());
                 std::vector<Field> all;
                 for (const Cursor& item : f.at.items()) all.push_back(f.with(item));
                 return all;
             })
        .def_property_readonly("is_list", [](const Field& f) { return f.at.is_list(); })
        .def("text", [](const Field& f, const std::string& what) { return f.at.text(what); })
        .def("number", [](const Field& f) { return f.at.number(); })
        .def("whole",
             [](const Field& f, int low, int high) { return f.at.whole_number(low, high); })
        .def("yes_or_no", [](const Field& f) { return f.at.yes_or_no(); })
        .def("one_of",
             [](const Field& f, const std::string& what, const std::vector<std::string>& allowed) {
                 return allowed[f.at.one_of(what, allowed)];
             });
    module.def(
        "did_you_mean",
        [](const std::string& wrong, const std::vector<std::string>& right,
           const std::string& label) { return reader::did_you_mean(wrong, right, label.c_str()); },
        py::arg("wrong"), py::arg("right"), py::arg("label"));
    module.def("quote", &reader::quote, py::arg("text"));
    module.def("study_page", &study_page, py::arg("data"));
    module.def("read_table", &read_table, py::arg("file"), py::arg("names"));
    module.def(
        "check_may_write",
        [](const std::string& file, const std::string& kind, const std::string& beginning) {
            reports::check_may_write(file, {kind, beginning});
        },
        py::arg("file"), py::arg("kind"), py::arg("beginning"));
    module.def(
        "write_whole",
        [](const std::string& file, const std::string& content, const std::string& kind,
           const std::string& beginning) {
            reports::write_whole(file, content, {kind, beginning});
        },
        py::arg("file"), py::arg("content"), py::arg("kind"), py::arg("beginning"));
    const reports::Provenance made = reports::provenance();
    module.attr("build") =
        made.version + " " + made.commit.substr(0, 12) + (made.dirty ? " changed" : "");
    module.attr("compiler") = made.compiler;
}

}  // namespace elastocheck::python
