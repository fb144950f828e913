// The command that runs the workbench: a local server, until it is interrupted.
#include "workbench.h"

#include "command_line.h"
#include "signals.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/workbench/server.h"

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <thread>

extern char** environ;  // NOLINT(readability-redundant-declaration): not in every <unistd.h>

namespace ostraka::app {

namespace {

/// Opens the workbench in the desktop's browser, if there is one. Other users can see command lines, and the URL contains a
/// secret; so the browser opens a file in the session's folder that only its owner can read and that redirects to the URL. The
/// file is deleted as soon as it is no longer needed.
class RedirectFile {
public:
    explicit RedirectFile(const Path& session) : file_(std::filesystem::absolute(session) / "ostraka-workbench.html") { close(); }
    ~RedirectFile() { close(); }
    RedirectFile(const RedirectFile&) = delete;
    RedirectFile& operator=(const RedirectFile&) = delete;

    void open(const std::string& address) const {
        if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
        try {
            write_file(
                file_,
                fmt::format("<!doctype html><meta charset=\"utf-8\"><meta name=\"referrer\" "
                            "content=\"no-referrer\"><title>Ostraka</title><meta http-equiv=\"refresh\" content=\"0; url={}\">\n",
                            address),
                FileAccess::owner_only);
        } catch (const Error&) {
            return;  // the URL is on the standard output
        }
        if (!show()) close();
    }
    /// May be called from any thread.
    void close() const {
        std::error_code ignored;
        std::filesystem::remove(file_, ignored);
    }

private:
    /// Returns false if no program to open it is found.
    [[nodiscard]] bool show() const {
        std::string program = "xdg-open", argument = file_.string();
        char* arguments[]{program.data(), argument.data(), nullptr};
        // A browser started here must outlive the workbench and receive all signals.
        posix_spawnattr_t attributes;
        ::posix_spawnattr_init(&attributes);
        sigset_t no_signals;
        sigemptyset(&no_signals);
        ::posix_spawnattr_setsigmask(&attributes, &no_signals);
        ::posix_spawnattr_setpgroup(&attributes, 0);
        ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
        pid_t child = 0;
        const bool is_started = ::posix_spawnp(&child, program.c_str(), nullptr, &attributes, arguments, environ) == 0;
        ::posix_spawnattr_destroy(&attributes);
        if (is_started) std::thread([child] { ::waitpid(child, nullptr, 0); }).detach();
        return is_started;
    }

    Path file_;
};

}  // namespace

int run_workbench(const std::vector<std::string>& words) {
    CLI::App command(workbench_help, "ostraka workbench");
    std::string place = ".", session;
    int port = 0, threads = 0;
    double memory = 0;
    bool no_browser = false;
    command.add_option("PLACE", place, "folder with meshes and templates, or one of them (default: the current folder)");
    command.add_option("--session", session,
                       "folder of the session: resumed if it exists, otherwise created (default: beside PLACE)");
    command.add_option("--port", port, "local port, 0 for any free one")->check(CLI::Range(0, 65535))->capture_default_str();
    command.add_option("--threads", threads, "number of threads, 0 for all cores; results do not depend on it")
        ->check(CLI::Range(0, 1024));
    command.add_option("--memory", memory, "memory limit of the workbench [GB]; 0: the memory of the machine")
        ->check(CLI::Range(0.0, 1e6));
    command.add_flag("--no-browser", no_browser, "only print the address");
    try {
        std::vector<std::string> reversed(words.rbegin(), words.rend());
        command.parse(reversed);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0)
            throw Error(ErrorKind::usage, "workbench", error.what(), "'ostraka workbench --help' shows what it takes");
        return command.exit(error) == 0 ? done : wrong_usage;
    }
    set_threads(threads);
    const Path path = std::filesystem::absolute(place).lexically_normal();
    const bool is_file = file_exists(path);
    if (!is_file && !is_folder(path))
        throw Error(ErrorKind::input, place, "does not exist", "name a folder, a mesh or a template");
    const Path root = is_file ? path.parent_path() : path;
    std::string stem = path.stem().string();
    if (stem.ends_with(".template")) stem.resize(stem.size() - std::string(".template").size());
    const Path folder = !session.empty() ? Path(session) : is_file ? root / (stem + "-session") : root / "session";

    const Signals signals;
    Workbench workbench(folder, root, memory * 1e9);
    if (is_file && workbench.session().steps().empty()) {
        Json request(rapidjson::kObjectType);
        request.AddMember("id", 0, request.GetAllocator());
        request.AddMember("do", "open", request.GetAllocator());
        add_member(request, "name", path.filename().string(), request.GetAllocator());
        const Workbench::Reply reply = workbench.answer(to_compact_text(request));
        const Json answer = parse_json(reply.json, "the workbench");
        if (!answer["ok"].GetBool())
            throw Error(ErrorKind::input, place, text_in(answer["error"], "problem"), text_in(answer["error"], "remedy"));
    }
    WorkbenchServer server(workbench, static_cast<std::uint16_t>(port));

    const RedirectFile redirect_file(folder);
    server.on_first_page = [&redirect_file] { redirect_file.close(); };
    signals.stop([&server, &redirect_file] {
        redirect_file.close();
        server.stop();
    });
    std::cout << server.address() << std::endl;
    std::cerr << "session: " << folder.string() << " (Ctrl+C ends the workbench; the session stays)\n";
    if (!no_browser) redirect_file.open(server.address());
    server.run();
    signals.stop({});
    return done;
}

}  // namespace ostraka::app
