// Free annotations: outlines, poly-lines and points that need not follow the edges of the mesh.
#pragma once

#include "ostraka/annotation/annotated_mesh.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/geom/curve_filling.h"

#include <optional>
#include <vector>

namespace ostraka {

/// Whether the annotation has its own curves.
inline bool is_free(const Annotation& annotation) { return !annotation.curves.empty(); }
bool any_free(const AnnotationSet& set);

/// The curve through vertices; a closed one repeats its first point.
std::vector<SurfacePoint> vertex_curve(const std::vector<Index>& path, bool closed = false);

/// The curves of a free annotation with the faces of their pieces. Throws Error (input), naming the annotation, if they do not
/// fit the mesh.
std::vector<SurfaceCurve> curves_on(const Mesh& mesh, const Annotation& annotation);

/// For each face, whether it is inside, outside or partly inside a free region.
CurveFilling filling_of(const Mesh& mesh, const Annotation& annotation);

/// Computes the elements of a free annotation nearest to its curves. Region: faces with at least half of their area inside, and
/// the connected components listed in `faces` that no curve traverses. Line: a path of edges. Point: vertices. Throws Error
/// (input) as `curves_on` does, and if outlines contradict each other.
void settle_elements(const Mesh& mesh, Annotation& annotation);

/// Area and perimeter of a region; for a free region, computed from its curves.
RegionMeasures measure_region(const Mesh& mesh, const Annotation& annotation);
/// Area of a region; 0 for other types.
double area_of(const Mesh& mesh, const Annotation& annotation);

/// The faces of a region, ascending, each with the fraction of its area inside: 1, or less if a free outline cuts the face.
std::vector<std::pair<Index, double>> face_shares(const Mesh& mesh, const Annotation& region);
/// Length of a line; for a free line, computed from its curves.
double length_of(const Mesh& mesh, const Annotation& annotation);
/// Coordinates of the outlines of a region, the poly-lines of a line or the points; closed curves repeat their first point.
std::vector<std::vector<Point>> drawn_curves(const Mesh& mesh, const Annotation& annotation);

/// A mesh cut along the free curves of its annotations, so that all curves follow edges. The surface is unchanged. The old
/// vertices come first and keep their indices; the annotations have no curves, and their measures keep the pins.
struct CutMesh : AnnotatedMesh {
    std::vector<Index> face_origin;    ///< new face -> old face, ascending
    std::vector<SurfacePoint> points;  ///< for each new vertex, its place on the old mesh
    std::size_t old_vertices = 0;
    std::vector<std::vector<Index>> more_paths;  ///< for each additional curve, all vertices along it

    /// Vertex values interpolated at the new vertices; face values copied to the parts of the face.
    [[nodiscard]] std::vector<double> vertex_values(const Mesh& before, const std::vector<double>& values) const;
    template <class Value>
    [[nodiscard]] std::vector<Value> face_values(const std::vector<Value>& values) const {
        std::vector<Value> parts;
        parts.reserve(face_origin.size());
        for (const Index f : face_origin) parts.push_back(values[f]);
        return parts;
    }
};

/// Cuts along the curves of the annotations and along `more`. Linear in the size of the mesh plus O(k log k) per face with k
/// nodes; if two outlines intersect, also in the sizes of both.
CutMesh cut_along_curves(AnnotatedMeshView object, const std::vector<SurfaceCurve>& more = {});

/// An annotated mesh in which all annotations follow edges, for read-only use: the given one if no annotation is free, else the
/// cut one. The argument must outlive this object.
class AlongEdges {
public:
    explicit AlongEdges(AnnotatedMeshView given) : given_(given) {
        if (any_free(given.annotations)) cut_.emplace(cut_along_curves(given));
    }
    [[nodiscard]] AnnotatedMeshView object() const { return cut_ ? AnnotatedMeshView(*cut_) : given_; }
    [[nodiscard]] const std::optional<CutMesh>& cut() const { return cut_; }

private:
    AnnotatedMeshView given_;
    std::optional<CutMesh> cut_;
};

/// Maps an annotation of the cut mesh back to the original mesh. It becomes free unless it follows edges of the original mesh.
/// Places in the interior of a straight piece are dropped.
void bring_back(const Mesh& mesh, const CutMesh& cut, Annotation& annotation);

}  // namespace ostraka
