// The workbench as a command: a server on this machine, until it is interrupted.
#include "workbench.h"

#include "command_line.h"

#include "ostraka/core/error.h"
#include "ostraka/core/parallel.h"
#include "ostraka/core/words.h"
#include "ostraka/workbench/server.h"

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

/// Shows an address in the browser of a desktop; silent where there is none.
void show_in_browser(const std::string& address) {
    if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
    std::string program = "xdg-open", argument = address;
    char* arguments[]{program.data(), argument.data(), nullptr};
    pid_t child = 0;
    if (::posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ) != 0) return;
    std::thread([child] { ::waitpid(child, nullptr, 0); }).detach();
}

}  // namespace

int run_workbench(const std::vector<std::string>& words) {
    CLI::App command(workbench_help, "ostraka workbench");
    std::string place = ".", session;
    int port = 0, threads = 0;
    bool no_browser = false;
    command.add_option("PLACE", place, "folder with meshes and templates, or one of them (else the current folder)");
    command.add_option("--session", session,
                       "folder of the session: goes on with the one that is there, or begins it (else beside PLACE)");
    command.add_option("--port", port, "port of this machine, 0 for any that is free")
        ->check(CLI::Range(0, 65535))
        ->capture_default_str();
    command.add_option("--threads", threads, "number of threads, 0 for all cores; results do not depend on it")
        ->check(CLI::Range(0, 1024));
    command.add_flag("--no-browser", no_browser, "say the address only");
    try {
        std::vector<std::string> reversed(words.rbegin(), words.rend());
        command.parse(reversed);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0)
            throw Error(ErrorKind::usage, "workbench", error.what(), "'ostraka workbench --help' shows what it takes");
        return command.exit(error) == 0 ? done : wrong_usage;
    }
    set_threads(threads);
    const Path given = std::filesystem::absolute(place).lexically_normal();
    const bool is_file = file_exists(given);
    if (!is_file && !is_folder(given))
        throw Error(ErrorKind::input, place, "is not there", "name a folder, a mesh or a template");
    const Path root = is_file ? given.parent_path() : given;
    std::string stem = given.stem().string();
    if (stem.ends_with(".template")) stem.resize(stem.size() - std::string(".template").size());
    const Path folder = !session.empty() ? Path(session) : is_file ? root / (stem + "-session") : root / "session";

    Workbench workbench(folder, root);
    if (is_file && workbench.session().steps().empty()) {
        Json request(rapidjson::kObjectType);
        request.AddMember("id", 0, request.GetAllocator());
        request.AddMember("do", "open", request.GetAllocator());
        add_member(request, "name", given.filename().string(), request.GetAllocator());
        const Workbench::Reply reply = workbench.answer(to_compact_text(request));
        const Json answer = parse_json(reply.json, "the workbench");
        if (!answer["ok"].GetBool())
            throw Error(ErrorKind::input, place, text_in(answer["error"], "problem"), text_in(answer["error"], "remedy"));
    }
    WorkbenchServer server(workbench, static_cast<std::uint16_t>(port));

    // Signals end it in order: a thread of its own waits for them.
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread([&server, signals] {
        int signal = 0;
        sigwait(&signals, &signal);
        server.stop();
        sigwait(&signals, &signal);  // a second one does not wait for what is under way
        std::_Exit(cancelled);
    }).detach();

    std::cout << server.address() << std::endl;
    std::cerr << "session: " << folder.string() << " (Ctrl+C ends the workbench; the session stays)\n";
    if (!no_browser) show_in_browser(server.address());
    server.run();
    return done;
}

}  // namespace ostraka::app
