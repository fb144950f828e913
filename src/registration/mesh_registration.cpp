#include "ostraka/registration/mesh_registration.h"

#include "registration/grid_pose.h"
#include "registration/pose_covariance.h"
#include "registration/trimmed_registration.h"

#include "ostraka/algebra/dense.h"
#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/mesh/orientation.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace ostraka {

namespace {

// Lengths here are in units of the root mean square distance of a surface from its centre.
constexpr double grid_radius = 0.3, coarse_tolerance = 0.1, fine_tolerance = 0.02, farthest_pair = 0.5;
constexpr double min_cosine = 0.3;  // of the normals of a pair
constexpr int rotation_count = 16384;
constexpr std::size_t scored_points = 250, refined_points = 500, refined_on_grid = 48, refined_on_faces = 8;

/// A point of a surface with its normal, and the local distance of the flat face from the curved surface that it approximates.
struct AreaSample {
    Vector3d place, normal;
    double sagitta = 0;
};

/// A mesh normalised to unit size at the origin.
struct UnitSurface {
    std::unique_ptr<Mesh> mesh;  ///< kept alive for `search`
    Motion to_unit;              ///< from the frame of the given mesh
    double face_area = 0;        ///< mean face area
    SurfacePoints points;
    std::unique_ptr<SurfaceSearch> search;
};

struct AreaMoments {
    Vector3d centre = Vector3d::Zero();
    Matrix3d covariance = Matrix3d::Zero();
    double area = 0;
};

AreaMoments area_moments(const Mesh& mesh, const std::string& name) {
    AreaMoments moments;
    const auto box = bounding_box(mesh);
    const Vector3d middle(0.5 * (box.xmin() + box.xmax()), 0.5 * (box.ymin() + box.ymax()), 0.5 * (box.zmin() + box.zmax()));
    const auto each_face = [&](auto&& visit) {
        CancelCheck cancel;
        for (const Face face : mesh.faces()) {
            cancel();
            const auto c = corners(mesh, face);
            const Vector3d p = eigen(mesh.point(c[0])) - middle, q = eigen(mesh.point(c[1])) - middle,
                           r = eigen(mesh.point(c[2])) - middle;
            visit(p, q, r, (q - p).cross(r - p).norm() / 2);
        }
    };
    each_face([&](const Vector3d& p, const Vector3d& q, const Vector3d& r, double area) {
        moments.area += area;
        moments.centre += area * (p + q + r) / 3;
    });
    if (!(moments.area > 0) || !std::isfinite(moments.area))
        fail_input(name, "it has no area, so nothing can be registered to it", "check that it is the right file");
    moments.centre /= moments.area;
    each_face([&](const Vector3d& a, const Vector3d& b, const Vector3d& c, double area) {
        const Vector3d p = a - moments.centre, q = b - moments.centre, r = c - moments.centre, s = p + q + r;
        for (const Vector3d& v : {p, q, r, s}) moments.covariance += area / (12 * moments.area) * v * v.transpose();
    });
    const Vector3d spread = symmetric_eigenvalues(moments.covariance);
    if (!(spread[0] > 1e-10 * spread[2]))
        fail_input(name, "it is flat: only its border determines its position", "give a surface with some relief");
    moments.centre += middle;
    return moments;
}

/// `size`: the length that becomes 1.
UnitSurface unit_surface(const Mesh& mesh, const AreaMoments& moments, double size) {
    UnitSurface unit;
    unit.to_unit.scale = 1 / size;
    unit.to_unit.translation = -moments.centre / size;
    unit.mesh = std::make_unique<Mesh>(mesh);
    // Subtracts the centre first: far from the origin this is more precise than a difference of products.
    for (const Vertex v : mesh.vertices()) unit.mesh->point(v) = point_of((eigen(mesh.point(v)) - moments.centre) / size);
    const double area = moments.area / (size * size);
    unit.face_area = area / static_cast<double>(mesh.number_of_faces());
    const double spacing = std::sqrt(0.7 * area / 2000);
    unit.points = spread_points(*unit.mesh, {}, spacing, spacing);
    unit.search = std::make_unique<SurfaceSearch>(*unit.mesh);
    return unit;
}

/// Height of the curved surface over a flat face, from the dihedral angles of its edges.
double sagitta_of(const Mesh& mesh, const SurfaceSearch& search, Face face) {
    double sum = 0;
    int edges = 0;
    for (const Halfedge h : CGAL::halfedges_around_face(mesh.halfedge(face), mesh)) {
        const Halfedge other = mesh.opposite(h);
        if (mesh.is_border(other)) continue;
        const Vector a = search.normal(face), b = search.normal(mesh.face(other));
        const double angle = std::acos(std::clamp(a * b, -1.0, 1.0));
        const double length = (eigen(mesh.point(mesh.target(h))) - eigen(mesh.point(mesh.source(h)))).norm();
        sum += (length * angle) * (length * angle);
        ++edges;
    }
    return edges > 0 ? 0.25 * std::sqrt(sum / edges) : 0;
}

/// Each sample represents the same area. On small faces a share `corner_share` of the samples is at a corner, the rest inside.
std::vector<AreaSample> area_samples(const UnitSurface& surface, int count, double corner_share) {
    constexpr double small = 16;
    const Mesh& mesh = *surface.mesh;
    const double step = surface.face_area * static_cast<double>(mesh.number_of_faces()) / count;
    std::vector<AreaSample> samples;
    double sum = 0, next = 0.5 * step;
    for (const Face face : mesh.faces()) {
        const double area = face_area(mesh, face);
        sum += area;
        if (next >= sum) continue;
        const auto c = corners(mesh, face);
        const Vector3d normal = eigen(area_vector(mesh, face)).normalized();
        const double sagitta = sagitta_of(mesh, *surface.search, face);
        for (; next < sum && samples.size() < static_cast<std::size_t>(count); next += step) {
            const std::size_t k = samples.size();
            double integer_part = 0, s = std::modf(0.5 + 0.7548776662466927 * static_cast<double>(k), &integer_part),
                   t = std::modf(0.5 + 0.5698402909980532 * static_cast<double>(k), &integer_part);
            if (s + t > 1) s = 1 - s, t = 1 - t;
            const Vector3d corner[3]{eigen(mesh.point(c[0])), eigen(mesh.point(c[1])), eigen(mesh.point(c[2]))};
            const bool at_corner =
                area < small * step && std::modf(0.6180339887498949 * static_cast<double>(k), &integer_part) < corner_share;
            samples.push_back(
                {at_corner ? corner[k % 3] : Vector3d(corner[0] + s * (corner[1] - corner[0]) + t * (corner[2] - corner[0])),
                 normal, sagitta});
        }
    }
    return samples;
}

/// Variants of the source: as given or mirrored, faces as given or flipped.
struct Handedness {
    bool mirrored = false, flipped = false;
    [[nodiscard]] Vector3d place(const Vector3d& p) const { return mirrored ? Vector3d(-p.x(), p.y(), p.z()) : p; }
    [[nodiscard]] Vector3d normal(const Vector3d& n) const { return (flipped ? -1.0 : 1.0) * place(n); }
};

/// Rotations evenly spread over SO(3): super-Fibonacci spirals (Alexa, "Super-Fibonacci spirals: fast, low-discrepancy sampling
/// of SO(3)", CVPR 2022).
Matrix3d spread_rotation(int i, int count) {
    constexpr double phi = 1.4142135623730951, psi = 1.533751168755204288118041;
    const double s = i + 0.5, t = s / count, d = 2 * pi * s;
    const double r = std::sqrt(t), big = std::sqrt(1 - t), alpha = d / phi, beta = d / psi;
    return Eigen::Quaterniond(r * std::sin(alpha), r * std::cos(alpha), big * std::sin(beta), big * std::cos(beta))
        .normalized()
        .toRotationMatrix();
}

double rotation_angle_between(const Motion& a, const Motion& b) {
    return std::acos(std::clamp(((a.rotation.transpose() * b.rotation).trace() - 1) / 2, -1.0, 1.0));
}

/// Poses in the order of their scores, best first, each at least `min_angle` from the previous ones.
std::vector<Motion> best_distinct(const std::vector<Motion>& poses, const std::vector<double>& scores, std::size_t count,
                                  double min_angle) {
    std::vector<std::size_t> order(poses.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return scores[a] > scores[b]; });
    std::vector<Motion> kept;
    for (const std::size_t i : order) {
        if (kept.size() == count) break;
        if (std::all_of(kept.begin(), kept.end(),
                        [&](const Motion& k) { return rotation_angle_between(k, poses[i]) > min_angle; }))
            kept.push_back(poses[i]);
    }
    return kept;
}

