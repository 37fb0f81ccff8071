// Design position: rank deficiency, redundant constraints, idle modes, condition number.
//
// Rank depends on geometry, not on stiffness. It is judged on rows of unit length, in the
// coordinates (Δr, L Δπ) with L a characteristic length, so that neither the unit of length nor a
// rate of 1e12 N/m hides an equation. An idle mode is a Δq that strains no constraint and no
// elastic element: a null vector of the stacked rows
//
//   ⎡ Φ_q           ⎤
//   ⎣ √K_e B_e, ... ⎦     one block per elastic element, Bᵀ K_e B its stiffness (elastic.hpp),
//                         in the element's own axes
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "elastocheck/equilibrium_path.hpp"
#include "elastocheck/model.hpp"
#include "models/vanishing_length.hpp"

namespace elastocheck::recursive {

struct IdleMode {
    BodyId body = ground;            // the body that moves most
    Eigen::SparseVector<double> dq;  // [6nb], unit in (Δr, L Δπ)
    std::string
        description;  // "strut: rotation about the line through 'strut_tube' and 'K2_strut_mount'"
    bool spins = false;  // one body alone, about an axis that carries all its attachments
    std::vector<std::string> outputs;  // names of the probes and wheels that the mode moves
};

struct Redundancy {
    int joint = 0;             // position in Model::joints
    int rows = 0;              // number of its rows that depend on the rows of earlier joints
    bool contradicts = false;  // whether Φ ≠ 0 there: the joints cannot all be closed
    double remainder = 0;      // largest of such a row of unit length; 0 if it depends exactly
    // whether `remainder` exceeds rounding: the row may be dependent or independent
    bool undecided = false;
    // Joints that share the dependency, each with its squared entries in the left null
    // vectors y of the row-scaled Φ_q: largest first, sum 1. Removing any of these joints
    // removes the dependency.
    std::vector<std::pair<int, double>> shares;
};

struct Diagnosis {
    int coordinates = 0;          // 6 nb
    int rows = 0;                 // m
    int rank = 0;                 // of Φ_q
    double length = 1;            // L, characteristic lever of the model [m]
    double constraint_error = 0;  // largest |Φ| at the design position [m] or [-]
    // largest unbalanced force [N] (or moment/L) at load factor 0 at the design position
    double imbalance = 0;
    std::vector<Redundancy> redundant;
    // Per joint: whether its reaction is determined by the loads. It is not where one of its rows
    // has a non-zero entry in a dependency yᵀ Φ_q = 0. Then only the sum over the joints of a set
    // is determined.
    std::vector<bool> determined;
    std::vector<std::vector<int>> redundant_sets;  // positions in Model::joints, ascending
    std::vector<IdleMode> idle;
    // Null space of eq. (24) [(6nb + m) × d]: idle modes (Δq, 0), then redundant combinations (0,
    // λ). Each involves as few bodies or joints as possible; the columns are not orthogonalised.
    Eigen::SparseMatrix<double> null_space;

    int degrees_of_freedom() const { return coordinates - rank; }
};

Diagnosis diagnose(const Model& model);

// L: root mean square lever of all attachments, invariant under motions of the ground frame [m].
double characteristic_length(const Model& model);

// The motion dq [6nb] of the bodies at these poses, named by the body that it moves most.
IdleMode motion_of(const Model& model, const std::vector<Pose>& poses, const Eigen::VectorXd& dq,
                   double length);

// Bodies that redundant joints leave no motion: "body 'arm' cannot move: the joints 'arm_front' and
// 'arm_rear' lock it". A held rack does not move either, and its joints are not redundant.
std::vector<std::string> locked_bodies(const Model& model, const Diagnosis& diagnosis);

// "'a'", "'a' and 'b'", "'a', 'b' and 'c'"
std::string listed(const std::vector<std::string>& names);

// Names the joint for which the rank decision is within rounding, as text; empty where
// there is none.
std::string undecided(const Model& model, const Diagnosis& diagnosis);

// Idle modes as text, one a line: "strut: rotation about ..., moves no output"; modes of the same
// kind together: "both 'a' and 'b' rotate about their own axis, which moves no output".
std::vector<std::string> describe_idle_modes(const Diagnosis& diagnosis);
// The same in one line.
std::string idle_modes(const Diagnosis& diagnosis);

// Why a path ended, after its place: ": redundant joints are inconsistent"; empty for an outcome
// that the diagnosis does not explain.
std::string end_by_diagnosis(Outcome outcome, const Diagnosis& diagnosis);
// "joint 'link' would have no length from 35 mm on"
std::string no_length(const Model& model, const Branch& branch, const Vanishing& vanishing);

// κ₂ of eq. (24) at the design position, without idle and redundant directions.
struct Conditioning {
    // unscaled: depends on the unit of length; reported for comparison with other programs
    double raw = 0;
    double equilibrated = 0;  // rows and columns scaled to unit size
};
Conditioning conditioning(const Model& model, const Diagnosis& diagnosis);

}  // namespace elastocheck::recursive
