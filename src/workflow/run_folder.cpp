#include "workflow/run_folder.h"

#include "ostraka/core/progress.h"
#include "ostraka/files/safe_path.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

namespace ostraka {

FolderLock::FolderLock(const Path& folder, const std::function<bool()>& stop)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    // Without file-system support for locks, do not wait.
    while (descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK && !stop()) {
        waited_ = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

FolderLock::~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void empty_folder(const Path& folder) {
    std::error_code code;
    std::vector<Path> entries;
    for (std::filesystem::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code))
        entries.push_back(entry->path());
    for (const Path& entry : entries) std::filesystem::remove_all(entry, code);
}

namespace {
/// Checks an entry of a folder that has already been checked: only a link can lead elsewhere or hide its type.
void check_entry(const Path& entry, const Path& run_folder) {
    std::error_code code;
    const auto type = std::filesystem::symlink_status(entry, code).type();
    using Type = std::filesystem::file_type;
    if (type != Type::not_found && type != Type::regular && type != Type::directory) require_writable_inside(entry, run_folder);
}

/// Names of the files written for all instances together.
std::vector<std::string> collected_names(const StudyPlan& plan) {
    std::vector<std::string> names{"page.md", "run.json", "run.study.json", "ro-crate-metadata.json"};
    const auto add = [&](const char* member, const std::vector<const char*>& endings) {
        if (const JsonValue* descriptions = find_member(*plan.study.document, member))
            for (const auto& description : descriptions->GetObject())
                for (const char* ending : endings) names.push_back(text_of(description.name) + ending);
    };
    add("tables", {".csv", ".md", ".tex"});
    add("plots", {".svg"});
    return names;
}
}  // namespace

void check_run_folder(const StudyPlan& plan, const Path& run_folder) {
    for (const std::string& name : collected_names(plan)) check_entry(run_folder / name, run_folder);
    check_entry(run_folder / "steps", run_folder);
    for (const StudyStep& step : plan.study.steps) check_entry(run_folder / "steps" / step.name, run_folder);
    for (const StudyInstance& instance : plan.instances) {
        check_cancelled();
        const Path folder = run_folder / instance.folder;
        check_entry(folder, run_folder);
        if (!is_folder(folder)) continue;
        static_cast<void>(read_record(folder));
        for (const char* name : {"report.json", "record.json", "output.txt"}) check_entry(folder / name, run_folder);
        for (const std::string& output : instance.kept) check_entry(folder / instance.outputs.at(output), run_folder);
    }
}

}  // namespace ostraka
