#include "semantic/reattachment.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/algebra/sparse.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/geom/with_points.h"
#include "ostraka/semantic/edit.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace ostraka::semantic {

namespace {

/// Values at free vertices that minimise the sum of the squared uniform Laplacians over those vertices and, with `to_others`,
/// over their neighbours; columns of `values` are vertices, those of others are given.
void smooth(const Mesh& mesh, const std::vector<Index>& free, bool to_others, Points& values) {
    if (free.empty()) return;
    std::vector<int> unknown(mesh.number_of_vertices(), -1);
    for (std::size_t i = 0; i < free.size(); ++i) unknown[free[i]] = static_cast<int>(i);
    std::vector<bool> is_row(mesh.number_of_vertices(), false);
    for (const Index v : free) {
        is_row[v] = true;
        if (!to_others) continue;
        for (const Vertex n : mesh.vertices_around_target(mesh.halfedge(Vertex(v)))) is_row[n] = true;
    }
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<Vector3d> right;
    for (const Vertex v : mesh.vertices()) {
        if (!is_row[v]) continue;
        const int row = static_cast<int>(right.size());
        right.emplace_back(Vector3d::Zero());
        const auto add = [&](Index u, double weight) {
            if (unknown[u] >= 0) entries.emplace_back(row, unknown[u], weight);
            else right.back() -= weight * values.col(u);
        };
        const double share = 1.0 / static_cast<double>(mesh.degree(v));
        add(v, 1);
        for (const Vertex n : mesh.vertices_around_target(mesh.halfedge(v))) add(n.idx(), -share);
    }
    Eigen::SparseMatrix<double> rows(static_cast<Eigen::Index>(right.size()), static_cast<Eigen::Index>(free.size()));
    rows.setFromTriplets(entries.begin(), entries.end());
    Eigen::MatrixX3d wanted(rows.rows(), 3);
    for (std::size_t i = 0; i < right.size(); ++i) wanted.row(static_cast<Eigen::Index>(i)) = right[i];
    const SparseLdlt solver(rows.transpose() * rows);
    const Eigen::MatrixX3d found = solver.solve(rows.transpose() * wanted);
    if (!found.allFinite()) return;  // a component without surroundings: unchanged
    for (std::size_t i = 0; i < free.size(); ++i) values.col(free[i]) = found.row(static_cast<Eigen::Index>(i)).transpose();
}

/// Area weights of the corners, a third of each face: the centroid follows a rigid motion.
Vector3d centroid_of(const Mesh& mesh, const std::vector<Index>& faces, const Points& points) {
    Vector3d sum = Vector3d::Zero();
    double area = 0;
    for (const Index f : faces) {
        const auto [a, b, c] = corners(mesh, Face(f));
        const Vector3d p = points.col(a), q = points.col(b), r = points.col(c);
        const double size = (q - p).cross(r - p).norm();
        sum += size * (p + q + r) / 3;
        area += size;
    }
    return area > 0 ? Vector3d(sum / area) : Vector3d(points.col(corners(mesh, Face(faces.front()))[0]));
}

struct FeaturePose {
    Matrix3d rotation = Matrix3d::Identity();
    Vector3d translation = Vector3d::Zero();
    [[nodiscard]] Vector3d operator()(const Vector3d& p) const { return rotation * p + translation; }
};

/// The rigid motion that brings columns of `from` closest to those of `to`.
FeaturePose fit(const Points& from, const Points& to) {
    const Vector3d a = from.rowwise().mean(), b = to.rowwise().mean();
    const Matrix3d m = (to.colwise() - b) * (from.colwise() - a).transpose();
    const Svd3 svd(m);
    Matrix3d sign = Matrix3d::Identity();
    sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
    FeaturePose result;
    result.rotation = svd.matrixU() * sign * svd.matrixV().transpose();
    result.translation = b - result.rotation * a;
    return result;
}

struct Feature {
    const Annotation* annotation;
    std::vector<Index> vertices, inside, outline;
    Vector3d centroid;  ///< at rest
    double radius = 0;  ///< maximum distance from it, at rest
    Points rest_outline;
    FeaturePose pose;
};

Feature feature_of(const Mesh& mesh, const Points& rest, const Annotation& annotation) {
    Feature feature{&annotation, vertices_of(mesh, annotation), {}, {}, {}, 0, {}, {}};
    const std::vector<bool> inside = face_flags(mesh, annotation.faces);
    for (const Index v : feature.vertices) {
        bool border = false;
        for (const Face f : mesh.faces_around_target(mesh.halfedge(Vertex(v))))
            border = border || f == Mesh::null_face() || !inside[f];
        (border ? feature.outline : feature.inside).push_back(v);
    }
    feature.centroid = centroid_of(mesh, annotation.faces, rest);
    for (const Index v : feature.vertices) feature.radius = std::max(feature.radius, (rest.col(v) - feature.centroid).norm());
    feature.rest_outline.resize(3, static_cast<Eigen::Index>(feature.outline.size()));
    for (std::size_t i = 0; i < feature.outline.size(); ++i)
        feature.rest_outline.col(static_cast<Eigen::Index>(i)) = rest.col(feature.outline[i]);
    return feature;
}

class Reattacher {
public:
    Reattacher(const Mesh& mesh, const Points& rest, const std::vector<Reattachment>& reattachments, Points& points)
        : mesh_(mesh),
          rest_(rest),
          points_(points),
          owner_(mesh.number_of_vertices(), -1),
          reattached_(points),
          change_(Points::Zero(3, points.cols())) {
        for (const Reattachment& reattachment : reattachments) {
            groups_.push_back({features_.size(), features_.size() + reattachment.features.size(), reattachment.up,
                               reattachment.bend, reattachment.references});
            for (const Annotation* annotation : reattachment.features) {
                for (const Index v : vertices_of(mesh, *annotation)) owner_[v] = static_cast<int>(features_.size());
                features_.push_back(feature_of(mesh, rest, *annotation));
            }
        }
    }

