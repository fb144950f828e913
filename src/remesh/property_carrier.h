// Copies the values of an element, in every property map of a plain type, to an element that was cut from it.
#pragma once

#include "ostraka/mesh/mesh.h"

#include <functional>

namespace ostraka {

/// Copies values in all property maps with key type Key and values of type Index, int, bool, double, float, std::uint8_t or
/// arrays of four std::uint8_t (colours), under any name.
template <class Key>
class PropertyCarrier {
public:
    /// Finds the property maps of the mesh.
    explicit PropertyCarrier(Mesh& mesh) {
        for (const std::string& name : mesh.properties<Key>()) {
            if (name == "v:point" || name.ends_with(":removed") || name.ends_with(":connectivity")) continue;
            add<Index>(mesh, name), add<int>(mesh, name), add<bool>(mesh, name), add<double>(mesh, name), add<float>(mesh, name);
            add<std::uint8_t>(mesh, name), add<std::array<std::uint8_t, 4>>(mesh, name);
        }
    }
    /// Copies the values of element `from` to element `to`.
    void copy(Key from, Key to) const {
        for (const auto& step : steps_) step(from, to);
    }

private:
    template <class Value>
    void add(Mesh& mesh, const std::string& name) {
        const auto [map, exists] = mesh.property_map<Key, Value>(name);
        if (exists) steps_.push_back([values = map](Key from, Key to) { values[to] = Value(values[from]); });
    }
    std::vector<std::function<void(Key, Key)>> steps_;  ///< one copy function per property map
};

}  // namespace ostraka
