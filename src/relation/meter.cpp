// Measures of the geometric relationships.
#include "meter.h"

#include "ostraka/core/angles.h"
#include "ostraka/core/error.h"
#include "ostraka/core/limits.h"
#include "ostraka/measure/measure.h"
#include "ostraka/relation/topology.h"

namespace ostraka {

using namespace detail;

namespace {

double angle_between(const Vector3d& a, const Vector3d& b) { return std::atan2(a.cross(b).norm(), std::abs(a.dot(b))) / degree; }

double off_line(const Vector3d& p, const PartAxis& line) { return (p - line.point).cross(line.direction).norm(); }

/// Why a relationship cannot be told; not an error: other relationships can.
struct Unknown {
    std::string text;
};

const PartAxis& axis_of(Part& part) {
    const PartAxis& axis = part.axis();
    if (!axis.found) throw Unknown{"'" + part.annotation().tag + "' has no axis: " + axis.reason};
    return axis;
}

Vector3d up_of(const AnnotationSet& set, const Relationship& relationship) {
    const auto& up = relationship.parameters.up ? relationship.parameters.up : set.up;
    const Vector3d unit = up ? eigen(unit_vector({(*up)[0], (*up)[1], (*up)[2]})) : Vector3d(0, 0, 0);
    if (unit.isZero(0)) throw Unknown{"it depends on what is up: give \"up\" in the annotations or the parameters"};
    return unit;
}

/// The measured quantities of one relationship with the tolerances that apply.
class Findings {
public:
    Findings(const Relationship& relationship, RelationParameters& parameters) : stated_(relationship), parameters_(parameters) {
        parameters_.deviations.clear();
    }
    void add(const std::string& quantity, double value, double tolerance, const std::string& unit) {
        for (const auto& deviation : stated_.parameters.deviations)
            if (deviation.quantity == quantity && deviation.tolerance) tolerance = *deviation.tolerance;
        parameters_.deviations.push_back({quantity, value, tolerance, unit});
        holds_ = holds_ && value <= tolerance;
    }
    [[nodiscard]] bool holds() const { return holds_; }

private:
    const Relationship& stated_;
    RelationParameters& parameters_;
    bool holds_ = true;
};

void measure_mirror(const std::vector<Part*>& parts, double tolerance, const std::string& unit, Findings& findings,
                    RelationParameters& parameters) {
    for (Part* part : parts)
        if (part->samples().empty()) throw Unknown{"only regions with area have mirror images"};
    const Mirror mirror = find_mirror(*parts.front(), *parts.back());
    findings.add("distance", mirror.rms, tolerance, unit);
    parameters.plane = PointAndDirection{array_of(mirror.point), array_of(mirror.normal)};
}

/// Largest relative difference of the values from their mean, per cent.
double spread_percent(const std::vector<double>& values) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const double size = std::max(std::abs(*least), std::abs(*most));
    return size > 0 ? 100 * (*most - *least) / size : 0;
}

double shape_difference(Part& a, Part& b) {
    const auto &x = a.shape(), &y = b.shape();
    if (x.empty() || y.empty()) throw Unknown{"a part is too small to have a shape"};
    double difference = 0, size = 0;
    for (std::size_t i = 0; i < x.size(); ++i) difference += std::abs(x[i] - y[i]), size += std::max(x[i], y[i]);
    return size > 0 ? 100 * difference / size : 0;
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
    static const std::map<std::string, std::vector<std::string>> quantities{
        {"mirror symmetry", {"distance"}},    {"co-axiality", {"angle", "distance"}},
        {"co-linearity", {"distance"}},       {"co-planarity", {"distance"}},
        {"same level", {"height"}},           {"parallel axes", {"angle"}},
        {"perpendicular axes", {"angle"}},    {"horizontal support", {"tilt", "height"}},
        {"side contact", {"tilt"}},           {"part similarity", {"area", "shape"}},
        {"equal attributes", {"difference"}},
    };
    const auto entry = quantities.find(type);
    return entry == quantities.end() ? std::vector<std::string>() : entry->second;
}

Part& RelationMeter::State::part(int id) {
    const auto entry = parts.find(id);
    if (entry != parts.end()) return entry->second;
    const Annotation* annotation = set.find(id);
    if (annotation == nullptr)
        fail_input("relationship", "names annotation " + std::to_string(id) + ", which does not exist", "mend it");
    return parts.try_emplace(id, mesh, *annotation).first->second;
}

const Contacts& RelationMeter::State::all_contacts() {
    if (contacts) return *contacts;
    Contacts found;
    const Topology known = topology(mesh, set);
    std::vector<std::vector<int>> regions(mesh.number_of_faces());
    for (const auto& annotation : set.annotations)
        for (const Index f : annotation.faces) regions[f].push_back(annotation.id);
    for (const auto& pair : known.adjacent) {
        const int a = set.annotations[pair.a].id, b = set.annotations[pair.b].id;
        found[std::minmax(a, b)];
    }
    for (const Edge e : mesh.edges()) {
        const Halfedge h = mesh.halfedge(e);
        const Face f = mesh.face(h), g = mesh.face(mesh.opposite(h));
        if (f == Mesh::null_face() || g == Mesh::null_face() || regions[f] == regions[g]) continue;
        const Vector3d p = eigen(mesh.point(mesh.source(h))), q = eigen(mesh.point(mesh.target(h)));
        for (const int a : regions[f])
            for (const int b : regions[g])
                if (const auto entry = found.find(std::minmax(a, b)); a != b && entry != found.end()) {
                    entry->second.points.emplace_back((p + q) / 2);
                    entry->second.weights.push_back((q - p).norm());
                }
    }
    return contacts.emplace(std::move(found));
}

const Cloud* RelationMeter::State::contact(int a, int b) {
    const auto entry = all_contacts().find(std::minmax(a, b));
    return entry == contacts->end() ? nullptr : &entry->second;
}

std::optional<double> RelationMeter::State::attribute(int id, const std::string& name) const {
    const Annotation* annotation = set.find(id);
    for (const auto& attribute : annotation->attributes) {
        if (attribute.name != name) continue;
        if (attribute.type == AttributeType::measure) {
            try {
                return evaluate(mesh, *annotation, attribute.measure);
            } catch (const Error&) {
                return {};  // pins without a way between them, say
            }
        }
        if (attribute.type == AttributeType::descriptor) {
            if (const auto value = evaluate(mesh, *annotation, name)) return value;
            if (attribute.descriptor.values.size() == 1 && !attribute.descriptor.stale)
                return attribute.descriptor.values.front();
        }
    }
    return {};
}

RelationMeter::RelationMeter(const Mesh& mesh, const AnnotationSet& set, const RelationOptions& options)
    : state_(new State{mesh, set, options, box_diagonal(mesh), {}, {}}) {
    check_options(options, "relation");
}
RelationMeter::~RelationMeter() = default;

namespace {

void measure_axes(const std::vector<Part*>& parts, const std::string& type, const RelationOptions& options, double length,
                  const std::string& unit, Findings& findings, RelationParameters& parameters) {
    double angle = 0, distance = 0;
    for (Part* a : parts)
        for (Part* b : parts) {
            if (a == b) continue;
            const double between = angle_between(axis_of(*a).direction, axis_of(*b).direction);
            angle = std::max(angle, type == "perpendicular axes" ? 90 - between : between);
            distance = std::max(distance, off_line(b->centroid(), axis_of(*a)));
        }
    findings.add("angle", angle, options.angle, "degree");
    if (type != "co-axiality") return;
    findings.add("distance", distance, length, unit);
    const PartAxis& first = axis_of(*parts.front());
    parameters.axis = PointAndDirection{array_of(first.point), array_of(first.direction)};
}

void measure_contact(const Cloud* contact, const std::vector<Part*>& parts, const std::string& type, const Vector3d& up,
                     const RelationOptions& options, const std::string& unit, Findings& findings,
                     RelationParameters& parameters) {
    if (contact == nullptr) throw Unknown{"the parts do not touch"};
    const Cloud::Plane plane = contact->plane();
    if (!(plane.spread > 1.3 * plane.rms)) throw Unknown{"the contact has no plane"};
    const double tilt = angle_between(plane.normal, up);
    parameters.plane = PointAndDirection{array_of(plane.point), array_of(plane.normal)};
    if (type == "side contact") {
        findings.add("tilt", 90 - tilt, options.tilt, "degree");
        return;
    }
    findings.add("tilt", tilt, options.tilt, "degree");
    const double at = up.dot(plane.point);
    const double wrong = std::max(up.dot(parts[0]->centroid()) - at, at - up.dot(parts[1]->centroid()));
    findings.add("height", std::max(0.0, wrong), 0, unit);
}

}  // namespace

RelationCheck RelationMeter::measure(const Relationship& relationship) {
    State& state = *state_;
    RelationCheck check;
    check.parameters = relationship.parameters;
    const std::string &type = relationship.type, &unit = state.set.unit;
    const double length = state.options.distance * state.diagonal;
    const auto quantities = measured_quantities(type);
    if (quantities.empty()) {
        check.text = "cannot be measured";
        return check;
    }
    std::vector<Part*> parts;
    for (const int id : relationship.annotations) parts.push_back(&state.part(id));
    Findings findings(relationship, check.parameters);
    try {
        for (Part* part : parts)
            if (part->cloud().points.empty()) throw Unknown{"'" + part->annotation().tag + "' is empty"};
        if (type == "mirror symmetry") {
            measure_mirror(parts, length, unit, findings, check.parameters);
        } else if (type == "co-axiality" || type == "parallel axes" || type == "perpendicular axes") {
            measure_axes(parts, type, state.options, length, unit, findings, check.parameters);
        } else if (type == "co-linearity" || type == "co-planarity") {
            Cloud all;
            for (Part* part : parts) {
                if (type == "co-linearity" && part->annotation().type != AnnotationType::point)
                    throw Unknown{"only points are co-linear"};
                all.points.insert(all.points.end(), part->cloud().points.begin(), part->cloud().points.end());
                all.weights.insert(all.weights.end(), part->cloud().weights.begin(), part->cloud().weights.end());
            }
            const std::size_t least = type == "co-linearity" ? 3 : 4;
            if (all.points.size() < least) throw Unknown{"fewer than " + std::to_string(least) + " points always are"};
            const Cloud::Plane plane = all.plane();
            if (type == "co-planarity") {
                findings.add("distance", plane.rms, length, unit);
                check.parameters.plane = PointAndDirection{array_of(plane.point), array_of(plane.normal)};
            } else {
                findings.add("distance", std::hypot(plane.rms, plane.spread), length, unit);
            }
        } else if (type == "same level") {
            const Vector3d up = up_of(state.set, relationship);
            double least = std::numeric_limits<double>::infinity(), most = -least;
            for (Part* part : parts) {
                const double height = up.dot(part->centroid());
                least = std::min(least, height), most = std::max(most, height);
            }
            findings.add("height", most - least, length, unit);
            check.parameters.up = array_of(up);
        } else if (type == "part similarity") {
            std::vector<double> areas;
            double shape = 0;
            for (Part* part : parts) {
                areas.push_back(part->area());
                shape = std::max(shape, shape_difference(*parts.front(), *part));
            }
            findings.add("area", spread_percent(areas), state.options.ratio, "%");
            findings.add("shape", shape, state.options.ratio, "%");
        } else if (type == "equal attributes") {
            std::vector<double> values;
            for (const int id : relationship.annotations) {
                const auto value = state.attribute(id, relationship.parameters.attribute);
                if (!value)
                    throw Unknown{"annotation " + std::to_string(id) + " has no number '" + relationship.parameters.attribute +
                                  "'"};
                values.push_back(*value);
            }
            findings.add("difference", spread_percent(values), state.options.ratio, "%");
        } else {
            const Vector3d up = up_of(state.set, relationship);
            measure_contact(state.contact(relationship.annotations[0], relationship.annotations[1]), parts, type, up,
                            state.options, unit, findings, check.parameters);
            check.parameters.up = array_of(up);
        }
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
