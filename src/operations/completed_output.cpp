#include "operations/completed_output.h"

#include <algorithm>

namespace ostraka {

void write_completed(const FolderOutput& folder, const std::string& name, const CompletedObject& object,
                     const std::vector<std::vector<Colour>>& fragment_colours) {
    const bool coloured = std::any_of(fragment_colours.begin(), fragment_colours.end(),
                                      [](const std::vector<Colour>& colours) { return !colours.empty(); });
    MeshExtras extras;
    NamedValues fragment{"fragment", {}}, distance{"distance", {}}, confidence{"confidence", {}};
    for (std::size_t f = 0; f < object.origin.size(); ++f) {
        const Origin origin = object.origin[f];
        extras.face_labels.push_back(static_cast<std::int32_t>(origin));
        Colour colour = origin == Origin::observed     ? Colour{186, 120, 82, 255}
                        : origin == Origin::hypothesis ? Colour{200, 205, 210, 255}
                        : coloured                     ? Colour{165, 165, 165, 255}
                                                       : Colour{214, 180, 120, 255};
        if (const int from = object.fragment[f]; from >= 0 && static_cast<std::size_t>(from) < fragment_colours.size()) {
            const std::vector<Colour>& own = fragment_colours[static_cast<std::size_t>(from)];
            if (object.fragment_face[f] < own.size()) colour = own[object.fragment_face[f]];
        }
        extras.face_colours.push_back(colour);
        fragment.values.push_back(static_cast<double>(object.fragment[f] + 1));
        distance.values.push_back(static_cast<double>(static_cast<float>(object.distance[f])));
        confidence.values.push_back(static_cast<double>(static_cast<float>(object.confidence[f])));
    }
    extras.face_values = {std::move(fragment), std::move(distance), std::move(confidence)};
    folder.write(name, object.mesh, extras);
}

}  // namespace ostraka
