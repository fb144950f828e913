// The axis of revolution of an object as a catalogue needs it. This is the only place where the catalogue depends on an
// estimator of axes.
#pragma once

#include "ostraka/axis/revolution_axis.h"
#include "ostraka/mesh/mesh.h"

#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// Axis of revolution with the uncertainty of diameters, or the reason why there is none. Lengths are in the mesh's unit.
struct CatalogueAxis {
    bool found = false;          ///< true if there is an axis
    std::string reason;          ///< why there is no axis; empty if there is one
    Point point{0, 0, 0};        ///< a point of the axis
    Vector direction{0, 0, 1};   ///< unit vector along the axis; its sign has no meaning
    double direction_error = 0;  ///< standard error of the direction, degrees
    /// Bounds of the 95 % interval of a diameter, relative to the diameter measured about the axis: the true diameter lies
    /// between diameter + `diameter_low` and diameter + `diameter_high`.
    double diameter_low = 0, diameter_high = 0;
    /// Diameters of a sherd with their intervals, in the mesh's unit (`revolution_axis`); empty: none.
    std::vector<DiameterEstimate> diameters;
    std::optional<Vector> rim_direction;  ///< unit vector along the axis towards the rim of a sherd; empty: no rim

    /// True if the interval is that of the posterior of a sherd (`revolution_axis`).
    [[nodiscard]] bool is_sherd() const { return !diameters.empty(); }
};

/// The axis of the surface of revolution fitted to all faces except `fractures` (`revolution_axis`). A sherd has the 95 %
/// interval of its posterior, a whole vessel 1.96 standard errors. There is no axis if all faces are fractures. Throws Error
/// (input) for a mesh without faces with area.
CatalogueAxis catalogue_axis(const Mesh& mesh, const std::vector<Index>& fractures = {});

}  // namespace ostraka
