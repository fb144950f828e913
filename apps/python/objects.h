// What the native half of the Python module shares: objects that Python holds.
#pragma once

#include "running.h"

#include "ostraka/operation/objects.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>

namespace ostraka {
class Context;
}

namespace ostraka::python {

/// Text of files may hold bytes that are no UTF-8.
py::str text_of_bytes(const std::string& text);

/// A name of a file as Python gives it: bytes, as os.fsencode makes them.
Path path_of(const py::bytes& name);

/// An object of the toolkit that Python holds.
struct Held {
    Object object;
    std::shared_ptr<Context> context = {};  ///< in whose memory the files of a folder or a template are
};

/// A name for a file in memory whose folder is removed at the end.
struct InMemory {
    explicit InMemory(const std::string& name) : folder("memory:.python-" + std::to_string(++count)), file(folder / name) {}
    ~InMemory() { forget_memory(folder); }
    InMemory(const InMemory&) = delete;
    InMemory& operator=(const InMemory&) = delete;
    static inline std::atomic<std::size_t> count{0};
    Path folder, file;
};

/// Writes the object as files, all together or not at all.
void write_object(const Object& object, const Path& file);

/// A number for each element.
Object object_of_values(std::vector<double> list);

/// Adds the class of such objects, and the functions that read and make them, to the module.
void add_objects(py::module_& module);

}  // namespace ostraka::python
