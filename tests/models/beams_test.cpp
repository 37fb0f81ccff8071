// Beams of a scene file: Timoshenko stiffness and mirrors; sections and nodes are in fixtures/cantilever.facts.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "elastocheck/read_scene.hpp"
#include "models/kinds.hpp"
#include "tests/models/fixtures.hpp"

namespace elastocheck {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// A cantilever along x and then along y, with a body at its end.
std::string cantilever(const std::string& beam) {
    const std::string text = fixture("cantilever");
    const auto begin = text.find("through:");
    return replaced(text, text.substr(begin, text.find('}', begin) - begin), beam);
}
const std::string section = "E: 2, G: 3, A: 5, I_y: 7, I_z: 11, J: 13";

Matrix6 K_of(const Bushing& b) { return std::get<LinearStiffness>(b.law).K; }

// e = B (Δr_i, Δπ_i, Δr_j, Δπ_j) for small motions:
//   d = Aᵀ (Δr_j + Δπ_j × s_j - Δr_i - Δπ_i × s_i),  θ = Aᵀ (Δπ_j - Δπ_i).
Eigen::Matrix<double, 6, 12> deformation(const Bushing& b) {
    const auto cross = [](const Vector3d& s) {  // π × s = cross(s) π
        Eigen::Matrix3d m;
        m << 0, s.z(), -s.y(), -s.z(), 0, s.x(), s.y(), -s.x(), 0;
        return m;
    };
    const Eigen::Matrix3d A = b.i.A_local.toRotationMatrix();
    Eigen::Matrix<double, 6, 12> B = Eigen::Matrix<double, 6, 12>::Zero();
    B.block<3, 3>(0, 0) = -A.transpose();
    B.block<3, 3>(0, 3) = -A.transpose() * cross(b.i.s_local);
    B.block<3, 3>(0, 6) = A.transpose();
    B.block<3, 3>(0, 9) = A.transpose() * cross(b.j.s_local);
    B.block<3, 3>(3, 3) = -A.transpose();
    B.block<3, 3>(3, 9) = A.transpose();
    return B;
}

// Displacement and rotation of body 0, the tip, under a small wrench; ground is eliminated from K.
Vector6 tip_motion(const Scene& scene, const Vector6& wrench) {
    const auto n = static_cast<Eigen::Index>(6 * scene.bodies.size());
    MatrixXd K = MatrixXd::Zero(n, n);
    for (const Elastic& elastic : scene.elastics) {
        const auto& b = std::get<Bushing>(elastic.kind);
        const auto B = deformation(b);
        const Eigen::Matrix<double, 12, 12> k = B.transpose() * K_of(b) * B;
        const BodyId ends[] = {b.i.body, b.j.body};
        for (int r = 0; r < 2; ++r)
            for (int c = 0; c < 2; ++c)
                if (ends[r] != ground && ends[c] != ground)
                    K.block<6, 6>(6 * ends[r], 6 * ends[c]) += k.block<6, 6>(6 * r, 6 * c);
    }
    VectorXd f = VectorXd::Zero(n);
    f.head<6>() = wrench;
    return VectorXd(K.partialPivLu().solve(f)).head<6>();
}

// Przemieniecki's 12×12 beam matrix, with x along the beam.
TEST(Beam, OneSegmentHasTheTimoshenkoStiffnessMatrix) {
    const Scene scene = parse_scene(cantilever("through: [root, bend], segments: 1, " + section +
                                               ", shear_y: 0.5, shear_z: 0.7, up: z"),
                                    "b.yaml");
    Scene moved = scene;  // moves the tip's origin to the end of the beam
    auto b = std::get<Bushing>(moved.elastics.at(0).kind);
    const double L = 3, EA = 10, EI_y = 14, EI_z = 22, GJ = 39, GA_y = 1.5, GA_z = 2.1;
    EXPECT_EQ(b.i.s_local, Vector3d(1.5, 0, 0));
    EXPECT_EQ(b.formulation.frame, Formulation::Frame::middle);
    b.j.s_local = Vector3d(-1.5, 0, 0);
    const auto B = deformation(b);
    const Eigen::Matrix<double, 12, 12> K = B.transpose() * K_of(b) * B;

    const double p_y = 12 * EI_z / (GA_y * L * L), p_z = 12 * EI_y / (GA_z * L * L);
    Eigen::Matrix<double, 12, 12> book = Eigen::Matrix<double, 12, 12>::Zero();
    const auto set = [&](int r, int c, double k) { book(r - 1, c - 1) = book(c - 1, r - 1) = k; };
    set(1, 1, EA / L), set(7, 1, -EA / L), set(7, 7, EA / L);
    set(4, 4, GJ / L), set(10, 4, -GJ / L), set(10, 10, GJ / L);
    const double y3 = 12 * EI_z / (L * L * L * (1 + p_y)), y2 = 6 * EI_z / (L * L * (1 + p_y));
    set(2, 2, y3), set(8, 2, -y3), set(8, 8, y3);
    set(6, 2, y2), set(12, 2, y2), set(8, 6, -y2), set(12, 8, -y2);
    const double z3 = 12 * EI_y / (L * L * L * (1 + p_z)), z2 = 6 * EI_y / (L * L * (1 + p_z));
    set(3, 3, z3), set(9, 3, -z3), set(9, 9, z3);
    set(5, 3, -z2), set(11, 3, -z2), set(9, 5, z2), set(11, 9, z2);
    for (const int k : {6, 12}) set(k, k, (4 + p_y) * EI_z / ((1 + p_y) * L));
    for (const int k : {5, 11}) set(k, k, (4 + p_z) * EI_y / ((1 + p_z) * L));
    set(12, 6, (2 - p_y) * EI_z / ((1 + p_y) * L));
    set(11, 5, (2 - p_z) * EI_y / ((1 + p_z) * L));
    Eigen::Index r = 0, c = 0;
    EXPECT_LE((K - book).cwiseAbs().maxCoeff(&r, &c), 1e-13 * book.cwiseAbs().maxCoeff())
        << "at " << r << ", " << c;
}

// Small loads on a cantilever with a corner: bending of both legs, torsion of the first. Exact for
// any number of segments.
TEST(Beam, StiffnessDoesNotDependOnTheNumberOfSegments) {
    const double a = 3, b = 2, EI_y = 14, EI_z = 22, EA = 10, GJ = 39;
    for (const int n : {2, 3, 5, 12, 40}) {
        const Scene scene =
            parse_scene(cantilever(fmt::format(
                            "through: [root, bend, tip], segments: {}, {}, up: z", n, section)),
                        "b.yaml");
        ASSERT_EQ(scene.bodies.size(), static_cast<std::size_t>(n));
        ASSERT_EQ(scene.elastics.size(), static_cast<std::size_t>(n));
        // F normal to the plane (z): w = F (a³ + b³)/(3EI_y) + F b² a/(GJ)
        const double up = tip_motion(scene, Vector6::Unit(2))[2];
        EXPECT_NEAR(up, (a * a * a + b * b * b) / (3 * EI_y) + b * b * a / GJ, 1e-9) << n;
        // F along x in the plane: the second leg bends, the first carries the force and its moment
        // F b.
        const double fore = tip_motion(scene, Vector6::Unit(0))[0];
        EXPECT_NEAR(fore, b * b * b / (3 * EI_z) + a / EA + b * b * a / EI_z, 1e-9) << n;
    }
}

// ---- Mirrors.

const std::string axle = fixture("beam_axle");

const Elastic& named(const Scene& scene, const std::string& name) {
    for (const Elastic& elastic : scene.elastics)
        if (elastic.name == name) return elastic;
    throw std::out_of_range(name);
}
Vector3d place(const Scene& scene, const Marker& m) {
    return m.s_local + (m.body == ground
                            ? Vector3d(Vector3d::Zero())
                            : scene.bodies.at(static_cast<std::size_t>(m.body)).design.r);
}

TEST(BeamMirror, NodesOfASharedBeamAreMirrorImages) {
    const Scene scene = parse_scene(axle, "axle.yaml");
    int of_the_beam = 0;
    for (const Body& body : scene.bodies) of_the_beam += body.name.starts_with("antiroll.");
    EXPECT_EQ(of_the_beam, 8);
    const std::pair<const char*, const char*> pairs[] = {{"mount_left", "mount_right"},
                                                         {"near_left", "near_right"}};
    for (const auto& [left, right] : pairs) {
        const auto& l = std::get<Bushing>(named(scene, left).kind);
        const auto& r = std::get<Bushing>(named(scene, right).kind);
        EXPECT_LE((scene.bodies[static_cast<std::size_t>(l.i.body)].design.r.cwiseProduct(
                       Vector3d(1, -1, 1)) -
                   scene.bodies[static_cast<std::size_t>(r.i.body)].design.r)
                      .norm(),
                  1e-15);
        EXPECT_NE(l.i.body, r.i.body);
        EXPECT_LE((place(scene, l.i).cwiseProduct(Vector3d(1, -1, 1)) - place(scene, r.i)).norm(),
                  1e-15);
    }
    EXPECT_EQ(body_name(scene, std::get<Bushing>(named(scene, "near_right").kind).i.body),
              "antiroll.7");
    for (int k = 1; k <= 9; ++k) {  // the segments are mirror images of each other
        const auto& a = std::get<Bushing>(named(scene, fmt::format("antiroll.{}", k)).kind);
        const auto& b = std::get<Bushing>(named(scene, fmt::format("antiroll.{}", 10 - k)).kind);
        EXPECT_LE((place(scene, a.i).cwiseProduct(Vector3d(1, -1, 1)) - place(scene, b.i)).norm(),
                  1e-15)
            << k;
        EXPECT_LE((K_of(a) - K_of(b)).cwiseAbs().maxCoeff(), 1e-12 * K_of(a).maxCoeff()) << k;
    }
}

TEST(BeamMirror, BeamOfOneSideIsMirroredWithItsNodes) {
    const Scene scene = parse_scene(axle, "axle.yaml");
    for (int k = 1; k <= 3; ++k) {
        const auto& l = std::get<Bushing>(named(scene, fmt::format("torsion_left.{}", k)).kind);
        const auto& r = std::get<Bushing>(named(scene, fmt::format("torsion_right.{}", k)).kind);
        const std::string left = body_name(scene, l.j.body);
        EXPECT_EQ(body_name(scene, r.j.body),
                  k == 3 ? "ground" : fmt::format("torsion_right.{}", k));
        EXPECT_EQ(left, k == 3 ? "ground" : fmt::format("torsion_left.{}", k));
        for (const auto& [m_l, m_r] : {std::pair{l.i, r.i}, std::pair{l.j, r.j}}) {
            EXPECT_LE(
                (place(scene, m_l).cwiseProduct(Vector3d(1, -1, 1)) - place(scene, m_r)).norm(),
                1e-15);
            const Eigen::Matrix3d S = Vector3d(1, -1, 1).asDiagonal();
            EXPECT_LE(
                (S * m_l.A_local.toRotationMatrix() * S - m_r.A_local.toRotationMatrix()).norm(),
                1e-14);
        }
    }
}

}  // namespace
}  // namespace elastocheck
