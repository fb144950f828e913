// Child processes.
#pragma once

#include "ostraka/files/file.h"

#include <functional>
#include <string>
#include <vector>

namespace ostraka {

/// Options for starting a child process.
struct ChildOptions {
    Path folder = {};  ///< working directory; empty: the working directory of this process
    /// Files for stdout and stderr; both may be the same file, which then keeps the order of printing.
    Path output = {}, errors = {};
    /// True: stdin is connected to ChildProcess::to and stdout to ChildProcess::from; false: stdin is empty.
    bool pipes = false;
    int threads = 0;  ///< OMP_NUM_THREADS of the program; 0: the value of this process
};

/// A running program in its own process group, so that signals of the terminal do not reach the program. The destructor kills the
/// program if it still runs.
class ChildProcess {
public:
    /// Starts a program. `words`: the program (searched in PATH as a shell does) and its arguments. Throws Error (failure) if the
    /// program cannot be started.
    ChildProcess(std::vector<std::string> words, const ChildOptions& options);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Waits for the program to end and returns true, or false as soon as `stop()` is true; `stop` is polled every few
    /// milliseconds.
    bool wait(const std::function<bool()>& stop);
    /// Sends a signal to the program and to the processes that the program has started.
    void signal(int number) const;
    /// Exit code of the ended program; 128 + N if signal N ended the program.
    [[nodiscard]] int code() const;
    /// Description of how the program ended: "ended with code 3", "ended by signal 11".
    [[nodiscard]] std::string ending() const;

    /// File descriptor that writes to the program's stdin; -1 without pipes.
    [[nodiscard]] int to() const { return to_; }
    /// File descriptor that reads the program's stdout; -1 without pipes.
    [[nodiscard]] int from() const { return from_; }
    /// Closes the program's standard input.
    void close_input();

private:
    int id_ = 0, status_ = 0, to_ = -1, from_ = -1;
};

/// Kills all running child processes and the processes that these have started; called before this process exits immediately.
void kill_children();

/// The folder of the running executable.
Path executable_folder();

}  // namespace ostraka
