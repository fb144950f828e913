#include "command_line.h"

#include "ostraka/core/error.h"
#include "ostraka/core/message_text.h"

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <new>

// NOLINTNEXTLINE(bugprone-exception-escape): what stands in the catches throws only without any memory left
int main(int argc, char** argv) {
    using namespace ostraka;
    // A closed pipe or a full disk must give an error message, not a signal.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        return app::run_command_line(argc, argv);
    } catch (const Error& error) {
        std::cerr << "ostraka: " << printable(error.what()) << '\n';
        // All outputs are undone; detached work of other libraries may still be running (core/run_interruptibly.h).
        if (error.kind() == ErrorKind::cancelled) std::_Exit(app::cancelled);
        return error.kind() == ErrorKind::usage ? app::wrong_usage : app::failed;
    } catch (const std::bad_alloc&) {
        std::cerr << "ostraka: out of memory (allow more by --memory, close other programs or use a smaller mesh)\n";
        return app::failed;
    } catch (const std::exception& error) {
        std::cerr << "ostraka: internal error: " << error.what() << " (please report it with the command that caused it)\n";
        return app::failed;
    }
}
