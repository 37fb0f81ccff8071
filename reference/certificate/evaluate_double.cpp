#include "reference/certificate/evaluate.hpp"

namespace elastocheck::reference::certificate {

template Values<double> evaluate_without_slopes(const System&, const std::vector<double>&, const double&);
template Values<double> evaluate(const System&, const std::vector<double>&, const double&, Slopes);
template std::vector<JointWrench<double>> wrenches(const System&, const std::vector<double>&, const double&);
template std::vector<JointWrench<double>> unit_wrenches(const System&, int, const std::vector<double>&,
                                                        const double&);

}  // namespace elastocheck::reference::certificate
