// Native part of the Python module: calls operations of the table by name, and converts their inputs and outputs to Python
// objects. It names no operation; apps/python/ostraka generates the functions from the declarations.
#include "objects.h"

#include "ostraka/core/memory.h"
#include "ostraka/core/message_text.h"
#include "ostraka/core/nearest_name.h"
#include "ostraka/execution/parallel.h"
#include "ostraka/files/json_build.h"
#include "ostraka/framework/operation.h"
#include "ostraka/framework/outputs.h"
#include "ostraka/operations/table.h"
#include "ostraka/template_package/template.h"

#include <fmt/core.h>

namespace ostraka::python {

namespace {

void raise_error(const Error& error) {
    if (error.kind() == ErrorKind::cancelled) {
        PyErr_SetNone(PyExc_KeyboardInterrupt);
        return;
    }
    const char* name = error.kind() == ErrorKind::usage   ? "UsageError"
                       : error.kind() == ErrorKind::input ? "InputError"
                                                          : "WorkError";
    const py::object type = py::module_::import("ostraka._errors").attr(name);
    const py::object raised = type(text_of_bytes(error.problem()), text_of_bytes(error.where()), text_of_bytes(error.remedy()));
    PyErr_SetObject(type.ptr(), raised.ptr());
}

// ---- reports ----

py::bytes layout_of(const Report& report) {
    static constexpr const char* types[]{"boolean", "integer", "number", "text", "numbers", "texts", "any"};
    Json tables(rapidjson::kArrayType);
    auto& allocator = tables.GetAllocator();
    for (const auto& table : report.layout().tables) {
        if (table.key.empty()) continue;
        JsonValue columns(rapidjson::kArrayType);
        for (const Field& field : table.columns)
            if (!field.key.empty())
                columns.PushBack(json_object(allocator, "key", field.key, "type", types[static_cast<std::size_t>(field.type)],
                                             "title", field.title, "unit", field.unit),
                                 allocator);
        tables.PushBack(json_object(allocator, "key", table.key, "columns", std::move(columns)), allocator);
    }
    return to_compact_text(tables);
}

py::str shown(const Report& report, const std::string& format) {
    return text_of_bytes(report.to_text(format == "csv"        ? ReportFormat::csv
                                        : format == "markdown" ? ReportFormat::markdown
                                        : format == "json"     ? ReportFormat::json
                                                               : ReportFormat::table));
}

// ---- calls ----

/// File name of an output that stays in memory.
std::string default_name(const Slot& slot) {
    const auto endings = extensions_of(slot.kind);
    return slot.name + (endings.empty() ? slot.kind == Kind::values ? ".npy" : "" : endings.front());
}

/// The result of Call::declaration for every operation, with further data that callers in other languages need.
py::bytes declarations() {
    Json entries(rapidjson::kArrayType);
    auto& allocator = entries.GetAllocator();
    for (const OperationEntry& entry : operations()) {
        const Call call(entry);
        JsonValue declaration = call.declaration(allocator);
        declaration.RemoveMember("result");
        for (const char* role : {"inputs", "outputs"})
            for (JsonValue& slot_entry : declaration[role].GetArray()) {
                const Slot& slot = *call.parameters().slot(text_in(slot_entry, "name"));
                add_members(slot_entry, allocator, "named", slot.is_named, "none", slot.takes_none, "new", slot.may_be_new,
                            "called", default_name(slot));
            }
        entries.PushBack(declaration, allocator);
    }
    return to_compact_text(entries);
}

std::vector<std::pair<std::string, std::string>> groups() {
    std::vector<std::pair<std::string, std::string>> entries;
    for (const OperationGroup& group : operation_groups()) entries.emplace_back(group.name, group.help);
    return entries;
}

void set_option(Call& call, const std::string& name, const py::handle& value) {
    if (py::isinstance<py::bool_>(value)) call.set(name, value.cast<bool>());
    else if (py::isinstance<py::float_>(value)) call.set(name, value.cast<double>());
    else if (py::isinstance<py::str>(value)) call.set(name, value.cast<std::string>());
    else {
        // Integers and lists, in JSON form.
        Json settings(rapidjson::kObjectType);
        auto& allocator = settings.GetAllocator();
        const auto json_of = [&](const py::handle& element) {
            if (py::isinstance<py::str>(element)) return json_string(element.cast<std::string>(), allocator);
            int overflow = 0;
            const long long integer =
                py::isinstance<py::int_>(element) ? PyLong_AsLongLongAndOverflow(element.ptr(), &overflow) : 0;
            if (py::isinstance<py::int_>(element) && overflow == 0) return JsonValue(static_cast<std::int64_t>(integer));
            if (py::isinstance<py::float_>(element)) return JsonValue(element.cast<double>());
            if (overflow > 0 && !PyErr_Occurred()) {
                const unsigned long long large = PyLong_AsUnsignedLongLong(element.ptr());
                if (!PyErr_Occurred()) return JsonValue(static_cast<double>(large));
                PyErr_Clear();
            }
            throw Error(ErrorKind::usage, call.entry().name,
                        fmt::format("option {} is {}", name, printable(py::repr(element).cast<std::string>(), 60)),
                        "use " + call.option(name).allowed());
        };
        JsonValue list(rapidjson::kArrayType);
        if (py::isinstance<py::list>(value))
            for (const auto element : value) list.PushBack(json_of(element), allocator);
        add_member(settings, name, py::isinstance<py::list>(value) ? std::move(list) : json_of(value), allocator);
        call.set(settings);
    }
}

void set_inputs(Call& call, const py::list& inputs) {
    for (const auto input : inputs) {
        const auto [slot, value, label] = input.cast<std::tuple<std::string, py::object, std::string>>();
        if (py::isinstance<Held>(value)) {
            Object object = value.cast<const Held&>().object;
            if (!label.empty()) object.name = label;
            call.set_object(slot, std::move(object));
        } else if (value.is_none()) {
            call.set_file(slot, "none");
        } else {
            const Path file = path_of(value.cast<py::bytes>());
            call.set_file(slot, label.empty() ? file : Path(label + "=" + file.string()));
        }
    }
}

void set_outputs(Call& call, const py::list& outputs) {
    for (const auto output : outputs) {
        const auto [slot, value] = output.cast<std::pair<std::string, py::object>>();
        if (py::isinstance<py::bytes>(value)) {
            call.set_file(slot, path_of(value.cast<py::bytes>()));
            continue;
        }
        // Outputs written as files in memory choose their own name, from which writers derive the format.
        const bool names_itself = dynamic_cast<const FileOutput*>(&call.slot(slot)) != nullptr;
        call.want(slot, !value.is_none() ? value.cast<std::string>() : names_itself ? "" : default_name(call.slot(slot)));
    }
}

/// Outputs that stayed in memory, by name.
py::dict outputs_of(const Call& call, const std::shared_ptr<Context>& context) {
    py::dict kept_outputs;
    for (const Slot* slot : call.parameters().slots()) {
        if (slot->role != Role::output) continue;
        py::list objects;
        for (const Source& source : slot->sources) {
            if (!source.object) continue;
            Held held{source.object, source.object.as<Path>() || source.object.as<Template>() ? context : nullptr};
            const Slot* updated = slot->updated;
            if (held.object.name == slot->name)  // no name was given
                held.object.name = updated != nullptr && *updated ? updated->file_name() : default_name(*slot);
            objects.append(std::move(held));
        }
        if (!objects.empty()) kept_outputs[py::str(slot->name)] = objects;
    }
    return kept_outputs;
}

/// Runs an operation. `options`: (name, value); `inputs`: (slot name, file name as bytes, object, or None for "none");
/// `outputs`: the same with a file name or, for outputs in memory, the name of the object.
py::tuple run(const std::string& name, const py::dict& options, const py::list& inputs, const py::list& outputs,
              const py::object& progress) {
    const auto call = std::make_shared<Call>(find_operation(name));
    for (const auto& [option, value] : options) set_option(*call, option.cast<std::string>(), value);
    // Folders and templates given as inputs keep their files in contexts of their own, which must live as long.
    std::vector<std::shared_ptr<Context>> contexts;
    for (const auto input : inputs)
        if (const auto value = input.cast<std::tuple<std::string, py::object, std::string>>();
            py::isinstance<Held>(std::get<1>(value)))
            contexts.push_back(std::get<1>(value).cast<const Held&>().context);
    set_inputs(*call, inputs);
    set_outputs(*call, outputs);
    const auto context = std::make_shared<Context>();
    const auto report = std::make_shared<std::shared_ptr<Report>>();
    run_watched({context, &context->watch}, progress, [contexts = std::move(contexts), call, context, report] {
        *report = std::make_shared<Report>(call->run(*context));
    });
    return py::make_tuple(*report, outputs_of(*call, context));
}

}  // namespace

}  // namespace ostraka::python

PYBIND11_MODULE(_ostraka, module) {
    using namespace ostraka;
    using namespace ostraka::python;
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const Error& error) {
            raise_error(error);
        }
    });
    requested_threads = threads();
    stop_work_at_exit();

    add_objects(module);
    py::class_<Report, std::shared_ptr<Report>>(module, "Report")
        .def("text", shown)
        .def("layout", layout_of)
        .def_property_readonly("holds", &Report::holds);

    module.def("version", version);
    module.def("memory_limit", [] { return requested_memory > 0 ? requested_memory.load() : memory_limit(); });
    module.def("set_memory_limit", [](double bytes) { requested_memory = bytes; });
    module.def("hold_spare_team", hold_spare_team);
    module.def("threads", [] { return requested_threads.load(); });
    module.def("set_threads", [](int count) {
        set_threads(count);  // rejects invalid numbers of threads
        requested_threads = threads();
    });
    module.def("nearest_name", nearest_name);
    module.def("declarations", declarations);
    module.def("groups", groups);
    module.def("run", run);
}
