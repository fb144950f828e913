// Three-way merge: each item has three states, and changes of only one side are applied.
#include "ostraka/interchange/difference.h"

#include "interchange/fields.h"

#include <fmt/core.h>

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
    const std::set<int> listed(first.begin(), first.end());
    std::copy_if(second.begin(), second.end(), std::back_inserter(order), [&](int id) { return !listed.contains(id); });
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
    const auto entry = entries.find(id);
    return entry == entries.end() ? nullptr : entry->second;
}

class Merger {
public:
    explicit Merger(const MergeOptions& options) : options_(options) {}

    MergedAnnotations merge(const AnnotationSet& base, const AnnotationSet& ours, const AnnotationSet& theirs) {
        std::vector<Annotation> their_annotations = theirs.annotations;
        if (options_.renumber) renumber(base, ours, their_annotations);
        AnnotationSet& set = result_.set;
        set.object_class = field("class", base.object_class, ours.object_class, theirs.object_class);
        set.unit = field("unit", base.unit, ours.unit, theirs.unit);
        set.up = field("up", base.up, ours.up, theirs.up);
        const auto b = by_id(base.annotations), o = by_id(ours.annotations), t = by_id(their_annotations);
        for (const int id : merged_order(ids_of(base.annotations), ids_of(ours.annotations), ids_of(their_annotations))) {
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
        conflict(name, as_text(base), as_text(ours), as_text(theirs));
        return theirs_preferred() ? theirs : ours;
    }

    /// Annotations added by both sides with the same id but different contents are separate: theirs get new ids.
    void renumber(const AnnotationSet& base, const AnnotationSet& ours, std::vector<Annotation>& theirs) {
        std::set<int> used_ids;
        for (const auto* annotations :
             {&base.annotations, &ours.annotations, static_cast<const std::vector<Annotation>*>(&theirs)})
            for (const Annotation& annotation : *annotations) used_ids.insert(annotation.id);
        for (Annotation& annotation : theirs) {
            const Annotation* our_annotation = ours.find(annotation.id);
            if (our_annotation == nullptr || base.find(annotation.id) != nullptr || same(*our_annotation, annotation)) continue;
            const int old_id = annotation.id;
            int new_id = 0;
            while (used_ids.contains(new_id)) ++new_id;
            used_ids.insert(new_id);
            annotation.id = new_id;
            result_.notes.push_back(
                fmt::format("annotation {} '{}' of theirs now has the id {}, because ours uses that id for '{}'", old_id,
                            as_text(annotation.tag), new_id, as_text(our_annotation->tag)));
        }
    }

    std::optional<Annotation> annotation(const Annotation* base, const Annotation* ours, const Annotation* theirs) {
        const auto state = [](const Annotation* a) { return a == nullptr ? std::string("removed") : as_text(*a); };
        const Annotation* any = ours != nullptr ? ours : theirs != nullptr ? theirs : base;
        tag_ = any == nullptr ? "" : any->tag;
        if (ours != nullptr && theirs != nullptr) {
            if (base != nullptr) return fields(*base, *ours, *theirs);
            if (same(*ours, *theirs)) return *ours;
            conflict("both added", "", state(ours), state(theirs));
            return theirs_preferred() ? *theirs : *ours;
        }
        if (base == nullptr) return *any;  // added by one side
        const Annotation* remaining = ours != nullptr ? ours : theirs;
        if (remaining == nullptr || same(*remaining, *base)) return {};  // removed by both, or by one and unchanged by the other
        conflict("removed by one, changed by the other", state(base), state(ours), state(theirs));
        const Annotation* preferred = theirs_preferred() ? theirs : ours;
        if (preferred == nullptr) return {};
        return *preferred;
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
        const auto take = [&](const Annotation& source) {
            merged.type = source.type;
            merged.points = source.points;
            merged.polylines = source.polylines;
            merged.faces = source.faces;
            merged.curves = source.curves;
            merged.all = source.all;
        };
        if (same_geometry(ours, theirs) || same_geometry(theirs, base)) return;
        if (same_geometry(ours, base)) return take(theirs);
        const bool regions = base.type == AnnotationType::region && ours.type == base.type && theirs.type == base.type &&
                             !base.all && !ours.all && !theirs.all && base.curves.empty() && ours.curves.empty() &&
                             theirs.curves.empty();
        if (options_.merge_faces && regions) {
            // Membership of a face is binary: a change by one side is applied, and the two sides cannot change it in different
            // ways.
            std::vector<Index> faces, all_faces;
            std::set_union(ours.faces.begin(), ours.faces.end(), theirs.faces.begin(), theirs.faces.end(),
                           std::back_inserter(all_faces));
            const auto contains = [](const Annotation& a, Index face) {
                return std::binary_search(a.faces.begin(), a.faces.end(), face);
            };
            for (const Index face : all_faces)
                if (contains(base, face) ? contains(ours, face) && contains(theirs, face) : true) faces.push_back(face);
            merged.faces = std::move(faces);
            result_.notes.push_back(
                fmt::format("annotation {} '{}': both sides changed the region; merged face by face to {} faces", base.id,
                            as_text(tag_), merged.faces.size()));
            return;
        }
        conflict("geometry", geometry_as_text(base), geometry_as_text(ours), geometry_as_text(theirs));
        if (theirs_preferred()) take(theirs);
    }

    void attributes(Annotation& merged, const Annotation& base, const Annotation& ours, const Annotation& theirs) {
        const auto b = by_id(base.attributes), o = by_id(ours.attributes), t = by_id(theirs.attributes);
        const auto equal = [](const Attribute* x, const Attribute* y) {
            return x == y || (x != nullptr && y != nullptr && same(*x, *y));
        };
        const auto state = [](const Attribute* a) { return a == nullptr ? std::string("none") : as_text(*a); };
        merged.attributes.clear();
        for (const int id : merged_order(ids_of(base.attributes), ids_of(ours.attributes), ids_of(theirs.attributes))) {
            const Attribute *base_attribute = look_up(b, id), *our_attribute = look_up(o, id), *their_attribute = look_up(t, id);
            const Attribute* chosen = our_attribute;
            if (!equal(our_attribute, their_attribute) && !equal(their_attribute, base_attribute)) {
                if (equal(our_attribute, base_attribute)) {
                    chosen = their_attribute;
                } else {
                    conflict("attribute " + std::to_string(id), state(base_attribute), state(our_attribute),
                             state(their_attribute));
                    chosen = theirs_preferred() ? their_attribute : our_attribute;
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
