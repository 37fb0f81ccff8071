// The extension module elastocheck._core, used by elastocheck/__init__.py.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "compare/jobs/allocation.hpp"
#include "reports/command/templates.hpp"
#include "reports/files/provenance.hpp"
#include "reports/python/analyses.hpp"
#include "reports/python/errors.hpp"
#include "reports/python/scene.hpp"

PYBIND11_MODULE(_core, module) {
    using namespace elastocheck;
    compare::align_suitesparse();  // before any thread of the process solves
    python::translate_exceptions();
    python::bind_scene(module);
    python::bind_analyses(module);
    python::bind_variants(module);
    python::bind_study(module);
    module.attr("version") = reports::provenance().version;
    module.def("templates", &reports::templates);
    module.def(
        "template_text",
        [](const std::string& name) { return std::string(reports::template_named(name)); },
        pybind11::arg("name"));
}
