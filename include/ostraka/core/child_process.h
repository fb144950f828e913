// Programs that are started by this one.
#pragma once

#include "ostraka/core/file.h"

#include <functional>
#include <string>
#include <vector>

namespace ostraka {

struct ChildOptions {
    Path folder = {};               ///< where it runs; empty: where this program does
    Path output = {}, errors = {};  ///< files for what it prints; the same file for both: in the order in which it is printed
    bool pipes =
        false;        ///< it reads what is written to `to`, and what it prints is read from `from`; else it has nothing to read
    int threads = 0;  ///< OMP_NUM_THREADS; 0: as in this program
};

/// A running program, in a process group of its own: signals of the terminal are this program's to answer. It is killed where it
/// still runs at the end.
class ChildProcess {
public:
    /// words: the program (found as the shell does) and its arguments. Throws Error (failure) where it cannot be started.
    ChildProcess(std::vector<std::string> words, const ChildOptions& options);
    ~ChildProcess();
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Waits until it ends: true; or until `stop` says so, which is asked every few milliseconds: false.
    bool wait(const std::function<bool()>& stop);
    /// Sends a signal to it and to what it has started.
    void signal(int number) const;
    /// Once it has ended: its exit code; 128 + N where signal N ended it.
    [[nodiscard]] int code() const;
    /// "ended with code 3", "ended by signal 11".
    [[nodiscard]] std::string ending() const;

    [[nodiscard]] int to() const { return to_; }
    [[nodiscard]] int from() const { return from_; }
    /// What it reads ends here.
    void close_input();

private:
    int id_ = 0, status_ = 0, to_ = -1, from_ = -1;
};

/// Kills all that are running, with what they have started: for a process that ends at once.
void kill_children();

/// The folder of the program that is running.
Path own_program_folder();

}  // namespace ostraka
