#include "ostraka/measure/examine.h"

#include "ostraka/annotation/curves.h"
#include "ostraka/core/flood.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/measure/measure.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ostraka {

namespace {

using std::to_string;

std::size_t count_patches(const Mesh& mesh, const std::vector<Index>& faces) {
    const std::vector<bool> selected = face_flags(mesh, faces);
    std::vector<bool> seen(selected.size(), false);
    std::size_t patches = 0;
    const auto stays = [&](Halfedge h) { return !mesh.is_border(mesh.opposite(h)) && selected[mesh.face(mesh.opposite(h))]; };
    CancelCheck check;
    for (const Index first : faces) {
        check();
        if (seen[first]) continue;
        ++patches;
        flood_faces(mesh, Face(first), seen, stays);
    }
    return patches;
}

class Examiner {
public:
    explicit Examiner(const Mesh& mesh) : mesh_(mesh) {}
    std::vector<Finding> findings;

    void selection(const Annotation& annotation, const std::string& at) {
        if (annotation.tag.empty()) defect(at + "/tag", "the tag is empty");
        switch (annotation.type) {
            case AnnotationType::point:
                points(annotation, at);
                break;
            case AnnotationType::line:
                line(annotation, at);
                break;
            case AnnotationType::region:
                region(annotation, at);
                break;
        }
    }

    /// `measured` is the same annotation with recomputed values.
    void values(const Annotation& annotation, const Annotation& measured, const std::string& at) {
        for (std::size_t i = 0; i < annotation.attributes.size(); ++i) {
            const Attribute& attribute = annotation.attributes[i];
            const Attribute& now = measured.attributes[i];
            const std::string here = at + "/attributes/" + to_string(i), name = "the attribute '" + attribute.name + "'";
            if (attribute.type == AttributeType::measure) {
                if (attribute.measure.stale) defect(here, name + " is marked stale");
                else if (now.measure.stale) defect(here, name + " cannot be measured: its pins are not joined");
                else if (attribute.measure.value) compare(*attribute.measure.value, *now.measure.value, here, name);
                else remark(here, name + " has no value; measured here: " + digits(*now.measure.value, 9));
                if (now.measure.direction && now.measure.repeats.empty() && !now.measure.stale &&
                    !is_extent(mesh_, annotation, now.measure))
                    remark(here, name +
                                     " is not the extent of its annotation along its direction: if it was meant to be, "
                                     "take it again");
            } else if (attribute.type == AttributeType::descriptor) {
                if (attribute.descriptor.stale) defect(here, name + " is marked stale");
                else if (attribute.descriptor.values.empty() && attribute.descriptor.file.empty())
                    defect(here, name + " has neither value nor file");
                else if (attribute.descriptor.values.size() == 1 && now.descriptor.values.size() == 1)
                    compare(attribute.descriptor.values.front(), now.descriptor.values.front(), here, name);
            }
        }
    }

    void defect(const std::string& where, const std::string& text) { findings.push_back({true, where, text}); }
    void remark(const std::string& where, const std::string& text) { findings.push_back({false, where, text}); }

private:
    void compare(double stored, double computed, const std::string& where, const std::string& name) {
        if (std::abs(stored - computed) <= 1e-6 * std::max(std::abs(stored), std::abs(computed))) return;
        defect(where, name + " is " + digits(stored, 9) + " but measures " + digits(computed, 9));
    }

    void points(const Annotation& annotation, const std::string& at) {
        if (annotation.points.empty()) defect(at, "there are no points" + because(annotation));
        std::set<Index> seen;
        for (std::size_t i = 0; i < annotation.points.size(); ++i)
            if (!seen.insert(annotation.points[i]).second)
                defect(at + "/points/" + to_string(i), "vertex " + to_string(annotation.points[i]) + " is repeated");
    }

    void line(const Annotation& annotation, const std::string& at) {
        if (is_free(annotation)) return;  // its edges are only the nearest ones
        if (annotation.polylines.empty()) defect(at, "there are no poly-lines" + because(annotation));
        std::set<std::pair<Index, Index>> edges;
        for (std::size_t i = 0; i < annotation.polylines.size(); ++i) {
            const auto& polyline = annotation.polylines[i];
            for (std::size_t k = 0; k + 1 < polyline.size(); ++k)
                if (!edges.insert(std::minmax(polyline[k], polyline[k + 1])).second) {
                    defect(at + "/polylines/" + to_string(i) + '/' + to_string(k + 1), "an edge is run over twice");
                    break;
                }
        }
    }

    void region(const Annotation& annotation, const std::string& at) {
        if (is_free(annotation)) {
            if (!(area_of(mesh_, annotation) > 0)) defect(at, "its outlines enclose nothing" + because(annotation));
            return;
        }
        if (annotation.faces.empty()) defect(at, "there are no faces" + because(annotation));
        const std::size_t patches = count_patches(mesh_, annotation.faces);
        if (patches > 1) remark(at, "the region has " + to_string(patches) + " separate patches");
        std::map<Index, std::size_t> visits;
        for (const Outline& outline : extract_outlines(mesh_, annotation.faces))
            for (const Index vertex : outline) ++visits[vertex];
        const auto touches = std::count_if(visits.begin(), visits.end(), [](const auto& visit) { return visit.second > 1; });
        if (touches > 0)
            remark(at, "the outlines touch themselves or each other at " + to_string(touches) +
                           (touches == 1 ? " vertex" : " vertices"));
    }

    static std::string because(const Annotation& annotation) {
        return annotation.note.empty() ? "" : " (" + annotation.note + ")";
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
            for (const auto& [face, share] : face_shares(mesh, annotation)) touched.push_back(face);
            summary.patches = count_patches(mesh, touched);
            summary.outlines = is_free(annotation) ? annotation.curves.size() : extract_outlines(mesh, annotation.faces).size();
            summary.area = measures.area;
            summary.length = measures.perimeter;
            break;
        }
    }
    return summary;
}

std::vector<Finding> examine(const Mesh& mesh, const AnnotationSet& set) {
    Examiner examiner(mesh);
    AnnotationSet measured;
    measured.annotations = set.annotations;
    refresh_measures(mesh, measured);
    std::map<std::string, std::size_t> tags;
    for (std::size_t i = 0; i < set.annotations.size(); ++i) {
        const Annotation& annotation = set.annotations[i];
        const std::string at = "/annotations/" + to_string(i);
        examiner.selection(annotation, at);
        examiner.values(annotation, measured.annotations[i], at);
        ++tags[annotation.tag];
    }
    for (const auto& [tag, count] : tags)
        if (count > 1 && !tag.empty())
            examiner.remark("/annotations", "the tag '" + tag + "' is used " + to_string(count) + " times");
    return std::move(examiner.findings);
}

}  // namespace ostraka
