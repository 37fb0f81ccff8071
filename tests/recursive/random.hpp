// Random configurations with a fixed seed.
#pragma once

#include <random>
#include <vector>

#include "elastocheck/mechanism.hpp"
#include "recursive/formula/state.hpp"

namespace elastocheck::recursive {

struct Random {
    std::mt19937 engine{20041};

    double operator()(double low = -1, double high = 1) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    Eigen::Vector3d vector(double size = 1) {
        return size * Eigen::Vector3d((*this)(), (*this)(), (*this)());
    }
    Eigen::Vector3d unit() { return vector().normalized(); }
    Eigen::Quaterniond rotation(double angle = 3) {
        return Eigen::Quaterniond(Eigen::AngleAxisd((*this)(0, angle), unit()));
    }
    Pose pose(double angle = 3) { return {vector(), rotation(angle)}; }
    State<double> state(int bodies, double angle = 3) {
        std::vector<Pose> poses;
        poses.reserve(static_cast<std::size_t>(bodies));
        for (int b = 0; b < bodies; ++b) poses.push_back(pose(angle));
        return state_of<double>(poses);
    }
    // Symmetric, positive definite, translations in 1e6 N/m, rotations in 1e3 N·m, coupled.
    Matrix6<double> stiffness() {
        Matrix6<double> root;
        for (int k = 0; k < 36; ++k) root(k / 6, k % 6) = (*this)();
        Vector6<double> size;
        size << 1e3, 1e3, 1e3, 30, 30, 30;
        const Matrix6<double> K = size.asDiagonal() * (root * root.transpose()) * size.asDiagonal();
        return (K + K.transpose()) / 2;
    }
};

}  // namespace elastocheck::recursive
