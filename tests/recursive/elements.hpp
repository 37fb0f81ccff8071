// Laws and formulations for tests: random curves, stops, all formulations of a bushing.
#pragma once

#include "tests/recursive/random.hpp"

namespace elastocheck::recursive {

using support::stop;

// Continuous curve with five knots within ± reach, a kink at each of them, and forces of
// the size `force`.
inline Curve random_curve(Random& random, double reach, double force) {
    Curve f;
    for (int k = 0; k < 5; ++k) f.knots.push_back(reach * (-1 + 0.4 * k + random(0.05, 0.35)));
    double value = random(-force, force);
    f.pieces.push_back({value, random(-force, force) / reach, 0, 0});
    for (std::size_t k = 0; k < 5; ++k) {
        std::array<double, 4> c{value, random(-force, force) / reach, 0, 0};
        if (k < 4) {
            c[2] = random(-force, force) / reach / reach;
            c[3] = random(-force, force) / reach / reach / reach;
            const double h = f.knots[k + 1] - f.knots[k];
            value = c[0] + h * (c[1] + h * (c[2] + h * c[3]));
        }
        f.pieces.push_back(c);
    }
    return f;
}
// Curves and rates alternate.
inline PerAxis random_axes(Random& random) {
    PerAxis law;
    for (std::size_t k = 0; k < 6; ++k) {
        if (k % 3 == 1)
            law.axis[k] = LinearRate{random(1e2, 1e3)};
        else
            law.axis[k] = random_curve(random, k < 3 ? 2 : 1, 1e3);
    }
    return law;
}

inline std::vector<Formulation> every_formulation() {
    std::vector<Formulation> all;
    for (const auto frame : {Formulation::Frame::on_i, Formulation::Frame::middle})
        for (const auto angles : {Formulation::Angles::rotation_vector, Formulation::Angles::cardan,
                                  Formulation::Angles::projected})
            for (const bool conjugate : {true, false})
                for (const bool offset_moment : {true, false})
                    if (conjugate || frame == Formulation::Frame::on_i)
                        all.push_back({frame, angles, conjugate, offset_moment});
    return all;
}
inline std::string name_of(const Formulation& f) {
    const char* const angles[] = {"rotation vector", "cardan", "projected"};
    return std::string(f.frame == Formulation::Frame::middle ? "middle, " : "on i, ") +
           angles[static_cast<int>(f.angles)] + (f.conjugate ? "" : ", not conjugate") +
           (f.offset_moment ? "" : ", no moment of the offset");
}

}  // namespace elastocheck::recursive