/// The best-scoring rotations, and residual translations and scales not fixed by the moments, on the grid of the target's
/// points.
std::vector<Motion> poses_on_grid(const UnitSurface& source, const detail::NearestGrid& grid, const Handedness& hand,
                                  bool scaled) {
    SurfacePoints points = detail::thinned(source.points, refined_points);
    for (Vector3d& p : points.places) p = hand.place(p);
    for (Vector3d& n : points.normals) n = hand.normal(n);
    const SurfacePoints sample = detail::thinned(points, scored_points);
    std::vector<Motion> poses(rotation_count);
    std::vector<double> scores(poses.size());
    parallel_for(poses.size(), 64, [&](std::size_t i) {
        poses[i].rotation = spread_rotation(static_cast<int>(i), rotation_count);
        scores[i] = score_on(grid, sample, poses[i], detail::Nearness(coarse_tolerance));
    });
    poses = best_distinct(poses, scores, refined_on_grid, 10 * degree);
    scores.resize(poses.size());
    parallel_for(poses.size(), 1, [&](std::size_t i) {
        poses[i] = refined_on(grid, points, poses[i], fine_tolerance, 16, scaled);
        scores[i] = score_on(grid, points, poses[i], detail::Nearness(fine_tolerance));
    });
    return best_distinct(poses, scores, refined_on_faces, 5 * degree);
}

