// Differences between two sets of annotations on one mesh, and three-way merge.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"

namespace ostraka {

/// One difference. `field` is "tag", "colour", "type", "geometry", "note", "attribute N" (N its id) or "order" of an
/// annotation; "class", "unit", "up" or "order" of the set; empty if a whole annotation was added or removed.
struct Difference {
    enum class Kind { added, removed, changed };
    Kind kind = Kind::changed;
    std::optional<int> id;  ///< id of the annotation; nullopt for the set itself
    std::string tag;        ///< tag of the annotation in the second set, or in the first set if it was removed
    std::string field;
    std::string before, after;                    ///< values as text; lists are truncated
    std::size_t only_before = 0, only_after = 0;  ///< geometry: number of faces, edges or points in only one of the sets
};

/// The differences from `a` to `b`: those of the set first, then annotations in ascending order of id. Empty if and only if the
/// files of both sets are equal except for the provenance. `differences(b, a)` is the same with the sides exchanged. Linear,
/// except for sorting.
std::vector<Difference> differences(const AnnotationSet& a, const AnnotationSet& b);

/// A field that both sides changed in different ways.
struct Conflict {
    std::optional<int> id;
    std::string tag, field;
    std::string base, ours, theirs;  ///< values as text
};

struct MergeOptions {
    enum class Side { none, ours, theirs } prefer = Side::none;
    bool merge_faces = false;
    bool renumber = false;

    void describe(OptionList& visit);
};

struct MergedAnnotations {
    AnnotationSet set;                ///< contains our version of each conflict, unless theirs is preferred
    std::vector<Conflict> conflicts;  ///< includes conflicts resolved by a preference
    std::vector<std::string> notes;   ///< new ids, regions merged face by face
    [[nodiscard]] bool settled(const MergeOptions& options) const {
        return conflicts.empty() || options.prefer != MergeOptions::Side::none;
    }
};

/// Three-way merge by id, field by field: a change of only one side is accepted, as are equal changes of both sides; different
/// changes are conflicts. Each attribute is a separate field, identified by id. Removing an annotation that the other side
/// changed is a conflict. merge(base, a, base) = a and merge(base, base, b) = b, including the order.
MergedAnnotations merge_annotations(const AnnotationSet& base, const AnnotationSet& ours, const AnnotationSet& theirs,
                                    const MergeOptions& options = {});

}  // namespace ostraka
