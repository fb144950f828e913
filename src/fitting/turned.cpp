#include "ostraka/fitting/turned.h"

#include "profile_outline.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/text.h"
#include "ostraka/geom/eigen.h"
#include "ostraka/geom/surface_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace ostraka {

using detail::ProfileImage;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double pi = std::numbers::pi;

/// Everything in the frame of the axis: height along it, directions across it.
struct AxisFrame {
    Vector3d foot = Vector3d::Zero(), up = Vector3d::UnitZ(), u = Vector3d::UnitX(), w = Vector3d::UnitY();
    [[nodiscard]] double height(const Vector3d& p) const { return (p - foot).dot(up); }
    [[nodiscard]] Vector3d across(const Vector3d& p) const { return p - foot - height(p) * up; }
    [[nodiscard]] Vector3d direction(double angle) const { return std::cos(angle) * u + std::sin(angle) * w; }
};

AxisFrame frame_of(const Axis& axis) {
    AxisFrame frame;
    frame.foot = eigen(axis.point);
    frame.up = eigen(axis.direction);
    frame.u = frame.up.cross(std::abs(frame.up.x()) < 0.6 ? Vector3d::UnitX() : Vector3d::UnitY()).normalized();
    frame.w = frame.up.cross(frame.u);
    return frame;
}

struct Joined {
    Mesh mesh;
    std::vector<Index> faces;                     ///< that are not of a break
    std::vector<std::vector<Index>> of_fragment;  ///< the same, fragment by fragment
};

Joined joined(const std::vector<const Fragment*>& sherds, const std::vector<Motion>& motions) {
    Joined all;
    for (std::size_t k = 0; k < sherds.size(); ++k) {
        const Fragment* sherd = sherds[k];
        const Mesh& mesh = sherd->mesh;
        std::vector<Vertex> vertices;
        for (const Vertex v : mesh.vertices())
            vertices.push_back(all.mesh.add_vertex(point_of(motions[k](eigen(mesh.point(v))))));
        auto& own = all.of_fragment.emplace_back();
        for (const Face face : mesh.faces()) {
            const auto c = corners(mesh, face);
            const Face made = all.mesh.add_face(vertices[c[0]], vertices[c[1]], vertices[c[2]]);
            if (!sherd->facets.empty() && sherd->facets[face] == Facet::fracture) continue;
            own.push_back(static_cast<Index>(made));
        }
        all.faces.insert(all.faces.end(), own.begin(), own.end());
    }
    return all;
}

/// How much clay rays from the axis meet, by height and radius.
ProfileImage look(const SurfaceSearch& search, const AxisFrame& frame, double low, double high, double far,
                  const TurnOptions& options, std::vector<double>& tops) {
    ProfileImage image;
    image.step = (high - low) / options.rows;
    image.rows = static_cast<std::size_t>(options.rows);
    image.columns = static_cast<std::size_t>(std::ceil(far / image.step)) + 2;
    image.clay.assign(image.rows * image.columns, 0);
    image.present.assign(image.rows, 0);
    const int half = std::max(4, options.columns / 2);
    std::vector<std::vector<bool>> met(image.rows, std::vector<bool>(2 * static_cast<std::size_t>(half), false));
    parallel_for(
        image.rows,
        [&](std::size_t row) {
            const Vector3d origin = frame.foot + (low + (static_cast<double>(row) + 0.5) * image.step) * frame.up;
            for (int k = 0; k < half; ++k) {
                // Not along symmetric directions, which edges of made meshes like.
                const Vector3d direction = frame.direction(pi * (k + 0.37) / half);
                const auto hits = search.line_hits(point_of(origin), vector_of(direction), 1.01 * far);
                for (const double side : {1.0, -1.0}) {
                    double begin = 0;
                    bool inside = false, first = true, any = false;
                    const auto visit = [&](const SurfaceHit& hit) {
                        const double radius = side * hit.distance;
                        if (radius < 0) return;
                        const bool leaving = side * eigen(search.normal(hit.face)).dot(direction) > 0;
                        if (first && leaving) inside = true, begin = 0;
                        first = false;
                        if (leaving && inside) {
                            image.add(row, begin, radius);
                            any = true;
                            inside = false;
                        } else if (!leaving && !inside) {
                            begin = radius;
                            inside = true;
                        }
                    };
                    // Outwards from the axis on either side of it.
                    std::vector<SurfaceHit> sorted = hits;
                    std::stable_sort(sorted.begin(), sorted.end(), [&](const SurfaceHit& a, const SurfaceHit& b) {
                        return std::abs(a.distance) < std::abs(b.distance);
                    });
                    for (const SurfaceHit& hit : sorted) visit(hit);
                    if (!any) continue;
                    met[row][static_cast<std::size_t>(side > 0 ? k : half + k)] = true;
                    ++image.present[row];
                }
            }
        },
        4);
    for (std::size_t row = 0; row < image.rows; ++row)
        for (std::size_t c = 0; c < image.columns; ++c)
            if (image.present[row] > 0) image.clay[row * image.columns + c] /= image.present[row];
    tops.assign(2 * static_cast<std::size_t>(half), -1);
    for (std::size_t row = 0; row < image.rows; ++row)
        for (std::size_t k = 0; k < tops.size(); ++k)
            if (met[row][k]) tops[k] = static_cast<double>(row) * image.step;
    return image;
}

