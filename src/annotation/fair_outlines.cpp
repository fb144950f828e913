#include "ostraka/annotation/fair_outlines.h"

#include "ostraka/annotation/curve_strands.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/distance.h"
#include "ostraka/geom/geodesic.h"
#include "ostraka/geom/polyline_distance.h"
#include "ostraka/geom/surface_search.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <map>

namespace ostraka {

namespace {

using Places = std::vector<SurfacePoint>;

Segments segments(const std::vector<Point>& points) {
    Segments list;
    for (std::size_t i = 1; i < points.size(); ++i) list.emplace_back(points[i - 1], points[i]);
    return list;
}

/// A stretch of curve between fixed places, or a loop.
struct Strand {
    Places before;  ///< original places; a loop repeats its first
    bool closed = false;
    std::vector<Point> points;  ///< coordinates of `before`
    std::vector<Point> fair;    ///< the faired curve; its ends are fixed
    std::vector<Vector> aside;  ///< for each point of `fair`, the direction to the left on the surface
    Places after;               ///< the faired curve on the surface
    double length = 0;
    double limit = 0;    ///< maximum distance from the original curve
    double room = 0.85;  ///< fraction of `limit` available to fairing; the rest is left for the shift that preserves areas
};

class Fairing {
public:
    Fairing(const Mesh& mesh, const FairOptions& options)
        : mesh_(mesh), search_(mesh), options_(options), mean_edge_(mean_edge_length(mesh)) {}

    std::vector<FairedAnnotation> run(std::vector<Annotation*> annotations) {
        std::vector<std::vector<Places>> curves;
        for (const Annotation* annotation : annotations) curves.push_back(curves_of(*annotation));
        find_strands(annotations, curves);
        for (Strand& strand : strands_) fair(strand);
        for (Strand& strand : strands_) draw(strand);
        std::vector<FairedAnnotation> result(annotations.size());
        std::vector<double> area(annotations.size(), 0);
        for (std::size_t i = 0; i < annotations.size(); ++i) {
            const Annotation& one = *annotations[i];
            result[i].id = one.id;
            if (one.type == AnnotationType::region) {
                const RegionMeasures measures = measure_region(mesh_, one);
                result[i].area_before = area[i] = measures.area;
                result[i].length_before = measures.perimeter;
            } else {
                result[i].length_before = length_of(mesh_, one);
            }
        }
        responses_.resize(annotations.size());
        // If an outline would intersect itself, it is reset, together with all annotations that share its strands.
        for (int round = 0; round < 20; ++round) {
            check_cancelled();
            if (!options_.let_area_change)
                for (int k = 0; k < 12; ++k)
                    if (!keep_areas(annotations, area)) break;
            for (Response& response : responses_) response.expected = 0;
            bool sound = true;
            for (Strand& strand : strands_) {  // strands moved beyond the limit by the shift or
                                               // the projection get a smaller limit for fairing
                if (strand.fair.empty() || hausdorff_distance(segments(drawn(strand)), segments(strand.points)) <= strand.limit)
                    continue;
                sound = false;
                strand.room *= 0.85;
                if (round < 15) fair(strand), draw(strand);
                else leave(strand);
            }
            if (!sound) continue;
            for (std::size_t i = 0; i < annotations.size(); ++i) {
                Annotation faired = *annotations[i];
                if (is_sound(i, faired, area[i])) continue;
                sound = false;
                for (const auto& uses : uses_[i])
                    for (const StrandUse& use : uses) leave(strands_[use.strand]);
                result[i].note = "its outline would cross itself: it is left as it was";
            }
            if (sound) break;
        }
        for (std::size_t i = 0; i < annotations.size(); ++i) {
            Annotation& one = *annotations[i];
            FairedAnnotation& what = result[i];
            for (const auto& uses : uses_[i])
                for (const StrandUse& use : uses) {
                    const Strand& strand = strands_[use.strand];
                    what.moved = std::max(what.moved, hausdorff_distance(segments(drawn(strand)), segments(strand.points)));
                }
            one.curves = curves_now(i);
            compute_elements(mesh_, one);
            if (one.type == AnnotationType::region) {
                const RegionMeasures measures = measure_region(mesh_, one);
                what.area_after = measures.area;
                what.length_after = measures.perimeter;
            } else {
                what.length_after = length_of(mesh_, one);
            }
        }
        return result;
    }

private:
    std::vector<Places> curves_of(const Annotation& annotation) const {
        if (is_free(annotation)) return annotation.curves;
        std::vector<Places> curves;
        for (const auto& line : annotation.polylines) curves.push_back(vertex_curve(line));
        if (annotation.type == AnnotationType::region)
            for (const OutlinePath& path : outline_paths(mesh_, annotation.faces))
                curves.push_back(vertex_curve(path.vertices, path.closed));
        return curves;
    }

