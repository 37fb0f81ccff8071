// Diagnosis at the design position: rank, redundancy, idle modes, condition number; what `inspect` says of
// idle motions is in tests/reports/claims/outcomes.claims.
#include "recursive/diagnosis/diagnosis.hpp"
#include "models/eigen/dense.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "elastocheck/compile.hpp"
#include "elastocheck/read_scene.hpp"
#include "elastocheck/recursive.hpp"
#include "recursive/diagnosis/analysis.hpp"
#include "recursive/linear_algebra/assembly.hpp"
#include "recursive/linear_algebra/pattern.hpp"
#include "recursive/linear_algebra/saddle_point.hpp"
#include "tests/support/scene_text.hpp"
#include "tests/support/scenes.hpp"

namespace elastocheck::recursive {
namespace {

// Two bars on one ground: the first on two hinges of one line, the second on one.
TEST(Diagnosis, OnlyReactionsOfRedundantJointsAreUndetermined) {
    Scene scene = support::scene_of("recursive/scenes/bar_on_two_hinges");
    scene.bodies.push_back({"other", {{0, 1, 0}, Eigen::Quaterniond::Identity()}});
    const Direction x{ground, Eigen::Vector3d::UnitX()}, own_x{1, Eigen::Vector3d::UnitX()};
    scene.joints.push_back(
        {"hinge_3", Revolute{{1, Eigen::Vector3d::Zero()}, {ground, {0, 1, 0}}, own_x, x}});
    scene.joints.push_back({"rod", Distance{{1, {0, 0, 1}}, {0, {0, 0, 1}}, 1}});
    scene.probes.push_back({"other", {1, Eigen::Vector3d::Zero()}});
    const Model model = compile(scene);
    const auto d = diagnose(model);
    EXPECT_EQ(d.rows, 16);
    EXPECT_EQ(d.rank, 11);
    ASSERT_EQ(d.redundant.size(), 1u);
    EXPECT_EQ(model.joints[static_cast<std::size_t>(d.redundant[0].joint)].name, "hinge_2");
    EXPECT_EQ(d.redundant[0].rows, 5);
    EXPECT_FALSE(d.redundant[0].contradicts);
    EXPECT_EQ(d.determined, (std::vector<bool>{false, false, true, true}));
    EXPECT_EQ(d.redundant_sets, (std::vector<std::vector<int>>{{0, 1}}));
}

TEST(Diagnosis, SoftDirectionOfARotatedBushingIsNotIdle) {
    // Rates of 1e12 beside 100, at an angle to the ground and to the body, as a diagonal of the
    // rotated frame and as a full matrix of the unrotated one.
    const Eigen::Matrix3d R(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -0.5).normalized()));
    for (const bool full : {false, true}) {
        Scene scene;
        scene.bodies = {{"block", {{1, 2, 3}, Eigen::Quaterniond::Identity()}}};
        LinearStiffness law;
        law.K.diagonal() << 1e12, 100, 100, 1e12, 100, 100;
        Bushing mount{
            {0, Eigen::Vector3d::Zero()}, {ground, {1, 2, 3}}, {}, elastocheck::Vector6::Zero()};
        if (full) {
            for (int k : {0, 3})
                law.K.block<3, 3>(k, k) = (R * law.K.block<3, 3>(k, k) * R.transpose()).eval();
        } else {
            mount.i.A_local = mount.j.A_local = Eigen::Quaterniond(R);
        }
        mount.law = law;
        scene.elastics = {{"mount", mount}};
        scene.probes = {{"block", {0, Eigen::Vector3d::Zero()}}};
        EXPECT_TRUE(diagnose(compile(scene)).idle.empty()) << full;
    }
}

TEST(Diagnosis, EquilibratedConditionDoesNotDependOnTheUnitsOfTheStiffness) {
    Scene scene = support::scene("pinned_bar");
    const auto equilibrated = [](const Scene& told) {
        const Model model = compile(told);
        return conditioning(model, diagnose(model)).equilibrated;
    };
    const double plain = equilibrated(scene);
    std::get<LinearStiffness>(std::get<Bushing>(scene.elastics[0].kind).law).K *= 1e12;
    EXPECT_NEAR(equilibrated(scene) / plain, 1, 1);
    EXPECT_LT(plain, 100);
}

