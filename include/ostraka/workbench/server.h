// The workbench's page and its messages over one port of this machine (doc/workbench.md, "Safety").
#pragma once

#include "ostraka/workbench/workbench.h"

#include <cstdint>

namespace ostraka {

struct ServerLimits {
    std::size_t connections = 32;
    std::size_t header = 8192;        ///< bytes
    std::size_t message = 4'000'000;  ///< bytes of a message from the page
    std::size_t waiting = 64;         ///< requests of one page that are not answered yet
    double seconds = 10;              ///< for a request's head, and for closing
};

/// Listens on the loopback address. Pages are served that say the token; their messages go to the workbench one after the other,
/// on a thread of its own.
class WorkbenchServer {
public:
    /// `port` 0: any that is free. Throws Error (failure) where the port cannot be had.
    WorkbenchServer(Workbench& workbench, std::uint16_t port = 0, const ServerLimits& limits = {});
    ~WorkbenchServer();

    /// "http://127.0.0.1:PORT/?token=TOKEN": it opens the page, and is a secret.
    [[nodiscard]] std::string address() const;
    [[nodiscard]] std::uint16_t port() const;
    [[nodiscard]] const std::string& token() const;

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
