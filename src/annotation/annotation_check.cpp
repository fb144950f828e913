// Conditions that every annotation must satisfy, whatever its source.
#include "annotation/annotation_places.h"
#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/curves.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/progress.h"
#include "ostraka/files/npy.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/mesh/limits.h"

#include <cmath>
#include <set>

namespace ostraka {

namespace places {

void fail(const std::string& where, const std::string& pointer, const std::string& what, const std::string& remedy) {
    fail_input(where, "at " + pointer + ": " + what, remedy);
}

void check_vertex(const Mesh& mesh, Index vertex, const std::string& where, const std::string& pointer) {
    if (vertex < mesh.number_of_vertices()) return;
    fail(where, pointer,
         "vertex " + std::to_string(vertex) + " of a mesh with " + std::to_string(mesh.number_of_vertices()) + " vertices",
         "give the mesh the annotations were made for");
}

void check_vertices(const Mesh& mesh, const std::vector<Index>& vertices, const std::string& where, const std::string& pointer) {
    for (std::size_t i = 0; i < vertices.size(); ++i) check_vertex(mesh, vertices[i], where, pointer + '/' + std::to_string(i));
}

void check_face(const Mesh& mesh, Index face, const std::string& where, const std::string& pointer) {
    if (face < mesh.number_of_faces()) return;
    fail(where, pointer, "face " + std::to_string(face) + " of a mesh with " + std::to_string(mesh.number_of_faces()) + " faces",
         "give the mesh the annotations were made for");
}

void check_edge(const Mesh& mesh, Index a, Index b, const std::string& where, const std::string& pointer) {
    if (find_halfedge(mesh, Vertex(a), Vertex(b)).is_valid()) return;
    fail(where, pointer,
         a == b ? "vertex " + std::to_string(a) + " follows itself"
                : "the mesh has no edge from vertex " + std::to_string(a) + " to vertex " + std::to_string(b),
         "successive vertices must be joined by an edge: give the mesh the annotations were made for, or correct the list");
}

}  // namespace places

namespace {

using places::fail;
using std::to_string;

void check_measure(const Measure& measure, const Mesh& mesh, const std::string& where, const std::string& at) {
    if (measure.tool != "ruler" && measure.tool != "tape" && measure.tool != "bounding")
        fail(where, at + "/tool", "the tool '" + measure.tool + "' is not known", "use ruler, tape or bounding");
    if (measure.points.size() < 2)
        fail(where, at + "/points", "a " + measure.tool + " needs two points or more, not " + to_string(measure.points.size()),
             "add its pins");
    places::check_vertices(mesh, measure.points, where, at + "/points");
    if (!measure.locations.empty() && measure.locations.size() != measure.points.size())
        fail(where, at + "/locations",
             to_string(measure.locations.size()) + " locations for " + to_string(measure.points.size()) + " points",
             "give one location for each point, or none");
    for (std::size_t i = 0; i < measure.locations.size(); ++i) {
        const std::string here = at + "/locations/" + to_string(i);
        const SurfacePoint& location = measure.locations[i];
        const auto& weights = location.weights;
        places::check_face(mesh, location.element[0], where, here + "/face");
        if (!(std::abs(weights[0] + weights[1] + weights[2] - 1) <= 1e-6))
            fail(where, here + "/barycentric", "the weights do not sum to one", "give three weights whose sum is 1");
    }
    if (measure.tool == "bounding") {
        if (!measure.direction) fail(where, at, "a bounding measure without a direction", "add the member \"direction\"");
        const auto& d = *measure.direction;
        if (unit_vector({d[0], d[1], d[2]}) == CGAL::NULL_VECTOR)
            fail(where, at + "/direction", "the direction has no length", "give a vector that is not zero");
    }
    if (measure.exact && measure.tool != "tape")
        fail(where, at + "/geodesic", "belongs to a tape, not to a " + measure.tool, "remove it");
    for (std::size_t i = 0; i < measure.repeats.size(); ++i) {
        const std::string here = at + "/repeats/" + to_string(i);
        if (measure.repeats[i].size() != measure.points.size())
            fail(where, here,
                 to_string(measure.repeats[i].size()) + " pins where the measure has " + to_string(measure.points.size()),
                 "pick the same pins again");
        places::check_vertices(mesh, measure.repeats[i], where, here);
    }
    if (measure.uncertainty && !(std::isfinite(*measure.uncertainty) && *measure.uncertainty >= 0))
        fail(where, at + "/uncertainty", "is negative or not finite", "leave it out");
    if (measure.value && !std::isfinite(*measure.value)) fail(where, at + "/value", "the value is not finite", "leave it out");
}

void check_attributes(const Annotation& annotation, const Mesh& mesh, const std::string& where, const std::string& at) {
    std::set<int> ids;
    for (std::size_t i = 0; i < annotation.attributes.size(); ++i) {
        const Attribute& attribute = annotation.attributes[i];
        const std::string here = at + "/attributes/" + to_string(i);
        if (!ids.insert(attribute.id).second)
            fail(where, here + "/id", "the attribute id " + to_string(attribute.id) + " is taken within its annotation",
                 "give each attribute its own id");
        if (const Measure* measure = attribute.measure()) check_measure(*measure, mesh, where, here + "/measure");
        if (const Descriptor* descriptor = attribute.descriptor())
            for (const double value : descriptor->values)
                if (!std::isfinite(value))
                    fail(where, here + "/value", "a value is not finite", "give a finite number, or remove the attribute");
    }
}

void check_selection(const Annotation& annotation, const Mesh& mesh, const std::string& where, const std::string& at,
                     bool settled) {
    const auto misplaced = [&](const char* member, const char* type) {
        fail(where, at, "an annotation of type " + to_string(annotation.type) + " has " + member,
             std::string("use it with the type ") + type);
    };
    if (annotation.type != AnnotationType::point && !annotation.points.empty()) misplaced("points", "point");
    if (annotation.type != AnnotationType::line && !annotation.polylines.empty()) misplaced("polylines", "line");
    if (annotation.type != AnnotationType::region && (!annotation.faces.empty() || annotation.all)) misplaced("faces", "region");
    places::check_vertices(mesh, annotation.points, where, at + "/points");
    for (std::size_t i = 0; i < annotation.polylines.size(); ++i) {
        const auto& polyline = annotation.polylines[i];
        const std::string here = at + "/polylines/" + to_string(i);
        if (polyline.size() < 2)
            fail(where, here, "a poly-line of " + to_string(polyline.size()) + (polyline.size() == 1 ? " vertex" : " vertices"),
                 "give two vertices or more, or use the type point");
        places::check_vertices(mesh, polyline, where, here);
        for (std::size_t k = 0; k + 1 < polyline.size(); ++k)
            places::check_edge(mesh, polyline[k], polyline[k + 1], where, here + '/' + to_string(k + 1));
    }
    for (std::size_t i = 0; i < annotation.faces.size(); ++i) {
        places::check_face(mesh, annotation.faces[i], where, at + "/faces/" + to_string(i));
        if (i > 0 && annotation.faces[i] <= annotation.faces[i - 1])
            fail(where, at + "/faces/" + to_string(i), "the faces are not in ascending order without repeats", "sort them");
    }
    if (is_free(annotation) && !settled) {
        if (annotation.all) fail(where, at, "the whole mesh has curves", "drop them or the mark \"all\"");
        Annotation again = annotation;
        try {
            compute_elements(mesh, again);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled) throw;
            fail(where, at + "/curves", error.where() + ": " + error.problem(), error.remedy());
        }
        if (again.points != annotation.points || again.polylines != annotation.polylines || again.faces != annotation.faces)
            throw Error(ErrorKind::failure, where, "at " + at + ": its curves and its elements differ",
                        "compute its elements from its curves, or remove the curves");
    }
    if (annotation.all && annotation.faces.size() != mesh.number_of_faces())
        fail(where, at,
             "a region that is the whole mesh lists " + to_string(annotation.faces.size()) + " of " +
                 to_string(mesh.number_of_faces()) + " faces",
             "list all or drop the mark \"all\"");
}

}  // namespace

