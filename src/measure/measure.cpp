#include "ostraka/measure/measure.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/progress.h"
#include "ostraka/geom/distance.h"
#include "ostraka/geom/geodesic.h"
#include "ostraka/geom/shortest_path.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/mesh/ids.h"
#include "ostraka/mesh/limits.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace ostraka {

namespace {

/// A pin: its position, and the vertices from which edge paths start with the distance to each.
struct Pin {
    Point point{0, 0, 0};
    Index face = no_index;  ///< of a pin inside a face
    SurfacePoint place;
    std::vector<std::pair<Vertex, double>> gates;
};

/// Evaluates measures on one mesh; the path search is created for the first tape.
class Evaluator {
public:
    explicit Evaluator(const Mesh& mesh) : mesh_(mesh) {}

    Evaluated evaluate(const Annotation& annotation, const Measure& measure) {
        const std::string where = name_of(annotation) + ", " + measure.tool;
        Evaluated result;
        std::vector<double> values;
        double variance = 0;
        const auto pick = [&](const Measure& picking) {
            const std::vector<Pin> pins = pins_at(picking, where);
            values.push_back(value(pins, measure, where));
            variance += resolution(pins, measure);
        };
        pick(measure);
        for (const auto& points : measure.repeats) {
            if (points.size() != measure.points.size())
                fail_input(where,
                           fmt::format("was picked again with {} pins instead of {}", points.size(), measure.points.size()),
                           "pick the same pins again");
            Measure repetition;
            repetition.points = points;
            pick(repetition);
        }
        const auto count = static_cast<double>(values.size());
        for (const double v : values) result.value += (v - values.front()) / count;
        result.value += values.front();
        for (const double v : values) result.spread += (v - result.value) * (v - result.value) / std::max(count - 1, 1.0);
        result.uncertainty = std::sqrt(variance / count + result.spread / count);
        result.spread = std::sqrt(result.spread);
        result.resolution = std::sqrt(variance / count);
        result.pickings = values.size();
        return result;
    }

private:
    std::vector<Pin> pins_at(const Measure& measure, const std::string& where) const {
        const std::size_t count = measure.locations.empty() ? measure.points.size() : measure.locations.size();
        if (count < 2) fail_input(where, "has fewer than two pins", "add pins");
        std::vector<Pin> pins;
        for (std::size_t i = 0; i < count; ++i) pins.push_back(pin(measure, i, where));
        return pins;
    }

    double value(const std::vector<Pin>& pins, const Measure& measure, const std::string& where) {
        if (measure.tool == "bounding") return bounding(pins, measure, where);
        if (measure.tool != "ruler" && measure.tool != "tape")
            fail_input(where, "is not a known tool", "use ruler, tape or bounding");
        double sum = 0;
        for (std::size_t i = 0; i + 1 < pins.size(); ++i) {
            if (measure.tool == "ruler") sum += distance(pins[i].point, pins[i + 1].point);
            else if (!measure.exact) sum += along_surface(pins[i], pins[i + 1], where);
            else sum += joined(geodesic_distance(mesh_, pins[i].place, pins[i + 1].place), where);
        }
        return sum;
    }

    /// Variance of a pin's position in each direction.
    [[nodiscard]] double variance(const Pin& pin) const {
        double area = 0;
        if (pin.face != no_index) area = face_area(mesh_, Face(pin.face));
        else if (const Vertex v = pin.place.vertex(); !mesh_.is_isolated(v))
            for (const Face face : mesh_.faces_around_target(mesh_.halfedge(v)))
                if (face != Mesh::null_face()) area += face_area(mesh_, face) / 3;
        return area / (4 * pi);
    }

