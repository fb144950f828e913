// Shared by the native part of the Python module: objects held by Python.
#pragma once

#include "running.h"

#include "ostraka/framework/objects.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>

namespace ostraka {
class Context;
}

namespace ostraka::python {

/// Decodes text from files, which may contain invalid UTF-8.
py::str text_of_bytes(const std::string& text);

/// Path from a Python file name: bytes, as from os.fsencode.
Path path_of(const py::bytes& name);

/// An object of the toolkit that Python holds.
struct Held {
    Object object;
    std::shared_ptr<Context> context = {};  ///< context that holds the files of a folder or a template
};

/// A unique in-memory file name; its folder is removed on destruction.
struct InMemory {
    explicit InMemory(const std::string& name) : folder("memory:.python-" + std::to_string(++count)), file(folder / name) {}
    ~InMemory() { remove_memory_files(folder); }
    InMemory(const InMemory&) = delete;
    InMemory& operator=(const InMemory&) = delete;
    static inline std::atomic<std::size_t> count{0};
    Path folder, file;
};

/// Writes the object to files, all or none.
void write_object(const Object& object, const Path& file);

/// One number per element.
Object object_of_values(std::vector<double> numbers);

/// Adds the class of these objects, and the functions that read and make them, to the module.
void add_objects(py::module_& module);

}  // namespace ostraka::python
