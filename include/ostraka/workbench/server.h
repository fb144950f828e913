// The workbench's page and its messages over one port of this machine (doc/workbench.md, "Safety").
#pragma once

#include "ostraka/workbench/workbench.h"

#include <cstdint>

namespace ostraka {

/// What one may ask of the server. Connections that have not said the token are counted apart from pages, so that they cannot
/// keep a page out.
struct ServerLimits {
    std::size_t unauthenticated = 128;      ///< connections that have not said the token; beyond, the oldest is dropped
    std::size_t pages = 32;                 ///< connections that have said it; beyond, further ones are refused
    std::size_t header = 8192;              ///< bytes
    std::size_t message = 4'000'000;        ///< bytes of a message from the page
    std::size_t waiting = 64;               ///< requests of one page that are not answered yet
    std::size_t waiting_bytes = 8'000'000;  ///< of these requests
    std::size_t queue_bytes = 64'000'000;   ///< of the requests of all pages, also of those that are gone
    std::size_t unsent = 4'000'000;         ///< bytes of answers that a page has not read; beyond, none of its requests is begun
    double seconds = 5;                     ///< for a request's head, and for closing
    double stalled = 30;                    ///< a page that takes nothing of its answer for so long is dropped
};

/// Listens on the loopback address. Pages are served that say the token; their messages go to the workbench one after the other,
/// on a thread of its own. What the server keeps for a page is at most `waiting_bytes`, `unsent`, and one answer.
class WorkbenchServer {
public:
    /// `port` 0: any that is free. Throws Error (failure) where the port cannot be had.
    WorkbenchServer(Workbench& workbench, std::uint16_t port = 0, const ServerLimits& limits = {});
    ~WorkbenchServer();

    /// "http://127.0.0.1:PORT/?token=TOKEN": it opens the page, and is a secret.
    [[nodiscard]] std::string address() const;
    [[nodiscard]] std::uint16_t port() const;
    [[nodiscard]] const std::string& token() const;

    /// Called once, when the first page talks, by the thread that runs the server. To be set before `run`.
    std::function<void()> on_first_page;

    /// Serves until `stop`; a request that is under way then ends first.
    void run();
    /// From any thread.
    void stop();

    struct State;  ///< of the server's own file

private:
    std::shared_ptr<State> state_;
};

/// The built page (web/README.md) as the command holds it.
std::string_view workbench_page();

}  // namespace ostraka
