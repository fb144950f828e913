#include "ostraka/interchange/edit.h"

#include "interchange/fields.h"
#include "interchange/text.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/annotation/curves.h"
#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/measure/measure.h"
#include "ostraka/mesh/flood.h"
#include "ostraka/mesh/ids.h"

#include <fmt/core.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace ostraka {

namespace {

using namespace interchange;
using std::to_string;

std::string quoted_name(const EntryName& name) {
    return name.id ? to_string(*name.id) : fmt::format("'{}'", interchange::as_text(name.text));
}

EntryName name_of(const JsonValue& value) {
    EntryName name;
    if (value.IsInt()) name.id = value.GetInt();
    else name.text = text_of(value);
    return name;
}

/// The edge-connected patches of a region, in the order of their smallest face.
std::vector<std::vector<Index>> patches(const Mesh& mesh, const std::vector<Index>& faces) {
    const std::vector<bool> selected = face_flags(mesh, faces);
    const auto [piece, count] = face_pieces(mesh, [&](Face f) -> bool { return selected[f]; });
    std::vector<std::vector<Index>> result(count);
    for (Index f = 0; f < piece.size(); ++f)
        if (piece[f] != no_index) result[piece[f]].push_back(f);
    return result;
}

int free_attribute_id(const Annotation& annotation) {
    std::set<int> used;
    for (const Attribute& attribute : annotation.attributes) used.insert(attribute.id);
    int id = 0;
    while (used.contains(id)) ++id;
    return id;
}

/// A unit derived from a unit of length ("mm^2", "1/mm"), converted from `old` to `fresh`.
std::string unit_after(const std::string& unit, const std::string& old_unit, const std::string& new_unit) {
    if (old_unit.empty() || new_unit.empty()) return unit == old_unit ? new_unit : unit;
    for (const std::string prefix : {"", "1/"})
        if (unit == prefix + old_unit || unit.starts_with(prefix + old_unit + '^'))
            return prefix + new_unit + unit.substr((prefix + old_unit).size());
    return unit;
}

class Editor {
public:
    Editor(const Mesh& mesh, AnnotationSet& set, const std::string& where) : mesh_(mesh), set_(set), where_(where) {}

    std::vector<std::string> run(const std::vector<AnnotationEdit>& edits) {
        for (std::size_t i = 0; i < edits.size(); ++i) {
            location_ = fmt::format("{}, edit {}", where_, i + 1);
            step(edits[i]);
        }
        check_annotations({mesh_, set_}, where_);
        return std::move(notes_);
    }

private:
    void step(const AnnotationEdit& edit) {
        std::size_t index = find(edit.annotation);
        for (const EntryName& other : edit.merge) {
            merge(index, find(other));
            index = find({merged_id_, {}});
        }
        if (edit.duplicate) {
            Annotation copy = set_.annotations[index];
            copy.id = free_id(set_);
            set_.annotations.insert(set_.annotations.begin() + static_cast<std::ptrdiff_t>(++index), std::move(copy));
        }
        Annotation& annotation = set_.annotations[index];
        if (edit.tag) annotation.tag = *edit.tag;
        if (edit.note) annotation.note = *edit.note;
        if (edit.colour) annotation.colour = *edit.colour;
        if (edit.id && *edit.id != annotation.id) {
            if (set_.find(*edit.id) != nullptr)
                fail_input(location_, fmt::format("the id {} is in use", *edit.id),
                           "choose another, such as " + to_string(free_id(set_)));
            if (!edit.duplicate)
                notes_.push_back(fmt::format("annotation {} now has the id {}: update the relations that use its old id",
                                             annotation.id, *edit.id));
            annotation.id = *edit.id;
        }
        for (const std::string& value : edit.remove_information) remove_information(annotation, value);
        for (const Information& entry : edit.information) put(annotation, entry);
        for (const EntryName& name : edit.remove_attributes) remove_attribute(annotation, name);
        for (const Attribute& attribute : edit.attributes) put(annotation, attribute);
        for (const auto& [name, text] : edit.texts) put(annotation, name, text);
        if (edit.split) split(index);
        if (edit.remove) set_.annotations.erase(set_.annotations.begin() + static_cast<std::ptrdiff_t>(index));
    }