// With a NaN in the model no rank is computed; the methods report the failure.
TEST(Diagnosis, NonFiniteDesignValueIsReportedAndNothingElse) {
    const double none[] = {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), 1e300};  // its square overflows
    for (const double bad : none) {
        Scene joint = support::scene("mcpherson"), element = joint, body = joint;
        std::get<Distance>(joint.joints[2].kind).i.s_local.y() = bad;
        std::get<AxialSpring>(element.elastics.front().kind).i.s_local.z() = bad;
        body.bodies.front().design.p.x() = bad;
        for (const auto& [scene, named] : {std::pair{joint, std::string("joint 'tie_rod'")},
                                           {element, "element 'K1_coil'"},
                                           {body, "joint '"}}) {
            if (std::isfinite(bad) && named.ends_with("joint '"))
                continue;  // a quaternion of any size turns
            const Model model = compile(scene);
            const Diagnosis d = diagnose(model);
            EXPECT_TRUE(std::isnan(d.constraint_error) && std::isnan(d.imbalance)) << named << bad;
            EXPECT_TRUE(d.redundant.empty() && d.idle.empty()) << named << bad;
            EXPECT_TRUE(std::isnan(conditioning(model, d).equilibrated)) << named << bad;
            for (const auto& method : methods) {
                const auto path =
                    solve(model, model.branches.front(), {.method = method, .steps = 3});
                EXPECT_EQ(path.outcome, Outcome::not_finite) << method.name << named << bad;
                EXPECT_NE(path.detail.find("a number of the model is not finite in "),
                          std::string::npos)
                    << path.detail;
                EXPECT_NE(path.detail.find(named), std::string::npos) << path.detail;
                EXPECT_TRUE(path.points.empty());
            }
        }
    }
}

TEST(Diagnosis, RankAndIdleModesDoNotDependOnFrameOrOrder) {
    const Scene scene = support::scene("chrono_mcpherson");
    const Eigen::Quaterniond R(Eigen::AngleAxisd(2, Eigen::Vector3d(1, -2, 0.5).normalized()));
    for (const auto& other :
         {support::moved(scene, R, {30, -20, 10}), support::reversed(scene),
          support::mirrored(scene), support::with_body_axes(scene, {R, R.conjugate()})}) {
        const auto a = diagnose(compile(scene)), b = diagnose(compile(other));
        EXPECT_EQ(a.rank, b.rank);
        EXPECT_NEAR(a.length, b.length, 1e-12);
        ASSERT_EQ(b.idle.size(), 1u);
        EXPECT_NE(b.idle[0].description.find("strut: rotation about the line through"),
                  std::string::npos)
            << b.idle[0].description;
    }
}

// ---- Comparison with dense matrices on small scenes.

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Φ_q in (Δr, L Δπ), rows of unit length.
MatrixXd dense_rows(const Model& model, double length) {
    MatrixXd rows = constraint_jacobian<double>(model, inputs_as_drawn<double>(model),
                                                design_state<double>(model));
    for (Eigen::Index b = 0; b < rows.cols() / 6; ++b) rows.middleCols(6 * b + 3, 3) /= length;
    for (Eigen::Index k = 0; k < rows.rows(); ++k)
        if (rows.row(k).norm() > 0) rows.row(k).normalize();
    return rows;
}
int dense_rank(const MatrixXd& rows) {
    if (rows.size() == 0) return 0;
    Eigen::ColPivHouseholderQR<MatrixXd> qr(rows.transpose());
    qr.setThreshold(1e-9);
    return static_cast<int>(qr.rank());
}

