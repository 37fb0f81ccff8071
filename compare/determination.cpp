#include "compare/determination.hpp"

#include <Eigen/QR>
#include <cmath>
#include <numeric>

#include "recursive/diagnosis.hpp"

namespace elastocheck::compare {

// With N an orthonormal basis of {λ : Φ_qᵀ λ = 0}, whichever, P = N Nᵀ is one and the same matrix. Row k
// takes part where P_kk > 0, and rows k and l in one and the same λ where P_kl ≠ 0.
Determination determination(const Model& model) {
    constexpr double none = 1e-9;  // of P, whose entries are at most 1
    const auto diagnosis = recursive::diagnose(model);
    const int m = constraint_rows(model);
    Determination result;
    result.joint.assign(model.joints.size(), true);
    const Eigen::MatrixXd lambda = diagnosis.null_space.bottomRows(diagnosis.null_space.rows() == 0 ? 0 : m);
    if (lambda.size() == 0 || lambda.isZero(0)) return result;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(lambda);
    const Eigen::MatrixXd Q = Eigen::MatrixXd(qr.householderQ()).leftCols(qr.rank());
    const Eigen::MatrixXd P = Q * Q.transpose();

    std::vector<int> joint_of_row, group(model.joints.size());
    for (const auto& constraint : model.constraints)
        joint_of_row.insert(joint_of_row.end(), static_cast<std::size_t>(rows(constraint.kind)),
                            constraint.joint);
    std::iota(group.begin(), group.end(), 0);
    for (int k = 0; k < m; ++k)
        for (int l = 0; l < m; ++l) {
            if (!(std::abs(P(k, l)) > none)) continue;
            const int a = joint_of_row[static_cast<std::size_t>(k)],
                      b = joint_of_row[static_cast<std::size_t>(l)];
            result.joint[static_cast<std::size_t>(a)] = false;
            const int from = group[static_cast<std::size_t>(a)], to = group[static_cast<std::size_t>(b)];
            for (int& g : group)
                if (g == from) g = to;
        }
    for (std::size_t g = 0; g < group.size(); ++g) {
        std::vector<int> members;
        for (std::size_t j = 0; j < group.size(); ++j)
            if (!result.joint[j] && group[j] == static_cast<int>(g)) members.push_back(static_cast<int>(j));
        if (members.size() > 1) result.groups.push_back(members);
    }
    return result;
}

}  // namespace elastocheck::compare
