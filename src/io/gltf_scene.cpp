#include "io/gltf_scene.h"

#include <fmt/core.h>

#include <cmath>

namespace ostraka::io {

std::array<double, 3> AffineMap::operator()(const std::array<double, 3>& p) const {
    std::array<double, 3> image{};
    for (std::size_t i = 0; i < 3; ++i) image[i] = linear[i][0] * p[0] + linear[i][1] * p[1] + linear[i][2] * p[2] + shift[i];
    return image;
}

AffineMap AffineMap::after(const AffineMap& first) const {
    AffineMap result;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            result.linear[i][k] =
                linear[i][0] * first.linear[0][k] + linear[i][1] * first.linear[1][k] + linear[i][2] * first.linear[2][k];
    result.shift = (*this)(first.shift);
    return result;
}

bool AffineMap::mirrors() const {
    const auto& [a, b, c] = linear;
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]) < 0;
}

namespace {

/// Reads the transformation of a node (glTF 2.0, section 3.5.3).
class NodeReader {
public:
    NodeReader(const glb::Reader& reader, const JsonValue& node, std::size_t index)
        : reader_(reader), node_(node), pointer_("/nodes/" + std::to_string(index)) {}

    [[nodiscard]] AffineMap placement() const {
        if (const JsonValue* extras = find_member(node_, "extras");
            extras != nullptr && find_member(*extras, glb::display_only) != nullptr)
            return {};
        AffineMap map;
        if (find_member(node_, "matrix") != nullptr) {
            const auto matrix = numbers<16>("matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});  // column by column
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t k = 0; k < 3; ++k) map.linear[i][k] = matrix[4 * k + i];
                map.shift[i] = matrix[12 + i];
            }
            return map;
        }
        map.shift = numbers<3>("translation", {0, 0, 0});
        if (find_member(node_, "rotation") != nullptr) map.linear = rotation(numbers<4>("rotation", {0, 0, 0, 1}));
        const auto scale = numbers<3>("scale", {1, 1, 1});
        for (auto& row : map.linear)
            for (std::size_t k = 0; k < 3; ++k) row[k] *= scale[k];
        return map;
    }

private:
    /// The matrix of a quaternion, which need not have unit length: writers round it to single precision.
    [[nodiscard]] std::array<std::array<double, 3>, 3> rotation(const std::array<double, 4>& quaternion) const {
        const auto& [x, y, z, w] = quaternion;
        const double square = x * x + y * y + z * z + w * w;
        if (!(square > 0) || !std::isfinite(square)) reader_.fail(pointer_ + "/rotation", "is not a rotation");
        const double s = 2 / square;
        return {{{1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)},
                 {s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)},
                 {s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)}}};
    }

    template <std::size_t count>
    [[nodiscard]] std::array<double, count> numbers(const char* name, std::array<double, count> fallback) const {
        const JsonValue* list = find_member(node_, name);
        if (list == nullptr) return fallback;
        if (!list->IsArray() || list->Size() != count)
            reader_.fail(fmt::format("{}/{}", pointer_, name), fmt::format("is not a list of {} numbers", count));
        for (std::size_t i = 0; i < count; ++i) {
            const JsonValue& value = (*list)[static_cast<rapidjson::SizeType>(i)];
            if (!value.IsNumber() || !std::isfinite(value.GetDouble()))
                reader_.fail(fmt::format("{}/{}/{}", pointer_, name, i), "is not a finite number");
            fallback[i] = value.GetDouble();
        }
        return fallback;
    }

    const glb::Reader& reader_;
    const JsonValue& node_;
    std::string pointer_;
};

/// An index in a list of indices.
std::size_t index_in(const glb::Reader& reader, const JsonValue& value, const std::string& pointer) {
    if (!value.IsUint()) reader.fail(pointer, "is not a non-negative integer");
    return value.GetUint();
}

