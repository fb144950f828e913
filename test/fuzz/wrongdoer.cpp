// Does wrong on purpose.
#include "subjects.h"

#include "ostraka/core/error.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

namespace ostraka::fuzz {

namespace {

std::string do_wrong(const std::string& what, Stopper& stopper) {
    std::atomic<bool> told{false};
    stopper.set([&told, what] { told = what == "stopped"; });
    if (what == "crash") std::raise(SIGSEGV);
    if (what == "throw") throw std::logic_error("wrong on purpose");
    if (what == "hang" || what == "stopped")
        while (!told) std::atomic_signal_fence(std::memory_order_seq_cst);
    if (what == "stopped") throw Error(ErrorKind::cancelled, "", "cancelled", "");
    if (what == "wait")
        for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
    if (what == "memory") return std::string(1'000'000'000, 'x').substr(0, 1);
    if (what == "more memory") return std::string(100'000'000'000, 'x').substr(0, 1);
    if (what == "touched") write_file("../canaries/made", "");
    if (what == "removed") std::filesystem::remove_all("../canaries/folder");
    if (what == "betrayed") return read_file("../canaries/secret.txt");
    return what;
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
