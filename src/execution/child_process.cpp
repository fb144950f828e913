#include "ostraka/execution/child_process.h"

#include "ostraka/core/error.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <mutex>
#include <set>
#include <thread>

namespace ostraka {

namespace {

std::vector<char*> pointers(std::vector<std::string>& texts) {
    std::vector<char*> result;
    for (std::string& text : texts) result.push_back(text.data());
    result.push_back(nullptr);
    return result;
}

std::vector<std::string> variables_for(int threads) {
    const std::string name = "OMP_NUM_THREADS=";
    std::vector<std::string> variables;
    for (char** variable = environ; *variable != nullptr; ++variable)
        if (threads == 0 || !std::string(*variable).starts_with(name)) variables.emplace_back(*variable);
    if (threads > 0) variables.push_back(name + std::to_string(threads));
    return variables;
}

void close_if_open(int& file) {
    if (file >= 0) ::close(file);
    file = -1;
}

/// Arguments of posix_spawn; the destructor frees them.
struct SpawnSettings {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    SpawnSettings() {
        posix_spawn_file_actions_init(&actions);
        posix_spawnattr_init(&attributes);
    }
    ~SpawnSettings() {
        posix_spawn_file_actions_destroy(&actions);
        posix_spawnattr_destroy(&attributes);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;

    void print_to(int number, const Path& file) {
        posix_spawn_file_actions_addopen(&actions, number, file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    }
};

/// Running process groups.
struct RunningChildren {
    std::mutex mutex;
    std::set<int> groups;
};
RunningChildren& running_children() {
    static RunningChildren children;
    return children;
}
void add_running(int group) {
    const std::lock_guard lock(running_children().mutex);
    running_children().groups.insert(group);
}
void remove_running(int group) {
    const std::lock_guard lock(running_children().mutex);
    running_children().groups.erase(group);
}

}  // namespace

ChildProcess::ChildProcess(std::vector<std::string> words, const ChildOptions& options) {
    const auto cannot_start = [&](int reason) {
        fail_work(words.front(), std::string("cannot be started: ") + std::strerror(reason), "check its name and its rights");
    };
    int input_pipe[2] = {-1, -1}, output_pipe[2] = {-1, -1};
    if (options.pipes && (::pipe2(input_pipe, O_CLOEXEC) != 0 || ::pipe2(output_pipe, O_CLOEXEC) != 0)) {
        const int reason = errno;
        for (int& end : input_pipe) close_if_open(end);
        cannot_start(reason);
    }
    SpawnSettings settings;
    if (options.pipes) {
        posix_spawn_file_actions_adddup2(&settings.actions, input_pipe[0], 0);
        posix_spawn_file_actions_adddup2(&settings.actions, output_pipe[1], 1);
    } else {
        posix_spawn_file_actions_addopen(&settings.actions, 0, "/dev/null", O_RDONLY, 0);
    }
    if (!options.output.empty()) settings.print_to(1, options.output);
    if (!options.errors.empty() && options.errors == options.output) posix_spawn_file_actions_adddup2(&settings.actions, 1, 2);
    else if (!options.errors.empty()) settings.print_to(2, options.errors);
    if (!options.folder.empty()) posix_spawn_file_actions_addchdir_np(&settings.actions, options.folder.c_str());
    // Signals blocked in this process are unblocked in the child.
    sigset_t no_signals;
    sigemptyset(&no_signals);
    posix_spawnattr_setsigmask(&settings.attributes, &no_signals);
    posix_spawnattr_setflags(&settings.attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    std::vector<std::string> variables = variables_for(options.threads);
    const int error_number = ::posix_spawnp(&id_, words.front().c_str(), &settings.actions, &settings.attributes,
                                            pointers(words).data(), pointers(variables).data());
    close_if_open(input_pipe[0]);
    close_if_open(output_pipe[1]);
    to_ = input_pipe[1];
    from_ = output_pipe[0];
    if (error_number == 0) {
        add_running(id_);
        return;
    }
    close_if_open(to_);
    close_if_open(from_);
    cannot_start(error_number);
}

ChildProcess::~ChildProcess() {
    if (id_ != 0) {
        signal(SIGKILL);
        ::waitpid(id_, &status_, 0);
        remove_running(id_);
    }
    close_if_open(to_);
    close_if_open(from_);
}

bool ChildProcess::wait(const std::function<bool()>& stop) {
    while (id_ != 0) {
        if (::waitpid(id_, &status_, WNOHANG) == id_) {
            remove_running(id_);
            id_ = 0;
            break;
        }
        if (stop()) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
}

void ChildProcess::signal(int number) const {
    if (id_ != 0) ::kill(-id_, number);
}

int ChildProcess::code() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_); }

std::string ChildProcess::ending() const {
    return WIFSIGNALED(status_) ? "ended by signal " + std::to_string(WTERMSIG(status_))
                                : "ended with code " + std::to_string(WEXITSTATUS(status_));
}

void ChildProcess::close_input() { close_if_open(to_); }

void kill_children() {
    const std::lock_guard lock(running_children().mutex);
    for (const int group : running_children().groups) ::kill(-group, SIGKILL);
}

Path executable_folder() {
    std::error_code code;
    const Path program = std::filesystem::read_symlink("/proc/self/exe", code);
    return code ? Path(".") : program.parent_path();
}

}  // namespace ostraka
