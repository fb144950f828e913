#include "ostraka/annotation/annotation_file.h"
#include "ostraka/collection/measure_definitions.h"
#include "ostraka/core/error.h"
#include "ostraka/core/limits.h"
#include "ostraka/core/text.h"
#include "ostraka/interchange/landmarks.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/descriptors.h"
#include "ostraka/measure/measure.h"
#include "ostraka/slicing/clay.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ostraka {

namespace {

/// Reason why a measure cannot be taken on this object.
struct Missing {
    std::string why;
};

struct Taken {
    double value = 0;
    int power = 1;
    std::string unit;  ///< for values that are not a power of a length
};

/// "mm^2" gives "mm" and 2; a text that is not such a power gives power 0.
std::pair<std::string, int> length_power(const std::string& unit) {
    const std::size_t caret = unit.find('^');
    if (caret == std::string::npos) return {unit, 1};
    const std::optional<int> power = whole_of(unit.substr(caret + 1));
    return power && *power >= 1 && *power <= 3 ? std::pair(unit.substr(0, caret), *power) : std::pair(unit, 0);
}

/// The files of one object, read on demand.
class Taker {
public:
    Taker(const Mesh* mesh, const AnnotationSet* set, const LandmarkSet* landmarks, const TagWords* words)
        : mesh_(mesh), set_(set), landmarks_(landmarks), words_(words) {}

    Taken take(const MeasureDefinition& definition) {
        if (!definition.attribute.empty()) return attribute(definition);
        if (!definition.descriptor.empty()) return descriptor(definition);
        if (!definition.clay.empty()) return clay(definition);
        if (definition.tool == "bounding") return bounding(definition);
        return definition.tool == "ruler" ? ruler(definition) : tape(definition);
    }

private:
    const Mesh& mesh() const {
        if (mesh_ == nullptr) throw Missing{"there is no mesh"};
        return *mesh_;
    }
    const Annotation* find(const std::string& tag) const {
        if (set_ == nullptr) return nullptr;
        const Annotation* found = nullptr;
        for (const Annotation& annotation : set_->annotations) {
            if (annotation.tag != tag) continue;
            if (found != nullptr) throw Missing{"two annotations are called '" + tag + "'"};
            found = &annotation;
        }
        if (found != nullptr || words_ == nullptr) return found;
        const std::vector<std::size_t> meant = words_->find(*set_, tag);
        if (meant.size() > 1) throw Missing{"several annotations are meant by '" + tag + "'"};
        return meant.empty() ? nullptr : &set_->annotations[meant.front()];
    }
    const Annotation& require(const std::string& tag) const {
        if (set_ == nullptr) throw Missing{"there are no annotations"};
        const Annotation* found = find(tag);
        if (found == nullptr) throw Missing{"no annotation is called '" + tag + "'"};
        return *found;
    }
    /// The annotation to measure; the whole mesh if none is named.
    Annotation measured(const MeasureDefinition& definition) const {
        if (!definition.annotation.empty()) return require(definition.annotation);
        Annotation whole;
        whole.type = AnnotationType::region;
        whole.all = true;
        whole.faces.resize(mesh().number_of_faces());
        std::iota(whole.faces.begin(), whole.faces.end(), Index{0});
        return whole;
    }
    std::array<double, 3> along(const MeasureDirection& direction) const {
        if (!direction.up) return direction.coordinates;
        if (set_ == nullptr || !set_->up) throw Missing{"the annotations do not say which way is up"};
        return *set_->up;
    }

    /// The vertex at a place; throws Missing if there is none.
    Index vertex(const MeasurePlace& place) const {
        if (place.extreme) return extremes(mesh(), require(place.name), along(*place.extreme))[1];
        std::string tag = place.name;
        std::size_t number = 0;
        const Annotation* found = find(tag);
        if (found == nullptr) {
            const std::size_t blank = tag.rfind(' ');
            const std::optional<int> last = blank == std::string::npos ? std::nullopt : whole_of(tag.substr(blank + 1));
            if (last && *last >= 1) found = find(tag.substr(0, blank)), number = static_cast<std::size_t>(*last - 1);
        }
        if (found == nullptr) throw Missing{"nothing is called '" + place.name + "'"};
        if (found->type != AnnotationType::point)
            throw Missing{"'" + found->tag + "' is a " + to_string(found->type) + ", not a point"};
        if (number >= found->points.size())
            throw Missing{"'" + found->tag + "' has " + std::to_string(found->points.size()) + " points"};
        return found->points[number];
    }
    /// The position of a place: of a landmark if it names one, otherwise of a vertex.
    Point place(const MeasurePlace& wanted) const {
        if (landmarks_ != nullptr && !wanted.extreme && find(wanted.name) == nullptr) {
            const Landmark* found = nullptr;
            for (const Landmark& landmark : landmarks_->landmarks) {
                if (landmark.name != wanted.name) continue;
                if (found != nullptr) throw Missing{"two landmarks are called '" + wanted.name + "'"};
                found = &landmark;
            }
            if (found != nullptr) return {found->position[0], found->position[1], found->position[2]};
            if (set_ == nullptr) throw Missing{"no landmark is called '" + wanted.name + "'"};
        }
        return mesh().point(Vertex(vertex(wanted)));
    }

