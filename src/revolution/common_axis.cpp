// Maximum likelihood estimate of the common axis of all sherds, and of the tilt and offset of each in the layout.
#include "stages.h"

#include "ostraka/axis/axis_evidence.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/dense.h"
#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace ostraka {

using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;

namespace {

/// Min share of a sherd's area that is rotationally symmetric about the common axis. Unknown fractures take up to half of the
/// area.
constexpr double least_round = 0.35;
/// Max disagreement of a sherd's axis with the others, in standard deviations.
constexpr double most_disagreement = 6;

class AxisConsensus {
public:
    AxisConsensus(std::vector<LaidSherd>& sherds, const RevolutionOptions& options, RevolutionTemplate& result)
        : sherds_(sherds), options_(options), result_(result) {}

    void run() {
        ask_each();
        drop_other_units();
        for (;;) {
            if (remaining().empty()) fail_all_left_out(result_);
            const std::optional<Axis> start = first_axis();
            if (!start) {
                for (const std::size_t k : remaining())
                    leave_out(result_.sherds[k], "has no axis: " + result_.sherds[k].axis.reason,
                              "give it together with sherds that show more of the turn");
                fail_all_left_out(result_);
            }
            settle(*start);
            if (!drop_one_that_disagrees()) break;
        }
        finish();
    }

private:
    /// The observation of one sherd, linearised at its current axis.
    struct Told {
        Matrix4d information = Matrix4d::Zero(), layout = Matrix4d::Zero();
        Vector4d target = Vector4d::Zero();  ///< information x axis, relative to the common axis
        double round = 0;
    };

    [[nodiscard]] std::vector<std::size_t> remaining() const {
        std::vector<std::size_t> list;
        for (std::size_t k = 0; k < sherds_.size(); ++k)
            if (result_.sherds[k].use != SherdUse::left_out) list.push_back(k);
        return list;
    }

    /// Estimates each sherd's own axis, and prepares its witness.
    void ask_each() {
        witnesses_.resize(sherds_.size());
        const std::vector<std::size_t> list = remaining();
        parallel_for(
            list.size(),
            [&](std::size_t i) {
                const std::size_t k = list[i];
                SherdOnProfile& one = result_.sherds[k];
                std::vector<bool> alone(sherds_.size(), false);
                alone[k] = true;
                const JoinedSherds own = joined(sherds_, alone);
                const std::vector<Index> faces = own.faces();
                double area = 0;
                for (const Index f : faces) area += face_area(own.mesh, Face(f));
                if (!(area > 0)) {
                    leave_out(one, faces.empty() ? "has no wall: all its faces are of the fracture" : "has no area",
                              "look at its annotations and its mesh ('mesh info')");
                    return;
                }
                witnesses_[k] = std::make_unique<AxisWitness>(own.mesh, faces, options_.axis);
                if (!witnesses_[k]->enough()) {
                    leave_out(one, "has " + std::to_string(faces.size()) + " faces, too few to tell",
                              "give a finer mesh ('mesh refine' adds faces, but no shape)");
                    return;
                }
                one.axis = rotation_axis(own.mesh, faces, options_.axis);
            },
            1);
    }

    Axis axis_of(const std::vector<std::size_t>& list) {
        std::vector<bool> take(sherds_.size(), false);
        for (const std::size_t k : list) take[k] = true;
        const JoinedSherds some = joined(sherds_, take);
        return rotation_axis(some.mesh, some.faces(), options_.axis);
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
                leave_out(result_.sherds[k], "is " + digits(size(k) / median_size_, 3) + " times as large as most",
                          "is it in another unit than the others? then scale it");
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
        const std::vector<std::size_t> list = remaining();
        std::vector<Axis> candidates;
        if (list.size() > 1) candidates.push_back(axis_of(list));
        for (const std::size_t k : list) candidates.push_back(result_.sherds[k].axis);
        std::optional<Axis> best;
        double most = 0, all = 0;
        for (const std::size_t k : list) all += vote(k);
        const auto consider = [&](const std::vector<Axis>& axes) {
            std::vector<double> scores(axes.size(), 0);
            parallel_for(
                axes.size(), [&](std::size_t i) { scores[i] = axes[i].found ? agreement(axes[i]) : 0; }, 1);
            for (std::size_t i = 0; i < axes.size(); ++i)
                if (axes[i].found && (!best || scores[i] > most)) best = axes[i], most = scores[i];
        };
        consider(candidates);
        const double enough = 0.4 * all;
        if (most > enough || list.size() < 3) return best;
        std::vector<std::size_t> largest = list;
        std::stable_sort(largest.begin(), largest.end(),
                         [&](std::size_t a, std::size_t b) { return witnesses_[a]->area() > witnesses_[b]->area(); });
        if (largest.size() > 8) largest.resize(8);
        std::vector<std::vector<std::size_t>> subsets;
        for (const std::size_t without : largest) {
            subsets.emplace_back();
            for (const std::size_t k : list)
                if (k != without) subsets.back().push_back(k);
        }
        for (std::size_t a = 0; a < largest.size(); ++a)
            for (std::size_t b = 0; b < a; ++b) subsets.push_back({largest[b], largest[a]});
        candidates.assign(subsets.size(), {});
        parallel_for(
            subsets.size(), [&](std::size_t i) { candidates[i] = axis_of(subsets[i]); }, 1);
        consider(candidates);
        return best;
    }

