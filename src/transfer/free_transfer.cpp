#include "free_transfer.h"

#include "attribute_carrier.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/parallel.h"
#include "ostraka/geom/polyline_distance.h"
#include "ostraka/measure/measure.h"
#include "ostraka/transfer/project_curves.h"
#include "path_tracer.h"
#include "scores.h"

#include <algorithm>
#include <optional>

namespace ostraka {

namespace {

/// The counts and flags of a projection as a score.
TransferScore score_of(const ProjectedAnnotation& projected) {
    TransferScore score;
    score.id = projected.annotation.id;
    score.tag = projected.annotation.tag;
    score.source_type = score.target_type = projected.annotation.type;
    score.vertices = projected.places;
    score.by_ray = projected.by_ray;
    score.by_closest_point = projected.by_closest_point;
    score.without_place = projected.without_place;
    score.detours = projected.detours;
    score.crossings_resolved = projected.untangled;
    score.note = projected.note;
    if (projected.lost) score.outcome = TransferOutcome::lost;
    return score;
}

/// Computes lengths, areas and distances of one annotation, and returns the overlap query if requested.
std::optional<OverlapQuestion> measured(const Mesh& source, const Annotation& from, const Mesh& target, const Annotation& to,
                                        bool overlap, TransferScore& score) {
    const Segments a = segments_of(source, from), b = segments_of(target, to);
    score.source_length = length_of(a);
    score.target_length = length_of(b);
    if (a.empty() == b.empty()) score.hausdorff = hausdorff_distance(a, b);
    if (from.type != AnnotationType::region) return std::nullopt;
    score.source_area = area_of(source, from);
    score.target_area = area_of(target, to);
    if (!overlap || score.outcome == TransferOutcome::lost) return std::nullopt;
    OverlapQuestion question{region_area(source, from), region_area(target, to), {}, &score};
    if (question.target.free)
        question.in_target = [free = question.target.free](const SurfaceHit& hit) { return free->contains(hit.face, hit.point); };
    else
        question.in_target = [flags = face_flags(target, to.faces)](const SurfaceHit& hit) {
            return static_cast<bool>(flags[hit.face]);
        };
    return question;
}

/// Merges both results in the order of the set.
void join_in_order(const AnnotationSet& set, const std::vector<bool>& free, std::vector<Annotation> projected,
                   std::vector<TransferScore> scores, TransferResult& result) {
    std::vector<Annotation> plain = std::move(result.annotations.annotations);
    std::vector<TransferScore> plain_scores = std::move(result.scores);
    result.annotations.annotations.clear();
    result.scores.clear();
    std::size_t next_plain = 0, next_free = 0;
    for (std::size_t i = 0; i < set.annotations.size(); ++i)
        result.scores.push_back(free[i] ? std::move(scores[next_free++]) : std::move(plain_scores[next_plain++]));
    for (const Annotation& annotation : set.annotations)
        for (std::vector<Annotation>* list : {&plain, &projected})
            for (Annotation& one : *list)
                if (one.id == annotation.id) result.annotations.annotations.push_back(std::move(one));
}

}  // namespace

void transfer_free(const Mesh& source, const AnnotationSet& set, const std::vector<bool>& free, const SurfaceSearch& target,
                   const TransferOptions& options, Clock& clock, TransferResult& result) {
    const Mesh& mesh = target.mesh();
    std::vector<const Annotation*> given;
    std::vector<Index> pins;
    for (std::size_t i = 0; i < set.annotations.size(); ++i) {
        if (!free[i]) continue;
        given.push_back(&set.annotations[i]);
        for (const Attribute& attribute : set.annotations[i].attributes) {
            const std::vector<Index> own = pins_of(attribute.measure);
            pins.insert(pins.end(), own.begin(), own.end());
        }
    }
    PathTracer tracer(source, target, options);
    tracer.match(std::move(pins));
    result.times.correspondence += clock.lap();
    std::vector<ProjectedAnnotation> projected = project_curves(source, given, target, options.correspondence);
    result.times.paths += clock.lap();
    AttributeCarrier attributes(tracer, false);
    AnnotationSet carried;
    carried.unit = set.unit;
    std::vector<TransferScore> scores;
    for (std::size_t i = 0; i < given.size(); ++i) {
        scores.push_back(score_of(projected[i]));
        attributes.carry(*given[i], projected[i].annotation);
    }
    std::vector<std::optional<OverlapQuestion>> questions(given.size());
    parallel_for(
        given.size(),
        [&](std::size_t i) { questions[i] = measured(source, *given[i], mesh, projected[i].annotation, options.overlap, scores[i]); },
        1);
    std::vector<OverlapQuestion> asked;
    for (auto& question : questions)
        if (question) asked.push_back(std::move(*question));
    if (!asked.empty()) {
        const SurfaceSearch back(source);
        score_overlaps({source, back}, {mesh, target}, asked, options.correspondence);
    }
    for (ProjectedAnnotation& one : projected)
        if (!one.lost) carried.annotations.push_back(std::move(one.annotation));
    refresh_measures(mesh, carried);
    attributes.keep_old_values(carried);
    result.times.scores += clock.lap();
    join_in_order(set, free, std::move(carried.annotations), std::move(scores), result);
}

}  // namespace ostraka
