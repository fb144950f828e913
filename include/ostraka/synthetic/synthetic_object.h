// Objects composed of blended implicit solids, with known semantic parts at every point of the surface.
#pragma once

#include "ostraka/mesh/mesh.h"
#include "ostraka/synthetic/solid.h"

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// A solid of an object, blended with the previously added solids.
struct Member {
    SolidPointer solid;  ///< the solid
    double blend = 0;    ///< width of the smooth transition of the union or difference, mm; 0: a sharp crease
    /// True: the solid is subtracted instead of added; the resulting surface gets the part of the nearest other member.
    bool carves = false;
    /// An interval of the solid's parameter that forms a part.
    struct Stretch {
        double until;  ///< parameter of the solid at which the interval ends
        int part;      ///< index of the part
    };
    std::vector<Stretch> stretches;  ///< intervals in increasing order; the last interval extends to the end
};

/// A flower in low relief: where the distance from the axis through `centre` along `axis` is below the petal curve radius (1 +
/// petal_depth cos(petals angle)), the surface is raised by up to `height`.
struct Relief {
    Eigen::Vector3d centre, axis;
    double radius, height, petal_depth;  ///< base radius of the petal curve, height of the relief, and depth of the petals
    int petals, part;                    ///< number of petals, and index of the flower's part
};

/// Changes the part `from` to the part `to` where the function `side` is negative.
struct Cut {
    int from, to;                                        ///< indices of the parts
    std::function<double(const Eigen::Vector3d&)> side;  ///< negative where the part `from` becomes the part `to`
};

/// An object composed of implicit solids, with its ground truth.
class SyntheticObject {
public:
    std::string name, object_class, description;  ///< name of the object, name of its class, and a sentence about it
    std::string unit = "mm";                      ///< unit of lengths
    std::vector<std::string> parts;  ///< names of the parts; the index is the label; each part is one connected patch
    std::vector<std::array<std::uint8_t, 3>> part_colours;  ///< red, green, blue of each part
    int genus = 0;                                          ///< number of handles (holes) of the surface
    std::size_t minimum_vertices = 300;                     ///< min number of vertices that represents the shape
    /// Thickness of the thinnest wall or gap, mm. The lattice must be finer, otherwise the mesh has a hole in the wall or a
    /// bridge across the gap.
    double thinnest = std::numeric_limits<double>::infinity();
    std::optional<double> exact_area, exact_volume;  ///< area and volume, if a formula is known
    std::vector<Member> members;                     ///< solids in the order in which they are blended
    std::vector<Relief> reliefs;                     ///< flowers in low relief
    std::vector<Cut> cuts;                           ///< cuts that divide a part into two parts

    /// Implicit function of the object, negative inside, and its gradient. Away from the surface, the value minus `slack` is a
    /// lower bound of the distance from the surface; close to the surface the function is continuously differentiable.
    [[nodiscard]] Sample sample(const Eigen::Vector3d& p) const;
    /// Value of the implicit function at p.
    [[nodiscard]] double value(const Point& p) const { return sample({p.x(), p.y(), p.z()}).value; }
    [[nodiscard]] Vector gradient(const Point& p) const;  ///< gradient of the implicit function at p

    /// Max displacement of the surface by reliefs.
    [[nodiscard]] double slack() const;

    /// Label of the part at a point on or near the surface: the part of the member with the smallest value at the point, changed
    /// by reliefs and cuts. The boundaries between parts are piecewise smooth curves.
    [[nodiscard]] int part(const Eigen::Vector3d& p) const;
    [[nodiscard]] int part(const Point& p) const { return part(Eigen::Vector3d(p.x(), p.y(), p.z())); }

    /// Projects the point `p`, which must be near the surface, onto the surface along the gradient.
    [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& p) const;
    [[nodiscard]] Point project(const Point& p) const;

    /// Bounding box of the surface.
    [[nodiscard]] const Eigen::AlignedBox3d& box() const { return box_; }

    /// Computes the bounding boxes; must be called once, after all members were added.
    void finish();

private:
    /// Function of one member, and its gradient.
    [[nodiscard]] Sample member_sample(std::size_t member, const Eigen::Vector3d& p) const;
    std::vector<Eigen::AlignedBox3d> boxes_;  ///< bounding box of each member
    Eigen::AlignedBox3d box_;
    double margin_ = 0;  ///< blend width by which the members' boxes are enlarged
};

/// Names of all synthetic objects, in alphabetical order.
std::vector<std::string> synthetic_object_names();
/// The synthetic object with this name. Throws Error (usage) for an unknown name, suggesting the most similar name.
const SyntheticObject& synthetic_object(const std::string& name);

}  // namespace ostraka
