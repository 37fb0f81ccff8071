// Four variants of a model in lockstep along the branches that have the same drivers.
//
// Each lane has its own variant: a copy of the model, a state, a matrix and checks, by the same
// functions as where it is solved alone (stepping_state.hpp). The series, the elimination in the
// pivot order of the design, and the substitutions are computed for all four at once. The sides of
// a branch share the expansion at its start: with a_1 r times as large, x_k is rᵏ times as large.
//
// A variant leaves its lane where a decision is close: its design position is nearer to singular
// than the design's by three digits, an idle mode or a redundancy is not exact, a pivot is refused,
// an expansion is rejected or begins at a knot, the determinant or the least stiffness shows an
// event. It is then solved alone from its start, which gives its result or the reason of its end.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "elastocheck/recursive_batch.hpp"
#include "recursive/batch/kernels.hpp"
#include "recursive/series/expand.hpp"
#include "recursive/series/pieces.hpp"

namespace elastocheck::recursive::batch {

// A variant in its lane.
struct LaneState {
    Model model;    // a copy: the state refers to it
    Branch branch;  // with the drivers of the present group
    std::unique_ptr<SteppingState> stepping;
    bool in_lockstep = false;  // holds a variant that has not left
    bool at_rest = false;      // as Analysis::at_rest
    std::vector<series::CurvePiece> curves, curves_at_start;
    // curves that are at a knot at the end of the present expansion, and the directions
    std::vector<std::pair<std::size_t, int>> crossings;
    Matrix<double> deformations, deformations_at_start;  // of the curves, their coefficients
    series::Coefficients<double> expansion;              // the present one
    State<double> expansion_point;                       // at its τ = 0
    Vector<double> x;                                    // its value, (Δq, λ)
    std::vector<EquilibriumPath> paths;                  // of the branches
    State<double> q_start;                               // at the start of the branches
    Vector<double> lambda_start;
    int sign_at_start = 0;           // sign of the determinant at the start of the branches
    double log_det_at_start = 0;     // log₂ |determinant| there
    double log_det = 0;              // log₂ |determinant| at the expansion point
    double det_ratio_at_middle = 1;  // determinant in the middle of the expansion over that
    double error = 0;                // of the present expansion at its end [m]
    double tau_end = 0;              // τ there
    bool ends_side = false;          // whether that is the end of the present side
    bool under_way = false;          // has not reached the end of the present side
    std::size_t next_point = 0;      // of the branch, to be recorded
    double last_correction = 0;      // size of the last Newton correction [m]
};

using Mask = std::array<bool, Lanes::count>;
using LaneEnds = std::array<double, Lanes::count>;  // parameter at the end of a side, per lane

struct Pack {
    const Analysis& design;
    const BatchOptions& options;
    std::array<LaneState, Lanes::count> lanes;
    Factors lu;
    std::vector<Lanes> rhs, solution;
    std::vector<int> omitted_entries;              // positions in M.values that the pattern omits
    std::vector<std::vector<std::size_t>> groups;  // branches with the same drivers

    Pack(const Model& model, const Analysis& analysis, const BatchOptions& batch_options);

    // Solves all branches of the variants, one to a lane, at most four. The lanes that are still
    // in lockstep have their paths; the variants of the others are to be solved alone.
    void solve_variants(std::span<const Model* const> variants);

  private:
    struct Group {
        series::Equations<Lanes> start, rate;
    };
    std::vector<Group> equations;                            // of the groups
    series::Coefficients<Lanes> start_expansion, expansion;  // of all lanes
    Vector<Lanes> x;
    Matrix<Lanes> definite;  // workspace of judge_start() [6nb × 6nb]
    Matrix<double> powers, values;
    State<double> point;

    Mask in_lockstep() const;
    Mask under_way() const;
    template <class Visit>
    void each(const Mask& mask, Visit&& visit) {
        for (std::size_t k = 0; k < lanes.size(); ++k)
            if (mask[k] && lanes[k].in_lockstep) visit(lanes[k], static_cast<int>(k));
    }

    void prepare(int lane, const Branch& branch);
    void solve_group(std::size_t group);
    void assemble(int lane);
    void load_matrix(int lane);
    void factorise(const Mask& mask, bool at_design);
    void back_substitute(const Mask& mask);
    void load_rhs(int lane);
    void start_at_design(series::Equations<Lanes>& e, Drive drive,
                         const std::vector<LaneEnds>& ends);
    void use_pieces(series::Equations<Lanes>& e, int lane);
    void expand(series::Equations<Lanes>& e, series::Coefficients<Lanes>& c, Drive drive,
                const LaneEnds& to);
    void find_range(const series::Coefficients<Lanes>& c, int lane, Drive drive, double to);
    void correct_ends(Drive drive, const LaneEnds& to);
    void cross_knots(series::Equations<Lanes>& e);
    void check_ends(bool with_stiffness, Matrix<Lanes>& softest);
    // Sets the equations to the variants of the lanes; returns the ends of the group's sides.
    std::vector<LaneEnds> load_group(std::size_t group, Drive drive);
    void keep_start(const series::Equations<Lanes>& e);  // what begin_side() returns to
    // Returns to the start, with the first side's expansion there scaled to this side.
    void begin_side(series::Equations<Lanes>& e, Drive drive, const std::vector<LaneEnds>& ends,
                    std::size_t side);
    void clear_paths(std::size_t branch);
    void measure_middle(Drive drive);  // the determinant in the middle of the present expansions
    void solve_branch(std::size_t group, Drive drive, bool from_design);
    std::array<LeastStiffness, Lanes::count> min_stiffness(const Mask& mask, Matrix<Lanes>& U);
    void judge_start(Matrix<Lanes>& softest);
    void sample(int lane, std::size_t branch);
};

}  // namespace elastocheck::recursive::batch