    /// Variance of a measure due to the resolution at its pins.
    [[nodiscard]] double resolution(const std::vector<Pin>& pins, const Measure& measure) const {
        double sum = 0;
        if (measure.tool == "bounding") {
            const auto [low, high] = outermost(pins, unit_direction(*measure.direction));
            return low == high ? 0 : variance(pins[low]) + variance(pins[high]);
        }
        for (std::size_t i = 0; i < pins.size(); ++i) {
            Vector derivative(0, 0, 0);
            double coincident = 0;  // coincident pins: may separate in any direction
            for (const std::size_t k : {i - 1, i + 1}) {
                if (k >= pins.size()) continue;
                const Vector difference = pins[i].point - pins[k].point;
                const double length = std::sqrt(difference.squared_length());
                if (length > 0) derivative += difference / length;
                else coincident += 1;
            }
            sum += variance(pins[i]) * (derivative.squared_length() + coincident);
        }
        return sum;
    }

    Pin pin(const Measure& measure, std::size_t i, const std::string& where) const {
        Pin result;
        if (measure.locations.empty()) {
            const Index vertex = measure.points[i];
            if (vertex >= mesh_.number_of_vertices())
                fail_input(where,
                           fmt::format("pin {} is vertex {}, but the mesh has {} vertices, counted from 0", i, vertex,
                                       mesh_.number_of_vertices()),
                           "use the mesh on which the measure was taken");
            result.point = mesh_.point(Vertex(vertex));
            result.gates.emplace_back(Vertex(vertex), 0.0);
            result.place = vertex_point(vertex);
            return result;
        }
        result.place = measure.locations[i];
        const Index face = result.place.element[0];
        if (face >= mesh_.number_of_faces())
            fail_input(where,
                       fmt::format("pin {} lies in face {}, but the mesh has {} faces, counted from 0", i, face,
                                   mesh_.number_of_faces()),
                       "use the mesh on which the measure was taken");
        result.face = face;
        const auto corner = corners(mesh_, Face(face));
        result.point = position(mesh_, result.place);
        for (std::size_t k = 0; k < 3; ++k) {
            if (measure.locations[i].weights[k] >= 1) {  // the pin coincides with this corner
                result.gates.assign(1, {corner[k], 0.0});
                result.place = vertex_point(corner[k]);
                result.face = no_index;
                break;
            }
            result.gates.emplace_back(corner[k], distance(result.point, mesh_.point(corner[k])));
        }
        return result;
    }

    static double bounding(const std::vector<Pin>& pins, const Measure& measure, const std::string& where) {
        if (!measure.direction) fail_input(where, "has no direction", "add a direction");
        const Vector direction = unit_direction(*measure.direction);
        if (direction == CGAL::NULL_VECTOR) fail_input(where, "has a direction without length", "give a vector that is not zero");
        const auto [low, high] = outermost(pins, direction);
        return (pins[high].point - pins[low].point) * direction;
    }

    static Vector unit_direction(const std::array<double, 3>& d) { return unit_vector({d[0], d[1], d[2]}); }

    /// The lowest and highest pins along a unit vector; heights are relative to the first pin, for precision far from the
    /// origin.
    static std::pair<std::size_t, std::size_t> outermost(const std::vector<Pin>& pins, const Vector& direction) {
        std::size_t lowest = 0, highest = 0;
        double low = 0, high = 0;
        for (std::size_t i = 0; i < pins.size(); ++i) {
            const double height = (pins[i].point - pins.front().point) * direction;
            if (height < low) low = height, lowest = i;
            if (height > high) high = height, highest = i;
        }
        return {lowest, highest};
    }

    static double joined(double length, const std::string& where) {
        if (!std::isfinite(length))
            fail_input(where, "no path along the surface connects two of its pins",
                       "the pins lie on separate parts: use a ruler");
        return length;
    }

    double along_surface(const Pin& from, const Pin& to, const std::string& where) {
        if (from.face != no_index && from.face == to.face) return distance(from.point, to.point);
        if (!search_) search_.emplace(mesh_);
        double best = std::numeric_limits<double>::infinity();
        for (const auto& [start, start_length] : from.gates)
            for (const auto& [end, end_length] : to.gates) {
                PathSearch::Query query;
                if (std::isfinite(best)) {
                    query.limit = best - start_length - end_length;
                    if (query.limit <= 0) continue;
                }
                const std::vector<Index> path = search_->find(start, end, query);
                if (path.empty()) continue;
                double length = start_length + end_length;
                for (std::size_t i = 0; i + 1 < path.size(); ++i)
                    length += distance(mesh_.point(Vertex(path[i])), mesh_.point(Vertex(path[i + 1])));
                best = std::min(best, length);
            }
        return joined(best, where);
    }

