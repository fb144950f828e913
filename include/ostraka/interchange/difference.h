// Differences between two sets of annotations on one mesh, and three-way merge.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"

namespace ostraka {

/// One difference between two sets of annotations.
struct Difference {
    enum class Kind { added, removed, changed };
    Kind kind = Kind::changed;
    std::optional<int> id;  ///< id of the annotation; none if the set itself differs
    std::string tag;        ///< tag of the annotation in the second set, or in the first set if it was removed
    /// Field of the annotation ("tag", "colour", "type", "geometry", "note", "attribute ID", "order") or of the set ("class",
    /// "unit", "up", "order"); empty: a whole annotation.
    std::string field;
    /// Value of the field in the first and in the second set, as text; lists are truncated.
    std::string before, after;
    /// For "geometry": number of faces, edges or points that only the first, or only the second, annotation has.
    std::size_t only_before = 0, only_after = 0;
};

/// The differences from `a` to `b`: first differences of the set itself, then of annotations in ascending order of id. The list
/// is empty if and only if the files of both sets are equal except for the provenance. `differences(b, a)` gives the same list
/// with the sides exchanged. Time: linear, except for sorting.
std::vector<Difference> differences(const AnnotationSet& a, const AnnotationSet& b);

/// A field that both sides of a merge changed in different ways.
struct Conflict {
    std::optional<int> id;           ///< id of the annotation; none if the field belongs to the set itself
    std::string tag, field;          ///< tag of the annotation; name of the field (Difference::field)
    std::string base, ours, theirs;  ///< value of the field in the base, in our set and in their set, as text
};

/// Options of `merge_annotations`.
struct MergeOptions {
    enum class Side { none, ours, theirs } prefer = Side::none;  ///< whose change is kept in a conflict
    bool merge_faces = false;  ///< true: merge regions that both sides changed face by face, without a conflict
    /// True: if both sides added an annotation under one id, theirs gets a new id, without a conflict.
    bool renumber = false;

    void list_options(OptionList& list);  ///< adds every member to a list of options
};

/// Result of `merge_annotations`.
struct MergedAnnotations {
    AnnotationSet set;                ///< the merged set; contains our version of each conflict, unless `prefer` is theirs
    std::vector<Conflict> conflicts;  ///< all conflicts, including conflicts resolved by `prefer`
    std::vector<std::string> notes;   ///< messages about new ids and about regions merged face by face
    /// True if there is no conflict left to resolve.
    [[nodiscard]] bool settled(const MergeOptions& options) const {
        return conflicts.empty() || options.prefer != MergeOptions::Side::none;
    }
};

/// Three-way merge of two sets with a common base, by id, field by field: a change of only one side is accepted, as are equal
/// changes of both sides; different changes are conflicts. Each attribute is a separate field, identified by id. Removing an
/// annotation that the other side changed is a conflict. merge(base, a, base) = a and merge(base, base, b) = b, including the
/// order.
MergedAnnotations merge_annotations(const AnnotationSet& base, const AnnotationSet& ours, const AnnotationSet& theirs,
                                    const MergeOptions& options = {});

}  // namespace ostraka
