#include "ostraka/reconstruction/template_cage.h"

#include "ostraka/cage/cage.h"
#include "ostraka/coords/coordinate_file.h"
#include "ostraka/core/error.h"

namespace ostraka {

TemplateCage template_in_cage(const Mesh& mesh, Mesh cage) {
    const CageCheck check = check_cage(cage, mesh);
    if (!check.valid()) {
        for (const Finding& finding : findings(check, ""))
            if (finding.defect)
                fail_input("cage" + (finding.where.empty() ? std::string() : ", " + finding.where), finding.text,
                           "give a sound cage around the template: 'cage check' tells all, 'cage make' makes one");
    }
    Coordinates coordinates = compute_coordinates("mean-value", cage, mesh);
    return {std::move(cage), std::move(coordinates)};
}

std::optional<TemplateCage> cage_of(const Template& known) {
    const Mesh& mesh = known.mesh->mesh;
    for (const std::optional<Mesh>& cage : known.cages) {
        if (!cage) continue;
        for (const PackagedFile* part : known.file.of("coordinates")) {
            try {
                Coordinates coordinates = read_coordinates(part->file, mesh, *cage);
                if (!coordinates.has_normals()) return TemplateCage{*cage, std::move(coordinates)};
            } catch (const Error& error) {  // they belong to another cage: new ones are computed
                if (error.kind() == ErrorKind::cancelled) throw;
                continue;
            }
        }
        return template_in_cage(mesh, *cage);
    }
    return std::nullopt;
}

TemplateCage made_cage(const Mesh& mesh, std::uint64_t vertices) {
    CageOptions options;
    options.vertices = vertices;
    return template_in_cage(mesh, make_cage(mesh, options).cage);
}

}  // namespace ostraka
