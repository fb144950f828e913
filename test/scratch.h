// Shared by tests: temporary folders, and running the built command through the shell.
#pragma once

#include "ostraka/files/file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <string>

namespace ostraka::test {

/// A new folder, removed with its content at the end of the test.
class Scratch {
public:
    Scratch() {
        std::string pattern = (std::filesystem::temp_directory_path() / "ostraka-test-XXXXXX").string();
        folder_ = ::mkdtemp(pattern.data()) == nullptr ? Path() : Path(pattern);
    }
    ~Scratch() {
        std::error_code code;
        if (!folder_.empty()) std::filesystem::remove_all(folder_, code);
    }
    Scratch(const Scratch&) = delete;
    Scratch& operator=(const Scratch&) = delete;

    [[nodiscard]] Path operator/(const std::string& name) const { return folder_ / name; }
    /// Writes a file into the folder.
    [[nodiscard]] Path file(const std::string& name, std::string_view bytes) const {
        write_file(folder_ / name, bytes);
        return folder_ / name;
    }
    [[nodiscard]] const Path& path() const { return folder_; }

private:
    Path folder_;
};

struct CommandResult {
    int code = -1;  ///< exit code, -1 if a signal ended it
    std::string out, err;
};

/// Runs the tool through the shell with `arguments`; `before` goes in front of the command (e.g. "ulimit -f 8;").
inline CommandResult run_command(const std::string& arguments, const std::string& before = {}) {
    const Scratch scratch;
    const std::string line =
        before + " " OSTRAKA_COMMAND " " + arguments + " > " + (scratch / "out").string() + " 2> " + (scratch / "err").string();
    const int status = std::system(line.c_str());
    CommandResult result;
    if (WIFEXITED(status)) result.code = WEXITSTATUS(status);
    result.out = read_file(scratch / "out");
    result.err = read_file(scratch / "err");
    return result;
}

/// All names in a folder, to test that no files were left behind.
inline std::size_t count_files(const Path& folder) {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
    return count;
}

}  // namespace ostraka::test
