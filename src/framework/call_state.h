// The state of a call while it runs, shared by Context and Call.
#pragma once

#include "ostraka/framework/inputs.h"
#include "ostraka/framework/operation.h"
#include "ostraka/framework/outputs.h"

#include <tuple>

namespace ostraka {

struct Context::CallState {
    std::string command;
    const Parameters* parameters = nullptr;
    Report* report = nullptr;
    std::vector<ReadRecord::Entry> read = {};                                   ///< files in the order of reading
    std::map<std::pair<const Slot*, std::size_t>, std::string> checksums = {};  ///< checksums of objects in memory
    std::map<std::tuple<const Slot*, std::size_t, std::type_index, std::string>, std::shared_ptr<const void>> loaded = {};
    std::vector<ReadRecord::Entry>* within = nullptr;  ///< files read by the enclosing load, if loads are nested
    std::vector<std::pair<std::string, std::string>> reported_notes = {};   ///< by file, to avoid repetitions
    std::vector<std::pair<std::string, std::string>> recorded_inputs = {};  ///< inputs that are read elsewhere, with checksums

    /// Checksum of the i-th object of a slot: stated by the object, or that of its file or of the file it would be written to.
    const std::string& checksum_of(const Slot& slot, std::size_t i);
    void add(const std::vector<ReadRecord::Entry>& files);
    /// Files that were read, except those that are updated in place.
    [[nodiscard]] std::vector<Path> inputs() const;
};

}  // namespace ostraka
