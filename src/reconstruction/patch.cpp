#include "reconstruction/patch.h"

#include <algorithm>
#include <utility>

namespace ostraka {

Patch::Patch(const Mesh& mesh, std::vector<bool> keep, double minimum) : mesh_(mesh), keep_(std::move(keep)), minimum_(minimum) {
    regularise({mesh.vertices().begin(), mesh.vertices().end()});
}

std::size_t Patch::size() const { return static_cast<std::size_t>(std::count(keep_.begin(), keep_.end(), true)); }

void Patch::erode(std::vector<Vertex> vertices, int rings) {
    std::vector<Vertex> touched;
    for (; rings > 0; --rings) {
        std::vector<Vertex> next;
        for (const Vertex v : vertices)
            for (const Face face : mesh_.faces_around_target(mesh_.halfedge(v))) {
                if (face == Mesh::null_face() || !keep_[face]) continue;
                keep_[face] = false;
                for (const Vertex corner : corners(mesh_, face)) next.push_back(corner);
            }
        touched.insert(touched.end(), next.begin(), next.end());
        vertices = std::move(next);
    }
    regularise(std::move(touched));
}

void Patch::regularise(std::vector<Vertex> stack) {
    open_fans(std::move(stack));
    const Pieces pieces = drop_small_pieces();
    find_closed(pieces);
    find_loops();
}

bool Patch::keeps(Halfedge h) const { return !mesh_.is_border(h) && keep_[mesh_.face(h)]; }

void Patch::open_fans(std::vector<Vertex> stack) {
    while (!stack.empty()) {
        const Vertex v = stack.back();
        stack.pop_back();
        if (mesh_.is_isolated(v)) continue;
        int border_count = 0;
        for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) border_count += is_border(h) ? 1 : 0;
        if (border_count < 2) continue;
        for (const Halfedge h : mesh_.halfedges_around_target(mesh_.halfedge(v))) {
            if (!keeps(h)) continue;
            keep_[mesh_.face(h)] = false;
            for (const Vertex other : corners(mesh_, mesh_.face(h)))
                if (other != v) stack.push_back(other);
        }
    }
}

Patch::Pieces Patch::drop_small_pieces() {
    Pieces pieces{std::vector<int>(keep_.size(), -1), {}};
    double total_area = 0;
    for (const Face seed : mesh_.faces()) {
        total_area += face_area(mesh_, seed);
        if (!keep_[seed] || pieces.of_face[seed] >= 0) continue;
        const int number = static_cast<int>(pieces.area.size());
        pieces.area.push_back(0);
        std::vector<Face> todo{seed};
        pieces.of_face[seed] = number;
        while (!todo.empty()) {
            const Face face = todo.back();
            todo.pop_back();
            pieces.area.back() += face_area(mesh_, face);
            for (const Halfedge h : mesh_.halfedges_around_face(mesh_.halfedge(face))) {
                const Halfedge other = mesh_.opposite(h);
                if (!keeps(other) || pieces.of_face[mesh_.face(other)] >= 0) continue;
                pieces.of_face[mesh_.face(other)] = number;
                todo.push_back(mesh_.face(other));
            }
        }
    }
    for (const Face face : mesh_.faces())
        if (keep_[face] && !(pieces.area[static_cast<std::size_t>(pieces.of_face[face])] >= minimum_ * total_area))
            keep_[face] = false;
    return pieces;
}

void Patch::find_closed(const Pieces& pieces) {
    closed_.clear();
    std::vector<bool> is_done(pieces.area.size(), false);
    for (const Halfedge h : mesh_.halfedges())
        if (is_border(h)) is_done[static_cast<std::size_t>(pieces.of_face[mesh_.face(h)])] = true;
    for (const Face face : mesh_.faces()) {
        if (!keep_[face] || is_done[static_cast<std::size_t>(pieces.of_face[face])]) continue;
        is_done[static_cast<std::size_t>(pieces.of_face[face])] = true;
        closed_.push_back(face);
    }
}

void Patch::find_loops() {
    loops_.clear();
    std::vector<Vertex> next(mesh_.number_of_vertices(), Mesh::null_vertex());
    for (const Halfedge h : mesh_.halfedges())
        if (is_border(h)) next[mesh_.source(h)] = mesh_.target(h);
    for (const Vertex start : mesh_.vertices()) {
        if (next[start] == Mesh::null_vertex()) continue;
        loops_.emplace_back();
        for (Vertex v = start; next[v] != Mesh::null_vertex();) {
            loops_.back().push_back(v);
            v = std::exchange(next[v], Mesh::null_vertex());
        }
    }
}

}  // namespace ostraka
