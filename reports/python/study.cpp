// Functions of this program for the study in Python: its reader of YAML, its results, its files.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <nlohmann/json.hpp>
#include <string>

#include "models/reader/document/cursor.hpp"
#include "models/reader/document/suggestions.hpp"
#include "reports/files/files.hpp"
#include "reports/files/provenance.hpp"
#include "reports/page/result_page.hpp"
#include "reports/python/analyses.hpp"
#include "reports/render/render.hpp"

namespace elastocheck::python {

namespace py = pybind11;
using json = nlohmann::ordered_json;
using compare::Cell;
using compare::Chart;
using compare::Table;
using reader::Cursor;
using Columns = std::vector<std::tuple<std::string, std::string, std::string>>;

namespace {

struct ParsedFile {  // has to outlive its cursors
    std::string file;
    reader::Value tree;
    std::vector<Number> numbers = {};
};
struct Field {
    std::shared_ptr<ParsedFile> parsed;
    Cursor at;

    Field with(const Cursor& other) const { return {parsed, other}; }
};

// Name, caption, columns (name, heading, digits), rows.
using TableWords = std::tuple<std::string, std::string, Columns, std::vector<std::vector<Cell>>>;
// Kind, title, table, abscissa, ordinates, rows, heading of the axis, limits.
using ChartWords =
    std::tuple<std::string, std::string, std::string, std::string, std::vector<std::string>,
               std::string, std::string, std::vector<double>>;

Table table_of(const TableWords& words_of_table) {
    using enum compare::Digits;
    static const std::map<std::string, compare::Digits> digits{
        {"hidden", hidden}, {"words", words}, {"whole", whole},     {"given", given},
        {"size", size},     {"three", three}, {"percent", percent},
    };
    const auto& [id, caption, columns, rows] = words_of_table;
    Table table{.rows = rows, .id = id, .caption = caption};
    for (const auto& [name, heading, shown] : columns)
        table.columns.push_back({.name = name,
                                 .words = shown == "words",
                                 .digits = digits.at(shown),
                                 .heading = heading});
    return table;
}

Chart chart_of(const ChartWords& words, std::size_t number) {
    const auto& [kind, title, table, x, y, only, axis, marks] = words;
    const auto known = std::ranges::find(compare::chart_kinds, kind);
    return {.id = fmt::format("f{}", number),
            .title = title,
            .table = table,
            .x = x,
            .y = y,
            .kind = static_cast<Chart::Kind>(known - compare::chart_kinds),
            .only = only,
            .axis = axis,
            .marks = marks};
}

compare::Result findings_of(const std::string& sentence, const std::vector<std::string>& reasons,
                            int compared, const std::vector<TableWords>& tables,
                            const std::vector<ChartWords>& charts, const std::string& note) {
    compare::Result result{
        .analysis = "study",
        .verdict = {.grade = reasons.empty() ? compare::Grade::pass : compare::Grade::not_judged,
                    .sentence = sentence,
                    .reasons = reasons,
                    .compared = compared,
                    .requested = compared > 0},
        .notes = {note}};
    for (const TableWords& words : tables) result.tables.push_back(table_of(words));
    for (const ChartWords& words : charts)
        result.charts.push_back(chart_of(words, result.charts.size() + 1));
    return result;
}

}  // namespace

void bind_study(py::module_& module) {
    // A value of a YAML file, with its path and line for messages: models/reader/document/cursor.hpp.
    py::class_<Field>(module, "Field")
        .def(py::init([](const std::string& text, const std::string& file) {
                 const auto parsed =
                     std::make_shared<ParsedFile>(file, reader::parse_yaml(text, file));
                 return Field{parsed, {&parsed->tree, "", &parsed->file, &parsed->numbers}};
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
        .def("one_of",
             [](const Field& f, const std::string& what, const std::vector<std::string>& allowed) {
                 return allowed[f.at.one_of(what, allowed)];
             });
    module.def(
        "did_you_mean",
        [](const std::string& wrong, const std::vector<std::string>& right,
           const std::string& label) { return reader::did_you_mean(wrong, right, label.c_str()); },
        py::arg("wrong"), py::arg("right"), py::arg("label"));
    py::class_<compare::Result>(module, "Findings")
        .def(py::init(&findings_of), py::arg("sentence"), py::arg("reasons"), py::arg("compared"),
             py::arg("tables"), py::arg("charts"), py::arg("note"))
        .def_property_readonly("text",
                               [](const compare::Result& found) { return reports::text(found); })
        .def_property_readonly("document",
                               [](const compare::Result& r) { return reports::json_of(r).dump(); })
        .def("page", &reports::result_page, py::arg("title"), py::arg("words"),
             py::arg("reproduce"), py::arg("made"));
    module.def(
        "check_may_write",
        [](const std::string& file, const std::string& kind, const std::string& beginning) {
            reports::check_may_write(file, {kind, beginning});
        },
        py::arg("file"), py::arg("kind"), py::arg("beginning"));
    const reports::Provenance made = reports::provenance();
    module.attr("build") =
        made.version + " " + made.commit.substr(0, 12) + (made.dirty ? " changed" : "");
    module.attr("compiler") = made.compiler;
}

}  // namespace elastocheck::python
