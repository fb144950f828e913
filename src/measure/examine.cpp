#include "ostraka/measure/examine.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/measure/measure.h"
#include "ostraka/mesh/flood.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ostraka {

namespace {

using std::to_string;

std::size_t count_patches(const Mesh& mesh, const std::vector<Index>& faces) {
    const std::vector<bool> selected = face_flags(mesh, faces);
    return face_pieces(mesh, [&](Face f) -> bool { return selected[f]; }).count;
}

class Examiner {
public:
    explicit Examiner(const Mesh& mesh) : mesh_(mesh) {}
    std::vector<Finding> findings;

    void selection(const Annotation& annotation, const std::string& pointer) {
        if (annotation.tag.empty()) defect(pointer + "/tag", "the tag is empty");
        switch (annotation.type) {
            case AnnotationType::point:
                points(annotation, pointer);
                break;
            case AnnotationType::line:
                line(annotation, pointer);
                break;
            case AnnotationType::region:
                region(annotation, pointer);
                break;
        }
    }

    /// `measured` is the same annotation with recomputed values.
    void values(const Annotation& annotation, const Annotation& measured, const std::string& pointer) {
        for (std::size_t i = 0; i < annotation.attributes.size(); ++i) {
            const Attribute& attribute = annotation.attributes[i];
            const Attribute& recomputed = measured.attributes[i];
            const std::string attribute_pointer = pointer + "/attributes/" + to_string(i),
                              name = fmt::format("the attribute '{}'", attribute.name);
            if (attribute.measure() != nullptr)
                measure(annotation, *attribute.measure(), *recomputed.measure(), attribute_pointer, name);
            else if (attribute.descriptor() != nullptr)
                descriptor(*attribute.descriptor(), *recomputed.descriptor(), attribute_pointer, name);
        }
    }

    void defect(const std::string& where, const std::string& text) { findings.push_back({true, where, text}); }
    void remark(const std::string& where, const std::string& text) { findings.push_back({false, where, text}); }

private:
    void measure(const Annotation& annotation, const Measure& stored, const Measure& recomputed, const std::string& pointer,
                 const std::string& name) {
        if (stored.stale) defect(pointer, name + " is marked stale");
        else if (recomputed.stale) defect(pointer, name + " cannot be measured: its pins are not connected");
        else if (stored.value) compare(*stored.value, *recomputed.value, pointer, name);
        else remark(pointer, fmt::format("{} has no value; it measures {}", name, digits(*recomputed.value, 9)));
        if (recomputed.direction && recomputed.repeats.empty() && !recomputed.stale && !is_extent(mesh_, annotation, recomputed))
            remark(pointer,
                   name + " is not the extent of its annotation along its direction: if it is meant to be, measure it again");
    }

    void descriptor(const Descriptor& stored, const Descriptor& recomputed, const std::string& pointer, const std::string& name) {
        if (stored.stale) defect(pointer, name + " is marked stale");
        else if (stored.values.empty() && stored.file.empty()) defect(pointer, name + " has neither value nor file");
        else if (stored.values.size() == 1 && recomputed.values.size() == 1)
            compare(stored.values.front(), recomputed.values.front(), pointer, name);
    }

    void compare(double stored, double computed, const std::string& where, const std::string& name) {
        if (std::abs(stored - computed) <= 1e-6 * std::max(std::abs(stored), std::abs(computed))) return;
        defect(where, fmt::format("{} is {} but measures {}", name, digits(stored, 9), digits(computed, 9)));
    }

    void points(const Annotation& annotation, const std::string& pointer) {
        if (annotation.points.empty()) defect(pointer, "there are no points" + note_text(annotation));
        std::set<Index> visited;
        for (std::size_t i = 0; i < annotation.points.size(); ++i)
            if (!visited.insert(annotation.points[i]).second)
                defect(pointer + "/points/" + to_string(i), fmt::format("vertex {} is repeated", annotation.points[i]));
    }

