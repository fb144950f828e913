// Terms of the W3C model of annotations and of our additions, shared by writer and reader.
#pragma once

namespace ostraka::interchange::web {

inline constexpr const char* context = "http://www.w3.org/ns/anno.jsonld";  ///< JSON-LD context of the W3C model
/// Private namespace of our additions, which is never looked up on the web.
inline constexpr const char* terms = "urn:x-ostraka:terms:";
inline constexpr const char* index_selector = "ostraka:IndexSelector";  ///< selects elements by indices
inline constexpr const char* place_selector = "ostraka:PlaceSelector";  ///< selects elements by coordinates

}  // namespace ostraka::interchange::web