    std::size_t find(const EntryName& name) const {
        std::vector<std::size_t> matches;
        for (std::size_t i = 0; i < set_.annotations.size(); ++i)
            if (name.id ? set_.annotations[i].id == *name.id : set_.annotations[i].tag == name.text) matches.push_back(i);
        if (matches.empty()) {
            std::vector<std::string> tags;
            for (const Annotation& annotation : set_.annotations) tags.push_back(annotation.tag);
            const std::string suggestion = name.id || name.text.size() > 100 ? std::string() : nearest_name(name.text, tags);
            fail_input(location_, "there is no annotation " + quoted_name(name),
                       (suggestion.empty() ? "" : fmt::format("did you mean '{}'? ", printable(suggestion, 60))) +
                           "'annotation list' shows ids and tags");
        }
        if (matches.size() > 1)
            fail_input(location_, fmt::format("{} annotations have the tag {}", matches.size(), quoted_name(name)),
                       "identify it by its id");
        return matches.front();
    }

    void remove_attribute(Annotation& annotation, const EntryName& name) const {
        const auto matches = [&](const Attribute& a) { return name.id ? a.id == *name.id : a.name == name.text; };
        const auto count = std::count_if(annotation.attributes.begin(), annotation.attributes.end(), matches);
        const std::string subject = "annotation " + to_string(annotation.id);
        if (count == 0)
            fail_input(location_, fmt::format("{} has no attribute {}", subject, quoted_name(name)),
                       "'annotation list' shows its attributes");
        if (count > 1)
            fail_input(location_, fmt::format("{} has several attributes {}", subject, quoted_name(name)),
                       "identify it by its id");
        annotation.attributes.erase(std::find_if(annotation.attributes.begin(), annotation.attributes.end(), matches));
    }

    void remove_information(Annotation& annotation, const std::string& value) const {
        const auto removed_count =
            std::erase_if(annotation.information, [&](const Information& entry) { return entry.value == value; });
        if (removed_count == 0)
            fail_input(location_,
                       fmt::format("annotation {} has no information '{}'", annotation.id, interchange::as_text(value)),
                       "give its text, link or file");
    }

    static void put(Annotation& annotation, const Information& information) {
        const auto existing = std::find_if(
            annotation.information.begin(), annotation.information.end(),
            [&](const Information& entry) { return entry.kind == information.kind && entry.value == information.value; });
        if (existing == annotation.information.end()) annotation.information.push_back(information);
        else *existing = information;
    }

    static void put(Annotation& annotation, const Attribute& attribute) {
        const auto same_id = std::find_if(annotation.attributes.begin(), annotation.attributes.end(),
                                          [&](const Attribute& a) { return a.id == attribute.id; });
        if (same_id == annotation.attributes.end()) annotation.attributes.push_back(attribute);
        else *same_id = attribute;
    }

    static void put(Annotation& annotation, const std::string& name, const std::string& text) {
        const auto same_name = std::find_if(annotation.attributes.begin(), annotation.attributes.end(),
                                            [&](const Attribute& a) { return a.name == name && a.note() != nullptr; });
        Attribute attribute;
        attribute.id = same_name == annotation.attributes.end() ? free_attribute_id(annotation) : same_name->id;
        attribute.name = name;
        attribute.value = Note{text, {}};
        put(annotation, attribute);
    }

    /// Recomputes the values measured on the selection.
    void refresh(Annotation& annotation) {
        AnnotationSet single_set;
        single_set.unit = set_.unit;
        single_set.annotations.push_back(std::move(annotation));
        const RefreshResult result = refresh_measures(mesh_, single_set);
        notes_.insert(notes_.end(), result.notes.begin(), result.notes.end());
        annotation = std::move(single_set.annotations.front());
    }

