// Damaged and malicious copies of files.
#pragma once

#include "dice.h"

#include "ostraka/files/json.h"

#include <functional>
#include <string>
#include <vector>

namespace ostraka::fuzz {

/// Placeholder for the folder of canaries in mutated files, since its path differs between runs.
inline constexpr const char* canaries_mark = "@CANARIES@";

/// A mutated file.
struct Change {
    enum class What { bytes, link, pipe, folder, gone } what = What::bytes;
    std::string file;   ///< relative to the folder of the run
    std::string bytes;  ///< content; for a link its target
};

/// Flips, removes, repeats or inserts bytes, replaces them by numbers that readers often mishandle, or joins them with `other`,
/// a file of the same kind.
std::string mutate_bytes(const std::string& bytes, const std::string& other, Dice& dice);

/// Removes, duplicates, renames and swaps members, changes types of values, and inserts paths that lead elsewhere. Bytes that
/// are not JSON are mutated as bytes. `plants`: values (JSON texts) to insert, each as a member of the object at its pointer.
struct Plant {
    const char* pointer;
    const char* value;
};
std::string mutate_json(const std::string& text, const std::vector<Plant>& plants, Dice& dice);

/// The same for some lines of a text in which each line is JSON.
std::string mutate_lines(const std::string& text, Dice& dice);

/// Changes the value of one of the members.
std::string mutate_options(const std::string& text, const std::vector<std::string>& members, Dice& dice);

/// Replaces a file by a link, a pipe, a folder or nothing. `may_lead_out`: also by links to canaries and devices.
Change replace_file(const std::string& file, bool may_lead_out, Dice& dice);

/// Whether the file is JSON, by its name.
bool is_json_name(const std::string& file);

}  // namespace ostraka::fuzz
