// The square system of this leg, as a function of the unknowns z and of the branch's parameter a:
//
//   z  per body   r - c [m], the quaternion (w, x, y, z) [-]         E  per body  Σ forces [N], Σ moments about its origin [N·m]
//      per row    its reaction R [N, N·m]                               per row   Φ [m, -]
//      per corner deformation x, force f                                per corner x(r, p; a) - x, f - ∂u/∂x
//                                                                       per body  |p|² - 1
//
// A corner is a law whose slope jumps. Set apart, it does what f does, and its slope stands in one place of ∂E/∂z: over the
// corner that is an interval, and the rest of the matrix is numbers. Within its element an interval would stand in each of the
// twelve rows and fourteen columns and range in each by itself, which no stop that is much stiffer than what it meets gets
// through. Nothing else changes: x and f are what (r, p) make them.
//
// c is a place near the model, a double, from which everything is counted: where the ground's frame sits does not matter.
// All that a driver may move stands as start + rate·a in intervals: what is stored enters as it is stored, and no product is
// rounded before the proof begins.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/equilibrium_path.hpp"
#include "reference/certificate/equations.hpp"

namespace elastocheck::reference::certificate {

struct Affine {
    Interval start, rate;
    template <class T>
    T at(const T& a) const {
        return a * constant<Base<T>>(rate) + constant<Base<T>>(start);
    }
};

// What an element is along the branch; an element uses the one that its kind has.
struct ElementPath {
    Affine free_length;             // of a spring [m]
    std::array<Affine, 6> preload;  // of a bushing [N, N·m]
    bool rotational = false;        // whether a bushing cares how its markers are turned against each other
    std::array<bool, 6> apart{};    // laws that are set apart; of a spring the first
};
// A law with a corner, set apart: its deformation and its force are unknowns of their own.
struct Apart {
    std::size_t element = 0, axis = 0;
};
struct LoadPath {
    LoadKind kind;
    Affine factor;
};

struct System {
    const Model* model = nullptr;
    const Branch* branch = nullptr;
    std::vector<Affine> values;         // per Model::constraints: its offset, length or angle
    std::vector<int> first_row;         // per Model::constraints
    std::vector<ElementPath> elements;  // per Model::elastics
    std::vector<LoadPath> loads;        // static and driven
    std::vector<Apart> apart;           // corners that are unknowns
    Eigen::Vector3d c = {0, 0, 0};      // [m]
    double length = 1;                  // size of the model, for what has to be made comparable [m]
    int bodies = 0, rows = 0;           // nb, m
    bool conservative = true;           // no follower, no formulation without energy
    int corners() const { return 2 * static_cast<int>(apart.size()); }
    int n() const { return 7 * bodies + rows + corners(); }
    int pose(BodyId body) const { return 7 * body; }
    int reaction(std::size_t constraint) const { return 7 * bodies + first_row[constraint]; }
    int balance(BodyId body) const { return 6 * body; }
    int closure(std::size_t constraint) const { return 6 * bodies + first_row[constraint]; }
    int deformation(std::size_t corner) const { return 7 * bodies + rows + 2 * static_cast<int>(corner); }
    int corner(std::size_t corner) const { return 6 * bodies + rows + 2 * static_cast<int>(corner); }
    int norm(BodyId body) const { return 6 * bodies + rows + corners() + body; }
};

// Throws std::invalid_argument where the model does not stand on the branch, or a driver moves what is not there.
enum class Corners { in_place, apart };
System make_system(const Model& model, const Branch& branch, Corners corners = Corners::in_place);
bool has_corners(const Model& model);
const ScalarLaw& law_of(const System& system, const Apart& corner);
// x and f of corners as the poses of z make them.
void set_corners(const System& system, Eigen::VectorXd& z, double a);

// E, and where asked for ∂E/∂z by rows [n × n] and ∂E/∂a.
template <class S>
struct Values {
    std::vector<S> E, J, E_a;
};
enum class Slopes { no, yes };
template <class S>
Values<S> evaluate(const System& system, const std::vector<S>& z, const S& a, Slopes slopes);
// What a branch is followed with: its equations over a piece, and their slopes.
using Along = Jet<6>;
using SlopesAlong = Jet<2>;
template <class S>
Values<S> evaluate_without_slopes(const System& system, const std::vector<S>& z, const S& a);

// Wrenches of the joints: on body i, about ModelJoint::at.
template <class S>
struct JointWrench {
    Vec<S> force, moment;
};
template <class S>
std::vector<JointWrench<S>> wrenches(const System& system, const std::vector<S>& z, const S& a);

// What a reaction of one in each row of the joint makes of its wrench: columns.
template <class S>
std::vector<JointWrench<S>> unit_wrenches(const System& system, int joint, const std::vector<S>& z,
                                          const S& a);
// The rows of a joint, as positions among all rows.
std::vector<int> rows_of_joint(const System& system, int joint);

// What the law of each element sees; springs in the first only.
std::vector<std::array<Interval, 6>> deformations(const System& system, const std::vector<Interval>& z,
                                                  const Interval& a);

}  // namespace elastocheck::reference::certificate
