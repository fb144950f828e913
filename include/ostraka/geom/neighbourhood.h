// Finds the vertices or faces inside a ball that are connected with the centre within the ball.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <algorithm>
#include <vector>

namespace ostraka {

/// Traverses neighbourhoods on one mesh without repeated allocation; each thread needs its own object.
class Neighbourhood {
public:
    /// Calls visit(vertex, squared distance) for `centre` and for each vertex closer than `radius` that is connected with
    /// `centre` by a path of edges inside the ball; the order of the calls depends only on the mesh.
    template <class Visit>
    void walk(const Mesh& mesh, Vertex centre, double radius, Visit&& visit) {
        begin(mesh.number_of_vertices());
        const Point& middle = mesh.point(centre);
        const double limit = radius * radius;
        front_.assign(1, centre);
        stamps_[centre] = stamp_;
        visit(centre, 0.0);
        for (std::size_t i = 0; i < front_.size(); ++i) {
            const Halfedge first = mesh.halfedge(front_[i]);
            if (first == Mesh::null_halfedge()) return;
            Halfedge h = first;  // halfedges into the vertex, around it
            do {
                const Vertex next = mesh.source(h);
                if (stamps_[next] != stamp_) {
                    stamps_[next] = stamp_;
                    const double squared = CGAL::squared_distance(mesh.point(next), middle);
                    if (squared < limit) {
                        front_.push_back(next);
                        visit(next, squared);
                    }
                }
                h = mesh.opposite(mesh.next(h));
            } while (h != first);
        }
    }

    /// Calls visit(face, squared distance) for the face `centre` and for each face whose centroid is closer than `radius` and
    /// that is connected with `centre` across edges inside the ball; the order of the calls depends only on the mesh.
    template <class Visit>
    void walk(const Mesh& mesh, const std::vector<Point>& centroids, Face centre, double radius, Visit&& visit) {
        begin(mesh.number_of_faces());
        const double limit = radius * radius;
        faces_.assign(1, centre);
        stamps_[centre] = stamp_;
        visit(centre, 0.0);
        for (std::size_t i = 0; i < faces_.size(); ++i) {
            Halfedge h = mesh.halfedge(faces_[i]);
            for (int k = 0; k < 3; ++k, h = mesh.next(h)) {
                const Face next = mesh.face(mesh.opposite(h));
                if (next == Mesh::null_face() || stamps_[next] == stamp_) continue;
                stamps_[next] = stamp_;
                const double squared = CGAL::squared_distance(centroids[next], centroids[centre]);
                if (!(squared < limit)) continue;
                faces_.push_back(next);
                visit(next, squared);
            }
        }
    }

private:
    void begin(std::size_t count) {
        if (stamps_.size() < count) stamps_.resize(count, 0);
        if (++stamp_ == 0) {
            std::fill(stamps_.begin(), stamps_.end(), 0);
            stamp_ = 1;
        }
    }

    std::vector<std::uint32_t> stamps_;
    std::uint32_t stamp_ = 0;
    std::vector<Vertex> front_;
    std::vector<Face> faces_;
};

/// The Neighbourhood object of the current thread; the result of a walk does not depend on earlier walks.
inline Neighbourhood& this_threads_neighbourhood() {
    static thread_local Neighbourhood neighbourhood;
    return neighbourhood;
}

}  // namespace ostraka