/// The nodes that are no child of another node.
std::vector<std::size_t> root_nodes(const glb::Reader& reader) {
    const auto nodes = list_in(reader.document(), "nodes");
    std::vector<bool> is_child(nodes.Size(), false);
    for (const JsonValue& node : nodes)
        for (const JsonValue& child : list_in(node, "children"))
            if (child.IsUint() && child.GetUint() < nodes.Size()) is_child[child.GetUint()] = true;
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < nodes.Size(); ++i)
        if (!is_child[i]) roots.push_back(i);
    if (roots.empty() && !nodes.Empty()) reader.fail("/nodes", "every node is the child of another: they form a cycle");
    return roots;
}

/// The nodes at which the scene begins.
std::vector<std::size_t> first_nodes(const glb::Reader& reader, std::vector<std::string>& notes) {
    const auto scenes = list_in(reader.document(), "scenes");
    if (scenes.Empty()) return root_nodes(reader);
    const std::size_t scene = reader.number(reader.document(), "scene", "", 0);
    if (scenes.Size() > 1)
        notes.push_back(fmt::format("contains {} scenes; only the default scene (number {}) was read", scenes.Size(), scene));
    std::vector<std::size_t> roots;
    const std::string pointer = fmt::format("/scenes/{}/nodes", scene);
    for (const JsonValue& node : list_in(reader.element("scenes", scene, "/scene"), "nodes"))
        roots.push_back(index_in(reader, node, pointer));
    return roots;
}

}  // namespace

std::vector<PlacedMesh> placed_meshes(const glb::Reader& reader, std::vector<std::string>& notes) {
    struct Step {
        std::size_t node;
        AffineMap parent;
    };
    const auto nodes = list_in(reader.document(), "nodes"), meshes = list_in(reader.document(), "meshes");
    std::vector<PlacedMesh> placed;
    if (nodes.Empty() && list_in(reader.document(), "scenes").Empty()) {
        for (std::size_t i = 0; i < meshes.Size(); ++i) placed.push_back({i, {}});
        if (!placed.empty()) notes.emplace_back("contains no nodes; each mesh was read once, where it is");
        return placed;
    }
    reader.charge(static_cast<double>(sizeof(Step) + sizeof(PlacedMesh)) * nodes.Size(), "/nodes");
    std::vector<bool> is_reached(nodes.Size(), false), is_shown(meshes.Size(), false);
    std::vector<Step> stack;
    const auto push = [&](std::size_t node, const AffineMap& parent, const std::string& pointer) {
        if (node >= nodes.Size()) reader.fail(pointer, fmt::format("refers to node {}, which does not exist", node));
        if (is_reached[node])
            reader.fail(pointer, fmt::format("node {} is reached twice: the nodes form a cycle, or it has two parents", node));
        is_reached[node] = true;
        stack.push_back({node, parent});
    };
    const std::vector<std::size_t> roots = first_nodes(reader, notes);
    for (auto root = roots.rbegin(); root != roots.rend(); ++root) push(*root, {}, "/scenes");
    while (!stack.empty()) {
        const Step step = stack.back();
        stack.pop_back();
        const JsonValue& node = nodes[static_cast<rapidjson::SizeType>(step.node)];
        const std::string pointer = "/nodes/" + std::to_string(step.node);
        const AffineMap map = step.parent.after(NodeReader(reader, node, step.node).placement());
        constexpr std::size_t no_mesh = static_cast<std::size_t>(-1);
        if (const std::size_t mesh = reader.number(node, "mesh", pointer, no_mesh); mesh != no_mesh) {
            if (mesh >= meshes.Size()) reader.fail(pointer + "/mesh", fmt::format("there is no mesh {}", mesh));
            placed.push_back({mesh, map});
            is_shown[mesh] = true;
        }
        const auto children = list_in(node, "children");
        for (rapidjson::SizeType i = children.Size(); i-- > 0;)
            push(index_in(reader, children[i], pointer + "/children"), map, pointer + "/children");
    }
    std::size_t hidden = 0;
    for (const bool shown : is_shown) hidden += shown ? 0 : 1;
    if (hidden > 0) notes.push_back(fmt::format("{} of {} meshes are not in the scene and were not read", hidden, meshes.Size()));
    return placed;
}

}  // namespace ostraka::io