/// ICP, point to plane, in both directions.
class UnitAligner {
public:
    UnitAligner(const UnitSurface& a, const UnitSurface& b, const Handedness& hand, bool scaled, int samples, double corner_share)
        : a_(a), b_(b), hand_(hand), scaled_(scaled) {
        const double share = std::clamp(a.face_area / (a.face_area + b.face_area), 0.1, 0.9);
        samples_a_ = area_samples(a, std::max(10, static_cast<int>(share * samples)), corner_share);
        samples_b_ = area_samples(b, std::max(10, static_cast<int>((1 - share) * samples)), corner_share);
    }

    detail::Registration run(const Motion& start, int iterations, double min_gain) {
        return detail::register_from(
            start, iterations, min_gain, pairs_, [&](const Motion& pose) { return measure(pose); },
            [&](const Motion& pose) {
                const PlaneMotion planes = pairs_.planes(1);
                return planes.motion(planes.solve(1e-7, scaled_)).after(pose);
            });
    }

    /// The pairs that determine the pose, in the target's frame.
    const std::vector<detail::PlanePair>& pairs_at(const Motion& pose) {
        measure(pose);
        return pairs_.pairs;
    }

    /// The nearest compatible point of the other surface, as a pair in the target's frame.
    [[nodiscard]] std::optional<detail::PlanePair> partner(const AreaSample& sample, bool of_source, const Motion& pose,
                                                           const Motion& back) const {
        if (of_source) {
            const Vector3d p = pose(hand_.place(sample.place)), n = pose.rotation * hand_.normal(sample.normal);
            const auto hit = b_.search->closest_compatible(point_of(p), vector_of(n), min_cosine, farthest_pair);
            if (!hit) return std::nullopt;
            return detail::PlanePair{p, eigen(hit->point), eigen(b_.search->normal(hit->face)), hit->distance * hit->distance};
        }
        const Vector3d p = hand_.place(back(sample.place)), n = hand_.normal(back.rotation * sample.normal);
        const auto hit = a_.search->closest_compatible(point_of(p), vector_of(n), min_cosine, farthest_pair / pose.scale);
        if (!hit) return std::nullopt;
        const Vector3d place = pose(hand_.place(eigen(hit->point)));
        return detail::PlanePair{place, sample.place, pose.rotation * hand_.normal(eigen(a_.search->normal(hit->face))),
                                 (place - sample.place).squaredNorm()};
    }

private:
    detail::PoseFit measure(const Motion& pose) {
        const std::size_t count = samples_a_.size() + samples_b_.size();
        std::vector<std::optional<detail::PlanePair>> partners(count);
        const Motion back = pose.inverse();
        parallel_for(count, 64, [&](std::size_t i) {
            const bool first = i < samples_a_.size();
            partners[i] = partner(first ? samples_a_[i] : samples_b_[i - samples_a_.size()], first, pose, back);
        });
        pairs_.pairs.clear();
        for (const auto& pair : partners)
            if (pair) pairs_.pairs.push_back(*pair);
        detail::PoseFit fit;
        fit.overlap = static_cast<double>(pairs_.pairs.size()) / static_cast<double>(count);
        const std::size_t kept_count = pairs_.trim(0.9, count), pair_count = pairs_.pairs.size();
        const double sum = pairs_.squares() + static_cast<double>(kept_count - pair_count) * farthest_pair * farthest_pair;
        fit.minimised = fit.residual = std::sqrt(sum / static_cast<double>(kept_count));
        return fit;
    }