    void merge(std::size_t index, std::size_t other_index) {
        if (index == other_index) fail_input(location_, "an annotation cannot be merged into itself", "give another annotation");
        Annotation& annotation = set_.annotations[index];
        const Annotation& other = set_.annotations[other_index];
        if (annotation.type != other.type)
            fail_input(location_,
                       fmt::format("a {} cannot be merged into a {}", to_string(other.type), to_string(annotation.type)),
                       "merge annotations of one type");
        for (const Information& entry : other.information) put(annotation, entry);
        if (is_free(annotation) || is_free(other)) {
            join_curves(annotation, other);
        } else {
            join_elements(annotation, other);
        }
        for (Attribute attribute : other.attributes) {
            const auto counterpart = std::find_if(
                annotation.attributes.begin(), annotation.attributes.end(),
                [&](const Attribute& a) { return a.name == attribute.name && a.value.index() == attribute.value.index(); });
            if (counterpart == annotation.attributes.end()) {
                attribute.id = free_attribute_id(annotation);
                annotation.attributes.push_back(std::move(attribute));
                continue;
            }
            attribute.id = counterpart->id;
            if (!same(attribute, *counterpart) && attribute.descriptor() == nullptr)
                notes_.push_back(fmt::format("annotation {} keeps its own '{}'; that of annotation {} is dropped", annotation.id,
                                             interchange::as_text(attribute.name), other.id));
        }
        refresh(annotation);
        merged_id_ = annotation.id;
        set_.annotations.erase(set_.annotations.begin() + static_cast<std::ptrdiff_t>(other_index));
    }

    /// Joins two annotations on the mesh cut along the curves of both.
    void join_curves(Annotation& annotation, const Annotation& other) const {
        AnnotationSet pair;
        pair.annotations = {annotation, other};
        const CutMesh cut = cut_along_curves({mesh_, pair});
        Annotation joined = cut.annotations.annotations[0];
        join_elements(joined, cut.annotations.annotations[1]);
        if (!joined.all) uncut_annotation(mesh_, cut, joined);
        annotation.points = std::move(joined.points);
        annotation.polylines = std::move(joined.polylines);
        annotation.faces = std::move(joined.faces);
        annotation.curves = std::move(joined.curves);
        annotation.all = joined.all;
        if (annotation.all) annotation.faces.resize(mesh_.number_of_faces());
        if (annotation.all) std::iota(annotation.faces.begin(), annotation.faces.end(), Index{0});
    }

    static void join_elements(Annotation& annotation, const Annotation& other) {
        std::set<Index> present(annotation.points.begin(), annotation.points.end());
        std::copy_if(other.points.begin(), other.points.end(), std::back_inserter(annotation.points),
                     [&](Index point) { return present.insert(point).second; });
        annotation.polylines.insert(annotation.polylines.end(), other.polylines.begin(), other.polylines.end());
        std::vector<Index> faces;
        std::set_union(annotation.faces.begin(), annotation.faces.end(), other.faces.begin(), other.faces.end(),
                       std::back_inserter(faces));
        annotation.faces = std::move(faces);
        annotation.all = annotation.all || other.all;
    }

    void split(std::size_t index) {
        const Annotation original = set_.annotations[index];
        std::vector<Annotation> parts;
        const auto add = [&]() -> Annotation& {
            Annotation part = original;
            part.points.clear();
            part.polylines.clear();
            part.faces.clear();
            part.curves.clear();
            part.all = false;
            return parts.emplace_back(std::move(part));
        };
        if (is_free(original)) {
            AnnotationSet single_set;
            single_set.annotations.push_back(original);
            const CutMesh cut = cut_along_curves({mesh_, single_set});
            const Annotation& cut_annotation = cut.annotations.annotations.front();
            for (const Index point : cut_annotation.points) add().points = {point};
            for (const auto& polyline : cut_annotation.polylines) add().polylines = {polyline};
            for (auto& patch : patches(cut.mesh, cut_annotation.faces)) add().faces = std::move(patch);
            for (Annotation& part : parts) uncut_annotation(mesh_, cut, part);
        } else {
            for (const Index point : original.points) add().points = {point};
            for (const auto& polyline : original.polylines) add().polylines = {polyline};
            for (auto& patch : patches(mesh_, original.faces)) add().faces = std::move(patch);
        }
        if (parts.size() < 2) {
            notes_.push_back(
                fmt::format("annotation {} '{}' already consists of one piece", original.id, interchange::as_text(original.tag)));
            return;
        }
        for (Annotation& part : parts) std::erase_if(part.attributes, [](const Attribute& a) { return a.measure() != nullptr; });
        std::vector<std::vector<Index>> touched;
        for (const Annotation& part : parts) touched.push_back(touched_vertices(mesh_, part));
        for (const Attribute& attribute : original.attributes) {
            if (attribute.measure() == nullptr) continue;
            std::size_t owner = 0;
            for (std::size_t i = parts.size(); i-- > 0;)
                for (const Index pin : attribute.measure()->points)
                    if (std::binary_search(touched[i].begin(), touched[i].end(), pin)) owner = i;
            parts[owner].attributes.push_back(attribute);
        }
        set_.annotations[index] = parts.front();
        refresh(set_.annotations[index]);
        FreeIds ids(set_.annotations);
        for (std::size_t i = 1; i < parts.size(); ++i) {
            parts[i].id = ids.next();
            refresh(parts[i]);
        }
        set_.annotations.insert(set_.annotations.begin() + static_cast<std::ptrdiff_t>(index) + 1,
                                std::make_move_iterator(parts.begin() + 1), std::make_move_iterator(parts.end()));
    }