    ReattachmentReport run() {
        Points base_points = points_;
        std::vector<Index> insides;
        for (const Feature& feature : features_) insides.insert(insides.end(), feature.inside.begin(), feature.inside.end());
        std::sort(insides.begin(), insides.end());
        smooth(mesh_, insides, true, base_points);
        const Mesh base = with_points(mesh_, list_of(base_points));
        const SurfaceSearch search(base);
        for (Feature& feature : features_) {
            Points to(3, feature.rest_outline.cols());
            for (std::size_t i = 0; i < feature.outline.size(); ++i)
                to.col(static_cast<Eigen::Index>(i)) = points_.col(feature.outline[i]);
            feature.pose = fit(feature.rest_outline, to);
            settle(feature, search, {});
        }
        for (const Group& group : groups_) place(group, search);
        ReattachmentReport report;
        constexpr double widest = 3;
        for (const double radii_around : {2.0, widest}) {
            const Points tried = surroundings(search, radii_around);
            report.folded = folded(tried);
            if (report.folded == 0 || radii_around == widest) points_ = tried;
            if (report.folded == 0) break;
        }
        return report;
    }

private:
    struct Group {
        std::size_t begin, end;
        std::optional<Vector3d> up;
        double bend;
        std::vector<std::vector<Index>> references;
    };

