#include "ostraka/collection/objects.h"

#include "ostraka/core/csv.h"
#include "ostraka/core/error.h"
#include "ostraka/core/inside.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/provenance.h"
#include "ostraka/core/text.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <new>
#include <set>

namespace ostraka {

namespace fs = std::filesystem;

namespace {

constexpr std::array<const char*, 4> mesh_endings{".obj", ".ply", ".off", ".stl"};
constexpr const char* markup_ending = ".mrk.json";

/// Names become names of files: no folders, nothing hidden, nothing a terminal would act on.
void check_name(const std::string& name, const std::string& where) {
    const bool good = !name.empty() && name.size() <= 200 && name.front() != '.' && name.find('/') == std::string::npos &&
                      name.find('\\') == std::string::npos && without_controls(name, "") == name;
    if (!good)
        fail_input(where, "'" + without_controls(name.substr(0, 60), "?") + "' cannot be the name of an object",
                   "use at most 200 characters without / and \\ that do not begin with a full stop");
}

std::string text_of(const JsonValue& object, const char* member) {
    const JsonValue* value = find_member(object, member);
    return value == nullptr || !value->IsString() ? std::string() : std::string(value->GetString(), value->GetStringLength());
}

/// The contents of all files of an object; empty if one cannot be read.
std::string checksum_of(const CollectionObject& object) {
    Sha256 hash;
    try {
        for (const Path& file : {object.mesh, object.annotations, object.landmarks}) {
            const std::string sum = file.empty() ? "-" : sha256_of_file(file);
            hash.update(sum.data(), sum.size());
        }
    } catch (const Error&) {
        return {};
    }
    return hash.hexadecimal();
}

Collection from_folder(const Path& folder) {
    std::map<std::string, std::vector<Path>> meshes;
    std::map<std::string, Path> markups;
    std::set<std::string> annotations;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (!entry.is_regular_file() || name.front() == '.') continue;
        if (name.ends_with(markup_ending))
            markups[name.substr(0, name.size() - std::string(markup_ending).size())] = entry.path();
        else if (name.ends_with(".ant.json")) annotations.insert(name);
        else if (std::find(mesh_endings.begin(), mesh_endings.end(), extension(entry.path())) != mesh_endings.end())
            meshes[entry.path().stem().string()].push_back(entry.path());
    }
    Collection collection;
    const auto add = [&](const std::string& name, const std::string& stem, const Path& mesh) {
        check_name(name, folder.string());
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
            const std::string name = text_of(objects[i], member);
            if (name.empty()) return Path();
            require_file_name(name, file.string(), at + "/" + member);
            return folder / name;
        };
        CollectionObject object;
        object.mesh = file_of("mesh");
        object.annotations = file_of("annotations");
        object.landmarks = file_of("landmarks");
        object.unit = text_of(objects[i], "unit");
        object.label = text_of(objects[i], "label");
        if (object.mesh.empty() && object.landmarks.empty())
            fail_input(file.string(), "at " + at + ": neither a mesh nor landmarks", "give one of both");
        object.name = text_of(objects[i], "name");
        if (object.name.empty()) object.name = (object.mesh.empty() ? object.landmarks : object.mesh).stem().string();
        check_name(object.name, file.string() + ", at " + at);
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
        std::string line;
        for (const auto& name : names) line += (line.empty() ? "" : ", ") + name;
        lines.push_back("the files of these objects are the same: " + line);
    }
    std::sort(lines.begin(), lines.end());
    collection.notes.insert(collection.notes.end(), lines.begin(), lines.end());
}

}  // namespace

