// Words of the W3C model and of our additions to it, shared by writer and reader.
#pragma once

namespace ostraka::interchange::web {

inline constexpr const char* context = "http://www.w3.org/ns/anno.jsonld";
/// Our additions have names in a private space: nothing is looked up there.
inline constexpr const char* terms = "urn:x-ostraka:terms:";
inline constexpr const char* index_selector = "ostraka:IndexSelector";
inline constexpr const char* place_selector = "ostraka:PlaceSelector";

}  // namespace ostraka::interchange::web
