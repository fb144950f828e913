#include "ostraka/workflow/program.h"

#include "ostraka/core/error.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

extern char** environ;

namespace ostraka {

Path own_program_folder() {
    std::error_code code;
    const Path program = std::filesystem::read_symlink("/proc/self/exe", code);
    return code ? Path(".") : program.parent_path();
}

int run_program(const Path& program, const std::vector<std::string>& words, const Path& folder, int threads,
                const std::function<bool()>& cancelled) {
    std::vector<std::string> texts = words, variables;
    for (char** one = environ; *one != nullptr; ++one)
        if (std::strncmp(*one, "OMP_NUM_THREADS=", 16) != 0) variables.emplace_back(*one);
    variables.push_back("OMP_NUM_THREADS=" + std::to_string(threads));
    const auto pointers = [](std::vector<std::string>& list) {
        std::vector<char*> all;
        for (std::string& text : list) all.push_back(text.data());
        all.push_back(nullptr);
        return all;
    };
    const std::string output = (folder / "output.txt").string();
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    posix_spawn_file_actions_adddup2(&actions, 1, 2);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawnattr_t attributes;  // a group of its own: signals of the terminal are the command's to answer
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    pid_t child = 0;
    const int failed =
        ::posix_spawn(&child, program.c_str(), &actions, &attributes, pointers(texts).data(), pointers(variables).data());
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (failed != 0) fail_work(program.string(), std::string("cannot be started: ") + std::strerror(failed), "check its rights");
    for (int status = 0, told = 0;;) {
        const pid_t ended = ::waitpid(child, &status, WNOHANG);
        if (ended == child) return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        if (cancelled() && told++ % 100 == 0) ::kill(-child, told < 100 ? SIGTERM : SIGKILL);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

}  // namespace ostraka
