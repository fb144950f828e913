// Misbehaves on purpose.
#include "subjects.h"

#include "ostraka/core/error.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

namespace ostraka::fuzz {

namespace {

std::string do_wrong(const std::string& misdeed, Stopper& stopper) {
    std::atomic<bool> is_stopped{false};
    stopper.set([&is_stopped, misdeed] { is_stopped = misdeed == "stopped"; });
    if (misdeed == "crash") std::raise(SIGSEGV);
    if (misdeed == "throw") throw std::logic_error("wrong on purpose");
    if (misdeed == "hang" || misdeed == "stopped")
        while (!is_stopped) std::atomic_signal_fence(std::memory_order_seq_cst);
    if (misdeed == "stopped") throw Error(ErrorKind::cancelled, "", "cancelled", "");
    if (misdeed == "wait")
        for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
    if (misdeed == "memory") return std::string(1'000'000'000, 'x').substr(0, 1);
    if (misdeed == "more memory") return std::string(100'000'000'000, 'x').substr(0, 1);
    if (misdeed == "touched") write_file("../canaries/made", "");
    if (misdeed == "removed") std::filesystem::remove_all("../canaries/folder");
    if (misdeed == "betrayed") return read_file("../canaries/secret.txt");
    return misdeed;
}

}  // namespace

void add_wrongdoer(std::vector<Subject>& subjects) {
    Subject subject;
    subject.name = "wrongdoer";
    subject.files = {{"what.txt", {}, "nothing"}};
    subject.act = [](Stopper& stopper) { return do_wrong(read_file("what.txt"), stopper); };
    subjects.push_back(std::move(subject));
}

}  // namespace ostraka::fuzz
