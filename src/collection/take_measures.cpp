#include "ostraka/annotation/annotation_file.h"
#include "ostraka/collection/measure_definitions.h"
#include "ostraka/core/error.h"
#include "ostraka/core/text.h"
#include "ostraka/interchange/landmarks.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/io/mesh_of_polygons.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/measure/measure.h"
#include "ostraka/mesh/limits.h"
#include "ostraka/slicing/clay.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

/// Reason why a measure cannot be taken on this object.
struct MissingMeasure {
    std::string why;
};

struct MeasuredValue {
    double value = 0;
    int power = 1;
    std::string unit;  ///< for values that are not a power of a length
};

/// "mm^2" gives "mm" and 2; a text that is not such a power gives power 0.
std::pair<std::string, int> length_power(const std::string& unit) {
    const std::size_t caret = unit.find('^');
    if (caret == std::string::npos) return {unit, 1};
    const std::optional<int> power = parse_int(unit.substr(caret + 1));
    return power && *power >= 1 && *power <= 3 ? std::pair(unit.substr(0, caret), *power) : std::pair(unit, 0);
}

/// The files of one object, read on demand.
class MeasureReader {
public:
    MeasureReader(const Mesh* mesh, const AnnotationSet* set, const LandmarkSet* landmarks, const TagMatcher* words)
        : mesh_(mesh), set_(set), landmarks_(landmarks), words_(words) {}

    MeasuredValue value_of(const MeasureDefinition& definition) {
        if (!definition.attribute.empty()) return attribute(definition);
        if (!definition.descriptor.empty()) return descriptor(definition);
        if (!definition.clay.empty()) return clay(definition);
        if (definition.tool == "bounding") return bounding(definition);
        return definition.tool == "ruler" ? ruler(definition) : tape(definition);
    }

private:
    const Mesh& mesh() const {
        if (mesh_ == nullptr) throw MissingMeasure{"the object has no mesh"};
        return *mesh_;
    }
    const Annotation* find(const std::string& tag) const {
        if (set_ == nullptr) return nullptr;
        const Annotation* matching_annotation = nullptr;
        for (const Annotation& annotation : set_->annotations) {
            if (annotation.tag != tag) continue;
            if (matching_annotation != nullptr) throw MissingMeasure{fmt::format("two annotations are called '{}'", tag)};
            matching_annotation = &annotation;
        }
        if (matching_annotation != nullptr || words_ == nullptr) return matching_annotation;
        const std::vector<std::size_t> matching_indices = words_->find(*set_, tag);
        if (matching_indices.size() > 1) throw MissingMeasure{fmt::format("several annotations match '{}'", tag)};
        return matching_indices.empty() ? nullptr : &set_->annotations[matching_indices.front()];
    }
    const Annotation& require(const std::string& tag) const {
        if (set_ == nullptr) throw MissingMeasure{"the object has no annotations"};
        const Annotation* annotation = find(tag);
        if (annotation == nullptr) throw MissingMeasure{fmt::format("no annotation is called '{}'", tag)};
        return *annotation;
    }
    /// The annotation to measure; the whole mesh if none is named.
    Annotation measured(const MeasureDefinition& definition) const {
        if (!definition.annotation.empty()) return require(definition.annotation);
        Annotation whole_object;
        whole_object.type = AnnotationType::region;
        whole_object.all = true;
        whole_object.faces.resize(mesh().number_of_faces());
        std::iota(whole_object.faces.begin(), whole_object.faces.end(), Index{0});
        return whole_object;
    }
    std::array<double, 3> direction_of(const MeasureDirection& direction) const {
        if (!direction.up) return direction.coordinates;
        if (set_ == nullptr || !set_->up) throw MissingMeasure{"the annotations have no upward direction"};
        return *set_->up;
    }

    /// The vertex at a place; throws MissingMeasure if there is none.
    Index vertex(const MeasurePlace& place) const {
        if (place.extreme) return extremes(mesh(), require(place.name), direction_of(*place.extreme))[1];
        std::string tag = place.name;
        std::size_t number = 0;
        const Annotation* annotation = find(tag);
        if (annotation == nullptr) {
            const std::size_t blank = tag.rfind(' ');
            const std::optional<int> last = blank == std::string::npos ? std::nullopt : parse_int(tag.substr(blank + 1));
            if (last && *last >= 1) annotation = find(tag.substr(0, blank)), number = static_cast<std::size_t>(*last - 1);
        }
        if (annotation == nullptr) throw MissingMeasure{fmt::format("nothing is called '{}'", place.name)};
        if (annotation->type != AnnotationType::point)
            throw MissingMeasure{fmt::format("'{}' is a {}, not a point", annotation->tag, to_string(annotation->type))};
        if (number >= annotation->points.size())
            throw MissingMeasure{fmt::format("'{}' has {} points", annotation->tag, annotation->points.size())};
        return annotation->points[number];
    }
    /// The position of a place: of a landmark if it names one, otherwise of a vertex.
    Point place(const MeasurePlace& pin) const {
        if (landmarks_ != nullptr && !pin.extreme && find(pin.name) == nullptr) {
            const Landmark* matching_landmark = nullptr;
            for (const Landmark& landmark : landmarks_->landmarks) {
                if (landmark.name != pin.name) continue;
                if (matching_landmark != nullptr) throw MissingMeasure{fmt::format("two landmarks are called '{}'", pin.name)};
                matching_landmark = &landmark;
            }
            if (matching_landmark != nullptr)
                return {matching_landmark->position[0], matching_landmark->position[1], matching_landmark->position[2]};
            if (set_ == nullptr) throw MissingMeasure{fmt::format("no landmark is called '{}'", pin.name)};
        }
        return mesh().point(Vertex(vertex(pin)));
    }