// Redundancy of every joint by ranks of all rows up to it; and which joints the projector on all
// dependencies couples.
void expect_as_dense(const Model& model, const Diagnosis& d, const std::string& what) {
    const MatrixXd Phi_q = dense_rows(model, d.length);
    EXPECT_EQ(d.rank, dense_rank(Phi_q)) << what;
    std::vector<int> end(model.joints.size(), 0), joint_of_row;
    for (const auto& c : model.constraints)
        joint_of_row.insert(joint_of_row.end(), rows(c.kind), c.joint);
    std::vector<std::pair<int, int>> redundant, found;
    int first = 0, before = 0;
    for (int joint = 0; joint < static_cast<int>(model.joints.size()); ++joint) {
        const auto own = static_cast<int>(std::ranges::count(joint_of_row, joint));
        const int rank = dense_rank(Phi_q.topRows(first + own));
        if (own > rank - before) redundant.emplace_back(joint, own - (rank - before));
        first += own;
        before = rank;
    }
    for (const auto& r : d.redundant) found.emplace_back(r.joint, r.rows);
    EXPECT_EQ(found, redundant) << what;

    Eigen::ColPivHouseholderQR<MatrixXd> qr;
    qr.setThreshold(1e-9);
    std::vector<bool> determined(model.joints.size(), true);
    std::vector<std::vector<int>> sets;
    if (d.rank < d.rows) {
        qr.compute(Phi_q);
        const MatrixXd Q = matrix_Q(qr), Y = Q.rightCols(d.rows - d.rank), P = Y * Y.transpose();
        MatrixXd coupled = MatrixXd::Zero(static_cast<Eigen::Index>(end.size()),
                                          static_cast<Eigen::Index>(end.size()));
        for (int k = 0; k < d.rows; ++k)
            for (int l = 0; l < d.rows; ++l)
                if (std::abs(P(k, l)) > 1e-7)
                    coupled(joint_of_row[static_cast<std::size_t>(k)],
                            joint_of_row[static_cast<std::size_t>(l)]) = 1;
        for (std::size_t step = 0; step < end.size(); ++step)
            coupled = (coupled * coupled).cwiseMin(1.0).eval();
        for (Eigen::Index joint = 0; joint < coupled.rows(); ++joint) {
            determined[static_cast<std::size_t>(joint)] = coupled(joint, joint) == 0;
            std::vector<int> members;
            for (Eigen::Index other = 0; other < coupled.rows(); ++other)
                if (coupled(joint, other) > 0) members.push_back(static_cast<int>(other));
            if (!members.empty() && members.front() == joint) sets.push_back(members);
        }
    }
    EXPECT_EQ(d.determined, determined) << what;
    EXPECT_EQ(d.redundant_sets, sets) << what;

    // The null space has the dimension of the rank deficiency, independent columns, and zero
    // product with the matrix.
    SaddleMatrix<double> M = saddle_matrix(model);
    VectorXd Phi(d.rows);
    assemble<double>(model, inputs_as_drawn<double>(model), design_state<double>(model), M, Phi);
    const VectorXd D = equilibration(M);
    const MatrixXd scaled = D.asDiagonal() * sparse(M).toDense() * D.asDiagonal();
    MatrixXd N = D.cwiseInverse().asDiagonal() * d.null_space.toDense();
    for (Eigen::Index c = 0; c < N.cols(); ++c) N.col(c).normalize();
    EXPECT_EQ(dense_rank(N.transpose()), N.cols()) << what;
    if (N.cols() > 0) {
        EXPECT_LE((scaled * N).cwiseAbs().maxCoeff(), 1e-10) << what;
        const VectorXd size = Eigen::JacobiSVD<MatrixXd>(scaled).singularValues();
        EXPECT_GT(size[size.size() - 1 - N.cols()], 1e-9 * size[0]) << what;
    }
}

TEST(Diagnosis, SparseRankEqualsDenseRankOnEveryBuiltInScene) {
    for (const auto& name : support::scene_names())
        for (const Detail detail : {Detail::required, Detail::everything}) {
            const Model model = compile(support::scene(name), detail);
            expect_as_dense(model, diagnose(model), name);
        }
}

