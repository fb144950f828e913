// Programs that are judged: started for each case, or once.
#include "ostraka/conformance/kit.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/core/words.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <mutex>
#include <thread>

extern char** environ;

namespace ostraka {

namespace {

std::vector<char*> pointers(std::vector<std::string>& words) {
    std::vector<char*> all;
    for (std::string& word : words) all.push_back(word.data());
    all.push_back(nullptr);
    return all;
}

[[noreturn]] void cannot_start(const std::string& program, int reason) {
    fail_work(program, std::string("cannot be started: ") + std::strerror(reason), "check its name and its rights");
}

std::string ended_by(int status) {
    return WIFSIGNALED(status) ? "ended by signal " + std::to_string(WTERMSIG(status))
                               : "ended with code " + std::to_string(WEXITSTATUS(status));
}

class CommandBackend final : public Backend {
public:
    CommandBackend(std::vector<std::string> words, ArgumentsOf arguments, double time_limit)
        : words_(std::move(words)), arguments_(std::move(arguments)), time_limit_(time_limit) {}

    Answer run(const ConformanceCase& one, const JsonValue& settings, const Path& folder) override {
        std::vector<std::string> words = words_;
        for (const std::string& word : arguments_(one.operation, settings)) words.push_back(word);
        const std::string out = (folder / "stdout").string(), err = (folder / "stderr").string();
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
        posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
        pid_t child = 0;
        const Stopwatch clock;
        const int failed = ::posix_spawnp(&child, words.front().c_str(), &actions, nullptr, pointers(words).data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        if (failed != 0) cannot_start(words.front(), failed);
        Answer answer;
        int status = 0;
        while (::waitpid(child, &status, WNOHANG) == 0) {
            const Watch* watch = current_watch();
            if (clock.seconds() > time_limit_ || (watch != nullptr && watch->is_cancelled())) {
                ::kill(child, SIGKILL);
                ::waitpid(child, &status, 0);
                check_cancelled();
                answer.message = "took more than " + digits(time_limit_, 4) + " s";
                return answer;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        answer.seconds = clock.seconds();
        answer.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        answer.message = printable(std::string(trimmed(read_file(err))), 400);
        if (answer.code < 0) answer.message = ended_by(status) + " " + answer.message;
        if (answer.code == 0 || answer.code == 3) {
            try {
                const Json report = parse_json(read_file(out), "its report");
                if (const JsonValue* result = find_member(report, "result")) {
                    auto copy = std::make_shared<Json>();
                    copy->CopyFrom(*result, copy->GetAllocator());
                    answer.result = copy;
                }
            } catch (const Error& error) {
                answer.message = error.what();
            }
        }
        return answer;
    }

private:
    std::vector<std::string> words_;
    ArgumentsOf arguments_;
    double time_limit_;
};

class LinesBackend final : public Backend {
public:
    LinesBackend(std::vector<std::string> words, double time_limit) : words_(std::move(words)), time_limit_(time_limit) {
        start();
    }
    ~LinesBackend() override { stop(); }

    Answer run(const ConformanceCase& one, const JsonValue& settings, const Path& /*folder*/) override {
        const std::lock_guard lock(mutex_);
        Answer answer;
        if (child_ == 0) start();
        Json request(rapidjson::kObjectType);
        auto& allocator = request.GetAllocator();
        add_member(request, "id", one.id, allocator);
        add_member(request, "operation", one.operation, allocator);
        add_member(request, "with", JsonValue(settings, allocator), allocator);
        const Stopwatch clock;
        if (!send(to_compact_text(request) + "\n")) return crashed("does not read any more");
        const auto line = receive(clock);
        if (!line)
            return crashed(clock.seconds() > time_limit_ ? "took more than " + digits(time_limit_, 4) + " s" : "gave no answer");
        answer.seconds = clock.seconds();
        try {
            const Json reply = parse_json(*line, "its answer");
            const JsonValue* code = find_member(reply, "code");
            if (code == nullptr || !code->IsInt())
                fail_input("its answer", "has no code", "answer {\"code\": 0, \"result\": {...}}");
            answer.code = code->GetInt();
            answer.message = text_in(reply, "message");
            if (const JsonValue* result = find_member(reply, "result")) {
                auto copy = std::make_shared<Json>();
                copy->CopyFrom(*result, copy->GetAllocator());
                answer.result = copy;
            }
        } catch (const Error& error) {
            answer.code = -1;
            answer.message = error.what();
        }
        return answer;
    }

private:
    void start() {
        int to[2], from[2];
        if (::pipe2(to, O_CLOEXEC) != 0 || ::pipe2(from, O_CLOEXEC) != 0) cannot_start(words_.front(), errno);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, to[0], 0);
        posix_spawn_file_actions_adddup2(&actions, from[1], 1);
        const int failed = ::posix_spawnp(&child_, words_.front().c_str(), &actions, nullptr, pointers(words_).data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        ::close(to[0]);
        ::close(from[1]);
        to_ = to[1];
        from_ = from[0];
        if (failed != 0) {
            child_ = 0;
            cannot_start(words_.front(), failed);
        }
    }
    void stop() {
        if (child_ == 0) return;
        ::close(to_);  // the end of its input is the end of its work
        int status = 0;
        for (int i = 0; i < 100 && ::waitpid(child_, &status, WNOHANG) == 0; ++i) {
            if (i == 50) ::kill(child_, SIGKILL);
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        ::close(from_);
        child_ = 0;
        left_.clear();
    }
    Answer crashed(const std::string& how) {
        if (child_ != 0) ::kill(child_, SIGKILL);
        stop();
        check_cancelled();
        Answer answer;
        answer.message = how;
        return answer;
    }
    bool send(std::string_view bytes) const {
        while (!bytes.empty()) {
            const ssize_t sent = ::write(to_, bytes.data(), bytes.size());
            if (sent <= 0) return false;
            bytes.remove_prefix(static_cast<std::size_t>(sent));
        }
        return true;
    }
    std::optional<std::string> receive(const Stopwatch& clock) {
        for (;;) {
            if (const std::size_t end = left_.find('\n'); end != std::string::npos) {
                std::string line = left_.substr(0, end);
                left_.erase(0, end + 1);
                return line;
            }
            const Watch* watch = current_watch();
            if (clock.seconds() > time_limit_ || (watch != nullptr && watch->is_cancelled())) return {};
            pollfd waiting{from_, POLLIN, 0};
            if (::poll(&waiting, 1, 100) <= 0) continue;
            char buffer[65536];
            const ssize_t got = ::read(from_, buffer, sizeof buffer);
            if (got <= 0) return {};
            left_.append(buffer, static_cast<std::size_t>(got));
        }
    }

    std::vector<std::string> words_;
    double time_limit_;
    pid_t child_ = 0;
    int to_ = -1, from_ = -1;
    std::string left_;
    std::mutex mutex_;
};

}  // namespace

Backend::~Backend() = default;

std::unique_ptr<Backend> command_backend(std::vector<std::string> words, ArgumentsOf arguments, double time_limit) {
    return std::make_unique<CommandBackend>(std::move(words), std::move(arguments), time_limit);
}
std::unique_ptr<Backend> lines_backend(std::vector<std::string> words, double time_limit) {
    return std::make_unique<LinesBackend>(std::move(words), time_limit);
}

}  // namespace ostraka
