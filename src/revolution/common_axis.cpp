// Maximum likelihood estimate of the common axis of all sherds, and of the tilt and offset of each in the layout.
#include "revolution/stages.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/axis/axis_evidence.h"
#include "ostraka/axis/revolution_axis.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace ostraka {

using Eigen::Matrix4d;
using Eigen::Vector4d;

namespace {

/// Min share of a sherd's area that is rotationally symmetric about the common axis. Unknown fractures take up to half of the
/// area.
constexpr double min_round = 0.35;
/// Max disagreement of a sherd's axis with the others, in standard deviations.
constexpr double max_disagreement = 6;

class AxisConsensus {
public:
    AxisConsensus(std::vector<PlacedSherd>& sherds, const RevolutionOptions& options, RevolutionTemplate& result)
        : sherds_(sherds), options_(options), result_(result) {}

    void run() {
        observe_each();
        drop_other_units();
        for (;;) {
            if (remaining().empty()) fail_all_left_out(result_);
            const std::optional<Axis> start = first_axis();
            if (!start) {
                for (const std::size_t k : remaining())
                    leave_out(result_.sherds[k], "has no axis: " + result_.sherds[k].axis.reason,
                              "add sherds that cover more of the circumference");
                fail_all_left_out(result_);
            }
            refine_axis(*start);
            if (!drop_one_that_disagrees()) break;
        }
        finish();
    }

private:
    /// The observation of one sherd, linearised at its current axis.
    struct AxisObservation {
        Matrix4d information = Matrix4d::Zero(), layout = Matrix4d::Zero();
        Vector4d target = Vector4d::Zero();  ///< information x axis, relative to the common axis
        double round = 0;
    };

    [[nodiscard]] std::vector<std::size_t> remaining() const {
        std::vector<std::size_t> indices;
        for (std::size_t k = 0; k < sherds_.size(); ++k)
            if (result_.sherds[k].use != SherdUse::left_out) indices.push_back(k);
        return indices;
    }

    /// Estimates each sherd's own axis, and prepares its witness.
    void observe_each() {
        witnesses_.resize(sherds_.size());
        const std::vector<std::size_t> indices = remaining();
        parallel_for(indices.size(), 1, [&](std::size_t i) {
            const std::size_t k = indices[i];
            SherdOnProfile& sherd = result_.sherds[k];
            std::vector<bool> alone(sherds_.size(), false);
            alone[k] = true;
            const JoinedSherds single = joined(sherds_, alone);
            const std::vector<Index> faces = single.faces();
            double area = 0;
            for (const Index f : faces) area += face_area(single.mesh, Face(f));
            if (!(area > 0)) {
                leave_out(sherd, faces.empty() ? "has no wall: all its faces are fracture surface" : "has no area",
                          "check its annotations and its mesh ('mesh info')");
                return;
            }
            witnesses_[k] = std::make_unique<AxisEvidenceEvaluator>(single.mesh, faces, options_.axis);
            if (!witnesses_[k]->enough()) {
                leave_out(sherd, fmt::format("has {} faces, too few to determine an axis", faces.size()),
                          "give a finer mesh ('mesh refine' adds faces, but no shape)");
                return;
            }
            sherd.axis = rotation_axis(single.mesh, faces, options_.axis);
        });
    }

    Axis axis_of(const std::vector<std::size_t>& indices) {
        std::vector<bool> selected(sherds_.size(), false);
        for (const std::size_t k : indices) selected[k] = true;
        const JoinedSherds subset = joined(sherds_, selected);
        return rotation_axis(subset.mesh, subset.faces(), options_.axis);
    }

    /// Weight by size, bounded by three times the median.
    [[nodiscard]] double vote(std::size_t k) const { return std::min(size(k), 3 * median_size_); }
    [[nodiscard]] double size(std::size_t k) const { return std::sqrt(witnesses_[k]->area()); }

