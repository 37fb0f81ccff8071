// The commands, and the judgement of a Python function, in the Python module.
#pragma once

#include <pybind11/pybind11.h>

namespace elastocheck::python {

// Adds to the module: run(words of the command line, progress) and judge(...), each of which returns
// (exit code, what is printed, text beside a printed document, errors).
void bind_analyses(pybind11::module_& module);
// Figures of many variants of a scene, and what the study of them (package/study/) takes from the
// program: its reader of YAML, its pages, its files.
void bind_variants(pybind11::module_& module);
void bind_study(pybind11::module_& module);

}  // namespace elastocheck::python
