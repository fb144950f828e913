// A call under way, which contexts and calls know.
#pragma once

#include "ostraka/operation/operation.h"

#include <tuple>

namespace ostraka {

struct Context::CallState {
    std::string command;
    const Parameters* parameters = nullptr;
    Report* report = nullptr;
    std::vector<ReadRecord::Entry> read = {};                                   ///< files, in the order of reading
    std::map<std::pair<const Slot*, std::size_t>, std::string> checksums = {};  ///< of objects in memory
    std::map<std::tuple<const Slot*, std::size_t, std::type_index, std::string>, std::shared_ptr<const void>> loaded = {};
    std::vector<ReadRecord::Entry>* within = nullptr;             ///< what the load reads under which another one is under way
    std::vector<std::pair<std::string, std::string>> noted = {};  ///< so that each note of a file comes once
    std::vector<std::pair<std::string, std::string>> named = {};  ///< name and checksum of inputs that are read elsewhere

    /// The checksum of the i-th object of a slot: what it says itself, or that of the file that it is or would be.
    const std::string& know(const Slot& slot, std::size_t i);
    void add(const std::vector<ReadRecord::Entry>& files);
    /// Files that were read, but for those that are brought up to date in their place.
    [[nodiscard]] std::vector<Path> inputs() const;
};

}  // namespace ostraka