    /// Drops sherds in another unit than most.
    void drop_other_units() {
        std::vector<double> sizes;
        for (const std::size_t k : remaining()) sizes.push_back(size(k));
        if (sizes.empty()) return;
        median_size_ = upper_median(sizes);
        for (const std::size_t k : remaining())
            if (sizes.size() > 2 && size(k) > 8 * median_size_)
                leave_out(result_.sherds[k], fmt::format("is {} times as large as most", digits(size(k) / median_size_, 3)),
                          "scale it if it is in another unit than the others");
    }

    /// Number of sherds that are rotationally symmetric about the axis, weighted by size.
    double agreement(const Axis& axis) const {
        const AxisFrame frame = frame_of(axis);
        double sum = 0;
        for (const std::size_t k : remaining()) {
            const double round = witnesses_[k]->at({frame.foot, frame.up, frame.u, frame.w}).round;
            sum += round * round * vote(k);
        }
        return sum;
    }

    /// Candidates are the axis of all sherds, those of single sherds and, if most sherds agree with none of these, those of all
    /// but one and of pairs. Returns the candidate about which most sherds are rotationally symmetric.
    std::optional<Axis> first_axis() {
        const std::vector<std::size_t> indices = remaining();
        std::vector<Axis> candidates;
        if (indices.size() > 1) candidates.push_back(axis_of(indices));
        for (const std::size_t k : indices) candidates.push_back(result_.sherds[k].axis);
        std::optional<Axis> best;
        double best_score = 0, total_vote = 0;
        for (const std::size_t k : indices) total_vote += vote(k);
        const auto consider = [&](const std::vector<Axis>& axes) {
            std::vector<double> scores(axes.size(), 0);
            parallel_for(axes.size(), 1, [&](std::size_t i) { scores[i] = axes[i].found ? agreement(axes[i]) : 0; });
            for (std::size_t i = 0; i < axes.size(); ++i)
                if (axes[i].found && (!best || scores[i] > best_score)) best = axes[i], best_score = scores[i];
        };
        consider(candidates);
        const double majority = 0.4 * total_vote;
        if (best_score > majority || indices.size() < 3) return best;
        std::vector<std::size_t> largest = indices;
        std::stable_sort(largest.begin(), largest.end(),
                         [&](std::size_t a, std::size_t b) { return witnesses_[a]->area() > witnesses_[b]->area(); });
        if (largest.size() > 8) largest.resize(8);
        std::vector<std::vector<std::size_t>> subsets;
        for (const std::size_t excluded : largest) {
            subsets.emplace_back();
            for (const std::size_t k : indices)
                if (k != excluded) subsets.back().push_back(k);
        }
        for (std::size_t a = 0; a < largest.size(); ++a)
            for (std::size_t b = 0; b < a; ++b) subsets.push_back({largest[b], largest[a]});
        candidates.assign(subsets.size(), {});
        parallel_for(subsets.size(), 1, [&](std::size_t i) { candidates[i] = axis_of(subsets[i]); });
        consider(candidates);
        return best;
    }

    [[nodiscard]] AxisGuess line(const Vector4d& parameters) const {
        const Vector3d up = (frame_.up + parameters[2] * frame_.u + parameters[3] * frame_.w).normalized();
        return {frame_.foot + parameters[0] * frame_.u + parameters[1] * frame_.w, up, frame_.u, frame_.w};
    }

    AxisObservation observe(std::size_t k) const {
        const AxisEvidence evidence = witnesses_[k]->at(line(common_ + deviations_[k]));
        AxisObservation observation;
        observation.round = evidence.round;
        // Steps refer to the sherd's own position; converts them to the foot of the frame.
        Matrix4d to_foot = Matrix4d::Identity();
        to_foot.topRightCorner<2, 2>() = frame_.height(evidence.place) * Eigen::Matrix2d::Identity();
        if (sherds_[k].axis) {
            observation.information = to_foot.transpose() * evidence.information * to_foot;
            observation.target = observation.information * deviations_[k] - to_foot.transpose() * evidence.gradient;
        }
        const double shift = 1 / std::pow(options_.layout_shift * diagonal_, 2),
                     tilt = 1 / std::pow(options_.layout_angle * pi / 180, 2);
        observation.layout = to_foot.transpose() * Vector4d(shift, shift, tilt, tilt).asDiagonal() * to_foot;
        return observation;
    }

