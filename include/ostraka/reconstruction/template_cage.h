// The cage of a template, for fits with few degrees of freedom.
#pragma once

#include "ostraka/coords/coordinates.h"
#include "ostraka/template_package/template.h"

#include <cstdint>

namespace ostraka {

/// A cage around a template and the coordinates of the template's vertices in it.
struct TemplateCage {
    Mesh cage;
    Coordinates coordinates;
};

/// Mean value coordinates in this cage. Throws Error (input) that names vertex, face and remedy for a cage that does not
/// contain the template or is invalid (`check_cage`).
TemplateCage template_in_cage(const Mesh& mesh, Mesh cage);

/// The template's first cage, with the template's coordinates that belong to it and have no normal term; if there are none,
/// mean value coordinates are computed. Nothing for a template without a cage. Throws Error as template_in_cage.
std::optional<TemplateCage> cage_of(const Template& package);

/// A cage generated around the template (`make_cage`), with mean value coordinates. Throws Error as make_cage.
TemplateCage generated_cage(const Mesh& mesh, std::uint64_t vertices = 200);

}  // namespace ostraka
