// Files: read whole, written atomically.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ostraka {

using Path = std::filesystem::path;

/// The file's bytes. Throws Error (input) if it is missing, a directory, unreadable or larger than memory allows.
std::string read_file(const Path& file);

/// A file that appears under its name only when complete: bytes go to a temporary file beside it, `commit` flushes
/// them to the disk and renames; without `commit` (an exception, say) the temporary file is removed and whatever
/// stood under the name stays. Devices and pipes (/dev/null, /dev/stdout) are written to directly. Throws Error (failure) when
/// the folder is missing or the disk is full.
class AtomicFile {
public:
    explicit AtomicFile(Path file);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(std::string_view bytes);
    void commit();

private:
    Path file_;
    Path temporary_;
    std::FILE* stream_ = nullptr;
};

/// Writes `bytes` atomically to `file`.
void write_file(const Path& file, std::string_view bytes);

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
