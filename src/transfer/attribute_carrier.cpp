#include "transfer/attribute_carrier.h"

namespace ostraka {

void AttributeCarrier::carry(const Annotation& from, Annotation& to) {
    for (const Attribute& attribute : from.attributes) {
        Attribute moved = attribute;
        // The file refers to the elements and the position of the old mesh.
        if (!moved.descriptor.file.empty()) moved.descriptor.stale = true;
        if (attribute.type == AttributeType::measure) {
            moved.measure.points.clear();
            moved.measure.locations.clear();
            moved.measure.repeats.clear();
            moved.measure.uncertainty.reset();
            bool complete = true;
            for (const Index v : attribute.measure.points) {
                const Correspondence& place = tracer_.place(v);
                if (place.vertex == no_index) {
                    complete = false;
                    continue;
                }
                moved.measure.points.push_back(place.vertex);
                // Face indices of a refined mesh are new: there, only the nearest vertex is stored.
                if (!refined_) moved.measure.locations.push_back(face_point(place.place.face, place.place.barycentric));
            }
            for (const auto& pins : attribute.measure.repeats) {  // a picking that loses a pin is dropped
                std::vector<Index> places;
                for (const Index v : pins)
                    if (const Index place = tracer_.place(v).vertex; place != no_index) places.push_back(place);
                if (complete && places.size() == pins.size()) moved.measure.repeats.push_back(std::move(places));
            }
            if (!complete) {
                to.note += (to.note.empty() ? "" : "; ") + ("measure '" + attribute.name + "' lost a pin");
                lost_pins_.emplace_back(from.id, attribute.id, attribute.measure.value);
                if (moved.measure.points.size() < 2) {
                    // A measure needs two pins: without them, the value is kept as a stale descriptor.
                    moved.type = AttributeType::descriptor;
                    if (attribute.measure.value) moved.descriptor.values = {*attribute.measure.value};
                    moved.descriptor.unit = attribute.measure.unit;
                    moved.measure = {};
                    if (!attribute.measure.value) continue;
                }
            }
        }
        to.attributes.push_back(std::move(moved));
    }
}

void AttributeCarrier::keep_old_values(AnnotationSet& set) const {
    for (const auto& [annotation, attribute, value] : lost_pins_) {
        Annotation* to = set.find(annotation);
        if (to == nullptr) continue;
        for (Attribute& moved : to->attributes) {
            if (moved.id != attribute) continue;
            if (moved.type == AttributeType::measure) {
                moved.measure.stale = true;
                moved.measure.value = value;
            } else {
                moved.descriptor.stale = true;
                moved.descriptor.values = {*value};
            }
        }
    }
}

}  // namespace ostraka
