#include "ostraka/collection/objects.h"

#include "ostraka/core/csv.h"
#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/safe_path.h"
#include "ostraka/core/text.h"
#include "ostraka/core/words.h"

#include <algorithm>
#include <array>
#include <set>

namespace ostraka {

namespace {

constexpr std::array<const char*, 4> mesh_endings{".obj", ".ply", ".off", ".stl"};
constexpr const char* markup_ending = ".mrk.json";

/// Names become file names and appear in JSON: no folders, no hidden files, no terminal control characters, UTF-8.
bool is_name(const std::string& name) {
    return !name.empty() && name.size() <= 200 && name.front() != '.' && name.find_first_of("/\\") == std::string::npos &&
           printable(name) == name;
}
constexpr const char* name_rule =
    "use at most 200 bytes of UTF-8 without / \\ and control characters, not beginning with a full stop";

/// "a, b, c and 4 more"
std::string some_of(const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), 3); ++i)
        text += (i == 0 ? "'" : ", '") + printable(names[i], 60) + "'";
    return names.size() <= 3 ? text : text + " and " + std::to_string(names.size() - 3) + " more";
}

/// Checksum of the contents of all files of an object; empty if one cannot be read.
std::string checksum_of(const CollectionObject& object) {
    Sha256 hash;
    try {
        for (const Path& file : {object.mesh, object.annotations, object.landmarks}) {
            const std::string sum = file.empty() ? "-" : sha256_of_file(file);
            hash.update(sum.data(), sum.size());
        }
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::cancelled) throw;
        return {};
    }
    return hash.hexadecimal();
}

/// Whether `read_collection` would treat the file as part of an object, by its extension: a mesh, annotations or markups.
bool is_object_file(const Path& file) {
    const std::string name = file.filename().string();
    return name.front() != '.' && (name.ends_with(markup_ending) || name.ends_with(".ant.json") ||
                                   std::find(mesh_endings.begin(), mesh_endings.end(), extension(file)) != mesh_endings.end());
}

Collection from_folder(const Path& folder) {
    std::map<std::string, std::vector<Path>> meshes;
    std::map<std::string, Path> markups;
    std::set<std::string> annotations;
    Collection collection;
    std::vector<std::string> others;
    for (const std::string& name : files_in(folder, &others)) {
        const Path file = folder / name;
        if (name.front() == '.') continue;
        if (!is_memory(folder) && !is_inside(file, folder)) {
            if (is_object_file(file))
                collection.left_out.emplace_back(printable(name, 60), "is a link that leads out of the folder");
            continue;
        }
        if (name.ends_with(markup_ending)) markups[name.substr(0, name.size() - std::string(markup_ending).size())] = file;
        else if (name.ends_with(".ant.json")) annotations.insert(name);
        else if (std::find(mesh_endings.begin(), mesh_endings.end(), extension(file)) != mesh_endings.end())
            meshes[file.stem().string()].push_back(file);
    }
    for (const std::string& name : others)
        if (is_object_file(folder / name))
            collection.left_out.emplace_back(printable(name, 60), "is no file that can be read (is it a link to nothing?)");
    const auto add = [&](const std::string& name, const std::string& stem, const Path& mesh) {
        if (!is_name(name)) {
            collection.left_out.emplace_back(printable(name, 60),
                                             std::string("its name cannot be that of an object (") + name_rule + ")");
            return;
        }
        CollectionObject object;
        object.name = name;
        object.mesh = mesh;
        if (annotations.contains(stem + ".ant.json") && !mesh.empty()) object.annotations = folder / (stem + ".ant.json");
        if (const auto it = markups.find(stem); it != markups.end()) object.landmarks = it->second;
        collection.objects.push_back(std::move(object));
    };
    for (auto& [stem, files] : meshes) {
        std::sort(files.begin(), files.end());
        for (const Path& file : files) add(files.size() == 1 ? stem : file.filename().string(), stem, file);
    }
    for (const auto& [stem, file] : markups)
        if (!meshes.contains(stem)) add(stem, stem, {});
    std::sort(collection.left_out.begin(), collection.left_out.end());
    return collection;
}

Collection from_file(const Path& file) {
    const Json document = read_json(file);
    validate(document, "study", file.string());
    const Path folder = file.parent_path();
    const JsonValue& objects = *find_member(document, "objects");
    Collection collection;
    for (rapidjson::SizeType i = 0; i < objects.Size(); ++i) {
        const std::string at = "/objects/" + std::to_string(i);
        const auto file_of = [&](const char* member) {
            const std::string name = text_in(objects[i], member);
            if (name.empty()) return Path();
            return file_inside(name, folder, file.string(), at + "/" + member, "the folder of the collection",
                               "put the objects into the folder of the file that lists them");
        };
        CollectionObject object;
        object.mesh = file_of("mesh");
        object.annotations = file_of("annotations");
        object.landmarks = file_of("landmarks");
        object.unit = text_in(objects[i], "unit");
        object.label = text_in(objects[i], "label");
        if (object.mesh.empty() && object.landmarks.empty())
            fail_input(file.string(), "at " + at + ": neither a mesh nor landmarks", "give one of both");
        object.name = text_in(objects[i], "name");
        if (object.name.empty()) object.name = (object.mesh.empty() ? object.landmarks : object.mesh).stem().string();
        if (!is_name(object.name))
            fail_input(file.string() + ", at " + at, "'" + printable(object.name, 60) + "' cannot be the name of an object",
                       name_rule);
        collection.objects.push_back(std::move(object));
    }
    return collection;
}