TEST(Conditioning, SparseEstimateEqualsDenseSingularValuesOnEveryBuiltInScene) {
    // In long double: an unscaled condition number of 1e15 leaves the smallest singular value no
    // digit in double.
    using Long = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
    for (const auto& name : support::scene_names()) {
        const Model model = compile(support::scene(name));
        const auto d = diagnose(model);
        const Conditioning found = conditioning(model, d);
        SaddleMatrix<double> M = saddle_matrix(model);
        VectorXd Phi(d.rows);
        assemble<double>(model, inputs_as_drawn<double>(model), design_state<double>(model), M,
                         Phi);
        const VectorXd D = equilibration(M);
        const MatrixXd raw = sparse(M).toDense(), scaled = D.asDiagonal() * raw * D.asDiagonal();
        const auto kappa = [&](const MatrixXd& A) {
            const Eigen::JacobiSVD<Long> svd(A.cast<long double>());
            const auto& s = svd.singularValues();
            return static_cast<double>(s[0] / s[s.size() - 1 - d.null_space.cols()]);
        };
        EXPECT_LE(std::abs(found.equilibrated / kappa(scaled) - 1), 1e-6) << name;
        const double expected = kappa(raw);
        // Tolerance by rounding of the largest entries.
        EXPECT_LE(std::abs(found.raw / expected - 1), std::max(1e-6, 1e-16 * expected))
            << name << " " << expected;
    }
}

// ---- Generated scenes.

// A chain of bodies, each with its origin at its joint with the next.
Scene row_of_bodies(int n, const std::function<Vector3d(int)>& at) {
    Scene scene;
    for (int k = 0; k < n; ++k)
        scene.bodies.push_back({"b" + std::to_string(k), {at(k), Eigen::Quaterniond::Identity()}});
    scene.probes = {{"end", {n - 1, Vector3d::Zero()}}};
    return scene;
}
Vector3d place(const Scene& scene, BodyId b) {
    return b == ground ? Vector3d(Vector3d::Zero())
                       : scene.bodies[static_cast<std::size_t>(b)].design.r;
}
Revolute hinge(const Scene& scene, BodyId i, BodyId j, const Vector3d& p, const Vector3d& axis) {
    return {{i, p - place(scene, i)}, {j, p - place(scene, j)}, {i, axis}, {j, axis}};
}
Bushing mount(const Scene& scene, BodyId i, BodyId j, const Vector3d& p,
              const Vector6<double>& rates) {
    Bushing bushing{
        {i, p - place(scene, i)}, {j, p - place(scene, j)}, {}, elastocheck::Vector6::Zero()};
    LinearStiffness law;
    law.K.diagonal() = rates;
    bushing.law = law;
    return bushing;
}
const Vector6<double> all_round = (Vector6<double>() << 1e6, 1e6, 1e6, 1e3, 1e3, 1e3).finished();
const Vector6<double> about_z = (Vector6<double>() << 0, 0, 0, 0, 0, 1e3).finished();

// Hinges with torsional springs, every other one with another axis.
Scene chain_of_hinges(int n, bool in_a_plane) {
    Scene scene = row_of_bodies(n, [&](int k) -> Vector3d {
        return {0.1 * (k + 1), 0.03 * (k % 3), in_a_plane ? 0.0 : 0.02 * (k % 5)};
    });
    for (BodyId b = 0; b < n; ++b) {
        const Vector3d p = place(scene, b - 1);
        const Vector3d axis = in_a_plane || b % 2 == 0 ? Vector3d::UnitZ() : Vector3d::UnitY();
        scene.joints.push_back({"hinge" + std::to_string(b), hinge(scene, b, b - 1, p, axis)});
        Vector6<double> rates = Vector6<double>::Zero();
        rates.tail<3>() = 1e3 * axis;
        scene.elastics.push_back({"spring" + std::to_string(b), mount(scene, b, b - 1, p, rates)});
    }
    return scene;
}