    /// Maximum likelihood of the common axis and of the tilt and offset of each sherd together. The own axis x of a sherd has
    /// information I about m, and the layout information P about the common axis c; with x eliminated, c has J = I - I (I +
    /// P)^-1 I about m.
    void refine_axis(const Axis& start) {
        const std::vector<std::size_t> indices = remaining();
        // The origin of the frame: near the centroid of all.
        Vector3d middle = Vector3d::Zero();
        double area = 0;
        const AxisFrame start_frame = frame_of(start);
        CGAL::Bbox_3 box;
        for (const std::size_t k : indices) {
            middle += witnesses_[k]->area() * witnesses_[k]->centroid();
            area += witnesses_[k]->area();
            if (indices.size() > 2 &&
                witnesses_[k]->at({start_frame.foot, start_frame.up, start_frame.u, start_frame.w}).round < min_round)
                continue;
            for (const Vertex v : sherds_[k].fragment->mesh.vertices()) box += sherds_[k].fragment->mesh.point(v).bbox();
        }
        middle /= area;
        diagonal_ = std::sqrt(std::pow(box.xmax() - box.xmin(), 2) + std::pow(box.ymax() - box.ymin(), 2) +
                              std::pow(box.zmax() - box.zmin(), 2));
        frame_ = start_frame;
        frame_.foot += frame_.up * frame_.height(middle);
        common_.setZero();
        deviations_.assign(sherds_.size(), Vector4d::Zero());
        std::vector<AxisObservation> observations(sherds_.size());
        for (int round = 0; round < 20; ++round) {
            check_cancelled();
            parallel_for(indices.size(), 1, [&](std::size_t i) { observations[indices[i]] = observe(indices[i]); });
            Matrix4d information = Matrix4d::Zero();
            Vector4d sum = Vector4d::Zero();
            for (const std::size_t k : indices) {
                SherdOnProfile& sherd = result_.sherds[k];
                const AxisObservation& t = observations[k];
                const Matrix4d both = t.information + t.layout, gain = t.information * inverse(both);
                const Matrix4d marginal = t.information - gain * t.information;
                const Vector4d pull = t.target - gain * t.target;
                const Vector4d mean = solve_ldlt<4>(Matrix4d(t.information + 1e-6 * t.layout), t.target);
                sherd.disagreement = std::sqrt(std::max(0.0, mean.dot(pull)));
                const double robust = std::pow(1 + std::pow(sherd.disagreement / 3, 2), -2);
                contribution_[k] = robust * marginal;
                pulls_[k] = robust * pull;
                information += robust * marginal + 1e-9 * t.layout;
                sum += robust * pull;
            }
            const Vector4d step = solve_ldlt<4>(information, sum);
            if (!step.allFinite()) break;
            common_ += step;
            for (const std::size_t k : indices) {
                const AxisObservation& t = observations[k];
                deviations_[k] = solve_ldlt<4>(Matrix4d(t.information + t.layout), Vector4d(t.target - t.information * step));
                if (const double tilt = deviations_[k].tail<2>().norm(); tilt > 0.3) deviations_[k] *= 0.3 / tilt;
            }
            covariance_ = inverse(information);
            if (step.head<2>().norm() < 1e-7 * diagonal_ && step.tail<2>().norm() < 1e-7) break;
        }
        for (const std::size_t k : indices) {
            result_.sherds[k].weight = (covariance_ * contribution_[k]).trace() / 4;
            round_[k] = observations[k].round;
        }
        spread_ = indices.size() < 4 ? covariance_ : jackknife(indices);
    }

