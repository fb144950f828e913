#include "ostraka/revolution/surface_of_revolution.h"
#include "ostraka/core/angles.h"

#include "revolution/stages.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/stats/summary.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace ostraka {

using detail::ProfileImage;

namespace {

class RevolutionBuilder {
public:
    RevolutionBuilder(const std::vector<const Fragment*>& sherds, const RevolutionOptions& options,
                      std::vector<SherdOnProfile> left_out)
        : options_(options) {
        for (const Fragment* sherd : sherds) {
            sherds_.emplace_back().fragment = sherd;
            result_.sherds.emplace_back();
            result_.sherds.back().name = sherd->name;
        }
        for (SherdOnProfile& sherd : left_out) result_.sherds.push_back(std::move(sherd));
    }

    RevolutionTemplate run() {
        check_sherds();
        for (;;) {
            for (PlacedSherd& sherd : sherds_) sherd.motion = {};
            find_common_axis(sherds_, options_, result_);
            if (!any_walls()) {
                for (SherdOnProfile& sherd : result_.sherds)
                    if (sherd.use != SherdUse::left_out) leave_out(sherd, sherd.reason, sherd.remedy);
                fail_all_left_out(result_);
            }
            const bool again = build() ? drop_one_off_the_template() || readmit_sherds() : drop_least_informative();
            if (!again) break;
        }
        report_partly_used();
        result_.notes.insert(result_.notes.end(), bridged_.begin(), bridged_.end());
        annotate_revolution(result_, frame_, lowest_, rings_);
        return std::move(result_);
    }

private:
    static constexpr int height_rounds = 4;
    /// Min share of a sherd's area that lies on the template. Unknown fractures take up to half of the area.
    static double min_on_template(const Fragment& sherd) { return sherd.facets.empty() ? 0.3 : 0.5; }
    /// Min share for a sherd whose own axis contradicts the others.
    static constexpr double min_readmitted = 0.6;

    void check_sherds() {
        for (std::size_t k = 0; k < sherds_.size(); ++k) {
            const Mesh& mesh = sherds_[k].fragment->mesh;
            SherdOnProfile& sherd = result_.sherds[k];
            if (mesh.number_of_faces() == 0) {
                leave_out(sherd, "has no faces", "give a mesh, or points of its surface");
                continue;
            }
            sherds_[k].walls = CGAL::is_closed(mesh);
            if (!sherds_[k].walls) {
                sherd.use = SherdUse::partly;
                sherd.reason =
                    "is not closed, so the inside of its wall cannot be determined: only its axis is used, not its walls";
                sherd.remedy = "close it ('mesh repair')";
                continue;
            }
            double volume = 0;
            const Vector3d origin = eigen(mesh.point(*mesh.vertices().begin()));
            for (const Face f : mesh.faces()) {
                const auto [a, b, c] = corners(mesh, f);
                volume +=
                    (eigen(mesh.point(a)) - origin).dot((eigen(mesh.point(b)) - origin).cross(eigen(mesh.point(c)) - origin));
            }
            sherds_[k].inside_out = volume < 0;
            if (volume < 0) result_.notes.push_back(fmt::format("sherd {} is inside out: its faces are reversed", sherd.name));
        }
    }

    [[nodiscard]] std::vector<bool> walled_sherds() const {
        std::vector<bool> selected;
        for (std::size_t k = 0; k < sherds_.size(); ++k)
            selected.push_back(sherds_[k].walls && result_.sherds[k].use != SherdUse::left_out);
        return selected;
    }

    [[nodiscard]] bool any_walls() const {
        const std::vector<bool> selected = walled_sherds();
        return std::find(selected.begin(), selected.end(), true) != selected.end();
    }

    /// Builds the template from the sherds that are not left out, and refines the heights of the sherds by registering each to
    /// it. False if they have no profile.
    bool build() {
        const std::vector<bool> selected = walled_sherds();
        const auto count = std::count(selected.begin(), selected.end(), true);
        heights_.assign(sherds_.size(), 0);
        for (int round = 0;; ++round) {
            const JoinedSherds joined_walls = joined(sherds_, selected);
            const SurfaceSearch search(joined_walls.mesh);
            if (!profile(search, joined_walls)) return false;
            sweep_profile();
            if (round == height_rounds || count == 1) {
                for (std::size_t k = 0; k < sherds_.size(); ++k) compare(joined_walls, k);
                return true;
            }
            adjust_heights(joined_walls);
        }
    }

