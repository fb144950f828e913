#include "ostraka/collection/objects.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/csv.h"
#include "ostraka/files/safe_path.h"
#include "ostraka/interchange/specimens.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <set>

namespace ostraka {

namespace {

constexpr std::array<const char*, 7> mesh_endings{".obj", ".ply", ".off", ".stl", ".glb", ".gltf", ".3mf"};
/// Endings of files that are left out beside a mesh of the same name: operations write GLB files for viewers beside their meshes.
constexpr std::array<const char*, 2> viewer_endings{".glb", ".gltf"};
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
        text += fmt::format("{}{}'", i == 0 ? "'" : ", '", printable(names[i], 60));
    return names.size() <= 3 ? text : fmt::format("{} and {} more", text, names.size() - 3);
}

/// Checksum of the contents of all files of an object; empty if one cannot be read.
std::string checksum_of(const CollectionObject& object) {
    Sha256 hash;
    try {
        for (const Path& file : {object.mesh, object.annotations, object.landmarks}) {
            const std::string checksum = file.empty() ? "-" : sha256_of_file(file);
            hash.update(checksum.data(), checksum.size());
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

/// The name without the ending of a landmark file; empty for other files, and for tables that hold no landmarks.
std::string landmark_stem(const Path& folder, const std::string& name) {
    if (!is_specimen_file(name)) return {};
    const std::string ending = extension(name);
    if (ending == ".csv" || ending == ".txt") {
        try {
            static_cast<void>(read_specimens(folder / name));
        } catch (const Error&) {
            return {};
        }
    }
    const std::string stem = Path(name).stem().string();
    return ending == ".json" ? Path(stem).stem().string() : stem;
}

Collection from_folder(const Path& folder, bool landmark_files) {
    std::map<std::string, std::vector<Path>> meshes;
    std::map<std::string, Path> markups;
    std::vector<std::pair<std::string, Path>> further_landmarks;
    std::set<std::string> annotations;
    Collection collection;
    std::vector<std::string> unreadable;
    for (const std::string& name : files_in(folder, &unreadable)) {
        const Path file = folder / name;
        if (name.front() == '.') continue;
        if (!is_memory(folder) && !is_inside(file, folder)) {
            if (is_object_file(file))
                collection.left_out.emplace_back(printable(name, 60), "is a link that leads out of the folder");
            continue;
        }
        if (name.ends_with(markup_ending)) markups[name.substr(0, name.size() - std::string(markup_ending).size())] = file;
        else if (const std::string stem = landmark_files ? landmark_stem(folder, name) : std::string(); !stem.empty())
            further_landmarks.emplace_back(stem, file);
        else if (name.ends_with(".ant.json")) annotations.insert(name);
        else if (std::find(mesh_endings.begin(), mesh_endings.end(), extension(file)) != mesh_endings.end())
            meshes[file.stem().string()].push_back(file);
    }
    std::sort(further_landmarks.begin(), further_landmarks.end());
    for (const auto& [stem, file] : further_landmarks)
        if (!markups.emplace(stem, file).second)
            collection.notes.push_back(fmt::format("'{}' is not read: '{}' has the landmarks of this object",
                                                   printable(file.filename().string(), 60),
                                                   printable(markups.at(stem).filename().string(), 60)));
    for (const std::string& name : unreadable)
        if (is_object_file(folder / name))
            collection.left_out.emplace_back(printable(name, 60), "is not a readable file (check whether it is a broken link)");
    const auto add = [&](const std::string& name, const std::string& stem, const Path& mesh) {
        if (!is_name(name)) {
            collection.left_out.emplace_back(printable(name, 60),
                                             fmt::format("its name is not valid for an object ({})", name_rule));
            return;
        }
        CollectionObject object;
        object.name = name;
        object.mesh = mesh;
        if (annotations.contains(stem + ".ant.json") && !mesh.empty()) object.annotations = folder / (stem + ".ant.json");
        if (const auto landmark_file = markups.find(stem); landmark_file != markups.end())
            object.landmarks = landmark_file->second;
        collection.objects.push_back(std::move(object));
    };
    for (auto& [stem, files] : meshes) {
        std::sort(files.begin(), files.end());
        const auto is_for_viewers = [](const Path& file) {
            return std::find(viewer_endings.begin(), viewer_endings.end(), extension(file)) != viewer_endings.end();
        };
        if (!std::all_of(files.begin(), files.end(), is_for_viewers)) std::erase_if(files, is_for_viewers);
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
            return file_inside(name, folder, file.string(), fmt::format("{}/{}", at, member), "the folder of the collection",
                               "put the objects into the folder of the file that lists them");
        };
        CollectionObject object;
        object.mesh = file_of("mesh");
        object.annotations = file_of("annotations");
        object.landmarks = file_of("landmarks");
        object.unit = text_in(objects[i], "unit");
        object.label = text_in(objects[i], "label");
        if (object.mesh.empty() && object.landmarks.empty())
            fail_input(file.string(), fmt::format("at {}: the object has neither a mesh nor landmarks", at),
                       "give a mesh, landmarks or both");
        object.name = text_in(objects[i], "name");
        if (object.name.empty()) object.name = (object.mesh.empty() ? object.landmarks : object.mesh).stem().string();
        if (!is_name(object.name))
            fail_input(fmt::format("{}, at {}", file.string(), at),
                       fmt::format("'{}' is not a valid name of an object", printable(object.name, 60)), name_rule);
        collection.objects.push_back(std::move(object));
    }
    return collection;
}

void note_copies(Collection& collection) {
    std::map<std::string, std::vector<std::string>> names_by_checksum;
    for (const auto& object : collection.objects)
        if (!object.checksum.empty()) names_by_checksum[object.checksum].push_back(object.name);
    std::vector<std::string> lines;
    for (const auto& [checksum, names] : names_by_checksum) {
        if (names.size() < 2) continue;
        lines.push_back("the files of these objects are the same: " + joined(names));
    }
    std::sort(lines.begin(), lines.end());
    collection.notes.insert(collection.notes.end(), lines.begin(), lines.end());
}

}  // namespace

void check_new_collection(const Path& folder) {
    if (!is_folder(folder)) return;
    std::vector<std::string> object_files = files_in(folder);
    std::erase_if(object_files, [](const std::string& name) { return !is_object_file(name) && extension(name) != ".csv"; });
    if (object_files.empty()) return;
    throw Error(
        ErrorKind::failure, folder.string(),
        fmt::format("the folder already contains {} objects or tables, such as '{}'", object_files.size(), object_files.front()),
        "name a new or empty folder, so that synthetic objects are not mixed with others");
}

namespace {

/// A landmark file as the only object of a collection.
Collection from_landmark_file(const Path& file) {
    CollectionObject object;
    object.landmarks = file;
    object.name = file.stem().string();
    if (file.string().ends_with(markup_ending)) object.name = Path(object.name).stem().string();
    if (!is_name(object.name)) object.name = "specimens";
    Collection collection;
    collection.objects.push_back(std::move(object));
    return collection;
}

Collection read_any(const Path& folder_or_file, const Share& share, bool landmark_files) {
    const std::string where = folder_or_file.string();
    const bool folder = is_folder(folder_or_file);
    if (!folder && !file_exists(folder_or_file)) fail_input(where, "the folder or file does not exist", "check the name");
    const bool landmarks = !folder && landmark_files && is_specimen_file(folder_or_file);
    if (!folder && !landmarks && extension(folder_or_file) != ".json")
        fail_input(where, "is not a collection",
                   landmark_files ? "name a folder, a landmark file, or a file *.study.json"
                                  : "name a folder of meshes, or a file *.study.json");
    Collection collection = folder      ? from_folder(folder_or_file, landmark_files)
                            : landmarks ? from_landmark_file(folder_or_file)
                                        : from_file(folder_or_file);
    if (collection.objects.empty() && !collection.left_out.empty())
        fail_input(
            where, "none of its files is a valid object",
            fmt::format("the first error, for '{}': {}", collection.left_out.front().first, collection.left_out.front().second));
    if (collection.objects.empty())
        fail_input(
            where, "contains no objects",
            folder ? "put meshes (OBJ, PLY, OFF, STL) or markups (.mrk.json) directly into the folder" : "list at least one");
    std::sort(collection.objects.begin(), collection.objects.end(),
              [](const CollectionObject& a, const CollectionObject& b) { return a.name < b.name; });
    for (std::size_t i = 1; i < collection.objects.size(); ++i)
        if (collection.objects[i].name == collection.objects[i - 1].name)
            fail_input(where, fmt::format("two objects have the name '{}'", collection.objects[i].name),
                       "give each object its own name");
    parallel_for(collection.objects.size(), 1, [&](std::size_t i) {
        if (share.has(i)) collection.objects[i].checksum = checksum_of(collection.objects[i]);
    });
    note_copies(collection);
    return collection;
}

}  // namespace

Collection read_collection(const Path& folder_or_file, const Share& share) { return read_any(folder_or_file, share, false); }

Collection read_landmark_collection(const Path& folder_or_file, const Share& share) {
    return read_any(folder_or_file, share, true);
}

std::map<std::string, std::string> read_labels(const Path& file, const std::string& column) {
    const std::string text = read_file(file), where = file.string();
    const auto rows = csv_rows(text, csv_separator(text), where);
    if (rows.size() < 2) fail_input(where, "contains no labels", "write one row with the column names, then one row per object");
    const auto& names = rows.front().cells;
    const auto column_of = [&](const std::string& wanted_column) {
        std::string column_names;
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (trimmed(names[i]) == wanted_column) return i;
            column_names += fmt::format("{}{}'", i == 0 ? "'" : ", '", printable(names[i], 60));
        }
        fail_input(fmt::format("{}, line {}", where, rows.front().line),
                   fmt::format("there is no column '{}'; the columns are {}", printable(wanted_column, 60), column_names),
                   "name the columns in the first row: 'name' for the objects, 'label' (or the name given by --truth-column) for "
                   "the labels");
    };
    const std::size_t name_column = column_of("name"), label_column = column_of(column.empty() ? "label" : column);
    std::map<std::string, std::string> labels;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        const auto& cells = rows[i].cells;
        const std::string at = fmt::format("{}, line {}", where, rows[i].line);
        if (cells.size() <= std::max(name_column, label_column))
            fail_input(at, "the row has too few cells", "give every row a cell for each column");
        const std::string name = unescape_formula(std::string(trimmed(cells[name_column])));
        if (!labels.emplace(name, unescape_formula(std::string(trimmed(cells[label_column])))).second)
            fail_input(at, fmt::format("the object '{}' has two labels", without_controls(name, "?")), "remove one of them");
    }
    return labels;
}

