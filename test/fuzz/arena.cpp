#include "arena.h"

#include "ostraka/core/error.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

namespace ostraka::fuzz {

namespace {

constexpr const char* token = "canary-5e7d21c94b";
constexpr double number = 271828.1875;  ///< a float too
constexpr double times_input = 16, beside_input = 256e6;

std::string bytes_of(auto value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

/// Text that reveals that a canary was read.
const std::vector<std::string>& traces() {
    static const std::vector<std::string> list{token, "271828.1875", bytes_of(number), bytes_of(static_cast<float>(number))};
    return list;
}

void write_plain(const Path& file, const std::string& bytes) {
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream << bytes;
}

std::string read_plain(const Path& file, std::size_t most = 50'000'000) {
    std::error_code code;
    const auto size = std::filesystem::file_size(file, code);
    std::ifstream stream(file, std::ios::binary);
    if (code || !stream) return {};
    std::string bytes(std::min<std::size_t>(size, most), '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, stream.gcount())));
    return bytes;
}

/// Names, kinds, sizes and times of all files in a folder.
void list_state(const Path& folder, std::ostream& text) {
    std::vector<Path> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path());
    std::sort(names.begin(), names.end());
    for (const Path& name : names) {
        struct stat state {};
        ::lstat(name.c_str(), &state);
        text << name.string() << ' ' << state.st_mode << ' ' << state.st_ino << ' ' << state.st_size << ' '
             << state.st_mtim.tv_sec << '.' << state.st_mtim.tv_nsec << ' ' << state.st_ctim.tv_sec << '.'
             << state.st_ctim.tv_nsec << '\n';
        if (S_ISDIR(state.st_mode)) list_state(name, text);
    }
}

std::string with_canaries(std::string text, const std::string& folder) {
    const std::string mark = canaries_mark;
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + folder.size()))
        text.replace(at, mark.size(), folder);
    return text;
}

void clear(const Path& folder) {
    std::error_code code;
    std::filesystem::remove_all(folder, code);
    std::filesystem::create_directories(folder, code);
}

}  // namespace

