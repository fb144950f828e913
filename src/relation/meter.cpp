// Measurement of the geometric relationships.
#include "relation/meter.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/measure/measure.h"
#include "ostraka/mesh/limits.h"
#include "ostraka/relation/topology.h"

namespace ostraka {

using namespace detail;

namespace {

double angle_between(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), std::abs(a.dot(b))) / degree; }

/// How far a part's own axis, where the part is, is from a line.
double off_line(Part& part, const PartAxis& own, const PartAxis& line) {
    const Vector3d middle = own.point + own.direction * own.direction.dot(part.centroid() - own.point);
    return (middle - line.point).cross(line.direction).norm();
}

const PartAxis& axis_of(Part& part) {
    const PartAxis& axis = part.axis();
    if (!axis.found) throw Unknown{"'" + part.annotation().tag + "' has no axis: " + axis.reason};
    return axis;
}

Vector3d up_of(const AnnotationSet& set, const Relationship& relationship) {
    const auto& up = relationship.parameters.up ? relationship.parameters.up : set.up;
    const Vector3d unit = up ? eigen(unit_vector({(*up)[0], (*up)[1], (*up)[2]})) : Vector3d(0, 0, 0);
    if (unit.isZero(0)) throw Unknown{"it depends on the upward direction: give \"up\" in the annotations or the parameters"};
    return unit;
}

/// The parts of these annotations. Throws Unknown for an empty part.
std::vector<Part*> parts_of(const std::vector<int>& ids, const std::function<Part&(int)>& part) {
    std::vector<Part*> parts;
    for (const int id : ids) parts.push_back(&part(id));
    for (Part* one : parts)
        if (one->empty()) throw Unknown{"'" + one->annotation().tag + "' is empty"};
    return parts;
}

void measure_mirror(const std::vector<Part*>& parts, Findings& findings) {
    for (Part* part : parts)
        if (part->samples().empty()) throw Unknown{"only regions with area have mirror images"};
    const Mirror mirror = find_mirror(*parts.front(), *parts.back());
    findings.add_length("distance", mirror.rms);
    findings.parameters.plane = PointAndDirection{array_of(mirror.point), array_of(mirror.normal)};
}

void measure_axes(const std::vector<Part*>& parts, GeometricRelation kind, Findings& findings) {
    double angle = 0, distance = 0;
    for (Part* a : parts)
        for (Part* b : parts) {
            if (a == b) continue;
            const double between = angle_between(axis_of(*a).direction, axis_of(*b).direction);
            angle = std::max(angle, kind == GeometricRelation::perpendicular_axes ? 90 - between : between);
            distance = std::max(distance, off_line(*b, axis_of(*b), axis_of(*a)));
        }
    findings.add_angle(angle);
    if (kind != GeometricRelation::co_axiality) return;
    findings.add_length("distance", distance);
    const PartAxis& first = axis_of(*parts.front());
    findings.parameters.axis = PointAndDirection{array_of(first.point), array_of(first.direction)};
}

/// Flatness of parts in a common plane, or of points on a line.
void measure_flatness(const std::vector<Part*>& parts, bool on_line, Findings& findings) {
    Cloud all;
    for (Part* part : parts) {
        if (on_line && part->annotation().type != AnnotationType::point) throw Unknown{"only points are co-linear"};
        all.points.insert(all.points.end(), part->cloud().points.begin(), part->cloud().points.end());
        all.weights.insert(all.weights.end(), part->cloud().weights.begin(), part->cloud().weights.end());
    }
    const std::size_t minimum = on_line ? 3 : 4;
    if (all.points.size() < minimum) throw Unknown{"fewer than " + std::to_string(minimum) + " points always are"};
    const Cloud::Plane plane = all.plane();
    findings.add_length("distance", on_line ? std::hypot(plane.rms, plane.spread) : plane.rms);
    if (!on_line) findings.parameters.plane = PointAndDirection{array_of(plane.point), array_of(plane.normal)};
}

