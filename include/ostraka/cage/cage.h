// Cages: closed coarse meshes around an object, whose vertices steer its deformation (thesis, section 4.1.3 and 6.1.1;
// doc/cages.md).
#pragma once

#include "ostraka/coords/coordinates.h"
#include "ostraka/core/finding.h"
#include "ostraka/core/mesh.h"
#include "ostraka/core/options.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct CageOptions {
    std::uint64_t vertices = 200;  ///< wanted number of vertices, a cage of several levels has it on the finest
    double alpha = 0;        ///< openings narrower than this share of the diagonal are closed; 0: chosen and doubled at need
    double offset = 0.0167;  ///< distance of the wrap from the mesh, as a share of the diagonal
    enum class Genus { follow, fill } genus = Genus::follow;  ///< handles and holes through the object

    void describe(OptionList& visit);
};

struct MirrorPlane {
    Point point{0, 0, 0};
    Vector normal{1, 0, 0};
};

/// How many times more vertices than elsewhere a place of the surface wants; positive.
using CageDensity = std::function<double(const Point&)>;

struct CageResult {
    Mesh cage;             ///< closed, oriented outwards, without self-intersections, strictly around the mesh
    bool reached = false;  ///< it has the wanted number of vertices, or with a mirror plane one or two fewer
    double alpha = 0;      ///< share of the diagonal that the wrap was made with
    std::size_t wrap_vertices = 0;
};

/// Wraps the mesh (Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez 2022) and collapses edges of the wrap (cost:
/// Garland and Heckbert 1997) as long as no triangle meets the mesh or another triangle and no part of the mesh is left outside:
/// every collapse is checked exactly before it is made, so that the cage encloses the mesh at each moment. Where the wanted
/// number is not reached a coarser wrap is tried. With a mirror plane one half is made, around the mesh and its image, and
/// mirrored. The mesh need not be closed; vertices that no face has are left out. Throws Error (input) for a mesh without extent
/// or without a face with an area, and for one so far from the origin that its coordinates are too coarse for the offset; (usage)
/// for bad options and a plane without a direction.
CageResult make_cage(const Mesh& mesh, const CageOptions& options = {}, const CageDensity& density = {},
                     const std::optional<MirrorPlane>& mirror = {});

/// The image of a closed mesh in a plane, oriented outward again, vertices and faces in their order.
Mesh mirror_image(const Mesh& mesh, const MirrorPlane& plane);

/// Cages of `levels` numbers of vertices, sorted from fine to coarse: the first around the mesh, each next around the one before.
std::vector<CageResult> make_nested_cages(const Mesh& mesh, std::vector<std::uint64_t> levels, const CageOptions& options = {},
                                          const CageDensity& density = {}, const std::optional<MirrorPlane>& mirror = {});

/// A vertex of the mesh that is not strictly inside.
struct OutsideVertex {
    Index vertex = no_index;
    double distance = 0;    ///< to the cage; 0: on it
    Index face = no_index;  ///< the nearest face of the cage
};

struct CageCheck {
    bool closed = false;                     ///< no border; otherwise nothing below but the components is known
    bool flat = false;                       ///< no face has an area; nothing below but the components and those faces is known
    bool outward = false;                    ///< faces are counter-clockwise seen from outside
    std::size_t components = 0, nested = 0;  ///< nested: cages within the outermost (coords/nested.h)
    long genus = 0;                          ///< of all components together
    std::size_t degenerate = 0;              ///< faces without area
    std::vector<std::pair<Index, Index>> intersections;  ///< pairs of faces of the cage, the first few thousands
    std::vector<OutsideVertex> outside;                  ///< by vertex
    std::size_t touching = 0;                            ///< how many of these are on the cage
    std::vector<Index> crossing;  ///< faces of the mesh that the cage crosses though their vertices are inside; the first few
    double clearance = 0;         ///< least distance from a vertex of the mesh to the cage, 0 unless it encloses

    [[nodiscard]] bool encloses() const { return closed && !flat && outside.empty() && crossing.empty(); }
    [[nodiscard]] bool valid() const { return encloses() && outward && intersections.empty() && degenerate == 0; }
};

/// Every property that a cage needs, exact for the coordinates as given. Of cages within cages the outermost has to enclose the
/// mesh; each is judged by itself otherwise, and they may cross each other. Vertices of the mesh that no face has count as well.
CageCheck check_cage(const Mesh& cage, const Mesh& mesh);

/// The check in words: what is wrong, where, and what to do about it; lengths in `unit` ("" if unknown).
std::vector<Finding> findings(const CageCheck& check, const std::string& unit);

/// Largest sum of the absolute values of a point's weights: how many times as far as the cage's vertices it may move.
double amplification(const Coordinates& coordinates);
/// What is still fit for deformation: in cages that enclose their object it is below 1.5.
inline constexpr double max_amplification = 3;

/// Why a mesh should not be deformed through the cage by these coordinates, in words: the cage is not sound (`CageCheck::valid`)
/// or the weights are large (`max_amplification`). Empty where nothing speaks against it.
std::vector<std::string> unfit_for_deformation(const CageCheck& check, const Coordinates& coordinates);

}  // namespace ostraka