Collection read_collection(const Path& folder_or_file) {
    const std::string where = folder_or_file.string();
    std::error_code code;
    const bool folder = fs::is_directory(folder_or_file, code);
    if (!folder && !fs::exists(folder_or_file, code)) fail_input(where, "there is no such folder or file", "check the name");
    if (!folder && extension(folder_or_file) != ".json")
        fail_input(where, "is no collection", "name a folder of meshes, or a file *.study.json");
    Collection collection = folder ? from_folder(folder_or_file) : from_file(folder_or_file);
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
        collection.objects.size(), [&](std::size_t i) { collection.objects[i].checksum = checksum_of(collection.objects[i]); },
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
    const auto find = [&](const std::string& name, std::size_t otherwise) {
        for (std::size_t i = 0; i < names.size(); ++i)
            if (trimmed(names[i]) == name) return i;
        return otherwise;
    };
    const std::size_t name_column = find("name", 0);
    const std::size_t none = names.size();
    const std::size_t label_column =
        column.empty() ? find("label", name_column == 0 ? std::size_t{1} : std::size_t{0}) : find(column, none);
    if (label_column >= names.size())
        fail_input(where + ", line " + std::to_string(rows.front().line),
                   column.empty() ? "there is one column only" : "there is no column '" + without_controls(column, "?") + "'",
                   "name the columns in the first row, and the one meant");
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

void set_labels(Collection& collection, const std::map<std::string, std::string>& labels) {
    std::set<std::string> met;
    std::size_t without = 0;
    for (auto& object : collection.objects) {
        const auto it = labels.find(object.name);
        object.label = it == labels.end() ? std::string() : it->second;
        if (it != labels.end()) met.insert(it->first);
        if (object.label.empty()) ++without;
    }
    if (without > 0) collection.notes.push_back(std::to_string(without) + " objects have no label");
    for (const auto& [name, label] : labels)
        if (!met.contains(name))
            collection.notes.push_back("there is a label for '" + without_controls(name, "?") + "', but no such object");
}

ResultStore::ResultStore(Path folder) : folder_(std::move(folder)) {}

std::string ResultStore::key(const std::vector<std::string>& parts) {
    Sha256 hash;
    const auto add = [&](const std::string& text) {
        const std::string length = std::to_string(text.size()) + ":";
        hash.update(length.data(), length.size());
        hash.update(text.data(), text.size());
    };
    add(version());
    for (const auto& part : parts) add(part);
    return hash.hexadecimal();
}

std::optional<Json> ResultStore::find(const std::string& name, const std::string& key) const {
    if (folder_.empty()) return {};
    const Path file = folder_ / (name + ".json");
    std::error_code code;
    if (!fs::exists(file, code)) return {};
    try {
        Json document = read_json(file);
        if (!document.IsObject() || text_of(document, "key") != key) return {};
        const JsonValue* result = find_member(document, "result");
        if (result == nullptr || text_of(document, "checksum") != sha256(to_text(*result))) return {};
        Json copy;
        copy.CopyFrom(*result, copy.GetAllocator());
        return copy;
    } catch (const Error&) {
        return {};
    }
}

void ResultStore::keep(const std::string& name, const std::string& key, const JsonValue& result) const {
    if (folder_.empty()) return;
    std::error_code code;
    fs::create_directories(folder_, code);
    Json document(rapidjson::kObjectType);
    auto& allocator = document.GetAllocator();
    add_member(document, "format", "ostraka-study-result", allocator);
    add_member(document, "version", JsonValue(1), allocator);
    add_member(document, "key", key, allocator);
    add_member(document, "checksum", sha256(to_text(result)), allocator);
    add_member(document, "result", JsonValue(result, allocator), allocator);
    // There at once, whatever becomes of the outputs that the caller writes together.
    OutputTransaction own;
    write_json(folder_ / (name + ".json"), document);
    own.commit();
}

std::vector<ObjectResult> for_each_object(const Collection& collection, const ResultStore& store,
                                          const std::vector<std::string>& what,
                                          const std::function<Json(const CollectionObject&)>& work) {
    std::vector<ObjectResult> results(collection.objects.size());
    Progress progress("objects", results.size());
    parallel_for(
        results.size(),
        [&](std::size_t i) {
            const CollectionObject& object = collection.objects[i];
            ObjectResult& mine = results[i];
            std::vector<std::string> parts = what;
            parts.insert(parts.end(), {object.name, object.checksum, object.unit});
            const std::string key = ResultStore::key(parts);
            try {
                if (!object.checksum.empty())
                    if (auto kept = store.find(object.name, key)) {
                        mine.result = std::move(*kept);
                        mine.resumed = true;
                    }
                if (!mine.resumed) {
                    mine.result = work(object);
                    if (!object.checksum.empty()) store.keep(object.name, key, mine.result);
                }
            } catch (const Error& error) {
                if (error.kind() == ErrorKind::usage) throw;
                mine.result.SetNull();
                mine.problem = error.what();
            } catch (const std::bad_alloc&) {
                mine.result.SetNull();
                mine.problem = object.name + ": out of memory (use a smaller mesh or --threads 1)";
            }
            progress.advance();
        },
        1);
    return results;
}

}  // namespace ostraka
