// The analyses of the commands as functions of the Python module. Each returns what the command
// reports: its text, its document, and its exit code.
#pragma once

#include <pybind11/pybind11.h>

namespace elastocheck::python {

// Adds Report and the functions compare, judge, certify, sensitivity, fit to the module.
void bind_analyses(pybind11::module_& module);
// Figures of many variants of a scene, and what the study of them (package/study/) takes from the
// program: its reader of YAML, its pages, its files.
void bind_variants(pybind11::module_& module);
void bind_study(pybind11::module_& module);

}  // namespace elastocheck::python