void set_labels(Collection& collection, const std::map<std::string, std::string>& labels, const std::string& where) {
    std::set<std::string> matched_names;
    std::size_t unlabelled = 0;
    for (auto& object : collection.objects) {
        const auto entry = labels.find(object.name);
        object.label = entry == labels.end() ? std::string() : entry->second;
        if (entry != labels.end()) matched_names.insert(entry->first);
        if (object.label.empty()) ++unlabelled;
    }
    if (unlabelled == collection.objects.size()) {
        std::vector<std::string> labelled, objects;
        for (const auto& [name, label] : labels) labelled.push_back(name);
        for (const auto& object : collection.objects) objects.push_back(object.name);
        fail_input(where,
                   matched_names.empty() ? fmt::format("no label belongs to an object: the labels are for {}, the objects are {}",
                                                       some_of(labelled), some_of(objects))
                                         : fmt::format("the labels of all objects are empty ({})", some_of(objects)),
                   "use the file names of the objects, without their endings");
    }
    if (unlabelled > 0) collection.notes.push_back(std::to_string(unlabelled) + " objects have no label");
    for (const auto& [name, label] : labels)
        if (!matched_names.contains(name))
            collection.notes.push_back(
                fmt::format("there is a label for '{}', which is not an object of the collection", without_controls(name, "?")));
}

}  // namespace ostraka
