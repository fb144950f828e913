#include "ostraka/reconstruction/placement.h"
#include "ostraka/core/dense.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/stats/random.h"

#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::vector<LandmarkPair> common_landmarks(const Mesh& template_mesh, const AnnotationSet& of_template, const Mesh& fragment,
                                           const AnnotationSet& of_fragment, std::vector<std::string>* notes) {
    using Tags = std::map<std::string, std::vector<const Annotation*>>;
    const auto collect = [](const AnnotationSet& set) {
        Tags tags;
        for (const Annotation& annotation : set.annotations)
            if (annotation.type == AnnotationType::point && !annotation.points.empty() && !annotation.tag.empty())
                tags[annotation.tag].push_back(&annotation);
        return tags;
    };
    const Tags ours = collect(of_template), theirs = collect(of_fragment);
    const auto note = [&](const std::string& tag, const std::string& text) {
        if (notes != nullptr) notes->push_back("landmark '" + tag + "' " + text);
    };
    const auto several = [](const std::vector<const Annotation*>& list) {
        return std::any_of(list.begin(), list.end(), [](const Annotation* one) { return one->points.size() > 1; });
    };
    std::vector<LandmarkPair> pairs;
    for (const auto& [tag, list] : theirs) {
        const auto found = ours.find(tag);
        if (found == ours.end()) {
            const auto alike = std::find_if(ours.begin(), ours.end(),
                                            [&tag = tag](const auto& one) { return boost::algorithm::iequals(one.first, tag); });
            note(tag, "is not on the template" +
                          (alike == ours.end() ? std::string()
                                               : ", which has '" + alike->first + "': small and large letters are told apart"));
        } else if (list.size() > 1 || found->second.size() > 1) {
            note(tag, "is there more than once, and not used: which is which is not known");
        } else if (several(list) || several(found->second)) {
            note(tag, "has several points, and is not used: give it one");
        } else {
            pairs.push_back({tag, eigen(template_mesh.point(Vertex(found->second.front()->points.front()))),
                             eigen(fragment.point(Vertex(list.front()->points.front()))), found->second.front()->points.front()});
        }
    }
    return pairs;
}

bool CommonPlacement::any() const {
    return std::any_of(fragments.begin(), fragments.end(), [](const auto& fragment) { return fragment.problem.empty(); });
}

namespace {

constexpr std::size_t max_triples = 4000;

/// The landmarks of one fragment.
class Landmarks {
public:
    Landmarks(const std::vector<LandmarkPair>& pairs, const PlacementOptions& options) : pairs_(pairs), options_(options) {
        used.assign(pairs.size(), true);
        for (const LandmarkPair& pair : pairs)
            if (!pair.on_template.allFinite() || !pair.on_fragment.allFinite())
                fail_input("landmark '" + pair.name + "'", "its place is not finite", "look at both files");
    }

    std::vector<bool> used;

    /// Centroids, and the cross-covariance of the template's landmarks with the fragment's.
    struct Moments {
        Vector3d from = Vector3d::Zero(), to = Vector3d::Zero();
        Matrix3d cross = Matrix3d::Zero();  ///< sum of (p - from) (f - to)^T
        double spread_from = 0, spread_to = 0;
        std::size_t count = 0;
    };
    [[nodiscard]] Moments moments() const {
        Moments m;
        for (std::size_t i = 0; i < pairs_.size(); ++i) {
            if (!used[i]) continue;
            m.from += pairs_[i].on_template;
            m.to += pairs_[i].on_fragment;
            ++m.count;
        }
        if (m.count == 0) return m;
        m.from /= static_cast<double>(m.count);
        m.to /= static_cast<double>(m.count);
        for (std::size_t i = 0; i < pairs_.size(); ++i) {
            if (!used[i]) continue;
            const Vector3d p = pairs_[i].on_template - m.from, f = pairs_[i].on_fragment - m.to;
            m.cross += p * f.transpose();
            m.spread_from += p.squaredNorm();
            m.spread_to += f.squaredNorm();
        }
        return m;
    }

    /// The similarity from the template to the fragment, from the landmarks used; without `proper` possibly a reflection.
    [[nodiscard]] Motion similarity(bool proper = true) const {
        const Moments m = moments();
        Motion motion;
        motion.rotation = rotation(m.cross.transpose(), proper);
        motion.scale = m.spread_from > 0 ? (motion.rotation * m.cross).trace() / m.spread_from : 1;
        motion.translation = m.to - motion.scale * (motion.rotation * m.from);
        return motion;
    }

    /// U diag(1, 1, d) V^T of a covariance of (to, from).
    static Matrix3d rotation(const Matrix3d& covariance, bool proper) {
        const Svd3 svd(covariance);
        Vector3d signs(1, 1, 1);
        if (proper && svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
        return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
    }

    [[nodiscard]] double distance(const Motion& motion, std::size_t i) const {
        return (motion(pairs_[i].on_template) - pairs_[i].on_fragment).norm();
    }
    [[nodiscard]] double mean_square(const Motion& motion) const {
        double sum = 0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < pairs_.size(); ++i)
            if (used[i]) sum += std::pow(distance(motion, i), 2), ++count;
        return count > 0 ? sum / static_cast<double>(count) : 0;
    }

