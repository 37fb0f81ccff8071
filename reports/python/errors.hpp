// Exceptions of the product as those of the Python package.
#pragma once

namespace elastocheck::python {

// From now on exceptions of the product arrive as the classes of elastocheck/_errors.py, with the
// message of the command line.
void translate_exceptions();

}  // namespace elastocheck::python