void note_copies(Collection& collection) {
    std::map<std::string, std::vector<std::string>> same;
    for (const auto& object : collection.objects)
        if (!object.checksum.empty()) same[object.checksum].push_back(object.name);
    std::vector<std::string> lines;
    for (const auto& [checksum, names] : same) {
        if (names.size() < 2) continue;
        lines.push_back("the files of these objects are the same: " + joined(names));
    }
    std::sort(lines.begin(), lines.end());
    collection.notes.insert(collection.notes.end(), lines.begin(), lines.end());
}

}  // namespace

void check_new_collection(const Path& folder) {
    if (!is_folder(folder)) return;
    std::vector<std::string> there = files_in(folder);
    std::erase_if(there, [](const std::string& name) { return !is_object_file(name) && extension(name) != ".csv"; });
    if (there.empty()) return;
    throw Error(
        ErrorKind::failure, folder.string(),
        "the folder holds objects or tables already (" + std::to_string(there.size()) + ", such as '" + there.front() + "')",
        "name a folder that is new or empty, so that made objects are not mixed with others");
}

Collection read_collection(const Path& folder_or_file, const Share& share) {
    const std::string where = folder_or_file.string();
    const bool folder = is_folder(folder_or_file);
    if (!folder && !file_exists(folder_or_file)) fail_input(where, "there is no such folder or file", "check the name");
    if (!folder && extension(folder_or_file) != ".json")
        fail_input(where, "is no collection", "name a folder of meshes, or a file *.study.json");
    Collection collection = folder ? from_folder(folder_or_file) : from_file(folder_or_file);
    if (collection.objects.empty() && !collection.left_out.empty())
        fail_input(where, "not one of its files can be an object",
                   "the first, '" + collection.left_out.front().first + "': " + collection.left_out.front().second);
    if (collection.objects.empty())
        fail_input(
            where, "there is no object in it",
            folder ? "put meshes (OBJ, PLY, OFF, STL) or markups (.mrk.json) directly into the folder" : "list at least one");
    std::sort(collection.objects.begin(), collection.objects.end(),
              [](const CollectionObject& a, const CollectionObject& b) { return a.name < b.name; });
    for (std::size_t i = 1; i < collection.objects.size(); ++i)
        if (collection.objects[i].name == collection.objects[i - 1].name)
            fail_input(where, "two objects have the name '" + collection.objects[i].name + "'", "give each a name of its own");
    parallel_for(
        collection.objects.size(),
        [&](std::size_t i) {
            if (share.has(i)) collection.objects[i].checksum = checksum_of(collection.objects[i]);
        },
        1);
    note_copies(collection);
    return collection;
}

std::map<std::string, std::string> read_labels(const Path& file, const std::string& column) {
    const std::string text = read_file(file), where = file.string();
    const auto rows = csv_rows(text, csv_separator(text), where);
    if (rows.size() < 2)
        fail_input(where, "there are no labels in it", "write a row with the columns' names, then a row an object");
    const auto& names = rows.front().cells;
    const auto column_of = [&](const std::string& wanted) {
        std::string there;
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (trimmed(names[i]) == wanted) return i;
            there += (i == 0 ? "'" : ", '") + printable(names[i], 60) + "'";
        }
        fail_input(
            where + ", line " + std::to_string(rows.front().line),
            "there is no column '" + printable(wanted, 60) + "' among " + there,
            "the first row names the columns: 'name' for the objects, 'label' (or that of --truth-column) for the answers");
    };
    const std::size_t name_column = column_of("name"), label_column = column_of(column.empty() ? "label" : column);
    std::map<std::string, std::string> labels;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const auto& cells = rows[i].cells;
        const std::string at = where + ", line " + std::to_string(rows[i].line);
        if (cells.size() <= std::max(name_column, label_column)) fail_input(at, "too few cells", "give every row all columns");
        const std::string name = unguarded(std::string(trimmed(cells[name_column])));
        if (!labels.emplace(name, unguarded(std::string(trimmed(cells[label_column])))).second)
            fail_input(at, "the object '" + without_controls(name, "?") + "' has a label already", "remove one of both");
    }
    return labels;
}

void set_labels(Collection& collection, const std::map<std::string, std::string>& labels, const std::string& where) {
    std::set<std::string> met;
    std::size_t without = 0;
    for (auto& object : collection.objects) {
        const auto it = labels.find(object.name);
        object.label = it == labels.end() ? std::string() : it->second;
        if (it != labels.end()) met.insert(it->first);
        if (object.label.empty()) ++without;
    }
    if (without == collection.objects.size()) {
        std::vector<std::string> labelled, objects;
        for (const auto& [name, label] : labels) labelled.push_back(name);
        for (const auto& object : collection.objects) objects.push_back(object.name);
        fail_input(where,
                   met.empty() ? "no label is of an object: there are labels of " + some_of(labelled) + ", and objects " +
                                     some_of(objects)
                               : "the labels of all objects are empty (" + some_of(objects) + ")",
                   "name the objects as their files are named, without the ending");
    }
    if (without > 0) collection.notes.push_back(std::to_string(without) + " objects have no label");
    for (const auto& [name, label] : labels)
        if (!met.contains(name))
            collection.notes.push_back("there is a label for '" + without_controls(name, "?") + "', but no such object");
}

}  // namespace ostraka
