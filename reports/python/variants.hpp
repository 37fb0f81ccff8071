// Figures of many variants of a scene for Python, and what the study of them (package/study/) takes
// from the program: its reader of YAML, its pages, its files.
#pragma once

#include <pybind11/pybind11.h>

namespace elastocheck::python {

void bind_variants(pybind11::module_& module);
void bind_study(pybind11::module_& module);

}  // namespace elastocheck::python
