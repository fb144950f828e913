#include "break_side.h"

#include "facet_evidence.h"
#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/geom/eigen.h"

#include <cmath>

namespace ostraka {

using Eigen::Vector3d;

SurfaceSamples sample_faces(const Mesh& mesh, const std::vector<Vector>& normals, const std::vector<bool>& chosen, int count) {
    SurfaceSamples samples;
    for (const Face face : mesh.faces())
        if (chosen[face]) samples.area += face_area(mesh, face);
    if (!(samples.area > 0)) return samples;
    // Within a face the points follow a sequence of low discrepancy (Roberts 2018), so that large faces are covered evenly too.
    double sum = 0, next = 0.5 * samples.area / count;
    std::size_t drawn = 0;
    for (const Face face : mesh.faces()) {
        if (!chosen[face]) continue;
        sum += face_area(mesh, face);
        const auto [a, b, c] = corners(mesh, face);
        while (next < sum && drawn < static_cast<std::size_t>(count)) {
            ++drawn;
            double u = std::fmod(0.5 + 0.7548776662466927 * static_cast<double>(drawn), 1),
                   v = std::fmod(0.5 + 0.5698402909980532 * static_cast<double>(drawn), 1);
            if (u + v > 1) u = 1 - u, v = 1 - v;
            samples.places.push_back((1 - u - v) * eigen(mesh.point(a)) + u * eigen(mesh.point(b)) + v * eigen(mesh.point(c)));
            samples.normals.push_back(eigen(normals[face]));
            next += samples.area / count;
        }
    }
    return samples;
}

std::vector<Point> places_of(const std::vector<RimFrame>& frames) {
    std::vector<Point> points;
    for (const RimFrame& frame : frames) points.push_back(point_of(frame.place));
    return points;
}

Eigen::Matrix3d RimFrame::axes() const {
    Eigen::Matrix3d axes;
    axes << side, fracture, side.cross(fracture);
    return axes;
}

Motion RimFrame::onto(const RimFrame& other) const {
    Eigen::Matrix3d goal;
    goal << other.side, -other.fracture, -other.side.cross(other.fracture);
    Motion motion;
    motion.rotation = goal * axes().transpose();
    motion.translation = other.place - motion.rotation * place;
    return motion;
}

double fragment_size(const Mesh& mesh) { return std::sqrt(surface_area(mesh)); }

BreakSide::BreakSide(const Fragment& fragment, double radius, int frame_count, int sample_count) {
    const Mesh& mesh = fragment.mesh;
    const std::string where = "fragment " + fragment.name;
    const std::vector<Vector> normals = filtered_normals(mesh, 0.01 * fragment_size(mesh));
    std::vector<bool> whole = not_broken(fragment.facets);
    whole.resize(mesh.number_of_faces(), true);
    std::vector<bool> broken = whole;
    broken.flip();
    fracture = sample_faces(mesh, normals, broken, sample_count);
    if (fracture.places.empty())
        fail_input(where, "has no fracture that could be laid against another one",
                   "annotate a region \"fracture\", or look for it with --facets auto");
    intact = sample_faces(mesh, normals, whole, sample_count);

    std::vector<Point> centroids;
    for (const Face face : mesh.faces()) centroids.push_back(centroid(mesh, face));
    const PointTree tree(centroids);
    struct RimEdge {
        Edge edge;
        Face broken, side;
        double length;
    };
    std::vector<RimEdge> rim;
    for (const Edge e : mesh.edges()) {
        const Halfedge h = mesh.halfedge(e);
        Face f = mesh.face(h), g = mesh.face(mesh.opposite(h));
        if (f == Mesh::null_face() || g == Mesh::null_face() || broken[f] == broken[g]) continue;
        if (broken[g]) std::swap(f, g);
        const double length = std::sqrt(CGAL::squared_distance(mesh.point(mesh.vertex(e, 0)), mesh.point(mesh.vertex(e, 1))));
        rim.push_back({e, f, g, length});
        rim_length += length;
    }
    if (rim.empty())
        fail_input(where, "has a fracture without a rim: all of it is broken", "annotate what of it is \"outer\" surface");
    std::vector<RimEdge> places;
    double sum = 0, next = 0.5 * rim_length / frame_count;
    for (const RimEdge& edge : rim) {
        sum += edge.length;
        if (next >= sum) continue;
        places.push_back(edge);
        while (next < sum) next += rim_length / frame_count;
    }
    std::vector<RimFrame> found(places.size());
    std::vector<char> sound(places.size(), 0);
    parallel_for(
        places.size(),
        [&](std::size_t i) {
            const RimEdge& edge = places[i];
            RimFrame& frame = found[i];
            frame.facet = fragment.facets[edge.side];
            frame.place = 0.5 * (eigen(mesh.point(mesh.vertex(edge.edge, 0))) + eigen(mesh.point(mesh.vertex(edge.edge, 1))));
            Vector3d side = Vector3d::Zero(), across = Vector3d::Zero();
            std::vector<Index> near;
            tree.within(point_of(frame.place), radius, near);
            near.push_back(edge.side);
            near.push_back(edge.broken);
            for (const Index f : near) {
                // Of the other side of a thin wall nothing.
                if (fragment.facets[f] == frame.facet && normals[f] * normals[edge.side] > 0)
                    side += face_area(mesh, Face(f)) * eigen(normals[f]);
                else if (broken[f] && normals[f] * normals[edge.broken] > 0)
                    across += face_area(mesh, Face(f)) * eigen(normals[f]);
            }
            if (!(side.norm() > 0)) return;
            frame.side = side.normalized();
            across -= across.dot(frame.side) * frame.side;
            if (!(across.norm() > 0)) return;
            frame.fracture = across.normalized();
            sound[i] = 1;
        },
        16);
    for (std::size_t i = 0; i < found.size(); ++i)
        if (sound[i] != 0) frames.push_back(found[i]);
    if (frames.empty()) fail_input(where, "has a rim whose surfaces have no normals", "repair it: run 'ostraka mesh repair'");
}

BreakSide BreakSide::moved(const Motion& motion) const {
    BreakSide result = *this;
    for (RimFrame& frame : result.frames) {
        frame.place = motion(frame.place);
        frame.side = motion.rotation * frame.side;
        frame.fracture = motion.rotation * frame.fracture;
    }
    for (SurfaceSamples* samples : {&result.fracture, &result.intact}) {
        for (Vector3d& p : samples->places) p = motion(p);
        for (Vector3d& n : samples->normals) n = motion.rotation * n;
    }
    return result;
}

SampleGrid::SampleGrid(const std::vector<Vector3d>& places, double margin) {
    Vector3d low = places.front(), high = low;
    for (const Vector3d& p : places) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    low_ = low - Vector3d::Constant(margin);
    const Vector3d extent = high - low + Vector3d::Constant(2 * margin);
    constexpr double cells = 64;
    width_ = extent.maxCoeff() / cells;
    for (std::size_t k = 0; k < 3; ++k) count_[k] = static_cast<std::size_t>(extent[static_cast<Eigen::Index>(k)] / width_) + 1;
    nearest_.resize(count_[0] * count_[1] * count_[2]);
    const PointTree tree(points_of(places));
    const double far = 4 * extent.sum();
    parallel_for(
        count_[1] * count_[2],
        [&](std::size_t row) {
            for (std::size_t x = 0; x < count_[0]; ++x) {
                const Vector3d middle =
                    low_ + width_ * Vector3d(static_cast<double>(x) + 0.5, static_cast<double>(row % count_[1]) + 0.5,
                                             static_cast<double>(row / count_[1]) + 0.5);
                nearest_[row * count_[0] + x] = tree.nearest(point_of(middle), far).index;
            }
        },
        16);
}

}  // namespace ostraka
