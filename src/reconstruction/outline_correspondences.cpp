#include "reconstruction/outline_correspondences.h"

#include "ostraka/annotation/outline.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace ostraka {

std::vector<VertexPath> vertex_paths_of(const Mesh& mesh, const Annotation& part, const std::vector<bool>& broken) {
    std::vector<VertexPath> vertex_paths;
    for (const auto& line : part.polylines) {
        const bool closed = line.size() > 2 && line.front() == line.back();
        vertex_paths.push_back({std::vector<Index>(line.begin(), line.end() - (closed ? 1 : 0)), closed});
    }
    if (part.type != AnnotationType::region) return vertex_paths;
    const auto ends_object = [&](Halfedge h) { return mesh.is_border(h) || (!broken.empty() && broken[mesh.face(h)]); };
    for (const Outline& loop : extract_outlines(mesh, part.faces)) {
        const std::size_t n = loop.size();
        std::vector<bool> ends(n, false);  // the edge that begins here does not belong to the annotation
        for (std::size_t i = 0; i < n; ++i) {
            const Halfedge h = find_halfedge(mesh, Vertex(loop[i]), Vertex(loop[(i + 1) % n]));
            ends[i] = h == Mesh::null_halfedge() || ends_object(h) || ends_object(mesh.opposite(h));
        }
        const auto first = std::find(ends.begin(), ends.end(), true);
        if (first == ends.end()) {
            vertex_paths.push_back({loop, true});
            continue;
        }
        const auto begin = static_cast<std::size_t>(first - ends.begin());
        VertexPath vertex_path;
        for (std::size_t k = 1; k <= n; ++k) {
            const std::size_t i = (begin + k) % n;
            vertex_path.vertices.push_back(loop[i]);
            if (!ends[i]) continue;
            if (vertex_path.vertices.size() > 1) vertex_paths.push_back(vertex_path);
            vertex_path.vertices.clear();
        }
    }
    return vertex_paths;
}

namespace {

/// A vertex path with the arc length of each of its vertices from the first.
struct ArcLengthPath {
    explicit ArcLengthPath(const Mesh& mesh, VertexPath path) : vertex_path(std::move(path)) {
        for (const Index v : vertex_path.vertices) places.push_back(eigen(mesh.point(Vertex(v))));
        for (std::size_t i = 0; i < places.size(); ++i) {
            arc_lengths.push_back(length);
            if (i + 1 < places.size() || vertex_path.closed) length += (places[(i + 1) % places.size()] - places[i]).norm();
        }
    }
    /// The point at an arc length; a closed path continues at its start.
    [[nodiscard]] Vector3d place(double arc_length) const {
        if (vertex_path.closed) arc_length -= length * std::floor(arc_length / length);
        const auto after = std::upper_bound(arc_lengths.begin(), arc_lengths.end(), arc_length);
        const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - arc_lengths.begin() - 1));
        const std::size_t next = (i + 1) % places.size();
        if (next == 0 && !vertex_path.closed) return places.back();
        const double edge = (places[next] - places[i]).norm();
        const double fraction = edge > 0 ? std::clamp((arc_length - arc_lengths[i]) / edge, 0.0, 1.0) : 0;
        return (1 - fraction) * places[i] + fraction * places[next];
    }

    VertexPath vertex_path;
    std::vector<Vector3d> places;
    std::vector<double> arc_lengths;
    double length = 0;
};

std::vector<ArcLengthPath> arc_length_paths_of(const Mesh& mesh, std::vector<VertexPath> vertex_paths) {
    std::vector<ArcLengthPath> paths;
    for (VertexPath& vertex_path : vertex_paths) {
        if (vertex_path.vertices.size() < 2) continue;
        ArcLengthPath path(mesh, std::move(vertex_path));
        if (path.length > 0) paths.push_back(std::move(path));
    }
    return paths;
}

/// The path on which a vertex lies and its arc length there; -1 if it is on none.
std::pair<int, double> on_vertex_path(const std::vector<ArcLengthPath>& paths, const Vector3d& place) {
    std::pair<int, double> result{-1, 0};
    double minimum = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < paths.size(); ++c)
        for (std::size_t i = 0; i < paths[c].places.size(); ++i) {
            const double distance = (paths[c].places[i] - place).norm();
            if (distance >= minimum || distance > 0.05 * paths[c].length) continue;
            minimum = distance;
            result = {static_cast<int>(c), paths[c].arc_lengths[i]};
        }
    return result;
}

struct PathCorrespondences {
    std::vector<OutlineCorrespondence> correspondences;
    std::size_t pieces = 0;  ///< number of intervals between consecutive landmarks on both paths
};

