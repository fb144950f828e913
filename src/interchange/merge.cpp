// Three-way merge: each item has three states, and changes of only one side are applied.
#include "ostraka/interchange/difference.h"

#include "fields.h"

#include <algorithm>
#include <map>
#include <set>

namespace ostraka {

namespace {

using namespace interchange;

/// The order of the items on one or both sides: theirs if ours kept the order of the base, otherwise ours; items of the other
/// side only come last.
std::vector<int> merged_order(const std::vector<int>& base, const std::vector<int>& ours, const std::vector<int>& theirs) {
    const std::vector<int>& first = ours == base ? theirs : ours;
    const std::vector<int>& second = ours == base ? ours : theirs;
    std::vector<int> order = first;
    const std::set<int> known(first.begin(), first.end());
    std::copy_if(second.begin(), second.end(), std::back_inserter(order), [&](int id) { return !known.contains(id); });
    return order;
}

template <class Entry>
std::map<int, const Entry*> by_id(const std::vector<Entry>& entries) {
    std::map<int, const Entry*> result;
    for (const Entry& entry : entries) result.emplace(entry.id, &entry);
    return result;
}
template <class Entry>
const Entry* look_up(const std::map<int, const Entry*>& entries, int id) {
    const auto found = entries.find(id);
    return found == entries.end() ? nullptr : found->second;
}

class Merger {
public:
    explicit Merger(const MergeOptions& options) : options_(options) {}

    MergedAnnotations merge(const AnnotationSet& base, const AnnotationSet& ours, const AnnotationSet& theirs) {
        std::vector<Annotation> other = theirs.annotations;
        if (options_.renumber) renumber(base, ours, other);
        AnnotationSet& set = result_.set;
        set.object_class = field("class", base.object_class, ours.object_class, theirs.object_class);
        set.unit = field("unit", base.unit, ours.unit, theirs.unit);
        set.up = field("up", base.up, ours.up, theirs.up);
        const auto b = by_id(base.annotations), o = by_id(ours.annotations), t = by_id(other);
        for (const int id : merged_order(ids_of(base.annotations), ids_of(ours.annotations), ids_of(other))) {
            id_ = id;
            if (const auto merged = annotation(look_up(b, id), look_up(o, id), look_up(t, id)))
                set.annotations.push_back(*merged);
        }
        return std::move(result_);
    }

private:
    void conflict(const std::string& name, const std::string& base, const std::string& ours, const std::string& theirs) {
        result_.conflicts.push_back({id_, tag_, name, base, ours, theirs});
    }
    [[nodiscard]] bool theirs_preferred() const { return options_.prefer == MergeOptions::Side::theirs; }

    template <class T>
    T field(const std::string& name, const T& base, const T& ours, const T& theirs) {
        if (ours == theirs || theirs == base) return ours;
        if (ours == base) return theirs;
        conflict(name, words(base), words(ours), words(theirs));
        return theirs_preferred() ? theirs : ours;
    }

    /// Annotations added by both sides with the same id but different contents are separate: theirs get new ids.
    void renumber(const AnnotationSet& base, const AnnotationSet& ours, std::vector<Annotation>& theirs) {
        std::set<int> taken;
        for (const auto* list : {&base.annotations, &ours.annotations, static_cast<const std::vector<Annotation>*>(&theirs)})
            for (const Annotation& annotation : *list) taken.insert(annotation.id);
        for (Annotation& annotation : theirs) {
            const Annotation* other = ours.find(annotation.id);
            if (other == nullptr || base.find(annotation.id) != nullptr || same(*other, annotation)) continue;
            const int before = annotation.id;
            int fresh = 0;
            while (taken.contains(fresh)) ++fresh;
            taken.insert(fresh);
            annotation.id = fresh;
            result_.notes.push_back("annotation " + std::to_string(before) + " '" + words(annotation.tag) + "' of theirs is " +
                                    std::to_string(fresh) + " now, as ours has that id for '" + words(other->tag) + "'");
        }
    }

