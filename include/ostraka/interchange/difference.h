// What differs between two sets of annotations on one mesh, and the merge of two people's work on a common base.
#pragma once

#include "ostraka/annotation/annotation.h"
#include "ostraka/core/options.h"

namespace ostraka {

/// One difference. `field` is "tag", "colour", "type", "geometry", "note", "attribute N" (N its id) or "order" of an annotation;
/// "class", "unit", "up" or "order" of the set; empty where a whole annotation was added or removed.
struct Difference {
    enum class Kind { added, removed, changed };
    Kind kind = Kind::changed;
    std::optional<int> id;  ///< of the annotation; nothing for the set itself
    std::string tag;        ///< of the annotation in the second set, or in the first where it is gone
    std::string field;
    std::string before, after;                    ///< in words; lists are cut short
    std::size_t only_before = 0, only_after = 0;  ///< geometry: faces, edges or points that one of the sets alone has
};

/// The differences from `a` to `b`, annotations by id in ascending order, those of the set first. Empty if and only if a file of
/// one would hold the same as one of the other, provenance apart; `differences(b, a)` is the same with sides changed. Linear but
/// for sorting.
std::vector<Difference> differences(const AnnotationSet& a, const AnnotationSet& b);

/// Two people changed one thing in two ways.
struct Conflict {
    std::optional<int> id;
    std::string tag, field;
    std::string base, ours, theirs;  ///< in words
};

struct MergeOptions {
    enum class Side { none, ours, theirs } prefer = Side::none;
    bool merge_faces = false;
    bool renumber = false;

    void describe(OptionList& visit);
};

struct MergedAnnotations {
    AnnotationSet set;                ///< with ours in place of each conflict, unless theirs is preferred
    std::vector<Conflict> conflicts;  ///< also where a preference settled them
    std::vector<std::string> notes;   ///< ids given anew, regions merged face by face
    [[nodiscard]] bool settled(const MergeOptions& options) const {
        return conflicts.empty() || options.prefer != MergeOptions::Side::none;
    }
};

/// Three-way merge by id, field by field: what only one side changed is taken, what both changed alike as well; the rest is a
/// conflict. Attributes are fields of their own, by id. One who removes an annotation that the other changed makes a conflict.
/// merge(base, a, base) = a and merge(base, base, b) = b, order included.
MergedAnnotations merge_annotations(const AnnotationSet& base, const AnnotationSet& ours, const AnnotationSet& theirs,
                                    const MergeOptions& options = {});

}  // namespace ostraka
