// What is remembered of an instance of a step that ran: enough to tell whether it has to run again, and why.
#pragma once

#include "ostraka/workflow/plan.h"

#include <mutex>
#include <optional>

namespace ostraka {

/// What an output was: in the record of an instance, and for those that take it.
struct OutputRecord {
    std::string file;    ///< its name; in the instance's folder where it is kept
    std::string sha256;  ///< of the file that it is or would be; of a folder: of its list of names and checksums
    bool kept = false;
    bool is_folder = false;
};

struct StudyRecord {
    /// All that the result depends on: what it is, and its value or checksum.
    std::vector<std::pair<std::string, std::string>> depends;
    /// Files that the inputs name in turn: relative to the study file, or, behind "run:", to the run folder.
    std::vector<std::pair<std::string, std::string>> read;
    std::map<std::string, OutputRecord> outputs;
    bool holds = true;  ///< the answer was not "no"
    double seconds = 0;
    std::string began, ended;  ///< UTC, ISO 8601
};

/// What tells that a file was written to, without reading it.
struct FileStamp {
    std::uintmax_t size = 0, number = 0;  ///< bytes; number of the file in its file system
    std::int64_t seconds = 0, nanoseconds = 0;
    bool operator==(const FileStamp&) const = default;
};
/// Nothing where there is no such file.
std::optional<FileStamp> stamp_of(const Path& file);

/// SHA-256 of files and folders, each computed once. Safe for several threads.
class FileChecksums {
public:
    /// Throws Error (input) where the file cannot be read.
    std::string file(const Path& file);
    /// Of the names and checksums of all files in a folder and its folders.
    std::string folder(const Path& folder);
    /// Of all objects that a collection lists, or of the folder.
    std::string collection(const Path& folder_or_file);
    void forget(const Path& file);
    /// It has this one, as somebody found who read it.
    void know(const Path& file, const std::string& sha256);
    /// Files whose checksum is known and that have another one now, or had another one for somebody else who read them.
    std::vector<Path> changed();
    bool is_known(const Path& file);

private:
    struct Known {
        std::string sha256;
        std::optional<FileStamp> stamp;
        bool differs = false;  ///< somebody who read it found other bytes
    };
    std::mutex mutex_;
    std::map<Path, Known> known_;
};

/// In FOLDER/record.json; nothing where there is none, or it is damaged or of another version. Throws Error (input) where an
/// output that it names would lie outside of the folder.
std::optional<StudyRecord> read_record(const Path& folder);
void write_record(const Path& folder, const StudyPlan& plan, const StudyInstance& instance, const StudyRecord& record);

/// What the result of an instance depends on, given the records of those that it needs. `program_folder`: where programs are.
std::vector<std::pair<std::string, std::string>> dependencies(const StudyPlan& plan, const StudyInstance& instance,
                                                              const std::function<const StudyRecord&(std::size_t)>& record_of,
                                                              FileChecksums& checksums, const Path& program_folder);

/// Why an instance has to run again, in words; empty where nothing has changed. `run_folder`: of all instances.
std::string why_again(const StudyPlan& plan, const std::optional<StudyRecord>& known,
                      const std::vector<std::pair<std::string, std::string>>& depends, const StudyInstance& instance,
                      const Path& run_folder, FileChecksums& checksums);

/// Before the name of a file in the run folder.
inline const std::string in_run = "run:";

/// The program of that name in the folder of programs. Throws Error (input).
Path find_program(const std::string& name, const Path& program_folder, const std::string& where);

}  // namespace ostraka
