// The objects of a collection, and work that is done on each of them apart: one that fails does not stop the others, and what is
// done is not done again.
#pragma once

#include "ostraka/core/json.h"
#include "ostraka/core/share.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ostraka {

struct CollectionObject {
    std::string name;   ///< of its own in the collection; may stand in a file's name
    Path mesh;          ///< empty where there are landmarks only
    Path annotations;   ///< empty where there are none
    Path landmarks;     ///< 3D Slicer markups (.mrk.json); empty where there are none
    std::string unit;   ///< of the coordinates, where the collection says so
    std::string label;  ///< the known answer; empty where it is not known
    /// SHA-256 over the contents of its files; empty where one cannot be read, and of objects that are not in the share.
    std::string checksum;
};

struct Collection {
    std::vector<CollectionObject> objects;                      ///< by name
    std::vector<std::pair<std::string, std::string>> left_out;  ///< files that can be no object: name as it can be shown, why
    std::vector<std::string> notes;                             ///< what is there twice, which labels are missing, in words
};

/// Throws Error (failure) where the folder holds files of objects or tables already, with which synthetic objects would be mixed.
/// It may be missing.
void check_new_collection(const Path& folder);

/// A folder: every OBJ, PLY, OFF or STL file directly in it is an object, named as the file without its ending (with it, where
/// two files differ in the ending only); NAME.ant.json and NAME.mrk.json beside it belong to it; markups without a mesh are
/// objects of landmarks; names that results cannot be kept under (longer than 200 bytes, with control characters or a backslash,
/// no UTF-8) are left out. A file *.study.json (doc/schema/study.schema.json): the objects that it lists, with their files
/// relative to it; such a name in it is an error. Files of objects outside the `share` are not read. Throws Error (input) for
/// what is neither, a collection without objects, or two objects of one name. A file that is missing or damaged is found out only
/// by the work on that object.
Collection read_collection(const Path& folder_or_file, const Share& share = {});

/// Labels of objects from a CSV file whose first row names the columns: "name" and `column` (by default "label"). Throws Error
/// (input) for a missing column, a name that comes twice or an empty table.
std::map<std::string, std::string> read_labels(const Path& file, const std::string& column = {});

/// Sets the labels of the objects; notes say how many objects have none and which labels no object. Throws Error (input) where no
/// object gets a label, naming some of both; `where` is what the labels were read from.
void set_labels(Collection& collection, const std::map<std::string, std::string>& labels, const std::string& where = "labels");

/// Results in a folder, one JSON file each, under a name and a key of everything they depend on. Files are written atomically;
/// one with another key, or that is damaged (it has a checksum of its result), counts as absent. Kept at once, even while an
/// OutputTransaction is open. Safe for several threads as long as they deal in different names.
class ResultStore {
public:
    /// Makes the folder when the first result is kept. Without a folder nothing is kept. Temporary files that killed runs left in
    /// the folder are removed (core/file.h: after a day).
    explicit ResultStore(Path folder = {}, const Share& share = {});
    /// A store in a folder within this one, for another kind of result under the same names.
    [[nodiscard]] ResultStore part(const std::string& kind) const;
    /// SHA-256 of texts one after the other; the toolkit's version goes in as well.
    static std::string key(const std::vector<std::string>& parts);

    [[nodiscard]] std::optional<Json> find(const std::string& name, const std::string& key) const;
    void keep(const std::string& name, const std::string& key, const JsonValue& result) const;
    /// Of the objects that are worked on here; results of others are found, not made.
    [[nodiscard]] const Share& share() const { return share_; }

private:
    Path folder_;
    Share share_;
};

/// What became of one object.
struct ObjectResult {
    Json result;          ///< null where the work failed
    std::string problem;  ///< why it failed, in words with place and remedy; empty where it did not
    bool resumed = false;
    bool elsewhere = false;  ///< another share's, and not there yet
};

/// Does `work` on every object, several at a time, and gives the results in the order of the collection, the same for any number
/// of threads (within the work, loops run on one thread). Errors of kind input and failure, and a lack of memory, are kept as the
/// object's problem; an Error of kind usage is thrown. Results are looked up and kept in `store` under a key of the object's
/// contents and name and of `what`: the work's name and all options it depends on. Failures are not kept. Objects outside of the
/// store's share are looked up, and not worked on. Objects without a
/// checksum (unreadable) are worked on, so that the error says why.
std::vector<ObjectResult> for_each_object(const Collection& collection, const ResultStore& store,
                                          const std::vector<std::string>& what,
                                          const std::function<Json(const CollectionObject&)>& work);

}  // namespace ostraka
