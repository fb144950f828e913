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
                fail_input(finding.where.empty() ? "cage" : "cage, " + finding.where, finding.text,
                           "give a valid cage around the template: 'cage check' lists all defects, 'cage make' generates one");
    }
    Coordinates coordinates = compute_coordinates("mean-value", cage, mesh);
    return {std::move(cage), std::move(coordinates)};
}

std::optional<TemplateCage> cage_of(const Template& package) {
    const Mesh& mesh = package.mesh->mesh;
    for (const std::optional<Mesh>& cage : package.cages) {
        if (!cage) continue;
        for (const PackagedFile* part : package.file.of("coordinates")) {
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

TemplateCage generated_cage(const Mesh& mesh, std::uint64_t vertices) {
    CageOptions options;
    options.vertices = vertices;
    return template_in_cage(mesh, make_cage(mesh, options).cage);
}

}  // namespace ostraka
