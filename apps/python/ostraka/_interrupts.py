"""What a thread that waits for an operation asks while it waits."""

import sys
import threading


def main_thread_state() -> int:
    """Called by the native module, twenty times a second, by the thread that called the operation: by being called it lets
    handlers of signals run, and what PyThreadState_SetAsyncExc has left for this thread.

    Python hands Ctrl-C to the main thread alone. Of other threads: 0 if that has nothing to say to them, 1 while it handles a
    KeyboardInterrupt, 2 if it has ended with one and only waits for its threads.
    """
    main = threading.main_thread()
    if main.ident == threading.get_ident():
        return 0
    if getattr(threading, "_SHUTTING_DOWN", False) or not main.is_alive():
        return 2 if _is_interrupt(getattr(sys, "last_type", None)) else 0
    handled = sys._current_exceptions().get(main.ident)
    return 1 if _is_interrupt(handled[0] if isinstance(handled, tuple) else type(handled)) else 0


def _is_interrupt(kind: object) -> bool:
    return isinstance(kind, type) and issubclass(kind, KeyboardInterrupt)
