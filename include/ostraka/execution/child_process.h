// Child processes.
#pragma once

#include "ostraka/files/file.h"

#include <functional>
#include <string>
#include <vector>

namespace ostraka {

struct ChildOptions {
    Path folder = {};               ///< working directory; empty: that of this process
    Path output = {}, errors = {};  ///< files for stdout and stderr; if both are the same file, the order of printing is kept
    bool pipes = false;             ///< stdin is connected to `to` and stdout to `from`; false: stdin is empty
    int threads = 0;                ///< OMP_NUM_THREADS; 0: as in this process
};

/// A running program in its own process group, so that signals of the terminal reach this process only. The destructor kills
/// the program if it still runs.
class ChildProcess {
public:
    /// words: the program (searched in PATH as a shell does) and its arguments. Throws Error (failure) if it cannot be started.
    ChildProcess(std::vector<std::string> words, const ChildOptions& options);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Waits for the program to end and returns true, or false as soon as `stop()` is true; `stop` is polled every few
    /// milliseconds.
    bool wait(const std::function<bool()>& stop);
    /// Sends a signal to the program and to the processes it has started.
    void signal(int number) const;
    /// Exit code after the program has ended; 128 + N if signal N ended it.
    [[nodiscard]] int code() const;
    /// "ended with code 3", "ended by signal 11".
    [[nodiscard]] std::string ending() const;

    [[nodiscard]] int to() const { return to_; }
    [[nodiscard]] int from() const { return from_; }
    /// Closes the program's standard input.
    void close_input();

private:
    int id_ = 0, status_ = 0, to_ = -1, from_ = -1;
};

/// Kills all running child processes and the processes they have started. For a process that exits immediately.
void kill_children();

/// The folder of the running executable.
Path executable_folder();

}  // namespace ostraka
