// The templates of the formula and of the linear algebra in double precision, which every other source
// file declares `extern`.
#include "recursive/formula/reactions.hpp"
#include "recursive/linear_algebra/assembly.hpp"

namespace elastocheck::recursive {

template void add_stiffness<double>(const Model&, const Inputs<double>&, const State<double>&,
                                    SaddleMatrix<double>&);
template void add_elastic_tangent<double>(const Model&, const Inputs<double>&, const State<double>&,
                                          SaddleMatrix<double>&);
template void add_curvature<double>(const Model&, const Inputs<double>&, const State<double>&,
                                    const Vector<double>&, SaddleMatrix<double>&);
template void add_load_stiffness<double>(const Model&, const Branch&, const Inputs<double>&,
                                         const State<double>&, SaddleMatrix<double>&);
template void set_inputs<double>(const Model&, const Branch&, const Inputs<double>&, double, double,
                                 Inputs<double>&);
template Spatial<double> deformation<double>(const Bushing&, const State<double>&);
template Matrix3<double> axes<double>(const Bushing&, const State<double>&);
template ElementStiffness<double> element_stiffness<double>(const ElasticKind&, const Rest<double>&,
                                                            const State<double>&);
template ElementForce<double> element_force<double>(const ElasticKind&, const Rest<double>&,
                                                    const State<double>&);
template void elastic_force<double>(const Model&, const Inputs<double>&, const State<double>&,
                                    Vector<double>&);
template void external_force<double>(const Model&, const Branch&, const Inputs<double>&,
                                     const State<double>&, Vector<double>&);
template double joint_wrenches<double>(const Model&, const Inputs<double>&, const State<double>&,
                                       const Vector<double>&, std::vector<Wrench>&);
template void analyse<double>(SparseLU<double>&, const Pattern&, const double*);
template double factorise<double>(SparseLU<double>&, const double*);
template void solve<double>(SparseLU<double>&, const double*, double*);
template void solve_unit<double>(SparseLU<double>&, int, const int*, int, double*);
template double factorise<double>(SaddlePoint<double>&);
template void back_substitute<double>(SaddlePoint<double>&, const Vector<double>&,
                                      const Vector<double>&, Vector<double>&);
template void set_border<double>(SaddlePoint<double>&);
template void assemble<double>(const Model&, const Inputs<double>&, const State<double>&,
                               SaddleMatrix<double>&, Vector<double>&);
template void assemble_constraints<double>(const Model&, const Inputs<double>&,
                                           const State<double>&, SaddleMatrix<double>&,
                                           Vector<double>&);
template void constraint_force<double>(const Model&, const Inputs<double>&, const State<double>&,
                                       const Vector<double>&, Vector<double>&, Vector<double>&);

}  // namespace elastocheck::recursive
