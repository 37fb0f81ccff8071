// What the study in Python takes from the program: its reader of YAML, its results, its files.
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

// Columns: name, heading, digits.
Table table_of(const std::string& id, const std::string& caption, const Columns& columns,
               std::vector<std::vector<Cell>> rows) {
    using enum compare::Digits;
    static const std::map<std::string, compare::Digits> digits{
        {"hidden", hidden}, {"words", words}, {"whole", whole},     {"given", given},
        {"size", size},     {"three", three}, {"percent", percent},
    };
    Table table{.rows = std::move(rows), .id = id, .caption = caption};
    for (const auto& [name, heading, shown] : columns)
        table.columns.push_back({.name = name,
                                 .words = shown == "words",
                                 .digits = digits.at(shown),
                                 .heading = heading});
    return table;
}

Chart chart_of(const std::string& kind, const std::string& title, const std::string& table,
               const std::string& x, std::vector<std::string> y) {
    const auto known = std::ranges::find(compare::chart_kinds, kind);
    return {.title = title,
            .table = table,
            .x = x,
            .y = std::move(y),
            .kind = static_cast<Chart::Kind>(known - compare::chart_kinds)};
}

compare::Verdict verdict_of(bool fine, const std::string& sentence,
                            std::vector<std::string> reasons, int compared) {
    return {.grade = fine ? compare::Grade::pass : compare::Grade::not_judged,
            .sentence = sentence,
            .reasons = std::move(reasons),
            .compared = compared,
            .requested = compared > 0};
}

compare::Result findings_of(compare::Verdict verdict, std::vector<Table> tables,
                            std::vector<Chart> charts, std::vector<std::string> notes) {
    int number = 0;
    for (Chart& chart : charts) chart.id = fmt::format("f{}", ++number);
    return {.analysis = "study",
            .verdict = std::move(verdict),
            .tables = std::move(tables),
            .charts = std::move(charts),
            .notes = std::move(notes)};
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
        .def("one_of",
             [](const Field& f, const std::string& what, const std::vector<std::string>& allowed) {
                 return allowed[f.at.one_of(what, allowed)];
             });
    module.def(
        "did_you_mean",
        [](const std::string& wrong, const std::vector<std::string>& right,
           const std::string& label) { return reader::did_you_mean(wrong, right, label.c_str()); },
        py::arg("wrong"), py::arg("right"), py::arg("label"));
    py::class_<Table>(module, "Table")
        .def(py::init(&table_of), py::arg("id"), py::arg("caption"), py::arg("columns"),
             py::arg("rows"));
    py::class_<Chart>(module, "Chart")
        .def(py::init(&chart_of), py::arg("kind"), py::arg("title"), py::arg("table"), py::arg("x"),
             py::arg("y"))
        .def_readwrite("only", &Chart::only)
        .def_readwrite("axis", &Chart::axis)
        .def_readwrite("marks", &Chart::marks);
    py::class_<compare::Verdict>(module, "Verdict")
        .def(py::init(&verdict_of), py::arg("fine"), py::arg("sentence"), py::arg("reasons"),
             py::arg("compared"));
    py::class_<compare::Result>(module, "Findings")
        .def(py::init(&findings_of), py::arg("verdict"), py::arg("tables"), py::arg("charts"),
             py::arg("notes"))
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