    /// Drops the sherd with the smallest share on the template.
    bool drop_one_off_the_template() {
        const std::vector<bool> selected = walled_sherds();
        std::size_t worst = 0;
        double min_ratio = 1;
        for (std::size_t k = 0; k < sherds_.size(); ++k) {
            const double ratio = result_.sherds[k].on_template / min_on_template(*sherds_[k].fragment);
            if (selected[k] && ratio < min_ratio) worst = k, min_ratio = ratio;
        }
        if (!(min_ratio < 1)) return false;
        leave_out(result_.sherds[worst],
                  fmt::format("has walls that are not on the vessel formed by the others ({} % of its area is)",
                              digits(100 * result_.sherds[worst].on_template, 2)),
                  "check whether it is in another unit, from another vessel, or misplaced");
        if (!any_walls()) fail_all_left_out(result_);
        return true;
    }

    /// Takes back sherds whose own axis contradicts the others (a short arc, unknown fractures), but whose walls lie on the
    /// vessel formed by the others: their walls are used, their axis is not.
    bool readmit_sherds() {
        bool readmitted = false;
        const SurfaceSearch surface(result_.mesh);
        for (std::size_t k = 0; k < sherds_.size(); ++k) {
            PlacedSherd& sherd = sherds_[k];
            if (!sherd.contradicts || !sherd.walls || !sherd.axis) continue;
            sherd.axis = false;
            sherd.motion = {};
            std::vector<bool> alone(sherds_.size(), false);
            alone[k] = true;
            const JoinedSherds single = joined(sherds_, alone);
            if (on_template(surface, single.mesh, single.of_fragment[k]).share < min_readmitted) continue;
            SherdOnProfile& on_profile = result_.sherds[k];
            on_profile.use = SherdUse::partly;
            on_profile.reason = "contributes radius and height in its given position; by itself it " + on_profile.reason;
            on_profile.remedy.clear();
            readmitted = true;
        }
        return readmitted;
    }

    /// If the walls have no common radius at any height, drops the sherd with the least information on the axis.
    bool drop_least_informative() {
        const std::vector<bool> selected = walled_sherds();
        std::size_t least_informative = selected.size();
        for (std::size_t k = 0; k < selected.size(); ++k)
            if (selected[k] &&
                (least_informative == selected.size() || result_.sherds[k].weight < result_.sherds[least_informative].weight))
                least_informative = k;
        leave_out(result_.sherds[least_informative], "has walls at no height at which the others have walls",
                  "lower --presence, or check whether it belongs to the same vessel");
        if (!any_walls()) fail_all_left_out(result_);
        return true;
    }

    void report_partly_used() {
        for (SherdOnProfile& sherd : result_.sherds)
            if (sherd.use == SherdUse::used && !sherd.axis.found) {
                sherd.use = SherdUse::partly;
                sherd.reason =
                    "contributes radius and height in its given position; by itself it has no axis: " + sherd.axis.reason;
            }
    }

    void adjust_heights(const JoinedSherds& joined_walls) {
        const SurfaceSearch surface(result_.mesh);
        const double search_radius = 0.05 * surface.diagonal();
        for (std::size_t k = 0; k < sherds_.size(); ++k) {
            struct Place {
                double area, up, distance;
            };
            std::vector<Place> places;
            std::vector<double> distances;
            for (const Index f : joined_walls.of_fragment[k]) {
                const Vector3d n = eigen(area_vector(joined_walls.mesh, Face(f))),
                               p = eigen(centroid(joined_walls.mesh, Face(f)));
                if (!(n.norm() > 0)) continue;
                const auto hit = surface.closest_compatible(point_of(p), vector_of(n.normalized()), 0.8, search_radius);
                if (!hit) continue;
                const Vector3d m = eigen(surface.normal(hit->face));
                places.push_back({n.norm(), m.dot(frame_.up), m.dot(eigen(hit->point) - p)});
                distances.push_back(std::abs(places.back().distance));
            }
            if (places.empty()) continue;
            // An unknown fracture may face the template from far away: Tukey's weights.
            const double limit = std::max(4.685 * 1.4826 * upper_median(std::move(distances)), 0.002 * surface.diagonal());
            double a = 0, b = 0, area = 0;
            for (const Place& place : places) {
                const double t = place.distance / limit;
                if (std::abs(t) >= 1) continue;
                const double weight = place.area * std::pow(1 - t * t, 2);
                area += weight;
                a += weight * place.up * place.up;
                b += weight * place.up * place.distance;
            }
            if (!(area > 0)) continue;
            // Radii are accurate to about 0.2 % of the diagonal: the layout determines the height of a wall without slope.
            const double layout_weight = area * std::pow(0.002 / options_.layout_shift, 2);
            double& height = heights_[k];
            // Over-relaxed: the sherd itself is part of the template there.
            const double step =
                std::clamp(1.3 * (b - layout_weight * height) / (a + layout_weight), -search_radius, search_radius);
            height += step;
            sherds_[k].motion.translation += step * frame_.up;
        }
    }

