// Records of the instances that ran. They determine whether an instance has to run again, and the reason.
#pragma once

#include "ostraka/workflow/plan.h"

#include <mutex>
#include <optional>

namespace ostraka {

/// Record of an output, for its instance and for the instances that use the output.
struct OutputRecord {
    std::string file;  ///< file name; the file is in the instance's folder if it is kept
    /// Checksum of the output, also if it was not written to a file; for a folder, checksum of the list of names and checksums
    /// of its files.
    std::string sha256;
    bool kept = false;       ///< true: the file was written
    bool is_folder = false;  ///< true: the output is a folder
};

/// Record of an instance that ran.
struct StudyRecord {
    /// The dependencies of the result: pairs of a description and a value or checksum.
    std::vector<std::pair<std::string, std::string>> depends;
    /// Files that the inputs refer to, as pairs of name and checksum; names are relative to the study file or, with the prefix
    /// "run:", to the run folder.
    std::vector<std::pair<std::string, std::string>> read;
    std::map<std::string, OutputRecord> outputs;  ///< records of the outputs, by name
    bool holds = true;                            ///< false: the answer of the operation was "no"
    double seconds = 0;                           ///< duration in seconds
    std::string began, ended;                     ///< start and end of the run, UTC, ISO 8601
};

/// Properties of a file that change when the file is written, so that changes are detected without reading it.
struct FileStamp {
    std::uintmax_t size = 0, number = 0;        ///< size in bytes; inode number
    std::int64_t seconds = 0, nanoseconds = 0;  ///< time of the last modification
    bool operator==(const FileStamp&) const = default;
};
/// Current properties of a file; empty if the file does not exist.
std::optional<FileStamp> stamp_of(const Path& file);

/// SHA-256 of files and folders; each checksum is computed once. Calls are thread-safe.
class FileChecksums {
public:
    /// Checksum of a file. Throws Error (input) if the file cannot be read.
    std::string file(const Path& file);
    /// Checksum over the names and checksums of all files in a folder and its subfolders.
    std::string folder(const Path& folder);
    /// Checksum over all objects that a collection file lists, or over a folder.
    std::string collection(const Path& folder_or_file);
    /// Discards the checksum of a file.
    void forget(const Path& file);
    /// Sets the checksum of a file that another reader computed.
    void store(const Path& file, const std::string& sha256);
    /// Files that changed after their checksums were computed, or for which two readers found different checksums.
    std::vector<Path> changed();
    /// True if the checksum of a file is known.
    bool is_known(const Path& file);

private:
    struct Entry {
        std::string sha256;              ///< checksum of the file
        std::optional<FileStamp> stamp;  ///< properties of the file when it was read; empty: not known
        bool differs = false;            ///< true: another reader found different content
    };
    std::mutex mutex_;
    std::map<Path, Entry> entries_;  ///< from the path of a file to its checksum
};

/// Reads FOLDER/record.json; empty if the file is missing, damaged or of another version. Throws Error (input) if an output named
/// in the record would lie outside the folder.
std::optional<StudyRecord> read_record(const Path& folder);
/// Writes FOLDER/record.json of an instance.
void write_record(const Path& folder, const StudyPlan& plan, const StudyInstance& instance, const StudyRecord& record);

/// Computes the dependencies of the result of an instance from the records of the instances that it needs. `program_folder`:
/// folder of the programs.
std::vector<std::pair<std::string, std::string>> dependencies(const StudyPlan& plan, const StudyInstance& instance,
                                                              const std::function<const StudyRecord&(std::size_t)>& record_of,
                                                              FileChecksums& checksums, const Path& program_folder);

/// The reason why an instance has to run again; empty if nothing has changed. `depends`: its current dependencies; `run_folder`:
/// folder of all instances.
std::string rerun_reason(const StudyPlan& plan, const std::optional<StudyRecord>& record,
                         const std::vector<std::pair<std::string, std::string>>& depends, const StudyInstance& instance,
                         const Path& run_folder, FileChecksums& checksums);

/// Prefix of the names of files in the run folder.
inline const std::string run_folder_prefix = "run:";

/// Path of the program with this name in the folder of programs. Throws Error (input), naming `where`, if there is none.
Path find_program(const std::string& name, const Path& program_folder, const std::string& where);

}  // namespace ostraka