    [[nodiscard]] AxisGuess line(const Vector4d& at) const {
        const Vector3d up = (frame_.up + at[2] * frame_.u + at[3] * frame_.w).normalized();
        return {frame_.foot + at[0] * frame_.u + at[1] * frame_.w, up, frame_.u, frame_.w};
    }

    Told ask(std::size_t k) const {
        const AxisEvidence evidence = witnesses_[k]->at(line(common_ + own_[k]));
        Told told;
        told.round = evidence.round;
        // Steps refer to the sherd's own position; converts them to the foot of the frame.
        Matrix4d there = Matrix4d::Identity();
        there.topRightCorner<2, 2>() = frame_.height(evidence.place) * Eigen::Matrix2d::Identity();
        if (sherds_[k].axis) {
            told.information = there.transpose() * evidence.information * there;
            told.target = told.information * own_[k] - there.transpose() * evidence.gradient;
        }
        const double shift = 1 / std::pow(options_.layout_shift * diagonal_, 2),
                     tilt = 1 / std::pow(options_.layout_angle * pi / 180, 2);
        told.layout = there.transpose() * Vector4d(shift, shift, tilt, tilt).asDiagonal() * there;
        return told;
    }

    /// Maximum likelihood of the common axis and of the tilt and offset of each sherd together. The own axis x of a sherd has
    /// information I about m, and the layout information P about the common axis c; with x eliminated, c has J = I - I (I +
    /// P)^-1 I about m.
    void settle(const Axis& start) {
        const std::vector<std::size_t> list = remaining();
        // The origin of the frame: near the centroid of all.
        Vector3d middle = Vector3d::Zero();
        double area = 0;
        const AxisFrame about = frame_of(start);
        CGAL::Bbox_3 box;
        for (const std::size_t k : list) {
            middle += witnesses_[k]->area() * witnesses_[k]->centroid();
            area += witnesses_[k]->area();
            if (list.size() > 2 && witnesses_[k]->at({about.foot, about.up, about.u, about.w}).round < least_round) continue;
            for (const Vertex v : sherds_[k].fragment->mesh.vertices()) box += sherds_[k].fragment->mesh.point(v).bbox();
        }
        middle /= area;
        diagonal_ = std::sqrt(std::pow(box.xmax() - box.xmin(), 2) + std::pow(box.ymax() - box.ymin(), 2) +
                              std::pow(box.zmax() - box.zmin(), 2));
        frame_ = about;
        frame_.foot += frame_.up * frame_.height(middle);
        common_.setZero();
        own_.assign(sherds_.size(), Vector4d::Zero());
        std::vector<Told> told(sherds_.size());
        for (int round = 0; round < 20; ++round) {
            check_cancelled();
            parallel_for(
                list.size(), [&](std::size_t i) { told[list[i]] = ask(list[i]); }, 1);
            Matrix4d all = Matrix4d::Zero();
            Vector4d sum = Vector4d::Zero();
            for (const std::size_t k : list) {
                SherdOnProfile& one = result_.sherds[k];
                const Told& t = told[k];
                const Matrix4d both = t.information + t.layout, gain = t.information * inverse(both);
                const Matrix4d marginal = t.information - gain * t.information;
                const Vector4d pull = t.target - gain * t.target;
                const Vector4d mean = solve_ldlt<4>(Matrix4d(t.information + 1e-6 * t.layout), t.target);
                one.disagreement = std::sqrt(std::max(0.0, mean.dot(pull)));
                const double robust = std::pow(1 + std::pow(one.disagreement / 3, 2), -2);
                contribution_[k] = robust * marginal;
                pulls_[k] = robust * pull;
                all += robust * marginal + 1e-9 * t.layout;
                sum += robust * pull;
            }
            const Vector4d step = solve_ldlt<4>(all, sum);
            if (!step.allFinite()) break;
            common_ += step;
            for (const std::size_t k : list) {
                const Told& t = told[k];
                own_[k] = solve_ldlt<4>(Matrix4d(t.information + t.layout), Vector4d(t.target - t.information * step));
                if (const double tilt = own_[k].tail<2>().norm(); tilt > 0.3) own_[k] *= 0.3 / tilt;
            }
            covariance_ = inverse(all);
            if (step.head<2>().norm() < 1e-7 * diagonal_ && step.tail<2>().norm() < 1e-7) break;
        }
        for (const std::size_t k : list) {
            result_.sherds[k].weight = (covariance_ * contribution_[k]).trace() / 4;
            round_[k] = told[k].round;
        }
        spread_ = list.size() < 4 ? covariance_ : jackknife(list);
    }

