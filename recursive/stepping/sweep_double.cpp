// The templates of the formula, the linear algebra and the stepping loop in double precision, which
// every other source file declares `extern`.
#include "recursive/stepping/stability.hpp"
#include "recursive/stepping/stiffness.hpp"
#include "recursive/stepping/sweep.hpp"

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
template void assemble_consistent<double>(const Model&, const Branch&, const Inputs<double>&,
                                          const State<double>&, const Vector<double>&,
                                          SaddleMatrix<double>&, Vector<double>&);
template void constraint_force<double>(const Model&, const Inputs<double>&, const State<double>&,
                                       const Vector<double>&, Vector<double>&, Vector<double>&);
template struct SteppingState<double>;
template void go_to<double>(SteppingState<double>&, Parameters<double>);
template Outcome check_factors<double>(SteppingState<double>&, const State<double>&, double);
template Outcome check_idle_load<double>(SteppingState<double>&, const State<double>&, double);
template Outcome factorise_at<double>(SteppingState<double>&, const State<double>&,
                                      const Vector<double>&);
template void residual_at<double>(SteppingState<double>&, const State<double>&,
                                  const Vector<double>&);
template bool is_inconsistent<double>(const SteppingState<double>&, const State<double>&);
template void drive_at<double>(SteppingState<double>&, Drive, double, const State<double>&,
                               const Vector<double>&);
template void record<double>(const Model&, const Inputs<double>&, const State<double>&,
                             const State<double>&, const Vector<double>&, double, Equilibrium&);
template void differentiate<double>(SteppingState<double>&, const ContinuationSettings<double>&,
                                    Node<double>&);
template Outcome correct<double>(SteppingState<double>&, const ContinuationSettings<double>&,
                                 State<double>&, Vector<double>&, double, double&);
template Trial<double> try_step<double>(SteppingState<double>&, const ContinuationSettings<double>&,
                                        const Node<double>&, const Vector<double>&,
                                        const Vector<double>&, Node<double>&);
template bool is_inconsistent_at<double>(SteppingState<double>&, const Node<double>&,
                                         State<double>&, Vector<double>&);
template Outcome settle<double>(SteppingState<double>&);
template Outcome settled<double>(const SteppingState<double>&, Outcome, double);
template LeastStiffness least_stiffness<double>(SteppingState<double>&, Matrix<double>&);
template double negative_idle_stiffness<double>(SteppingState<double>&, const State<double>&,
                                                const Vector<double>&);

template EquilibriumPath sweep<double>(const Model&, const Branch&, const Options&, const Analysis&,
                                       const Visit&, Stop&);

}  // namespace elastocheck::recursive