    void line(const Annotation& annotation, const std::string& pointer) {
        if (is_free(annotation)) return;  // its edges are only the nearest ones
        if (annotation.polylines.empty()) defect(pointer, "there are no poly-lines" + note_text(annotation));
        std::set<std::pair<Index, Index>> edges;
        for (std::size_t i = 0; i < annotation.polylines.size(); ++i) {
            const auto& polyline = annotation.polylines[i];
            for (std::size_t k = 0; k + 1 < polyline.size(); ++k)
                if (!edges.insert(std::minmax(polyline[k], polyline[k + 1])).second) {
                    defect(pointer + "/polylines/" + to_string(i) + '/' + to_string(k + 1), "an edge is traversed twice");
                    break;
                }
        }
    }

    void region(const Annotation& annotation, const std::string& pointer) {
        if (is_free(annotation)) {
            if (!(area_of(mesh_, annotation) > 0)) defect(pointer, "its outlines enclose nothing" + note_text(annotation));
            return;
        }
        if (annotation.faces.empty()) defect(pointer, "there are no faces" + note_text(annotation));
        const std::size_t patches = count_patches(mesh_, annotation.faces);
        if (patches > 1) remark(pointer, fmt::format("the region has {} separate patches", patches));
        std::map<Index, std::size_t> visits;
        for (const Outline& outline : extract_outlines(mesh_, annotation.faces))
            for (const Index vertex : outline) ++visits[vertex];
        const auto touches = std::count_if(visits.begin(), visits.end(), [](const auto& visit) { return visit.second > 1; });
        if (touches > 0)
            remark(pointer, fmt::format("the outlines touch themselves or each other at {} {}", touches,
                                        touches == 1 ? "vertex" : "vertices"));
    }

    static std::string note_text(const Annotation& annotation) {
        return annotation.note.empty() ? std::string() : fmt::format(" ({})", annotation.note);
    }

    const Mesh& mesh_;
};

}  // namespace

AnnotationSummary summarise(const Mesh& mesh, const Annotation& annotation) {
    check_cancelled();
    AnnotationSummary summary;
    switch (annotation.type) {
        case AnnotationType::point:
            summary.elements = summary.patches = annotation.points.size();
            break;
        case AnnotationType::line:
            summary.patches = annotation.polylines.size();
            for (const auto& polyline : annotation.polylines) summary.elements += polyline.size() - 1;
            summary.length = evaluate(mesh, annotation, std::string("length")).value_or(0);
            break;
        case AnnotationType::region: {
            const RegionMeasures measures = measure_region(mesh, annotation);
            summary.elements = annotation.faces.size();
            // Faces cut by a curve may connect parts that the selected faces alone do not.
            std::vector<Index> touched;
            for (const auto& [face, share] : face_area_fractions(mesh, annotation)) touched.push_back(face);
            summary.patches = count_patches(mesh, touched);
            summary.outlines = is_free(annotation) ? annotation.curves.size() : extract_outlines(mesh, annotation.faces).size();
            summary.area = measures.area;
            summary.length = measures.perimeter;
            break;
        }
    }
    return summary;
}

std::vector<Finding> examine(AnnotatedMeshView object) {
    Examiner examiner(object.mesh);
    AnnotationSet measured;
    measured.annotations = object.annotations.annotations;
    refresh_measures(object.mesh, measured);
    std::map<std::string, std::size_t> tags;
    for (std::size_t i = 0; i < object.annotations.annotations.size(); ++i) {
        const Annotation& annotation = object.annotations.annotations[i];
        const std::string pointer = "/annotations/" + to_string(i);
        examiner.selection(annotation, pointer);
        examiner.values(annotation, measured.annotations[i], pointer);
        ++tags[annotation.tag];
    }
    for (const auto& [tag, count] : tags)
        if (count > 1 && !tag.empty()) examiner.remark("/annotations", fmt::format("the tag '{}' is used {} times", tag, count));
    return std::move(examiner.findings);
}

}  // namespace ostraka
