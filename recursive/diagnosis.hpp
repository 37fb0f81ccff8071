// What the design position tells before anything is solved:
// rank, redundant constraints, idle modes, conditioning.
//
// Rank is a question of geometry, not of stiffness: it is judged on rows of unit length,
// in coordinates (Δr, L Δπ) with L a characteristic length, so neither the unit
// of length nor a rate of 1e12 N/m can hide an equation. An idle mode is a Δq that
// no constraint and no elastic element notices: a null vector of the stacked rows
//
//   ⎡ Φ_q           ⎤
//   ⎣ √K_e B_e, ... ⎦     one block per elastic element, Bᵀ K_e B its stiffness (elastic.hpp), taken in the
//                         element's own axes
#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "models/model.hpp"

namespace elastocheck::recursive {

struct IdleMode {
    BodyId body = ground;            // the body that moves most
    Eigen::SparseVector<double> dq;  // [6nb], unit in (Δr, L Δπ)
    std::string description;  // "strut: rotation about the line through 'strut_tube' and 'K2_strut_mount'"
    bool spins = false;       // one body alone, about an axis that all lies on by which it is attached
    std::vector<std::string> outputs;  // the probes and wheels that it moves
};

struct Redundancy {
    int joint = 0;             // position in Model::joints
    int rows = 0;              // how many of its rows repeat what the joints before it already hold
    bool contradicts = false;  // whether Φ ≠ 0 there: the joints cannot all be met
    double left = 0;  // the most that is left of such a row of unit length: 0 of one that repeats exactly
    bool undecided = false;  // whether that is more than rounding: it may repeat, or hold something more
    // The joints that the repetition is among, and what each has of the left null vectors y of the row-scaled Φ_q, squared:
    // largest first, together 1. Taking out any of them takes out the repetition.
    std::vector<std::pair<int, double>> shares;
};

struct Diagnosis {
    int coordinates = 0;          // 6 nb
    int rows = 0;                 // m
    int rank = 0;                 // of Φ_q
    double length = 1;            // L, characteristic lever of the model [m]
    double constraint_error = 0;  // largest |Φ| at the design position [m] or [-]
    double imbalance =
        0;  // largest force [N] (or moment/L) that is left at load factor 0 at the design position
    std::vector<Redundancy> redundant;
    // Per joint: whether its reaction follows from the loads. It does not where one of its rows has a part in
    // a dependency yᵀ Φ_q = 0; then only the total over the joints that share one does, which are a set each.
    std::vector<bool> determined;
    std::vector<std::vector<int>> redundant_sets;  // positions in Model::joints, ascending
    std::vector<IdleMode> idle;
    // Of eq. (24): idle modes (Δq, 0), then redundant combinations (0, λ) [(6nb + m) × d], each of as few bodies
    // or joints as can be, none of them perpendicular to another on purpose.
    Eigen::SparseMatrix<double> null_space;

    int degrees_of_freedom() const { return coordinates - rank; }
};

Diagnosis diagnose(const Model& model);

// Which joint cannot be told from one that repeats others, in words; empty where all can.
std::string undecided(const Model& model, const Diagnosis& diagnosis);

// As a person would say them, one a line: "strut: rotation about ..., moves no output", those that spin together: "both 'a'
// and 'b' spin about themselves, moves no output".
std::vector<std::string> told_idle_modes(const Diagnosis& diagnosis);
// All of them in one line.
std::string idle_modes(const Diagnosis& diagnosis);

// κ₂ of eq. (24) at the design position, idle and redundant directions left out.
struct Conditioning {
    double raw = 0;  // as it stands: depends on the unit of length; shown because it is what others see
    double equilibrated = 0;  // rows and columns scaled to unit size
};
Conditioning conditioning(const Model& model, const Diagnosis& diagnosis);

}  // namespace elastocheck::recursive
