// Names an image in messages.
#pragma once

#include "ostraka/core/error.h"

#include <string>

namespace ostraka::images {

/// Where an image is, for messages.
struct Place {
    std::string where;    ///< the file that is or contains the image
    std::string subject;  ///< "the image", with its name unless `where` ends with the name
};
Place place_of(const std::string& name, const std::string& where);

/// Throws Error (input): the subject and what is wrong with it, such as "is empty".
[[noreturn]] void refuse(const Place& place, const std::string& problem, const std::string& remedy = {});

/// Remedy for damaged images.
inline constexpr const char* save_again =
    "copy the image again from its source, or open it in an image editor and save it as PNG";

}  // namespace ostraka::images
