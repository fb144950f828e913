#include "operations/completed_output.h"

namespace ostraka {

void write_completed(const FolderOutput& folder, const std::string& name, const CompletedObject& object) {
    MeshExtras extras;
    NamedValues fragment{"fragment", {}}, distance{"distance", {}}, confidence{"confidence", {}};
    for (std::size_t f = 0; f < object.origin.size(); ++f) {
        const Origin origin = object.origin[f];
        extras.face_labels.push_back(static_cast<std::int32_t>(origin));
        extras.face_colours.push_back(origin == Origin::observed       ? Colour{186, 120, 82, 255}
                                      : origin == Origin::interpolated ? Colour{214, 180, 120, 255}
                                                                       : Colour{200, 205, 210, 255});
        fragment.values.push_back(static_cast<double>(object.fragment[f] + 1));
        distance.values.push_back(static_cast<double>(static_cast<float>(object.distance[f])));
        confidence.values.push_back(static_cast<double>(static_cast<float>(object.confidence[f])));
    }
    extras.face_values = {std::move(fragment), std::move(distance), std::move(confidence)};
    folder.write(name, object.mesh, extras);
}

}  // namespace ostraka
