// Damaged and hostile copies of files.
#pragma once

#include "dice.h"

#include "ostraka/core/json.h"

#include <functional>
#include <string>
#include <vector>

namespace ostraka::fuzz {

/// Stands for the folder of canaries in mutated files: where it is differs from run to run.
inline constexpr const char* canaries_mark = "@CANARIES@";

/// What became of a file.
struct Change {
    enum class What { bytes, link, pipe, folder, gone } what = What::bytes;
    std::string file;   ///< relative to the folder of the run
    std::string bytes;  ///< of a link its target
};

/// Bytes flipped, cut, repeated, inserted, replaced by numbers that readers trip over, or joined with `other`, a file of the same
/// kind.
std::string mutate_bytes(const std::string& bytes, const std::string& other, Dice& dice);

/// Members dropped, doubled, renamed and swapped, values of other types, texts that lead elsewhere. Bytes that are no JSON are
/// mutated as bytes. `plants`: values (JSON texts) to add somewhere, each as a member of the object at its pointer.
struct Plant {
    const char* pointer;
    const char* value;
};
std::string mutate_json(const std::string& text, const std::vector<Plant>& plants, Dice& dice);

/// The same with a line here and there, each of which is JSON.
std::string mutate_lines(const std::string& text, Dice& dice);

/// Another value of one of the members; the others stay.
std::string mutate_options(const std::string& text, const std::vector<std::string>& members, Dice& dice);

/// A link, a pipe, a folder or nothing instead of a file. `may_lead_out`: links to canaries and devices as well.
Change replace_file(const std::string& file, bool may_lead_out, Dice& dice);

/// JSON by the file's name.
bool is_json_name(const std::string& file);

}  // namespace ostraka::fuzz
