#include "ostraka/collection/proportion_graph.h"

#include "ostraka/core/error.h"
#include "ostraka/core/json_build.h"
#include "ostraka/measure/measure.h"

namespace ostraka {

namespace {

/// Why a ratio is not proposed.
struct Refused {
    std::string why;
};

struct Carried {
    int annotation;  ///< id of the annotation
    std::string tag, attribute;
};

Annotation& annotation_of(AnnotationSet& set, const MeasureDefinition& definition) {
    if (definition.annotation.empty()) throw Refused{"'" + definition.name + "' does not say which annotation it measures"};
    Annotation* found = nullptr;
    for (Annotation& annotation : set.annotations) {
        if (annotation.tag != definition.annotation) continue;
        if (found != nullptr) throw Refused{"the template has two annotations '" + definition.annotation + "'"};
        found = &annotation;
    }
    if (found == nullptr) throw Refused{"the template has no annotation '" + definition.annotation + "'"};
    return *found;
}

const Attribute* find_measure(const Annotation& annotation, const std::string& name) {
    for (const Attribute& attribute : annotation.attributes)
        if (attribute.name == name && attribute.type == AttributeType::measure) return &attribute;
    return nullptr;
}

Index pin_of(const Mesh& mesh, const AnnotationSet& set, const MeasurePlace& place) {
    for (const Annotation& annotation : set.annotations) {
        if (annotation.tag != place.name) continue;
        if (place.extreme) {
            if (place.extreme->up && !set.up) throw Refused{"the template does not say which way is up"};
            return extremes(mesh, annotation, place.extreme->up ? *set.up : place.extreme->coordinates)[1];
        }
        if (annotation.type == AnnotationType::point && !annotation.points.empty()) return annotation.points.front();
    }
    throw Refused{"the template has no point '" + place.name + "'"};
}

/// The measure of the template's annotation; taken and stored if the annotation does not have it yet.
Carried carry(const Mesh& mesh, AnnotationSet& set, const MeasureDefinition& definition) {
    Annotation& annotation = annotation_of(set, definition);
    if (!definition.descriptor.empty()) throw Refused{"'" + definition.name + "' is a descriptor, which no constraint keeps"};
    const std::string name = definition.attribute.empty() ? definition.name : definition.attribute;
    if (find_measure(annotation, name) == nullptr) {
        if (!definition.attribute.empty()) throw Refused{"the template's '" + annotation.tag + "' has no measure '" + name + "'"};
        Measure measure;
        measure.tool = definition.tool;
        measure.exact = definition.exact;
        measure.unit = set.unit;
        if (definition.tool == "bounding") {
            if (definition.direction.up && !set.up) throw Refused{"the template does not say which way is up"};
            measure.direction = definition.direction.up ? *set.up : definition.direction.coordinates;
            const auto pins = extremes(mesh, annotation, *measure.direction);
            measure.points.assign(pins.begin(), pins.end());
        } else {
            for (const MeasurePlace& place : definition.pins) measure.points.push_back(pin_of(mesh, set, place));
        }
        measure.value = evaluate(mesh, annotation, measure);
        add_measure(annotation, name, std::move(measure));
    }
    return {annotation.id, annotation.tag, name};
}

/// The parameters of the constraint as the text of a JSON object.
std::string parameters(const Carried& part, const Carried& reference, double low, double high, bool hard) {
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_members(document, allocator, "measure1", part.attribute, "measure2", reference.attribute, "minValue", low, "maxValue",
                high);
    if (hard) add_member(document, "hard", JsonValue(true), allocator);
    std::string text = to_text(document);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
}

}  // namespace

Proposals propose_proportions(const Mesh& mesh, const AnnotationSet& set, RelationGraph existing,
                              const MeasureDefinitions& definitions, const ProportionStudy& study,
                              const ProposalOptions& options) {
    check_options(options, "proposals");
    Proposals result;
    result.graph = std::move(existing);
    result.set = set;
    for (const RatioRow& ratio : study.ratios) {
        if (ratio.fixedness != Fixedness::fixed && !(options.stable && ratio.fixedness == Fixedness::stable)) continue;
        try {
            const Carried part = carry(mesh, result.set, definitions.list.at(ratio.denominator)),
                          reference = carry(mesh, result.set, definitions.list.at(ratio.numerator));
            if (part.annotation == reference.annotation)
                throw Refused{"both measures are of '" + part.tag + "': a constraint is between two annotations"};
            Relationship relationship;
            relationship.id = free_id(result.graph);
            relationship.type = "proportion";
            relationship.annotations = {part.annotation, reference.annotation};
            relationship.is_constraint = true;
            relationship.weight = options.weight;
            relationship.constraint = parameters(part, reference, 1 / ratio.high, 1 / ratio.low, options.hard);
            relationship.origin = "stated";
            if (const RelationType* type = find_relation_type(relationship.type)) relationship.directed = type->directed;
            if (find_twin(result.graph, relationship) != nullptr) throw Refused{"the graph has it already"};
            check_relationship(relationship, result.set, "proposal");
            result.graph.relationships.push_back(std::move(relationship));
            ++result.proposed;
        } catch (const Refused& refused) {
            result.notes.push_back("not proposed: " + ratio.row.name + ": " + refused.why);
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::failure || error.kind() == ErrorKind::cancelled) throw;
            result.notes.push_back("not proposed: " + ratio.row.name + ": " + error.problem());
        }
    }
    return result;
}

void ProposalOptions::describe(OptionList& visit) {
    visit("stable", stable, "propose ratios that are stable as well, not only fixed ones");
    visit("weight", weight, "weight of the proposed constraints", Range{0, 1e12});
    visit("hard", hard, "propose hard constraints");
}

}  // namespace ostraka
