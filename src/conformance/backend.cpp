// Backends as programs, started for each case or once.
#include "ostraka/conformance/kit.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/progress.h"
#include "ostraka/core/stopwatch.h"
#include "ostraka/execution/child_process.h"

#include <fmt/core.h>

#include <poll.h>
#include <unistd.h>

#include <mutex>

namespace ostraka {

namespace {

bool is_cancelled() {
    const Watch* watch = current_watch();
    return watch != nullptr && watch->is_cancelled();
}

/// Copies "result" of a report into the answer.
void copy_result(Answer& answer, const Json& report) {
    const JsonValue* result = find_member(report, "result");
    if (result == nullptr) return;
    auto copy = std::make_shared<Json>();
    copy->CopyFrom(*result, copy->GetAllocator());
    answer.result = copy;
}

class CommandBackend final : public Backend {
public:
    CommandBackend(std::vector<std::string> words, ArgumentsOf arguments, double time_limit)
        : words_(std::move(words)), arguments_(std::move(arguments)), time_limit_(time_limit) {}

    Answer run(const ConformanceCase& test_case, const JsonValue& settings, const Path& folder) override {
        std::vector<std::string> words = words_;
        for (const std::string& word : arguments_(test_case.operation, settings)) words.push_back(word);
        const Path out = folder / "stdout", err = folder / "stderr";
        const Stopwatch clock;
        ChildProcess program(std::move(words), {.output = out, .errors = err});
        Answer answer;
        if (!program.wait([&] { return clock.seconds() > time_limit_ || is_cancelled(); })) {
            check_cancelled();
            answer.message = fmt::format("took more than {} s", digits(time_limit_, 4));
            return answer;
        }
        answer.seconds = clock.seconds();
        answer.code = program.code();
        answer.message = printable(std::string(trimmed(read_file(err))), 400);
        if (answer.code > 128) answer.message = fmt::format("{} {}", program.ending(), answer.message);
        if (answer.code == 0 || answer.code == 3) {
            try {
                copy_result(answer, parse_json(read_file(out), "its report"));
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
    ~LinesBackend() override {
        if (!program_) return;
        program_->close_input();  // the program ends when its input ends
        const Stopwatch since;
        program_->wait([&] { return since.seconds() > 1; });
    }

    Answer run(const ConformanceCase& test_case, const JsonValue& settings, const Path& /*folder*/) override {
        const std::lock_guard lock(mutex_);
        Answer answer;
        if (!program_) start();
        Json request(rapidjson::kObjectType);
        auto& allocator = request.GetAllocator();
        add_member(request, "id", test_case.id, allocator);
        add_member(request, "operation", test_case.operation, allocator);
        add_member(request, "with", JsonValue(settings, allocator), allocator);
        const Stopwatch clock;
        if (!send(to_compact_text(request) + "\n")) return failed_answer("does not read its input any more");
        const auto line = receive(clock);
        if (!line)
            return failed_answer(clock.seconds() > time_limit_ ? fmt::format("took more than {} s", digits(time_limit_, 4))
                                                               : "gave no answer");
        answer.seconds = clock.seconds();
        try {
            const Json reply = parse_json(*line, "its answer");
            const JsonValue* code = find_member(reply, "code");
            if (code == nullptr || !code->IsInt())
                fail_input("its answer", "has no code", "answer {\"code\": 0, \"result\": {...}}");
            answer.code = code->GetInt();
            answer.message = text_in(reply, "message");
            copy_result(answer, reply);
        } catch (const Error& error) {
            answer.code = -1;
            answer.message = error.what();
        }
        return answer;
    }

private:
    void start() { program_ = std::make_unique<ChildProcess>(words_, ChildOptions{.pipes = true}); }
    /// The program will be restarted for the next case.
    Answer failed_answer(const std::string& reason) {
        program_.reset();
        unread_.clear();
        check_cancelled();
        Answer answer;
        answer.message = reason;
        return answer;
    }
    bool send(std::string_view bytes) const {
        while (!bytes.empty()) {
            const ssize_t sent = ::write(program_->to(), bytes.data(), bytes.size());
            if (sent <= 0) return false;
            bytes.remove_prefix(static_cast<std::size_t>(sent));
        }
        return true;
    }
    std::optional<std::string> receive(const Stopwatch& clock) {
        for (;;) {
            if (const std::size_t end = unread_.find('\n'); end != std::string::npos) {
                std::string line = unread_.substr(0, end);
                unread_.erase(0, end + 1);
                return line;
            }
            if (clock.seconds() > time_limit_ || is_cancelled()) return {};
            pollfd waiting{program_->from(), POLLIN, 0};
            if (::poll(&waiting, 1, 100) <= 0) continue;
            char buffer[65536];
            const ssize_t bytes_read = ::read(program_->from(), buffer, sizeof buffer);
            if (bytes_read <= 0) return {};
            unread_.append(buffer, static_cast<std::size_t>(bytes_read));
        }
    }

    std::vector<std::string> words_;
    double time_limit_;
    std::unique_ptr<ChildProcess> program_;  ///< null after a crash
    std::string unread_;
    std::mutex mutex_;
};

}  // namespace

Backend::~Backend() = default;

std::unique_ptr<Backend> command_backend(std::vector<std::string> words, ArgumentsOf arguments, double time_limit) {
    return std::make_unique<CommandBackend>(std::move(words), std::move(arguments), time_limit);
}
std::unique_ptr<Backend> json_lines_backend(std::vector<std::string> words, double time_limit) {
    return std::make_unique<LinesBackend>(std::move(words), time_limit);
}

}  // namespace ostraka