    const UnitSurface &a_, &b_;
    Handedness hand_;
    bool scaled_;
    std::vector<AreaSample> samples_a_, samples_b_;
    detail::PlanePairs pairs_;
};

// Min shares of either surface within the tolerance of the other, and within a third of it (the sagitta itself). Meshes of 5000
// or more vertices of one object reach at least 96 and 79 %; two heads that differ by 0.23 % of the diagonal, at 1000 vertices,
// reach 98 and 69 %.
constexpr double min_share = 0.96, min_close = 0.75;

/// A pose of the source in the unit frame, and its residual.
struct UnitPose {
    Motion pose;
    double residual = 0;
    double corner_share = 1;  ///< share of the samples at corners of faces in the last refinement
};

class MeshRegistrar {
public:
    MeshRegistrar(const Mesh& source, const Mesh& target, const MeshRegistrationOptions& options) : options_(options) {
        const AreaMoments a = area_moments(source, "source"), b = area_moments(target, "target");
        unit_ = std::sqrt(b.covariance.trace());
        a_ = unit_surface(source, a, options.scale ? std::sqrt(a.covariance.trace()) : unit_);
        b_ = unit_surface(target, b, unit_);
        grid_ = std::make_unique<detail::NearestGrid>(b_.points, grid_radius);
        samples_a_ = area_samples(a_, options.samples, 0);
        samples_b_ = area_samples(b_, options.samples, 0);
        fixed_tolerance_ = options.tolerance * b_.search->diagonal();
    }

    /// The best poses, best first; only roughly refined if even the best residual exceeds `bound`. A remeshed object has its
    /// vertices on the surface, a decimated one neither vertices nor faces: samples of both kinds are weighted by the inverse
    /// of their squared residuals.
    [[nodiscard]] std::vector<UnitPose> search(const Handedness& hand, double bound) const {
        std::vector<UnitPose> poses;
        UnitAligner coarse(a_, b_, hand, options_.scale, std::min(1000, options_.samples), 1);
        std::vector<Motion> starts = poses_on_grid(a_, *grid_, hand, options_.scale);
        starts.emplace_back();  // may be the intended pose of a symmetric object
        for (const Motion& start : starts) {
            const detail::Registration registration = coarse.run(start, 20, 1e-2);
            poses.push_back({registration.pose, registration.fit.residual, 1});
        }
        sort(poses);
        const double best = poses.front().residual;
        if (best > bound) return poses;
        std::erase_if(poses, [&](const UnitPose& candidate) { return candidate.residual > 2 * best + 1e-3; });
        refine(poses, hand, 1);
        const Motion pose = poses.front().pose;
        const auto residual_at = [&](double corner_share) {
            return UnitAligner(a_, b_, hand, options_.scale, options_.samples, corner_share).run(pose, 0, 0).fit.residual;
        };
        const double corners = residual_at(1), inside = residual_at(0),
                     share = inside * inside / (inside * inside + corners * corners + 1e-30);
        if (share < 0.9) refine(poses, hand, share);
        return poses;
    }

