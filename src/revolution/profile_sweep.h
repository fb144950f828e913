// A profile swept about an axis, as a mesh.
#pragma once

#include "axis_frame.h"

namespace ostraka {

/// Rings of vertices around the axis, each with as many as its size asks for, sewn together.
class ProfileSweep {
public:
    /// Heights are above `lowest`; the triangles' edges are about as long as `edge`.
    ProfileSweep(const AxisFrame& frame, double lowest, double edge) : frame_(frame), lowest_(lowest), edge_(edge) {}

    /// At this radius and height; one vertex where the radius is 0.
    void ring(const Eigen::Vector2d& at);
    /// Triangles between two rings.
    void sew(std::size_t a, std::size_t b);
    [[nodiscard]] TriangleSoup soup() const;

    struct Ring {
        std::vector<Vertex> vertices;
        bool pole = false;
    };
    std::vector<Ring> rings;

private:
    void add(Vertex a, Vertex b, Vertex c) { triangles_.push_back({Index(a), Index(b), Index(c)}); }
    const AxisFrame& frame_;
    double lowest_, edge_;
    Mesh mesh_;  ///< vertices only
    std::vector<std::array<Index, 3>> triangles_;
};

}  // namespace ostraka
