// Records of step instances that ran, from which it is decided whether an instance has to run again, and why.
#pragma once

#include "ostraka/workflow/plan.h"

#include <mutex>
#include <optional>

namespace ostraka {

/// Record of an output, for its instance and for the instances that use it.
struct OutputRecord {
    std::string file;    ///< file name; in the instance's folder if kept
    std::string sha256;  ///< checksum of the file, written or not; for a folder: of the list of names and checksums
    bool kept = false;
    bool is_folder = false;
};

struct StudyRecord {
    /// Everything the result depends on: a description, and the value or checksum.
    std::vector<std::pair<std::string, std::string>> depends;
    /// Files that the inputs refer to: relative to the study file or, with the prefix "run:", to the run folder.
    std::vector<std::pair<std::string, std::string>> read;
    std::map<std::string, OutputRecord> outputs;
    bool holds = true;  ///< false if the answer was "no"
    double seconds = 0;
    std::string began, ended;  ///< UTC, ISO 8601
};

/// Properties of a file that reveal writes without reading it.
struct FileStamp {
    std::uintmax_t size = 0, number = 0;  ///< size in bytes; inode number
    std::int64_t seconds = 0, nanoseconds = 0;
    bool operator==(const FileStamp&) const = default;
};
/// Empty if the file does not exist.
std::optional<FileStamp> stamp_of(const Path& file);

/// SHA-256 of files and folders, each computed once. Thread-safe.
class FileChecksums {
public:
    /// Throws Error (input) if the file cannot be read.
    std::string file(const Path& file);
    /// Checksum over the names and checksums of all files in a folder and its subfolders.
    std::string folder(const Path& folder);
    /// Checksum over all objects listed by a collection, or over the folder.
    std::string collection(const Path& folder_or_file);
    void forget(const Path& file);
    /// Sets the checksum of a file, as computed by another reader.
    void store(const Path& file, const std::string& sha256);
    /// Files with known checksums that have changed, or that had different checksums for different readers.
    std::vector<Path> changed();
    bool is_known(const Path& file);

private:
    struct Entry {
        std::string sha256;
        std::optional<FileStamp> stamp;
        bool differs = false;  ///< another reader found different content
    };
    std::mutex mutex_;
    std::map<Path, Entry> entries_;
};

/// Reads FOLDER/record.json; empty if it is missing, damaged or of another version. Throws Error (input) if an output that it
/// names would lie outside the folder.
std::optional<StudyRecord> read_record(const Path& folder);
void write_record(const Path& folder, const StudyPlan& plan, const StudyInstance& instance, const StudyRecord& record);

/// Dependencies of an instance's result, given the records of the instances it needs. `program_folder`: folder of the programs.
std::vector<std::pair<std::string, std::string>> dependencies(const StudyPlan& plan, const StudyInstance& instance,
                                                              const std::function<const StudyRecord&(std::size_t)>& record_of,
                                                              FileChecksums& checksums, const Path& program_folder);

/// The reason why an instance has to run again; empty if nothing has changed. `run_folder`: folder of all instances.
std::string rerun_reason(const StudyPlan& plan, const std::optional<StudyRecord>& record,
                         const std::vector<std::pair<std::string, std::string>>& depends, const StudyInstance& instance,
                         const Path& run_folder, FileChecksums& checksums);

/// Prefix of names of files in the run folder.
inline const std::string run_folder_prefix = "run:";

/// Path of the program with this name in the folder of programs. Throws Error (input).
Path find_program(const std::string& name, const Path& program_folder, const std::string& where);

}  // namespace ostraka