    /// Jackknife covariance of the common axis: needs no assumption on the accuracy of the layout.
    [[nodiscard]] Matrix4d jackknife(const std::vector<std::size_t>& indices) const {
        Matrix4d information = Matrix4d::Zero();
        Vector4d sum = Vector4d::Zero(), mean = Vector4d::Zero();
        for (const std::size_t k : indices) information += contribution_[k], sum += pulls_[k];
        std::vector<Vector4d> estimates;
        for (const std::size_t k : indices) {
            const Matrix4d rest = information - contribution_[k];
            estimates.push_back(solve_ldlt<4>(Matrix4d(rest + 1e-9 * information), Vector4d(sum - pulls_[k])));
            mean += estimates.back() / static_cast<double>(indices.size());
        }
        Matrix4d spread = Matrix4d::Zero();
        for (const Vector4d& estimate : estimates) spread += (estimate - mean) * (estimate - mean).transpose();
        return static_cast<double>(indices.size() - 1) / static_cast<double>(indices.size()) * spread;
    }

    static Matrix4d inverse(const Matrix4d& matrix) {
        Matrix4d result;
        for (int k = 0; k < 4; ++k) result.col(k) = solve_ldlt<4>(matrix, Vector4d(Vector4d::Unit(k)));
        return result;
    }

    /// Deviation of a sherd's own axis from the common axis.
    void measure_own(std::size_t k) {
        SherdOnProfile& sherd = result_.sherds[k];
        if (!sherd.axis.found) return;
        const AxisGuess common = line(common_);
        Vector3d direction = eigen(sherd.axis.direction);
        if (direction.dot(common.direction) < 0) direction = -direction;
        const Vector3d p = eigen(sherd.axis.point), middle = witnesses_[k]->centroid();
        const double across = std::max(0.05, direction.dot(common.direction));
        const Vector3d crossing = p + direction * ((middle - p).dot(common.direction) / across), offset = crossing - common.point;
        sherd.lean = 180 / pi * std::acos(std::min(1.0, direction.dot(common.direction)));
        sherd.aside = (offset - offset.dot(common.direction) * common.direction).norm();
    }

    /// Deviation of an own axis from the common one, relative to the limits: the linearised equations are valid near the common
    /// axis only and may miss a large deviation.
    [[nodiscard]] double axis_deviation(const SherdOnProfile& sherd) const {
        if (!sherd.axis.found) return 0;
        const double tilt = max_disagreement * options_.layout_angle + 3 * sherd.axis.figure("direction error")->value,
                     shift =
                         max_disagreement * options_.layout_shift * diagonal_ + 3 * sherd.axis.figure("diameter error")->value;
        return std::max(sherd.lean / tilt, sherd.aside / shift);
    }

    /// Drops the sherd that contradicts the others most; the axis is then estimated again.
    bool drop_one_that_disagrees() {
        const std::vector<std::size_t> indices = remaining();
        if (indices.size() < 2) return false;
        std::optional<std::size_t> worst;
        double max_deviation = 1;
        for (const std::size_t k : indices) {
            measure_own(k);
            if (!sherds_[k].axis) continue;
            const double deviation = std::max({result_.sherds[k].disagreement / max_disagreement,
                                               axis_deviation(result_.sherds[k]), round_[k] > 0 ? min_round / round_[k] : 1e300});
            if (deviation > max_deviation) worst = k, max_deviation = deviation;
        }
        if (!worst) return false;
        SherdOnProfile& sherd = result_.sherds[*worst];
        sherds_[*worst].contradicts = true;
        const std::string remedy = "place it as it was in the vessel, or leave it out";
        if (sherd.axis.found)
            leave_out(sherd,
                      fmt::format("has an axis that leans by {} degrees against that of the others and lies {} off it",
                                  digits(sherd.lean, 3), digits(sherd.aside, 3)),
                      remedy);
        else if (round_[*worst] < min_round)
            leave_out(
                sherd,
                fmt::format("is not round about the axis of the others ({} % of its area is); it has no axis of its own: {}",
                            digits(100 * round_[*worst], 2), sherd.axis.reason),
                remedy);
        else leave_out(sherd, "is round about another axis than the others", remedy);
        return true;
    }

