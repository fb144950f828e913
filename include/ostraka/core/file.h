// Files: read whole, written atomically. A name that begins with "memory:" is that of a file in this process's memory: it is read
// and written like any other, and touches no disk.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ostraka {

using Path = std::filesystem::path;

/// Throws Error (input) as read_file does where the file is missing, a directory or cannot be opened.
void check_readable(const Path& file);

/// The file's bytes. Throws Error (input) if it is missing, a directory, unreadable or larger than memory allows.
std::string read_file(const Path& file);

/// Whether the name is that of a file in memory.
bool is_memory(const Path& file);
/// Removes the file in memory, or all that lie in the folder of that name.
void forget_memory(const Path& file);

/// The same questions for files on disk and in memory.
bool file_exists(const Path& file);
/// In bytes; 0 where there is no such file.
std::size_t size_of_file(const Path& file);
bool is_folder(const Path& folder);
/// Names of the files in a folder (not of its folders), sorted. `others`: gets the names of what is neither a file nor a folder,
/// such as links to nothing.
std::vector<std::string> files_in(const Path& folder, std::vector<std::string>* others = nullptr);
/// Makes the folder and those it lies in. Throws Error (failure) where it cannot be made or is a file.
void make_folder(const Path& folder);
void remove_file(const Path& file);
/// Whether two names are of one place: links and relative spellings seen through, whether anything stands there or not.
bool same_place(const Path& a, const Path& b);

/// Lists what `read_file` reads on this thread while it lives.
class ReadRecord {
public:
    ReadRecord();
    ~ReadRecord();
    ReadRecord(const ReadRecord&) = delete;
    ReadRecord& operator=(const ReadRecord&) = delete;
    struct Entry {
        Path file;
        std::string sha256;
    };
    std::vector<Entry> files;  ///< in the order in which they were first read

private:
    ReadRecord* outer_;
};

/// Who may read a file that is written.
enum class FileAccess {
    usual,      ///< as the file of that name before, else as the process's umask says
    owner_only  ///< mode 0600, for secrets
};

/// A file that appears under its name only when complete: bytes go to a temporary file beside it, `commit` flushes
/// them to the disk and renames, or leaves the renaming to the OutputTransaction that is open; without `commit` (an exception,
/// say) the temporary file is removed and whatever stood under the name stays. Devices and pipes (/dev/null, /dev/stdout) are
/// written to directly. Throws Error (failure) when the folder is missing or the disk is full.
class AtomicFile {
public:
    explicit AtomicFile(Path file, FileAccess access = FileAccess::usual);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes);
    void commit();

private:
    Path file_;
    Path temporary_;
    std::FILE* stream_ = nullptr;
    std::string memory_;  ///< of a file in memory
};

/// Several outputs that appear together or not at all: while one is open on this thread, files that AtomicFile commits on it and
/// in parallel loops that it starts are on the disk but wait under their temporary names until `commit` renames them all; without
/// it they are removed, and so are folders that were made and are empty. Where a name cannot be taken, what stood under the
/// others comes back (but on file systems without hard links).
class OutputTransaction {
public:
    OutputTransaction();
    ~OutputTransaction();
    OutputTransaction(const OutputTransaction&) = delete;
    OutputTransaction& operator=(const OutputTransaction&) = delete;

    void commit();

private:
    friend class AtomicFile;
    friend void replace_outputs(const Path&, const std::string&);
    friend void make_folder(const Path&);
    std::vector<std::pair<Path, Path>> waiting_;          ///< temporary name, name
    std::vector<Path> made_;                              ///< folders, each after the one that it is in
    std::vector<std::pair<Path, std::string>> replaced_;  ///< folder, owner
    OutputTransaction* outer_;
};

/// For a folder that one command fills: the innermost open transaction, when it commits, also removes what an earlier one of the
/// same `owner` wrote directly into `folder` and this one did not. A list in the folder (`.OWNER.outputs`, as sha256sum writes
/// it) remembers what was written; what is not on it, or was changed since, stays. Throws std::logic_error where none is open.
void replace_outputs(const Path& folder, const std::string& owner);

/// Removes the temporary files that AtomicFile left in `folder` when its process was killed: regular files named as it names them
/// that no process holds locked; where files cannot be locked, those not touched for a day. AtomicFile does so when its process
/// first writes to a folder. Returns how many.
std::size_t remove_stale_temporaries(const Path& folder);

/// Writes `bytes` atomically to `file`.
void write_file(const Path& file, std::string_view bytes, FileAccess access = FileAccess::usual);

/// For a process that ends at once while its threads still work: waits for a commit that is under way, then removes all temporary
/// files, scratch folders and empty folders that it has made, and refuses to make others.
void abandon_outputs();

/// A new folder of this process alone in the system's folder for temporary files, removed with all that it holds at the end.
class ScratchFolder {
public:
    /// `purpose`: a word for its name. Throws Error (failure) where it cannot be made.
    explicit ScratchFolder(const std::string& purpose);
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    [[nodiscard]] const Path& path() const { return path_; }

private:
    Path path_;
};

/// Throws Error (usage) if an output names the same file as an input (links and relative spellings seen through),
/// or the same file as another output, and Error (failure) if the folder of an output does not exist. To be called before any
/// work.
void check_outputs(const std::vector<Path>& inputs, const std::vector<Path>& outputs);

/// Lower-case extension with the dot.
std::string extension(const Path& file);

/// SHA-256 in hexadecimal.
std::string sha256(std::string_view bytes);
std::string sha256_of_file(const Path& file);

/// Incremental SHA-256.
class Sha256 {
public:
    Sha256();
    ~Sha256();
    Sha256(const Sha256&) = delete;
    Sha256& operator=(const Sha256&) = delete;
    void update(const void* data, std::size_t size);
    std::string hexadecimal();

private:
    void* context_;
};

}  // namespace ostraka
