// Interactive deformation: vertices of a cage are dragged while constraints hold, at frame rate (doc/deformation.md, "While a
// handle moves").
#pragma once

#include "ostraka/semantic/deform.h"

#include <memory>

namespace ostraka {

/// Solver for one drag of cage vertices: the constraints of a graph, linearised over the vertices of the cage at the start of
/// the drag. After the drag, `deform` with the same steps gives the exact result.
class LiveDeformation {
public:
    /// `edit`: the steps before the drag. `handles`: the cage vertices to be dragged. Throws the errors of deform; Error
    /// (usage) without a cage, or for a handle that is not a vertex of the cage.
    LiveDeformation(const HandleSpace& space, const RelationGraph& graph, const Edit& edit, std::vector<Index> handles,
                    const DeformOptions& options = {}, const RelationOptions& tolerances = {});
    ~LiveDeformation();

    /// Positions of the cage's vertices at the start of the drag.
    [[nodiscard]] const std::vector<Point>& cage() const;
    /// True if there is a constraint to solve for.
    [[nodiscard]] bool has_constraints() const;

    /// Positions of the cage's vertices after the handles were dragged to `places` (one per handle), computed by a few
    /// iterations that start from the result of the last call. Time: quadratic in the number of cage vertices, plus linear in
    /// the number of constrained mesh vertices.
    const std::vector<Point>& follow(const std::vector<Point>& places);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
