// A template's cage, whose vertices are the unknowns of fits with few degrees of freedom.
#pragma once

#include "ostraka/coords/coordinates.h"
#include "ostraka/template_package/template.h"

#include <cstdint>

namespace ostraka {

/// A cage around a template and the coordinates of the template's vertices in it.
struct TemplateCage {
    Mesh cage;                ///< mesh of the cage
    Coordinates coordinates;  ///< coordinates of the template's vertices in the cage
};

/// Computes the mean value coordinates of a template's vertices in the given cage. Throws Error (input) that names vertex, face
/// and remedy for a cage that does not contain the template or is invalid (`check_cage`).
TemplateCage template_in_cage(const Mesh& mesh, Mesh cage);

/// The first cage of a template, with the coordinates stored for this cage if they have no normal term; otherwise mean value
/// coordinates are computed. Returns nothing for a template without a cage. Throws the same errors as template_in_cage.
std::optional<TemplateCage> cage_of(const Template& package);

/// Generates a cage around the template (`make_cage`) with about this number of vertices, and mean value coordinates. Throws
/// the same errors as make_cage.
TemplateCage generated_cage(const Mesh& mesh, std::uint64_t vertices = 200);

}  // namespace ostraka
