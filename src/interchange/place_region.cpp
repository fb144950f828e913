#include "place_region.h"

#include "text.h"

#include "ostraka/annotation/annotation.h"

#include <cmath>

namespace ostraka::interchange {

std::vector<Index> region_of(Placer& placer, const std::vector<RegionPart>& parts, const std::string& where,
                             std::vector<std::string>& remarks) {
    const Mesh& mesh = placer.mesh();
    std::vector<bool> selected(mesh.number_of_faces(), false);
    for (const RegionPart& part : parts) {
        std::vector<bool> flags;
        if (part.outlines.empty()) {
            flags = placer.component(placer.nearest(part.inside).face);
        } else {
            std::vector<std::vector<Index>> vertex_paths;
            for (const auto& outline : part.outlines) {
                std::vector<Index> vertex_path = placer.vertex_path(outline, true, where);
                if (vertex_path.size() > 3) vertex_paths.push_back(std::move(vertex_path));
            }
            flags = placer.fill(vertex_paths, part.area);
        }
        double area = 0;
        for (std::size_t f = 0; f < flags.size(); ++f)
            if (flags[f]) {
                area += face_area(mesh, Face(static_cast<Index>(f)));
                selected[f] = true;
            }
        if (area == 0) remarks.emplace_back("a part of the region shrank to nothing on this mesh");
        else if (std::abs(area - part.area) > part.area / 20)
            remarks.push_back("a part's area of " + digits(part.area) + " became " + digits(area) + " on this mesh");
    }
    return flagged(selected);
}

}  // namespace ostraka::interchange