    /// False if there is no profile.
    bool profile(const SurfaceSearch& search, const JoinedSherds& joined_walls) {
        double low = 1e300, high = -1e300, far = 0;
        bridged_.clear();
        result_.present.clear();
        rings_ = {};
        for (int attempt = 0; attempt < 2; ++attempt) {
            frame_ = frame_of(result_.axis);
            low = 1e300, high = -1e300, far = 0;
            for (const Vertex v : joined_walls.mesh.vertices()) {
                const Vector3d p = eigen(joined_walls.mesh.point(v));
                low = std::min(low, frame_.height(p));
                high = std::max(high, frame_.height(p));
                far = std::max(far, frame_.across(p).norm());
            }
            WallSection section = wall_section(search, joined_walls.broken(), frame_, low, high, far, options_);
            section.drop_rare(options_);
            result_.rim = section.has_rim(options_);
            image_ = std::move(section.image);
            result_.base = image_.reaches_axis(0, image_.rows / 2);
            // The foot is where the wall reaches the axis; for an open tube, the narrower end.
            const bool upside_down = !result_.base && image_.reaches_axis(image_.rows / 2, image_.rows);
            if (attempt == 1 || !upside_down) break;
            result_.axis.direction = -result_.axis.direction;
        }
        image_.bridge(&bridged_);
        image_.smooth(options_.smoothing);
        detail::Outline outline = image_.outline();
        if (outline.points.size() < 8) return false;
        double lowest = 1e300;
        for (const Vector2d& p : outline.points) lowest = std::min(lowest, p.y());
        for (Vector2d& p : outline.points) p.y() -= lowest;
        lowest_ = low + lowest;
        closed_ = outline.closed;
        result_.profile = std::move(outline.points);
        const std::size_t rows = image_.rows;
        for (std::size_t row = 0; row < rows; ++row)
            result_.present.push_back(360.0 * image_.present[row] / std::max(8.0, 2.0 * std::max(4, options_.columns / 2)));
        return true;
    }

    void sweep_profile() {
        double length = 0, area = 0;
        const auto& line = result_.profile;
        const std::size_t pieces = closed_ ? line.size() : line.size() - 1;
        for (std::size_t i = 0; i < pieces; ++i) {
            const Vector2d &a = line[i], &b = line[(i + 1) % line.size()];
            length += (b - a).norm();
            area += pi * (a.x() + b.x()) * (b - a).norm();
        }
        const double edge = std::sqrt(2 * area / (std::sqrt(3.0) * static_cast<double>(options_.vertices)));
        // Rows of equilateral triangles.
        result_.profile =
            detail::resampled(line, closed_, std::max(8, static_cast<int>(std::lround(length / (edge * std::sqrt(0.75))))));
        if (!closed_) result_.profile.front().x() = result_.profile.back().x() = 0;
        ProfileSweep sweep(frame_, lowest_, edge);
        for (const Vector2d& p : result_.profile) sweep.ring(p);
        const std::size_t count = result_.profile.size();
        for (std::size_t i = 0; i + 1 < count; ++i) sweep.sew(i, i + 1);
        if (closed_) sweep.sew(count - 1, 0);
        TriangleSoup soup = sweep.soup();
        double volume = 0;
        const auto point_at = [&](Index i) -> Vector3d {
            return Vector3d(soup.points[i][0], soup.points[i][1], soup.points[i][2]) - frame_.foot;
        };
        for (const auto& t : soup.triangles) volume += point_at(t[0]).cross(point_at(t[1])).dot(point_at(t[2]));
        if (volume < 0)
            for (auto& t : soup.triangles) std::swap(t[1], t[2]);
        result_.mesh = build_mesh(soup);
        for (const auto& ring : sweep.rings) {
            rings_.of_vertex.insert(rings_.of_vertex.end(), ring.vertices.size(), rings_.vertices.size());
            rings_.vertices.push_back(ring.vertices);
        }
    }

