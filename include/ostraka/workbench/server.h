// HTTP and WebSocket server for the workbench's web page, on one local port (doc/workbench.md, "Safety").
#pragma once

#include "ostraka/workbench/workbench.h"

#include <cstdint>

namespace ostraka {

/// Limits of the server. Unauthenticated connections are counted separately, so that they cannot prevent the page from
/// connecting.
struct ServerLimits {
    std::size_t unauthenticated = 128;  ///< max number of unauthenticated connections; if there are more, the oldest is closed
    std::size_t pages = 32;             ///< max number of authenticated connections; further ones are refused
    std::size_t header = 8192;          ///< max size of a request head in bytes
    std::size_t message = 4'000'000;    ///< max size of a message from the page in bytes
    std::size_t waiting = 64;           ///< max number of unanswered requests of one page
    std::size_t waiting_bytes = 8'000'000;  ///< max total size of the unanswered requests of one page, bytes
    std::size_t queue_bytes = 64'000'000;   ///< max total size of the requests of all pages, including closed pages, bytes
    /// Max size of unread answers of a page, bytes; above it no further request of the page is started.
    std::size_t unsent = 4'000'000;
    double seconds = 5;   ///< time limit for a request head and for closing, in seconds
    double stalled = 30;  ///< if sending an answer makes no progress for this time, in seconds, the connection is closed
};

/// Listens on the loopback address. Serves pages that present the secret token; the workbench processes their messages one at a
/// time, on a separate thread. For each page the server buffers at most `waiting_bytes`, `unsent`, and one answer.
class WorkbenchServer {
public:
    /// `port` 0: any free port. Throws Error (failure) if the port is not available.
    WorkbenchServer(Workbench& workbench, std::uint16_t port = 0, const ServerLimits& limits = {});
    ~WorkbenchServer();

    /// URL that opens the page, "http://127.0.0.1:PORT/?token=TOKEN"; it contains the secret token.
    [[nodiscard]] std::string address() const;
    /// Port on which the server listens.
    [[nodiscard]] std::uint16_t port() const;
    /// Secret token that a page must present.
    [[nodiscard]] const std::string& token() const;

    /// Called once, on the server's thread, when the first page connects. Must be set before `run`.
    std::function<void()> on_first_page;

    /// Serves pages until `stop` is called; a request in progress is completed first.
    void run();
    /// Stops the server. May be called from any thread.
    void stop();

    struct State;  ///< defined in server.cpp

private:
    std::shared_ptr<State> state_;
};

/// Text of the built HTML page (web/README.md), which is embedded in the command.
std::string_view workbench_page();

}  // namespace ostraka
