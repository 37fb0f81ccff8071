// Scenes of any size, each of a kind whose answer is known from elsewhere: what grows in benchmarks and tests.
//
// However many bodies, a family has one length, one load and about one displacement: its stiffness is shared out so that
// the sum of compliances stays. One branch of five steps, one probe where the load's work is done.
//
//   chain         links along x, one after the other on hinges, the load across its end: in the plane xz a recursion from
//                 the end back gives every angle (tests/support/planar_chain.hpp)
//   tree          each link carries two half as stiff, side by side in y, every leaf its share of the load. Full (of
//                 2^m - 1 bodies), each link is a mirror image of itself in y: all of a level move as one link of a
//                 chain of m
//   grid          R chains side by side in y, R the largest divisor of the number up to its root, tied by bushings from
//                 link to link; the load shared by the ends: every row moves as a chain of its own, no tie is deformed
//   leaf_spring   up to five graduated leaves, clamped at the seat, each pressing on the tips of the next one; an eye, a
//                 shackle, the load at the seat. For small loads the pressures follow from beams (tests)
//   ladder_frame  two rails, up to five cross-members, three corners held, the load at the fourth. For small loads a
//                 grillage
//   axle          a housing on links, by turns to the front and to the rear, side by side in y. With as many on either
//                 side it is lifted straight, and all links move as one does whose end has its share of the load
//
// A hinge is a bushing, as stiff in all directions, or a revolute joint about y with a torsion spring; leaf springs and
// ladder frames are beams and have none.
#pragma once

#include <array>
#include <string>
#include <string_view>

namespace elastocheck::families {

enum class Kind { chain, tree, grid, leaf_spring, ladder_frame, axle };
inline constexpr std::array kinds{Kind::chain,       Kind::tree,         Kind::grid,
                                  Kind::leaf_spring, Kind::ladder_frame, Kind::axle};
std::string_view name(Kind kind);

enum class Hinge { bushing, revolute };
std::string_view name(Hinge hinge);
bool has_hinges(Kind kind);  // else they are beams

struct Family {
    Kind kind = Kind::chain;
    int bodies = 100;  // as solved
    Hinge hinge = Hinge::bushing;
};
inline constexpr int max_bodies = 2000;  // what the format of scenes has room for
int min_bodies(Kind kind);

// The text of the scene. Throws std::invalid_argument for what is no such family, std::out_of_range for a number of
// bodies that it cannot have.
std::string scene(const Family& family);

// ---- Chain, tree and grid: a rod of this length along x, the load across its end.
inline constexpr double length = 1, load = 1000;  // [m] [N]
inline constexpr double EI = 1000, EA = 1e5;  // [N·m²] [N]: n hinges have n EI/L and n EA/L each
inline constexpr double width = 1;            // [m] of what lies side by side in y

int rows(int bodies);    // of the grid
int levels(int bodies);  // of the tree

// ---- The axle: all links together have K_T and K_R at either end.
inline constexpr double link = 0.5, K_T = 1e5, K_R = 500;  // [m] [N/m] [N·m/rad]

// ---- Steel; round tubes for the frame, flat leaves.
inline constexpr double E = 206e9, G = 79e9;  // [N/m²]

struct Leaves {
    int count = 1;
    double half = 0.6, width = 0.060, thick = 0.008, pad = 2e7;  // [m] [m] [m] [N/m]
    double load = 0;                                             // [N]
    double half_of(int leaf) const { return half * (count - leaf) / count; }
};
Leaves leaves(int bodies);

struct Tube {
    double diameter = 0, wall = 0;  // [m]
};
struct Frame {
    int cross_members = 2;
    double length = 3, width = 0.8, load = 5000;  // [m] [m] [N]
    Tube rail{0.08, 0.004}, cross{0.06, 0.003};
};
Frame frame(int bodies);

}  // namespace elastocheck::families