    /// Moves a placed feature so that its outline lies on the base, and its centroid at the target height if given.
    void settle(Feature& feature, const SurfaceSearch& search, const std::optional<std::pair<Vector3d, double>>& height) const {
        const double enough = 1e-9 * search.diagonal();
        for (int round = 0; round < 50; ++round) {
            const FeaturePose before = feature.pose;
            Points to(3, feature.rest_outline.cols());
            Vector3d normal = Vector3d::Zero();
            for (Eigen::Index i = 0; i < to.cols(); ++i) {
                const SurfaceHit hit = search.closest(point_of(before(feature.rest_outline.col(i))));
                to.col(i) = eigen(hit.point);
                normal += eigen(search.normal(hit.face));
            }
            feature.pose = fit(feature.rest_outline, to);
            if (height) {
                // Along the base, in the direction of steepest height; vertically if the base is level.
                const auto& [up, wanted] = *height;
                normal = normal.norm() > 0 ? Vector3d(normal.normalized()) : up;
                const Vector3d slope = up - normal * normal.dot(up);
                const double off = wanted - up.dot(feature.pose(feature.centroid));
                feature.pose.translation += slope.norm() > 0.2 ? Vector3d(off / slope.squaredNorm() * slope) : Vector3d(off * up);
            }
            const double moved = (feature.pose(feature.centroid) - before(feature.centroid)).norm() +
                                 feature.radius * (feature.pose.rotation - before.rotation).norm();
            if (moved < enough) break;
        }
        if (height) {
            const auto& [up, wanted] = *height;
            feature.pose.translation += (wanted - up.dot(feature.pose(feature.centroid))) * up;
        }
    }

    /// The placed feature, bent so that its outline lies on the base as far as permitted.
    void bend(const Feature& feature, const SurfaceSearch& search, double maximum) {
        for (const Index v : feature.outline) {
            const Vector3d p = feature.pose(rest_.col(v));
            change_.col(v) = eigen(search.closest(point_of(p)).point) - p;
        }
        smooth(mesh_, feature.inside, false, change_);
        double sum = 0;
        for (const Index v : feature.vertices) sum += change_.col(v).squaredNorm();
        const double rms = std::sqrt(sum / static_cast<double>(feature.vertices.size()));
        const double share = rms > maximum ? maximum / rms : 1;
        for (const Index v : feature.vertices) reattached_.col(v) = feature.pose(rest_.col(v)) + share * change_.col(v);
    }

    void place(const Group& group, const SurfaceSearch& search) {
        const double maximum = group.bend * (rest_.rowwise().maxCoeff() - rest_.rowwise().minCoeff()).norm();
        for (std::size_t i = group.begin; i < group.end; ++i) bend(features_[i], search, maximum);
        if (!group.up) return;
        const Vector3d& up = *group.up;
        const auto height = [&](std::size_t i) {
            if (group.references.empty()) return up.dot(centroid_of(mesh_, features_[i].annotation->faces, reattached_));
            double sum = 0;
            for (const Index v : group.references[i - group.begin]) sum += up.dot(reattached_.col(v));
            return sum / static_cast<double>(group.references[i - group.begin].size());
        };
        double mean = 0;
        for (std::size_t i = group.begin; i < group.end; ++i) mean += height(i) / static_cast<double>(group.end - group.begin);
        for (std::size_t i = group.begin; i < group.end; ++i) {
            Feature& feature = features_[i];
            for (int round = 0; round < 5; ++round) {
                const double wanted = mean - height(i) + up.dot(feature.pose(feature.centroid));
                settle(feature, search, std::pair{up, wanted});
                bend(feature, search, maximum);
            }
            const Vector3d rest = (mean - height(i)) * up;
            for (const Index v : feature.vertices) reattached_.col(v) += rest;
        }
    }

    /// All points with the features in place and their surroundings displaced on the base.
    Points surroundings(const SurfaceSearch& search, double radii_around) const {
        // Displacements along the base, and the distances of outlines from it, both faded out smoothly.
        Points moved = Points::Zero(3, points_.cols()), off = moved, result = points_;
        for (const Feature& feature : features_)
            for (const Index v : feature.vertices) {
                result.col(v) = reattached_.col(v);
                moved.col(v) = result.col(v) - points_.col(v);
            }
        std::vector<bool> ring(points_.cols(), false);
        for (const Feature& feature : features_) {
            for (const Index v : feature.outline)
                off.col(v) = result.col(v) - eigen(search.closest(point_of(result.col(v))).point);
            grow(feature, radii_around * feature.radius, ring);
        }
        std::vector<Index> free;
        for (Index v = 0; v < ring.size(); ++v)
            if (ring[v] && owner_[v] < 0) free.push_back(v);
        smooth(mesh_, free, true, moved);
        smooth(mesh_, free, true, off);
        for (const Index v : free) {
            const Vector3d slid = points_.col(v) + moved.col(v);
            result.col(v) = eigen(search.closest(point_of(slid)).point) + off.col(v);
        }
        return result;
    }

