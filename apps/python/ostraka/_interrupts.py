"""Checks for interrupts while a thread waits for an operation."""

import sys
import threading


def main_thread_state() -> int:
    """State of the main thread, for threads that wait for an operation.

    The native module calls it twenty times per second in the thread that called the operation. The call also lets signal
    handlers run, and raises exceptions set by PyThreadState_SetAsyncExc for this thread.

    Python delivers Ctrl-C to the main thread only. For other threads, returns 1 while the main thread handles a
    KeyboardInterrupt, 2 if it has ended with one and only waits for its threads, and 0 otherwise.
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
