// The objects of a collection, and work that is done on each of them independently: a failure of one does not stop the others,
// and finished results are not computed again.
#pragma once

#include "ostraka/core/shard.h"
#include "ostraka/files/json.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct CollectionObject {
    std::string name;   ///< unique within the collection; valid as a file name
    Path mesh;          ///< empty if there are only landmarks
    Path annotations;   ///< empty if there are none
    Path landmarks;     ///< 3D Slicer markups (.mrk.json); empty if there are none
    std::string unit;   ///< unit of the coordinates, if the collection gives it
    std::string label;  ///< known class label; empty if unknown
    /// SHA-256 over the contents of its files; empty if one cannot be read, and for objects outside the share.
    std::string checksum;
};

struct Collection {
    std::vector<CollectionObject> objects;                      ///< sorted by name
    std::vector<std::pair<std::string, std::string>> left_out;  ///< files that cannot be objects: printable name, reason
    std::vector<std::string> notes;                             ///< messages on duplicates and missing labels
};

/// Throws Error (failure) if the folder already contains object files or tables, which would mix with synthetic objects. The
/// folder need not exist.
void check_new_collection(const Path& folder);

/// Reads a collection from a folder or a study file. In a folder, every OBJ, PLY, OFF or STL file at the top level is an
/// object, named by its file stem (by the full file name if two files differ only in the extension). NAME.ant.json and
/// NAME.mrk.json beside it belong to it; markups without a mesh form an object that has only landmarks. Names under which
/// results cannot be stored (longer than 200 bytes, with control characters or a backslash, not UTF-8) are left out. A file
/// *.study.json (doc/schema/study.schema.json) lists objects with file paths relative to it; an invalid name in it is an error.
/// Files of objects outside the `share` are not read. Throws Error (input) if the path is neither, if the collection has no
/// objects, or if two objects have the same name. A missing or damaged file is reported only by the work on that object.
Collection read_collection(const Path& folder_or_file, const Share& share = {});

/// Reads labels of objects from a CSV file whose first row names the columns: "name" and `column` (by default "label"). Throws
/// Error (input) for a missing column, a duplicate name or an empty table.
std::map<std::string, std::string> read_labels(const Path& file, const std::string& column = {});

/// Sets the labels of the objects. Notes report how many objects have no label and which labels match no object. Throws Error
/// (input), with examples of both, if no object gets a label; `where` names the source of the labels.
void set_labels(Collection& collection, const std::map<std::string, std::string>& labels, const std::string& where = "labels");

/// Stores results in a folder, one JSON file each, under a name and a key of everything they depend on. Files are written
/// atomically; a file with another key, or a damaged one (each has a checksum of its result), counts as absent. Results are
/// stored at once, even while an OutputTransaction is open. Safe to use from several threads if they use different names.
class ResultStore {
public:
    /// Creates the folder when the first result is stored. Without a folder nothing is stored. Temporary files left in the
    /// folder by killed runs are removed (core/file.h: after a day).
    explicit ResultStore(Path folder = {}, const Share& share = {});
    /// A store in a subfolder, for another kind of result under the same names.
    [[nodiscard]] ResultStore part(const std::string& kind) const;
    /// SHA-256 of the concatenated texts and the version of the toolkit.
    static std::string key(const std::vector<std::string>& parts);

    [[nodiscard]] std::optional<Json> find(const std::string& name, const std::string& key) const;
    void keep(const std::string& name, const std::string& key, const JsonValue& result) const;
    /// The share of objects that this process works on; results of other objects are only looked up.
    [[nodiscard]] const Share& share() const { return share_; }

private:
    Path folder_;
    Share share_;
};

/// Result of the work on one object.
struct ObjectResult {
    Json result;          ///< null if the work failed
    std::string problem;  ///< message with place and remedy if the work failed; empty otherwise
    bool resumed = false;
    bool elsewhere = false;  ///< belongs to another share and is not available yet
};

/// Applies `work` to every object, several in parallel, and returns the results in the order of the collection. Results do not
/// depend on the number of threads (loops within the work run on one thread). Errors of kind input and failure, and a lack of
/// memory, are recorded as the object's problem; an Error of kind usage is thrown. Results are looked up and stored in `store`
/// under a key of the object's contents and name and of `what`: the name of the work and all options it depends on. Failures
/// are not stored. Objects outside the store's share are looked up but not worked on. Objects without a checksum (unreadable)
/// are worked on, so that the error gives the reason.
std::vector<ObjectResult> for_each_object(const Collection& collection, const ResultStore& store,
                                          const std::vector<std::string>& key_parts,
                                          const std::function<Json(const CollectionObject&)>& work);

}  // namespace ostraka
