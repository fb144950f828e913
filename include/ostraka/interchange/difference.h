// Differences between two sets of annotations on one mesh, and three-way merge.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"

namespace ostraka {

/// One difference between two sets of annotations.
struct Difference {
    enum class Kind { added, removed, changed };
    Kind kind = Kind::changed;
    std::optional<int> id;  ///< id of the annotation; none if the difference is in a field of the set
    std::string tag;        ///< tag of the annotation in the second set, or in the first set if it was removed
    /// Field of the annotation ("tag", "colour", "type", "geometry", "note", "attribute ID", "order") or of the set ("class",
    /// "unit", "up", "order"); empty: the whole annotation was added or removed.
    std::string field;
    /// Value of the field in the first and in the second set, as text; lists are truncated.
    std::string before, after;
    /// For "geometry": number of faces, edges or points that are only in the annotation of the first set, and only in that of
    /// the second set.
    std::size_t only_before = 0, only_after = 0;
};

/// The differences from `a` to `b`: first differences of the set itself, then of annotations in ascending order of id. The list
/// is empty if and only if the files of both sets are equal except for the provenance. `differences(b, a)` gives the same list
/// with first and second set exchanged. Time: linear, except for sorting.
std::vector<Difference> differences(const AnnotationSet& a, const AnnotationSet& b);

/// A field that both sides of a three-way merge ("ours" and "theirs") changed in different ways.
struct Conflict {
    std::optional<int> id;   ///< id of the annotation; none if the field belongs to the set itself
    std::string tag, field;  ///< tag of the annotation; name of the field (Difference::field)
    /// Value of the field in the common base, in the set `ours` and in the set `theirs`, as text.
    std::string base, ours, theirs;
};

/// Options of `merge_annotations`.
struct MergeOptions {
    /// Side whose change is kept in a conflict; none: conflicts are reported as unresolved.
    enum class Side { none, ours, theirs } prefer = Side::none;
    bool merge_faces = false;  ///< true: merge regions that both sides changed face by face, without a conflict
    /// True: if both sides added an annotation with the same id, the annotation of `theirs` gets a new id; this is not a
    /// conflict.
    bool renumber = false;

    void declare_options(OptionList& list);  ///< declares the options with their names, help texts and ranges
};

/// Result of `merge_annotations`.
struct MergedAnnotations {
    /// The merged set; for each conflict it contains the value of `ours`, or of `theirs` if `prefer` is theirs.
    AnnotationSet set;
    std::vector<Conflict> conflicts;  ///< all conflicts, including conflicts resolved by `prefer`
    std::vector<std::string> notes;   ///< messages about new ids and about regions merged face by face
    /// True if there is no conflict left to resolve.
    [[nodiscard]] bool is_resolved(const MergeOptions& options) const {
        return conflicts.empty() || options.prefer != MergeOptions::Side::none;
    }
};

/// Three-way merge of two sets with a common base. Annotations are matched by id and merged field by field. A change made by
/// one side only, or an equal change made by both sides, is accepted; different changes of one field are a conflict. Each
/// attribute is a separate field, identified by id. Removing an annotation that the other side changed is a conflict.
/// merge(base, a, base) = a and merge(base, base, b) = b, including the order.
MergedAnnotations merge_annotations(const AnnotationSet& base, const AnnotationSet& ours, const AnnotationSet& theirs,
                                    const MergeOptions& options = {});

}  // namespace ostraka
