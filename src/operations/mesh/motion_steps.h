// The steps of a motion, given by options: matrix, unit, axes, scale, mirror, rotation, centre, translation.
#pragma once

#include "operations/operations.h"

#include "ostraka/geom/rigid_fit.h"

namespace ostraka {

/// A motion of an object, and the units of length before and after it.
struct MeshMotion {
    Motion motion;
    std::string unit_before, unit_after;  ///< empty: unknown
    std::vector<std::string> notes;       ///< remarks on the steps
};

/// Options that give the steps of a motion. The steps are carried out in the order of the options, whatever their order on the
/// command line: matrix, unit, axes, scale, mirror, rotation, centre, translation.
class MotionSteps {
public:
    /// Declares the options.
    void declare(Parameters& p);
    /// Throws Error (usage) if no step is given, if options contradict each other, or if a value cannot be read.
    void check() const;
    /// The motion of an object. `object_name`: name of its file, by which its pose is found in an assembly; `set`: its
    /// annotations, for the unit and the upward direction; null: none. Throws Error (input) if the matrix file is not a motion,
    /// or if the annotations are in another unit.
    [[nodiscard]] MeshMotion motion(const TriangleSoup& soup, const std::string& object_name, const AnnotationSet* set) const;

private:
    /// Starts with the matrix, and the units that its file states.
    void add_matrix(MeshMotion& result, const std::string& object_name) const;
    void add_unit(MeshMotion& result, const std::string& object_name, const AnnotationSet* set) const;
    /// Scale, mirror and rotation, about the place that --about names.
    void add_turn(MeshMotion& result, const TriangleSoup& soup) const;
    void add_centre(MeshMotion& result, const TriangleSoup& soup, const AnnotationSet* set) const;
    [[nodiscard]] Eigen::Vector3d upward(const Motion& motion, const AnnotationSet* set) const;

    FileInput matrix_;
    bool inverse_ = false;
    std::optional<std::string> from_unit_, to_unit_, centre_;
    std::string axes_, mirror_, rotate_, quaternion_, about_ = "origin", translate_;
    std::optional<double> scale_;
    DirectionOption up_;
};

}  // namespace ostraka
