#include "recursive/stepping/sweep.hpp"

namespace elastocheck::recursive {

template EquilibriumPath sweep<long double>(const Model&, const Branch&, const Options&,
                                            const Analysis&, const Visit&, Stop&);

}  // namespace elastocheck::recursive