    const Mesh& mesh_;
    AnnotationSet& set_;
    const std::string& where_;
    std::string location_;
    int merged_id_ = 0;
    std::vector<std::string> notes_;
};

}  // namespace

std::vector<AnnotationEdit> edits_from_json(const JsonValue& document, const std::string& where) {
    validate(document, "annotation-edits", where);
    std::vector<AnnotationEdit> edits;
    for (const auto& entry : list_in(document, "edits")) {
        const std::string pointer = "/edits/" + to_string(edits.size());
        AnnotationEdit& edit = edits.emplace_back();
        edit.annotation = name_of(entry["annotation"]);
        if (find_member(entry, "tag") != nullptr) edit.tag = text_in(entry, "tag");
        if (find_member(entry, "note") != nullptr) edit.note = text_in(entry, "note");
        if (const JsonValue* id = find_member(entry, "id")) edit.id = id->GetInt();
        if (const JsonValue* colour = find_member(entry, "colour"))
            edit.colour = {(*colour)[0].GetInt(), (*colour)[1].GetInt(), (*colour)[2].GetInt()};
        if (const JsonValue* attributes = find_member(entry, "attributes"))
            edit.attributes = attributes_from_json(*attributes, where, pointer + "/attributes");
        edit.information = information_from_json(list_in(entry, "information"), where, pointer + "/information");
        for (const auto& value : list_in(entry, "removeInformation")) edit.remove_information.push_back(text_of(value));
        if (const JsonValue* texts = find_member(entry, "texts"))
            for (const auto& text : texts->GetObject()) edit.texts.emplace_back(text_of(text.name), text_of(text.value));
        for (const auto& name : list_in(entry, "merge")) edit.merge.push_back(name_of(name));
        for (const auto& name : list_in(entry, "removeAttributes")) edit.remove_attributes.push_back(name_of(name));
        edit.duplicate = flag_in(entry, "duplicate");
        edit.split = flag_in(entry, "split");
        edit.remove = flag_in(entry, "remove");
    }
    return edits;
}

std::vector<AnnotationEdit> read_edits(const Path& file) { return edits_from_json(read_json(file), file.string()); }

std::vector<std::string> edit_annotations(const Mesh& mesh, AnnotationSet& set, const std::vector<AnnotationEdit>& edits,
                                          const std::string& where) {
    return Editor(mesh, set, where).run(edits);
}

void change_length_unit(const Mesh& mesh, AnnotationSet& set, const std::string& new_unit) {
    const std::string old_unit = set.unit;
    set.unit = new_unit;
    for (Annotation& annotation : set.annotations)
        for (Attribute& attribute : annotation.attributes) {
            if (Measure* measure = attribute.measure()) measure->unit = unit_after(measure->unit, old_unit, new_unit);
            if (attribute.descriptor() == nullptr) continue;
            std::string& unit = attribute.descriptor()->unit;
            const bool computed = (old_unit.empty() ? unit.empty() : unit == descriptor_unit(attribute.name, old_unit)) &&
                                  evaluate(mesh, annotation, attribute.name);
            unit = computed           ? descriptor_unit(attribute.name, new_unit)
                   : old_unit.empty() ? unit
                                      : unit_after(unit, old_unit, new_unit);
        }
}

}  // namespace ostraka
