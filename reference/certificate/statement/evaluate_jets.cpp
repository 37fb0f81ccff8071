// Instantiations of evaluate.hpp along a piece of a branch, for the equations (Along) and for
// their Jacobian (SlopesAlong).
#include "reference/certificate/statement/evaluate.hpp"

namespace elastocheck::reference::certificate {

template Values<Along> evaluate_without_slopes(const System&, const std::vector<Along>&,
                                               const Along&);
template Values<Jet<1>> evaluate_without_slopes(const System&, const std::vector<Jet<1>>&,
                                                const Jet<1>&);
template Values<Along> residual(const System&, const std::vector<Along>&, const Along&);
template Values<Jet<1>> residual(const System&, const std::vector<Jet<1>>&, const Jet<1>&);
template Values<SlopesAlong> evaluate_without_slopes(const System&, const std::vector<SlopesAlong>&,
                                                     const SlopesAlong&);
template Values<SlopesAlong> evaluate(const System&, const std::vector<SlopesAlong>&,
                                      const SlopesAlong&, Slopes);

}  // namespace elastocheck::reference::certificate