    static bool is_region(const Annotation& annotation) { return annotation.type == AnnotationType::region; }

    std::vector<Point> drawn(const Strand& strand) const { return positions(mesh_, strand.after); }

    /// Junctions are found separately for outlines and for lines: a line that crosses an outline does not fix it there.
    void find_strands(const std::vector<Annotation*>& annotations, const std::vector<std::vector<Places>>& curves) {
        std::vector<CurveStrand> found;
        uses_.resize(curves.size());
        for (const bool regions : {true, false}) {
            std::vector<bool> chosen;
            for (const Annotation* annotation : annotations) chosen.push_back(is_region(*annotation) == regions);
            auto uses = separate_nonmanifold(mesh_, curves, chosen, found);
            for (std::size_t i = 0; i < curves.size(); ++i)
                if (chosen[i]) uses_[i] = std::move(uses[i]);
        }
        for (CurveStrand& one : found) {
            Strand& strand = strands_.emplace_back();
            strand.points = positions(mesh_, one.places);
            strand.after = one.places;
            strand.before = std::move(one.places);
            strand.closed = one.closed;
        }
    }

    /// Equidistant points along the midpoints of the segments; the ends are fixed.
    static std::vector<Point> resampled(const Strand& strand, std::size_t count) {
        std::vector<Point> middles;
        const std::vector<Point>& points = strand.points;
        if (!strand.closed) middles.push_back(points.front());
        for (std::size_t i = 0; i + 1 < points.size(); ++i) middles.push_back(CGAL::midpoint(points[i], points[i + 1]));
        middles.push_back(strand.closed ? middles.front() : points.back());
        std::vector<double> along{0};
        for (std::size_t i = 1; i < middles.size(); ++i) along.push_back(along.back() + distance(middles[i - 1], middles[i]));
        std::vector<Point> result;
        std::size_t at = 0;
        for (std::size_t k = 0; k <= count; ++k) {
            const double s = along.back() * static_cast<double>(k) / static_cast<double>(count);
            while (at + 2 < along.size() && along[at + 1] < s) ++at;
            const double step = along[at + 1] - along[at];
            const double t = step > 0 ? std::clamp((s - along[at]) / step, 0.0, 1.0) : 0;
            result.push_back(middles[at] + t * (middles[at + 1] - middles[at]));
        }
        return result;  // a loop repeats its first point at the end
    }