TEST(Diagnosis, AChainOfTwoThousandHingesHasNoRedundantRowAndNoIdleMode) {
    Scene scene = chain_of_hinges(2000, false);
    for (const bool reversed : {false, true}) {
        if (reversed) std::ranges::reverse(scene.joints);
        const auto d = diagnose(compile(scene, Detail::everything));
        EXPECT_EQ(d.rank, 10000);
        EXPECT_TRUE(d.redundant.empty());
        EXPECT_TRUE(d.idle.empty());
    }
}

TEST(Diagnosis, AChainOfTwoThousandBushingsHasNoIdleMode) {
    Scene scene = row_of_bodies(2000, [](int k) -> Vector3d { return {0.1 * (k + 1), 0, 0}; });
    for (BodyId b = 0; b < 2000; ++b)
        scene.elastics.push_back(
            {"k" + std::to_string(b), mount(scene, b, b - 1, place(scene, b - 1), all_round)});
    EXPECT_TRUE(diagnose(compile(scene, Detail::everything)).idle.empty());
    // Without a rate about the chain halfway along it, the rest rotates about the chain as one.
    scene.elastics[1000].kind = mount(scene, 1000, 999, place(scene, 999),
                                      (Vector6<double>() << 1e6, 1e6, 1e6, 0, 1e3, 1e3).finished());
    const auto d = diagnose(compile(scene, Detail::everything));
    ASSERT_EQ(d.idle.size(), 1u);
    EXPECT_EQ(d.idle[0].dq.nonZeros(), 1000);
    EXPECT_NE(d.idle[0].description.find("rotation about the line through"), std::string::npos)
        << d.idle[0].description;
}

TEST(Diagnosis, LastJointOfALoopOfTwoThousandIsRedundant) {
    // In a plane three of the five rows of the last hinge are dependent; out of the plane
    // they are independent.
    for (const double tilt : {0.0, 1e-6}) {
        Scene scene = chain_of_hinges(2000, true);
        const Vector3d end = place(scene, 1999) + Vector3d(0.1, 0.05, 0);
        scene.joints.push_back(
            {"last", hinge(scene, 1999, ground, end, Vector3d(tilt, 0, 1).normalized())});
        for (const bool first : {false, true}) {
            if (first) std::ranges::rotate(scene.joints, scene.joints.end() - 1);
            const Model model = compile(scene, Detail::everything);
            const auto d = diagnose(model);
            const int repeated = tilt == 0 ? 3 : 2;
            EXPECT_EQ(d.rank, 10005 - repeated) << tilt;
            ASSERT_EQ(d.redundant.size(), 1u) << tilt;
            EXPECT_EQ(d.redundant[0].rows, repeated);
            EXPECT_EQ(model.joints[static_cast<std::size_t>(d.redundant[0].joint)].name,
                      first ? "hinge1999" : "last");
            ASSERT_EQ(d.redundant_sets.size(), 1u);
            EXPECT_EQ(d.redundant_sets[0].size(), 2001u);
        }
    }
}

// A tower of four-hinge loops: only the last hinge of every loop has dependent rows.
Scene tower(int loops) {
    Scene scene = row_of_bodies(3 * loops, [](int k) -> Vector3d {
        return {k % 3 == 1 ? 0.1 : 0.0, 0.1 * (k / 3 + 1), 0};
    });
    for (int k = 0; k < loops; ++k) {
        const BodyId left = 3 * k, right = 3 * k + 1, top = 3 * k + 2,
                     base = k == 0 ? ground : 3 * k - 1;
        const Vector3d up(0, 0.1 * k, 0), across(0.1, 0, 0), next = up + Vector3d(0, 0.1, 0);
        const std::string name = std::to_string(k);
        const auto join = [&](const char* what, BodyId i, BodyId j, const Vector3d& p) {
            scene.joints.push_back({what + name, hinge(scene, i, j, p, Vector3d::UnitZ())});
        };
        join("left", left, base, up), join("right", right, base, up + across);
        join("top", top, left, next), join("close", top, right, next + across);
        scene.elastics.push_back({"s" + name, mount(scene, left, base, up, about_z)});
    }
    return scene;
}

