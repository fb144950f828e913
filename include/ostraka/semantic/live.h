// Interactive deformation: handles of a cage are dragged while constraints hold, at frame rate (doc/deformation.md, "While a
// handle moves").
#pragma once

#include "ostraka/semantic/deform.h"

#include <memory>

namespace ostraka {

/// The constraints of a graph over the handles of a cage, set up once for a drag. They are evaluated on the shape at the start
/// of the drag; `deform` with the same steps gives the exact result once the handles are at rest.
class LiveDeformation {
public:
    /// `edit`: the steps so far. `handles`: the vertices of the cage to be dragged. Throws as deform; Error (usage) without a
    /// cage, or for a handle that is not a vertex of the cage.
    LiveDeformation(const HandleSpace& space, const RelationGraph& graph, const Edit& edit, std::vector<Index> handles,
                    const DeformOptions& options = {}, const RelationOptions& tolerances = {});
    ~LiveDeformation();

    /// The vertices of the cage at the start of the drag.
    [[nodiscard]] const std::vector<Point>& cage() const;
    /// True if there is a constraint to solve for.
    [[nodiscard]] bool has_constraints() const;

    /// The cage after the handles were dragged to these positions (one per handle), by a few iterations from the result of the
    /// last call. Quadratic in the number of cage vertices if constraints involve few points, and linear in the constrained
    /// vertices.
    const std::vector<Point>& follow(const std::vector<Point>& places);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