    void fair(Strand& strand) const {
        strand.length = 0;
        strand.fair.clear();
        for (std::size_t i = 1; i < strand.points.size(); ++i) strand.length += distance(strand.points[i - 1], strand.points[i]);
        if (strand.points.size() < (strand.closed ? 7U : 4U) || !(strand.length > 0)) return;
        const double own_edge = strand.length / static_cast<double>(strand.points.size() - 1);
        strand.limit = options_.distance > 0 ? options_.distance : std::max(own_edge, mean_edge_);
        const std::size_t count = std::clamp<std::size_t>(2 * (strand.points.size() - 1), 8, 100000);
        const std::vector<Point> start = resampled(strand, count);
        const std::size_t n = strand.closed ? count : count + 1;
        const Point origin = start.front();
        Eigen::MatrixXd given(static_cast<Eigen::Index>(n), 3);
        for (std::size_t i = 0; i < n; ++i) {
            const Vector d = start[i] - origin;
            given.row(static_cast<Eigen::Index>(i)) << d.x(), d.y(), d.z();
        }
        const auto solved = [&](double weight) {
            // Second differences times `weight`, and the given points; the ends of an open strand are fixed.
            std::vector<Eigen::Triplet<double>> entries;
            const auto N = static_cast<Eigen::Index>(n);
            for (Eigen::Index i = 0; i < N; ++i) entries.emplace_back(i, i, 1);
            for (Eigen::Index i = strand.closed ? 0 : 1; i < (strand.closed ? N : N - 1); ++i) {
                const Eigen::Index at[3] = {(i + N - 1) % N, i, (i + 1) % N};
                constexpr double factor[3] = {1, -2, 1};
                for (int a = 0; a < 3; ++a)
                    for (int b = 0; b < 3; ++b) entries.emplace_back(at[a], at[b], weight * factor[a] * factor[b]);
            }
            if (!strand.closed)
                for (const Eigen::Index end : {Eigen::Index{0}, N - 1}) entries.emplace_back(end, end, 1e9 * (1 + weight));
            Eigen::SparseMatrix<double> matrix(N, N);
            matrix.setFromTriplets(entries.begin(), entries.end());
            Eigen::MatrixXd right = given;
            if (!strand.closed) {
                right.row(0) *= 1 + 1e9 * (1 + weight);
                right.row(N - 1) *= 1 + 1e9 * (1 + weight);
            }
            const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
            const Eigen::MatrixXd found = solver.solve(right);
            std::vector<Point> points;
            for (Eigen::Index i = 0; i < N; ++i) points.push_back(origin + Vector(found(i, 0), found(i, 1), found(i, 2)));
            if (strand.closed) {
                points.push_back(points.front());
            } else {
                points.front() = strand.points.front();
                points.back() = strand.points.back();
            }
            return points;
        };
        const Segments before = segments(strand.points);
        const auto near = [&](const std::vector<Point>& points) {
            return hausdorff_distance(segments(points), before) <= strand.room * strand.limit;
        };
        double low = -2, high = 7;  // of the logarithm of the weight
        std::vector<Point> best = solved(std::pow(10, low));
        if (!near(best)) return;
        for (int round = 0; round < 12; ++round) {
            check_cancelled();
            const double middle = (low + high) / 2;
            std::vector<Point> points = solved(std::pow(10, middle));
            if (near(points)) low = middle, best = std::move(points);
            else high = middle;
        }
        strand.fair = std::move(best);
    }

