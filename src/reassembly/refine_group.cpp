#include "reassembly/refine_group.h"

#include "ostraka/core/progress.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

using Eigen::Quaterniond;

namespace {

/// Distance of a point of the second fragment from a plane of the first.
struct PlaneDistance {
    ContactPoint contact;
    double weight;

    template <class T>
    bool operator()(const T* rotation_a, const T* translation_a, const T* rotation_b, const T* translation_b, T* distance) const {
        using Vector = Eigen::Matrix<T, 3, 1>;
        const Eigen::Map<const Eigen::Quaternion<T>> ra(rotation_a), rb(rotation_b);
        const Eigen::Map<const Vector> ta(translation_a), tb(translation_b);
        const Vector on_b = contact.on_b.cast<T>(), on_a = contact.on_a.cast<T>(), normal = contact.normal.cast<T>();
        const Vector offset = rb * on_b + tb - ta;
        distance[0] = T(weight) * normal.dot(ra.conjugate() * offset - on_a);
        return true;
    }
};

}  // namespace

void refine_group(const std::vector<const PreparedFracture*>& fragments, const std::vector<MeetingPair>& meetings,
                  std::vector<Motion>& poses, int rounds) {
    const std::size_t n = fragments.size();
    if (n < 2 || meetings.empty()) return;
    std::vector<Quaterniond> rotations(n);
    std::vector<Vector3d> translations(n);
    for (std::size_t k = 0; k < n; ++k) {
        rotations[k] = Quaterniond(poses[k].rotation).normalized();
        translations[k] = poses[k].translation;
    }
    const auto pose = [&](std::size_t k) {
        Motion motion;
        motion.rotation = rotations[k].normalized().toRotationMatrix();
        motion.translation = translations[k];
        return motion;
    };
    // Fewer samples in large groups, where several neighbours constrain each fragment.
    const std::size_t samples = std::clamp<std::size_t>(200 * 25 / n, 40, 200);
    for (int round = 0; round < rounds; ++round) {
        check_cancelled();
        const double radius_factor = rounds > 1 ? 2 - static_cast<double>(round) / (rounds - 1) : 1;
        ceres::Problem::Options ownership;
        ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
        ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
        ceres::CauchyLoss loss(1);
        ceres::EigenQuaternionManifold sphere;
        ceres::Problem problem(ownership);
        for (std::size_t k = 0; k < n; ++k) {
            problem.AddParameterBlock(rotations[k].coeffs().data(), 4, &sphere);
            problem.AddParameterBlock(translations[k].data(), 3);
        }
        problem.SetParameterBlockConstant(rotations[0].coeffs().data());
        problem.SetParameterBlockConstant(translations[0].data());
        for (const MeetingPair& meeting : meetings)
            for (const auto& [a, b] : {std::pair(meeting.first, meeting.second), std::pair(meeting.second, meeting.first)}) {
                const auto contacts = contact_points(*fragments[a], *fragments[b], pose(a).inverse().after(pose(b)),
                                                     radius_factor * meeting.tolerance, samples);
                for (const ContactPoint& contact : contacts)
                    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PlaneDistance, 1, 4, 3, 4, 3>(
                                                 new PlaneDistance{contact, std::sqrt(contact.weight) / meeting.tolerance}),
                                             &loss, rotations[a].coeffs().data(), translations[a].data(),
                                             rotations[b].coeffs().data(), translations[b].data());
            }
        if (problem.NumResidualBlocks() < 6) break;
        ceres::Solver::Options options;
        options.linear_solver_type = n < 12 ? ceres::DENSE_QR : ceres::SPARSE_NORMAL_CHOLESKY;
        options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;  // no BLAS: several threads may be active here
        options.max_num_iterations = 12;
        options.num_threads = 1;  // for a fixed order of summation
        options.logging_type = ceres::SILENT;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &problem, &summary);
    }
    for (std::size_t k = 1; k < n; ++k) poses[k] = pose(k);
}

}  // namespace ostraka
