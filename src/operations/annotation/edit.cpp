// annotation edit
#include "operations/annotation/differences.h"
#include "operations/operations.h"

#include "ostraka/interchange/edit.h"

#include <fmt/core.h>

#include <charconv>

namespace ostraka {

namespace {

/// Parses an id, or a tag or name.
EntryName entry_name(const std::string& text) {
    int value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_number = !text.empty() && code == std::errc() && end == text.data() + text.size();
    return {is_number ? std::optional(value) : std::nullopt, text};
}

/// Parses a colour: "200,30,60", "200 30 60" or "#c81e3c".
std::array<int, 3> named_colour(const std::string& text) {
    std::array<int, 3> colour{};
    const bool hexadecimal = text.size() == 7 && text[0] == '#';
    bool valid = true;
    const char *place = text.data() + (hexadecimal ? 1 : 0), *const end = text.data() + text.size();
    for (std::size_t k = 0; k < 3; ++k) {
        while (!hexadecimal && place != end && (*place == ' ' || (*place == ',' && k > 0))) ++place;
        const auto [next, code] = std::from_chars(place, hexadecimal ? place + 2 : end, colour[k], hexadecimal ? 16 : 10);
        valid = valid && code == std::errc() && colour[k] >= 0 && colour[k] <= 255 && (!hexadecimal || next == place + 2);
        place = next;
    }
    while (place != end && *place == ' ') ++place;
    if (!valid || place != end)
        fail_usage(fmt::format("the colour '{}' is not valid", printable(text, 60)),
                   "give red, green and blue from 0 to 255 as 200,30,60 or #c81e3c");
    return colour;
}

struct AnnotationEditing final : AnnotatedMeshOperation {
    void declare(Parameters& p) override {
        declare_inputs(p);
        p.output("output", Kind::annotations, output, "annotations to write (.ant.json)");
        p.input_option("edits", Kind::edit, edits_file, "list of edits (JSON, doc/schema/annotation-edits.schema.json)");
        p.options("annotation", annotation, "annotation to edit: its id, or its tag if no other annotation has the same tag");
        p.options("merge", merge, "id or tag of an annotation that is merged into the annotation of --annotation; repeatable");
        p.options("tag", tag, "new tag of the annotation");
        p.options("note", note, "new note of the annotation");
        p.options("colour", colour, "new colour: 200,30,60 or #c81e3c");
        p.options("id", id, "new id of the annotation");
        p.options("remove-attribute", remove_attributes, "id or name of an attribute to remove; may be given more than once");
        p.options("attribute", attributes, "NAME=TEXT: a semantic attribute to add or change; may be given more than once");
        p.options("information", information,
                  "KIND=VALUE with KIND text, image, link or file: information to which the annotation refers; the checksum of a "
                  "local file is stored; may be given more than once");
        p.options("remove-information", remove_information,
                  "text, link or file to remove from the annotation; may be given more than once");
        p.options("set-class", object_class, "class of the object of the whole file; '' removes it");
        p.options("set-unit", unit, "unit of the coordinates (any text, such as mm); numbers are not converted; '' removes it");
        p.options("set-up", up, "upward direction of the whole file; '' removes it", direction_words("--set-up"));
        p.options("duplicate", duplicate, "add a copy of the annotation; the other changes apply only to the copy");
        p.options("split", split, "make each patch, poly-line or point a separate annotation");
        p.options("remove", remove, "remove the annotation");
        p.report.values(integer("annotations"));
        declare_differences(p.report, "changes");
    }

    void check() const override {
        const bool changes_set = object_class || unit || up;
        if (static_cast<bool>(edits_file) == !annotation.empty() && !(changes_set && !edits_file))
            fail_usage(
                "either one annotation or a list of edits is needed",
                "name an annotation with --annotation, or give --edits FILE, not both; or --set-class, --set-unit, --set-up");
        if (tag && (trimmed(*tag).empty() || printable(*tag) != *tag))
            fail_usage(fmt::format("--tag is '{}'", printable(*tag, 60)), "give a tag of printable characters");
        if (!annotation.empty()) static_cast<void>(by_options());
    }