    Taken ruler(const MeasureDefinition& definition) const {
        double length = 0;
        for (std::size_t i = 1; i < definition.pins.size(); ++i) {
            const Vector step = place(definition.pins[i]) - place(definition.pins[i - 1]);
            length += std::hypot(step.x(), step.y(), step.z());
        }
        return {length, 1, ""};
    }
    Taken tape(const MeasureDefinition& definition) const {
        Measure measure;
        measure.tool = "tape";
        measure.exact = definition.exact;
        for (const MeasurePlace& pin : definition.pins) measure.points.push_back(vertex(pin));
        return {evaluate(mesh(), {}, measure), 1, ""};
    }
    Taken bounding(const MeasureDefinition& definition) const {
        const Annotation annotation = measured(definition);
        Measure measure;
        measure.tool = "bounding";
        measure.direction = along(definition.direction);
        const auto pins = extremes(mesh(), annotation, *measure.direction);
        measure.points.assign(pins.begin(), pins.end());
        return {evaluate(mesh(), annotation, measure), 1, ""};
    }
    Taken descriptor(const MeasureDefinition& definition) const {
        const Annotation annotation = measured(definition);
        DescriptorSearch search(mesh());
        const std::optional<Quantity> found = search.find(annotation, definition.descriptor);
        if (!found) throw Missing{"'" + definition.descriptor + "' is no descriptor of a " + to_string(annotation.type)};
        if (static_cast<std::size_t>(definition.entry) > found->values.size())
            throw Missing{"'" + definition.descriptor + "' has " + std::to_string(found->values.size()) + " numbers"};
        return {found->values[static_cast<std::size_t>(definition.entry - 1)], found->power, found->unit};
    }
    /// Sliced across the object's up direction, or across z if the annotations give none.
    Taken clay(const MeasureDefinition& definition) {
        if (!clay_) {
            const std::array<double, 3> up = set_ != nullptr && set_->up ? *set_->up : std::array<double, 3>{0, 0, 1};
            clay_ = clay_volume(mesh(), slice_frame(Point(0, 0, 0), Vector(up[0], up[1], up[2])));
        }
        const double value = definition.clay == "max" ? clay_->maximum : clay_->minimum;
        if (std::isnan(value))
            throw Missing{definition.clay == "max" || std::isnan(clay_->maximum) ? "no slice has a closed outline"
                                                                                 : "no wall is seen, so there is no least"};
        return {value, 3, ""};
    }
    Taken attribute(const MeasureDefinition& definition) const {
        const Annotation& annotation = require(definition.annotation);
        const Attribute* found = nullptr;
        for (const Attribute& attribute : annotation.attributes) {
            if (attribute.name != definition.attribute || attribute.type == AttributeType::semantic) continue;
            if (found != nullptr) throw Missing{"'" + annotation.tag + "' has two attributes '" + definition.attribute + "'"};
            found = &attribute;
        }
        if (found == nullptr)
            throw Missing{"'" + annotation.tag + "' has no measure or descriptor '" + definition.attribute + "'"};
        if (found->type == AttributeType::measure) {
            if (found->measure.stale || !found->measure.value)
                throw Missing{"the value of '" + definition.attribute + "' is stale: run 'ostraka measure refresh'"};
            return in_own_unit(*found->measure.value, found->measure.unit, true);
        }
        if (found->descriptor.stale)
            throw Missing{"the value of '" + definition.attribute + "' is stale: run 'ostraka measure refresh'"};
        if (static_cast<std::size_t>(definition.entry) > found->descriptor.values.size())
            throw Missing{"'" + definition.attribute + "' has " + std::to_string(found->descriptor.values.size()) + " numbers"};
        return in_own_unit(found->descriptor.values[static_cast<std::size_t>(definition.entry - 1)], found->descriptor.unit,
                           false);
    }
    /// A value with its own unit, converted to the unit of the annotations if both are lengths.
    Taken in_own_unit(double value, const std::string& unit, bool length) const {
        const auto [base, power] = length_power(unit);
        const std::string own = set_ == nullptr ? "" : set_->unit;
        if (unit.empty()) return {value, length ? 1 : 0, ""};
        if (power != 0 && base == own) return {value, power, ""};
        if (power != 0 && !own.empty()) {
            // Uses the conversion of the measure table, so that there is only one list of units.
            MeasureTable one;
            one.objects = {"a", "b", "c"};
            one.units = {base, own, own};
            one.measures = {{"value", power, ""}};
            one.values = Eigen::Vector3d(value, 1, 1);
            const UnifiedMeasures unified = unify_units(one);
            if (unified.comparable[0]) return {unified.table.values(0, 0), power, ""};
        }
        return {value, 0, unit};
    }

