// ostraka annotation edit
#include "command.h"
#include "number_lists.h"

#include "ostraka/annotation/annotation_file.h"
#include "ostraka/exchange/difference.h"
#include "ostraka/exchange/edit.h"
#include "ostraka/io/mesh_file.h"
#include "ostraka/measure/measure.h"

#include <algorithm>
#include <charconv>
#include <iostream>
#include <memory>

namespace ostraka::app {

namespace {

std::optional<int> whole(const std::string& text) {
    int value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || code != std::errc() || end != text.data() + text.size()) return {};
    return value;
}

EntryName name_of(const std::string& text) { return {whole(text), text}; }

/// "200 30 60", "200,30,60" or "#c81e3c".
std::array<int, 3> colour_of(const std::string& text) {
    std::array<int, 3> colour{};
    bool good = false;
    if (text.size() == 7 && text[0] == '#') {
        good = true;
        for (std::size_t k = 0; k < 3; ++k) {
            const char* begin = text.data() + 1 + 2 * k;
            const auto [end, code] = std::from_chars(begin, begin + 2, colour[k], 16);
            good = good && code == std::errc() && end == begin + 2 && colour[k] >= 0;
        }
    } else {
        std::string list = text;
        std::replace(list.begin(), list.end(), ',', ' ');
        std::istringstream stream(list);
        std::string word, rest;
        good = true;
        for (int& part : colour) {
            stream >> word;
            const auto value = whole(word);
            good = good && !stream.fail() && value && *value >= 0 && *value <= 255;
            part = value.value_or(0);
        }
        good = good && !(stream >> rest);
    }
    if (!good)
        fail_usage("the colour '" + text + "' is not known", "give red, green and blue from 0 to 255 as 200,30,60 or #c81e3c");
    return colour;
}

/// A unit made of one of length ("mm^2", "1/mm") in terms of another.
std::string unit_after(const std::string& unit, const std::string& old, const std::string& fresh) {
    if (old.empty() || fresh.empty()) return unit == old ? fresh : unit;
    for (const std::string before : {"", "1/"})
        if (unit == before + old || unit.starts_with(before + old + '^'))
            return before + fresh + unit.substr((before + old).size());
    return unit;
}

/// Calls the unit of length another; no number changes. The units of values taken of the coordinates follow.
void rename_unit(const Mesh& mesh, AnnotationSet& set, const std::string& fresh) {
    const std::string old = set.unit;
    set.unit = fresh;
    for (Annotation& annotation : set.annotations)
        for (Attribute& attribute : annotation.attributes) {
            if (attribute.type == AttributeType::measure) attribute.measure.unit = unit_after(attribute.measure.unit, old, fresh);
            if (attribute.type != AttributeType::descriptor) continue;
            std::string& unit = attribute.descriptor.unit;
            const bool computed = (old.empty() ? unit.empty() : unit == descriptor_unit(attribute.name, old)) &&
                                  evaluate(mesh, annotation, attribute.name);
            unit = computed ? descriptor_unit(attribute.name, fresh) : old.empty() ? unit : unit_after(unit, old, fresh);
        }
}

struct Edit {
    std::string mesh, annotations, output, list, annotation, tag, colour, note, id, object_class, unit, up;
    std::vector<std::string> attributes, remove_attributes, merge;
    bool duplicate = false, split = false, remove = false;
    CLI::Option *tag_given = nullptr, *note_given = nullptr, *class_given = nullptr, *unit_given = nullptr, *up_given = nullptr;
    ReadAnnotationsOptions reading;

    int run(const Session& session) const {
        const bool of_set = class_given->count() + unit_given->count() + up_given->count() > 0;
        if (list.empty() == annotation.empty() && !(of_set && list.empty()))
            fail_usage(
                "one annotation or a list of edits",
                "name an annotation with --annotation, or give --edits FILE, not both; or --set-class, --set-unit, --set-up");
        std::optional<std::array<double, 3>> direction;
        if (!up.empty()) direction = direction_of(up, "--set-up");
        std::vector<Path> inputs{mesh, annotations};
        if (!list.empty()) inputs.emplace_back(list);
        check_outputs(inputs, {output});
        Provenance provenance{"annotation edit", list_options(reading), {}};
        for (const Path& file : inputs) provenance.add_input(file);
        const MeshFile file = read_mesh(mesh);
        AnnotationSet set = read_annotations(annotations, file.mesh, reading);
        for (const auto& text : set.notes) session.note("note: " + text);
        AnnotationSet before;
        before.object_class = set.object_class;
        before.unit = set.unit;
        before.up = set.up;
        before.annotations = set.annotations;
        std::vector<AnnotationEdit> edits;
        if (!list.empty()) edits = read_edits(list);
        else if (!annotation.empty()) edits = {by_flags(provenance, set)};
        auto notes = edit_annotations(file.mesh, set, edits, list.empty() ? "flags" : list);
        for (const auto& [name, option, value] :
             {std::tuple{"set-class", class_given, &object_class}, {"set-unit", unit_given, &unit}, {"set-up", up_given, &up}})
            if (option->count() > 0) provenance.options.emplace_back(name, *value);
        if (class_given->count() > 0) set.object_class = object_class;
        if (up_given->count() > 0) set.up = direction;
        if (unit_given->count() > 0 && unit != set.unit) {
            rename_unit(file.mesh, set, unit);
            notes.push_back("the numbers stay as they are: the unit is that of the mesh's coordinates");
        }
        write_annotations(output, set, file.mesh, mesh, provenance);
        for (const auto& text : notes) session.note("note: " + text);
        print(session, provenance, set, differences(before, set), notes);
        return done;
    }

private:
    AnnotationEdit by_flags(Provenance& provenance, const AnnotationSet& set) const {
        AnnotationEdit edit;
        const auto remember = [&](const char* name, const std::string& value) { provenance.options.emplace_back(name, value); };
        remember("annotation", annotation);
        edit.annotation = name_of(annotation);
        // A tag may be a number as well.
        if (edit.annotation.id && set.find(*edit.annotation.id) == nullptr) edit.annotation.id.reset();
        if (tag_given->count() > 0) edit.tag = tag, remember("tag", tag);
        if (note_given->count() > 0) edit.note = note, remember("note", note);
        if (!colour.empty()) edit.colour = colour_of(colour), remember("colour", colour);
        if (!id.empty()) {
            edit.id = whole(id);
            if (!edit.id) fail_usage("the id '" + id + "' is not a whole number", "give a whole number");
            remember("id", id);
        }
        for (const auto& name : merge) edit.merge.push_back(name_of(name)), remember("merge", name);
        for (const auto& name : remove_attributes) {
            edit.remove_attributes.push_back(name_of(name));
            remember("remove-attribute", name);
        }
        for (const auto& text : attributes) {
            const std::size_t equals = text.find('=');
            if (equals == std::string::npos || equals == 0)
                fail_usage("the attribute '" + text + "' is not NAME=TEXT", "for measures and descriptors use --edits FILE");
            edit.texts.emplace_back(text.substr(0, equals), text.substr(equals + 1));
            remember("attribute", text);
        }
        if (duplicate) edit.duplicate = true, remember("duplicate", "true");
        if (split) edit.split = true, remember("split", "true");
        if (remove) edit.remove = true, remember("remove", "true");
        return edit;
    }