    std::optional<Annotation> annotation(const Annotation* base, const Annotation* ours, const Annotation* theirs) {
        const auto state = [](const Annotation* a) { return a == nullptr ? std::string("removed") : words(*a); };
        const Annotation* any = ours != nullptr ? ours : theirs != nullptr ? theirs : base;
        tag_ = any == nullptr ? "" : any->tag;
        if (ours != nullptr && theirs != nullptr) {
            if (base != nullptr) return fields(*base, *ours, *theirs);
            if (same(*ours, *theirs)) return *ours;
            conflict("both added", "", state(ours), state(theirs));
            return theirs_preferred() ? *theirs : *ours;
        }
        if (base == nullptr) return *any;  // added by one side
        const Annotation* kept = ours != nullptr ? ours : theirs;
        if (kept == nullptr || same(*kept, *base)) return {};  // removed by both, or by one and unchanged by the other
        conflict("removed by one, changed by the other", state(base), state(ours), state(theirs));
        const Annotation* chosen = theirs_preferred() ? theirs : ours;
        if (chosen == nullptr) return {};
        return *chosen;
    }

    Annotation fields(const Annotation& base, const Annotation& ours, const Annotation& theirs) {
        Annotation merged = ours;
        merged.tag = field("tag", base.tag, ours.tag, theirs.tag);
        merged.colour = field("colour", base.colour, ours.colour, theirs.colour);
        merged.note = field("note", base.note, ours.note, theirs.note);
        merged.information = field("information", base.information, ours.information, theirs.information);
        geometry(merged, base, ours, theirs);
        attributes(merged, base, ours, theirs);
        return merged;
    }

    /// Type and selection are merged as one field.
    void geometry(Annotation& merged, const Annotation& base, const Annotation& ours, const Annotation& theirs) {
        const auto take = [&](const Annotation& from) {
            merged.type = from.type;
            merged.points = from.points;
            merged.polylines = from.polylines;
            merged.faces = from.faces;
            merged.curves = from.curves;
            merged.all = from.all;
        };
        if (same_geometry(ours, theirs) || same_geometry(theirs, base)) return;
        if (same_geometry(ours, base)) return take(theirs);
        const bool regions = base.type == AnnotationType::region && ours.type == base.type && theirs.type == base.type &&
                             !base.all && !ours.all && !theirs.all && base.curves.empty() && ours.curves.empty() &&
                             theirs.curves.empty();
        if (options_.merge_faces && regions) {
            // Membership of a face is binary: a change by one side is applied, and the two sides cannot change it in different
            // ways.
            std::vector<Index> faces, all;
            std::set_union(ours.faces.begin(), ours.faces.end(), theirs.faces.begin(), theirs.faces.end(),
                           std::back_inserter(all));
            const auto in = [](const Annotation& a, Index face) {
                return std::binary_search(a.faces.begin(), a.faces.end(), face);
            };
            for (const Index face : all)
                if (in(base, face) ? in(ours, face) && in(theirs, face) : true) faces.push_back(face);
            merged.faces = std::move(faces);
            result_.notes.push_back("annotation " + std::to_string(base.id) + " '" + words(tag_) +
                                    "': both changed the region, merged face by face to " + std::to_string(merged.faces.size()) +
                                    " faces");
            return;
        }
        conflict("geometry", geometry_words(base), geometry_words(ours), geometry_words(theirs));
        if (theirs_preferred()) take(theirs);
    }

    void attributes(Annotation& merged, const Annotation& base, const Annotation& ours, const Annotation& theirs) {
        const auto b = by_id(base.attributes), o = by_id(ours.attributes), t = by_id(theirs.attributes);
        const auto equal = [](const Attribute* x, const Attribute* y) {
            return x == y || (x != nullptr && y != nullptr && same(*x, *y));
        };
        const auto state = [](const Attribute* a) { return a == nullptr ? std::string("none") : words(*a); };
        merged.attributes.clear();
        for (const int id : merged_order(ids_of(base.attributes), ids_of(ours.attributes), ids_of(theirs.attributes))) {
            const Attribute *from = look_up(b, id), *mine = look_up(o, id), *other = look_up(t, id);
            const Attribute* chosen = mine;
            if (!equal(mine, other) && !equal(other, from)) {
                if (equal(mine, from)) {
                    chosen = other;
                } else {
                    conflict("attribute " + std::to_string(id), state(from), state(mine), state(other));
                    chosen = theirs_preferred() ? other : mine;
                }
            }
            if (chosen != nullptr) merged.attributes.push_back(*chosen);
        }
    }

    const MergeOptions& options_;
    MergedAnnotations result_;
    std::optional<int> id_;
    std::string tag_;
};

}  // namespace

MergedAnnotations merge_annotations(const AnnotationSet& base, const AnnotationSet& ours, const AnnotationSet& theirs,
                                    const MergeOptions& options) {
    check_options(options, "annotation merge");
    return Merger(options).merge(base, ours, theirs);
}

}  // namespace ostraka
