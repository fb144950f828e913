#include "reconstruction/outline_correspondences.h"

#include "ostraka/annotation/outline.h"
#include "ostraka/geom/eigen.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

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

/// Correspondences of one path from the landmarks on it.
class PathMatcher {
public:
    /// `marks`: arc lengths of the landmarks on ours and theirs. Lengths on theirs are `scale` times those on ours.
    PathMatcher(const ArcLengthPath& ours, const ArcLengthPath& theirs, std::vector<std::pair<double, double>> marks,
                double scale)
        : ours_(ours), theirs_(theirs), marks_(std::move(marks)) {
        std::sort(marks_.begin(), marks_.end());
        marks_.erase(std::unique(marks_.begin(), marks_.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
                     marks_.end());
        add_pieces(scale);
    }

    [[nodiscard]] PathCorrespondences run() const {
        constexpr double share_beyond = 0.25;
        PathCorrespondences result;
        result.pieces = pieces_.size();
        for (std::size_t i = 0; i < ours_.places.size(); ++i) {
            OutlineCorrespondence correspondence{ours_.vertex_path.vertices[i], Vector3d::Zero(), length_at(i)};
            if (const auto between = place_between(i)) {
                correspondence.place = *between;
            } else if (const auto beyond = place_beyond(i)) {
                correspondence.place = beyond->place;
                if (beyond->distance > 0) correspondence.length *= share_beyond;
            } else {
                continue;
            }
            result.correspondences.push_back(correspondence);
        }
        return result;
    }

private:
    struct Piece {
        double from, to, there_from, there_to;
    };
    struct Beyond {
        Vector3d place;
        double distance;  ///< arc length to the nearest landmark
    };

    void add_pieces(double scale) {
        const std::size_t n = marks_.size();
        double known_length = 0, known_length_there = 0;
        for (std::size_t k = 0; k < n; ++k) {
            const bool last = k + 1 == n;
            if (last && !ours_.vertex_path.closed) break;
            const auto& [a, b] = marks_[k];
            auto [c, d] = marks_[(k + 1) % n];
            if (last) c += ours_.length;
            if (theirs_.vertex_path.closed && (d < b || (n == 1 && d <= b))) d += theirs_.length;
            if (!(d > b)) continue;  // interrupted on their side
            if ((d - b) > 2 * scale * (c - a) || scale * (c - a) > 2 * (d - b)) continue;
            pieces_.push_back({a, c, b, d});
            known_length += c - a;
            known_length_there += d - b;
        }
        ratio_ = known_length > 0 ? known_length_there / known_length : scale;
    }

    /// Half the length of the edges at the i-th vertex of the path.
    [[nodiscard]] double length_at(std::size_t i) const {
        const std::size_t count = ours_.places.size();
        const bool closed = ours_.vertex_path.closed;
        double length = 0;
        if (i > 0 || closed) length += 0.5 * (ours_.places[i] - ours_.places[(i + count - 1) % count]).norm();
        if (i + 1 < count || closed) length += 0.5 * (ours_.places[(i + 1) % count] - ours_.places[i]).norm();
        return length;
    }

    /// Interpolated between two landmarks.
    [[nodiscard]] std::optional<Vector3d> place_between(std::size_t i) const {
        for (const double arc_length : {ours_.arc_lengths[i], ours_.arc_lengths[i] + ours_.length}) {
            if (arc_length > ours_.length && !ours_.vertex_path.closed) break;
            for (const Piece& piece : pieces_) {
                if (arc_length < piece.from || arc_length > piece.to) continue;
                const double fraction = piece.to > piece.from ? (arc_length - piece.from) / (piece.to - piece.from) : 0;
                return theirs_.place(piece.there_from + fraction * (piece.there_to - piece.there_from));
            }
        }
        return {};
    }

    /// Extrapolated from the nearest landmark, in either direction.
    [[nodiscard]] std::optional<Beyond> place_beyond(std::size_t i) const {
        const bool closed = ours_.vertex_path.closed;
        double nearest = std::numeric_limits<double>::infinity(), their_arc_length = 0;
        for (const auto& [a, b] : marks_)
            for (const double wrap : {-1.0, 0.0, 1.0}) {
                if (wrap != 0 && !closed) continue;
                const double offset = ours_.arc_lengths[i] + wrap * ours_.length - a;
                if (std::abs(offset) >= nearest) continue;
                nearest = std::abs(offset);
                their_arc_length = b + ratio_ * offset;
            }
        if (!std::isfinite(nearest)) return {};
        if (!theirs_.vertex_path.closed && (their_arc_length < 0 || their_arc_length > theirs_.length)) return {};
        // Near the opposite point of a closed path the position is unreliable.
        if (closed && nearest > 0.4 * ours_.length) return {};
        return Beyond{theirs_.place(their_arc_length), nearest};
    }

    const ArcLengthPath& ours_;
    const ArcLengthPath& theirs_;
    std::vector<std::pair<double, double>> marks_;
    std::vector<Piece> pieces_;
    double ratio_ = 1;  ///< lengths on theirs divided by those on ours
};

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
        PathCorrespondences best = PathMatcher(path, forward[their_index], path_marks.first, scale).run();
        if (line) {
            PathCorrespondences other = PathMatcher(path, backward[their_index], path_marks.second, scale).run();
            if (other.pieces > best.pieces || (other.pieces == best.pieces && mean_square(mesh, other.correspondences, scale) <
                                                                                  mean_square(mesh, best.correspondences, scale)))
                best = std::move(other);
        }
        correspondences.insert(correspondences.end(), best.correspondences.begin(), best.correspondences.end());
    }
    return correspondences;
}

}  // namespace ostraka
