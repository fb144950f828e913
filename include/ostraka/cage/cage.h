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

/// Options of `make_cage`.
struct CageOptions {
    std::uint64_t vertices = 200;  ///< target number of cage vertices; for nested cages: of the finest cage
    /// Openings narrower than twice this fraction of the mesh's diagonal are closed; 0: automatic, doubled when needed.
    double alpha = 0;
    double offset = 0.0167;  ///< distance of the wrap from the mesh, as a fraction of the mesh's diagonal
    /// follow: the cage keeps the handles of the mesh; fill: the cage has no handles
    enum class Genus { follow, fill } genus = Genus::follow;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Plane of symmetry of a cage.
struct MirrorPlane {
    Point point{0, 0, 0};    ///< a point of the plane
    Vector normal{1, 0, 0};  ///< normal of the plane, of any length
};

/// Requested density of cage vertices at a point of the surface, relative to other points; positive.
using CageDensity = std::function<double(const Point&)>;

/// A cage made by `make_cage`.
struct CageResult {
    Mesh cage;  ///< closed, oriented outwards, without self-intersections, strictly around the mesh
    /// True if the cage has the target number of vertices (with a mirror plane: or one or two fewer).
    bool reached = false;
    double alpha = 0;               ///< alpha that the wrap was made with, as a fraction of the mesh's diagonal
    std::size_t wrap_vertices = 0;  ///< number of vertices of the wrap before edge collapses
};

/// Wraps the mesh (Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez 2022) and collapses edges of the wrap (cost: Garland
/// and Heckbert 1997). A collapse is made only if no triangle then intersects the mesh or another triangle and no part of the
/// mesh is left outside. The conditions for a collapse are checked exactly before every collapse, so that the cage always
/// encloses the mesh. If the target number is not reached, a coarser wrap is tried. With a mirror plane, one half is built around
/// the union of the mesh and its mirror image, and then mirrored. The mesh need not be closed; isolated vertices are ignored.
/// Throws Error (input) for a mesh without extent or without a face of positive area, and for a mesh so far from the origin that
/// the precision of its coordinates is too coarse for the offset; Error (usage) for invalid options and a plane without a
/// direction.
CageResult make_cage(const Mesh& mesh, const CageOptions& options = {}, const CageDensity& density = {},
                     const std::optional<MirrorPlane>& mirror = {});

/// The mirror image of a closed mesh in a plane, oriented outwards again; vertices and faces keep their order.
Mesh mirror_image(const Mesh& mesh, const MirrorPlane& plane);

/// Nested cages with the numbers of vertices in `levels`, sorted from fine to coarse: the first cage encloses the mesh, and each
/// other cage encloses the cage before it.
std::vector<CageResult> make_nested_cages(const Mesh& mesh, std::vector<std::uint64_t> levels, const CageOptions& options = {},
                                          const CageDensity& density = {}, const std::optional<MirrorPlane>& mirror = {});

/// A vertex of the mesh that is not strictly inside the cage.
struct OutsideVertex {
    Index vertex = no_index;  ///< index of the vertex
    double distance = 0;      ///< distance of the vertex from the cage; 0 if the vertex is on the cage
    Index face = no_index;    ///< the face of the cage closest to the vertex
};

/// Properties of a cage around a mesh.
struct CageCheck {
    bool closed = false;  ///< true: the cage has no border edges; if false, only `components` is known besides
    /// True: no face has positive area; then only `components` and `degenerate` are known besides.
    bool flat = false;
    bool outward = false;  ///< true: faces are counter-clockwise when seen from outside
    /// Number of connected components; number of cages nested inside the outermost cage (coords/nested.h).
    std::size_t components = 0, nested = 0;
    long genus = 0;                                      ///< genus, summed over all components
    std::size_t degenerate = 0;                          ///< number of cage faces without area
    std::vector<std::pair<Index, Index>> intersections;  ///< pairs of intersecting faces of the cage, up to a few thousand
    std::vector<OutsideVertex> outside;                  ///< mesh vertices that are not strictly inside the cage, sorted by index
    std::size_t touching = 0;                            ///< number of the `outside` vertices that lie on the cage
    /// Faces of the mesh that the cage crosses although all their vertices are inside; only the first few are listed.
    std::vector<Index> crossing;
    double clearance = 0;  ///< smallest distance from a vertex of the mesh to the cage; 0 unless the cage encloses the
                           ///< mesh

    [[nodiscard]] bool encloses() const { return closed && !flat && outside.empty() && crossing.empty(); }
    [[nodiscard]] bool valid() const { return encloses() && outward && intersections.empty() && degenerate == 0; }
};

/// Checks every property that a cage needs, in exact arithmetic on the given coordinates. The outermost of nested cages must
/// enclose the mesh; the other properties are checked for each cage separately, and the cages may intersect each other. Isolated
/// vertices of the mesh are included.
CageCheck check_cage(const Mesh& cage, const Mesh& mesh);

/// The defects and remarks of a check as text, each with its location and remedy. `unit`: unit of length ("" if unknown).
std::vector<Finding> findings(const CageCheck& check, const std::string& unit);

/// Largest sum, over all points, of the absolute values of a point's weights: bounds the displacement of a point relative to the
/// largest displacement of a cage vertex.
double amplification(const Coordinates& coordinates);
/// Largest `amplification` with which meshes are deformed; cages that enclose their object have an amplification below 1.5.
inline constexpr double max_amplification = 3;

/// Reasons against deforming the mesh through the cage with these coordinates, as text: the cage is invalid (`CageCheck::valid`)
/// or the weights are large (`max_amplification`). The list is empty if there are no reasons.
std::vector<std::string> reasons_against_deformation(const CageCheck& check, const Coordinates& coordinates);

}  // namespace ostraka