    void run(Context&, Report& report) override {
        const Mesh& surface = mesh->mesh;
        const AnnotationSet& before = set();
        AnnotationSet edited = before;
        std::vector<AnnotationEdit> edits;
        if (edits_file) edits = edits_file.load<std::vector<AnnotationEdit>>(read_edits);
        else if (!annotation.empty()) edits = {by_options()};
        // A number may also be a tag.
        if (!edits_file && !edits.empty() && edits[0].annotation.id && edited.find(*edits[0].annotation.id) == nullptr)
            edits[0].annotation.id.reset();
        for (AnnotationEdit& edit : edits)
            for (Information& information_entry : edit.information)
                if (information_entry.is_local() && information_entry.sha256.empty())
                    information_entry.sha256 = sha256_of_file(beside_output(information_entry.value));
        std::vector<std::string> notes = edit_annotations(surface, edited, edits, edits_file ? edits_file.file() : "flags");
        if (object_class) edited.object_class = *object_class;
        if (up) edited.up = direction();
        if (unit && *unit != edited.unit) {
            change_length_unit(surface, edited, *unit);
            notes.emplace_back("numbers are not converted: the unit names the unit of the mesh's coordinates");
        }
        report.notes(notes);
        report("annotations", edited.annotations.size());
        add_differences(report, "changes", differences(before, edited), "nothing changed");
        output.write(std::move(edited), surface, mesh.file());
    }

    /// Parses "image=photo.jpg".
    static Information referred(const std::string& text) {
        const std::size_t equals = text.find('=');
        Information entry;
        bool is_known_kind = false;
        for (const auto kind :
             {Information::Kind::text, Information::Kind::image, Information::Kind::link, Information::Kind::file})
            if (equals != std::string::npos && to_string(kind) == text.substr(0, equals)) entry.kind = kind, is_known_kind = true;
        if (!is_known_kind || equals + 1 == text.size())
            fail_usage(fmt::format("the information '{}' is not KIND=VALUE", printable(text, 60)),
                       "KIND is text, image, link or file: image=photo.jpg");
        entry.value = text.substr(equals + 1);
        return entry;
    }
    /// Resolves a file relative to the annotations that refer to it.
    [[nodiscard]] Path beside_output(const std::string& value) const {
        const Path file(value);
        return file.is_absolute() || output.file().empty() ? file : Path(output.file()).parent_path() / file;
    }

    [[nodiscard]] std::optional<std::array<double, 3>> direction() const {
        if (!up || up->empty()) return {};
        return direction_of(*up, "--set-up");
    }

    [[nodiscard]] AnnotationEdit by_options() const {
        AnnotationEdit edit;
        edit.annotation = entry_name(annotation);
        edit.tag = tag;
        edit.note = note;
        if (!colour.empty()) edit.colour = named_colour(colour);
        edit.id = id;
        for (const auto& name : merge) edit.merge.push_back(entry_name(name));
        for (const auto& name : remove_attributes) edit.remove_attributes.push_back(entry_name(name));
        for (const auto& text : attributes) {
            const std::size_t equals = text.find('=');
            if (equals == std::string::npos || equals == 0)
                fail_usage(fmt::format("the attribute '{}' is not NAME=TEXT", text),
                           "for measures and descriptors use --edits FILE");
            edit.texts.emplace_back(text.substr(0, equals), text.substr(equals + 1));
        }
        for (const auto& text : information) edit.information.push_back(referred(text));
        edit.remove_information = remove_information;
        edit.duplicate = duplicate;
        edit.split = split;
        edit.remove = remove;
        return edit;
    }

    AnnotationsOutput output;
    FileInput edits_file;
    std::string annotation, colour;
    std::optional<std::string> tag, note, object_class, unit, up;
    std::optional<int> id;
    std::vector<std::string> attributes, remove_attributes, merge, information, remove_information;
    bool duplicate = false, split = false, remove = false;
};

}  // namespace

std::unique_ptr<Operation> make_annotation_edit() { return make<AnnotationEditing>(); }

}  // namespace ostraka
