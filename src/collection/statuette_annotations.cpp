#include "ostraka/collection/statuette_annotations.h"

#include "ostraka/annotation/label_file.h"
#include "ostraka/measure/measure.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

/// Adds the measure; does nothing if a landmark is missing.
void add_measure(const Statuette& statuette, Annotation& object, const std::string& name, const std::string& tool,
                 const std::vector<std::string>& landmarks) {
    Measure measure;
    measure.tool = tool;
    measure.unit = "mm";
    for (const std::string& landmark_name : landmarks) {
        const auto landmark =
            std::find_if(statuette.landmarks.begin(), statuette.landmarks.end(),
                         [&](const StatuetteLandmark& statuette_landmark) { return statuette_landmark.name == landmark_name; });
        if (landmark == statuette.landmarks.end()) return;
        measure.points.push_back(landmark->vertex);
        measure.locations.push_back(landmark->place);
    }
    measure.exact = tool == "tape";
    measure.value = evaluate(statuette.mesh, object, measure);
    add_measure(object, name, std::move(measure));
}

}  // namespace

AnnotationSet annotate_statuette(const Statuette& statuette) {
    std::map<std::int32_t, std::string> names;
    for (std::size_t part = 0; part < statuette.parts.size(); ++part)
        names[static_cast<std::int32_t>(part)] = statuette.parts[part];
    AnnotationSet set = regions_from_labels(statuette.mesh, statuette.face_labels, names);
    set.object_class = "votive statuette";
    set.unit = "mm";
    set.up = {0, 0, 1};
    for (Annotation& region : set.annotations) {
        const auto& [red, green, blue] = statuette.part_colours[static_cast<std::size_t>(region.id)];
        region.colour = {red, green, blue};
    }
    Annotation& object = ensure_root(set, statuette.mesh);
    // The height is measured between the lowest and the topmost vertex; arms never reach above the head.
    Measure height;
    height.tool = "bounding";
    height.direction = {0, 0, 1};
    height.unit = "mm";
    for (const Index pin : extremes(statuette.mesh, object, *height.direction)) height.points.push_back(pin);
    height.value = evaluate(statuette.mesh, object, height);
    add_measure(object, "total height", std::move(height));
    add_measure(statuette, object, "base diameter", "ruler", {"base right", "base left"});
    for (const std::string side : {"right", "left"}) {
        std::vector<std::string> tape_pins{"arm joint " + side};
        for (int i = 1; i <= 5; ++i) tape_pins.push_back(fmt::format("arm outside {} {}", i, side));
        tape_pins.push_back("hand end " + side);
        add_measure(statuette, object, "arm length " + side, "tape", tape_pins);
    }
    add_measure(statuette, object, "head height", "ruler", {"head joint", "top of the head"});
    for (const StatuetteLandmark& landmark : statuette.landmarks) {
        Annotation point;
        point.id = free_id(set);
        point.tag = landmark.name;
        point.colour = {30, 30, 30};
        point.type = AnnotationType::point;
        point.points = {landmark.vertex};
        set.annotations.push_back(std::move(point));
    }
    return set;
}

}  // namespace ostraka
