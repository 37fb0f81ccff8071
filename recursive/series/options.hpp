// What can be chosen about the branch as a power series (path.hpp).
#pragma once

namespace elastocheck::recursive::series {

struct Options {
    int order = 16;            // p
    double tolerance = 1e-12;  // truncation error of any body's position [m] and orientation times L [m]
    int expansions = 200;      // at most
    bool arc_length = false;   // as parameter instead of the branch's own
};

}  // namespace elastocheck::recursive::series