    /// Jackknife covariance of the common axis: needs no assumption on the accuracy of the layout.
    [[nodiscard]] Matrix4d jackknife(const std::vector<std::size_t>& list) const {
        Matrix4d all = Matrix4d::Zero();
        Vector4d sum = Vector4d::Zero(), mean = Vector4d::Zero();
        for (const std::size_t k : list) all += contribution_[k], sum += pulls_[k];
        std::vector<Vector4d> without;
        for (const std::size_t k : list) {
            const Matrix4d rest = all - contribution_[k];
            without.push_back(solve_ldlt<4>(Matrix4d(rest + 1e-9 * all), Vector4d(sum - pulls_[k])));
            mean += without.back() / static_cast<double>(list.size());
        }
        Matrix4d spread = Matrix4d::Zero();
        for (const Vector4d& one : without) spread += (one - mean) * (one - mean).transpose();
        return static_cast<double>(list.size() - 1) / static_cast<double>(list.size()) * spread;
    }

    static Matrix4d inverse(const Matrix4d& matrix) {
        Matrix4d result;
        for (int k = 0; k < 4; ++k) result.col(k) = solve_ldlt<4>(matrix, Vector4d(Vector4d::Unit(k)));
        return result;
    }

    /// Deviation of a sherd's own axis from the common axis.
    void measure_own(std::size_t k) {
        SherdOnProfile& one = result_.sherds[k];
        if (!one.axis.found) return;
        const AxisGuess common = line(common_);
        Vector3d own = eigen(one.axis.direction);
        if (own.dot(common.direction) < 0) own = -own;
        const Vector3d p = eigen(one.axis.point), middle = witnesses_[k]->centroid();
        const double across = std::max(0.05, own.dot(common.direction));
        const Vector3d at = p + own * ((middle - p).dot(common.direction) / across), off = at - common.point;
        one.lean = 180 / pi * std::acos(std::min(1.0, own.dot(common.direction)));
        one.aside = (off - off.dot(common.direction) * common.direction).norm();
    }

    /// Deviation of an own axis from the common one, relative to the limits: the linearised equations are valid near the common
    /// axis only and may miss a large deviation.
    [[nodiscard]] double own_off(const SherdOnProfile& one) const {
        if (!one.axis.found) return 0;
        const double tilt = most_disagreement * options_.layout_angle + 3 * one.axis.figure("direction error")->value,
                     shift = most_disagreement * options_.layout_shift * diagonal_ + 3 * one.axis.figure("diameter error")->value;
        return std::max(one.lean / tilt, one.aside / shift);
    }

