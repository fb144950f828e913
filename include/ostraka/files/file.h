// Files are read as a whole and written atomically. A name that begins with "memory:" denotes a file in the memory of this
// process: it is read and written like any other file but never touches the disk.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ostraka {

using Path = std::filesystem::path;

/// Checks that a file can be read. Throws Error (input) if the file is missing, is a directory or cannot be opened.
void check_readable(const Path& file);

/// Reads a whole file and returns its bytes. Throws Error (input) if the file is missing, a directory, unreadable or larger than
/// memory allows.
std::string read_file(const Path& file);

/// True if the path denotes a file in memory.
bool is_memory(const Path& file);
/// Removes a file in memory, or all files in memory below a folder.
void remove_memory_files(const Path& file);

/// True if the file exists, on disk or in memory.
bool file_exists(const Path& file);
/// Size of a file in bytes; 0 if there is no such file.
std::size_t size_of_file(const Path& file);
bool is_folder(const Path& folder);  ///< true for an existing folder
/// Names of the files directly in a folder, sorted. `other_entries`: receives the names of entries that are neither files nor
/// folders, such as dangling links.
std::vector<std::string> files_in(const Path& folder, std::vector<std::string>* other_entries = nullptr);
/// Creates the folder and its missing parents. Throws Error (failure) if the folder cannot be created or a file has its name.
void make_folder(const Path& folder);
void remove_file(const Path& file);  ///< removes a file on disk or in memory
/// True if two paths denote the same file or folder, after resolving links and relative parts. The file need not exist.
bool same_place(const Path& a, const Path& b);

/// Records the files that `read_file` reads on this thread during the lifetime of this object.
class ReadRecord {
public:
    ReadRecord();
    ~ReadRecord();
    ReadRecord(const ReadRecord&) = delete;
    ReadRecord& operator=(const ReadRecord&) = delete;
    struct Entry {
        Path file;
        std::string sha256;  ///< checksum of the bytes read
    };
    std::vector<Entry> files;  ///< files that were read, in the order of their first reading

private:
    ReadRecord* outer_;
};

/// Permissions of a written file.
enum class FileAccess {
    usual,      ///< permissions of the replaced file, or by the process's umask if there is no such file
    owner_only  ///< mode 0600, for secrets
};

/// A file that appears under its name only when it is complete: bytes are written to a temporary file in the same folder;
/// `commit` flushes the temporary file to the disk and renames it, or leaves the renaming to an open OutputTransaction. Without
/// `commit` (after an exception, for example) the temporary file is removed and an existing file of that name stays. Devices and
/// pipes (/dev/null, /dev/stdout) are written to directly. Throws Error (failure) if the folder is missing or the disk is full.
class AtomicFile {
public:
    explicit AtomicFile(Path file, FileAccess access = FileAccess::usual);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes);  ///< appends bytes to the temporary file
    void commit();

private:
    Path file_;
    Path temporary_;
    std::FILE* stream_ = nullptr;
    std::string memory_;  ///< contents of a file in memory
};

/// Writes several files as one transaction: either all of them appear or none. While a transaction is open on this thread,
/// files that AtomicFile commits on this thread and in parallel loops started by this thread stay on disk under temporary names
/// until the transaction's `commit` renames them all. Without `commit` the temporary files and the empty folders created for
/// them are removed. If one file cannot be renamed, replaced files are restored (except on file systems without hard links).
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
    std::vector<std::pair<Path, Path>> pending_;          ///< files to be renamed: temporary name, final name
    std::vector<Path> created_;                           ///< created folders, parents first
    std::vector<std::pair<Path, std::string>> replaced_;  ///< arguments of replace_outputs: folder, owner
    OutputTransaction* outer_;
};

/// For a folder that is filled by one command: when the innermost open transaction commits, files are removed that an earlier
/// transaction of the same `owner` wrote directly into `folder` and the current transaction did not write again. The written
/// files are listed in the folder (`.OWNER.outputs`, in the format of sha256sum); files that are not in the list, or that were
/// changed after they were written, stay. Throws std::logic_error if no transaction is open.
void replace_outputs(const Path& folder, const std::string& owner);

/// Removes the temporary files of AtomicFile that a killed process left in `folder`. A regular file with the name of a
/// temporary file is removed if no running process has locked it; on file systems without locks, if it was not modified for a
/// day. AtomicFile calls this function when its process first writes to a folder. Returns the number of files
/// removed.
std::size_t remove_stale_temporaries(const Path& folder);

/// Writes `bytes` atomically to `file`.
void write_file(const Path& file, std::string_view bytes, FileAccess access = FileAccess::usual);

/// For a process that exits while some of its threads are still running: waits for a commit in progress, then removes all
/// temporary files, scratch folders and empty folders that this process created. No more files can be created afterwards.
void abandon_outputs();

/// A new folder, private to this process, in the system's folder for temporary files; the destructor removes it with its
/// contents.
class ScratchFolder {
public:
    /// `purpose`: a word that becomes part of the folder's name. Throws Error (failure) if the folder cannot be created.
    explicit ScratchFolder(const std::string& purpose);
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    [[nodiscard]] const Path& path() const { return path_; }

private:
    Path path_;
};

/// Checks file names before any work is done. Throws Error (usage) if an output is the same file as an input or another output
/// (after resolving links and relative parts), and Error (failure) if the folder of an output does not exist.
void check_outputs(const std::vector<Path>& inputs, const std::vector<Path>& outputs);

/// File name extension in lower case, with the dot.
std::string extension(const Path& file);

/// SHA-256 checksum of bytes, in hexadecimal.
std::string sha256(std::string_view bytes);
std::string sha256_of_file(const Path& file);

/// SHA-256 of data that are given piece by piece.
class Sha256 {
public:
    Sha256();
    ~Sha256();
    Sha256(const Sha256&) = delete;
    Sha256& operator=(const Sha256&) = delete;
    void update(const void* data, std::size_t size);  ///< adds bytes
    std::string hexadecimal();                        ///< the checksum; no data may be added afterwards

private:
    void* context_;
};

}  // namespace ostraka
