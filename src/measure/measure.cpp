#include "ostraka/measure/measure.h"

#include "ostraka/annotation/outline.h"
#include "ostraka/core/error.h"
#include "ostraka/geom/shortest_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace ostraka {

namespace {

std::string name_of(const Annotation& annotation) {
    return "annotation " + std::to_string(annotation.id) + " ('" + annotation.tag + "')";
}

double distance(const Point& a, const Point& b) { return std::sqrt(CGAL::squared_distance(a, b)); }

/// A pin: where it is, and the vertices from which edge paths start with the way to each.
struct Pin {
    Point point{0, 0, 0};
    Index face = no_index;  ///< of a pin inside a face
    std::vector<std::pair<Vertex, double>> gates;
};

/// Evaluates measures on one mesh; the path search is made when the first tape needs it.
class Evaluator {
public:
    explicit Evaluator(const Mesh& mesh) : mesh_(mesh) {}

    double evaluate(const Annotation& annotation, const Measure& measure) {
        const std::string where = name_of(annotation) + ", " + measure.tool;
        if (measure.points.size() < 2 && measure.locations.size() < 2) fail_input(where, "has fewer than two pins", "add them");
        std::vector<Pin> pins;
        const std::size_t count = measure.locations.empty() ? measure.points.size() : measure.locations.size();
        for (std::size_t i = 0; i < count; ++i) pins.push_back(pin(measure, i, where));
        if (measure.tool == "bounding") return bounding(pins, measure, where);
        if (measure.tool != "ruler" && measure.tool != "tape")
            fail_input(where, "is not a known tool", "use ruler, tape or bounding");
        double sum = 0;
        for (std::size_t i = 0; i + 1 < pins.size(); ++i)
            sum +=
                measure.tool == "ruler" ? distance(pins[i].point, pins[i + 1].point) : along_surface(pins[i], pins[i + 1], where);
        return sum;
    }

private:
    Pin pin(const Measure& measure, std::size_t i, const std::string& where) const {
        Pin result;
        if (measure.locations.empty()) {
            const Index vertex = measure.points[i];
            if (vertex >= mesh_.number_of_vertices())
                fail_input(where,
                           "pin " + std::to_string(i) + " is vertex " + std::to_string(vertex) + " of " +
                               std::to_string(mesh_.number_of_vertices()),
                           "was it taken on another mesh?");
            result.point = mesh_.point(Vertex(vertex));
            result.gates.emplace_back(Vertex(vertex), 0.0);
            return result;
        }
        const auto& [face, weights] = measure.locations[i];
        if (face >= mesh_.number_of_faces())
            fail_input(where,
                       "pin " + std::to_string(i) + " lies in face " + std::to_string(face) + " of " +
                           std::to_string(mesh_.number_of_faces()),
                       "was it taken on another mesh?");
        result.face = face;
        const auto corner = corners(mesh_, Face(face));
        double x = 0, y = 0, z = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Point& p = mesh_.point(corner[k]);
            x += weights[k] * p.x();
            y += weights[k] * p.y();
            z += weights[k] * p.z();
        }
        result.point = Point(x, y, z);
        for (std::size_t k = 0; k < 3; ++k) {
            if (weights[k] >= 1) {  // the pin is this corner
                result.gates.assign(1, {corner[k], 0.0});
                result.face = no_index;
                break;
            }
            result.gates.emplace_back(corner[k], distance(result.point, mesh_.point(corner[k])));
        }
        return result;
    }

    static double bounding(const std::vector<Pin>& pins, const Measure& measure, const std::string& where) {
        if (!measure.direction) fail_input(where, "has no direction", "add one");
        // Scaled first: squares of huge and tiny numbers are neither.
        const auto& [x, y, z] = *measure.direction;
        const double scale = std::max({std::abs(x), std::abs(y), std::abs(z)});
        const Vector direction(x / scale, y / scale, z / scale);
        const double length = std::sqrt(direction.squared_length());
        if (!(length > 0)) fail_input(where, "has a direction without length", "give a vector that is not zero");
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const Pin& p : pins) {
            // Relative to the first pin, so that nothing is lost far from the origin.
            const double height = ((p.point - pins.front().point) * direction) / length;
            low = std::min(low, height);
            high = std::max(high, height);
        }
        return high - low;
    }

    double along_surface(const Pin& from, const Pin& to, const std::string& where) {
        if (from.face != no_index && from.face == to.face) return distance(from.point, to.point);
        if (!search_) search_.emplace(mesh_);
        double best = std::numeric_limits<double>::infinity();
        for (const auto& [start, way_there] : from.gates)
            for (const auto& [end, way_on] : to.gates) {
                PathSearch::Query query;
                if (std::isfinite(best)) {
                    query.limit = best - way_there - way_on;
                    if (query.limit <= 0) continue;
                }
                const std::vector<Index> path = search_->find(start, end, query);
                if (path.empty()) continue;
                double length = way_there + way_on;
                for (std::size_t i = 0; i + 1 < path.size(); ++i)
                    length += distance(mesh_.point(Vertex(path[i])), mesh_.point(Vertex(path[i + 1])));
                best = std::min(best, length);
            }
        if (!std::isfinite(best))
            fail_input(where, "no path along the surface joins two of its pins", "they lie on separate parts: use a ruler");
        return best;
    }

    const Mesh& mesh_;
    std::optional<PathSearch> search_;
};

