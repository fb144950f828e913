// The state of a call while it runs, shared by Context and Call.
#pragma once

#include "ostraka/framework/inputs.h"
#include "ostraka/framework/operation.h"
#include "ostraka/framework/outputs.h"

#include <tuple>

namespace ostraka {

/// What a context knows about the running call.
struct Context::CallState {
    std::string command;                       ///< name of the operation
    const Parameters* parameters = nullptr;    ///< slots and options of the call
    Report* report = nullptr;                  ///< report of the call
    std::vector<ReadRecord::Entry> read = {};  ///< files read so far, in the order of reading
    /// (slot, index) -> checksum of the object in memory.
    std::map<std::pair<const Slot*, std::size_t>, std::string> checksums = {};
    /// (slot, index, type, key) -> object read in this call.
    std::map<std::tuple<const Slot*, std::size_t, std::type_index, std::string>, std::shared_ptr<const void>> loaded = {};
    /// Files read by the enclosing load if loads are nested; else null.
    std::vector<ReadRecord::Entry>* within = nullptr;
    /// (file, note) pairs already reported, to avoid repetitions.
    std::vector<std::pair<std::string, std::string>> reported_notes = {};
    /// Name and checksum of inputs that are read elsewhere.
    std::vector<std::pair<std::string, std::string>> recorded_inputs = {};

    /// Checksum of the i-th object of a slot: the checksum that the object states, or the checksum of its file, or of the file
    /// that writing the object would give.
    const std::string& checksum_of(const Slot& slot, std::size_t i);
    void add(const std::vector<ReadRecord::Entry>& files);  ///< adds files that were read
    /// Files that were read, except files that are updated in place.
    [[nodiscard]] std::vector<Path> inputs() const;
};

}  // namespace ostraka
