#include "ostraka/annotation/part.h"

#include "ostraka/annotation/colouring.h"
#include "ostraka/annotation/remap.h"
#include "ostraka/core/error.h"

#include <numeric>

namespace ostraka {

namespace {

/// Sets the flags of the faces of these regions to `value`.
void mark(const AnnotationSet& set, const std::vector<std::size_t>& regions, bool value, std::vector<bool>& keep) {
    for (const std::size_t i : regions) {
        const Annotation& one = set.annotations.at(i);
        if (one.type != AnnotationType::region)
            fail_input(name_of(one), "is a " + to_string(one.type) + ", which holds no surface", "name a region");
        for (const Index f : one.faces) keep[f] = value;
    }
}

/// Whether the border halfedge of the piece was an interior edge of the whole mesh.
bool was_cut(const Mesh& whole, const CutPart& part, Halfedge border) {
    const Vertex from(part.vertices[part.mesh.source(border)]), to(part.vertices[part.mesh.target(border)]);
    const Halfedge before = whole.halfedge(from, to);
    return before != Mesh::null_halfedge() && !whole.is_border(before) && !whole.is_border(whole.opposite(before));
}

void close_cuts(CutPart& part, const std::vector<Halfedge>& cuts) {
    const std::size_t before = part.mesh.number_of_faces();
    for (const Halfedge border : cuts)
        if (close_hole(part.mesh, border) > 0) ++part.closed;
    const std::size_t after = part.mesh.number_of_faces();
    part.faces.resize(after, no_index);
    for (Annotation& one : part.annotations.annotations)
        if (one.all) {
            one.faces.resize(after);
            std::iota(one.faces.begin(), one.faces.end(), Index{0});
        }
    if (after == before) return;
    Annotation cap;
    cap.id = free_id(part.annotations);
    cap.tag = "cut";
    for (std::size_t f = before; f < after; ++f) cap.faces.push_back(static_cast<Index>(f));
    cap.colour = unused_colour(part, cap);
    part.annotations.annotations.push_back(std::move(cap));
}

}  // namespace

CutPart cut_out_part(AnnotatedMeshView object, const std::vector<std::size_t>& regions, const std::vector<std::size_t>& left_out,
                     bool close) {
    CutPart part;
    if (any_free(object.annotations)) part.whole.emplace(cut_along_curves(object));
    const AnnotatedMeshView whole = part.whole ? AnnotatedMeshView(*part.whole) : object;
    std::vector<bool> keep(whole.mesh.number_of_faces(), regions.empty());
    mark(whole.annotations, regions, true, keep);
    mark(whole.annotations, left_out, false, keep);
    SubMesh piece = keep_faces(whole.mesh, keep);
    if (piece.faces.empty())
        fail_input("annotations", "nothing is left of the part", left_out.empty() ? "name another one" : "leave fewer parts out");
    part.mesh = std::move(piece.mesh);
    part.vertices = std::move(piece.vertices);
    part.faces = std::move(piece.faces);
    part.annotations = annotations_of_piece(whole, part.mesh, part.vertices, part.faces);
    std::vector<Halfedge> cuts;
    for (const Halfedge hole : holes_of(part.mesh)) {
        bool cut = false;
        for (Halfedge h = hole;;) {
            cut = cut || was_cut(whole.mesh, part, h);
            h = part.mesh.next(h);
            if (cut || h == hole) break;
        }
        if (cut) cuts.push_back(hole);
    }
    part.cuts = cuts.size();
    if (close) close_cuts(part, cuts);
    return part;
}

}  // namespace ostraka
