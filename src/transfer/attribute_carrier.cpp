#include "transfer/attribute_carrier.h"

namespace ostraka {

void AttributeCarrier::carry(const Annotation& from, Annotation& to) {
    for (const Attribute& attribute : from.attributes) {
        Attribute moved = attribute;
        // The file refers to the elements and the position of the old mesh.
        if (Descriptor* descriptor = moved.descriptor(); descriptor != nullptr && !descriptor->file.empty())
            descriptor->stale = true;
        if (const Measure* measure = attribute.measure()) {
            const bool complete = carry_pins(*measure, *moved.measure());
            if (!complete) {
                to.note += (to.note.empty() ? "" : "; ") + ("measure '" + attribute.name + "' lost a pin");
                lost_pins_.emplace_back(from.id, attribute.id, measure->value);
                if (moved.measure()->points.size() < 2) {
                    // A measure needs two pins: without them, the value is kept as a stale descriptor.
                    if (!measure->value) continue;
                    auto& descriptor = moved.value.emplace<Descriptor>();
                    descriptor.values = {*measure->value};
                    descriptor.unit = measure->unit;
                }
            }
        }
        to.attributes.push_back(std::move(moved));
    }
}

bool AttributeCarrier::carry_pins(const Measure& measure, Measure& moved) const {
    moved.points.clear();
    moved.locations.clear();
    moved.repeats.clear();
    moved.uncertainty.reset();
    bool complete = true;
    for (const Index v : measure.points) {
        const Correspondence& place = tracer_.place(v);
        if (place.vertex == no_index) {
            complete = false;
            continue;
        }
        moved.points.push_back(place.vertex);
        // Face indices of a refined mesh are new: there, only the nearest vertex is stored.
        if (!refined_) moved.locations.push_back(face_point(place.place.face, place.place.barycentric));
    }
    for (const auto& pins : measure.repeats) {  // a picking that loses a pin is dropped
        std::vector<Index> places;
        for (const Index v : pins)
            if (const Index place = tracer_.place(v).vertex; place != no_index) places.push_back(place);
        if (complete && places.size() == pins.size()) moved.repeats.push_back(std::move(places));
    }
    return complete;
}

void AttributeCarrier::keep_old_values(AnnotationSet& set) const {
    for (const auto& [annotation, attribute, value] : lost_pins_) {
        Annotation* to = set.find(annotation);
        if (to == nullptr) continue;
        for (Attribute& moved : to->attributes) {
            if (moved.id != attribute) continue;
            if (Measure* measure = moved.measure()) {
                measure->stale = true;
                measure->value = value;
            } else if (Descriptor* descriptor = moved.descriptor()) {
                descriptor->stale = true;
                descriptor->values = {*value};
            }
        }
    }
}

}  // namespace ostraka
