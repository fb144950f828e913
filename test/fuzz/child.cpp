#include "child.h"

#include "ostraka/core/error.h"
#include "ostraka/execution/parallel.h"

#include <linux/landlock.h>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iostream>
#include <new>
#include <thread>

namespace ostraka::fuzz {

namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool is_sanitized = true;  // its shadow memory exceeds any limit, and it is several times slower
#else
constexpr bool is_sanitized = false;
#endif

constexpr double slower = is_sanitized ? 5 : 1;
constexpr double grace = 3;  ///< seconds to end after a cancellation
enum Code { accepted = 40, refused = 41, stopped = 42, no_memory = 43, no_error = 44 };

std::atomic<bool> told_to_stop{false};

int landlock_version() {
    return static_cast<int>(::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION));
}

/// All rights that change files.
constexpr std::uint64_t always = LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE |
                                 LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
                                 LANDLOCK_ACCESS_FS_MAKE_SOCK | LANDLOCK_ACCESS_FS_MAKE_FIFO | LANDLOCK_ACCESS_FS_MAKE_BLOCK |
                                 LANDLOCK_ACCESS_FS_MAKE_SYM;

std::uint64_t writing_rights() {
    std::uint64_t rights = always;
    if (landlock_version() >= 2) rights |= LANDLOCK_ACCESS_FS_REFER;
#ifdef LANDLOCK_ACCESS_FS_TRUNCATE
    if (landlock_version() >= 3) rights |= LANDLOCK_ACCESS_FS_TRUNCATE;
#endif
    return rights;
}

bool allow(int rules, const char* path, std::uint64_t access) {
    landlock_path_beneath_attr rule{};
    rule.allowed_access = access;
    rule.parent_fd = ::open(path, O_PATH | O_CLOEXEC);
    if (rule.parent_fd < 0) return false;
    const bool done = ::syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) == 0;
    ::close(rule.parent_fd);
    return done;
}

/// From here on this process can write below `home` and to /dev/null alone.
bool confine(const Path& home) {
    const std::uint64_t writing = writing_rights();
    landlock_ruleset_attr attributes{};
    attributes.handled_access_fs = writing;
    const int rules =
        static_cast<int>(::syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes.handled_access_fs, 0));
    if (rules < 0) return false;
    const bool done = allow(rules, home.c_str(), writing) && allow(rules, "/dev/null", LANDLOCK_ACCESS_FS_WRITE_FILE) &&
                      ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::syscall(SYS_landlock_restrict_self, rules, 0) == 0;
    ::close(rules);
    return done;
}

void limit(int resource, double soft, double hard) {
    const rlimit limits{static_cast<rlim_t>(soft), static_cast<rlim_t>(hard)};
    ::setrlimit(static_cast<__rlimit_resource>(resource), &limits);
}