/// Rings of vertices around the axis, each with as many as its size asks for, sewn together.
class Lathe {
public:
    Lathe(const AxisFrame& frame, double lowest, double edge) : frame_(frame), lowest_(lowest), edge_(edge) {}

    void ring(const Vector2d& at) {
        Ring ring;
        ring.pole = at.x() < 1e-9 * edge_;
        const int count = ring.pole ? 1 : std::max(6, static_cast<int>(std::lround(2 * pi * at.x() / edge_)));
        for (int k = 0; k < count; ++k)
            ring.vertices.push_back(mesh.add_vertex(
                point_of(frame_.foot + (lowest_ + at.y()) * frame_.up + at.x() * frame_.direction(2 * pi * k / count))));
        rings.push_back(std::move(ring));
    }
    void sew(std::size_t a, std::size_t b) {
        const auto &p = rings[a].vertices, &q = rings[b].vertices;
        const std::size_t n = rings[a].pole ? 0 : p.size(), m = rings[b].pole ? 0 : q.size();
        for (std::size_t i = 0, j = 0; i < n || j < m;) {
            const bool first = j >= m || (i < n && static_cast<double>(i + 1) / static_cast<double>(n) <=
                                                       static_cast<double>(j + 1) / static_cast<double>(m));
            if (first) {
                add(p[i], p[(i + 1) % n], q[j % q.size()]);
                ++i;
            } else {
                add(p[i % p.size()], q[(j + 1) % m], q[j]);
                ++j;
            }
        }
    }
    struct Ring {
        std::vector<Vertex> vertices;
        bool pole = false;
    };
    TriangleSoup soup() const {
        TriangleSoup result = to_soup(mesh);
        result.triangles = triangles_;
        return result;
    }
    Mesh mesh;  ///< vertices only
    std::vector<Ring> rings;

private:
    void add(Vertex a, Vertex b, Vertex c) { triangles_.push_back({Index(a), Index(b), Index(c)}); }
    const AxisFrame& frame_;
    double lowest_, edge_;
    std::vector<std::array<Index, 3>> triangles_;
};

class Turner {
public:
    Turner(const std::vector<const Fragment*>& sherds, const TurnOptions& options) : sherds_(sherds), options_(options) {}

