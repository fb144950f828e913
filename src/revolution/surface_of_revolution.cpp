#include "ostraka/revolution/surface_of_revolution.h"
#include "ostraka/core/angles.h"

#include "stages.h"

#include "ostraka/core/error.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"

#include <algorithm>
#include <cmath>

namespace ostraka {

using detail::ProfileImage;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

class RevolutionBuilder {
public:
    RevolutionBuilder(const std::vector<const Fragment*>& sherds, const RevolutionOptions& options)
        : sherds_(sherds), options_(options) {}

    RevolutionTemplate run() {
        for (const Fragment* sherd : sherds_)
            if (!CGAL::is_closed(sherd->mesh))
                fail_input("sherd " + sherd->name, "is not closed, so that where its clay is cannot be told",
                           "close it ('mesh repair'), or leave it out");
        motions_ = common_axis(sherds_, options_, result_);
        // Heights are mended by what the template, made of all, says to each.
        for (int round = 0;; ++round) {
            const JoinedSherds all = joined(sherds_, motions_);
            const SurfaceSearch search(all.mesh);
            profile(search, all);
            make();
            if (round == height_rounds || sherds_.size() == 1) {
                for (std::size_t k = 0; k < sherds_.size(); ++k) compare(all, k);
                break;
            }
            mend_heights(all);
        }
        result_.notes.insert(result_.notes.end(), bridged_.begin(), bridged_.end());
        annotate_revolution(result_, frame_, lowest_, rings_);
        return std::move(result_);
    }

private:
    static constexpr int height_rounds = 4;

    void mend_heights(const JoinedSherds& all) {
        const SurfaceSearch surface(result_.mesh);
        const double search_radius = 0.05 * surface.diagonal();
        for (std::size_t k = 0; k < sherds_.size(); ++k) {
            double a = 0, b = 0;
            for (const Index f : all.of_fragment[k]) {
                const Vector3d n = eigen(area_vector(all.mesh, Face(f))), p = eigen(centroid(all.mesh, Face(f)));
                if (!(n.norm() > 0)) continue;
                const auto hit = surface.closest_compatible(point_of(p), vector_of(n.normalized()), 0.8, search_radius);
                if (!hit) continue;
                const Vector3d m = eigen(surface.normal(hit->face));
                const double up = m.dot(frame_.up);
                a += n.norm() * up * up;
                b += n.norm() * up * m.dot(eigen(hit->point) - p);
            }
            // More than the step: part of the template there is the sherd itself.
            if (a > 0) motions_[k].translation += std::clamp(1.3 * b / a, -search_radius, search_radius) * frame_.up;
        }
    }

    void profile(const SurfaceSearch& search, const JoinedSherds& all) {
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
            WallSection section = wall_section(search, frame_, low, high, far, options_);
            section.drop_rare(options_);
            result_.rim = section.has_rim(options_);
            image_ = std::move(section.image);
            result_.base = image_.reaches_axis(0, image_.rows / 2);
            // The foot is where the wall reaches the axis; of an open tube the narrower end.
            const bool upside_down = !result_.base && image_.reaches_axis(image_.rows / 2, image_.rows);
            if (attempt == 1 || !upside_down) break;
            result_.axis.direction = -result_.axis.direction;
        }
        image_.bridge(&bridged_);
        image_.smooth(options_.smoothing);
        detail::Outline outline = image_.outline();
        if (outline.points.size() < 8)
            fail_input("sherds", "have no profile: at no height is there enough of a wall",
                       "ask for less presence, or look at their axis");
        double lowest = 1e300;
        for (const Vector2d& p : outline.points) lowest = std::min(lowest, p.y());
        for (Vector2d& p : outline.points) p.y() -= lowest;
        lowest_ = low + lowest;
        closed_ = outline.closed;
        result_.profile = std::move(outline.points);
        const std::size_t rows = image_.rows;
        for (std::size_t row = 0; row < rows; ++row)
            result_.present.push_back(360.0 * image_.present[row] / std::max(8.0, 2.0 * std::max(4, options_.columns / 2)));
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
        one.name = sherds_[k]->name;
        one.motion = motions_[k];
        const SurfaceSearch surface(result_.mesh);
        double area = 0, squares = 0, tolerance = 0.02 * surface.diagonal();
        one.lowest = 1e300, one.highest = -1e300;
        for (const Index f : all.of_fragment[k]) {
            const Vector3d p = eigen(centroid(all.mesh, Face(f))), n = eigen(area_vector(all.mesh, Face(f)));
            one.lowest = std::min(one.lowest, frame_.height(p) - lowest_);
            one.highest = std::max(one.highest, frame_.height(p) - lowest_);
            if (!(n.norm() > 0)) continue;
            const auto hit = surface.closest_compatible(point_of(p), vector_of(n.normalized()), 0.8, tolerance);
            if (!hit) continue;  // of a break
            area += n.norm();
            squares += n.norm() * hit->distance * hit->distance;
        }
        if (!(area > 0))
            fail_input("sherd '" + one.name + "'", "its walls are nowhere on the vessel that all sherds make",
                       "is it in another unit than the others, inside out, or of another vessel?");
        one.residual = std::sqrt(squares / area);
    }

    const std::vector<const Fragment*>& sherds_;
    const RevolutionOptions& options_;
    AxisFrame frame_;
    std::vector<Motion> motions_;  ///< of each sherd to where its axis and height are those of all
    std::vector<std::string> bridged_;
    ProfileImage image_;
    double lowest_ = 0;
    bool closed_ = false;
    ProfileRings rings_;
    RevolutionTemplate result_;
};

}  // namespace

RevolutionTemplate template_of_revolution(const std::vector<const Fragment*>& sherds, const RevolutionOptions& options) {
    check_options(options, "turned template");
    if (sherds.empty()) fail_usage("there is no sherd", "give one or more");
    return RevolutionBuilder(sherds, options).run();
}

void RevolutionOptions::describe(OptionList& visit) {
    visit("rows", rows, "heights at which the walls are looked at", Range{10, 20000});
    visit("columns", columns, "directions around the axis", Range{8, 7200});
    visit("presence", presence, "degrees of wall that a height must have to count", Range{0, 360});
    visit("profile-smoothing", smoothing, "of the profile: standard deviation in rows", Range{0, 50});
    visit("vertices", vertices, "of the template, about", Range{100, 1e7});
    axis.describe(visit);
}

}  // namespace ostraka
