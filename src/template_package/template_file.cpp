// *.template.json
#include "ostraka/coords/coordinate_file.h"
#include "ostraka/core/error.h"
#include "ostraka/files/json_build.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/template_package/template.h"

#include <fmt/core.h>

#include <algorithm>

namespace ostraka {

namespace {

using std::to_string;

/// Path of a named part.
Path locate(const std::string& name, const Path& folder, bool allow_outside, const std::string& where,
            const std::string& pointer) {
    require_file_name(name, where, pointer);
    if (allow_outside) return folder / Path(name);
    return file_inside(
        name, folder, where, pointer, "the template's folder",
        "move the part into the template's folder ('template pack --copy' does so), or allow it with --allow-outside");
}

}  // namespace

const std::vector<std::string>& template_roles() {
    static const std::vector<std::string> roles{"mesh",       "annotations", "graph",  "cage",     "coordinates",
                                                "vocabulary", "rules",       "ranges", "landmarks"};
    return roles;
}

std::vector<const PackagedFile*> TemplateFile::of(const std::string& role) const {
    std::vector<const PackagedFile*> parts;
    for (const PackagedFile& part : contents)
        if (part.role == role) parts.push_back(&part);
    return parts;
}

TemplateFile template_from_json(const JsonValue& document, const Path& folder, const std::string& where,
                                const TemplateOptions& options) {
    check_format(document, "ostraka-template", where, "give a template ('ostraka-template')");
    validate(document, "template", where);
    TemplateFile result;
    result.object_class = text_in(document, "class");
    result.unit = text_in(document, "unit");
    if (const JsonValue* up = find_member(document, "up")) {
        result.up = triple_of(*up);
        if (result.up == std::array<double, 3>{0, 0, 0})
            fail_input(where, "at /up: the upward direction is zero", "give a direction such as [0, 0, 1]");
    }
    for (const std::string& role : template_roles()) {
        const JsonValue* value = find_member(document, role);
        if (value == nullptr) continue;
        const auto add = [&](const JsonValue& name, const std::string& pointer) {
            result.contents.push_back(
                {role, text_of(name), locate(text_of(name), folder, options.allow_outside, where, pointer), {}});
        };
        if (value->IsString()) add(*value, "/" + role);
        else
            for (rapidjson::SizeType i = 0; i < value->Size(); ++i) add((*value)[i], fmt::format("/{}/{}", role, i));
    }
    if (const JsonValue* checksums = find_member(document, "checksums"))
        for (const auto& member : checksums->GetObject()) {
            bool is_part = false;
            for (PackagedFile& part : result.contents)
                if (part.name == text_of(member.name)) part.sha256 = text_of(member.value), is_part = true;
            if (!is_part)
                fail_input(where, fmt::format("at /checksums: '{}' is not a part of the template", text_of(member.name)),
                           "name an existing part, or remove it");
        }
    return result;
}

TemplateFile read_template(const Path& file, const TemplateOptions& options) {
    const Path folder = file.has_parent_path() ? file.parent_path() : Path(".");
    return template_from_json(read_json(file), folder, file.string(), options);
}

Json template_to_json(const TemplateFile& file, const Provenance& provenance) {
    Json document = json_document("template");
    auto& allocator = document.GetAllocator();
    add_nonempty_members(document, allocator, "class", file.object_class, "unit", file.unit, "up", file.up);
    JsonValue checksums(rapidjson::kObjectType);
    for (const std::string& role : template_roles()) {
        const auto parts = file.of(role);
        if (parts.size() == 1) add_member(document, role, parts.front()->name, allocator);
        else
            add_nonempty_members(document, allocator, role,
                                 json_list(parts, allocator, [](const auto* part) { return part->name; }));
        for (const PackagedFile* part : parts)
            if (find_member(checksums, part->name) == nullptr)
                add_nonempty_members(checksums, allocator, part->name, part->sha256);
    }
    add_nonempty_members(document, allocator, "checksums", std::move(checksums));
    add_members(document, allocator, "provenance", provenance.to_json(allocator));
    return document;
}

void TemplateOptions::declare_options(OptionList& list) {
    list("allow-outside", allow_outside, "allow the template to refer to files outside of its folder", Anything{});
    list("force-mesh", force_mesh, "accept annotations made for another mesh if all their vertices, faces and edges exist here",
         Anything{});
}

std::string part_name(const Path& folder, const Path& part) {
    std::error_code code;
    const Path home = std::filesystem::weakly_canonical(std::filesystem::absolute(folder), code);
    const Path file = std::filesystem::weakly_canonical(std::filesystem::absolute(part), code);
    const Path relative = file.lexically_relative(home);
    return (relative.empty() ? file : relative).generic_string();
}

TemplateFile copy_template(const TemplateFile& file, const Path& folder, const std::string& name, const Provenance& provenance) {
    TemplateFile copy = file;
    const WriteScope written(folder);
    for (PackagedFile& part : copy.contents) {
        part.name = part.file.filename().string();
        if (std::any_of(copy.contents.begin(), copy.contents.end(), [&](const PackagedFile& other) {
                return &other < &part && other.name == part.name && other.file != part.file;
            }))
            fail_input("template", fmt::format("two of its parts from different folders have the name '{}'", part.name),
                       "rename one of them");
        const Path target = folder / part.name;
        const std::string bytes = read_file(part.file);
        if (!same_place(target, part.file)) {
            write_file(target, bytes);
            // Coordinates are read with their header, sparse ones also with their index files.
            if (extension(part.file) == ".npy")
                for (const Path& companion :
                     {coordinate_header_file(part.file), sparse_columns_file(part.file), sparse_rows_file(part.file)})
                    if (file_exists(companion) && is_inside(companion, part.file.parent_path()))
                        write_file(folder / companion.filename().string(), read_file(companion));
        }
        part.sha256 = sha256(bytes);
        part.file = target;
    }
    write_json(folder / name, template_to_json(copy, provenance));
    return copy;
}

}  // namespace ostraka