void measure_level(const std::vector<Part*>& parts, const Vector3d& up, Findings& findings) {
    double minimum = std::numeric_limits<double>::infinity(), maximum = -minimum;
    for (Part* part : parts) {
        const double height = up.dot(part->centroid());
        minimum = std::min(minimum, height), maximum = std::max(maximum, height);
    }
    findings.add_length("height", maximum - minimum);
    findings.parameters.up = array_of(up);
}

void measure_contact(const Cloud* contact, const std::vector<Part*>& parts, bool support, const Vector3d& up,
                     Findings& findings) {
    if (contact == nullptr) throw Unknown{"the parts do not touch"};
    const Cloud::Plane plane = contact->plane();
    if (!(plane.spread > 1.3 * plane.rms)) throw Unknown{"the contact has no plane"};
    const double tilt = angle_between(plane.normal, up);
    findings.parameters.plane = PointAndDirection{array_of(plane.point), array_of(plane.normal)};
    findings.parameters.up = array_of(up);
    if (!support) return findings.add_tilt(90 - tilt);
    findings.add_tilt(tilt);
    const double at = up.dot(plane.point);
    const double wrong = std::max(up.dot(parts[0]->centroid()) - at, at - up.dot(parts[1]->centroid()));
    findings.add_height_below_0(std::max(0.0, wrong));
}

/// Largest relative difference of the values from their mean, per cent.
double spread_percent(const std::vector<double>& values) {
    const auto [minimum, maximum] = std::minmax_element(values.begin(), values.end());
    const double size = std::max(std::abs(*minimum), std::abs(*maximum));
    return size > 0 ? 100 * (*maximum - *minimum) / size : 0;
}

double shape_difference(Part& a, Part& b) {
    const auto &x = a.shape(), &y = b.shape();
    if (x.empty() || y.empty()) throw Unknown{"a part is too small to have a shape"};
    double difference = 0, size = 0;
    for (std::size_t i = 0; i < x.size(); ++i) difference += std::abs(x[i] - y[i]), size += std::max(x[i], y[i]);
    return size > 0 ? 100 * difference / size : 0;
}

void measure_similarity(const std::vector<Part*>& parts, Findings& findings) {
    std::vector<double> areas;
    double shape = 0;
    for (Part* part : parts) {
        areas.push_back(part->area());
        shape = std::max(shape, shape_difference(*parts.front(), *part));
    }
    findings.add_ratio("area", spread_percent(areas));
    findings.add_ratio("shape", shape);
}

}  // namespace

Axis axis_of_part(const Mesh& mesh, const Annotation& annotation) {
    Part part(mesh, annotation);
    const PartAxis& found = part.axis();
    Axis axis;
    axis.found = found.found;
    axis.reason = found.reason;
    if (!found.found) return axis;
    axis.point = point_of(found.point);
    axis.direction = vector_of(found.direction);
    return axis;
}

std::vector<std::string> measured_quantities(const std::string& type) {
    const RelationType* known = find_relation_type(type);
    return known == nullptr ? std::vector<std::string>() : known->quantities;
}

detail::Findings::Findings(const Relationship& as_stated, const RelationOptions& options, double diagonal,
                           const std::string& unit, RelationParameters& of)
    : stated(as_stated), parameters(of), options_(options), diagonal_(diagonal), unit_(unit) {
    parameters.deviations.clear();
}

void detail::Findings::add(const std::string& quantity, double value, double tolerance, const std::string& unit) {
    for (const auto& deviation : stated.parameters.deviations)
        if (deviation.quantity == quantity && deviation.tolerance) tolerance = *deviation.tolerance;
    parameters.deviations.push_back({quantity, value, tolerance, unit});
    holds_ = holds_ && value <= tolerance;
}

Part& RelationMeter::State::part(int id) {
    const auto entry = parts.find(id);
    if (entry != parts.end()) return entry->second;
    const Annotation* annotation = annotations.find(id);
    if (annotation == nullptr)
        fail_input("relationship", "names annotation " + std::to_string(id) + ", which does not exist",
                   "name an annotation of this file");
    return parts.try_emplace(id, mesh, *annotation).first->second;
}

