// A cage whose handles are dragged while constraints hold, at the rate of pictures (doc/deformation.md, "While a handle moves").
#pragma once

#include "ostraka/semantic/deform.h"

#include <memory>

namespace ostraka {

/// The constraints of a graph over the handles of a cage, set up once for a drag. What they ask is taken from the shape at its
/// beginning; `deform` with the same steps gives the exact answer once the handles rest.
class LiveDeformation {
public:
    /// `edit`: the steps so far. `handles`: the vertices of the cage that will be dragged. Throws as deform; Error (usage) where
    /// there is no cage, or a handle is none of its vertices.
    LiveDeformation(const HandleSpace& space, const RelationGraph& graph, const JsonValue& edit, std::vector<Index> handles,
                    const DeformOptions& options = {}, const RelationOptions& tolerances = {});
    ~LiveDeformation();

    /// The vertices of the cage at the beginning.
    [[nodiscard]] const std::vector<Point>& cage() const;
    /// Whether there is a constraint to solve for.
    [[nodiscard]] bool has_constraints() const;

    /// The cage when the handles are dragged to these places, one for each, from where the last call left it: a few iterations.
    /// O(handles of the cage squared) where no constraint reaches far, and linear in the constrained vertices.
    const std::vector<Point>& follow(const std::vector<Point>& places);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ostraka
