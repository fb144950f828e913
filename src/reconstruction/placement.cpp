#include "ostraka/reconstruction/placement.h"
#include "ostraka/algebra/dense.h"

#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/stats/random.h"

#include <fmt/core.h>
#include <boost/algorithm/string/predicate.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

std::vector<LandmarkPair> common_landmarks(AnnotatedMeshView template_object, AnnotatedMeshView fragment,
                                           std::vector<std::string>* notes) {
    using Tags = std::map<std::string, std::vector<const Annotation*>>;
    const auto collect = [](const AnnotationSet& set) {
        Tags tags;
        for (const Annotation& annotation : set.annotations)
            if (annotation.type == AnnotationType::point && !annotation.points.empty() && !annotation.tag.empty())
                tags[annotation.tag].push_back(&annotation);
        return tags;
    };
    const Tags ours = collect(template_object.annotations), theirs = collect(fragment.annotations);
    const auto note = [&](const std::string& tag, const std::string& text) {
        if (notes != nullptr) notes->push_back(fmt::format("landmark '{}' {}", tag, text));
    };
    const auto several = [](const std::vector<const Annotation*>& annotations) {
        return std::any_of(annotations.begin(), annotations.end(),
                           [](const Annotation* annotation) { return annotation->points.size() > 1; });
    };
    std::vector<LandmarkPair> pairs;
    for (const auto& [tag, annotations] : theirs) {
        const auto entry = ours.find(tag);
        if (entry == ours.end()) {
            const auto similar = std::find_if(ours.begin(), ours.end(), [&tag = tag](const auto& candidate) {
                return boost::algorithm::iequals(candidate.first, tag);
            });
            note(tag, similar == ours.end()
                          ? "is not on the template"
                          : fmt::format("is not on the template, which has '{}': upper and lower case are distinguished",
                                        similar->first));
        } else if (annotations.size() > 1 || entry->second.size() > 1) {
            note(tag, "occurs more than once and is not used, since it is ambiguous");
        } else if (several(annotations) || several(entry->second)) {
            note(tag, "has several points and is not used: give it one point");
        } else {
            pairs.push_back({tag, eigen(template_object.mesh.point(Vertex(entry->second.front()->points.front()))),
                             eigen(fragment.mesh.point(Vertex(annotations.front()->points.front()))),
                             entry->second.front()->points.front()});
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
                fail_input(fmt::format("landmark '{}'", pair.name), "its position is not finite", "check both files");
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
    void find_outliers() {
        const std::size_t n = pairs_.size();
        if (n < 5) return;
        // Shapes differ from their template without error: a few landmarks may be wrong, not half of them.
        const std::size_t max_outliers = std::max<std::size_t>(1, n / 6), quantile = n - max_outliers;
        double best = -1;
        Motion chosen;
        for_triples(n, [&](const std::array<std::size_t, 3>& triple) {
            std::fill(used.begin(), used.end(), false);
            for (const std::size_t i : triple) used[i] = true;
            if (flatness() < options_.collinear) return;
            const Motion motion = similarity();
            if (!(motion.scale > 0)) return;
            std::vector<double> distances;
            for (std::size_t i = 0; i < n; ++i) distances.push_back(distance(motion, i) / motion.scale);
            std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(quantile - 1), distances.end());
            if (best < 0 || distances[quantile - 1] < best) best = distances[quantile - 1], chosen = motion;
        });
        std::fill(used.begin(), used.end(), true);
        if (best < 0) return;
        // A wrong landmark is off by far more than those that agree.
        const double spread = std::sqrt(moments().spread_from / static_cast<double>(n));
        for (int round = 0; round < 10; ++round) {
            check_cancelled();
            const std::vector<bool> before = used;
            std::vector<double> distances;
            for (std::size_t i = 0; i < n; ++i) distances.push_back(distance(chosen, i) / chosen.scale);
            std::vector<double> sorted = distances;
            std::sort(sorted.begin(), sorted.end());
            double squares = 0;
            for (std::size_t i = 0; i < quantile; ++i) squares += sorted[i] * sorted[i];
            const double limit = std::max(4 * std::sqrt(squares / static_cast<double>(quantile)), options_.outlier * spread);
            for (std::size_t i = 0; i < n; ++i) used[i] = distances[i] <= limit || distances[i] <= sorted[quantile - 1];
            if (used == before && round > 0) break;
            chosen = similarity();
        }
    }

    /// Pairs of landmarks, at least one of them left out, that would fit each other's positions.
    [[nodiscard]] std::vector<std::pair<std::string, std::string>> swapped() const {
        const Motion motion = similarity();
        const auto separation = [&](std::size_t i, std::size_t j) {
            return (motion(pairs_[i].on_template) - pairs_[j].on_fragment).norm();
        };
        std::vector<std::pair<std::string, std::string>> exchanged;
        for (std::size_t i = 0; i < pairs_.size(); ++i)
            for (std::size_t j = i + 1; j < pairs_.size(); ++j)
                if ((!used[i] || !used[j]) &&
                    3 * std::hypot(separation(i, j), separation(j, i)) < std::hypot(separation(i, i), separation(j, j)))
                    exchanged.emplace_back(pairs_[i].name, pairs_[j].name);
        return exchanged;
    }

private:
    template <class Visit>
    static void for_triples(std::size_t n, Visit&& visit) {
        const double triples = static_cast<double>(n) * static_cast<double>(n - 1) * static_cast<double>(n - 2) / 6;
        if (triples <= static_cast<double>(max_triples)) {
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
    std::string names;
    for (const LandmarkPair& pair : pairs) names += (names.empty() ? "'" : ", '") + pair.name + "'";
    return names;
}

}  // namespace

CommonPlacement place_by_landmarks(const std::vector<std::vector<LandmarkPair>>& pairs, const PlacementOptions& options) {
    check_options(options, "placement");
    CommonPlacement placement;
    std::vector<Landmarks> landmark_sets;
    for (const auto& common : pairs) {
        FragmentPlacement fragment;
        landmark_sets.emplace_back(common, options);
        Landmarks& landmarks = landmark_sets.back();
        if (common.size() < 3) {
            fragment.problem = fmt::format(
                "has {} landmark{} in common with the template{}: give three or more points the tags that they have on the "
                "template, or let the pose be searched for",
                common.size(), common.size() == 1 ? "" : "s", common.empty() ? "" : " (" + names_of(common) + ")");
        } else {
            landmarks.find_outliers();
            const auto count = static_cast<std::size_t>(std::count(landmarks.used.begin(), landmarks.used.end(), true));
            if (count < 3) {
                std::fill(landmarks.used.begin(), landmarks.used.end(), true);
                fragment.problem = fmt::format("no three of its landmarks ({}) agree on a pose: check their tags and positions",
                                               names_of(common));
            } else if (landmarks.flatness() < options.collinear) {
                fragment.problem = fmt::format(
                    "its landmarks ({}) lie on a line, so the rotation about it is undetermined: add one beside the line",
                    names_of(common));
            } else {
                const Motion proper = landmarks.similarity(), unrestricted = landmarks.similarity(false);
                fragment.own_scale = proper.scale;
                const double spread = landmarks.moments().spread_to / static_cast<double>(count);
                const double proper_error = landmarks.mean_square(proper), mirrored_error = landmarks.mean_square(unrestricted);
                // Three landmarks fit their mirror image equally well, nearly flat configurations nearly so.
                fragment.mirrored = count > 3 && unrestricted.rotation.determinant() < 0 && proper_error > 1e-4 * spread &&
                                    mirrored_error < proper_error / 9;
                if (fragment.mirrored)
                    fragment.problem = fmt::format(
                        "its mirror image fits the template, but the fragment itself does not (residual {} against {}): was it "
                        "mirrored by the scanner's software, or are left and right exchanged in its tags?",
                        digits(std::sqrt(mirrored_error), 3), digits(std::sqrt(proper_error), 3));
            }
        }
        placement.fragments.push_back(std::move(fragment));
    }

    // Finds fragments in another unit than most.
    std::vector<double> scales;
    for (const auto& fragment : placement.fragments)
        if (fragment.problem.empty()) scales.push_back(fragment.own_scale);
    if (scales.size() > 1) {
        std::sort(scales.begin(), scales.end());
        const double middle = scales[(scales.size() - 1) / 2];
        for (auto& fragment : placement.fragments) {
            if (!fragment.problem.empty()) continue;
            const double ratio = fragment.own_scale / middle;
            if (std::max(ratio, 1 / ratio) > options.unit_ratio)
                fragment.problem = fmt::format("is {} times {} than the other fragments suggest: is it in another unit?",
                                               digits(std::max(ratio, 1 / ratio), 3), ratio > 1 ? "larger" : "smaller");
        }
    }

    // One scale for all: rotations first, which do not depend on it.
    double across = 0, squares = 0;
    std::vector<Matrix3d> rotations(pairs.size());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        if (!placement.fragments[k].problem.empty()) continue;
        const Landmarks::Moments m = landmark_sets[k].moments();
        rotations[k] = Landmarks::rotation(m.cross, true);  // of the fragment onto the template
        across += (rotations[k].transpose() * m.cross).trace();
        squares += m.spread_from;
    }
    if (squares > 0) placement.scale = across / squares;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        FragmentPlacement& fragment = placement.fragments[k];
        if (!fragment.problem.empty()) {
            for (const LandmarkPair& pair : pairs[k]) fragment.landmarks.push_back({pair.name, 0, false});
            continue;
        }
        const Landmarks::Moments m = landmark_sets[k].moments();
        fragment.pose.rotation = rotations[k];
        fragment.pose.translation = placement.scale * m.from - rotations[k] * m.to;
        fragment.swapped = landmark_sets[k].swapped();
        double sum = 0;
        for (std::size_t i = 0; i < pairs[k].size(); ++i) {
            const double distance = (fragment.pose(pairs[k][i].on_fragment) - placement.scale * pairs[k][i].on_template).norm();
            fragment.landmarks.push_back({pairs[k][i].name, distance, landmark_sets[k].used[i]});
            if (landmark_sets[k].used[i]) sum += distance * distance;
        }
        fragment.residual = std::sqrt(sum / static_cast<double>(m.count));
    }
    return placement;
}

void PlacementOptions::declare_options(OptionList& list) {
    list("outlier", outlier, "minimum residual of a possible outlier, as a share of the spread of the template's landmarks",
         Range{0, 1});
    list("unit-ratio", unit_ratio, "ratio of scales above which two fragments are assumed to have different units",
         Range{1, 1e6});
    list("collinear", collinear, "maximum ratio of second to first principal extent of landmarks that count as collinear",
         Range{0, 1});
}

}  // namespace ostraka
