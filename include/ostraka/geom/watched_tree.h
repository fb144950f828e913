// Cancellable construction of CGAL's AABB trees.
#pragma once

#include "ostraka/core/progress.h"

namespace ostraka {

/// Builds a CGAL::AABB_tree as tree.build() does, but checks for cancellation at every node. If the work is cancelled, throws
/// Error (cancelled), and the tree must not be used afterwards.
template <class Tree>
void build_watched(Tree& tree) {
    const auto boxes = tree.traits().compute_bbox_object();
    const auto halves = tree.traits().split_primitives_object();
    CancelCheck check;
    tree.custom_build(boxes, [&](auto first, auto beyond, const auto& box) {
        if (beyond - first > 1024) check_cancelled();
        check();
        halves(first, beyond, box);
    });
}

}  // namespace ostraka
