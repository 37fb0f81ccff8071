#include "recursive/stepping/sweep.hpp"

namespace elastocheck::recursive {

// Part of the sweep; tests/recursive/tangent_test.cpp declares them `extern`.
template void set_inputs<long double>(const Model&, const Branch&, const Inputs<long double>&,
                                      long double, long double, Inputs<long double>&);
template void elastic_force<long double>(const Model&, const Inputs<long double>&,
                                         const State<long double>&, Vector<long double>&);
template void external_force<long double>(const Model&, const Branch&, const Inputs<long double>&,
                                          const State<long double>&, Vector<long double>&);
template void constraint_force<long double>(const Model&, const Inputs<long double>&,
                                            const State<long double>&, const Vector<long double>&,
                                            Vector<long double>&, Vector<long double>&);
template void assemble_consistent<long double>(const Model&, const Branch&,
                                               const Inputs<long double>&,
                                               const State<long double>&,
                                               const Vector<long double>&,
                                               SaddleMatrix<long double>&, Vector<long double>&);

template EquilibriumPath sweep<long double>(const Model&, const Branch&, const Options&,
                                            const Analysis&, const Visit&, Stop&);

}  // namespace elastocheck::recursive
