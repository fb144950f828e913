// Cages: closed coarse meshes around an object, whose vertices control its deformation (thesis, sections 4.1.3 and 6.1.1;
// doc/cages.md).
#pragma once

#include "ostraka/coords/coordinates.h"
#include "ostraka/core/finding.h"
#include "ostraka/core/options.h"
#include "ostraka/mesh/mesh.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct CageOptions {
    std::uint64_t vertices = 200;  ///< target number of vertices; for nested cages that of the finest
    double alpha = 0;              ///< openings narrower than this share of the diagonal are closed; 0: automatic, doubled when
                                   ///< needed
    double offset = 0.0167;        ///< distance of the wrap from the mesh, as a share of the diagonal
    enum class Genus { follow, fill } genus = Genus::follow;  ///< whether handles and holes are filled

    void describe(OptionList& visit);
};

struct MirrorPlane {
    Point point{0, 0, 0};
    Vector normal{1, 0, 0};
};

/// Requested relative vertex density at a point of the surface; positive.
using CageDensity = std::function<double(const Point&)>;

struct CageResult {
    Mesh cage;             ///< closed, oriented outwards, without self-intersections, strictly around the mesh
    bool reached = false;  ///< true if it has the target number of vertices, or with a mirror plane one or two fewer
    double alpha = 0;      ///< alpha of the wrap, as a share of the diagonal
    std::size_t wrap_vertices = 0;
};

/// Wraps the mesh (Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez 2022) and collapses edges of the wrap (cost: Garland
/// and Heckbert 1997). A collapse is made only if no triangle then intersects the mesh or another triangle and no part of the
/// mesh is left outside. This is checked exactly before every collapse, so that the cage always encloses the mesh. If the
/// target number is not reached, a coarser wrap is tried. With a mirror plane one half is built, around the mesh and its image,
/// and mirrored. The mesh need not be closed; isolated vertices are ignored. Throws Error (input) for a mesh without extent or
/// without a face of positive area, and for one so far from the origin that its coordinates are too coarse for the offset;
/// Error (usage) for invalid options and a plane without a direction.
CageResult make_cage(const Mesh& mesh, const CageOptions& options = {}, const CageDensity& density = {},
                     const std::optional<MirrorPlane>& mirror = {});

/// The mirror image of a closed mesh in a plane, oriented outwards again; vertices and faces keep their order.
Mesh mirror_image(const Mesh& mesh, const MirrorPlane& plane);

/// Nested cages with the numbers of vertices in `levels`, sorted from fine to coarse: the first around the mesh, each other
/// around the one before.
std::vector<CageResult> make_nested_cages(const Mesh& mesh, std::vector<std::uint64_t> levels, const CageOptions& options = {},
                                          const CageDensity& density = {}, const std::optional<MirrorPlane>& mirror = {});

/// A vertex of the mesh that is not strictly inside the cage.
struct OutsideVertex {
    Index vertex = no_index;
    double distance = 0;    ///< distance to the cage; 0 if the vertex is on it
    Index face = no_index;  ///< the nearest face of the cage
};

struct CageCheck {
    bool closed = false;                     ///< no border; if false, only `components` is known besides
    bool flat = false;                       ///< no face has positive area; if true, only `components` and `degenerate` are
                                             ///< known besides
    bool outward = false;                    ///< faces are counter-clockwise when seen from outside
    std::size_t components = 0, nested = 0;  ///< number of components; number of cages nested in the outermost
                                             ///< (coords/nested.h)
    long genus = 0;                          ///< sum over all components
    std::size_t degenerate = 0;              ///< faces without area
    std::vector<std::pair<Index, Index>> intersections;  ///< pairs of intersecting faces of the cage, up to a few thousand
    std::vector<OutsideVertex> outside;                  ///< sorted by vertex
    std::size_t touching = 0;                            ///< number of those vertices that are on the cage
    std::vector<Index> crossing;  ///< faces of the mesh that the cage crosses although their vertices are inside; the first few
    double clearance = 0;         ///< smallest distance from a vertex of the mesh to the cage; 0 unless the cage encloses the
                                  ///< mesh

    [[nodiscard]] bool encloses() const { return closed && !flat && outside.empty() && crossing.empty(); }
    [[nodiscard]] bool valid() const { return encloses() && outward && intersections.empty() && degenerate == 0; }
};

/// Checks every property that a cage needs, exactly for the given coordinates. Of nested cages the outermost must enclose the
/// mesh; the other properties are checked for each cage separately, and the cages may intersect each other. Isolated vertices
/// of the mesh are included.
CageCheck check_cage(const Mesh& cage, const Mesh& mesh);

/// The findings of a check as text: defect, location and remedy. `unit`: unit of length ("" if unknown).
std::vector<Finding> findings(const CageCheck& check, const std::string& unit);

/// Largest sum of the absolute values of a point's weights: bounds the displacement of a point relative to the largest
/// displacement of a cage vertex.
double amplification(const Coordinates& coordinates);
/// Limit of `amplification` for deformation; for cages that enclose their object it is below 1.5.
inline constexpr double max_amplification = 3;

/// Reasons against deforming the mesh through the cage with these coordinates, as text: the cage is invalid
/// (`CageCheck::valid`) or the weights are large (`max_amplification`). Empty if there are none.
std::vector<std::string> reasons_against_deformation(const CageCheck& check, const Coordinates& coordinates);

}  // namespace ostraka