    /// Tests the samples of either mesh against the other, each with its own tolerance.
    [[nodiscard]] SurfaceAgreement judge(const Motion& pose, const Handedness& hand, double* mean_tolerance = nullptr) const {
        const UnitAligner pairs(a_, b_, hand, options_.scale, 10, 1);
        const Motion back = pose.inverse();
        SurfaceAgreement agreement;
        agreement.share = agreement.close = 1;
        double squares = 0, tolerances = 0;
        for (const bool of_source : {true, false}) {
            const std::vector<AreaSample>& samples = of_source ? samples_a_ : samples_b_;
            std::vector<double> distances(samples.size(), farthest_pair), allowed(samples.size());
            parallel_for(samples.size(), 64, [&](std::size_t i) {
                if (const auto pair = pairs.partner(samples[i], of_source, pose, back)) distances[i] = std::sqrt(pair->squared);
                allowed[i] = tolerance_at(samples[i], of_source, hand, pose, back);
            });
            std::size_t within = 0, close = 0;
            for (std::size_t i = 0; i < samples.size(); ++i) {
                squares += distances[i] * distances[i] / static_cast<double>(samples_a_.size() + samples_b_.size());
                tolerances += allowed[i] / static_cast<double>(samples_a_.size() + samples_b_.size());
                if (distances[i] <= allowed[i]) ++within;
                if (distances[i] <= allowed[i] / 3) ++close;
            }
            const auto count = static_cast<double>(samples.size());
            agreement.share = std::min(agreement.share, static_cast<double>(within) / count);
            agreement.close = std::min(agreement.close, static_cast<double>(close) / count);
            std::sort(distances.begin(), distances.end());
            agreement.largest = std::max(agreement.largest, unit_ * distances[99 * (samples.size() - 1) / 100]);
        }
        agreement.rms = unit_ * std::sqrt(squares);
        if (mean_tolerance != nullptr) *mean_tolerance = unit_ * tolerances;
        return agreement;
    }

    [[nodiscard]] bool aligned(const SurfaceAgreement& agreement) const {
        return agreement.share >= min_share && (fixed_tolerance_ > 0 || agreement.close >= min_close);
    }

    [[nodiscard]] RegistrationUncertainty uncertainty(const UnitPose& pose) const {
        UnitAligner aligner(a_, b_, {}, options_.scale, options_.samples, pose.corner_share);
        RegistrationUncertainty result = detail::pose_uncertainty(aligner.pairs_at(pose.pose), options_.scale);
        result.translation *= unit_;
        result.placement *= unit_;
        return result;
    }

    /// Converts a pose in the unit frame to one between the files.
    [[nodiscard]] Motion in_files(const Motion& pose) const {
        Motion motion{pose.rotation, Vector3d::Zero(), pose.scale * a_.to_unit.scale * unit_};
        const Vector3d a = -a_.to_unit.translation / a_.to_unit.scale, b = -unit_ * b_.to_unit.translation;
        motion.translation = b + unit_ * pose.translation - motion.scale * (motion.rotation * a);
        return motion;
    }

