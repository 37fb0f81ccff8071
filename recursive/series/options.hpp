// Settings of the series method (path.hpp).
#pragma once

namespace elastocheck::recursive::series {

struct Options {
    int order = 16;  // p
    // truncation error of any body's position [m], and of its orientation times L [m]
    double tolerance = 1e-12;
    // maximum number; as many again for each knot of a curve that the branch crosses
    int expansions = 200;
    bool arc_length = false;  // as parameter instead of the branch's own
};

}  // namespace elastocheck::recursive::series
