#include "fracture/fracture_side.h"

#include "fracture/filtered_normals.h"
#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"

#include <cmath>

namespace ostraka {

SurfaceSamples sample_faces(const Mesh& mesh, const std::vector<Vector>& normals, const std::vector<bool>& chosen, int count) {
    SurfaceSamples samples;
    for (const Face face : mesh.faces())
        if (chosen[face]) samples.area += face_area(mesh, face);
    if (!(samples.area > 0)) return samples;
    // Within a face the points follow a low-discrepancy sequence (Roberts 2018), so that large faces are covered evenly too.
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

namespace {

/// The loop with positions and sides averaged over a length of about `radius`, so that the zigzag of the faces does not lengthen
/// it.
RimLoop smoothed(const RimLoop& loop, double radius) {
    const std::size_t n = loop.places.size();
    RimLoop result = loop;
    const auto step = [&](std::size_t k) { return (loop.places[(k + 1) % n] - loop.places[k]).norm(); };
    for (std::size_t k = 0; k < n; ++k) {
        Vector3d place = Vector3d::Zero(), side = Vector3d::Zero();
        double total = 0;
        const auto add = [&](std::size_t i, double distance) {
            const double weight = std::pow(1 - distance / radius, 2) * 0.5 * (step(i) + step((i + n - 1) % n));
            place += weight * loop.places[i];
            side += weight * loop.sides[i];
            total += weight;
        };
        add(k, 0);
        double distance = 0;
        for (std::size_t i = 1; i < n; ++i) {
            if (!loop.closed && k + i >= n) break;
            distance += step((k + i - 1) % n);
            if (distance >= radius) break;
            add((k + i) % n, distance);
        }
        distance = 0;
        for (std::size_t i = 1; i < n; ++i) {
            if (!loop.closed && i > k) break;
            distance += step((k + n - i) % n);
            if (distance >= radius) break;
            add((k + n - i) % n, distance);
        }
        if (total > 0) result.places[k] = place / total;
        if (side.norm() > 0) result.sides[k] = side.normalized();
    }
    return result;
}

/// The rim as ordered loops: edges between fracture and intact faces, followed around their ends.
std::vector<RimLoop> loops_of(const Mesh& mesh, const std::vector<bool>& broken, const std::vector<Vector>& normals,
                              const std::vector<Facet>& facets, double smoothing_radius) {
    const auto on_rim = [&](Halfedge h) {
        const Face f = mesh.face(h), g = mesh.face(mesh.opposite(h));
        return f != Mesh::null_face() && g != Mesh::null_face() && broken[f] && !broken[g];
    };
    // The next or previous edge of the rim: around the shared end, through fracture faces.
    const auto adjacent_rim_edge = [&](Halfedge h, bool after) {
        const auto step = [&](Halfedge g) { return after ? mesh.next(g) : mesh.prev(g); };
        Halfedge g = step(h);
        while (!on_rim(g)) {
            const Halfedge o = mesh.opposite(g);
            if (mesh.is_border(o)) return Mesh::null_halfedge();
            g = step(o);
        }
        return g;
    };
    std::vector<bool> visited(mesh.num_halfedges(), false);
    std::vector<RimLoop> loops;
    for (const Halfedge start : mesh.halfedges()) {
        if (visited[start] || !on_rim(start)) continue;
        RimLoop loop;
        Halfedge first = start;
        for (Halfedge h = adjacent_rim_edge(start, false); h != start; h = adjacent_rim_edge(h, false)) {
            if (h == Mesh::null_halfedge()) {
                loop.closed = false;
                break;
            }
            first = h;
        }
        if (loop.closed) first = start;
        for (Halfedge h = first; h != Mesh::null_halfedge() && !visited[h]; h = adjacent_rim_edge(h, true)) {
            visited[h] = true;
            const Face side = mesh.face(mesh.opposite(h));
            loop.places.push_back(0.5 * (eigen(mesh.point(mesh.source(h))) + eigen(mesh.point(mesh.target(h)))));
            loop.sides.push_back(eigen(normals[side]));
            loop.facets.push_back(facets[side]);
        }
        if (loop.places.size() >= 3) loops.push_back(smoothed(loop, smoothing_radius));
    }
    return loops;
}

}  // namespace

double fragment_size(const Mesh& mesh) { return std::sqrt(surface_area(mesh)); }

FractureSide::FractureSide(const Fragment& fragment, double radius, int frame_count, int sample_count) {
    const Mesh& mesh = fragment.mesh;
    const std::string where = "fragment " + fragment.name;
    const std::vector<Vector> normals = filtered_normals(mesh, 0.01 * fragment_size(mesh));
    std::vector<bool> is_intact = intact_faces(fragment.facets);
    is_intact.resize(mesh.number_of_faces(), true);
    std::vector<bool> is_fracture = is_intact;
    is_fracture.flip();
    fracture = sample_faces(mesh, normals, is_fracture, sample_count);
    if (fracture.places.empty())
        fail_input(where, "has no fracture surface to match with another one",
                   "annotate a region \"fracture\", or detect it with --facets auto");
    intact = sample_faces(mesh, normals, is_intact, sample_count);

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
        if (f == Mesh::null_face() || g == Mesh::null_face() || is_fracture[f] == is_fracture[g]) continue;
        if (is_fracture[g]) std::swap(f, g);
        const double length = std::sqrt(CGAL::squared_distance(mesh.point(mesh.vertex(e, 0)), mesh.point(mesh.vertex(e, 1))));
        rim.push_back({e, f, g, length});
        rim_length += length;
    }
    // On a wide fracture the radius of a frame grows, so that neither relief nor rounded edges tilt it.
    const double fracture_width = rim_length > 0 ? 2 * fracture.area / rim_length : 0, size = fragment_size(mesh),
                 frame_radius = std::max(radius, std::min(0.25 * fracture_width, 0.1 * size));
    if (rim.empty())
        fail_input(where, "has a fracture surface without a rim: it covers the whole fragment",
                   "annotate its intact surface as \"outer\"");
    std::vector<RimEdge> places;
    double sum = 0, next = 0.5 * rim_length / frame_count;
    for (const RimEdge& edge : rim) {
        sum += edge.length;
        if (next >= sum) continue;
        places.push_back(edge);
        while (next < sum) next += rim_length / frame_count;
    }
    std::vector<RimFrame> candidate_frames(places.size());
    std::vector<char> valid(places.size(), 0);
    parallel_for(places.size(), 16, [&](std::size_t i) {
        const RimEdge& edge = places[i];
        RimFrame& frame = candidate_frames[i];
        frame.facet = fragment.facets[edge.side];
        frame.place = 0.5 * (eigen(mesh.point(mesh.vertex(edge.edge, 0))) + eigen(mesh.point(mesh.vertex(edge.edge, 1))));
        Vector3d side = Vector3d::Zero(), across = Vector3d::Zero(), beside = Vector3d::Zero();
        double area = 0;
        std::vector<Index> near_faces;
        tree.within(point_of(frame.place), frame_radius, near_faces);
        near_faces.push_back(edge.side);
        near_faces.push_back(edge.broken);
        for (const Index f : near_faces) {
            // Ignores the other side of a thin wall.
            if (fragment.facets[f] == frame.facet && normals[f] * normals[edge.side] > 0) {
                const double weight = face_area(mesh, Face(f));
                side += weight * eigen(normals[f]);
                beside += weight * eigen(centroids[f]);
                area += weight;
            } else if (is_fracture[f] && normals[f] * normals[edge.broken] > 0)
                across += face_area(mesh, Face(f)) * eigen(normals[f]);
        }
        if (!(side.norm() > 0)) return;
        frame.side = side.normalized();
        frame.beside = beside / area;
        across -= across.dot(frame.side) * frame.side;
        if (!(across.norm() > 0)) return;
        frame.fracture = across.normalized();
        valid[i] = 1;
    });
    for (std::size_t i = 0; i < candidate_frames.size(); ++i)
        if (valid[i] != 0) frames.push_back(candidate_frames[i]);
    loops = loops_of(mesh, is_fracture, normals, fragment.facets, 0.4 * radius);
    if (frames.empty()) fail_input(where, "has a rim whose surfaces have no normals", "repair it: run 'ostraka mesh repair'");
}

FractureSide FractureSide::moved(const Motion& motion) const {
    FractureSide result = *this;
    for (RimFrame& frame : result.frames) {
        frame.place = motion(frame.place);
        frame.beside = motion(frame.beside);
        frame.side = motion.rotation * frame.side;
        frame.fracture = motion.rotation * frame.fracture;
    }
    for (RimLoop& loop : result.loops) {
        for (Vector3d& p : loop.places) p = motion(p);
        for (Vector3d& n : loop.sides) n = motion.rotation * n;
    }
    for (SurfaceSamples* samples : {&result.fracture, &result.intact}) {
        for (Vector3d& p : samples->places) p = motion(p);
        for (Vector3d& n : samples->normals) n = motion.rotation * n;
    }
    return result;
}

SampleGrid::SampleGrid(const std::vector<Vector3d>& places, double margin, int cells) {
    Vector3d low = places.front(), high = low;
    for (const Vector3d& p : places) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    low_ = low - Vector3d::Constant(margin);
    const Vector3d extent = high - low + Vector3d::Constant(2 * margin);
    width_ = extent.maxCoeff() / cells;
    for (std::size_t k = 0; k < 3; ++k) count_[k] = static_cast<std::size_t>(extent[static_cast<Eigen::Index>(k)] / width_) + 1;
    nearest_.resize(count_[0] * count_[1] * count_[2]);
    const PointTree tree(points_of(places));
    const double max_distance = 4 * extent.sum();
    parallel_for(count_[1] * count_[2], 16, [&](std::size_t row) {
        // The nearest sample of the previous cell bounds the distance for this cell.
        double bound = max_distance;
        const std::size_t y = row % count_[1], z = row / count_[1];
        for (std::size_t x = 0; x < count_[0]; ++x) {
            const Vector3d middle = low_ + width_ * Vector3d(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5,
                                                             static_cast<double>(z) + 0.5);
            if (x > 0) bound = (1 + 1e-9) * (places[nearest_[row * count_[0] + x - 1]] - middle).norm();
            nearest_[row * count_[0] + x] = tree.nearest(point_of(middle), bound).index;
        }
    });
}

}  // namespace ostraka