    [[nodiscard]] SlippableMotions slippable() const { return slippable_motions_of(b_.points.places, b_.points.normals, 0.02); }
    [[nodiscard]] SlippableMotions in_target(SlippableMotions motions) const {
        motions.point = unit_ * (motions.point - b_.to_unit.translation);
        motions.pitch *= unit_;
        return motions;
    }

private:
    void refine(std::vector<UnitPose>& poses, const Handedness& hand, double corner_share) const {
        UnitAligner fine(a_, b_, hand, options_.scale, options_.samples, corner_share);
        for (UnitPose& candidate : poses) {
            const detail::Registration refined = fine.run(candidate.pose, 60, 1e-5);
            candidate = {refined.pose, refined.fit.residual, corner_share};
        }
        sort(poses);
    }
    static void sort(std::vector<UnitPose>& poses) {
        std::stable_sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) { return a.residual < b.residual; });
    }

    /// Three times the distance of flat faces from the curved surface, from the dihedral angles here and at the nearest point
    /// of the other mesh.
    [[nodiscard]] double tolerance_at(const AreaSample& sample, bool of_source, const Handedness& hand, const Motion& pose,
                                      const Motion& back) const {
        constexpr double minimum = 3e-4, maximum = 0.03;
        if (fixed_tolerance_ > 0) return fixed_tolerance_;
        const UnitSurface& other = of_source ? b_ : a_;
        const Vector3d place = of_source ? pose(hand.place(sample.place)) : hand.place(back(sample.place));
        const Face face(other.search->closest(point_of(place)).face);
        return std::min(maximum, 3 * (sample.sagitta + sagitta_of(*other.mesh, *other.search, face)) + minimum);
    }

    const MeshRegistrationOptions& options_;
    double unit_ = 1, fixed_tolerance_ = 0;
    UnitSurface a_, b_;
    std::unique_ptr<detail::NearestGrid> grid_;
    std::vector<AreaSample> samples_a_, samples_b_;
};

constexpr double max_rough_residual = 0.05;  // residual of a rough registration beyond which the meshes count as different
constexpr double mirrored_gain =
    0.5;  // max residual of the mirror image relative to that of the object, for the verdict "mirrored"
constexpr double equal_residual = 1.5;  // max residual ratio of poses that fit equally, besides an absolute 1e-4

/// Selects, among the poses that fit as well as the best, the one that moves the source least, and stores the others.
void choose_pose(const MeshRegistrar& registrar, const std::vector<UnitPose>& poses, MeshRegistration& result) {
    const SlippableMotions open = registrar.slippable();
    result.slippable = registrar.in_target(open);
    std::vector<UnitPose> equal;
    for (const UnitPose& candidate : poses)
        if (candidate.residual <= equal_residual * poses.front().residual + 1e-4 &&
            (&candidate == poses.data() || registrar.aligned(registrar.judge(candidate.pose, {}))))
            equal.push_back(candidate);
    const auto by_angle = [](const UnitPose& a, const UnitPose& b) {
        return rotation_angle_between(a.pose, Motion()) < rotation_angle_between(b.pose, Motion()) - 0.1 * degree;
    };
    const UnitPose chosen = *std::min_element(equal.begin(), equal.end(), by_angle);
    const Motion best = chosen.pose;
    result.motion = registrar.in_files(best);
    result.uncertainty = registrar.uncertainty(chosen);
    result.agreement = registrar.judge(best, {}, &result.tolerance);
    std::vector<Motion> kept{best};
    for (const UnitPose& candidate : equal) {
        const auto is_equal = [&](const Motion& other) {
            const Motion between = candidate.pose.after(other.inverse());
            return rotation_angle_between(candidate.pose, other) < 5 * degree ||
                   (open.kind != SlippableKind::none && open.contains(between, Vector3d::Zero(), 5 * degree, 0.05));
        };
        if (std::any_of(kept.begin(), kept.end(), is_equal)) continue;
        kept.push_back(candidate.pose);
        result.others.push_back(registrar.in_files(candidate.pose));
    }
}

/// Registers the meshes as they are oriented; verdict `different` and `turned_over` if they coincide once the faces of one of
/// them are turned over.
MeshRegistration registered_as_oriented(const Mesh& source, const Mesh& target, const MeshRegistrationOptions& options) {
    Progress progress("registering", 4);
    const MeshRegistrar registrar(source, target, options);
    MeshRegistration result;
    progress.advance();
    const std::vector<UnitPose> poses = registrar.search({}, max_rough_residual);
    progress.advance();
    const std::vector<UnitPose> reflected =
        registrar.search({.mirrored = true}, std::min(max_rough_residual, 2 * poses.front().residual));
    progress.advance();
    choose_pose(registrar, poses, result);
    result.mirrored = registrar.judge(reflected.front().pose, {.mirrored = true});
    const bool mirrored = registrar.aligned(result.mirrored), aligned = registrar.aligned(result.agreement);
    if (mirrored && (!aligned || reflected.front().residual < mirrored_gain * poses.front().residual - 1e-4)) {
        result.verdict = RegistrationVerdict::mirrored;
    } else if (aligned) {
        result.verdict = RegistrationVerdict::aligned;
    } else {
        for (const bool with_mirror : {false, true}) {
            const Handedness hand{.mirrored = with_mirror, .flipped = true};
            const SurfaceAgreement agreement = registrar.judge(registrar.search(hand, max_rough_residual).front().pose, hand);
            if (!registrar.aligned(agreement)) continue;
            if (with_mirror) result.verdict = RegistrationVerdict::mirrored, result.mirrored = agreement;
            else result.turned_over = true;
            break;
        }
    }
    if (result.verdict != RegistrationVerdict::aligned) result.others.clear();
    progress.advance();
    return result;
}

}  // namespace