    const Mesh& mesh_;
    std::optional<PathSearch> search_;
};

}  // namespace

double evaluate(const Mesh& mesh, const Annotation& annotation, const Measure& measure) {
    return Evaluator(mesh).evaluate(annotation, measure).value;
}

Evaluated evaluate_with_uncertainty(const Mesh& mesh, const Annotation& annotation, const Measure& measure) {
    return Evaluator(mesh).evaluate(annotation, measure);
}

namespace {

/// True if both are pickings of the same measure: only their pins at vertices, repeats and values may differ.
bool is_same_measure(const Measure& a, const Measure& b) {
    return a.tool == b.tool && a.points.size() == b.points.size() && a.direction == b.direction && a.exact == b.exact &&
           a.unit == b.unit && a.locations.empty() && b.locations.empty();
}

}  // namespace

std::size_t merge_pickings(Annotation& annotation) {
    std::vector<Attribute> merged_attributes;
    std::size_t merged = 0;
    for (Attribute& attribute : annotation.attributes) {
        const Measure* measure = attribute.measure();
        const auto matching = std::find_if(merged_attributes.begin(), merged_attributes.end(), [&](const Attribute& other) {
            return measure != nullptr && other.measure() != nullptr && other.name == attribute.name &&
                   is_same_measure(*measure, *other.measure());
        });
        if (matching == merged_attributes.end()) {
            merged_attributes.push_back(std::move(attribute));
            continue;
        }
        Measure& merged_measure = *matching->measure();
        merged_measure.repeats.push_back(measure->points);
        merged_measure.repeats.insert(merged_measure.repeats.end(), measure->repeats.begin(), measure->repeats.end());
        merged_measure.stale = true;
        merged_measure.uncertainty.reset();
        ++merged;
    }
    annotation.attributes = std::move(merged_attributes);
    return merged;
}

std::optional<double> evaluate(const Mesh& mesh, const Annotation& annotation, const std::string& descriptor) {
    const auto quantity = DescriptorSearch(mesh).find(annotation, descriptor);
    if (!quantity || quantity->is_list) return std::nullopt;
    return quantity->values.front();
}

std::string descriptor_unit(const std::string& descriptor, const std::string& unit) {
    if (descriptor == "Gaussian curvature integral") return "rad";
    if (unit.empty() || descriptor == "circularity" || descriptor == "box axes") return {};
    if (descriptor == "area") return unit + "^2";
    if (descriptor == "volume" || descriptor == "volume bound") return unit + "^3";
    return unit;
}

