// The objects of a collection, and work that is done on each object independently: a failure on one object does not stop the work
// on others, and finished results are not computed again.
#pragma once

#include "ostraka/core/shard.h"
#include "ostraka/files/json.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

/// An object of a collection, with its files.
struct CollectionObject {
    std::string name;   ///< unique within the collection; valid as a file name
    Path mesh;          ///< mesh file; empty if the object has only landmarks
    Path annotations;   ///< annotation file; empty if the object has no annotations
    Path landmarks;     ///< landmark file (.mrk.json, or another format); empty if the object has no landmarks
    std::string unit;   ///< unit of the coordinates; empty if the collection does not give it
    std::string label;  ///< known class label; empty if unknown
    /// SHA-256 over the contents of the object's files; empty if a file cannot be read, and for objects outside the shard.
    std::string checksum;
};

/// The objects of a folder or a study file.
struct Collection {
    std::vector<CollectionObject> objects;  ///< sorted by name
    /// Files that cannot be objects: printable file name, reason.
    std::vector<std::pair<std::string, std::string>> left_out;
    std::vector<std::string> notes;  ///< messages about duplicates and missing labels
};

/// Throws Error (failure) if the folder for new synthetic objects already contains object files or tables. The folder need not
/// exist.
void check_new_collection(const Path& folder);

/// Reads a collection from a folder or a study file. In a folder, every OBJ, PLY, OFF or STL file at the top level is an object,
/// named by its file stem (by the full file name if two files differ only in the extension). Files NAME.ant.json and
/// NAME.mrk.json belong to the object NAME; markups without a mesh form an object that has only landmarks. Names under which
/// results cannot be stored (longer than 200 bytes, with control characters or a backslash, not UTF-8) are left out. A file
/// *.study.json (doc/schema/study.schema.json) lists objects with file paths relative to the study file; an invalid name in a
/// study file is an error. Files of objects outside the shard `share` are not read. Throws Error (input) if the path is neither a
/// folder nor a study file, if the collection has no objects, or if two objects have the same name. A missing or damaged file is
/// reported only by the work on that object.
Collection read_collection(const Path& folder_or_file, const Share& share = {});

/// The same for a study of landmarks: landmark files of every format (interchange/specimens.h) belong to the objects of a folder
/// or form objects of their own, also tables (.csv, .txt) with landmarks of at least one specimen; if an object has several
/// landmark files, the first in the order .mrk.json, then by name counts, and a note names the others. A single landmark file is
/// a collection of one object, whose file may hold many specimens.
Collection read_landmark_collection(const Path& folder_or_file, const Share& share = {});

/// Reads the map from object names to labels from a CSV file whose first row names the columns: "name" and `column` (empty:
/// "label"). Throws Error (input) for a missing column, a duplicate name or an empty table.
std::map<std::string, std::string> read_labels(const Path& file, const std::string& column = {});

/// Sets the labels of the objects. Notes report how many objects have no label and which labels match no object. Throws Error
/// (input), with examples of both, if no object gets a label; `where` names the source of the labels.
void set_labels(Collection& collection, const std::map<std::string, std::string>& labels, const std::string& where = "labels");

/// Stores results in a folder, one JSON file per result, under the name of the object and a key: the checksum of everything the
/// result depends on. Files are written atomically; a file with another key counts as absent, as does a damaged file (each file
/// has a checksum of its result). Results are written immediately, even while an OutputTransaction is open. Several threads may
/// use a store at the same time if they use different names.
class ResultStore {
public:
    /// The folder is created when the first result is stored; without a folder nothing is stored. Temporary files left in the
    /// folder by killed runs are removed (core/file.h: after a day).
    explicit ResultStore(Path folder = {}, const Share& share = {});
    /// A store in the subfolder `kind`, for another kind of result of the same objects.
    [[nodiscard]] ResultStore part(const std::string& kind) const;
    /// SHA-256 of the concatenated texts and the version of the toolkit.
    static std::string key(const std::vector<std::string>& parts);

    /// The stored result; none if absent.
    [[nodiscard]] std::optional<Json> find(const std::string& name, const std::string& key) const;
    /// Stores a result.
    void keep(const std::string& name, const std::string& key, const JsonValue& result) const;
    /// The shard of the objects on which this process works; results of other objects are only looked up in the store.
    [[nodiscard]] const Share& share() const { return share_; }

private:
    Path folder_;
    Share share_;
};

/// The result of the work on one object, or the problem.
struct ObjectResult {
    Json result;             ///< null if the work failed
    std::string problem;     ///< message with place and remedy if the work failed; empty otherwise
    bool resumed = false;    ///< true: the result was found in the store, not computed
    bool elsewhere = false;  ///< true: the object belongs to another shard and its result is not available yet
};

/// Applies `work` to every object, several in parallel, and returns the results in the order of the collection. Results do not
/// depend on the number of threads (parallel loops inside `work` run on one thread). Errors of kind input and failure, and a lack
/// of memory, are recorded as the object's problem; an Error of kind usage is thrown. Results are looked up and stored in `store`
/// under a key of the object's contents and name and of `key_parts`: the name of the work and all options on which the work
/// depends. Failures are not stored. For objects outside the store's shard, `work` is not called; only stored results are
/// returned. For objects without a checksum (unreadable files) `work` is called, so that its error gives the reason.
std::vector<ObjectResult> for_each_object(const Collection& collection, const ResultStore& store,
                                          const std::vector<std::string>& key_parts,
                                          const std::function<Json(const CollectionObject&)>& work);

}  // namespace ostraka
