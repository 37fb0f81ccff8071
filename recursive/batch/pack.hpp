// Four variants of a model in lockstep along the branches that have the same drivers.
//
// Each lane has a variant of its own: its copy of the model, its state, its matrix and its checks,
// by the same functions as where it is solved alone (stepping_state.hpp). In one for all four are
// the series, the elimination in the pivot order of the design, and the substitutions. The sides of
// a branch share the expansion at its start: with a_1 r times as large, x_k is rᵏ times as large.
//
// A lane leaves where anything is not plain: the design position is nearer to singular than the
// design's by three digits, an idle mode or a redundancy is not exactly that, a pivot is refused, an
// expansion is rejected or begins at a knot, the determinant or the least stiffness shows an event.
// Its variant is then solved alone from its start, which finds what there is to report.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "elastocheck/recursive.hpp"
#include "recursive/batch/kernels.hpp"
#include "recursive/series/expand.hpp"
#include "recursive/series/pieces.hpp"

namespace elastocheck::recursive::batch {

// A variant in its lane.
struct Slot {
    Model model;    // a copy: the state refers to it
    Branch branch;  // with the drivers of the present group
    std::unique_ptr<SteppingState> s;
    bool inside = false;   // holds a variant that has not left
    bool at_rest = false;  // as Analysis::at_rest
    std::vector<series::Followed> curves, curves_at_start;
    std::vector<std::pair<std::size_t, int>> over;  // curves at their knots at the end, directions
    Matrix<double> deformations, deformations_at_start;  // of the curves, their coefficients
    series::Coefficients<double> c;                      // of the present expansion
    std::vector<EquilibriumPath> paths;                  // of the branches
    State<double> from;                                  // at τ = 0 of the present expansion
    State<double> q_start;                               // at the start of the branches
    Vector<double> lambda_start, x;
    int side = 0;             // as in the scalar path: sign of the determinant at the start
    double log_at_start = 0;  // log₂ |determinant| at the start of the branches
    double log_begin = 0;     // log₂ |determinant| at the start of the expansion
    double in_middle = 1;     // determinant in the middle over that at the start
    double error = 0;         // of the present expansion at its end [m]
    double reached = 0;       // τ at the end of the present expansion
    bool last = false;        // whether that is the end of the branch
    bool going = false;       // on the present side
    std::size_t next = 0;     // point of the branch
    double before = 0;        // size of the last correction
};

using Mask = std::array<bool, Lanes::count>;
using LaneEnds = std::array<double, Lanes::count>;  // parameter at the end of a side, per lane

struct Pack {
    const Analysis& design;
    const BatchOptions& options;
    std::array<Slot, Lanes::count> slots;
    Factors lu;
    std::vector<Lanes> rhs, solution;
    std::vector<int> outside;                      // positions in M.values that the pattern omits
    std::vector<std::vector<std::size_t>> groups;  // branches with the same drivers

    Pack(const Model& model, const Analysis& analysis, const BatchOptions& batch_options);

    // Follows all branches of the variants, one to a lane, at most four. A slot that is not inside
    // afterwards has left; the others have their paths.
    void follow(std::span<const Model* const> variants);

  private:
    struct Group {
        series::Equations<Lanes> start, rate;
    };
    std::vector<Group> equations;  // of the groups
    series::Coefficients<Lanes> first, present;
    Vector<Lanes> x;
    Matrix<Lanes> definite;
    Matrix<double> powers, values;
    State<double> point;

    Mask inside() const;
    Mask going() const;
    template <class Visit>
    void each(const Mask& mask, Visit&& visit) {
        for (std::size_t k = 0; k < slots.size(); ++k)
            if (mask[k] && slots[k].inside) visit(slots[k], static_cast<int>(k));
    }

    void prepare(int at, const Branch& branch);
    void follow_group(std::size_t group);
    void assemble(int at);
    void load_matrix(int at);
    void factorise(const Mask& mask, bool at_design);
    void back_substitute(const Mask& mask);
    void load_rhs(int at);
    void start_at_design(series::Equations<Lanes>& e, Drive drive, const std::vector<LaneEnds>& to);
    void use_pieces(series::Equations<Lanes>& e, int at);
    void expand(series::Equations<Lanes>& e, series::Coefficients<Lanes>& c, Drive drive,
                const LaneEnds& to);
    void find_range(const series::Coefficients<Lanes>& c, int at, Drive drive, double to);
    void correct_ends(Drive drive, const LaneEnds& to);
    void cross_knots(series::Equations<Lanes>& e);
    void check_ends(bool stable, Matrix<Lanes>& softest);
    // Loads the equations of a group of branches with the same drivers; the ends of its sides.
    std::vector<LaneEnds> load_group(std::size_t group, Drive drive);
    void keep_start(const series::Equations<Lanes>& e);
    // Returns to the start, with the first side's expansion there scaled to this side.
    void begin_side(series::Equations<Lanes>& e, Drive drive, const std::vector<LaneEnds>& to,
                    std::size_t side);
    void clear_paths(std::size_t branch);
    void measure_middle(Drive drive);  // the determinant in the middle of the present expansions
    void solve_branch(std::size_t group, Drive drive, bool from_design);
    std::array<LeastStiffness, Lanes::count> min_stiffness(const Mask& mask, Matrix<Lanes>& U);
    void judge_start(Matrix<Lanes>& softest);
    void sample(int at, std::size_t branch);
};

}  // namespace elastocheck::recursive::batch
