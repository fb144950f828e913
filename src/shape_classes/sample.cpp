#include "ostraka/shape_classes/sample.h"

#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/with_points.h"
#include "ostraka/io/diagnose.h"
#include "ostraka/semantic/deform.h"
#include "ostraka/stats/random.h"
#include "shape_classes/parts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>

namespace ostraka {

namespace {

using Pairs = std::vector<std::pair<Index, Index>>;

Pairs crossings(const Mesh& mesh) { return self_intersections(to_soup(mesh)).pairs; }

/// 1 at the given vertices, decreasing smoothly to 0 at distance `fading_length` along edges.
std::vector<double> fading(const Mesh& mesh, const std::vector<Index>& start_vertices, double fading_length) {
    std::vector<double> distance(mesh.number_of_vertices(), std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const Index v : start_vertices) distance[v] = 0, queue.emplace(0, v);
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (d > distance[v] || d > fading_length || mesh.is_isolated(Vertex(v))) continue;
        for (const Halfedge h : mesh.halfedges_around_target(mesh.halfedge(Vertex(v)))) {
            const Index n = mesh.source(h).idx();
            const double next = d + (eigen(mesh.point(Vertex(n))) - eigen(mesh.point(Vertex(v)))).norm();
            if (next < distance[n]) distance[n] = next, queue.emplace(next, n);
        }
    }
    for (double& d : distance) {
        const double t = std::clamp(1 - d / fading_length, 0.0, 1.0);
        d = t * t * (3 - 2 * t);
    }
    return distance;
}

class Sampler {
public:
    Sampler(const ShapeClass& learnt, const ClassTemplate& class_template, const SampleOptions& options)
        : learnt_(learnt),
          class_template_(class_template),
          options_(options),
          diagonal_(box_diagonal(class_template.mesh)),
          template_crossings_(crossings(class_template.mesh)) {
        frame_ = landmarks_of({class_template.mesh.points().begin(), class_template.mesh.points().end()});
        for (const Relationship& relationship : class_template.graph.relationships)
            constrained_ = constrained_ || relationship.is_constraint;
        for (const Annotation& annotation : class_template.annotations.annotations)
            if (is_part(class_template.mesh, annotation)) parts_.push_back(&annotation);
        if (options.by == SampleOptions::Way::modes && learnt.modes.variances.empty())
            fail_input("class", "has no modes of variation", "learn it from at least two different members, or use --by edits");
        if (options.by == SampleOptions::Way::edits && parts_.empty())
            fail_input("template", "has no region that could be edited as a part", "annotate parts, or use --by modes");
    }

    Sampling run() {
        Sampling result;
        result.of_members = learnt_.diversity;
        const auto maximum = static_cast<std::size_t>(options_.count) * static_cast<std::size_t>(options_.attempts);
        std::vector<Landmarks> shapes;
        while (result.samples.size() < static_cast<std::size_t>(options_.count) && result.tried < maximum) {
            Random random(options_.seed, result.tried++);
            ClassSample sample;
            Landmarks shape = options_.by == SampleOptions::Way::modes ? by_modes(random, sample) : by_edits(random, sample);
            if (!keep(shape, sample, result)) continue;
            shapes.push_back(landmarks_of(sample.points));
            result.samples.push_back(std::move(sample));
        }
        result.diversity = mean_distance(learnt_.modes, shapes);
        return result;
    }

private:
    Landmarks sized(Landmarks shape, Random& random) const {
        if (learnt_.sizes) return shape;
        // A size drawn between the members' sizes, by linear interpolation of the sorted sizes.
        auto sizes = learnt_.modes.centroid_sizes;
        std::sort(sizes.begin(), sizes.end());
        const double at = random.uniform() * static_cast<double>(sizes.size() - 1);
        const auto i = static_cast<std::size_t>(at);
        const double size =
            i + 1 < sizes.size() ? sizes[i] + (at - static_cast<double>(i)) * (sizes[i + 1] - sizes[i]) : sizes[i];
        return shape * (size / learnt_.modes.mean_size);
    }

    Landmarks by_modes(Random& random, ClassSample& sample) const {
        for (std::size_t k = 0; k < learnt_.modes.variances.size(); ++k) {
            const auto column = learnt_.modes.coefficients.col(static_cast<Eigen::Index>(k));
            const double low = options_.spread * column.minCoeff(), high = options_.spread * column.maxCoeff();
            const double deviation = std::sqrt(learnt_.modes.variances[k]);
            double b = 0;
            int draws = 0;
            do b = random.normal(0, deviation);
            while ((b < low || b > high) && ++draws < 100);
            sample.coefficients.push_back(std::clamp(b, low, high));
        }
        return sized(shape_of(learnt_.modes, sample.coefficients), random);
    }

