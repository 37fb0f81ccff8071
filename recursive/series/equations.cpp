#include "recursive/series/terms.hpp"

namespace elastocheck::recursive::series {

template struct Equations<double>;
template Equations<double> equations<double>(const Model&, const Branch&, int, Drive);
template void take<double>(Equations<double>&, const Model&, const Branch&, int);
template void settle_on_constants<double>(Equations<double>&);
template CubicSeries<double>& cubic_of<double>(Equations<double>&, std::size_t, int);
template const double& deformation<double>(const Equations<double>&, std::size_t, int, int);
template void begin<double>(Equations<double>&, const State<double>&, const Vector<double>&, double,
                            int);
template void evaluate<double>(Equations<double>&, Order);
template void assign<double>(Equations<double>&, int, const Vector<double>&, const double&);

}  // namespace elastocheck::recursive::series