void RelationMeter::State::used(const std::vector<int>& ids) {
    constexpr std::size_t most_faces = 300'000;  // some hundred bytes per face
    for (const int id : ids) {
        if (const auto at = recent_place.find(id); at != recent_place.end()) recent.erase(at->second);
        else recent_faces += part(id).annotation().faces.size();
        recent_place[id] = recent.insert(recent.end(), id);
    }
    while (recent_faces > most_faces && recent.size() > ids.size()) {
        Part& oldest = part(recent.front());
        recent_faces -= oldest.annotation().faces.size();
        oldest.forget();
        recent_place.erase(recent.front());
        recent.pop_front();
    }
}

namespace {

/// The pairs with the longest shared borders, limited in number of pairs and of edges; all pairs if they are within the limits.
std::vector<AdjacentPair> longest_borders(std::vector<AdjacentPair> pairs) {
    constexpr std::size_t most_pairs = 20'000, most_edges = 4'000'000;
    std::size_t edges = 0;
    for (const AdjacentPair& pair : pairs) edges += pair.edges;
    if (pairs.size() <= most_pairs && edges <= most_edges) return pairs;
    std::sort(pairs.begin(), pairs.end(), [](const AdjacentPair& x, const AdjacentPair& y) {
        return std::tuple(-x.length, x.a, x.b) < std::tuple(-y.length, y.a, y.b);
    });
    std::size_t kept = 0;
    for (edges = 0; kept < std::min(most_pairs, pairs.size()); ++kept)
        if (edges += pairs[kept].edges; edges > most_edges && kept > 0) break;
    pairs.resize(kept);
    return pairs;
}

/// Collects the midpoints of the edges between two regions. A region on both sides of an edge overlaps the others there and
/// does not count.
void add_contacts(AnnotatedMeshView object, Contacts& found) {
    std::vector<std::vector<int>> regions(object.mesh.number_of_faces());
    for (const auto& annotation : object.annotations.annotations)
        for (const Index f : annotation.faces) regions[f].push_back(annotation.id);
    for (auto& list : regions) std::sort(list.begin(), list.end());
    std::vector<int> of_f, of_g;
    for (const Edge e : object.mesh.edges()) {
        const Halfedge h = object.mesh.halfedge(e);
        const Face f = object.mesh.face(h), g = object.mesh.face(object.mesh.opposite(h));
        if (f == Mesh::null_face() || g == Mesh::null_face() || regions[f] == regions[g]) continue;
        of_f.clear(), of_g.clear();
        std::set_difference(regions[f].begin(), regions[f].end(), regions[g].begin(), regions[g].end(), std::back_inserter(of_f));
        std::set_difference(regions[g].begin(), regions[g].end(), regions[f].begin(), regions[f].end(), std::back_inserter(of_g));
        const Vector3d p = eigen(object.mesh.point(object.mesh.source(h))), q = eigen(object.mesh.point(object.mesh.target(h)));
        const auto add = [&](Cloud& cloud) {
            cloud.points.emplace_back((p + q) / 2);
            cloud.weights.push_back((q - p).norm());
        };
        if (of_f.size() * of_g.size() > found.size()) {  // fewer pairs are wanted than meet at this edge
            const auto holds = [](const std::vector<int>& list, int id) {
                return std::binary_search(list.begin(), list.end(), id);
            };
            for (auto& [pair, cloud] : found)
                if ((holds(of_f, pair.first) && holds(of_g, pair.second)) ||
                    (holds(of_g, pair.first) && holds(of_f, pair.second)))
                    add(cloud);
            continue;
        }
        for (const int a : of_f)
            for (const int b : of_g)
                if (const auto entry = found.find(std::minmax(a, b)); entry != found.end()) add(entry->second);
    }
}

}  // namespace

const Contacts& RelationMeter::State::all_contacts() {
    if (contacts) return *contacts;
    const std::vector<AdjacentPair> adjacent = topology(*this).adjacent;
    const std::vector<AdjacentPair> kept = longest_borders(adjacent);
    contacts_left_out = kept.size() < adjacent.size();
    Contacts found;
    for (const auto& pair : kept) found[std::minmax(annotations.annotations[pair.a].id, annotations.annotations[pair.b].id)];
    add_contacts(*this, found);
    return contacts.emplace(std::move(found));
}