    void finish() {
        const std::vector<std::size_t> indices = remaining();
        const AxisGuess common = line(common_);
        if (indices.size() == 1) {
            SherdOnProfile& sherd = result_.sherds[indices[0]];
            std::vector<bool> alone(sherds_.size(), false);
            alone[indices[0]] = true;
            const JoinedSherds single = joined(sherds_, alone);
            sherd.axis = revolution_axis(single.mesh, single.faces(), options_.axis).axis;
            if (!sherd.axis.found) {
                leave_out(sherd, "has no axis: " + sherd.axis.reason, "add sherds that cover more of the circumference");
                fail_all_left_out(result_);
            }
            result_.axis = sherd.axis;
            sherd.weight = 1;
            sherd.lean = sherd.aside = 0;
            result_.direction_error = sherd.axis.figure("direction error")->value;
            result_.place_error = sherd.axis.figure("diameter error")->value / 2;
            return;
        }
        const SymmetricEigen2 shifts(Eigen::Matrix2d(spread_.topLeftCorner<2, 2>())),
            tilts(Eigen::Matrix2d(spread_.bottomRightCorner<2, 2>()));
        result_.direction_error = std::min(90.0, 180 / pi * std::sqrt(std::max(0.0, tilts.eigenvalues()[1])));
        result_.place_error = std::sqrt(std::max(0.0, shifts.eigenvalues()[1]));
        if (SymmetricEigen2(Eigen::Matrix2d(covariance_.bottomRightCorner<2, 2>())).eigenvalues()[1] >
            std::pow(5 * pi / 180, 2)) {
            for (const std::size_t k : indices)
                leave_out(result_.sherds[k], "does not determine an axis, nor do all sherds together",
                          "add sherds that cover more of the circumference");
            fail_all_left_out(result_);
        }
        result_.axis.found = true;
        result_.axis.direction = vector_of(common.direction);
        result_.axis.point = point_of(common.point);
        for (const std::size_t k : indices) {
            measure_own(k);
            const AxisGuess sherd_axis = line(common_ + deviations_[k]);
            const auto foot = [&](const AxisGuess& axis) {
                return Vector3d(axis.point + axis.direction * (witnesses_[k]->centroid() - axis.point).dot(common.direction) /
                                                 axis.direction.dot(common.direction));
            };
            Motion& motion = sherds_[k].motion;
            motion.rotation = rotation_between(sherd_axis.direction, common.direction).toRotationMatrix();
            motion.translation = foot(common) - motion.rotation * foot(sherd_axis);
        }
    }

    std::vector<PlacedSherd>& sherds_;
    const RevolutionOptions& options_;
    RevolutionTemplate& result_;
    std::vector<std::unique_ptr<AxisEvidenceEvaluator>> witnesses_;
    AxisFrame frame_;
    double diagonal_ = 0;                 ///< of the sherds around the axis
    double median_size_ = 0;              ///< of the sherds: square roots of their areas
    Vector4d common_ = Vector4d::Zero();  ///< offset and tilt of the common axis relative to the frame
    std::vector<Vector4d> deviations_;    ///< of each sherd's axis relative to the common one
    std::vector<Matrix4d> contribution_ = std::vector<Matrix4d>(sherds_.size(), Matrix4d::Zero());
    std::vector<double> round_ = std::vector<double>(sherds_.size(), 0);
    std::vector<Vector4d> pulls_ = std::vector<Vector4d>(sherds_.size(), Vector4d::Zero());
    Matrix4d covariance_ = Matrix4d::Zero(), spread_ = Matrix4d::Zero();
};

}  // namespace

void find_common_axis(std::vector<PlacedSherd>& sherds, const RevolutionOptions& options, RevolutionTemplate& result) {
    AxisConsensus(sherds, options, result).run();
}

}  // namespace ostraka
