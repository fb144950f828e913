#include "io/zip_archive.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/progress.h"

#include <fmt/core.h>
#include <minizip/unzip.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace ostraka::io {

namespace {

/// The bytes of an archive as a file for minizip.
struct MemoryFile {
    std::string_view bytes;
    std::size_t position = 0;
};

voidpf open_memory(voidpf opaque, const void*, int) {
    static_cast<MemoryFile*>(opaque)->position = 0;
    return opaque;
}

uLong read_memory_file(voidpf, voidpf stream, void* buffer, uLong size) {
    auto& file = *static_cast<MemoryFile*>(stream);
    const std::size_t count = std::min<std::size_t>(size, file.bytes.size() - file.position);
    if (count > 0) std::memcpy(buffer, file.bytes.data() + file.position, count);
    file.position += count;
    return count;
}

ZPOS64_T tell_memory(voidpf, voidpf stream) { return static_cast<MemoryFile*>(stream)->position; }

long seek_memory(voidpf, voidpf stream, ZPOS64_T offset, int origin) {
    auto& file = *static_cast<MemoryFile*>(stream);
    const std::size_t start = origin == ZLIB_FILEFUNC_SEEK_SET   ? 0
                              : origin == ZLIB_FILEFUNC_SEEK_CUR ? file.position
                                                                 : file.bytes.size();
    if (offset > file.bytes.size() - start) return -1;
    file.position = start + offset;
    return 0;
}

int close_memory(voidpf, voidpf) { return 0; }

constexpr int ignoring_case = 2;

}  // namespace

struct ZipArchive::Reading {
    MemoryFile memory;
    unzFile zip = nullptr;

    explicit Reading(std::string_view bytes) : memory{bytes} {
        zlib_filefunc64_def functions{};
        functions.zopen64_file = open_memory;
        functions.zread_file = read_memory_file;
        functions.ztell64_file = tell_memory;
        functions.zseek64_file = seek_memory;
        functions.zclose_file = close_memory;
        functions.zerror_file = close_memory;
        functions.opaque = &memory;
        zip = unzOpen2_64("", &functions);
    }
    ~Reading() {
        if (zip != nullptr) unzClose(zip);
    }
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;
};

ZipArchive::ZipArchive(std::string_view bytes, std::string file)
    : bytes_(bytes), file_(std::move(file)), reading_(std::make_shared<Reading>(bytes)) {
    if (reading_->zip == nullptr) fail_input(file_, "is not a zip archive, or its end is missing", "the file may be cut off");
}

bool ZipArchive::has(const std::string& part) const {
    return part.size() < 200 && unzLocateFile(reading_->zip, part.c_str(), ignoring_case) == UNZ_OK;
}

void ZipArchive::stream(const std::string& part, const std::function<bool(std::string_view)>& consume) const {
    const std::string where = fmt::format("{}, {}", file_, printable(part, 200)), remedy = "the file is damaged; export it again";
    if (!has(part)) fail_input(file_, fmt::format("has no part {}", printable(part, 200)), remedy);
    unz_file_info64 info{};
    if (unzGetCurrentFileInfo64(reading_->zip, &info, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK)
        fail_input(where, "cannot be read", remedy);
    const std::size_t limit = std::max<std::size_t>(std::size_t{64} << 20, 100 * bytes_.size());
    const auto refuse = [&] {
        fail_input(where, fmt::format("is unpacked more than {} bytes, of an archive of {}", limit, bytes_.size()),
                   "such archives are made to exhaust memory; get the file from another source");
    };
    if (info.uncompressed_size > limit) refuse();
    if (unzOpenCurrentFile(reading_->zip) != UNZ_OK) fail_input(where, "is packed in an unknown way or damaged", remedy);
    std::array<char, 1 << 16> buffer{};
    std::size_t total = 0;
    int count = 0;
    bool is_complete = true;
    while (is_complete && (count = unzReadCurrentFile(reading_->zip, buffer.data(), buffer.size())) > 0) {
        check_cancelled();
        total += static_cast<std::size_t>(count);
        if (total > limit) refuse();
        is_complete = consume({buffer.data(), static_cast<std::size_t>(count)});
    }
    const int closed = unzCloseCurrentFile(reading_->zip);  // compares the checksum
    if (is_complete && (count < 0 || closed != UNZ_OK || total != info.uncompressed_size))
        fail_input(where, "is damaged: its content does not agree with its checksum", remedy);
}

std::string ZipArchive::read(const std::string& part, std::size_t max_bytes) const {
    std::string content;
    stream(part, [&](std::string_view piece) {
        if (content.size() + piece.size() > max_bytes)
            fail_input(fmt::format("{}, {}", file_, printable(part, 200)), fmt::format("is larger than {} bytes", max_bytes));
        content.append(piece);
        return true;
    });
    return content;
}

}  // namespace ostraka::io
