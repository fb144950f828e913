// Free annotations: outlines, poly-lines and points that need not follow the edges of the mesh.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/annotation/outline.h"
#include "ostraka/geom/curve_filling.h"

#include <optional>
#include <vector>

namespace ostraka {

/// Whether it has curves of its own.
inline bool is_free(const Annotation& annotation) { return !annotation.curves.empty(); }
bool any_free(const AnnotationSet& set);

/// Its curves with their coordinates. Throws Error (input), naming the annotation, where they do not fit the mesh.
std::vector<SurfaceCurve> curves_on(const Mesh& mesh, const Annotation& annotation);

/// Which faces a free region holds, in part or whole.
CurveFilling filling_of(const Mesh& mesh, const Annotation& annotation);

/// Gives a free annotation the elements nearest to its curves: of a region the faces of which at least half is inside, and those
/// of whole components that `faces` lists and no curve runs through; of a poly-line a path of edges; of points the vertices.
/// Throws Error (input) as `curves_on`, and for outlines that contradict each other.
void settle_elements(const Mesh& mesh, Annotation& annotation);

/// Area and perimeter of a region: of a free one those of its curves.
RegionMeasures measure_region(const Mesh& mesh, const Annotation& annotation);
/// Area of a region, 0 of others.
double area_of(const Mesh& mesh, const Annotation& annotation);

/// The faces of a region, ascending, each with the share of its area that is inside: 1, or less where a free outline cuts it.
std::vector<std::pair<Index, double>> face_shares(const Mesh& mesh, const Annotation& region);
/// Length of a line: of its curves if it is free.
double length_of(const Mesh& mesh, const Annotation& annotation);
/// The outlines of a region, the poly-lines of a line, the points of points, as coordinates; closed ones repeat their first.
std::vector<std::vector<Point>> drawn_curves(const Mesh& mesh, const Annotation& annotation);

/// A mesh cut along the free curves of annotations, where all of them follow edges. The surface is the same.
struct CutMesh {
    Mesh mesh;                       ///< old vertices first, under their old indices
    AnnotationSet annotations;       ///< without curves; measures keep their pins
    std::vector<Index> face_origin;  ///< new face -> old face, ascending
    std::vector<SurfaceNode> nodes;  ///< of the vertices beyond the old ones: where they are on the old mesh
    std::size_t old_vertices = 0;
    std::vector<std::vector<Index>> more_paths;  ///< of the other curves: all vertices along each

    /// Values of old vertices, interpolated at the new ones; values of old faces, handed to their parts.
    [[nodiscard]] std::vector<double> vertex_values(const Mesh& before, const std::vector<double>& values) const;
    template <class Value>
    [[nodiscard]] std::vector<Value> face_values(const std::vector<Value>& values) const {
        std::vector<Value> parts;
        parts.reserve(face_origin.size());
        for (const Index f : face_origin) parts.push_back(values[f]);
        return parts;
    }
};

/// Cuts along the curves of the set, and along `more`. Linear in the mesh plus O(k log k) per face with k nodes; where two
/// outlines cross each other, in the sizes of both.
CutMesh cut_along_curves(const Mesh& mesh, const AnnotationSet& set, const std::vector<SurfaceCurve>& more = {});

/// Mesh and annotations where all follow edges, for what only looks at them: as they are if none is free, else cut. What is given
/// must outlive it.
class AlongEdges {
public:
    AlongEdges(const Mesh& mesh, const AnnotationSet& set) : mesh_(&mesh), set_(&set) {
        if (any_free(set)) cut_.emplace(cut_along_curves(mesh, set));
    }
    [[nodiscard]] const Mesh& mesh() const { return cut_ ? cut_->mesh : *mesh_; }
    [[nodiscard]] const AnnotationSet& annotations() const { return cut_ ? cut_->annotations : *set_; }
    [[nodiscard]] const std::optional<CutMesh>& cut() const { return cut_; }

private:
    const Mesh* mesh_;
    const AnnotationSet* set_;
    std::optional<CutMesh> cut_;
};

/// An annotation of the cut mesh on the mesh that was cut: a free one, unless it follows the edges of that as well. Places
/// between others on a straight piece are left out.
void bring_back(const Mesh& mesh, const CutMesh& cut, Annotation& annotation);

}  // namespace ostraka
