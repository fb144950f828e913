// Helper functions for describing synthetic objects.
#pragma once

#include "ostraka/core/angles.h"
#include "ostraka/synthetic/synthetic_object.h"

#include <memory>
#include <string>

namespace ostraka::shapes {

using Colour3 = std::array<std::uint8_t, 3>;

/// Rotation matrix for an angle in degrees around an axis.
inline Eigen::Matrix3d turned(double degrees, const Vector3d& axis) {
    return Eigen::AngleAxisd(degrees * pi / 180, axis.normalized()).toRotationMatrix();
}

/// Creates an object without parts; `thinnest`: thinnest wall or gap, mm.
inline std::unique_ptr<SyntheticObject> start_object(const std::string& name, const std::string& object_class,
                                                     const std::string& description, int genus, std::size_t minimum_vertices,
                                                     double thinnest) {
    auto object = std::make_unique<SyntheticObject>();
    object->name = name;
    object->object_class = object_class;
    object->description = description;
    object->genus = genus;
    object->minimum_vertices = minimum_vertices;
    object->thinnest = thinnest;
    return object;
}

/// Adds a part to an object and returns its label.
inline int add_part(SyntheticObject& object, const std::string& name, const Colour3& colour) {
    object.parts.push_back(name);
    object.part_colours.push_back(colour);
    return static_cast<int>(object.parts.size()) - 1;
}

/// Adds a solid that forms one part; `blend`: width of the smooth union, mm.
inline void add_member(SyntheticObject& object, SolidPointer solid, int part, double blend) {
    object.members.push_back({std::move(solid), blend, false, {{std::numeric_limits<double>::infinity(), part}}});
}

/// Adds a solid that forms several parts; each pair in `until` is the index of a profile point or bead, and the part that ends
/// there.
template <class Items>
void add_divided_member(SyntheticObject& object, SolidPointer solid, const Items& items, double blend,
                        const std::vector<std::pair<double, int>>& until) {
    const auto lengths = chord_lengths(items);
    Member member{std::move(solid), blend, false, {}};
    for (const auto& [item, part] : until) {
        const auto index = static_cast<std::size_t>(item);
        const double share = item - static_cast<double>(index);
        const double length = index + 1 < lengths.size() ? (1 - share) * lengths[index] + share * lengths[index + 1]
                                                         : std::numeric_limits<double>::infinity();
        member.stretches.push_back({length, part});
    }
    object.members.push_back(std::move(member));
}

/// Subtracts a solid from an object; the resulting walls become `part` (below 0: the part that was cut).
inline void carve(SyntheticObject& object, SolidPointer solid, int part, double blend) {
    Member member{std::move(solid), blend, true, {}};
    if (part >= 0) member.stretches = {{std::numeric_limits<double>::infinity(), part}};
    object.members.push_back(std::move(member));
}

using ObjectPointer = std::unique_ptr<const SyntheticObject>;
/// Completes an object after all members were added.
inline ObjectPointer finished(std::unique_ptr<SyntheticObject> object) {
    object->finish();
    return object;
}
ObjectPointer make_teapot();
ObjectPointer make_vase();
ObjectPointer make_statuette();
ObjectPointer make_chair();
ObjectPointer make_hand();
ObjectPointer make_elephant();
ObjectPointer make_bird();
ObjectPointer make_sphere();
ObjectPointer make_torus_object();
ObjectPointer make_box_object();
ObjectPointer make_capsule();
ObjectPointer make_cylinder_object();

}  // namespace ostraka::shapes
