// Conversion between values of this program and of Python.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <vector>

#include "elastocheck/compare.hpp"
#include "reports/command/options/load_scene.hpp"

namespace elastocheck::python {

// {"springs.coil.rate": 28}: numbers with the fewest digits that read back as the same, texts as
// they are. Throws Python's TypeError for other values.
reports::Settings settings_of(const pybind11::dict& values);

// The numbers as a matrix with this many columns; nothing is copied.
pybind11::array matrix(std::vector<double> values, std::size_t columns);
// The same [points × bodies × 7].
pybind11::array poses(std::vector<double> values, std::size_t bodies);

// A progress that calls a Python function (what, done), from any thread; empty for None. An exception of
// the function ends the computation and arrives at the caller. The function has to outlive the progress;
// it is not copied, since that would need the lock of the interpreter.
compare::Progress progress_to(const pybind11::object& function);

}  // namespace elastocheck::python