    /// Projects the faired curve of a strand onto the surface; a strand that cannot be projected is reset.
    void draw(Strand& strand) const {
        if (strand.fair.empty()) return leave(strand);
        Places drawn;
        strand.aside.clear();
        const std::size_t n = strand.fair.size();
        for (std::size_t i = 0; i < n; ++i) {
            if (strand.closed && i + 1 == n) {
                drawn.push_back(drawn.front());
                strand.aside.push_back(strand.aside.front());
                break;
            }
            const SurfaceHit hit = search_.closest(strand.fair[i]);
            if (!strand.closed && (i == 0 || i + 1 == n)) drawn.push_back(i == 0 ? strand.before.front() : strand.before.back());
            else drawn.push_back(surface_point(mesh_, hit.face, hit.barycentric));
            const Vector along = strand.fair[(i + 1) % n] - strand.fair[i == 0 ? (strand.closed ? n - 2 : 0) : i - 1];
            const Vector left = CGAL::cross_product(normal_at(drawn.back()), along);
            const double size = std::sqrt(left.squared_length());
            strand.aside.push_back(size > 0 ? left / size : Vector(0, 0, 0));
        }
        Places places{stored_point(mesh_, drawn.front())};
        for (std::size_t i = 0; i + 1 < drawn.size(); ++i) {
            const double apart = distance(position(mesh_, drawn[i]), position(mesh_, drawn[i + 1]));
            const Vector up = normal_at(drawn[i]) + normal_at(drawn[i + 1]);
            auto line = trace_line(mesh_, drawn[i], drawn[i + 1], up, 2 * apart + 1e-9 * search_.diagonal());
            if (!line) line = geodesic_curve(mesh_, drawn[i], drawn[i + 1]);  // a step across a fold
            if (line && line->length(mesh_) > 4 * apart + 1e-9 * search_.diagonal()) line.reset();
            if (!line) return leave(strand);
            for (std::size_t k = 1; k < line->points.size(); ++k)
                if (const SurfacePoint p = stored_point(mesh_, line->points[k]); p != places.back()) places.push_back(p);
        }
        if (places.size() < (strand.closed ? 4U : 2U)) return leave(strand);
        strand.after = std::move(places);
    }

    /// The sum of the normals of the faces of the point: for a point on an edge, the choice of one face would depend on
    /// rounding.
    Vector normal_at(const SurfacePoint& p) const {
        Vector sum(0, 0, 0);
        for (const Face face : faces_of(mesh_, p)) sum = sum + search_.normal(face);
        return sum;
    }

    static void leave(Strand& strand) {
        strand.fair.clear();
        strand.after = strand.before;
    }

    std::vector<Places> curves_now(std::size_t i) const {
        std::vector<Places> curves;
        for (const auto& uses : uses_[i]) {
            Places& curve = curves.emplace_back();
            for (const StrandUse& use : uses) {
                Places part = strands_[use.strand].after;
                if (use.backwards) std::reverse(part.begin(), part.end());
                curve.insert(curve.end(), part.begin() + (curve.empty() ? 0 : 1), part.end());
            }
        }
        return curves;
    }

    /// Shifts strands sideways to compensate the area deficit of each region. Returns false if there is nothing to shift.
    bool keep_areas(const std::vector<Annotation*>& annotations, const std::vector<double>& area) {
        std::vector<std::size_t> movable;
        std::map<std::size_t, Eigen::Index> column;
        for (std::size_t s = 0; s < strands_.size(); ++s)
            if (!strands_[s].fair.empty()) {
                column[s] = static_cast<Eigen::Index>(movable.size());
                movable.push_back(s);
            }
        if (movable.empty()) return false;
        std::vector<std::pair<std::size_t, double>> lacks;
        bool kept = true;
        for (std::size_t i = 0; i < annotations.size(); ++i) {
            if (!is_region(*annotations[i])) continue;
            Annotation now = *annotations[i];
            now.curves = curves_now(i);
            const CurveFilling filling = fill_curves(mesh_, curves_on(mesh_, now));
            const double lack = area[i] - filling.area(mesh_);
            if (filling.conflicts > 0 || std::abs(lack) > 0.5 * area[i]) continue;
            kept = kept && std::abs(lack) <= 1e-6 * area[i];
            Response& response = responses_[i];
            // On a bumpy surface, a shift changes the area by more than length times shift; the ratio observed in the previous
            // step is used.
            if (response.expected != 0) response.gain = std::clamp((response.lack - lack) / response.expected, 0.3, 4.0);
            response.lack = lack;
            lacks.emplace_back(i, lack);
        }
        if (kept) return false;
        // The area of each region changes by the length of its strands times their shift; the solution with the smallest shifts
        // is used.
        const auto rows = static_cast<Eigen::Index>(lacks.size());
        Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(rows, static_cast<Eigen::Index>(movable.size()));
        Eigen::VectorXd wanted(rows);
        for (Eigen::Index r = 0; r < rows; ++r) {
            const auto& [region, lack] = lacks[static_cast<std::size_t>(r)];
            wanted[r] = lack / responses_[region].gain;
            for (const auto& uses : uses_[region])
                for (const StrandUse& use : uses)
                    if (const auto at = column.find(use.strand); at != column.end())
                        slopes(r, at->second) += (use.backwards ? 1 : -1) * length_now(strands_[use.strand]);
        }
        // Regions that partition a closed surface make the matrix rank-deficient by one; the threshold detects this despite
        // rounding.
        Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposed;
        decomposed.setThreshold(1e-9);
        decomposed.compute(slopes);
        Eigen::VectorXd shift = decomposed.solve(wanted);
        for (std::size_t c = 0; c < movable.size(); ++c) {
            Strand& strand = strands_[movable[c]];
            double& by = shift[static_cast<Eigen::Index>(c)];
            by = std::clamp(by, -0.1 * strand.limit, 0.1 * strand.limit);
            const std::size_t n = strand.fair.size();
            for (std::size_t i = strand.closed ? 0 : 1; i < (strand.closed ? n : n - 1); ++i)
                strand.fair[i] = strand.fair[i] + by * strand.aside[i];
            if (strand.closed) strand.fair.back() = strand.fair.front();
            draw(strand);
        }
        const Eigen::VectorXd expected = slopes * shift;
        for (Eigen::Index r = 0; r < rows; ++r) responses_[lacks[static_cast<std::size_t>(r)].first].expected = expected[r];
        return true;
    }

