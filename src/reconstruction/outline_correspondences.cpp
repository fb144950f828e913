#include "outline_correspondences.h"

#include "ostraka/annotation/outline.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace ostraka {

using Eigen::Vector3d;

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
    explicit ArcLengthPath(const Mesh& mesh, VertexPath of) : vertex_path(std::move(of)) {
        for (const Index v : vertex_path.vertices) places.push_back(eigen(mesh.point(Vertex(v))));
        for (std::size_t i = 0; i < places.size(); ++i) {
            at.push_back(length);
            if (i + 1 < places.size() || vertex_path.closed) length += (places[(i + 1) % places.size()] - places[i]).norm();
        }
    }
    /// The point at an arc length; a closed path continues at its start.
    [[nodiscard]] Vector3d place(double way) const {
        if (vertex_path.closed) way -= length * std::floor(way / length);
        const auto after = std::upper_bound(at.begin(), at.end(), way);
        const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - at.begin() - 1));
        const std::size_t next = (i + 1) % places.size();
        if (next == 0 && !vertex_path.closed) return places.back();
        const double edge = (places[next] - places[i]).norm();
        const double share = edge > 0 ? std::clamp((way - at[i]) / edge, 0.0, 1.0) : 0;
        return (1 - share) * places[i] + share * places[next];
    }

    VertexPath vertex_path;
    std::vector<Vector3d> places;
    std::vector<double> at;
    double length = 0;
};

std::vector<ArcLengthPath> arc_length_paths_of(const Mesh& mesh, std::vector<VertexPath> vertex_paths) {
    std::vector<ArcLengthPath> ways;
    for (VertexPath& vertex_path : vertex_paths) {
        if (vertex_path.vertices.size() < 2) continue;
        ArcLengthPath way(mesh, std::move(vertex_path));
        if (way.length > 0) ways.push_back(std::move(way));
    }
    return ways;
}

/// The path on which a vertex lies and its arc length there; -1 if it is on none.
std::pair<int, double> on_vertex_path(const std::vector<ArcLengthPath>& ways, const Vector3d& place) {
    std::pair<int, double> found{-1, 0};
    double minimum = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < ways.size(); ++c)
        for (std::size_t i = 0; i < ways[c].places.size(); ++i) {
            const double distance = (ways[c].places[i] - place).norm();
            if (distance >= minimum || distance > 0.05 * ways[c].length) continue;
            minimum = distance;
            found = {static_cast<int>(c), ways[c].at[i]};
        }
    return found;
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
    double known = 0, known_there = 0;
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
        known += c - a;
        known_there += d - b;
    }
    const double ratio = known > 0 ? known_there / known : scale;
    PathCorrespondences result;
    result.pieces = pieces.size();
    for (std::size_t i = 0; i < ours.places.size(); ++i) {
        const std::size_t count = ours.places.size();
        double length = 0;
        if (i > 0 || ours.vertex_path.closed) length += 0.5 * (ours.places[i] - ours.places[(i + count - 1) % count]).norm();
        if (i + 1 < count || ours.vertex_path.closed) length += 0.5 * (ours.places[(i + 1) % count] - ours.places[i]).norm();
        OutlineCorrespondence correspondence{ours.vertex_path.vertices[i], Vector3d::Zero(), length};
        bool found = false;
        for (const double way : {ours.at[i], ours.at[i] + ours.length}) {
            if (way > ours.length && !ours.vertex_path.closed) break;
            for (const Piece& piece : pieces) {
                if (found || way < piece.from || way > piece.to) continue;
                const double share = piece.to > piece.from ? (way - piece.from) / (piece.to - piece.from) : 0;
                correspondence.place = theirs.place(piece.there_from + share * (piece.there_to - piece.there_from));
                found = true;
            }
        }
        if (!found) {
            // From the nearest landmark, in either direction.
            double nearest = std::numeric_limits<double>::infinity(), there = 0;
            for (const auto& [a, b] : marks)
                for (const double turn : {-1.0, 0.0, 1.0}) {
                    if (turn != 0 && !ours.vertex_path.closed) continue;
                    const double off = ours.at[i] + turn * ours.length - a;
                    if (std::abs(off) >= nearest) continue;
                    nearest = std::abs(off);
                    there = b + ratio * off;
                }
            if (!std::isfinite(nearest) || (!theirs.vertex_path.closed && (there < 0 || there > theirs.length))) continue;
            // Near the opposite point of a closed path the position is unreliable.
            if (ours.vertex_path.closed && nearest > 0.4 * ours.length) continue;
            correspondence.place = theirs.place(there);
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
    const auto theirs_turned = [&](bool turned) {
        std::vector<VertexPath> vertex_paths = vertex_paths_of(fragment, of_fragment, broken);
        if (turned)
            for (VertexPath& vertex_path : vertex_paths) std::reverse(vertex_path.vertices.begin(), vertex_path.vertices.end());
        return arc_length_paths_of(fragment, std::move(vertex_paths));
    };
    const std::vector<ArcLengthPath> forward = theirs_turned(false);
    const bool line = part.type == AnnotationType::line;
    const std::vector<ArcLengthPath> backward = line ? theirs_turned(true) : std::vector<ArcLengthPath>();
    using Marks = std::vector<std::pair<double, double>>;
    std::map<std::pair<int, int>, std::pair<Marks, Marks>> marks;  // by paths, forward and backward
    for (const auto& [vertex, there] : landmarks) {
        const Vector3d place = eigen(fragment.point(Vertex(there)));
        const auto [a, way] = on_vertex_path(ours, eigen(mesh.point(Vertex(vertex))));
        const auto [b, way_there] = on_vertex_path(forward, place);
        if (a < 0 || b < 0) continue;
        auto& both = marks[{a, b}];
        both.first.emplace_back(way, way_there);
        if (line) both.second.emplace_back(way, on_vertex_path(backward, place).second);
    }
    std::vector<OutlineCorrespondence> correspondences;
    for (const auto& [vertex_paths, both] : marks) {
        const ArcLengthPath& way = ours[static_cast<std::size_t>(vertex_paths.first)];
        const auto there = static_cast<std::size_t>(vertex_paths.second);
        PathCorrespondences best = correspondences_along(way, forward[there], both.first, scale);
        if (line) {
            PathCorrespondences other = correspondences_along(way, backward[there], both.second, scale);
            if (other.pieces > best.pieces || (other.pieces == best.pieces && mean_square(mesh, other.correspondences, scale) <
                                                                                  mean_square(mesh, best.correspondences, scale)))
                best = std::move(other);
        }
        correspondences.insert(correspondences.end(), best.correspondences.begin(), best.correspondences.end());
    }
    return correspondences;
}

}  // namespace ostraka