    MeasuredValue ruler(const MeasureDefinition& definition) const {
        double length = 0;
        for (std::size_t i = 1; i < definition.pins.size(); ++i) {
            const Vector step = place(definition.pins[i]) - place(definition.pins[i - 1]);
            length += std::hypot(step.x(), step.y(), step.z());
        }
        return {length, 1, ""};
    }
    MeasuredValue tape(const MeasureDefinition& definition) const {
        Measure measure;
        measure.tool = "tape";
        measure.exact = definition.exact;
        for (const MeasurePlace& pin : definition.pins) measure.points.push_back(vertex(pin));
        return {evaluate(mesh(), {}, measure), 1, ""};
    }
    MeasuredValue bounding(const MeasureDefinition& definition) const {
        const Annotation annotation = measured(definition);
        Measure measure;
        measure.tool = "bounding";
        measure.direction = direction_of(definition.direction);
        const auto pins = extremes(mesh(), annotation, *measure.direction);
        measure.points.assign(pins.begin(), pins.end());
        return {evaluate(mesh(), annotation, measure), 1, ""};
    }
    MeasuredValue descriptor(const MeasureDefinition& definition) const {
        const Annotation annotation = measured(definition);
        DescriptorSearch search(mesh());
        const std::optional<Quantity> quantity = search.find(annotation, definition.descriptor);
        if (!quantity)
            throw MissingMeasure{
                fmt::format("'{}' is not a descriptor of a {}", definition.descriptor, to_string(annotation.type))};
        if (static_cast<std::size_t>(definition.entry) > quantity->values.size())
            throw MissingMeasure{fmt::format("'{}' has {} numbers", definition.descriptor, quantity->values.size())};
        return {quantity->values[static_cast<std::size_t>(definition.entry - 1)], quantity->power, quantity->unit};
    }
    /// Sliced across the object's up direction, or across z if the annotations give none.
    MeasuredValue clay(const MeasureDefinition& definition) {
        if (!clay_) {
            const std::array<double, 3> up = set_ != nullptr && set_->up ? *set_->up : std::array<double, 3>{0, 0, 1};
            clay_ = clay_volume(mesh(), slice_frame(Point(0, 0, 0), Vector(up[0], up[1], up[2])));
        }
        const double value = definition.clay == "max" ? clay_->maximum : clay_->minimum;
        if (std::isnan(value))
            throw MissingMeasure{definition.clay == "max" || std::isnan(clay_->maximum)
                                     ? "no slice has a closed outline"
                                     : "no wall is found, so that there is no minimum"};
        return {value, 3, ""};
    }
    MeasuredValue attribute(const MeasureDefinition& definition) const {
        const Annotation& annotation = require(definition.annotation);
        const Attribute* matching_attribute = nullptr;
        for (const Attribute& attribute : annotation.attributes) {
            if (attribute.name != definition.attribute || attribute.note() != nullptr) continue;
            if (matching_attribute != nullptr)
                throw MissingMeasure{fmt::format("'{}' has two attributes '{}'", annotation.tag, definition.attribute)};
            matching_attribute = &attribute;
        }
        if (matching_attribute == nullptr)
            throw MissingMeasure{fmt::format("'{}' has no measure or descriptor '{}'", annotation.tag, definition.attribute)};
        if (const Measure* measure = matching_attribute->measure()) {
            if (measure->stale || !measure->value)
                throw MissingMeasure{
                    fmt::format("the value of '{}' is stale: run 'ostraka measure refresh'", definition.attribute)};
            return in_annotation_unit(*measure->value, measure->unit, true);
        }
        const Descriptor& descriptor = *matching_attribute->descriptor();
        if (descriptor.stale)
            throw MissingMeasure{fmt::format("the value of '{}' is stale: run 'ostraka measure refresh'", definition.attribute)};
        if (static_cast<std::size_t>(definition.entry) > descriptor.values.size())
            throw MissingMeasure{fmt::format("'{}' has {} numbers", definition.attribute, descriptor.values.size())};
        return in_annotation_unit(descriptor.values[static_cast<std::size_t>(definition.entry - 1)], descriptor.unit, false);
    }
    /// A value with its own unit, converted to the unit of the annotations if both are lengths.
    MeasuredValue in_annotation_unit(double value, const std::string& unit, bool length) const {
        const auto [base, power] = length_power(unit);
        const std::string own_unit = set_ == nullptr ? "" : set_->unit;
        if (unit.empty()) return {value, length ? 1 : 0, ""};
        if (power != 0 && base == own_unit) return {value, power, ""};
        if (power != 0 && !own_unit.empty()) {
            // Uses the conversion of the measure table, so that there is only one list of units.
            MeasureTable conversion;
            conversion.objects = {"a", "b", "c"};
            conversion.units = {base, own_unit, own_unit};
            conversion.measures = {{"value", power, ""}};
            conversion.values = Eigen::Vector3d(value, 1, 1);
            const UnifiedMeasures unified = unify_units(conversion);
            if (unified.comparable[0]) return {unified.table.values(0, 0), power, ""};
        }
        return {value, 0, unit};
    }