    void compare(const JoinedSherds& joined_walls, std::size_t k) {
        SherdOnProfile& sherd = result_.sherds[k];
        sherd.motion = sherds_[k].motion;
        sherd.on_template = sherd.residual = sherd.lowest = sherd.highest = 0;
        if (joined_walls.of_fragment[k].empty()) return;
        sherd.lowest = 1e300, sherd.highest = -1e300;
        for (const Index f : joined_walls.of_fragment[k]) {
            const double height = frame_.height(eigen(centroid(joined_walls.mesh, Face(f)))) - lowest_;
            sherd.lowest = std::min(sherd.lowest, height), sherd.highest = std::max(sherd.highest, height);
        }
        const OnTemplate coverage = on_template(SurfaceSearch(result_.mesh), joined_walls.mesh, joined_walls.of_fragment[k]);
        sherd.on_template = coverage.share, sherd.residual = coverage.distance;
    }

    struct OnTemplate {
        double share = 0, distance = 0;  ///< share of the area; its root mean square distance
    };
    static OnTemplate on_template(const SurfaceSearch& surface, const Mesh& mesh, const std::vector<Index>& faces) {
        const double tolerance = 0.02 * surface.diagonal();
        double total_area = 0, covered_area = 0, squares = 0;
        for (const Index f : faces) {
            const Vector3d n = eigen(area_vector(mesh, Face(f)));
            if (!(n.norm() > 0)) continue;
            total_area += n.norm();
            const auto hit = surface.closest_compatible(centroid(mesh, Face(f)), vector_of(n.normalized()), 0.8, tolerance);
            if (!hit) continue;  // fracture
            covered_area += n.norm();
            squares += n.norm() * hit->distance * hit->distance;
        }
        if (!(covered_area > 0)) return {};
        return {covered_area / total_area, std::sqrt(squares / covered_area)};
    }

    std::vector<PlacedSherd> sherds_;
    const RevolutionOptions& options_;
    AxisFrame frame_;
    std::vector<double> heights_;  ///< vertical shift of each sherd
    std::vector<std::string> bridged_;
    ProfileImage image_;
    double lowest_ = 0;
    bool closed_ = false;
    ProfileRings rings_;
    RevolutionTemplate result_;
};

}  // namespace

RevolutionTemplate template_of_revolution(const std::vector<const Fragment*>& sherds, const RevolutionOptions& options,
                                          std::vector<SherdOnProfile> left_out) {
    check_options(options, "surface of revolution");
    if (sherds.empty() && left_out.empty()) fail_usage("there are no sherds", "give one or more");
    return RevolutionBuilder(sherds, options, std::move(left_out)).run();
}

void RevolutionOptions::declare_options(OptionList& list) {
    list("rows", rows, "number of heights at which the walls are sampled", Range{10, 20000});
    list("columns", columns, "number of directions around the axis at which the walls are sampled", Range{8, 7200});
    list("presence", presence, "minimum angle, in degrees about the axis, that sherds must cover at a height of the profile",
         Range{0, 360});
    list("profile-smoothing", smoothing, "standard deviation of the Gaussian that smooths the profile, in rows", Range{0, 50});
    list("layout-angle", layout_angle, "standard deviation of the error of a sherd's tilt in the given poses, in degrees",
         Range{0.001, 90});
    list("layout-shift", layout_shift,
         "standard deviation of the error of a sherd's position in the given poses, as a share of the vessel's diagonal",
         Range{1e-6, 1});
    list("vertices", vertices, "approximate number of vertices of the template", Range{100, 1e7});
    axis.declare_options(list);
}

}  // namespace ostraka