    double length_now(const Strand& strand) const {
        double sum = 0;
        for (std::size_t i = 1; i < strand.fair.size(); ++i) sum += distance(strand.fair[i - 1], strand.fair[i]);
        return sum;
    }

    bool is_sound(std::size_t i, Annotation& faired, double area) const {
        faired.curves = curves_now(i);
        if (faired.type != AnnotationType::region) return true;
        const CurveFilling filling = fill_curves(mesh_, curves_on(mesh_, faired));
        return filling.conflicts == 0 && std::abs(filling.area(mesh_) - area) <= 0.5 * area;
    }

    const Mesh& mesh_;
    SurfaceSearch search_;
    const FairOptions& options_;
    double mean_edge_;
    std::vector<Strand> strands_;
    /// The response of a region's area to the previous shift of its strands.
    struct Response {
        double lack = 0, expected = 0, gain = 1;
    };
    std::vector<Response> responses_;
    std::vector<std::vector<std::vector<StrandUse>>> uses_;  ///< by annotation and curve
};

}  // namespace

std::vector<FairedAnnotation> fair_outlines(const Mesh& mesh, AnnotationSet& set, const std::vector<int>& ids,
                                            const FairOptions& options) {
    check_options(options, "annotation smooth");
    std::vector<Annotation*> annotations;
    const auto has_curves = [](const Annotation& one) {
        return one.type != AnnotationType::point && !one.all && (!one.faces.empty() || !one.polylines.empty() || is_free(one));
    };
    for (const int id : ids)
        if (set.find(id) == nullptr)
            fail_input("annotations", "none has the id " + std::to_string(id), "'annotation list' shows ids");
    for (Annotation& one : set.annotations)
        if (has_curves(one) && (ids.empty() || std::find(ids.begin(), ids.end(), one.id) != ids.end()))
            annotations.push_back(&one);
    if (annotations.empty()) return {};
    return Fairing(mesh, options).run(std::move(annotations));
}

void FairOptions::declare_options(OptionList& list) {
    list("distance", distance,
         "maximum distance of a smoothed curve from the original; 0: the mean edge length of the mesh or along the curve",
         Range{0, 1e60}, "unit of the mesh");
    list("let-area-change", let_area_change, "do not restore the areas of regions after smoothing");
}

}  // namespace ostraka
