// Building the library's trees of boxes so that it can be cancelled.
#pragma once

#include "ostraka/core/progress.h"

namespace ostraka {

/// Builds a CGAL::AABB_tree as tree.build() does, and asks the watch of the thread at every node: throws Error (cancelled). The
/// tree is of no use then.
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