/// Correspondences of one path from the landmarks on it (arc lengths on ours and theirs). Lengths on theirs are `scale` times
/// those on ours.
PathCorrespondences correspondences_along(const ArcLengthPath& ours, const ArcLengthPath& theirs,
                                          std::vector<std::pair<double, double>> marks, double scale) {
    constexpr double share_beyond = 0.25;
    std::sort(marks.begin(), marks.end());
    marks.erase(std::unique(marks.begin(), marks.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
                marks.end());
    const std::size_t n = marks.size();
    struct Piece {
        double from, to, there_from, there_to;
    };
    std::vector<Piece> pieces;
    double known_length = 0, known_length_there = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const bool last = k + 1 == n;
        if (last && !ours.vertex_path.closed) break;
        const auto& [a, b] = marks[k];
        auto [c, d] = marks[(k + 1) % n];
        if (last) c += ours.length;
        if (theirs.vertex_path.closed && (d < b || (n == 1 && d <= b))) d += theirs.length;
        if (!(d > b)) continue;  // interrupted on their side
        if ((d - b) > 2 * scale * (c - a) || scale * (c - a) > 2 * (d - b)) continue;
        pieces.push_back({a, c, b, d});
        known_length += c - a;
        known_length_there += d - b;
    }
    const double ratio = known_length > 0 ? known_length_there / known_length : scale;
    PathCorrespondences result;
    result.pieces = pieces.size();
    for (std::size_t i = 0; i < ours.places.size(); ++i) {
        const std::size_t count = ours.places.size();
        double length = 0;
        if (i > 0 || ours.vertex_path.closed) length += 0.5 * (ours.places[i] - ours.places[(i + count - 1) % count]).norm();
        if (i + 1 < count || ours.vertex_path.closed) length += 0.5 * (ours.places[(i + 1) % count] - ours.places[i]).norm();
        OutlineCorrespondence correspondence{ours.vertex_path.vertices[i], Vector3d::Zero(), length};
        bool is_found = false;
        for (const double arc_length : {ours.arc_lengths[i], ours.arc_lengths[i] + ours.length}) {
            if (arc_length > ours.length && !ours.vertex_path.closed) break;
            for (const Piece& piece : pieces) {
                if (is_found || arc_length < piece.from || arc_length > piece.to) continue;
                const double fraction = piece.to > piece.from ? (arc_length - piece.from) / (piece.to - piece.from) : 0;
                correspondence.place = theirs.place(piece.there_from + fraction * (piece.there_to - piece.there_from));
                is_found = true;
            }
        }
        if (!is_found) {
            // From the nearest landmark, in either direction.
            double nearest = std::numeric_limits<double>::infinity(), their_arc_length = 0;
            for (const auto& [a, b] : marks)
                for (const double wrap : {-1.0, 0.0, 1.0}) {
                    if (wrap != 0 && !ours.vertex_path.closed) continue;
                    const double offset = ours.arc_lengths[i] + wrap * ours.length - a;
                    if (std::abs(offset) >= nearest) continue;
                    nearest = std::abs(offset);
                    their_arc_length = b + ratio * offset;
                }
            if (!std::isfinite(nearest) ||
                (!theirs.vertex_path.closed && (their_arc_length < 0 || their_arc_length > theirs.length)))
                continue;
            // Near the opposite point of a closed path the position is unreliable.
            if (ours.vertex_path.closed && nearest > 0.4 * ours.length) continue;
            correspondence.place = theirs.place(their_arc_length);
            if (nearest > 0) correspondence.length *= share_beyond;
        }
        result.correspondences.push_back(correspondence);
    }
    return result;
}

double mean_square(const Mesh& mesh, const std::vector<OutlineCorrespondence>& correspondences, double scale) {
    double sum = 0;
    for (const OutlineCorrespondence& correspondence : correspondences)
        sum += (scale * eigen(mesh.point(Vertex(correspondence.vertex))) - correspondence.place).squaredNorm();
    return correspondences.empty() ? std::numeric_limits<double>::infinity() : sum / static_cast<double>(correspondences.size());
}

}  // namespace

std::vector<OutlineCorrespondence> outline_correspondences(const Mesh& mesh, const Annotation& part, const Mesh& fragment,
                                                           const Annotation& of_fragment, const std::vector<bool>& broken,
                                                           const std::vector<std::pair<Index, Index>>& landmarks, double scale) {
    const std::vector<ArcLengthPath> ours = arc_length_paths_of(mesh, vertex_paths_of(mesh, part));
    const auto their_paths = [&](bool reversed) {
        std::vector<VertexPath> vertex_paths = vertex_paths_of(fragment, of_fragment, broken);
        if (reversed)
            for (VertexPath& vertex_path : vertex_paths) std::reverse(vertex_path.vertices.begin(), vertex_path.vertices.end());
        return arc_length_paths_of(fragment, std::move(vertex_paths));
    };
    const std::vector<ArcLengthPath> forward = their_paths(false);
    const bool line = part.type == AnnotationType::line;
    const std::vector<ArcLengthPath> backward = line ? their_paths(true) : std::vector<ArcLengthPath>();
    using Marks = std::vector<std::pair<double, double>>;
    std::map<std::pair<int, int>, std::pair<Marks, Marks>> marks;  // by paths, forward and backward
    for (const auto& [vertex, their_vertex] : landmarks) {
        const Vector3d place = eigen(fragment.point(Vertex(their_vertex)));
        const auto [a, arc_length] = on_vertex_path(ours, eigen(mesh.point(Vertex(vertex))));
        const auto [b, their_arc_length] = on_vertex_path(forward, place);
        if (a < 0 || b < 0) continue;
        auto& path_marks = marks[{a, b}];
        path_marks.first.emplace_back(arc_length, their_arc_length);
        if (line) path_marks.second.emplace_back(arc_length, on_vertex_path(backward, place).second);
    }
    std::vector<OutlineCorrespondence> correspondences;
    for (const auto& [vertex_paths, path_marks] : marks) {
        const ArcLengthPath& path = ours[static_cast<std::size_t>(vertex_paths.first)];
        const auto their_index = static_cast<std::size_t>(vertex_paths.second);
        PathCorrespondences best = correspondences_along(path, forward[their_index], path_marks.first, scale);
        if (line) {
            PathCorrespondences other = correspondences_along(path, backward[their_index], path_marks.second, scale);
            if (other.pieces > best.pieces || (other.pieces == best.pieces && mean_square(mesh, other.correspondences, scale) <
                                                                                  mean_square(mesh, best.correspondences, scale)))
                best = std::move(other);
        }
        correspondences.insert(correspondences.end(), best.correspondences.begin(), best.correspondences.end());
    }
    return correspondences;
}

}  // namespace ostraka