    Landmarks by_edits(Random& random, ClassSample& sample) const {
        Landmarks shape = learnt_.modes.mean;
        const std::size_t edits = 1 + random.below(3);
        for (std::size_t e = 0; e < edits; ++e) {
            const Annotation& part = *parts_[random.below(parts_.size())];
            const std::vector<Index> vertices = touched_vertices(class_template_.mesh, part);
            const double factor = std::exp(random.normal(0, options_.edit));
            Vector3d axis(random.normal(), random.normal(), random.normal());
            const bool scale = random.uniform() < 0.5;
            axis.normalize();
            Vector3d middle = Vector3d::Zero();
            for (const Index v : vertices)
                middle += shape.row(static_cast<Eigen::Index>(v)).transpose() / static_cast<double>(vertices.size());
            const auto weights = fading(class_template_.mesh, vertices, 0.1 * diagonal_);
            for (Eigen::Index i = 0; i < shape.rows(); ++i) {
                const Vector3d lever = shape.row(i).transpose() - middle;
                const Vector3d move = (factor - 1) * (scale ? lever : Vector3d(axis.dot(lever) * axis));
                shape.row(i) += weights[static_cast<std::size_t>(i)] * move.transpose();
            }
            sample.edits.push_back(part.tag + (scale ? " scaled by " : " stretched by ") + digits(factor, 4));
        }
        return sized(shape, random);
    }

    /// Restores the constraints and tests whether the shape is accepted.
    bool keep(const Landmarks& shape, ClassSample& sample, Sampling& result) {
        const auto reject = [&](std::size_t& count, const std::string& why) {
            if (count++ == 0) result.examples.push_back(why);
            return false;
        };
        sample.points = points_of(shape);
        if (constrained_) {
            // Solved in the frame of the template, at its size unless sizes count.
            const double factor = learnt_.sizes ? 1 : centroid_size(frame_) / centroid_size(shape);
            const SimilarityMap to_frame = procrustes(factor * shape, frame_);
            const std::vector<Point> start = points_of(to_frame.apply(factor * shape));
            DeformOptions deform_options;
            deform_options.conflicts = 0;
            const DeformResult restored = restore_constraints(class_template_, class_template_.graph, start,
                                                              std::vector<bool>(start.size(), false), deform_options);
            for (std::size_t i = 0; i < start.size(); ++i)
                sample.moved = std::max(sample.moved, (eigen(restored.points[i]) - eigen(start[i])).norm() / diagonal_);
            for (const ConstraintReport& report : restored.constraints)
                if (report.used && report.verdict != Verdict::holds)
                    return reject(result.by_constraints, fmt::format("constraint {} ({}) does not hold{}", report.id, report.type,
                                                                     report.text.empty() ? "" : ": " + report.text));
            const Landmarks restored_landmarks = landmarks_of(restored.points).rowwise() - to_frame.translation.transpose();
            sample.points = points_of(restored_landmarks * to_frame.rotation / factor);
        }
        LearntMember member;
        member.fit.points = sample.points;
        member.quantities = measure_quantities(class_template_, sample.points, learnt_.sizes);
        const ClassAnswer class_answer = compare_with(learnt_, member);
        if (!class_answer.rejecting_checks.empty()) return reject(result.by_ranges, class_answer.reasons().front());
        const Mesh mesh = with_points(class_template_.mesh, sample.points);
        for (const auto& pair : crossings(mesh))
            if (!std::binary_search(template_crossings_.begin(), template_crossings_.end(), pair))
                return reject(result.by_intersections, fmt::format("faces {} and {} cross", pair.first, pair.second));
        return true;
    }

    const ShapeClass& learnt_;
    const ClassTemplate& class_template_;
    const SampleOptions& options_;
    double diagonal_;
    Pairs template_crossings_;
    Landmarks frame_;
    bool constrained_ = false;
    std::vector<const Annotation*> parts_;
};

}  // namespace

Sampling sample_class(const ShapeClass& learnt, const ClassTemplate& class_template, const SampleOptions& options) {
    check_options(options, "sample");
    if (static_cast<std::size_t>(learnt.modes.mean.rows()) != class_template.mesh.number_of_vertices())
        fail_input("class",
                   fmt::format("was learnt with a template of {} vertices, but this template has {}", learnt.modes.mean.rows(),
                               class_template.mesh.number_of_vertices()),
                   "use the template of the class");
    return Sampler(learnt, class_template, options).run();
}

void SampleOptions::declare_options(OptionList& list) {
    list("count", count, "number of new members to sample", Range{1, 1e6});
    list("seed", seed, "random seed", Range{0, 1e18});
    list("by", by,
         "sampling method: modes (normally distributed mode coefficients, within the range of the members) or edits (mean shape "
         "with one to three random parts stretched or scaled)",
         Choices{"modes", "edits"});
    list("spread", spread, "modes: the coefficients are drawn within the range of the members' coefficients times this factor",
         Range{0, 10});
    list("edit", edit, "edits: standard deviation of the logarithm of the factor by which a part is stretched", Range{0, 2});
    list("attempts", attempts, "maximum number of random draws for each new member", Range{1, 1e6});
}

}  // namespace ostraka
