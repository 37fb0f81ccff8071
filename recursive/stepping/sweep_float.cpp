#include "recursive/stepping/sweep.hpp"

namespace elastocheck::recursive {

template EquilibriumPath sweep<float>(const Model&, const Branch&, const Options&, const Analysis&,
                                      const Visit&, Stop&);

}  // namespace elastocheck::recursive
