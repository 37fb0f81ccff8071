// Exceptions of this program as those of the Python package.
#pragma once

namespace elastocheck::python {

// Registers the translation of exceptions of this program to the classes of elastocheck/_errors.py, with
// the messages of the command line.
void translate_exceptions();

}  // namespace elastocheck::python
