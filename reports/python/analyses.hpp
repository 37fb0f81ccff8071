// The commands, and the judgement of a Python function, in the Python module.
#pragma once

#include <pybind11/pybind11.h>

namespace elastocheck::python {

// Adds to the module: run(words of the command line, progress) and judge(...), each of which returns
// (exit code, what is printed, text beside a printed document, errors).
void bind_analyses(pybind11::module_& module);
// Adds Variants: figures of many variants of a scene.
void bind_variants(pybind11::module_& module);
// Adds what a study of variants (package/study/) uses of the program: reader of YAML, pages, files.
void bind_study(pybind11::module_& module);

}  // namespace elastocheck::python