    /// Drops the sherd that contradicts the others most; the axis is then estimated again.
    bool drop_one_that_disagrees() {
        const std::vector<std::size_t> list = remaining();
        if (list.size() < 2) return false;
        std::optional<std::size_t> worst;
        double most = 1;
        for (const std::size_t k : list) {
            measure_own(k);
            if (!sherds_[k].axis) continue;
            const double off = std::max({result_.sherds[k].disagreement / most_disagreement, own_off(result_.sherds[k]),
                                         round_[k] > 0 ? least_round / round_[k] : 1e300});
            if (off > most) worst = k, most = off;
        }
        if (!worst) return false;
        SherdOnProfile& one = result_.sherds[*worst];
        sherds_[*worst].contradicts = true;
        const std::string remedy = "lay it as it was in the vessel, or leave it out";
        if (one.axis.found)
            leave_out(one,
                      "has an axis that leans by " + digits(one.lean, 3) + " degrees against that of the others and lies " +
                          digits(one.aside, 3) + " off it",
                      remedy);
        else if (round_[*worst] < least_round)
            leave_out(one,
                      "is not round about the axis of the others (" + digits(100 * round_[*worst], 2) +
                          " % of its area is); it has none of its own: " + one.axis.reason,
                      remedy);
        else leave_out(one, "is round about another line than the others", remedy);
        return true;
    }

    void finish() {
        const std::vector<std::size_t> list = remaining();
        const AxisGuess common = line(common_);
        if (list.size() == 1) {
            SherdOnProfile& one = result_.sherds[list[0]];
            if (!one.axis.found) {
                leave_out(one, "has no axis: " + one.axis.reason, "give it together with sherds that show more of the turn");
                fail_all_left_out(result_);
            }
            result_.axis = one.axis;
            one.weight = 1;
            one.lean = one.aside = 0;
            result_.direction_error = one.axis.figure("direction error")->value;
            result_.place_error = one.axis.figure("diameter error")->value / 2;
            return;
        }
        const SymmetricEigen2 shifts(Eigen::Matrix2d(spread_.topLeftCorner<2, 2>())),
            tilts(Eigen::Matrix2d(spread_.bottomRightCorner<2, 2>()));
        result_.direction_error = std::min(90.0, 180 / pi * std::sqrt(std::max(0.0, tilts.eigenvalues()[1])));
        result_.place_error = std::sqrt(std::max(0.0, shifts.eigenvalues()[1]));
        if (SymmetricEigen2(Eigen::Matrix2d(covariance_.bottomRightCorner<2, 2>())).eigenvalues()[1] >
            std::pow(5 * pi / 180, 2)) {
            for (const std::size_t k : list)
                leave_out(result_.sherds[k], "tells too little of an axis, and so do all together",
                          "give sherds that show more of the turn");
            fail_all_left_out(result_);
        }
        result_.axis.found = true;
        result_.axis.direction = vector_of(common.direction);
        result_.axis.point = point_of(common.point);
        for (const std::size_t k : list) {
            measure_own(k);
            const AxisGuess own = line(common_ + own_[k]);
            const auto foot = [&](const AxisGuess& axis) {
                return Vector3d(axis.point + axis.direction * (witnesses_[k]->centroid() - axis.point).dot(common.direction) /
                                                 axis.direction.dot(common.direction));
            };
            Motion& motion = sherds_[k].motion;
            motion.rotation = rotation_between(own.direction, common.direction).toRotationMatrix();
            motion.translation = foot(common) - motion.rotation * foot(own);
        }
    }

    std::vector<LaidSherd>& sherds_;
    const RevolutionOptions& options_;
    RevolutionTemplate& result_;
    std::vector<std::unique_ptr<AxisWitness>> witnesses_;
    AxisFrame frame_;
    double diagonal_ = 0;                 ///< of the sherds around the axis
    double median_size_ = 0;              ///< of the sherds: square roots of their areas
    Vector4d common_ = Vector4d::Zero();  ///< offset and tilt of the common axis relative to the frame
    std::vector<Vector4d> own_;           ///< of each sherd's axis relative to the common one
    std::vector<Matrix4d> contribution_ = std::vector<Matrix4d>(sherds_.size(), Matrix4d::Zero());
    std::vector<double> round_ = std::vector<double>(sherds_.size(), 0);
    std::vector<Vector4d> pulls_ = std::vector<Vector4d>(sherds_.size(), Vector4d::Zero());
    Matrix4d covariance_ = Matrix4d::Zero(), spread_ = Matrix4d::Zero();
};

}  // namespace

void find_common_axis(std::vector<LaidSherd>& sherds, const RevolutionOptions& options, RevolutionTemplate& result) {
    AxisConsensus(sherds, options, result).run();
}

}  // namespace ostraka
