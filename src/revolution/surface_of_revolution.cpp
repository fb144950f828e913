#include "ostraka/revolution/surface_of_revolution.h"
#include "ostraka/core/angles.h"

#include "stages.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"
#include "ostraka/stats/summary.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

using detail::ProfileImage;
using Eigen::Vector2d;
using Eigen::Vector3d;

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
        for (SherdOnProfile& one : left_out) result_.sherds.push_back(std::move(one));
    }

    RevolutionTemplate run() {
        look_at_each();
        for (;;) {
            for (LaidSherd& one : sherds_) one.motion = {};
            find_common_axis(sherds_, options_, result_);
            if (!any_walls()) {
                for (SherdOnProfile& one : result_.sherds)
                    if (one.use != SherdUse::left_out) leave_out(one, one.reason, one.remedy);
                fail_all_left_out(result_);
            }
            const bool again = turn() ? drop_one_off_the_template() || take_back() : drop_the_least_sure();
            if (!again) break;
        }
        say_what_is_partly_used();
        result_.notes.insert(result_.notes.end(), bridged_.begin(), bridged_.end());
        annotate_revolution(result_, frame_, lowest_, rings_);
        return std::move(result_);
    }

private:
    static constexpr int height_rounds = 4;
    /// Min share of a sherd's area that lies on the template. Unknown fractures take up to half of the area.
    static double least_on_template(const Fragment& sherd) { return sherd.facets.empty() ? 0.3 : 0.5; }
    /// Min share for a sherd whose own axis contradicts the others.
    static constexpr double enough_on_template = 0.6;

    void look_at_each() {
        for (std::size_t k = 0; k < sherds_.size(); ++k) {
            const Mesh& mesh = sherds_[k].fragment->mesh;
            SherdOnProfile& one = result_.sherds[k];
            if (mesh.number_of_faces() == 0) {
                leave_out(one, "has no faces", "give a mesh, or points of its surface");
                continue;
            }
            sherds_[k].walls = CGAL::is_closed(mesh);
            if (!sherds_[k].walls) {
                one.use = SherdUse::partly;
                one.reason = "is not closed, so that where its clay is cannot be told: of it the axis counts, not the walls";
                one.remedy = "close it ('mesh repair')";
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
            if (volume < 0) result_.notes.push_back("sherd " + one.name + " is inside out: its faces count the other way round");
        }
    }

    [[nodiscard]] std::vector<bool> of_walls() const {
        std::vector<bool> take;
        for (std::size_t k = 0; k < sherds_.size(); ++k)
            take.push_back(sherds_[k].walls && result_.sherds[k].use != SherdUse::left_out);
        return take;
    }

    [[nodiscard]] bool any_walls() const {
        const std::vector<bool> take = of_walls();
        return std::find(take.begin(), take.end(), true) != take.end();
    }

    /// Builds the template from the sherds that are not left out, and refines the heights of the sherds by registering each to
    /// it. False if they have no profile.
    bool turn() {
        const std::vector<bool> take = of_walls();
        const auto count = std::count(take.begin(), take.end(), true);
        heights_.assign(sherds_.size(), 0);
        for (int round = 0;; ++round) {
            const JoinedSherds all = joined(sherds_, take);
            const SurfaceSearch search(all.mesh);
            if (!profile(search, all)) return false;
            make();
            if (round == height_rounds || count == 1) {
                for (std::size_t k = 0; k < sherds_.size(); ++k) compare(all, k);
                return true;
            }
            mend_heights(all);
        }
    }

    /// Drops the sherd with the smallest share on the template.
    bool drop_one_off_the_template() {
        const std::vector<bool> take = of_walls();
        std::size_t worst = 0;
        double least = 1;
        for (std::size_t k = 0; k < sherds_.size(); ++k) {
            const double share = result_.sherds[k].on_template / least_on_template(*sherds_[k].fragment);
            if (take[k] && share < least) worst = k, least = share;
        }
        if (!(least < 1)) return false;
        leave_out(result_.sherds[worst],
                  "has walls that are not on the vessel that the others make (" +
                      digits(100 * result_.sherds[worst].on_template, 2) + " % of its area is)",
                  "is it in another unit than the others, of another vessel, or not where it lay?");
        if (!any_walls()) fail_all_left_out(result_);
        return true;
    }

    /// Takes back sherds whose own axis contradicts the others (a short arc, unknown fractures), but whose walls lie on the
    /// vessel formed by the others: their walls are used, their axis is not.
    bool take_back() {
        bool any = false;
        const SurfaceSearch surface(result_.mesh);
        for (std::size_t k = 0; k < sherds_.size(); ++k) {
            LaidSherd& sherd = sherds_[k];
            if (!sherd.contradicts || !sherd.walls || !sherd.axis) continue;
            sherd.axis = false;
            sherd.motion = {};
            std::vector<bool> alone(sherds_.size(), false);
            alone[k] = true;
            const JoinedSherds own = joined(sherds_, alone);
            if (on_template(surface, own.mesh, own.of_fragment[k]).share < enough_on_template) continue;
            SherdOnProfile& one = result_.sherds[k];
            one.use = SherdUse::partly;
            one.reason = "tells radius and height where it lies; by itself it " + one.reason;
            one.remedy.clear();
            any = true;
        }
        return any;
    }

    /// If the walls have no common radius at any height, drops the sherd with the least information on the axis.
    bool drop_the_least_sure() {
        const std::vector<bool> take = of_walls();
        std::size_t least = take.size();
        for (std::size_t k = 0; k < take.size(); ++k)
            if (take[k] && (least == take.size() || result_.sherds[k].weight < result_.sherds[least].weight)) least = k;
        leave_out(result_.sherds[least], "has walls that are at no height where those of the others are",
                  "ask for less presence (--presence), or look whether it is of the same vessel");
        if (!any_walls()) fail_all_left_out(result_);
        return true;
    }

    void say_what_is_partly_used() {
        for (SherdOnProfile& one : result_.sherds)
            if (one.use == SherdUse::used && !one.axis.found) {
                one.use = SherdUse::partly;
                one.reason = "tells radius and height where it lies; by itself it has no axis: " + one.axis.reason;
            }
    }

    void mend_heights(const JoinedSherds& all) {
        const SurfaceSearch surface(result_.mesh);
        const double search_radius = 0.05 * surface.diagonal();
        for (std::size_t k = 0; k < sherds_.size(); ++k) {
            struct Place {
                double area, up, off;
            };
            std::vector<Place> places;
            std::vector<double> offs;
            for (const Index f : all.of_fragment[k]) {
                const Vector3d n = eigen(area_vector(all.mesh, Face(f))), p = eigen(centroid(all.mesh, Face(f)));
                if (!(n.norm() > 0)) continue;
                const auto hit = surface.closest_compatible(point_of(p), vector_of(n.normalized()), 0.8, search_radius);
                if (!hit) continue;
                const Vector3d m = eigen(surface.normal(hit->face));
                places.push_back({n.norm(), m.dot(frame_.up), m.dot(eigen(hit->point) - p)});
                offs.push_back(std::abs(places.back().off));
            }
            if (places.empty()) continue;
            // An unknown fracture may face the template from far away: Tukey's weights.
            const double limit = std::max(4.685 * 1.4826 * upper_median(std::move(offs)), 0.002 * surface.diagonal());
            double a = 0, b = 0, area = 0;
            for (const Place& place : places) {
                const double t = place.off / limit;
                if (std::abs(t) >= 1) continue;
                const double weight = place.area * std::pow(1 - t * t, 2);
                area += weight;
                a += weight * place.up * place.up;
                b += weight * place.up * place.off;
            }
            if (!(area > 0)) continue;
            // Radii are accurate to about 0.2 % of the diagonal: the layout determines the height of a wall without slope.
            const double hold = area * std::pow(0.002 / options_.layout_shift, 2);
            double& height = heights_[k];
            // Over-relaxed: the sherd itself is part of the template there.
            const double step = std::clamp(1.3 * (b - hold * height) / (a + hold), -search_radius, search_radius);
            height += step;
            sherds_[k].motion.translation += step * frame_.up;
        }
    }

    /// False if there is no profile.
    bool profile(const SurfaceSearch& search, const JoinedSherds& all) {
        double low = 1e300, high = -1e300, far = 0;
        bridged_.clear();
        result_.present.clear();
        rings_ = {};
        for (int attempt = 0; attempt < 2; ++attempt) {
            frame_ = frame_of(result_.axis);
            low = 1e300, high = -1e300, far = 0;
            for (const Vertex v : all.mesh.vertices()) {
                const Vector3d p = eigen(all.mesh.point(v));
                low = std::min(low, frame_.height(p));
                high = std::max(high, frame_.height(p));
                far = std::max(far, frame_.across(p).norm());
            }
            WallSection section = wall_section(search, all.broken(), frame_, low, high, far, options_);
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

    void make() {
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
        const auto at = [&](Index i) -> Vector3d {
            return Vector3d(soup.points[i][0], soup.points[i][1], soup.points[i][2]) - frame_.foot;
        };
        for (const auto& t : soup.triangles) volume += at(t[0]).cross(at(t[1])).dot(at(t[2]));
        if (volume < 0)
            for (auto& t : soup.triangles) std::swap(t[1], t[2]);
        result_.mesh = build_mesh(soup);
        for (const auto& ring : sweep.rings) {
            rings_.of_vertex.insert(rings_.of_vertex.end(), ring.vertices.size(), rings_.vertices.size());
            rings_.vertices.push_back(ring.vertices);
        }
    }

    void compare(const JoinedSherds& all, std::size_t k) {
        SherdOnProfile& one = result_.sherds[k];
        one.motion = sherds_[k].motion;
        one.on_template = one.residual = one.lowest = one.highest = 0;
        if (all.of_fragment[k].empty()) return;
        one.lowest = 1e300, one.highest = -1e300;
        for (const Index f : all.of_fragment[k]) {
            const double height = frame_.height(eigen(centroid(all.mesh, Face(f)))) - lowest_;
            one.lowest = std::min(one.lowest, height), one.highest = std::max(one.highest, height);
        }
        const OnTemplate found = on_template(SurfaceSearch(result_.mesh), all.mesh, all.of_fragment[k]);
        one.on_template = found.share, one.residual = found.distance;
    }

    struct OnTemplate {
        double share = 0, distance = 0;  ///< share of the area; its root mean square distance
    };
    static OnTemplate on_template(const SurfaceSearch& surface, const Mesh& mesh, const std::vector<Index>& faces) {
        const double tolerance = 0.02 * surface.diagonal();
        double all = 0, on = 0, squares = 0;
        for (const Index f : faces) {
            const Vector3d n = eigen(area_vector(mesh, Face(f)));
            if (!(n.norm() > 0)) continue;
            all += n.norm();
            const auto hit = surface.closest_compatible(centroid(mesh, Face(f)), vector_of(n.normalized()), 0.8, tolerance);
            if (!hit) continue;  // fracture
            on += n.norm();
            squares += n.norm() * hit->distance * hit->distance;
        }
        if (!(on > 0)) return {};
        return {on / all, std::sqrt(squares / on)};
    }

    std::vector<LaidSherd> sherds_;
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
    check_options(options, "turned template");
    if (sherds.empty() && left_out.empty()) fail_usage("there is no sherd", "give one or more");
    return RevolutionBuilder(sherds, options, std::move(left_out)).run();
}

void RevolutionOptions::describe(OptionList& visit) {
    visit("rows", rows, "number of heights at which the walls are sampled", Range{10, 20000});
    visit("columns", columns, "number of directions around the axis", Range{8, 7200});
    visit("presence", presence, "minimum extent of wall around the axis at a height, degrees", Range{0, 360});
    visit("profile-smoothing", smoothing, "smoothing of the profile: standard deviation in rows", Range{0, 50});
    visit("layout-angle", layout_angle, "standard deviation of a sherd's tilt in its pose, degrees", Range{0.001, 90});
    visit("layout-shift", layout_shift, "standard deviation of a sherd's shift in its pose, as a share of the vessel's diagonal",
          Range{1e-6, 1});
    visit("vertices", vertices, "approximate number of vertices of the template", Range{100, 1e7});
    axis.describe(visit);
}

}  // namespace ostraka