Arena::Arena(const Path& project) {
    std::string pattern = (std::filesystem::temp_directory_path() / "ostraka-fuzz-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) fail_work(pattern, "cannot be made", "is there space?");
    root_ = pattern;
    above_ = root_ / "a" / "b" / "c";  // names with .. must find something
    home_ = above_ / "home";
    std::filesystem::create_directories(seeds());
    for (const char* name : {"work", "canaries", "tmp"}) std::filesystem::create_directories(home_ / name);
    ::setenv("TMPDIR", (home_ / "tmp").c_str(), 1);
    ::setenv("HOME", (home_ / "tmp").c_str(), 1);
    plant_canaries();
    const Verdict verdict =
        run_child([&](Stopper&) { return make_seeds(project), std::string(); }, seeds(), above_, above_ / "output", {120, 0});
    if (verdict.outcome != Outcome::accepted)
        fail_work("the seeds", "cannot be made: " + verdict.detail + " " + output(),
                  "repair test/fuzz, or the operations that make them");
}

Arena::~Arena() {
    std::error_code code;
    std::filesystem::remove_all(root_, code);
}

void Arena::plant_canaries() {
    const Path folder = home_ / "canaries";
    std::ostringstream mesh;
    mesh.precision(12);
    mesh << "ply\nformat ascii 1.0\ncomment " << token << "\nelement vertex 4\nproperty double x\nproperty double y\n"
         << "property double z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
         << number << " 0 0\n0 1 0\n0 0 1\n0 0 0\n3 0 1 2\n3 0 2 3\n3 0 3 1\n3 1 3 2\n";
    write_plain(folder / "secret.txt", std::string(token) + "\n");
    write_plain(folder / "secret.ply", mesh.str());
    write_plain(folder / "secret.json", std::string("{\"") + token + "\": 1}\n");
    write_plain(folder / "program", "#!/bin/sh\necho > \"$(dirname \"$0\")/made\"\n");
    ::chmod((folder / "program").c_str(), 0755);
    std::filesystem::create_directories(folder / "folder" / "steps" / "s001");
    write_plain(folder / "folder" / "inner.txt", std::string(token) + "\n");
    write_plain(folder / "folder" / "steps" / "s001" / "inner.ply", mesh.str());
    std::filesystem::create_symlink("secret.txt", folder / "link");
    canaries_ = look_at_canaries();
}

std::string Arena::look_at_canaries() const {
    std::ostringstream text;
    if (std::filesystem::is_directory(home_ / "canaries")) list_state(home_ / "canaries", text);
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(home_)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    for (const std::string& name : names) text << name << '\n';
    return text.str();
}

/// Returns the number of bytes.
double Arena::lay_out(const Subject& subject, const std::vector<Change>& changes) const {
    const Path work = home_ / "work";
    clear(work);
    clear(home_ / "tmp");
    for (const std::string& folder : subject.folders) std::filesystem::create_directories(work / folder);
    for (const SubjectFile& file : subject.files) {
        std::filesystem::create_directories((work / file.name).parent_path());
        if (file.from.empty()) write_plain(work / file.name, file.text);
        else std::filesystem::copy_file(file.from, work / file.name);
    }
    if (subject.keeps_inside) std::filesystem::create_symlink(home_ / "canaries", work / "link-out");
    for (const Change& change : changes) apply(change);
    double bytes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(work))
        if (!entry.is_symlink() && entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
    return bytes;
}

void Arena::apply(const Change& change) const {
    const Path file = home_ / "work" / change.file;
    std::error_code code;
    std::filesystem::remove_all(file, code);
    const std::string bytes = with_canaries(change.bytes, (home_ / "canaries").string());
    switch (change.what) {
        case Change::What::bytes:
            write_plain(file, bytes);
            break;
        case Change::What::link:
            std::filesystem::create_symlink(bytes, file, code);
            break;
        case Change::What::pipe:
            ::mkfifo(file.c_str(), 0600);
            break;
        case Change::What::folder:
            std::filesystem::create_directories(file, code);
            break;
        case Change::What::gone:
            break;
    }
}

/// The file or output of the run that contains a canary's contents; empty: none.
std::string Arena::betrayed_in() const {
    std::vector<Path> files{above_ / "output"};
    for (const char* folder : {"work", "tmp"})
        for (auto entry = std::filesystem::recursive_directory_iterator(home_ / folder); entry != decltype(entry)(); ++entry)
            if (!entry->is_symlink() && entry->is_regular_file()) files.push_back(entry->path());
    for (const Path& file : files) {
        const std::string bytes = read_plain(file);
        for (const std::string& trace : traces())
            if (bytes.find(trace) != std::string::npos) return file.lexically_relative(above_).string();
    }
    return {};
}

void Arena::judge(Verdict& verdict) {
    const auto report = [&](Outcome outcome, const std::string& detail) {
        verdict.outcome = outcome;
        verdict.detail = detail;
    };
    if (!is_finding(verdict.outcome) && output().find("internal error") != std::string::npos)
        report(Outcome::crash, "an exception that is no Error");
    if (const std::string file = betrayed_in(); !file.empty()) report(Outcome::betrayed, "what a canary holds is in " + file);
    if (look_at_canaries() == canaries_) return;
    report(Outcome::touched, "the canaries are no longer as they were");
    for (const char* name : {"canaries", "work", "tmp"}) clear(home_ / name);
    std::vector<Path> strangers;
    for (const auto& entry : std::filesystem::directory_iterator(home_)) {
        const std::string name = entry.path().filename().string();
        if (name != "canaries" && name != "work" && name != "tmp") strangers.push_back(entry.path());
    }
    for (const Path& stranger : strangers) std::filesystem::remove_all(stranger);
    plant_canaries();
}

Verdict Arena::run(const Subject& subject, const std::vector<Change>& changes, double seconds) {
    if (idle_ == 0) idle_ = idle_memory();
    const double input = lay_out(subject, changes);
    const Limits limits{seconds, idle_ + times_input * input + beside_input};
    Verdict verdict = run_child(subject.act, home_ / "work", home_, above_ / "output", limits);
    judge(verdict);
    return verdict;
}

std::string Arena::output() const { return read_plain(above_ / "output", 4'000'000); }

}  // namespace ostraka::fuzz