    /// Ratio of second to first extent of the landmarks used, the smaller of both sides.
    [[nodiscard]] double flatness() const {
        double minimum = 1;
        for (const bool ours : {true, false}) {
            const Moments m = moments();
            Matrix3d second = Matrix3d::Zero();
            for (std::size_t i = 0; i < pairs_.size(); ++i) {
                if (!used[i]) continue;
                const Vector3d p = ours ? Vector3d(pairs_[i].on_template - m.from) : Vector3d(pairs_[i].on_fragment - m.to);
                second += p * p.transpose();
            }
            const Vector3d extents = symmetric_eigenvalues(second);
            minimum = std::min(minimum, extents[2] > 0 ? std::sqrt(std::max(0.0, extents[1]) / extents[2]) : 0.0);
        }
        return minimum;
    }

    /// Sets `used` from the similarity through three landmarks that explains most of the others.
    void find_wrong() {
        const std::size_t n = pairs_.size();
        if (n < 5) return;
        // Shapes differ from their template without error: a few landmarks may be wrong, not half of them.
        const std::size_t max_wrong = std::max<std::size_t>(1, n / 6), quantile = n - max_wrong;
        double best = -1;
        Motion chosen;
        for_triples(n, [&](const std::array<std::size_t, 3>& triple) {
            std::fill(used.begin(), used.end(), false);
            for (const std::size_t i : triple) used[i] = true;
            if (flatness() < options_.collinear) return;
            const Motion motion = similarity();
            if (!(motion.scale > 0)) return;
            std::vector<double> off;
            for (std::size_t i = 0; i < n; ++i) off.push_back(distance(motion, i) / motion.scale);
            std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(quantile - 1), off.end());
            if (best < 0 || off[quantile - 1] < best) best = off[quantile - 1], chosen = motion;
        });
        std::fill(used.begin(), used.end(), true);
        if (best < 0) return;
        // A wrong landmark is off by far more than those that agree.
        const double spread = std::sqrt(moments().spread_from / static_cast<double>(n));
        for (int round = 0; round < 10; ++round) {
            check_cancelled();
            const std::vector<bool> before = used;
            std::vector<double> off;
            for (std::size_t i = 0; i < n; ++i) off.push_back(distance(chosen, i) / chosen.scale);
            std::vector<double> sorted = off;
            std::sort(sorted.begin(), sorted.end());
            double squares = 0;
            for (std::size_t i = 0; i < quantile; ++i) squares += sorted[i] * sorted[i];
            const double limit = std::max(4 * std::sqrt(squares / static_cast<double>(quantile)), options_.outlier * spread);
            for (std::size_t i = 0; i < n; ++i) used[i] = off[i] <= limit || off[i] <= sorted[quantile - 1];
            if (used == before && round > 0) break;
            chosen = similarity();
        }
    }

    /// Pairs of landmarks, at least one of them left out, that would fit each other's positions.
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> swapped() const {
        const Motion motion = similarity();
        const auto off = [&](std::size_t i, std::size_t j) {
            return (motion(pairs_[i].on_template) - pairs_[j].on_fragment).norm();
        };
        std::vector<std::pair<std::string, std::string>> found;
        for (std::size_t i = 0; i < pairs_.size(); ++i)
            for (std::size_t j = i + 1; j < pairs_.size(); ++j)
                if ((!used[i] || !used[j]) && 3 * std::hypot(off(i, j), off(j, i)) < std::hypot(off(i, i), off(j, j)))
                    found.emplace_back(pairs_[i].name, pairs_[j].name);
        return found;
    }

private:
    template <class Visit>
    static void for_triples(std::size_t n, Visit&& visit) {
        const double all = static_cast<double>(n) * static_cast<double>(n - 1) * static_cast<double>(n - 2) / 6;
        if (all <= static_cast<double>(max_triples)) {
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t j = i + 1; j < n; ++j)
                    for (std::size_t k = j + 1; k < n; ++k) visit({i, j, k});
            return;
        }
        Random random(1, n);
        for (std::size_t drawn = 0; drawn < max_triples;) {
            const std::array<std::size_t, 3> triple{random.below(n), random.below(n), random.below(n)};
            if (triple[0] == triple[1] || triple[1] == triple[2] || triple[0] == triple[2]) continue;
            visit(triple);
            ++drawn;
        }
    }

    const std::vector<LandmarkPair>& pairs_;
    const PlacementOptions& options_;
};

