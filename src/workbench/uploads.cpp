#include "ostraka/workbench/uploads.h"

#include "ostraka/files/safe_path.h"
#include "ostraka/framework/objects.h"
#include "ostraka/point_cloud/point_cloud.h"
#include "workbench/session_names.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

namespace ostraka {

using workbench::fail_request;

namespace {

constexpr const char* folder_name = "uploads";

/// Throws unless the name is a relative path of plain names.
void require_plain_path(const std::string& name) {
    const auto fail = [&] {
        fail_request(fmt::format("'{}' is not a valid name of a file", printable(name, 100)),
                     "rename the file, then send it again");
    };
    if (name.size() > 1000) fail();
    std::size_t begin = 0, depth = 0;
    for (;;) {
        const std::size_t end = std::min(name.find('/', begin), name.size());
        const std::string part = name.substr(begin, end - begin);
        if (part.size() > 200 || ++depth > 16 || !workbench::is_plain_name(part.substr(0, 100)) || printable(part) != part ||
            part.find_first_of("\\:$") != std::string::npos)
            fail();
        if (end == name.size()) return;
        begin = end + 1;
    }
}

std::string megabytes(std::uintmax_t bytes) { return fmt::format("{} MB", (bytes + 999'999) / 1'000'000); }

}  // namespace

Uploads::Uploads(const Path& session, const UploadLimits& limits) : folder_(session / folder_name), limits_(limits) {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored))
        if (const std::string name = entry.path().filename().string(); is_batch(name))
            last_ = std::max<std::size_t>(last_, std::stoul(name.substr(1)));
}

bool Uploads::is_batch(std::string_view name) {
    return name.size() >= 4 && name.size() <= 9 && name.front() == 'u' &&
           name.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

std::string Uploads::announce(const std::vector<AnnouncedFile>& files) {
    if (files.empty()) fail_request("no file is sent", "drop files or folders that hold scans");
    if (files.size() > limits_.files)
        fail_input(fmt::format("{} files", files.size()), fmt::format("are more than {}", limits_.files), "send fewer at once");
    std::uintmax_t total = 0;
    std::set<std::string> names;
    for (const AnnouncedFile& file : files) {
        require_plain_path(file.name);
        if (!names.insert(file.name).second) fail_request(fmt::format("'{}' is sent twice", printable(file.name, 100)));
        if (file.size > limits_.file_bytes)
            fail_input(file.name, fmt::format("has {}, more than {}", megabytes(file.size), megabytes(limits_.file_bytes)),
                       "import it by the command: ostraka import");
        total += file.size;
    }
    if (total > limits_.total_bytes)
        fail_input(counted(files.size(), "file"),
                   fmt::format("have {}, more than {} together", megabytes(total), megabytes(limits_.total_bytes)),
                   "import them by the command: ostraka import");
    const std::lock_guard lock(mutex_);
    require_writable_inside(folder_, folder_.parent_path());
    make_folder(folder_);
    std::error_code code;
    const auto space = std::filesystem::space(folder_, code);
    // The import writes a copy of the raw files, and the object.
    if (!code && space.available < 3 * total + limits_.free_bytes)
        throw Error(
            ErrorKind::failure, folder_.string(),
            fmt::format("the disk has {} left, too few for {} and their import", megabytes(space.available), megabytes(total)),
            "make space, or import them by the command elsewhere");
    const std::string batch = fmt::format("u{:03}", ++last_);
    auto& announced = announced_[batch];
    for (const AnnouncedFile& file : files) {
        const Path path = folder_ / batch / file.name;
        make_folder(path.parent_path());
        announced.push_back(Receiving{path, file.size});
    }
    return batch;
}

std::optional<Uploads::Receiving> Uploads::begin(std::string_view batch, std::size_t file) {
    const std::lock_guard lock(mutex_);
    const auto announced = announced_.find(batch);
    if (announced == announced_.end() || file >= announced->second.size()) return {};
    return std::exchange(announced->second[file], std::nullopt);
}

Path Uploads::path_of(const Path& session, const std::string& batch, const std::string& name) {
    if (!is_batch(batch)) fail_request(fmt::format("'{}' is no upload", printable(batch, 40)), "send the files again");
    require_plain_path(name);
    const Path path = session / folder_name / batch / name;
    if (!is_inside(path, session) || !file_exists(path))
        fail_request(fmt::format("'{}' was not sent completely", printable(name, 100)), "send the files again");
    return path;
}

std::vector<std::size_t> scans_among(const std::vector<AnnouncedFile>& files) {
    const auto has = [](const std::vector<std::string>& endings, const std::string& ending) {
        return std::find(endings.begin(), endings.end(), ending) != endings.end();
    };
    const std::vector<std::string> meshes = extensions_of(Kind::mesh);
    std::vector<std::size_t> scans, texts;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const std::string ending = extension(files[i].name);
        const bool is_text = ending == ".txt" || ending == ".csv";
        if (is_text) texts.push_back(i);
        else if (has(meshes, ending) || has(point_cloud_endings(), ending)) scans.push_back(i);
    }
    return scans.empty() ? texts : scans;
}

}  // namespace ostraka