    const Mesh* mesh_;
    const AnnotationSet* set_;
    const LandmarkSet* landmarks_;
    const TagMatcher* words_;
    std::optional<ClayVolume> clay_;
};

ObjectMeasures measure_object(const Mesh* mesh, const AnnotationSet* set, const LandmarkSet* landmarks,
                              const MeasureDefinitions& definitions, const TagMatcher* words) {
    ObjectMeasures result;
    MeasureReader reader(mesh, set, landmarks, words);
    for (const MeasureDefinition& definition : definitions.measures) {
        std::optional<double> value;
        int power = 1;
        std::string unit, why;
        try {
            const MeasuredValue measured = reader.value_of(definition);
            if (!std::isfinite(measured.value)) throw MissingMeasure{"the value is not finite"};
            value = measured.value;
            power = measured.power;
            unit = measured.unit;
        } catch (const MissingMeasure& missing) {
            why = missing.why;
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::failure || error.kind() == ErrorKind::cancelled) throw;
            why = error.problem();
        }
        if (!value) result.notes.push_back(fmt::format("no '{}': {}", definition.name, why));
        result.values.push_back(value);
        result.powers.push_back(power);
        result.units.push_back(unit);
    }
    return result;
}

/// Whether landmarks are sufficient for all measures.
bool needs_only_landmarks(const LandmarkSet& landmarks, const MeasureDefinitions& definitions) {
    const auto is_landmark = [&](const MeasurePlace& place) {
        return !place.extreme && std::any_of(landmarks.landmarks.begin(), landmarks.landmarks.end(),
                                             [&](const Landmark& landmark) { return landmark.name == place.name; });
    };
    return std::all_of(definitions.measures.begin(), definitions.measures.end(), [&](const MeasureDefinition& definition) {
        return definition.tool == "ruler" && std::all_of(definition.pins.begin(), definition.pins.end(), is_landmark);
    });
}

}  // namespace

ObjectMeasures take_measures(const CollectionObject& object, const MeasureDefinitions& definitions, const TagMatcher* words) {
    std::optional<LandmarkSet> landmarks;
    if (!object.landmarks.empty()) landmarks = read_landmarks(object.landmarks, LandmarkFormat::mrk);
    std::optional<MeshFile> file;
    std::optional<AnnotationSet> set;
    if (!object.mesh.empty() && !(landmarks && needs_only_landmarks(*landmarks, definitions))) {
        file = read_mesh(object.mesh);
        if (!object.annotations.empty()) set = read_annotations(object.annotations, file->mesh);
    }
    ObjectMeasures result = measure_object(file ? &file->mesh : nullptr, set ? &*set : nullptr, landmarks ? &*landmarks : nullptr,
                                           definitions, words);
    if (file)
        for (std::string& note : manifold_notes(*file)) result.notes.push_back(std::move(note));
    result.unit = !object.unit.empty() ? object.unit : set && !set->unit.empty() ? set->unit : landmarks ? landmarks->unit : "";
    if (std::none_of(result.values.begin(), result.values.end(), [](const auto& value) { return value.has_value(); }))
        fail_input(object.name, "no measure could be taken: " + result.notes.front(),
                   "check that its annotations or landmarks exist and have the names used by the measures");
    return result;
}

ObjectMeasures take_measures(AnnotatedMeshView object, const MeasureDefinitions& definitions, const TagMatcher* words) {
    ObjectMeasures result = measure_object(&object.mesh, &object.annotations, nullptr, definitions, words);
    result.unit = object.annotations.unit;
    return result;
}

}  // namespace ostraka
