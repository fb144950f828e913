// Free annotations: outlines, poly-lines and points that need not follow the edges of the mesh.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/geom/curve_filling.h"

#include <optional>
#include <vector>

namespace ostraka {

/// True if the annotation is free: it has its own curves, which need not follow edges.
inline bool is_free(const Annotation& annotation) { return !annotation.curves.empty(); }
bool any_free(const AnnotationSet& set);  ///< true if at least one annotation is free

/// The curve through the vertices of `path`; a closed curve repeats its first point.
std::vector<SurfacePoint> vertex_curve(const std::vector<Index>& path, bool closed = false);

/// The curves of a free annotation, with the face in which each straight segment lies. Throws Error (input), naming the
/// annotation, if a point of a curve is not on the mesh or two consecutive points do not lie in a common face.
std::vector<SurfaceCurve> curves_on(const Mesh& mesh, const Annotation& annotation);

/// Classifies each face of the mesh as inside, outside or partly inside a free region.
CurveFilling filling_of(const Mesh& mesh, const Annotation& annotation);

/// Computes the elements of a free annotation nearest to its curves. The elements of a region are the faces with at least half of
/// their area inside, and the connected components listed in `faces` that no curve traverses. The elements of a line are a path
/// of edges, and the elements of a point annotation are vertices. Throws Error (input) as `curves_on` does, and if outlines
/// contradict each other.
void compute_elements(const Mesh& mesh, Annotation& annotation);

/// Area and perimeter of a region; for a free region, both are computed from its curves.
RegionMeasures measure_region(const Mesh& mesh, const Annotation& annotation);
/// Area of a region; 0 for points and lines.
double area_of(const Mesh& mesh, const Annotation& annotation);

/// The faces of a region, ascending, each with the fraction of its area that lies inside the region: 1, or less if a free outline
/// cuts the face.
std::vector<std::pair<Index, double>> face_area_fractions(const Mesh& mesh, const Annotation& region);
/// Length of a line annotation; for a free line, the length is computed from its curves.
double length_of(const Mesh& mesh, const Annotation& annotation);
/// Coordinates of the outlines of a region, the poly-lines of a line or the points; closed curves repeat their first point.
std::vector<std::vector<Point>> drawn_curves(const Mesh& mesh, const Annotation& annotation);

/// A mesh cut along the free curves of its annotations, so that all curves follow edges. The surface is unchanged. The vertices
/// of the uncut mesh come first and keep their indices, then come the new vertices. The annotations follow edges of the cut mesh,
/// without free curves; measures keep their pins.
struct CutMesh : AnnotatedMesh {
    /// For each face of the cut mesh: face of the uncut mesh that contains it; ascending.
    std::vector<Index> face_origin;
    std::vector<SurfacePoint> points;  ///< for each new vertex: its place on the uncut mesh
    std::size_t old_vertices = 0;      ///< number of vertices of the uncut mesh
    /// For each additional curve (argument `more` of cut_along_curves): the vertices along the curve.
    std::vector<std::vector<Index>> more_paths;

    /// Values per vertex of the cut mesh from values per vertex of the uncut mesh `before`, interpolated at the new vertices.
    [[nodiscard]] std::vector<double> vertex_values(const Mesh& before, const std::vector<double>& values) const;
    /// Values per face of the cut mesh: each part of a face gets the value of the uncut face.
    template <class Value>
    [[nodiscard]] std::vector<Value> face_values(const std::vector<Value>& values) const {
        std::vector<Value> parts;
        parts.reserve(face_origin.size());
        for (const Index f : face_origin) parts.push_back(values[f]);
        return parts;
    }
};

/// Cuts the mesh along the free curves of the annotations and along the curves in `more`. Time: linear in the size of the mesh
/// plus O(k log k) per face with k nodes; if two outlines intersect, also linear in the sizes of both.
CutMesh cut_along_curves(AnnotatedMeshView object, const std::vector<SurfaceCurve>& more = {});

/// Read-only access to an annotated mesh whose annotations all follow edges. The view is the given mesh if no annotation has free
/// curves, otherwise the mesh cut along the free curves. The constructor's argument must outlive this object.
class EdgeAlignedAnnotations {
public:
    explicit EdgeAlignedAnnotations(AnnotatedMeshView given) : given_(given) {
        if (any_free(given.annotations)) cut_.emplace(cut_along_curves(given));
    }
    [[nodiscard]] AnnotatedMeshView object() const { return cut_ ? AnnotatedMeshView(*cut_) : given_; }
    [[nodiscard]] const std::optional<CutMesh>& cut() const { return cut_; }  ///< none if no annotation is free

private:
    AnnotatedMeshView given_;
    std::optional<CutMesh> cut_;
};

/// Maps an annotation of the cut mesh back to the original mesh. The annotation becomes free unless it follows edges of the
/// original mesh. Points inside a straight segment are removed from its curves.
void uncut_annotation(const Mesh& mesh, const CutMesh& cut, Annotation& annotation);

}  // namespace ostraka