double length_of(const Mesh& mesh, const Annotation& annotation) {
    double sum = 0;
    for (const auto& polyline : annotation.polylines)
        for (std::size_t k = 0; k + 1 < polyline.size(); ++k)
            sum += distance(mesh.point(Vertex(polyline[k])), mesh.point(Vertex(polyline[k + 1])));
    return sum;
}

/// V = 1/3 sum c . n A (the thesis's footnote with its erratum), about the first vertex so that nothing is lost far from the
/// origin.
double volume_of(const Mesh& mesh) {
    if (mesh.number_of_faces() == 0) return 0;
    const Point origin = mesh.point(corners(mesh, *mesh.faces().begin())[0]);
    double sum = 0;
    for (const Face face : mesh.faces()) sum += (centroid(mesh, face) - origin) * area_vector(mesh, face);
    return sum / 3;
}

bool is_closed(const Mesh& mesh) {
    return std::none_of(mesh.halfedges().begin(), mesh.halfedges().end(), [&](Halfedge h) { return mesh.is_border(h); });
}

}  // namespace

double evaluate(const Mesh& mesh, const Annotation& annotation, const Measure& measure) {
    return Evaluator(mesh).evaluate(annotation, measure);
}

std::optional<double> evaluate(const Mesh& mesh, const Annotation& annotation, const std::string& descriptor) {
    if (annotation.type == AnnotationType::line && descriptor == "length") return length_of(mesh, annotation);
    if (annotation.type != AnnotationType::region) return std::nullopt;
    if (descriptor == "area") return measure_region(mesh, annotation.faces).area;
    if (descriptor == "perimeter") return measure_region(mesh, annotation.faces).perimeter;
    if (descriptor == "circularity") return measure_region(mesh, annotation.faces).circularity();
    if (descriptor == "volume" && annotation.all && is_closed(mesh)) return volume_of(mesh);
    return std::nullopt;
}

std::string descriptor_unit(const std::string& descriptor, const std::string& unit) {
    if (unit.empty() || descriptor == "circularity") return {};
    if (descriptor == "area") return unit + "^2";
    if (descriptor == "volume") return unit + "^3";
    return unit;
}

std::array<Index, 2> extremes(const Mesh& mesh, const Annotation& annotation, const std::array<double, 3>& direction) {
    const std::vector<Index> vertices = touched_vertices(mesh, annotation);
    if (vertices.empty()) fail_input(name_of(annotation), "has no elements to measure", "select some first");
    const Vector along(direction[0], direction[1], direction[2]);
    const Point origin = mesh.point(Vertex(vertices.front()));
    std::array<Index, 2> result{vertices.front(), vertices.front()};
    double low = 0, high = 0;
    for (const Index vertex : vertices) {
        const double height = (mesh.point(Vertex(vertex)) - origin) * along;
        if (height < low) low = height, result[0] = vertex;
        if (height > high) high = height, result[1] = vertex;
    }
    return result;
}

RefreshResult refresh_measures(const Mesh& mesh, AnnotationSet& set) {
    RefreshResult result;
    Evaluator evaluator(mesh);
    const auto stays_stale = [&](bool& mark, const Annotation& annotation, const Attribute& attribute, const std::string& why) {
        mark = true;
        ++result.stale;
        result.notes.push_back(name_of(annotation) + ", attribute '" + attribute.name + "': " + why);
    };
    for (Annotation& annotation : set.annotations)
        for (Attribute& attribute : annotation.attributes) {
            if (attribute.type == AttributeType::measure) {
                try {
                    attribute.measure.value = evaluator.evaluate(annotation, attribute.measure);
                    attribute.measure.stale = false;
                    ++result.computed;
                } catch (const Error& error) {
                    stays_stale(attribute.measure.stale, annotation, attribute, error.problem());
                }
            } else if (attribute.type == AttributeType::descriptor) {
                Descriptor& descriptor = attribute.descriptor;
                const auto value =
                    descriptor.file.empty() && !descriptor.is_list ? evaluate(mesh, annotation, attribute.name) : std::nullopt;
                if (value) {
                    descriptor.values.assign(1, *value);
                    descriptor.stale = false;
                    ++result.computed;
                } else if (descriptor.stale) {
                    stays_stale(descriptor.stale, annotation, attribute, "is not a descriptor that can be computed here");
                }
            }
        }
    return result;
}

}  // namespace ostraka
