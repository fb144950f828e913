#include "ostraka/collection/proportion_graph.h"

#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"
#include "ostraka/measure/measure.h"

#include <fmt/core.h>

namespace ostraka {

namespace {

/// Why a ratio is not proposed.
struct RejectedProposal {
    std::string why;
};

struct TemplateMeasure {
    int annotation;  ///< id of the annotation
    std::string tag, attribute;
};

Annotation& annotation_of(AnnotationSet& set, const MeasureDefinition& definition) {
    if (definition.annotation.empty())
        throw RejectedProposal{fmt::format("'{}' does not say which annotation it measures", definition.name)};
    Annotation* matching_annotation = nullptr;
    for (Annotation& annotation : set.annotations) {
        if (annotation.tag != definition.annotation) continue;
        if (matching_annotation != nullptr)
            throw RejectedProposal{fmt::format("the template has two annotations '{}'", definition.annotation)};
        matching_annotation = &annotation;
    }
    if (matching_annotation == nullptr)
        throw RejectedProposal{fmt::format("the template has no annotation '{}'", definition.annotation)};
    return *matching_annotation;
}

const Attribute* find_measure(const Annotation& annotation, const std::string& name) {
    for (const Attribute& attribute : annotation.attributes)
        if (attribute.name == name && attribute.measure() != nullptr) return &attribute;
    return nullptr;
}

Index pin_of(AnnotatedMeshView object, const MeasurePlace& place) {
    for (const Annotation& annotation : object.annotations.annotations) {
        if (annotation.tag != place.name) continue;
        if (place.extreme) {
            if (place.extreme->up && !object.annotations.up) throw RejectedProposal{"the template has no upward direction"};
            return extremes(object.mesh, annotation, place.extreme->up ? *object.annotations.up : place.extreme->coordinates)[1];
        }
        if (annotation.type == AnnotationType::point && !annotation.points.empty()) return annotation.points.front();
    }
    throw RejectedProposal{fmt::format("the template has no point '{}'", place.name)};
}

/// The measure of the template's annotation; taken and stored if the annotation does not have it yet.
TemplateMeasure measure_on_template(const Mesh& mesh, AnnotationSet& set, const MeasureDefinition& definition) {
    Annotation& annotation = annotation_of(set, definition);
    if (!definition.descriptor.empty())
        throw RejectedProposal{fmt::format("'{}' is a descriptor, which no constraint can preserve", definition.name)};
    const std::string name = definition.attribute.empty() ? definition.name : definition.attribute;
    if (find_measure(annotation, name) == nullptr) {
        if (!definition.attribute.empty())
            throw RejectedProposal{fmt::format("annotation '{}' of the template has no measure '{}'", annotation.tag, name)};
        Measure measure;
        measure.tool = definition.tool;
        measure.exact = definition.exact;
        measure.unit = set.unit;
        if (definition.tool == "bounding") {
            if (definition.direction.up && !set.up) throw RejectedProposal{"the template has no upward direction"};
            measure.direction = definition.direction.up ? *set.up : definition.direction.coordinates;
            const auto pins = extremes(mesh, annotation, *measure.direction);
            measure.points.assign(pins.begin(), pins.end());
        } else {
            for (const MeasurePlace& place : definition.pins) measure.points.push_back(pin_of({mesh, set}, place));
        }
        measure.value = evaluate(mesh, annotation, measure);
        add_measure(annotation, name, std::move(measure));
    }
    return {annotation.id, annotation.tag, name};
}

/// The parameters of the constraint as the text of a JSON object.
std::string parameters(const TemplateMeasure& part, const TemplateMeasure& reference, double low, double high, bool hard) {
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

Proposals propose_proportions(AnnotatedMeshView template_object, RelationGraph existing, const MeasureDefinitions& definitions,
                              const ProportionStudy& study, const ProposalOptions& options) {
    check_options(options, "proposals");
    Proposals result;
    result.graph = std::move(existing);
    result.set = template_object.annotations;
    for (const RatioRow& ratio : study.ratios) {
        if (ratio.fixedness != Fixedness::fixed && !(options.stable && ratio.fixedness == Fixedness::stable)) continue;
        try {
            const auto taken = [&](std::size_t measure) {
                return measure_on_template(template_object.mesh, result.set, definitions.measures.at(measure));
            };
            const TemplateMeasure part = taken(ratio.denominator), reference = taken(ratio.numerator);
            if (part.annotation == reference.annotation)
                throw RejectedProposal{
                    fmt::format("both measures belong to '{}', but a constraint relates two annotations", part.tag)};
            Relationship relationship;
            relationship.id = free_id(result.graph);
            relationship.type = "proportion";
            relationship.annotations = {part.annotation, reference.annotation};
            relationship.is_constraint = true;
            relationship.weight = options.weight;
            relationship.constraint = parameters(part, reference, 1 / ratio.high, 1 / ratio.low, options.hard);
            relationship.origin = "stated";
            if (const RelationType* type = find_relation_type(relationship.type)) relationship.directed = type->directed;
            if (find_equivalent(result.graph, relationship) != nullptr) throw RejectedProposal{"the graph already contains it"};
            check_relationship(relationship, result.set, "proposal");
            result.graph.relationships.push_back(std::move(relationship));
            ++result.proposed;
        } catch (const RejectedProposal& rejected) {
            result.notes.push_back(fmt::format("not proposed: {}: {}", ratio.row.name, rejected.why));
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::failure || error.kind() == ErrorKind::cancelled) throw;
            result.notes.push_back(fmt::format("not proposed: {}: {}", ratio.row.name, error.problem()));
        }
    }
    return result;
}

void ProposalOptions::declare_options(OptionList& list) {
    list("stable", stable, "propose constraints for stable ratios as well as for fixed ratios");
    list("weight", weight, "weight of the proposed constraints", Range{0, 1e12});
    list("hard", hard, "make the proposed constraints hard (satisfied exactly)");
}

}  // namespace ostraka
