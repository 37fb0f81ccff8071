// What the study in Python takes from the program: its reader of YAML, its pages, its files.
#include <pybind11/stl.h>

#include <nlohmann/json.hpp>
#include <string>

#include "models/reader/document/cursor.hpp"
#include "models/reader/document/suggestions.hpp"
#include "reports/files/files.hpp"
#include "reports/files/provenance.hpp"
#include "reports/files/templates.hpp"
#include "reports/page/plot.hpp"
#include "reports/page/svg.hpp"
#include "reports/python/analyses.hpp"

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

std::string svg_of(const json& from, const std::string& id) {
    using enum Series::Style;
    static const std::map<std::string, Series::Style> styles{
        {"bars", bars}, {"dashed", dashed}, {"line", line}, {"points", points}};
    Figure figure{.title = from.at("title"),
                  .description = from.at("description"),
                  .x = from.at("x"),
                  .y = from.value("y", "")};
    figure.y_low = from.value("y_low", figure.y_low);
    figure.y_high = from.value("y_high", figure.y_high);
    figure.height = from.value("height", 1.);
    for (const json& tick : from.value("y_ticks", json::array()))
        figure.y_ticks.emplace_back(tick.at(0), tick.at(1));
    for (const json& one : from.at("series"))
        figure.series.push_back({.title = one.value("title", ""),
                                 .style = styles.at(one.at("style")),
                                 .colour = one.value("colour", reports::ink),
                                 .rows = one.at("rows")});
    return illustrate(draw(figure), id, figure.title, figure.description).inlined;
}

// The page of a study (page/templates/html/study.mustache) from its JSON, with plots as data.
std::string study_page(const std::string& text) {
    json data = json::parse(text);
    std::size_t drawn = 0;
    for (json& figure : data.at("figures"))
        for (json& plot : figure.at("plots"))
            plot["svg"] = svg_of(plot, "f" + std::to_string(++drawn));
    data["tints"] = reports::tints();
    return reports::render("html/study", data, reports::Escape::html);
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
    module.def("study_page", &study_page, py::arg("data"));
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