TEST(Diagnosis, EachLoopOfATowerHasItsOwnRedundantSet) {
    const Model few = compile(tower(4), Detail::everything);
    expect_as_dense(few, diagnose(few), "four loops");
    const Model model = compile(tower(500), Detail::everything);
    const auto d = diagnose(model);
    ASSERT_EQ(d.redundant.size(), 500u);
    EXPECT_EQ(d.redundant_sets.size(), 500u);
    for (const auto& r : d.redundant) {
        EXPECT_EQ(r.rows, 3);
        EXPECT_TRUE(model.joints[static_cast<std::size_t>(r.joint)].name.starts_with("close"));
    }
    for (const auto& set : d.redundant_sets) EXPECT_EQ(set.size(), 4u);
    EXPECT_LE(d.null_space.nonZeros(), 500 * 3 * 20);
    EXPECT_TRUE(d.idle.empty());
}

TEST(Diagnosis, DuplicatedJointOfAGridIsFound) {
    const int side = 20;
    Scene scene = row_of_bodies(side * side, [&](int k) -> Vector3d {
        return {0.1 * (k % side), 0.1 * (k / side), 0.01 * ((k * k) % 7)};
    });
    const auto ball = [&](BodyId i, BodyId j) {
        const Vector3d p = place(scene, i);
        scene.joints.push_back(
            {"ball", Spherical{{i, p - place(scene, i)}, {j, p - place(scene, j)}}});
    };
    for (BodyId b = 0; b < side * side; ++b) {
        scene.elastics.push_back({"k", mount(scene, b, ground, place(scene, b), all_round)});
        if (b % side > 0) ball(b, b - 1);
    }
    EXPECT_TRUE(diagnose(compile(scene, Detail::everything)).redundant.empty());
    scene.joints.insert(scene.joints.begin() + 300, scene.joints[120]);
    const auto d = diagnose(compile(scene, Detail::everything));
    ASSERT_EQ(d.redundant.size(), 1u);
    EXPECT_EQ(d.redundant[0].joint, 300);
    EXPECT_EQ(d.redundant[0].rows, 3);
    EXPECT_EQ(d.redundant_sets, (std::vector<std::vector<int>>{{120, 300}}));
}

TEST(Diagnosis, IdleSpinOfEachOfAThousandBodiesIsAModeOfThatBodyAlone) {
    // A body with a thousand others on it.
    Scene scene = row_of_bodies(1001, [](int k) -> Vector3d {
        return {0.01 * k, 0.5, 0.001 * (k % 7)};
    });
    scene.elastics.push_back({"frame", mount(scene, 0, ground, place(scene, 0), all_round)});
    for (BodyId b = 1; b <= 1000; ++b) {
        const Vector3d p = place(scene, b), other = p - Vector3d(0, 0.3, 0.1);
        scene.joints.push_back(
            {"ball", Spherical{{b, Vector3d::Zero()}, {0, p - place(scene, 0)}}});
        Vector6<double> rates = all_round;
        rates.tail<3>().setZero();
        scene.elastics.push_back({"k", mount(scene, b, ground, other, rates)});
    }
    const auto d = diagnose(compile(scene, Detail::everything));
    ASSERT_EQ(d.idle.size(), 1000u);
    for (const auto& mode : d.idle) {
        EXPECT_LE(mode.dq.nonZeros(), 6);
        EXPECT_NE(mode.description.find("rotation about the line through"), std::string::npos);
    }
    EXPECT_TRUE(d.redundant.empty());
}

TEST(Diagnosis, ModelWithoutBodiesIsRejectedWithAMessage) {
    const auto message = [](auto&& call) -> std::string {
        try {
            call();
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(message([] { diagnose({}); }), "the model has no bodies");
    EXPECT_EQ(message([] { analyse(Model{}); }), "the model has no bodies");
    for (const Method& method : methods)
        EXPECT_EQ(message([&] { solve(Model{}, Branch{}, {.method = method}); }),
                  "the model has no bodies")
            << method.name;
}

}  // namespace
}  // namespace elastocheck::recursive