    TurnedTemplate run() {
        for (const Fragment* sherd : sherds_)
            if (!CGAL::is_closed(sherd->mesh))
                fail_input("sherd " + sherd->name, "is not closed, so that where its clay is cannot be told",
                           "close it ('mesh repair'), or leave it out");
        motions_.assign(sherds_.size(), Motion());
        common_axis();
        // Heights are mended by what the template, made of all, says to each.
        for (int round = 0;; ++round) {
            const Joined all = joined(sherds_, motions_);
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
        annotate();
        return std::move(result_);
    }

private:
    static constexpr int height_rounds = 4;

    /// Each sherd's own axis is laid onto the mean of all: sherds put together by hand stand off each other by their joints.
    void common_axis() {
        const Joined all = joined(sherds_, motions_);
        result_.axis = rotation_axis(all.mesh, all.faces, options_.axis);
        std::vector<double> weights;
        Vector3d direction = Vector3d::Zero(), through = Vector3d::Zero(), first = Vector3d::Zero();
        double sum = 0;
        for (const auto& faces : all.of_fragment) {
            SherdOnProfile one;
            one.axis = rotation_axis(all.mesh, faces, options_.axis);
            double area = 0;
            for (const Index f : faces) area += face_area(all.mesh, Face(f));
            weights.push_back(one.axis.found ? area : 0);
            if (one.axis.found) {
                Vector3d own = eigen(one.axis.direction);
                if (first.isZero()) first = own;
                if (own.dot(first) < 0) own = -own;
                direction += area * own;
                sum += area;
            }
            result_.sherds.push_back(std::move(one));
        }
        if (!(sum > 0)) {
            if (!result_.axis.found)
                fail_input("sherds", "have no common axis: " + result_.axis.reason,
                           sherds_.size() > 1 ? "do they lie as they did in the vessel?" : "");
            return;
        }
        direction.normalize();
        const auto middle_of = [&](std::size_t k) { return eigen(area_moments(all.mesh, all.of_fragment[k]).centroid); };
        // Where each axis is at the height of its sherd, across the common direction.
        std::vector<Vector3d> at(sherds_.size(), Vector3d::Zero());
        for (std::size_t k = 0; k < sherds_.size(); ++k) {
            if (weights[k] == 0) continue;
            const Vector3d p = eigen(result_.sherds[k].axis.point), d = eigen(result_.sherds[k].axis.direction);
            at[k] = p + d * ((middle_of(k) - p).dot(direction) / d.dot(direction));
            through += weights[k] / sum * at[k];
        }
        for (std::size_t k = 0; k < sherds_.size(); ++k) {
            SherdOnProfile& one = result_.sherds[k];
            one.name = sherds_[k]->name;
            if (weights[k] == 0) {
                result_.notes.push_back("sherd " + one.name + " has no axis of its own (" + one.axis.reason +
                                        "): it stays where it is");
                continue;
            }
            Vector3d own = eigen(one.axis.direction);
            if (own.dot(direction) < 0) own = -own;
            const Vector3d offset = through - at[k], aside = offset - offset.dot(direction) * direction;
            one.lean = 180 / pi * std::acos(std::min(1.0, own.dot(direction)));
            one.aside = aside.norm();
            if (one.lean > 15 || one.aside > 0.1 * box_diagonal(all.mesh))
                fail_input("sherd " + one.name,
                           "has an axis that leans by " + digits(one.lean, 3) + " degrees against that of all and lies " +
                               digits(one.aside, 3) + " off it",
                           "lay the sherds as they were in the vessel, or leave it out");
            motions_[k].turn = Eigen::Quaterniond::FromTwoVectors(own, direction).toRotationMatrix();
            motions_[k].shift = at[k] + aside - motions_[k].turn * at[k];
        }
        const auto heaviest = static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
        if (!result_.axis.found) result_.axis = result_.sherds[heaviest].axis;
        result_.axis.direction = vector_of(direction);
        result_.axis.point = point_of(through);
    }

    void mend_heights(const Joined& all) {
        const SurfaceSearch surface(result_.mesh);
        const double reach = 0.05 * surface.diagonal();
        for (std::size_t k = 0; k < sherds_.size(); ++k) {
            double a = 0, b = 0;
            for (const Index f : all.of_fragment[k]) {
                const Vector3d n = eigen(area_vector(all.mesh, Face(f))), p = eigen(centroid(all.mesh, Face(f)));
                if (!(n.norm() > 0)) continue;
                const auto hit = surface.closest_compatible(point_of(p), vector_of(n.normalized()), 0.8, reach);
                if (!hit) continue;
                const Vector3d m = eigen(surface.normal(hit->face));
                const double up = m.dot(frame_.up);
                a += n.norm() * up * up;
                b += n.norm() * up * m.dot(eigen(hit->point) - p);
            }
            // More than the step: part of the template there is the sherd itself.
            if (a > 0) motions_[k].shift += std::clamp(1.3 * b / a, -reach, reach) * frame_.up;
        }
    }

    void profile(const SurfaceSearch& search, const Joined& all) {
        double low = 1e300, high = -1e300, far = 0;
        bridged_.clear();
        result_.present.clear();
        rings_.clear();
        ring_of_.clear();
        for (int turn = 0; turn < 2; ++turn) {
            frame_ = frame_of(result_.axis);
            low = 1e300, high = -1e300, far = 0;
            for (const Vertex v : all.mesh.vertices()) {
                const Vector3d p = eigen(all.mesh.point(v));
                low = std::min(low, frame_.height(p));
                high = std::max(high, frame_.height(p));
                far = std::max(far, frame_.across(p).norm());
            }
            std::vector<double> tops;
            image_ = look(search, frame_, low, high, far, options_, tops);
            drop_rare();
            judge_ends(tops);
            // The foot is where the clay reaches the axis; of an open tube the narrower end.
            const bool upside_down = !result_.base && image_.reaches_axis_above();
            if (turn == 1 || !upside_down) break;
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

    /// Heights with too little wall do not count.
    void drop_rare() {
        const double least = options_.presence / 360 * 2 * std::max(4, options_.columns / 2);
        for (std::size_t row = 0; row < image_.rows; ++row)
            if (image_.present[row] < std::max(1.0, least)) image_.clear(row);
    }

    void judge_ends(const std::vector<double>& tops) {
        result_.base = image_.reaches_axis_below();
        // A rim: where there is wall near the top, it ends at one height.
        const double highest = *std::max_element(tops.begin(), tops.end());
        double near = 0, at = 0;
        for (const double top : tops) {
            if (top < highest - 30 * image_.step) continue;
            ++near;
            if (top > highest - 4 * image_.step) ++at;
        }
        result_.rim = at > 0.8 * near && near > options_.presence / 360 * static_cast<double>(tops.size());
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
        Lathe lathe(frame_, lowest_, edge);
        for (const Vector2d& p : result_.profile) lathe.ring(p);
        const std::size_t count = result_.profile.size();
        for (std::size_t i = 0; i + 1 < count; ++i) lathe.sew(i, i + 1);
        if (closed_) lathe.sew(count - 1, 0);
        TriangleSoup soup = lathe.soup();
        double volume = 0;
        const auto at = [&](Index i) -> Vector3d {
            return Vector3d(soup.points[i][0], soup.points[i][1], soup.points[i][2]) - frame_.foot;
        };
        for (const auto& t : soup.triangles) volume += at(t[0]).cross(at(t[1])).dot(at(t[2]));
        if (volume < 0)
            for (auto& t : soup.triangles) std::swap(t[1], t[2]);
        result_.mesh = build_mesh(soup);
        for (const auto& ring : lathe.rings) {
            ring_of_.insert(ring_of_.end(), ring.vertices.size(), rings_.size());
            rings_.push_back(ring.vertices);
        }
    }

    void annotate() {
        AnnotationSet& set = result_.annotations;
        set.object_class = "turned vessel";
        set.up = {frame_.up.x(), frame_.up.y(), frame_.up.z()};
        const auto& line = result_.profile;
        const auto higher = [](const Vector2d& a, const Vector2d& b) { return a.y() < b.y(); };
        const auto top = static_cast<std::size_t>(std::max_element(line.begin(), line.end(), higher) - line.begin());
        // From the foot outside up, inside down.
        std::size_t widest = 0, foot = 0;
        const double height = line[top].y();
        for (std::size_t i = 0; i <= top; ++i) {
            if (line[i].x() > line[widest].x()) widest = i;
            if (line[i].y() < 0.015 * height) foot = i;
        }
        std::vector<bool> outer(result_.mesh.number_of_faces()), base(outer.size(), false);
        for (const Face f : result_.mesh.faces()) {
            std::size_t low = line.size(), high = 0;
            for (const Vertex v : corners(result_.mesh, f)) {
                low = std::min(low, ring_of_[v]);
                high = std::max(high, ring_of_[v]);
            }
            outer[f] = high <= top;
            base[f] = result_.base && high <= foot;
        }
        ensure_root(set, result_.mesh);
        Attribute axis;
        axis.name = "axis";
        axis.type = AttributeType::descriptor;
        axis.descriptor.is_list = true;
        for (const Vector3d& v : {Vector3d(frame_.foot + lowest_ * frame_.up), frame_.up})
            for (int k = 0; k < 3; ++k) axis.descriptor.values.push_back(v[k]);
        set.annotations.front().attributes.push_back(axis);
        const auto region = [&](const std::string& tag, std::array<int, 3> colour, const std::function<bool(Index)>& in) {
            Annotation one;
            one.id = free_id(set);
            one.tag = tag;
            one.colour = colour;
            for (Index f = 0; f < outer.size(); ++f)
                if (in(f)) one.faces.push_back(f);
            if (!one.faces.empty()) set.annotations.push_back(std::move(one));
        };
        region("outer", {186, 120, 82}, [&](Index f) { return outer[f]; });
        region("inner", {150, 110, 90}, [&](Index f) { return !outer[f]; });
        region("base", {90, 70, 60}, [&](Index f) { return base[f]; });
        const auto ring = [&](const std::string& tag, std::size_t i, std::array<int, 3> colour) {
            if (rings_[i].size() < 3) return;
            Annotation one;
            one.id = free_id(set);
            one.tag = tag;
            one.colour = colour;
            one.type = AnnotationType::line;
            auto& way = one.polylines.emplace_back();
            for (const Vertex v : rings_[i]) way.push_back(Index(v));
            way.push_back(Index(rings_[i].front()));
            Attribute diameter;
            diameter.name = "diameter";
            diameter.type = AttributeType::measure;
            diameter.measure.tool = "ruler";
            diameter.measure.points = {Index(rings_[i].front()), Index(rings_[i][rings_[i].size() / 2])};
            diameter.measure.value =
                (eigen(result_.mesh.point(rings_[i].front())) - eigen(result_.mesh.point(rings_[i][rings_[i].size() / 2])))
                    .norm();
            one.attributes.push_back(std::move(diameter));
            set.annotations.push_back(std::move(one));
        };
        ring(result_.rim ? "rim" : "upper end", top, {40, 60, 120});
        ring("widest girth", widest, {40, 120, 60});
        if (result_.base) ring("foot", foot, {60, 40, 40});
        const auto pole = [&](const std::string& tag, std::size_t i) {
            if (rings_[i].size() != 1) return;
            Annotation one;
            one.id = free_id(set);
            one.tag = tag;
            one.colour = {30, 30, 30};
            one.type = AnnotationType::point;
            one.points = {Index(rings_[i].front())};
            set.annotations.push_back(std::move(one));
        };
        pole("base centre", 0);
        pole("floor centre", line.size() - 1);
    }

    void compare(const Joined& all, std::size_t k) {
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
        if (area > 0) one.residual = std::sqrt(squares / area);
    }

    const std::vector<const Fragment*>& sherds_;
    const TurnOptions& options_;
    AxisFrame frame_;
    std::vector<Motion> motions_;  ///< of each sherd to where its axis and height are those of all
    std::vector<std::string> bridged_;
    ProfileImage image_;
    double lowest_ = 0;
    bool closed_ = false;
    std::vector<std::size_t> ring_of_;
    std::vector<std::vector<Vertex>> rings_;
    TurnedTemplate result_;
};

}  // namespace

TurnedTemplate turn_template(const std::vector<const Fragment*>& sherds, const TurnOptions& options) {
    check_options(options, "turned template");
    if (sherds.empty()) fail_usage("there is no sherd", "give one or more");
    return Turner(sherds, options).run();
}

}  // namespace ostraka
