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

/// A solid of an object, blended with the previous solids.
struct Member {
    SolidPointer solid;
    double blend = 0;     ///< width of the smooth union (or of the smooth difference), mm; 0 gives a crease
    bool carves = false;  ///< subtracted instead of added; the resulting walls belong to the nearest other member
    struct Stretch {
        double until;  ///< parameter of the solid at which the part ends
        int part;
    };
    std::vector<Stretch> stretches;  ///< in increasing order; the last extends to the end
};

/// A flower in low relief: where the distance from `axis` through `centre` is below the petal curve radius (1 + petal_depth
/// cos(petals angle)), the surface is raised by up to `height`.
struct Relief {
    Eigen::Vector3d centre, axis;
    double radius, height, petal_depth;
    int petals, part;
};

/// Part `from` becomes part `to` where `side` is negative.
struct Cut {
    int from, to;
    std::function<double(const Eigen::Vector3d&)> side;
};

class SyntheticObject {
public:
    std::string name, object_class, description;
    std::string unit = "mm";
    std::vector<std::string> parts;  ///< the index is the label; each part is one connected patch
    std::vector<std::array<std::uint8_t, 3>> part_colours;
    int genus = 0;
    std::size_t minimum_vertices = 300;  ///< minimum number of vertices that represents the shape
    double thinnest =
        std::numeric_limits<double>::infinity();     ///< thinnest wall or gap, mm: a coarser lattice would tear or bridge it
    std::optional<double> exact_area, exact_volume;  ///< if a formula is known
    std::vector<Member> members;
    std::vector<Relief> reliefs;
    std::vector<Cut> cuts;

    /// Implicit function, negative inside, and its gradient. Away from the surface the value is a lower bound of the
    /// distance up to `slack`; close to it, the function is continuously differentiable.
    [[nodiscard]] Sample sample(const Eigen::Vector3d& p) const;
    [[nodiscard]] double value(const Point& p) const { return sample({p.x(), p.y(), p.z()}).value; }
    [[nodiscard]] Vector gradient(const Point& p) const;

    /// Maximum displacement of the surface by reliefs.
    [[nodiscard]] double slack() const;

    /// Label of the part at a point on or near the surface: of the member with the smallest value there and its stretch, then
    /// of reliefs and cuts. The boundaries are piecewise smooth curves.
    [[nodiscard]] int part(const Eigen::Vector3d& p) const;
    [[nodiscard]] int part(const Point& p) const { return part(Eigen::Vector3d(p.x(), p.y(), p.z())); }

    /// Projects `p`, which must be near the surface, onto the surface along the gradient.
    [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& p) const;
    [[nodiscard]] Point project(const Point& p) const;

    /// Bounding box of the surface.
    [[nodiscard]] const Eigen::AlignedBox3d& box() const { return box_; }

    /// Stores the bounding boxes. Call it once, after adding all members.
    void finish();

private:
    [[nodiscard]] Sample member_sample(std::size_t member, const Eigen::Vector3d& p) const;
    std::vector<Eigen::AlignedBox3d> boxes_;
    Eigen::AlignedBox3d box_;
    double margin_ = 0;
};

/// All names, in alphabetical order.
std::vector<std::string> synthetic_object_names();
/// The object with this name. Throws Error (usage) for an unknown name, suggesting the nearest known name.
const SyntheticObject& synthetic_object(const std::string& name);

}  // namespace ostraka