    const Mesh* mesh_;
    const AnnotationSet* set_;
    const LandmarkSet* landmarks_;
    const TagWords* words_;
    std::optional<ClayVolume> clay_;
};

ObjectMeasures take(const Mesh* mesh, const AnnotationSet* set, const LandmarkSet* landmarks,
                    const MeasureDefinitions& definitions, const TagWords* words) {
    ObjectMeasures result;
    Taker taker(mesh, set, landmarks, words);
    for (const MeasureDefinition& definition : definitions.list) {
        std::optional<double> value;
        int power = 1;
        std::string unit, why;
        try {
            const Taken taken = taker.take(definition);
            if (!std::isfinite(taken.value)) throw Missing{"the value is not finite"};
            value = taken.value;
            power = taken.power;
            unit = taken.unit;
        } catch (const Missing& missing) {
            why = missing.why;
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::failure || error.kind() == ErrorKind::cancelled) throw;
            why = error.problem();
        }
        if (!value) result.notes.push_back("no '" + definition.name + "': " + why);
        result.values.push_back(value);
        result.powers.push_back(power);
        result.units.push_back(unit);
    }
    return result;
}

/// Whether landmarks are sufficient for all measures.
bool by_landmarks(const LandmarkSet& landmarks, const MeasureDefinitions& definitions) {
    const auto known = [&](const MeasurePlace& place) {
        return !place.extreme && std::any_of(landmarks.landmarks.begin(), landmarks.landmarks.end(),
                                             [&](const Landmark& landmark) { return landmark.name == place.name; });
    };
    return std::all_of(definitions.list.begin(), definitions.list.end(), [&](const MeasureDefinition& definition) {
        return definition.tool == "ruler" && std::all_of(definition.pins.begin(), definition.pins.end(), known);
    });
}

}  // namespace

ObjectMeasures take_measures(const CollectionObject& object, const MeasureDefinitions& definitions, const TagWords* words) {
    std::optional<LandmarkSet> landmarks;
    if (!object.landmarks.empty()) landmarks = read_landmarks(object.landmarks, LandmarkFormat::mrk);
    std::optional<MeshFile> file;
    std::optional<AnnotationSet> set;
    if (!object.mesh.empty() && !(landmarks && by_landmarks(*landmarks, definitions))) {
        file = read_mesh(object.mesh);
        if (!object.annotations.empty()) set = read_annotations(object.annotations, file->mesh);
    }
    ObjectMeasures result =
        take(file ? &file->mesh : nullptr, set ? &*set : nullptr, landmarks ? &*landmarks : nullptr, definitions, words);
    result.unit = !object.unit.empty() ? object.unit : set && !set->unit.empty() ? set->unit : landmarks ? landmarks->unit : "";
    if (std::none_of(result.values.begin(), result.values.end(), [](const auto& value) { return value.has_value(); }))
        fail_input(object.name, "no measure can be taken: " + result.notes.front(),
                   "are its annotations or landmarks there, and named as the measures say?");
    return result;
}

ObjectMeasures take_measures(const Mesh& mesh, const AnnotationSet& set, const MeasureDefinitions& definitions,
                             const TagWords* words) {
    ObjectMeasures result = take(&mesh, &set, nullptr, definitions, words);
    result.unit = set.unit;
    return result;
}

}  // namespace ostraka