    static void print(const Session& session, const Provenance& provenance, const AnnotationSet& set,
                      const std::vector<Difference>& changes, const std::vector<std::string>& notes) {
        Json document(rapidjson::kObjectType);
        auto& allocator = document.GetAllocator();
        JsonValue result(rapidjson::kObjectType), entries(rapidjson::kArrayType), texts(rapidjson::kArrayType);
        std::vector<std::vector<std::string>> rows;
        for (const Difference& change : changes) {
            const std::string who = change.id ? std::to_string(*change.id) : "set";
            const std::string kind = change.kind == Difference::Kind::added     ? "added"
                                     : change.kind == Difference::Kind::removed ? "removed"
                                                                                : "changed";
            JsonValue entry(rapidjson::kObjectType);
            add_member(entry, "kind", kind, allocator);
            if (change.id) add_member(entry, "id", JsonValue(*change.id), allocator);
            add_member(entry, "field", change.field, allocator);
            add_member(entry, "before", change.before, allocator);
            add_member(entry, "after", change.after, allocator);
            entries.PushBack(entry, allocator);
            rows.push_back({who, change.tag, kind, change.field, change.before, change.after});
        }
        for (const auto& note : notes) texts.PushBack(json_string(note, allocator), allocator);
        add_member(result, "annotations", JsonValue(static_cast<std::uint64_t>(set.annotations.size())), allocator);
        add_member(result, "changes", std::move(entries), allocator);
        add_member(result, "notes", std::move(texts), allocator);
        if (session.json) session.print_report(provenance, document, result);
        else if (rows.empty()) std::cout << "nothing changed\n";
        else std::cout << table({"id", "tag", "what", "field", "before", "after"}, rows);
    }
};

}  // namespace

void add_annotation_edit(CLI::App& annotation, Session& session) {
    const auto edit = std::make_shared<Edit>();
    CLI::App* command =
        session.add(annotation, "edit",
                    "change tags, colours, ids, attributes, the file's class, unit and up; remove, duplicate, merge, split",
                    [&session, edit] { return edit->run(session); });
    command->add_option("mesh", edit->mesh, "mesh file")->required();
    command->add_option("annotations", edit->annotations, "its annotations (.ant.json)")->required();
    command->add_option("output", edit->output, "annotations to write")->required();
    command->add_option("--edits", edit->list, "list of edits (JSON, doc/schema/annotation-edits.schema.json)");
    command->add_option("--annotation", edit->annotation, "the annotation to edit: its id, or its tag if no other has it");
    command->add_option("--merge", edit->merge, "another annotation that becomes part of this one; may be given more than once")
        ->allow_extra_args(false);
    edit->tag_given = command->add_option("--tag", edit->tag, "new tag");
    edit->note_given = command->add_option("--note", edit->note, "new note");
    command->add_option("--colour", edit->colour, "new colour: 200,30,60 or #c81e3c");
    command->add_option("--id", edit->id, "new id");
    command->add_option("--remove-attribute", edit->remove_attributes, "id or name of an attribute to remove")
        ->allow_extra_args(false);
    command->add_option("--attribute", edit->attributes, "NAME=TEXT: a semantic attribute, new or changed")
        ->allow_extra_args(false);
    edit->class_given =
        command->add_option("--set-class", edit->object_class, "class of the object, of the whole file; '' for none");
    edit->unit_given =
        command->add_option("--set-unit", edit->unit,
                            "unit of the coordinates, of the whole file (any text, such as mm); no number changes; '' for none");
    edit->up_given = command->add_option("--set-up", edit->up, "x,y,z: upward direction, of the whole file; '' for none");
    command->add_flag("--duplicate", edit->duplicate, "add a copy; the other changes are made to the copy, the original stays");
    command->add_flag("--split", edit->split, "make each patch, poly-line or point an annotation of its own");
    command->add_flag("--remove", edit->remove, "remove the annotation");
    add_flags(command, edit->reading);
}

}  // namespace ostraka::app