void places::check_set(AnnotatedMeshView object, const std::string& where, bool settled) {
    if (object.mesh.has_garbage()) fail_work(where, "the mesh has removed elements", "collect the mesh's garbage first");
    if (object.annotations.up) {
        const auto& [x, y, z] = *object.annotations.up;
        if (unit_vector({x, y, z}) == CGAL::NULL_VECTOR)
            fail(where, "/up", "the direction has no length", "give a vector that is not zero, or leave it out");
    }
    std::set<int> ids;
    for (std::size_t i = 0; i < object.annotations.annotations.size(); ++i) {
        check_cancelled();
        const Annotation& annotation = object.annotations.annotations[i];
        const std::string at = "/annotations/" + to_string(i);
        if (!ids.insert(annotation.id).second)
            fail(where, at + "/id", "the id " + to_string(annotation.id) + " is taken", "give each annotation its own id");
        for (const int part : annotation.colour)
            if (part < 0 || part > 255)
                fail(where, at + "/colour", "the colour part " + to_string(part) + " is not within 0 to 255",
                     "give red, green and blue from 0 to 255");
        check_selection(annotation, object.mesh, where, at, settled);
        check_attributes(annotation, object.mesh, where, at);
    }
}

void check_annotations(AnnotatedMeshView object, const std::string& where) { places::check_set(object, where, false); }