void set_limits(const Limits& limits) {
    limit(RLIMIT_CORE, 0, 0);
    limit(RLIMIT_FSIZE, 2e9, 2e9);
    limit(RLIMIT_CPU, std::max(1.0, slower * limits.seconds), slower * limits.seconds + grace + 1);
    // Twice the limit: large allocations fail early, and slightly excessive use is measured.
    if (!is_sanitized && limits.memory > 0) limit(RLIMIT_DATA, 2 * limits.memory, 2 * limits.memory);
    std::signal(SIGXCPU, [](int) { told_to_stop = true; });
    std::signal(SIGTERM, [](int) { told_to_stop = true; });
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

int act_and_tell(const Act& act, Stopper& stopper) {
    try {
        std::cout << act(stopper) << std::flush;
        return accepted;
    } catch (const Error& error) {
        std::cout << error.what() << std::flush;
        return error.kind() == ErrorKind::cancelled ? stopped : refused;
    } catch (const std::bad_alloc&) {
        return no_memory;
    } catch (const std::exception& error) {
        std::cout << "internal error: " << error.what() << std::flush;
        return no_error;
    }
}

[[noreturn]] void be_child(const Act& act, const Path& folder, const Path& home, const Path& output_file, const Limits& limits) {
    ::setpgid(0, 0);
    const int out = ::open(output_file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    const int in = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    ::dup2(in, 0);
    ::dup2(out, 1);
    ::dup2(out, 2);
    set_limits(limits);
    if (::chdir(folder.c_str()) != 0 || !confine(home)) ::_exit(1);
    set_threads(1);
    Stopper stopper;
    stopper.memory = limits.memory;
    std::thread([&stopper] {
        while (!told_to_stop) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        stopper.stop();
    }).detach();
    ::_exit(act_and_tell(act, stopper));
}

/// Whether one of its threads is runnable.
bool is_at_work(pid_t child) {
    std::error_code code;
    const Path tasks = Path("/proc") / std::to_string(child) / "task";
    for (std::filesystem::directory_iterator task(tasks, code), end; !code && task != end; task.increment(code)) {
        std::ifstream stream(task->path() / "stat");
        std::string text;
        std::getline(stream, text);
        const std::size_t behind_name = text.rfind(") ");
        if (behind_name != std::string::npos && (text[behind_name + 2] == 'R' || text[behind_name + 2] == 'D')) return true;
    }
    return false;
}

/// Waits for it, and kills it if it has been idle for too long. Busy processes are ended by their limits.
int wait_for(pid_t child, double seconds, rusage& used) {
    using Clock = std::chrono::steady_clock;
    constexpr double between = 0.25;
    double idle = 0, looked = 0;
    const auto begin = Clock::now();
    for (unsigned pause = 200;; pause = std::min(pause * 2, 5000U)) {
        int status = 0;
        if (::wait4(child, &status, WNOHANG, &used) == child) return status;
        const double gone = std::chrono::duration<double>(Clock::now() - begin).count();
        if (gone > looked + between) {
            idle = is_at_work(child) ? 0 : idle + gone - looked;
            looked = gone;
            if (idle > seconds) ::kill(child, SIGTERM);
            if (idle > seconds + grace) ::kill(-child, SIGKILL), ::kill(child, SIGKILL);
        }
        ::usleep(pause);
    }
}

double seconds_of(const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); }

Outcome outcome_of(int status, std::string& detail) {
    if (WIFSIGNALED(status)) {
        detail = std::string("signal ") + std::to_string(WTERMSIG(status)) + " (" + ::strsignal(WTERMSIG(status)) + ")";
        return WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGXCPU ? Outcome::hang : Outcome::crash;
    }
    switch (WEXITSTATUS(status)) {
        case accepted:
            return Outcome::accepted;
        case refused:
            return Outcome::refused;
        case stopped:
            return Outcome::stopped;
        case no_memory:
            detail = "memory was refused";
            return Outcome::memory;
        case no_error:
            detail = "an exception that is no Error";
            return Outcome::crash;
        default:
            detail = "exit code " + std::to_string(WEXITSTATUS(status));
            return Outcome::crash;
    }
}

}  // namespace

std::string to_string(Outcome outcome) {
    static constexpr const char* names[]{"accepted", "refused", "stopped", "crash", "hang", "memory", "touched", "betrayed"};
    return names[static_cast<std::size_t>(outcome)];
}

bool measures_memory() { return !is_sanitized; }

bool can_confine() { return landlock_version() >= 1; }

Verdict run_child(const Act& act, const Path& folder, const Path& home, const Path& output_file, const Limits& limits) {
    std::cout.flush();
    const pid_t child = ::fork();
    if (child < 0) fail_work("a run", std::string("cannot be started: ") + std::strerror(errno), "end other programs");
    if (child == 0) be_child(act, folder, home, output_file, limits);
    rusage used{};
    const int status = wait_for(child, slower * limits.seconds, used);
    ::kill(-child, SIGKILL);  // its child processes
    Verdict verdict;
    verdict.seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
    verdict.peak = 1024.0 * static_cast<double>(used.ru_maxrss);
    verdict.outcome = outcome_of(status, verdict.detail);
    if (!is_sanitized && limits.memory > 0 && !is_finding(verdict.outcome) && verdict.peak > limits.memory) {
        verdict.outcome = Outcome::memory;
        verdict.detail = std::to_string(static_cast<long>(verdict.peak / 1e6)) + " MB, allowed are " +
                         std::to_string(static_cast<long>(limits.memory / 1e6));
    }
    return verdict;
}

double idle_memory() {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    rusage used{};
    int status = 0;
    ::wait4(child, &status, 0, &used);
    return 1024.0 * static_cast<double>(used.ru_maxrss);
}

}  // namespace ostraka::fuzz