std::array<Index, 2> extremes(const Mesh& mesh, const Annotation& annotation, const std::array<double, 3>& direction) {
    check_cancelled();
    const std::vector<Index> vertices = touched_vertices(mesh, annotation);
    if (vertices.empty()) fail_input(name_of(annotation), "has no elements to measure", "select elements first");
    const Vector along = scaled_vector({direction[0], direction[1], direction[2]});
    if (along == CGAL::NULL_VECTOR)
        fail_input(name_of(annotation), "has a direction without length", "give a vector that is not zero");
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

bool is_extent(const Mesh& mesh, const Annotation& annotation, const Measure& measure) {
    if (!measure.direction || !measure.repeats.empty() || touched_vertices(mesh, annotation).empty()) return false;
    Measure extent_measure = measure;
    const auto pins = extremes(mesh, annotation, *measure.direction);
    extent_measure.points.assign(pins.begin(), pins.end());
    extent_measure.locations.clear();
    const double extent = evaluate(mesh, annotation, extent_measure);
    return std::abs(evaluate(mesh, annotation, measure) - extent) <= 1e-9 * extent;
}

void move_extents(AnnotatedMeshView before, const Mesh& after, AnnotationSet& to) {
    for (Annotation& annotation : to.annotations) {
        const Annotation* source = before.annotations.find(annotation.id);
        if (source == nullptr || touched_vertices(after, annotation).empty()) continue;
        for (Attribute& attribute : annotation.attributes) {
            const auto is_same_attribute = [&](const Attribute& candidate) {
                return candidate.id == attribute.id && candidate.measure() != nullptr;
            };
            const auto original = std::find_if(source->attributes.begin(), source->attributes.end(), is_same_attribute);
            if (attribute.measure() == nullptr || original == source->attributes.end() ||
                !is_extent(before.mesh, *source, *original->measure()))
                continue;
            Measure& measure = *attribute.measure();
            const auto pins = extremes(after, annotation, *measure.direction);
            measure.points.assign(pins.begin(), pins.end());
            measure.locations.clear();
        }
    }
}

std::vector<Point> pins_of(const Mesh& mesh, const Measure& measure) {
    std::vector<Point> pins;
    for (std::size_t i = 0; i < measure.points.size(); ++i) {
        const bool located = i < measure.locations.size() && measure.locations[i].element[0] != no_index;
        pins.push_back(position(mesh, located ? measure.locations[i] : vertex_point(measure.points[i])));
    }
    if (measure.tool == "bounding" && measure.direction && pins.size() == 2) {
        const auto& d = *measure.direction;
        const Vector direction(d[0], d[1], d[2]);
        const double length = direction.squared_length();
        if (length > 0) pins[1] = pins[0] + ((pins[1] - pins[0]) * direction / length) * direction;
    }
    return pins;
}

std::vector<Point> path_of_measure(PathSearch& search, const Mesh& mesh, const Measure& measure) {
    std::vector<Point> path;
    if (measure.tool != "tape" || measure.exact || !measure.locations.empty()) return path;
    for (std::size_t i = 1; i < measure.points.size(); ++i)
        for (const Index v : search.find(Vertex(measure.points[i - 1]), Vertex(measure.points[i]), {}))
            path.push_back(mesh.point(Vertex(v)));
    return path;
}

Attribute& add_measure(Annotation& annotation, const std::string& name, Measure measure) {
    annotation.attributes.push_back({next_free_id(annotation.attributes), name, std::move(measure)});
    return annotation.attributes.back();
}

RefreshResult refresh_measures(const Mesh& mesh, AnnotationSet& set, bool uncertainties) {
    RefreshResult result;
    Evaluator evaluator(mesh);
    DescriptorSearch descriptors(mesh);
    descriptors.prepare(set);
    const auto stays_stale = [&](bool& mark, const Annotation& annotation, const Attribute& attribute,
                                 const std::string& reason) {
        mark = true;
        ++result.stale;
        result.notes.push_back(fmt::format("{}, attribute '{}': {}", name_of(annotation), attribute.name, reason));
    };
    for (Annotation& annotation : set.annotations)
        for (Attribute& attribute : annotation.attributes) {
            if (attribute.measure() != nullptr) {
                try {
                    Measure& measure = *attribute.measure();
                    const Evaluated evaluated = evaluator.evaluate(annotation, measure);
                    measure.value = evaluated.value;
                    if (uncertainties || measure.uncertainty || !measure.repeats.empty())
                        measure.uncertainty = evaluated.uncertainty;
                    measure.stale = false;
                    ++result.computed;
                } catch (const Error& error) {
                    if (error.kind() == ErrorKind::cancelled) throw;
                    stays_stale(attribute.measure()->stale, annotation, attribute, error.problem());
                }
            } else if (attribute.descriptor() != nullptr) {
                Descriptor& descriptor = *attribute.descriptor();
                const auto quantity = descriptor.file.empty() ? descriptors.find(annotation, attribute.name) : std::nullopt;
                if (quantity && quantity->is_list == descriptor.is_list) {
                    descriptor.values = quantity->values;
                    descriptor.stale = false;
                    ++result.computed;
                } else if (descriptor.stale) {
                    stays_stale(descriptor.stale, annotation, attribute,
                                descriptor.file.empty()
                                    ? "is not a descriptor that can be computed"
                                    : fmt::format("is in the file '{}' of another mesh: compute it again ('measure map', 'axis')",
                                                  descriptor.file));
                }
            }
        }
    return result;
}

}  // namespace ostraka