namespace {

/// A local file that an annotation refers to.
struct ReferredFile {
    std::string pointer;   ///< JSON pointer in the annotation file
    std::string referrer;  ///< subject and verb for the message: "annotation 3 ('spout') refers to the image"
    std::string name;
    std::string sha256;
};

std::vector<ReferredFile> referred_files(const AnnotationSet& set) {
    std::vector<ReferredFile> files;
    for (std::size_t i = 0; i < set.annotations.size(); ++i) {
        const Annotation& annotation = set.annotations[i];
        const std::string at = "/annotations/" + to_string(i);
        for (std::size_t k = 0; k < annotation.information.size(); ++k) {
            const Information& information = annotation.information[k];
            if (!information.is_local()) continue;
            files.push_back({at + "/information/" + to_string(k),
                             name_of(annotation) + " refers to the " + to_string(information.kind), information.value,
                             information.sha256});
        }
        for (std::size_t k = 0; k < annotation.attributes.size(); ++k) {
            const Attribute& attribute = annotation.attributes[k];
            const Descriptor* descriptor = attribute.descriptor();
            if (descriptor == nullptr || descriptor->file.empty()) continue;
            files.push_back({at + "/attributes/" + to_string(k),
                             name_of(annotation) + " has the attribute '" + printable(attribute.name, 60) + "' in the file",
                             descriptor->file, descriptor->sha256});
        }
    }
    return files;
}

/// The defect of the contents of an attribute's file; empty: none.
std::string defect_of_content(const Path& file, const Mesh& mesh) {
    const std::string bytes = read_file(file);
    if (extension(file) == ".npy") {
        const NpyView array = view_npy(bytes, file.string());
        const std::size_t count = array.count();
        if (array.columns() == 1 && (count == mesh.number_of_vertices() || count == mesh.number_of_faces())) return {};
        return "which has " + to_string(count) + " numbers, neither one for each of the " + to_string(mesh.number_of_vertices()) +
               " vertices nor one for each of the " + to_string(mesh.number_of_faces()) + " faces";
    }
    if (extension(file) != ".json") return {};
    const Json document = parse_json(bytes, file.string());
    const JsonValue* format = document.IsObject() ? find_member(document, "format") : nullptr;
    if (format == nullptr || !format->IsString() || std::string(format->GetString()) != "ostraka-axis") return {};
    const JsonValue* axis = find_member(document, "axis");
    const JsonValue* found = axis != nullptr && axis->IsObject() ? find_member(*axis, "found") : nullptr;
    return found != nullptr && found->IsTrue() ? "" : "which holds no axis that was found";
}

}  // namespace

std::vector<Finding> check_files(AnnotatedMeshView object, const Path& folder) {
    std::vector<Finding> findings;
    for (const ReferredFile& referred : referred_files(object.annotations)) {
        const Path given(referred.name), file = folder / given;
        const auto add = [&](bool defect, const std::string& what) {
            findings.push_back(
                {defect, referred.pointer, referred.referrer + " '" + printable(referred.name, 60) + "', " + what});
        };
        // Files outside the folder of a received annotation file are not read.
        if (given.is_absolute() || !is_inside(file, folder)) add(true, "which leads out of the folder of the annotations");
        else if (!file_exists(file)) add(true, "which is not there");
        else if (referred.sha256.empty()) add(false, "whose checksum is not known");
        else if (sha256_of_file(file) != referred.sha256) add(true, "which has changed since (its checksum differs)");
        else if (referred.pointer.find("/attributes/") != std::string::npos) {
            try {
                if (const std::string defect = defect_of_content(file, object.mesh); !defect.empty()) add(true, defect);
            } catch (const Error& error) {
                if (error.kind() != ErrorKind::input) throw;
                add(true, "which cannot be read: " + error.problem());
            }
        }
    }
    return findings;
}

}  // namespace ostraka