    /// Flags vertices within an edge-path distance of the outline on the rest shape, in order of increasing distance.
    void grow(const Feature& feature, double length, std::vector<bool>& ring) const {
        std::set<std::pair<double, Index>> open;
        std::map<Index, double> known;
        for (const Index v : feature.outline) open.insert({0, v}), known[v] = 0;
        while (!open.empty()) {
            const auto [way, v] = *open.begin();
            open.erase(open.begin());
            ring[v] = true;
            for (const Vertex n : mesh_.vertices_around_target(mesh_.halfedge(Vertex(v)))) {
                const double next = way + (rest_.col(n.idx()) - rest_.col(v)).norm();
                if (owner_[n] >= 0 || next > length) continue;
                const auto [entry, fresh] = known.try_emplace(n.idx(), next);
                if (!fresh && entry->second <= next) continue;
                if (!fresh) open.erase({entry->second, n.idx()});
                entry->second = next;
                open.insert({next, n.idx()});
            }
        }
    }

    /// Number of faces outside the features that are flipped relative to the previous surface.
    [[nodiscard]] std::size_t folded(const Points& result) const {
        std::size_t count = 0;
        for (const Face f : mesh_.faces()) {
            const auto corner = corners(mesh_, f);
            if (std::all_of(corner.begin(), corner.end(), [&](Index v) { return result.col(v) == points_.col(v); })) continue;
            if (std::all_of(corner.begin(), corner.end(), [&](Index v) { return owner_[v] >= 0; })) continue;
            const auto normal = [&](const Points& p) -> Vector3d {
                return (p.col(corner[1]) - p.col(corner[0])).cross(p.col(corner[2]) - p.col(corner[0]));
            };
            const Vector3d then = normal(points_), now = normal(result);
            count += then.norm() > 0 && !(then.dot(now) > 0);
        }
        return count;
    }

    const Mesh& mesh_;
    const Points& rest_;
    Points& points_;
    std::vector<int> owner_;  ///< feature of each vertex, or -1
    std::vector<Feature> features_;
    Points reattached_, change_;  ///< of the features' vertices
    std::vector<Group> groups_;
};

}  // namespace

std::vector<Point> list_of(const Points& points) {
    std::vector<Point> list;
    for (Eigen::Index i = 0; i < points.cols(); ++i) list.push_back(point_of(points.col(i)));
    return list;
}

std::vector<Halfedge> outline_of(const Mesh& mesh, const Annotation& region) {
    const std::vector<bool> inside = face_flags(mesh, region.faces);
    std::vector<Halfedge> outline;
    for (const Index f : region.faces)
        for (const Halfedge h : mesh.halfedges_around_face(mesh.halfedge(Face(f)))) {
            const Face other = mesh.face(mesh.opposite(h));
            if (other == Mesh::null_face() || !inside[other]) outline.push_back(h);
        }
    return outline;
}

bool has_outline(const Mesh& mesh, const Annotation& region) {
    const std::vector<Halfedge> outline = outline_of(mesh, region);
    return std::any_of(outline.begin(), outline.end(), [&](Halfedge h) { return !mesh.is_border(mesh.opposite(h)); });
}

ReattachmentReport reattach(const Mesh& mesh, const Points& rest, const std::vector<Reattachment>& reattachments,
                            Points& points) {
    if (reattachments.empty()) return {};
    return Reattacher(mesh, rest, reattachments, points).run();
}

}  // namespace ostraka::semantic