/// The names, for a message.
std::string names_of(const std::vector<LandmarkPair>& pairs) {
    std::string list;
    for (const LandmarkPair& pair : pairs) list += (list.empty() ? "'" : ", '") + pair.name + "'";
    return list;
}

}  // namespace

CommonPlacement place_by_landmarks(const std::vector<std::vector<LandmarkPair>>& pairs, const PlacementOptions& options) {
    check_options(options, "placement");
    CommonPlacement placement;
    std::vector<Landmarks> all;
    for (const auto& list : pairs) {
        FragmentPlacement one;
        all.emplace_back(list, options);
        Landmarks& landmarks = all.back();
        if (list.size() < 3) {
            one.problem = "has " + std::to_string(list.size()) + (list.size() == 1 ? " landmark" : " landmarks") +
                          " in common with the template" + (list.empty() ? "" : " (" + names_of(list) + ")") +
                          ": give three or more points the tags that they have on the template, or let poses be searched for";
        } else {
            landmarks.find_wrong();
            const auto count = static_cast<std::size_t>(std::count(landmarks.used.begin(), landmarks.used.end(), true));
            if (count < 3) {
                std::fill(landmarks.used.begin(), landmarks.used.end(), true);
                one.problem = "no three of its landmarks (" + names_of(list) + ") agree on a pose: look at their tags and places";
            } else if (landmarks.flatness() < options.collinear) {
                one.problem = "its landmarks (" + names_of(list) +
                              ") lie on a line, which leaves the turn about it open: add one beside the line";
            } else {
                const Motion proper = landmarks.similarity(), any = landmarks.similarity(false);
                one.own_scale = proper.scale;
                const double spread = landmarks.moments().spread_to / static_cast<double>(count);
                const double with = landmarks.mean_square(proper), without = landmarks.mean_square(any);
                // Three landmarks fit their mirror image equally well, nearly flat configurations nearly so.
                one.mirrored = count > 3 && any.rotation.determinant() < 0 && with > 1e-4 * spread && without < with / 9;
                if (one.mirrored)
                    one.problem = "its mirror image fits the template, and itself it does not (residual " +
                                  digits(std::sqrt(without), 3) + " against " + digits(std::sqrt(with), 3) +
                                  "): was it mirrored by the scanner's program, or are left and right mixed up in its tags?";
            }
        }
        placement.fragments.push_back(std::move(one));
    }

    // Finds fragments in another unit than most.
    std::vector<double> scales;
    for (const auto& one : placement.fragments)
        if (one.problem.empty()) scales.push_back(one.own_scale);
    if (scales.size() > 1) {
        std::sort(scales.begin(), scales.end());
        const double middle = scales[(scales.size() - 1) / 2];
        for (auto& one : placement.fragments) {
            if (!one.problem.empty()) continue;
            const double ratio = one.own_scale / middle;
            if (std::max(ratio, 1 / ratio) > options.unit_ratio)
                one.problem = "is " + digits(std::max(ratio, 1 / ratio), 3) + " times " + (ratio > 1 ? "larger" : "smaller") +
                              " than the others would have it: is it in another unit?";
        }
    }

    // One scale for all: rotations first, which do not depend on it.
    double across = 0, squares = 0;
    std::vector<Matrix3d> rotations(pairs.size());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        if (!placement.fragments[k].problem.empty()) continue;
        const Landmarks::Moments m = all[k].moments();
        rotations[k] = Landmarks::rotation(m.cross, true);  // of the fragment onto the template
        across += (rotations[k].transpose() * m.cross).trace();
        squares += m.spread_from;
    }
    if (squares > 0) placement.scale = across / squares;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        FragmentPlacement& one = placement.fragments[k];
        if (!one.problem.empty()) {
            for (const LandmarkPair& pair : pairs[k]) one.landmarks.push_back({pair.name, 0, false});
            continue;
        }
        const Landmarks::Moments m = all[k].moments();
        one.pose.rotation = rotations[k];
        one.pose.translation = placement.scale * m.from - rotations[k] * m.to;
        one.swapped = all[k].swapped();
        double sum = 0;
        for (std::size_t i = 0; i < pairs[k].size(); ++i) {
            const double off = (one.pose(pairs[k][i].on_fragment) - placement.scale * pairs[k][i].on_template).norm();
            one.landmarks.push_back({pairs[k][i].name, off, all[k].used[i]});
            if (all[k].used[i]) sum += off * off;
        }
        one.residual = std::sqrt(sum / static_cast<double>(m.count));
    }
    return placement;
}

void PlacementOptions::describe(OptionList& visit) {
    visit("outlier", outlier,
          "a landmark whose residual exceeds this share of the spread of the template's landmarks is a possible outlier",
          Range{0, 1});
    visit("unit-ratio", unit_ratio, "fragments whose scales differ by more than this factor are taken to have different units",
          Range{1, 1e6});
    visit("collinear", collinear, "landmarks are collinear if their second extent is below this share of the first", Range{0, 1});
}

}  // namespace ostraka