std::string to_string(RegistrationVerdict verdict) {
    static constexpr const char* words[]{"aligned", "mirror image", "not the same object"};
    return words[static_cast<std::size_t>(verdict)];
}

MeshRegistration register_mesh(const Mesh& source, const Mesh& target, const MeshRegistrationOptions& options) {
    check_options(options, "registration");
    MeshRegistration result = registered_as_oriented(source, target, options);
    if (!result.turned_over) return result;
    MeshRegistration turned = registered_as_oriented(turned_over(source), target, options);
    if (turned.verdict != RegistrationVerdict::aligned) {
        result.turned_over = false;
        return result;
    }
    turned.turned_over = true;
    turned.inside_out = is_inside_out(source)   ? MeshRegistration::InsideOut::source
                        : is_inside_out(target) ? MeshRegistration::InsideOut::target
                                                : MeshRegistration::InsideOut::unknown;
    return turned;
}

std::string message_about(const MeshRegistration& registration, double diagonal) {
    const auto share = [](double x) { return digits(100 * x, 3) + " %"; };
    const std::string residual =
        fmt::format("rms distance {} of the diagonal, {} of the surfaces within the tolerance given by their resolutions",
                    share(registration.agreement.rms / diagonal), share(registration.agreement.share));
    switch (registration.verdict) {
        case RegistrationVerdict::aligned:
            return "aligned: " + residual;
        case RegistrationVerdict::mirrored:
            return fmt::format(
                "a mirror image: reflected, the source would fit with an rms distance of {} of the diagonal (unreflected: {})",
                share(registration.mirrored.rms / diagonal), share(registration.agreement.rms / diagonal));
        default:
            return "not the same object, or too coarse to decide: " + residual;
    }
}

std::vector<std::string> remarks_on(const MeshRegistration& registration) {
    std::vector<std::string> remarks;
    if (registration.verdict != RegistrationVerdict::aligned) return remarks;
    if (registration.turned_over) {
        using InsideOut = MeshRegistration::InsideOut;
        remarks.push_back(fmt::format(
            "{} inside out: the faces of the source were turned over in memory (ostraka mesh repair corrects the file)",
            registration.inside_out == InsideOut::source   ? "the source is"
            : registration.inside_out == InsideOut::target ? "the target is"
                                                           : "one of the meshes is"));
    }
    if (!registration.others.empty())
        remarks.push_back(
            fmt::format("{}{} poses fit equally: the object is symmetric; the one that rotates the source least was chosen",
                        registration.others.size() >= refined_on_faces - 1 ? "at least " : "", registration.others.size() + 1));
    if (registration.slippable.kind != SlippableKind::none)
        remarks.push_back(fmt::format("the shape leaves a motion open ({}): the displacement of the source along it is unknown",
                                      registration.slippable.text()));
    return remarks;
}

void MeshRegistrationOptions::declare_options(OptionList& list) {
    list("scale", scale, "also find the scale, because the two meshes may be in different units", Anything{});
    list("tolerance", tolerance,
         "points of the two registered meshes within this distance count as the same surface; 0: estimated from the resolutions",
         Range{0, 1}, "share of the target's diagonal");
    list("samples", samples, "number of surface points with which the meshes are registered and compared", Range{100, 1e6});
}

}  // namespace ostraka