const Cloud* RelationMeter::State::contact(int a, int b) {
    const auto entry = all_contacts().find(std::minmax(a, b));
    if (entry != contacts->end()) return &entry->second;
    if (!contacts_left_out) return nullptr;
    Contacts one;  // possibly a pair that was left out
    one[std::minmax(a, b)];
    add_contacts(*this, one);
    const auto& cloud = one.begin()->second;
    return cloud.points.empty() ? nullptr : &contacts->insert_or_assign(std::minmax(a, b), cloud).first->second;
}

std::optional<double> RelationMeter::State::attribute(const Annotation& annotation, const std::string& name) const {
    for (const auto& attribute : annotation.attributes) {
        if (attribute.name != name) continue;
        if (const Measure* measure = attribute.measure()) {
            try {
                return evaluate(mesh, annotation, *measure);
            } catch (const Error& error) {
                if (error.kind() == ErrorKind::cancelled) throw;
                return {};  // for example pins without a path between them
            }
        }
        if (const Descriptor* descriptor = attribute.descriptor()) {
            if (const auto value = evaluate(mesh, annotation, name)) return value;
            if (descriptor->values.size() == 1 && !descriptor->stale) return descriptor->values.front();
        }
    }
    return {};
}

std::vector<double> RelationMeter::State::values(const Relationship& stated) const {
    const std::string& name = stated.parameters.attribute;
    std::vector<double> list;
    for (const int id : stated.annotations) {
        const auto value = attribute(*annotations.find(id), name);
        if (!value) throw Unknown{"annotation " + std::to_string(id) + " has no number '" + name + "'"};
        list.push_back(*value);
    }
    return list;
}

RelationMeter::RelationMeter(AnnotatedMeshView object, const RelationOptions& options)
    : state_(new State{object, options, box_diagonal(object.mesh), {}, {}, false, {}, {}, 0}) {
    check_options(options, "relation");
}
RelationMeter::~RelationMeter() = default;

void RelationMeter::State::measure(GeometricRelation kind, Findings& findings) {
    using enum GeometricRelation;
    const Relationship& stated = findings.stated;
    used(stated.annotations);
    const std::vector<Part*> members = parts_of(stated.annotations, [&](int id) -> Part& { return part(id); });
    switch (kind) {
        case mirror_symmetry:
            return measure_mirror(members, findings);
        case co_axiality:
        case parallel_axes:
        case perpendicular_axes:
            return measure_axes(members, kind, findings);
        case co_linearity:
        case co_planarity:
            return measure_flatness(members, kind == co_linearity, findings);
        case same_level:
            return measure_level(members, up_of(annotations, stated), findings);
        case part_similarity:
            return measure_similarity(members, findings);
        case equal_attributes:
            return findings.add_ratio("difference", spread_percent(values(stated)));
        default: {
            const Vector3d up = up_of(annotations, stated);
            measure_contact(contact(stated.annotations[0], stated.annotations[1]), members, kind == horizontal_support, up,
                            findings);
        }
    }
}

RelationCheck RelationMeter::measure(const Relationship& relationship) {
    RelationCheck check;
    check.parameters = relationship.parameters;
    const RelationType* type = find_relation_type(relationship.type);
    if (type == nullptr || type->quantities.empty()) {
        check.text = "cannot be measured";
        return check;
    }
    Findings findings(relationship, state_->options, state_->diagonal, state_->annotations.unit, check.parameters);
    try {
        state_->measure(*type->geometric, findings);
    } catch (const Unknown& unknown) {
        check.parameters = relationship.parameters;
        check.text = unknown.text;
        return check;
    }
    check.verdict = findings.holds() ? Verdict::holds : Verdict::fails;
    if (!findings.holds())
        for (const auto& deviation : check.parameters.deviations)
            if (*deviation.value > *deviation.tolerance) check.text += (check.text.empty() ? "" : ", ") + deviation.quantity;
    if (!check.text.empty()) check.text = "out of tolerance: " + check.text;
    return check;
}

}  // namespace ostraka
